/* stream.h - poses to the device, each at its moment, until they end, somebody stops it, or the device does.
 *
 *     begin     who is there, its counters, whether the source is fast enough
 *     arm       the first pose again and again until the device follows it (live: while they come)
 *     play      every pose at its own time; its age says by how much it was late
 *     end       disarm, counters again, where every pose went
 */
#ifndef LIMBER_STREAM_H
#define LIMBER_STREAM_H

#include <stdbool.h>
#include <stdint.h>

#include "account.h"
#include "angles_csv.h"
#include "delays.h"
#include "graphics.h"
#include "monitor_view.h"
#include "pose_track.h"
#include "session.h"
#include "source.h"
#include "stream_scene.h"

/* A live source may fall silent for so long that the device relaxes or goes limp; when poses come again it is armed
 * again, since that is what a live stream is for. A device that is lost is another matter: see rearm. */

typedef struct {
    const char *port;
    bool arm;            /* before the first pose, and disarm at the end */
    bool reconnect;      /* go on after the device was lost ... */
    bool rearm;          /* ... and arm it again */
    double speed;        /* times the track's own pace; 0: as fast as the line takes it */
    monitor_view *view;  /* open, to be drawn while it runs; NULL: a line of progress */
    pose_track *poses;   /* where the poses that the device used are written; NULL: nowhere */
    stream_scene *scene; /* what the rod touches; NULL: whatever the device has */
} stream_options;

typedef enum {
    ARMING_OFF,  /* not wanted, or not any more */
    ARMING_WAIT, /* until the device calls the stream good */
    ARMING_ASKED,
    ARMING_BLEND, /* torque is on, the rod comes to where it should be */
    ARMING_DONE,
    ARMING_FAILED, /* complained of */
} arming_phase;

typedef struct {
    stream_options options;
    source *source;
    angles_csv *csv;
    graphics *graphics; /* NULL: nobody draws */
    bool nodes_asked;   /* nodes_rate was 0 before we came */
    session s;
    bool in_session;

    arming_phase arming;
    uint64_t arming_us, asked_us; /* since when; when last asked */
    bool maybe_armed;             /* an ARM has been sent and no DISARM answered */
    int armings_n;                /* how often it came to ACTIVE by our ARM */
    uint8_t state;                /* newest from HEARTBEAT or ANGLES */

    uint64_t captured_us; /* of the last pose sent */
    uint64_t session_sent_n, lead_n, skipped_n, angles_n;
    uint64_t played_n;        /* of the source */
    double played_s;          /* source's time of the last one */
    uint64_t play_us, end_us; /* our clock as the play began and ended */
    uint64_t back_us;         /* when the device was found again */
    uint64_t progress_us;
    monitor_state monitor; /* for the view */
    uint32_t pings_n;
    bool pong_came;
    int reconnects_n;

    message_stats before;
    account account;
    pose_delays *delays;
    char device[48]; /* name and build */
    int links_n;
    bool interrupted;
    uint8_t end_state; /* before DISARM */
} stream;

/* Runs it all; what came of it is in *st. Returns an exit code after complaining of what went wrong.
 * options, source, csv and graphics (NULL: none) are the caller's. */
int stream_run(stream *st, const stream_options *options, source *src, angles_csv *csv,
               graphics *drawn);
void stream_free(stream *st);

/* --- within stream: stream.c ------------------------------------------------------------------------ */

/* Sends a pose captured at that moment of our clock. */
void stream_send(stream *st, const rod_pose *pose, uint64_t captured_us);

/* --- stream_session.c ------------------------------------------------------------------------------- */

/* Opens it, and asks for all that must be known before the first pose. SIM_OK, or an exit code after
 * complaining; it is closed then. */
int stream_open(stream *st);
/* The device is lost: asks again and again, as long as nobody says stop. SIM_OK with a new session, or
 * without one after an interrupt. */
int stream_find_again(stream *st);
/* Where the session's poses went. Some may still be on their way into a tick: asked again before anything is
 * called unaccounted for. SIM_OK, or LIMBER_DEVICE after complaining. */
int stream_settle(stream *st);

/* --- stream_arming.c -------------------------------------------------------------------------------- */

/* Refuses a source that the device would stop and start: SIM_OK or LIMBER_DEVICE after complaining. */
int stream_check_pace(stream *st);

void stream_begin_arming(stream *st);
/* To be called often: brings the arming one step further if it can. */
void stream_step_arming(stream *st);
/* Whether the device has stopped following though nobody told it to; complains. Live: where it only had to wait for
 * too long the arming begins anew, and that is said. */
bool stream_was_dropped(stream *st);
/* DISARM, if it may be armed. SIM_OK, or LIMBER_DEVICE after complaining. */
int stream_disarm(stream *st);

/* --- stream_graphics.c ------------------------------------------------------------------------------ */

/* Sees to it that the device sends NODES where somebody draws, and at the end that it is as it was. */
void stream_begin_graphics(stream *st);
void stream_end_graphics(stream *st);

/* --- stream_summary.c ------------------------------------------------------------------------------- */

void stream_show_progress(stream *st);
void stream_print_summary(const stream *st);
void stream_print_json(const stream *st, int exit_code);

#endif
