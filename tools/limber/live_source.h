/* live_source.h - poses that come while they are made: one interface, three kinds.
 *
 *     -                                  TUM lines on standard input
 *     vrpn:TRACKER@HOST[:PORT][#SENSOR]  a VRPN server, by TCP: OptiTrack, Vicon, most labs (port 3883, sensor 0)
 *     osc:[ADDRESS:]PORT[#SERIAL]        /VMC/Ext/Tra/Pos by UDP: Vive and VMC apps, Unity, phones (on 127.0.0.1,
 *                                        the first tracker that is heard)
 *
 * One clock rule: a pose is as old as its way here. Where the source writes times (VRPN) the quickest pose of the
 * last seconds counts as having come at once, and the others are older by what they took longer; where it does
 * not (OSC, lines) a pose was captured when it arrived. All of it on limber_now_us's clock.
 *
 * A source may fall silent, go and come back: that is said on stderr, counted, and never an error. What is no
 * pose is counted too, whatever it is. Memory is bounded: what open takes, and no more. All from one
 * thread; nothing blocks but open, while it looks up a name.
 */
#ifndef LIMBER_LIVE_SOURCE_H
#define LIMBER_LIVE_SOURCE_H

#include <stdbool.h>
#include <stdint.h>

#include "live_source_pace.h"
#include "track.h"

enum {
    LIVE_NAME_BYTES = 200,
    LIVE_POSES_MAX_HZ = 2000, /* of networks: more than this, but for bursts of 50, are left out */
};

typedef struct live_source live_source;

typedef struct {
    const char *prefix; /* "vrpn:" */
    bool timed;         /* samples' t_s is when they were captured, by the source's clock */
    bool waits;         /* what is not read yet waits: then no number of poses is too many */
    bool unity;         /* left-handed and y up, unless told otherwise */
    /* `where` is the name after the prefix. Fills state. SIM_OK, or SIM_BAD_INPUT after complaining. */
    int (*open)(live_source *s, const char *where);
    /* Takes what there is, at most one buffer full; also called, from time to time, when there is nothing.
     * Fills arrived_us. */
    void (*read)(live_source *s, bool readable);
    /* The next pose in the buffer, axes and units as sent; its numbers may be anything. */
    bool (*next)(live_source *s, track_sample *sample);
    void (*close)(live_source *s);
} live_kind;

extern const live_kind live_lines_kind, live_vrpn_kind, live_osc_kind;

/* Where what came has gone, beside the poses. */
typedef struct {
    long unreadable;     /* damaged, or not of the kind that was expected */
    long others;         /* of other trackers, sensors and addresses */
    long blind;          /* without an orientation, all zeros: the tracker sees nothing */
    long too_many;       /* beyond LIVE_POSES_MAX_HZ */
    long connections;    /* VRPN: how often there was one */
    long clock_restarts; /* the source's clock jumped by more than a second */
} live_counts;

/* The source's clock, seen from here. */
typedef struct {
    bool begun;
    int64_t offset_us[2]; /* ours minus its: least of this window and of the one before */
    uint64_t window_us;   /* our time as this window began */
    int64_t last_us;      /* its time of the last pose */
} live_clock;

struct live_source {
    const live_kind *kind;
    const char *name; /* as given; the caller's */
    int fd;           /* to wait for; -1: none at the moment */
    bool ended;       /* lines only: there is no more to come */
    uint64_t arrived_us;
    live_counts counts;
    live_pace *pace;
    void *state; /* the kind's own */

    /* private */
    live_clock clock;
    uint64_t credit_us, credited_us; /* of poses that may come at once */
};

/* The kind that a name stands for; NULL: it is a file's. "-" is for whoever knows that it is no file. */
const live_kind *live_source_kind(const char *name);

/* SIM_OK, or SIM_BAD_INPUT after complaining. Close it with live_source_close in any case. */
int live_source_open(live_source *s, const live_kind *kind, const char *name);
void live_source_close(live_source *s);

/* Takes what there is, if there is something, and keeps the connection up; to be called at least every 50 ms. */
void live_source_read(live_source *s, bool readable);

/* The next pose of what has been read, its numbers finite, and when it was captured. False: no more of them; says it
 * when the source has just fallen silent. */
bool live_source_next(live_source *s, track_sample *sample, uint64_t *captured_us);

/* Forgets what came while nobody was reading; returns how many poses that were. */
long live_source_skip(live_source *s);

/* No pose yet, or none for longer than it usually takes. */
bool live_source_is_silent(const live_source *s);

/* Splits "HOST:PORT", "[HOST]:PORT" in place. False where there is no such PORT from 1 to 65535; without one at
 * all *port is left as it is. */
bool live_source_split(char *text, char **host, const char **port);

#endif
