/* replay_capsule.c - repeats a replay from its capsule and prints the hash of its angles.
 *
 *     replay_capsule CAPSULE
 *
 * Nothing but the core and stdio, so that any compiler, and the emulated board, can be held against
 * limber-sim. One tick in memory at a time.
 */
#include <inttypes.h>
#include <stdio.h>

#include "angle_hash.h"
#include "capsule.h"

static rod subject;
static scene objects;
static capsule_header header;

int main(int argc, char **argv)
{
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    if (file == NULL || fread(&header, sizeof header, 1, file) != 1 ||
        header.magic != CAPSULE_MAGIC) {
        fprintf(stderr,
                "replay_capsule: needs one argument, a file of limber-sim replay --capsule\n");
        return 2;
    }
    if (capsule_begin(&header, &objects, &subject) != ROD_OK) {
        fprintf(stderr, "replay_capsule: the rod refuses what the capsule begins with\n");
        return 2;
    }
    uint64_t hash = ANGLE_HASH_START;
    uint32_t done_n = 0;
    capsule_tick tick;
    for (; fread(&tick, sizeof tick, 1, file) == 1; done_n++) {
        if (tick.restart != 0) {
            rod_reset(&subject);
        }
        const rod_error error = rod_step(&subject, &tick.base);
        if (error != ROD_OK) {
            fprintf(stderr, "replay_capsule: tick %" PRIu32 ": %s\n", done_n,
                    rod_error_text(error));
            return 3;
        }
        hash = angle_hash_add(hash, &rod_angles(&subject)[0][0], 2 * header.params.links_n);
    }
    fclose(file);
    if (done_n != header.ticks_n) {
        fprintf(stderr, "replay_capsule: the capsule ends early\n");
        return 2;
    }
    printf("ticks %" PRIu32 "\nhash %08" PRIx32 "%08" PRIx32 "\n", done_n, (uint32_t)(hash >> 32),
           (uint32_t)hash);
    return 0;
}
