/* fake_main.c - how the fake device is to misbehave, from the command line. */
#include <popt.h>
#include <stdio.h>

#include "fake_device.h"

#define NUMBER(name, member)                                                                       \
    {                                                                                              \
        name, 0, POPT_ARG_INT, &d.ways.member, 0, NULL, NULL                                       \
    }
#define SWITCH(name, value)                                                                        \
    {                                                                                              \
        name, 0, POPT_ARG_VAL, &value, 1, NULL, NULL                                               \
    }

int main(int argc, char **argv)
{
    static fake_device d = {.ways = {.tick_hz = 1000, .angles_hz = 200, .state = DEVICE_DISARMED}};
    int mute = 0, deaf = 0, other_hash = 0, garbage = 0, reboots = 0, still = 0;
    const struct poptOption table[] = {{"pty", 0, POPT_ARG_STRING, &d.ways.pty_link, 0, NULL, NULL},
                                       {"text", 0, POPT_ARG_STRING, &d.ways.text, 0, NULL, NULL},
                                       {"hold", 0, POPT_ARG_FLOAT, &d.ways.hold_ms, 0, NULL, NULL},
                                       NUMBER("major", major),
                                       NUMBER("older", older),
                                       NUMBER("state", state),
                                       NUMBER("angles-hz", angles_hz),
                                       NUMBER("nack", nack_type),
                                       NUMBER("reason", nack_reason),
                                       NUMBER("drop-requests", drop_requests),
                                       NUMBER("drop-poses", drop_poses),
                                       NUMBER("swing", swing),
                                       NUMBER("reject-poses", reject_poses),
                                       NUMBER("lie", lie),
                                       NUMBER("silent-after", silent_after),
                                       NUMBER("close-after", close_after),
                                       NUMBER("fall-after", fall_after),
                                       NUMBER("fall-to", fall_to),
                                       NUMBER("reopen-ms", reopen_ms),
                                       SWITCH("mute", mute),
                                       SWITCH("deaf", deaf),
                                       SWITCH("other-hash", other_hash),
                                       SWITCH("garbage", garbage),
                                       SWITCH("reboots", reboots),
                                       SWITCH("still", still),
                                       POPT_TABLEEND};
    poptContext context = poptGetContext(NULL, argc, (const char **)argv, table, 0);
    const int wrong = poptGetNextOpt(context);
    if (wrong != -1) {
        fprintf(stderr, "fake_device: %s\n", poptStrerror(wrong));
        return 2;
    }
    d.ways.mute = mute || d.ways.text != NULL;
    d.ways.deaf = deaf;
    d.ways.other_hash = other_hash;
    d.ways.garbage = garbage;
    d.ways.reboots = reboots;
    d.ways.still = still;
    d.state = (uint8_t)d.ways.state;
    d.fault = d.state == DEVICE_FAULT ? FAULT_CODE_DEADLINE : FAULT_CODE_NONE;
    d.start_us = fake_now_us();
    frame_decoder_init(&d.decoder);
    fake_requests_init(&d);
    fake_line_open(&d.line, d.ways.pty_link);
    fake_run(&d);
}
