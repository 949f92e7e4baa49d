/* replay.h - a rod run along a track, tick by tick, and everything that came of it.
 *
 * Only what is kept for later is in memory: all angles, and the base poses. The rod itself is the
 * board's.
 */
#ifndef LIMBER_REPLAY_H
#define LIMBER_REPLAY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "rod.h"
#include "scene_text.h"
#include "track.h"

/* What is around the rod; all zero is nothing. Borrowed. */
typedef struct {
    const char *scene_path, *shape_name; /* for the summary */
    const scene_text *objects;           /* where the track is */
    const rod_joint *shape_rad;          /* to take from the start on */
    float shape_strength_nm, shape_blend_s;
} replay_surroundings;

/* What came of one object. */
typedef struct {
    long ticks_n;             /* in which anything touched it */
    int nodes_n;              /* that touched it at once, at most */
    double force_most_newton; /* of all of them together */
    double deepest_m;         /* that any node was inside */
    double deepest_first_m; /* the same of the first tick alone: the rod is laid straight into it */
} replay_touch;

typedef struct {
    double peak_rad[2], rms_rad[2]; /* theta, phi */
    double lag_deg;                 /* behind joint 1, at the strongest frequency of joint 1 */
    bool lag_known;
    double
        limit_share; /* of the ticks, with either angle at its limit (contour's stop) or beyond (elastic) */
} replay_joint;

typedef struct {
    const track *source; /* borrowed */
    replay_surroundings around;
    scene objects; /* as the rod meets them: from the track's first sample */
    rod_params params;
    double rate_hz;
    long ticks_n;
    track_tick *ticks;       /* ticks_n */
    float *angles_rad;       /* ticks_n rows of 2 * links_n, theta before phi */
    touch_contact *contacts; /* of all ticks, one behind the other */
    size_t contacts_n, contacts_room;
    size_t *contacts_begin; /* ticks_n + 1 places in contacts; NULL where there are no objects */
    replay_touch touches[SCENE_OBJECTS_MAX];
    long restarts; /* after gaps */
    long
        restored_n; /* ticks after which links had to be made as long as they are: rod_restored_n */
    double step_median_us, step_p99_us, step_max_us;
    double lag_frequency_hz; /* 0 where joint 1 hardly moves */
    replay_joint joints[ROD_MAX_LINKS];
    uint64_t hash;
} replay;

/* Runs the whole track; around may be NULL. Returns SIM_OK, or an exit code after complaining. Shows a progress bar
 * on stderr where that is a terminal and the run is long. The caller frees with replay_free. */
int replay_run(const track *source, const rod_params *params, double rate_hz,
               const replay_surroundings *around, replay *out);
void replay_free(replay *r);

/* The nodes at a tick, 0 ... links_n, in the track's own place. */
void replay_nodes(const replay *r, long tick, double nodes_m[][3]);

const float *replay_angles(const replay *r, long tick);

/* What touched in a tick: *contacts_n of them, by node. */
const touch_contact *replay_contacts(const replay *r, long tick, int *contacts_n);

/* The force of all that touched in a tick, on the rod, N. */
vec3 replay_contact_force(const replay *r, long tick);

#endif
