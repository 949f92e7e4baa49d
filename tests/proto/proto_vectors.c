/* proto_vectors.c - the golden frames of proto/vectors, and the C side of the test against others' code.
 *
 *     proto_vectors --write DIRECTORY    make the files
 *     proto_vectors --check DIRECTORY    they are what would be made, and decode to what they expect
 *     proto_vectors --dump ROUNDS        so many random records of each message on standard output
 *     proto_vectors --read               each line of hex on standard input: what comes of it, and of a
 *                                        good frame header and payload */
#include <stdlib.h>

#include "proto_support.h"
#include "vector_text.h"

enum { BYTES_ROOM = 8192 };

static uint8_t bytes[BYTES_ROOM];
static size_t bytes_n;

static const struct {
    const char *name;
    void (*put)(FILE *out);
} FILES[] = {{"good.txt", put_good}, {"damaged.txt", put_damaged}};

static FILE *open_or_die(const char *directory, const char *name, const char *mode)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", directory, name);
    FILE *const file = fopen(path, mode);
    if (file == NULL) {
        perror(path);
        exit(EXIT_FAILURE);
    }
    return file;
}

/* The file's records decode to what they expect. */
static bool check_records(FILE *file, const char *name)
{
    static char line[4 * BYTES_ROOM], record[4 * BYTES_ROOM];
    bool good = true;
    int records_n = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        line[strcspn(line, "\n")] = '\0';
        if (strncmp(line, "name: ", 6) == 0) {
            snprintf(record, sizeof record, "%s", line + 6);
        } else if (strncmp(line, "hex: ", 5) == 0) {
            bytes_n = get_hex(line + 5, bytes, sizeof bytes);
        } else if (strncmp(line, "expect:", 7) == 0) {
            char *events = NULL;
            size_t events_n = 0;
            FILE *const out = open_memstream(&events, &events_n);
            put_events(out, bytes, bytes_n);
            fclose(out);
            if (strcmp(events, line + 7) != 0) {
                printf("%s: %s: expected%s, got%s\n", name, record, line + 7, events);
                good = false;
            }
            free(events);
            records_n++;
        }
    }
    printf("%s: %d records\n", name, records_n);
    return good && records_n > 0;
}

static bool check_file(size_t i, const char *directory)
{
    char *made = NULL;
    size_t made_n = 0, same_n = 0;
    FILE *const out = open_memstream(&made, &made_n);
    FILES[i].put(out);
    fclose(out);
    FILE *const file = open_or_die(directory, FILES[i].name, "rb");
    while (same_n < made_n && fgetc(file) == (unsigned char)made[same_n]) {
        same_n++;
    }
    const bool same = same_n == made_n && fgetc(file) == EOF;
    free(made);
    if (!same) {
        printf("%s is not what --write makes\n", FILES[i].name);
    }
    rewind(file);
    const bool good = check_records(file, FILES[i].name);
    fclose(file);
    return same && good;
}

static void dump(int rounds_n)
{
    uint32_t seed = 4711;
    static message m;
    for (int round = 0; round < rounds_n; round++) {
        for (int i = 0; i < MESSAGES_N; i++) {
            const frame header = random_frame(NULL, 0, &seed);
            fill_message(&m, &messages[i], FILL_RANDOM_FINITE, &seed);
            put_message_record(stdout, "random", &m, &header);
        }
    }
}

static void read_lines(void)
{
    static char line[4 * BYTES_ROOM];
    static frame_decoder decoder;
    while (fgets(line, sizeof line, stdin) != NULL) {
        bytes_n = get_hex(line, bytes, sizeof bytes);
        put_events(stdout, bytes, bytes_n);
        frame f;
        frame_decoder_init(&decoder);
        for (size_t i = 0; i < bytes_n; i++) {
            if (frame_decoder_push(&decoder, bytes[i], &f)) {
                printf(" = %u %u %u %lu", f.type, f.session, f.seq, (unsigned long)f.t_us);
                for (size_t k = 0; k < f.payload_n; k++) {
                    printf(" %02x", f.payload[k]);
                }
            }
        }
        putchar('\n');
    }
}

int main(int argc, char **argv)
{
    const char *const mode = argc > 1 ? argv[1] : "";
    bool good = true;
    if (argc == 3 && strcmp(mode, "--write") == 0) {
        for (size_t i = 0; i < sizeof FILES / sizeof FILES[0]; i++) {
            FILE *const file = open_or_die(argv[2], FILES[i].name, "wb");
            FILES[i].put(file);
            fclose(file);
        }
    } else if (argc == 3 && strcmp(mode, "--check") == 0) {
        for (size_t i = 0; i < sizeof FILES / sizeof FILES[0]; i++) {
            good = check_file(i, argv[2]) && good;
        }
    } else if (argc == 3 && strcmp(mode, "--dump") == 0) {
        dump(atoi(argv[2]));
    } else if (argc == 2 && strcmp(mode, "--read") == 0) {
        read_lines();
    } else {
        fprintf(stderr,
                "usage: proto_vectors --write|--check DIRECTORY | --dump ROUNDS | --read\n");
        return EXIT_FAILURE;
    }
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
