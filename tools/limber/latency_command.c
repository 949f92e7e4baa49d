/* latency_command.c - limber latency: still poses to a device without torque, and how long they take. */
#include <stdio.h>
#include <stdlib.h>

#include "delays.h"
#include "interrupt.h"
#include "link_options.h"
#include "progress.h"
#include "texts.h"

enum { OPTION_SECONDS = 1, OPTION_RATE, OPTION_HISTOGRAM };

static const char EXAMPLES[] =
    "  limber latency\n"
    "  limber latency --seconds 30 --rate 500 --port serial:/dev/ttyUSB0\n"
    "  limber latency --histogram\n"
    "  limber latency --json | jq .latency.whole.p99_ms\n\n"
    "Sends a pose that does not move and waits for the angles it led to: the whole way and its "
    "three parts. The reply\n"
    "waits for the turn of ANGLES, which come at angles_rate (limber params). Servos and tracker "
    "come on top.\n"
    "--histogram: how many poses took how long, in bars of equal width; where a few took very "
    "long, at most one in a\n"
    "hundred, the last bar has them all. With --json: latency.histogram.\n";

typedef struct {
    pose_delays *delays;
    const clock_sync *clock;
} listening;

static void listen(void *context, const message *m, const frame *f, uint64_t at_us)
{
    listening *l = context;
    if (m->type == MESSAGE_ANGLES) {
        pose_delays_angles(l->delays, &m->angles, f->t_us, at_us, l->clock);
    }
}

/* Poses would move it. */
static int refuse_if_armed(const session *s)
{
    switch (s->heartbeat.state) {
    case DEVICE_ARMING:
    case DEVICE_ACTIVE:
    case DEVICE_HOLD:
    case DEVICE_RELAX:
        return limber_refuse("the device is %s: the still pose would move it; limber disarm first",
                             session_state_name(s));
    default:
        return SIM_OK;
    }
}

static int measure(session *s, listening *l, double seconds, double rate_hz)
{
    pose_delays *const d = l->delays;
    const message pose = {.type = MESSAGE_POSE,
                          .pose = {.quaternion_xyzw = {0.0f, 0.0f, 0.0f, 1.0f},
                                   .quality = UINT8_MAX,
                                   .source = SOURCE_SYNTHETIC}};
    const long poses_n = (long)(seconds * rate_hz);
    pose_delays_session(d, s->device.tick_hz);
    s->listener = listen;
    s->context = l;
    interrupt_catch();
    const uint64_t start_us = limber_now_us();
    for (long n = 0; n <= poses_n && !s->lost && !interrupt_came(); n++) {
        /* an odd fraction of the interval is added, so that poses meet ANGLES in all phases */
        const double phase = (double)(n % 7) / 7.0 * 0.5;
        const uint64_t due_us = start_us + (uint64_t)(((double)n + phase) / rate_hz * 1e6);
        while (limber_now_us() < due_us && !s->lost && !interrupt_came()) {
            (void)session_step(s, due_us, -1);
        }
        if (n < poses_n) {
            pose_delays_sent(d, session_next_seq(s, MESSAGE_POSE), limber_now_us());
            (void)session_send(s, &pose);
        }
        if (n % 20 == 0) {
            progress_show("%.1f of %.1f s", (double)n / rate_hz, seconds);
        }
    }
    for (const uint64_t end_us = limber_now_us() + 100000; limber_now_us() < end_us && !s->lost;) {
        (void)session_step(s, end_us, -1); /* the last ones are still on their way */
    }
    progress_clear();
    if (s->lost) {
        return session_complain(s);
    }
    return d->whole.n > 0 ? SIM_OK
                          : limber_refuse("no ANGLES came back with a pose of ours; limber info "
                                          "tells what became of the poses");
}

static void print(const session *s, const pose_delays *d, bool json, bool histogram)
{
    const int error_us = clock_sync_error_us(&s->clock, limber_now_us());
    if (json) {
        cJSON *const all = cJSON_CreateObject();
        cJSON_AddStringToObject(all, "port", s->name);
        cJSON_AddStringToObject(all, "device", s->device.device);
        cJSON_AddNumberToObject(all, "sent", (double)d->sent_n);
        cJSON_AddNumberToObject(all, "clock_error_us", error_us);
        cJSON *const latency = pose_delays_json(d);
        if (histogram) {
            cJSON_AddItemToObject(latency, "histogram", delays_bars_json(&d->whole));
        }
        cJSON_AddItemToObject(all, "latency", latency);
        texts_print_json(all);
        return;
    }
    pose_delays_print(d, stdout);
    if (histogram) {
        printf("histogram  of pose -> angles, ms, and how many poses\n");
        delays_print_bars(&d->whole, stdout);
    }
    printf(
        "clocks     known to within %d us: so far line and reply may be off against each other\n",
        error_us);
    printf("angles     come %g times a second: on average the reply waits %.2f ms for its turn\n",
           (double)s->device.angles_hz,
           s->device.angles_hz > 0.0f ? 500.0 / (double)s->device.angles_hz : 0.0);
}

static int run(poptContext context, link_options *link, session *s)
{
    double seconds = 5.0, rate_hz = 200.0;
    bool histogram = false;
    int result = SIM_OK;
    for (int option;
         result == SIM_OK && (option = options_next(context, "latency", EXAMPLES)) != 0;) {
        if (option == OPTION_HELP) {
            return SIM_OK;
        }
        if (option < 0) {
            return SIM_BAD_INPUT;
        }
        if (option == OPTION_HISTOGRAM) {
            histogram = true;
            continue;
        }
        char *const text = poptGetOptArg(context);
        result = option == OPTION_SECONDS ? link_number("--seconds", text, 0.1, 1e5, &seconds)
                                          : link_number("--rate", text, 1.0, 2000.0, &rate_hz);
        free(text);
    }
    if (result == SIM_OK) {
        result = link_no_more_arguments(context, "latency");
    }
    if (result == SIM_OK) {
        result = link_open(link, s);
    }
    if (result == SIM_OK) {
        result = session_wait_for_state(s);
    }
    if (result == SIM_OK) {
        result = refuse_if_armed(s);
    }
    if (result != SIM_OK) {
        return result;
    }
    pose_delays *const d = pose_delays_new();
    listening l = {d, &s->clock};
    result = d == NULL ? SIM_INTERNAL : measure(s, &l, seconds, rate_hz);
    if (result == SIM_OK) {
        print(s, d, link->json != 0, histogram);
    }
    free(d);
    return result;
}

int limber_latency_command(int argc, const char **argv)
{
    link_options link = {0};
    const struct poptOption table[] = {
        LINK_PORT_OPTION(&link),
        LINK_JSON_OPTION(&link),
        {"seconds", 0, POPT_ARG_STRING, NULL, OPTION_SECONDS, "for so long (5)", "S"},
        {"histogram", 0, POPT_ARG_NONE, NULL, OPTION_HISTOGRAM, "and how they are spread", NULL},
        {"rate", 'r', POPT_ARG_STRING, NULL, OPTION_RATE, "poses a second (200)", "HZ"},
        OPTIONS_END};
    session s = {0};
    argv[0] = "limber latency"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    const int result = run(context, &link, &s);
    poptFreeContext(context);
    link_close(&link, &s);
    return result;
}
