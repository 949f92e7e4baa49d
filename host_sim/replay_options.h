/* replay_options.h - what limber-sim replay was asked for. */
#ifndef LIMBER_REPLAY_OPTIONS_H
#define LIMBER_REPLAY_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "params_text.h"
#include "track.h"

typedef struct {
    char *track_path;
    params_text params;
    track_options track;
    double rate_hz;
    char *scene_path, *shape;
    bool shape_strength_given;
    double shape_strength_nm, shape_blend_s;
    char *angles_path, *nodes_path, *contacts_path, *report_path, *picture_path, *capsule_path,
        *per_tick_path;
    bool expect;
    uint64_t expected_hash;
} replay_choices;

/* Returns SIM_OK, with *help where the help was asked for and printed, or an exit code after complaining. To be freed
 * either way. */
int replay_options_take(int argc, const char **argv, replay_choices *c, bool *help);
void replay_options_free(replay_choices *c);

#endif
