/* fake_device.c - see fake_device.h. */
#include "fake_device.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { BLEND_US = 60000, HOLD_US = 50000, RELAX_US = 500000 };

uint32_t fake_now_us(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    /* a clock of its own, that wraps while the tests run */
    return (uint32_t)((uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u) +
           0x7fff0000u;
}

void fake_tell(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    putchar('\n');
    fflush(stdout);
}

void fake_send(fake_device *d, const message *m)
{
    uint8_t wire[FRAME_WIRE_MAX];
    if (d->silent || d->ways.mute || (d->ways.deaf && m->type != MESSAGE_HEARTBEAT)) {
        return;
    }
    const size_t n =
        messages_encode(m, d->session, d->seq[m->type]++, fake_now_us(), wire, sizeof wire);
    if (d->ways.garbage) {
        uint8_t noise[40];
        for (size_t i = 0; i < sizeof noise; i++) {
            noise[i] = (uint8_t)rand();
        }
        fake_line_write(&d->line, noise, sizeof noise);
    }
    fake_line_write(&d->line, wire, n);
}

static void say_hello(fake_device *d, uint16_t request_id)
{
    message hello = {.type = MESSAGE_HELLO,
                     .hello = {request_id, PROTOCOL_MAJOR, PROTOCOL_MINOR, messages_layout_hash(),
                               FEATURE_SIMULATED | FEATURE_SETTINGS, 64,
                               (uint16_t)(d->ways.swing > 0 ? d->ways.swing : FAKE_JOINTS_N),
                               8000.0f, (float)d->ways.tick_hz, (float)d->ways.angles_hz, 0.0f, 0,
                               "fake", "0.0 test"}};
    if (d->ways.major > 0) {
        hello.hello.protocol_major = (uint8_t)d->ways.major;
    }
    hello.hello.protocol_minor = (uint8_t)(PROTOCOL_MINOR - d->ways.older);
    hello.hello.layout_hash += d->ways.other_hash;
    fake_send(d, &hello);
    fake_send(d, &(message){.type = MESSAGE_BOOT_REPORT,
                            .boot_report = {
                                .cause = RESET_POWER, .clock = CLOCK_HOST, .clock_hz = 168000000}});
}

static void take_hello(fake_device *d, const message_hello *hello, uint8_t session)
{
    fake_tell("hello %s %s pose_hz %g", hello->device, hello->build, (double)hello->pose_hz);
    if (d->ways.nack_type == MESSAGE_HELLO) {
        message nack = {.type = MESSAGE_NACK,
                        .nack = {.request_id = hello->request_id,
                                 .answered = MESSAGE_HELLO,
                                 .reason = (uint8_t)d->ways.nack_reason,
                                 .entry = -1,
                                 .text = "not with me"}};
        fake_send(d, &nack);
        return;
    }
    if (session != d->session) {
        d->any_pose = false;
    }
    d->session = session;
    d->greeted = true;
    say_hello(d, hello->request_id);
}

/* False: it did not come. */
static bool count_pose(fake_device *d, uint16_t seq, uint8_t session)
{
    d->poses_n++;
    if (d->ways.drop_poses > 0 && d->poses_n % (uint32_t)d->ways.drop_poses == 0) {
        return false;
    }
    if (session != d->session) {
        d->stats.poses_wrong_session++;
        return false;
    }
    const uint16_t ahead = (uint16_t)(seq - d->newest_seq);
    d->stats.poses_lost += d->any_pose ? (uint32_t)(ahead - 1) : 0;
    d->any_pose = true;
    d->newest_seq = seq;
    d->newest_us = fake_now_us();
    if (d->ways.reject_poses > 0 && d->poses_n % (uint32_t)d->ways.reject_poses == 0) {
        d->stats.poses_teleport++;
    } else {
        d->stats.poses_accepted++;
    }
    return true;
}

static void take_pose(fake_device *d, const message_pose *p, const frame *f)
{
    if (count_pose(d, f->seq, f->session)) {
        const float *x = p->position_m, *q = p->quaternion_xyzw;
        fake_tell("pose %u %u %u %a %a %a %a %a %a %a", f->seq, f->t_us, p->age_us, (double)x[0],
                  (double)x[1], (double)x[2], (double)q[0], (double)q[1], (double)q[2],
                  (double)q[3]);
    }
    const int n = (int)d->poses_n;
    if (n == d->ways.silent_after) {
        fake_tell("silent");
        d->silent = true;
    }
    if (n == d->ways.fall_after) {
        d->state = (uint8_t)d->ways.fall_to;
        if (d->state == DEVICE_FAULT) {
            d->fault = FAULT_CODE_DEADLINE;
            fake_send(d, &(message){.type = MESSAGE_FAULT,
                                    .fault = {.fault = d->fault, .text = "1200 us"}});
        }
    }
    if (n == d->ways.close_after) {
        fake_line_close(&d->line);
        fake_tell("closed");
        if (d->ways.reopen_ms == 0) {
            exit(0);
        }
        usleep((unsigned)d->ways.reopen_ms * 1000);
        if (d->ways.reboots) {
            memset(&d->stats, 0, sizeof d->stats);
            d->start_us = fake_now_us();
        }
        d->state = DEVICE_DISARMED;
        fake_line_open(&d->line, d->ways.pty_link);
    }
}

static void take(fake_device *d, const frame *f)
{
    message m;
    const uint32_t came_us = fake_now_us();
    d->stats.frames_good++;
    if (messages_unpack(f, &m) != MESSAGES_OK) {
        fake_tell("bad message %u", f->type);
        return;
    }
    switch (m.type) {
    case MESSAGE_HELLO:
        take_hello(d, &m.hello, f->session);
        break;
    case MESSAGE_TIMESYNC:
        d->stats.clock_exchanges += m.timesync.last_known;
        fake_send(d, &(message){.type = MESSAGE_TIMESYNC_ANSWER,
                                .timesync_answer = {m.timesync.t1_us, came_us, fake_now_us()}});
        break;
    case MESSAGE_PING:
        fake_send(d, &(message){.type = MESSAGE_PONG, .pong = {m.ping.token}});
        break;
    case MESSAGE_POSE:
        take_pose(d, &m.pose, f);
        break;
    case MESSAGE_PONG:
        break;
    default:
        if (m.type == MESSAGE_ESTOP && f->session == 0) {
            fake_tell("estop without a session");
        }
        fake_request(d, &m);
    }
}

static void step_state(fake_device *d, uint32_t now_us)
{
    const uint32_t silence_us = d->any_pose ? now_us - d->newest_us : UINT32_MAX;
    if (d->state == DEVICE_ARMING && now_us - d->armed_us > BLEND_US && !d->ways.still) {
        d->state = DEVICE_ACTIVE;
    } else if (d->state == DEVICE_ACTIVE && silence_us > HOLD_US) {
        d->state = DEVICE_HOLD;
        d->stats.holds++;
    } else if (d->state == DEVICE_HOLD) {
        d->state = silence_us > RELAX_US  ? DEVICE_RELAX
                   : silence_us < HOLD_US ? DEVICE_ACTIVE
                                          : DEVICE_HOLD;
    }
}

static void report(fake_device *d, uint32_t now_us)
{
    const bool good = d->any_pose && now_us - d->newest_us < HOLD_US;
    fake_send(
        d, &(message){.type = MESSAGE_HEARTBEAT,
                      .heartbeat = {d->state, d->fault, (uint8_t)(good ? HEARTBEAT_POSES_GOOD : 0),
                                    (now_us - d->start_us) / 1000, d->tick, 0, 20, 30}});
}

static void send_angles(fake_device *d, uint32_t now_us)
{
    message m = {.type = MESSAGE_ANGLES,
                 .angles = {.tick = d->tick,
                            .pose_seq = d->newest_seq,
                            .state = d->state,
                            .flags = d->any_pose ? 0 : ANGLES_NO_POSE,
                            .angles_n = FAKE_JOINTS_N}};
    const uint32_t ago_us = now_us - d->newest_us;
    m.angles.received_ago_us = (uint16_t)(ago_us < 65535 ? ago_us : 65535);
    m.angles.solved_ago_us = (uint16_t)(m.angles.received_ago_us / 4);
    m.angles.angles_tenth_mrad[0][0] = (int16_t)(d->tick % 1000);
    m.angles.angles_tenth_mrad[2][1] = MESSAGES_ANGLE_INVALID;
    if (d->ways.swing > 0) {
        fake_swing_angles(d, &m.angles);
    }
    fake_send(d, &m);
}

void fake_run(fake_device *d)
{
    uint32_t beat_us = fake_now_us(), angles_us = beat_us;
    for (;;) {
        uint8_t bytes[4096];
        frame f;
        const size_t n = fake_line_read(&d->line, bytes, sizeof bytes, 1);
        for (size_t i = 0; i < n; i++) {
            if (frame_decoder_push(&d->decoder, bytes[i], &f)) {
                take(d, &f);
            }
        }
        const uint32_t now_us = fake_now_us();
        d->tick =
            (uint32_t)((uint64_t)(now_us - d->start_us) * (uint64_t)d->ways.tick_hz / 1000000);
        if (d->ways.swing > 0) {
            fake_swing(d, now_us);
        }
        step_state(d, now_us);
        if (now_us - beat_us >= 100000) {
            beat_us = now_us;
            report(d, now_us);
            if (d->ways.text != NULL) {
                fake_line_write(&d->line, d->ways.text, strlen(d->ways.text));
            }
        }
        if (d->greeted && now_us - angles_us >= 1000000u / (unsigned)d->ways.angles_hz) {
            angles_us = now_us;
            send_angles(d, now_us);
        }
    }
}
