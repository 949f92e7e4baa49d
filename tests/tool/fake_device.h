/* fake_device.h - a device that does what a test wants, not what a rod needs: the wire from the device's end,
 * by the same proto/, with a choice of misbehaviour. It tells on stdout what it got. */
#ifndef LIMBER_FAKE_DEVICE_H
#define LIMBER_FAKE_DEVICE_H

#include <stdbool.h>
#include <stdint.h>

#include "fake_line.h"
#include "messages.h"

enum { FAKE_PARAMS_N = 6, FAKE_JOINTS_N = 3, FAKE_OBJECTS_N = 8 };

/* How it misbehaves; all zeros: not at all. */
typedef struct {
    const char *pty_link, *text; /* text: says only that, like a board of another make */
    bool mute, deaf, other_hash, garbage, reboots, still;
    int older; /* protocol minors that it is behind */
    int major, state, tick_hz, angles_hz, nack_type, nack_reason;
    int drop_requests;            /* ignores each request so many times */
    int drop_poses, reject_poses; /* every so-many-th */
    int swing;                    /* joints that move as if poses came: fake_swing.c */
    int lie;                      /* counts so many fewer accepted poses in the end */
    int silent_after, close_after, fall_after, fall_to; /* poses; the state then */
    int reopen_ms;
    float hold_ms;
} fake_ways;

typedef struct {
    fake_ways ways;
    fake_line line;
    frame_decoder decoder;
    uint8_t session, state, fault;
    uint16_t seq[256];
    message_stats stats;
    uint32_t start_us, armed_us, tick;
    bool any_pose, silent, greeted;
    uint16_t newest_seq;
    uint32_t newest_us, poses_n;
    uint16_t last_request;
    int ignored_n;
    message_scene_put objects[FAKE_OBJECTS_N];
    float in_force[FAKE_PARAMS_N][FAKE_JOINTS_N], staged[FAKE_PARAMS_N][FAKE_JOINTS_N];
} fake_device;

uint32_t fake_now_us(void);
void fake_send(fake_device *d, const message *m);

/* A line on stdout for the test. */
void fake_tell(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Until the process is killed; ways and state are set. */
void fake_run(fake_device *d);

/* fake_requests.c: everything with a request id but HELLO. */
void fake_requests_init(fake_device *d);
void fake_request(fake_device *d, const message *m);
void fake_tell_stats(fake_device *d, uint16_t request_id); /* 0: unasked */

void fake_ack(fake_device *d, const message *m);
void fake_nack(fake_device *d, const message *m, message_nack why);

/* fake_scene.c */
void fake_scene_put(fake_device *d, const message *m);
void fake_scene_show(fake_device *d, const message *m);
void fake_shape(fake_device *d, const message *m);

/* fake_swing.c: a device that somebody moves, to be watched. To be called often. */
void fake_swing(fake_device *d, uint32_t now_us);
void fake_swing_angles(const fake_device *d, message_angles *angles);

#endif
