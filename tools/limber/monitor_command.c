/* monitor_command.c - limber monitor: a session that only watches, drawn live or told once a second. */
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "interrupt.h"
#include "link_options.h"
#include "monitor_state.h"
#include "monitor_text.h"
#include "monitor_view.h"
#include "stats_request.h"

enum {
    OPTION_PLAIN = 1,
    OPTION_SECONDS,
    DRAW_US = 100000,
    TELL_US = 1000000,
    RETRY_US = 250000,
};

static const char EXAMPLES[] =
    "  limber monitor\n"
    "  limber monitor --port pty:build/rod\n"
    "  limber monitor --plain --seconds 60 | tee monitor.txt\n\n"
    "Shows state and fault, rates, the limits that act, counters (\"+3\": grew by 3 just now) and "
    "every joint's angles.\n"
    "q or Ctrl-C ends it. --plain, or no terminal: a line a second. A device that is lost is "
    "waited for.\n"
    "It only watches, in a session of its own: it never arms, disarms, sets anything or sends "
    "poses. A port has one owner:\n"
    "while another program talks to the device, limber monitor is refused and the device not "
    "disturbed.\n";

typedef struct {
    session *session;
    monitor_state state;
    monitor_view view;
    bool plain;
    uint64_t start_us, end_us, due_us, retry_us;
} monitor;

static void listen(void *context, const message *m, const frame *f, uint64_t at_us)
{
    (void)at_us;
    monitor_state_take(context, m, f->t_us);
}

static void begin(monitor *w)
{
    monitor_state_begin(&w->state, w->session->name, &w->session->device);
    w->session->listener = listen;
    w->session->context = &w->state;
    session_ask(w->session, &(message){.type = MESSAGE_STATS_GET}); /* the others come unasked */
}

/* Another try to find a device that was lost; it may take a second. */
static void look_again(monitor *w)
{
    session *const s = w->session;
    if (session_open(s, s->name, 0.0f)) {
        begin(w);
    } else {
        w->retry_us = limber_now_us() + RETRY_US;
    }
}

static void follow(monitor *w, int keys_fd)
{
    session *const s = w->session;
    const uint64_t now_us = limber_now_us();
    if (!w->state.connected && now_us >= w->retry_us) {
        look_again(w);
    } else if (!w->state.connected) {
        (void)port_wait(&(port){.fd = -1}, keys_fd, DRAW_US);
    } else if (s->lost) {
        monitor_state_lost(&w->state, s->why);
        session_close(s);
        w->due_us = 0;
        w->retry_us = now_us + RETRY_US;
    } else {
        (void)session_step(s, w->due_us < w->end_us ? w->due_us : w->end_us, keys_fd);
    }
}

static void show(monitor *w)
{
    const uint64_t now_us = limber_now_us();
    monitor_state_refresh(&w->state, now_us);
    if (now_us < w->due_us) {
        return;
    }
    const uint64_t period_us = w->plain ? TELL_US : DRAW_US;
    w->due_us = now_us < w->due_us + period_us ? w->due_us + period_us : now_us + period_us;
    if (w->plain) {
        monitor_text_line(&w->state, (double)(now_us - w->start_us) * 1e-6, stdout);
    } else {
        monitor_view_draw(&w->view, &w->state);
    }
}

static void watch(monitor *w)
{
    /* keys of a file or pipe are none */
    const int keys_fd = !w->plain && isatty(STDIN_FILENO) != 0 ? STDIN_FILENO : -1;
    while (!interrupt_came() && limber_now_us() < w->end_us && ferror(stdout) == 0 &&
           (keys_fd < 0 || monitor_view_keys(&w->view))) {
        show(w);
        follow(w, keys_fd);
    }
}

static int run(monitor *w, double seconds)
{
    interrupt_catch();
    w->start_us = limber_now_us();
    w->end_us = w->start_us + (uint64_t)(seconds * 1e6);
    monitor_state_init(&w->state);
    begin(w);
    w->plain = w->plain || !monitor_view_possible() || !monitor_view_open(&w->view);
    w->due_us = w->start_us + (w->plain ? TELL_US : DRAW_US); /* rates need a while */
    watch(w);
    if (!w->plain) {
        monitor_view_close(&w->view);
    }
    return w->state.connected ? SIM_OK : limber_refuse("lost the device: %s", w->state.why);
}

static int take_options(poptContext context, monitor *w, double *seconds, bool *help)
{
    int result = SIM_OK;
    *help = false;
    for (int option;
         result == SIM_OK && (option = options_next(context, "monitor", EXAMPLES)) != 0;) {
        if (option < 0) {
            return SIM_BAD_INPUT;
        }
        if (option == OPTION_HELP) {
            *help = true;
            return SIM_OK;
        }
        if (option == OPTION_PLAIN) {
            w->plain = true;
            continue;
        }
        char *const text = poptGetOptArg(context);
        result = link_number("--seconds", text, 0.1, 1e9, seconds);
        free(text);
    }
    return result == SIM_OK ? link_no_more_arguments(context, "monitor") : result;
}

int limber_monitor_command(int argc, const char **argv)
{
    link_options link = {0};
    const struct poptOption table[] = {
        LINK_PORT_OPTION(&link),
        {"plain", 0, POPT_ARG_NONE, NULL, OPTION_PLAIN, "a line a second, on any output", NULL},
        {"seconds", 0, POPT_ARG_STRING, NULL, OPTION_SECONDS, "for so long (until q or Ctrl-C)",
         "S"},
        OPTIONS_END};
    session s = {0};
    monitor w = {.session = &s};
    double seconds = 1e9;
    bool help;
    argv[0] = "limber monitor"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    int result = take_options(context, &w, &seconds, &help);
    if (result == SIM_OK && !help) {
        result = link_open(&link, &s);
    }
    if (result == SIM_OK && !help) {
        result = run(&w, seconds);
    }
    poptFreeContext(context);
    link_close(&link, &s);
    return result;
}
