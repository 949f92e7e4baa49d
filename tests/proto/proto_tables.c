/* proto_tables.c - writes what PROTOCOL.md and limber.ksy say about messages and values, from the lists
 * that the code is made of; or checks that they say it.
 *
 *     proto_tables --write|--check DIRECTORY
 *
 * A region starts after a line with "begin NAME" and ends before one with "end NAME". */
#include <stdlib.h>
#include <string.h>

#include "proto_tables.h"

#define FIELD_MEANING_ONE(of, type, name, meaning) meaning,
#define FIELD_MEANING_MANY(of, type, n, name, meaning) meaning,
#define FIELD_MEANING_NAME(of, n, name, meaning) meaning,
#define FIELD_MEANINGS(NAME, member, type, tail, direction, drop, meaning)                         \
    static const char *const MEANINGS_##member[] = {                                               \
        NAME##_FIELDS(member, FIELD_MEANING_ONE, FIELD_MEANING_MANY, FIELD_MEANING_NAME)};
MESSAGES(FIELD_MEANINGS)

#define WORDS(NAME, member, type, tail, direction, drop, meaning)                                  \
    {meaning, #member, #tail, MEANINGS_##member},
const message_words message_words_of[MESSAGES_N] = {MESSAGES(WORDS)};

#define ADD_VALUES(list, member, flags, title) &message_values_##member,
const message_values *const values_lists[] = {MESSAGE_VALUES(ADD_VALUES)};
const int values_lists_n = sizeof values_lists / sizeof values_lists[0];

const char *const direction_words[] = {"", "to the device", "from the device", "both ways"};

typedef struct {
    const char *file, *name;
    void (*put)(FILE *out);
} region;

static const region REGIONS[] = {
    {"PROTOCOL.md", "messages", put_markdown_messages},
    {"PROTOCOL.md", "values", put_markdown_values},
    {"PROTOCOL.md", "example", put_markdown_example},
    {"limber.ksy", "types", put_kaitai_types},
    {"limber.ksy", "cases", put_kaitai_cases},
    {"limber.ksy", "enums", put_kaitai_enums},
};

static char text[1 << 18]; /* of one file */

static void read_file(const char *path)
{
    FILE *const file = fopen(path, "rb");
    if (file == NULL) {
        perror(path);
        exit(EXIT_FAILURE);
    }
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
}

/* The start of the line after the one, or of the one, that contains the words. */
static char *find_line(char *from, const char *word, const char *name, bool after)
{
    char words_of_line[64];
    snprintf(words_of_line, sizeof words_of_line, "%s %s", word, name);
    char *at = strstr(from, words_of_line);
    if (at == NULL) {
        fprintf(stderr, "proto_tables: no line with \"%s\"\n", words_of_line);
        exit(EXIT_FAILURE);
    }
    if (after) {
        return strchr(at, '\n') + 1;
    }
    while (at > from && at[-1] != '\n') {
        at--;
    }
    return at;
}

static bool treat(const region *r, const char *directory, bool write)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", directory, r->file);
    read_file(path);
    char *made = NULL;
    size_t made_n = 0;
    FILE *const out = open_memstream(&made, &made_n);
    r->put(out);
    fclose(out);

    char *const begin = find_line(text, "begin", r->name, true);
    char *const end = find_line(begin, "end", r->name, false);
    const bool same = (size_t)(end - begin) == made_n && memcmp(begin, made, made_n) == 0;
    if (!same && write) {
        FILE *const file = fopen(path, "wb");
        if (file == NULL) {
            perror(path);
            exit(EXIT_FAILURE);
        }
        fwrite(text, 1, (size_t)(begin - text), file);
        fwrite(made, 1, made_n, file);
        fputs(end, file);
        fclose(file);
    }
    printf("%s, %s: %s\n", r->file, r->name, same ? "as made" : write ? "written" : "DIFFERS");
    free(made);
    return same || write;
}

int main(int argc, char **argv)
{
    const bool write = argc == 3 && strcmp(argv[1], "--write") == 0;
    if (argc != 3 || (!write && strcmp(argv[1], "--check") != 0)) {
        fprintf(stderr, "usage: proto_tables --write|--check DIRECTORY\n");
        return EXIT_FAILURE;
    }
    bool good = true;
    for (size_t i = 0; i < sizeof REGIONS / sizeof REGIONS[0]; i++) {
        good = treat(&REGIONS[i], argv[2], write) && good;
    }
    if (!good) {
        fprintf(stderr, "the lists have changed: run  tools/dev build && "
                        "build/host/tests/proto/proto_tables --write proto\n");
    }
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
