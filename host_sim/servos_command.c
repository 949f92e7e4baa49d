/* servos_command.c - limber-sim servos: smart servos on a port of their own, for a board that is not there: QEMU's
 * sixth serial port, or a USB adapter's bus at the other end of a cable. */
#include <math.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bus_model.h"
#include "live.h"
#include "options.h"
#include "sim.h"

enum {
    OPTION_PTY = 1,
    OPTION_TCP,
    OPTION_COUNT,
    OPTION_BAUD,
    OPTION_FACTORY,
    OPTION_ECHO,
    OPTION_INJECT,
};
enum { AT_ONCE_BAUD = 100000000 }; /* an emulated board's bytes take no time either */

#define STEP_S 0.0005f /* the servos turn in steps of it */

static const char EXAMPLES[] =
    "  limber-sim servos --pty build/servos --count 100\n"
    "  qemu-system-arm ... -chardev serial,id=bus,path=build/servos -serial chardev:bus\n"
    "  limber-sim servos --tcp 127.0.0.1:5556 --inject unplug@10+5:3 --inject garble@20+5:0.01\n\n"
    "The sixth -serial is the emulated board's USART6, the servo bus. The port does not tell a "
    "baud\n"
    "rate: the servos understand whatever comes. They have power from the start. Ends with Ctrl-C, "
    "and\n"
    "then prints what it has seen.\n";

typedef struct {
    char *pty, *tcp;
    double count;
    uint32_t baud, set_baud; /* of the wire; what the servos are set to */
    int echo;
    injection script;
} choices;

typedef struct {
    line line;
    servo_plant plant;
    bus_model bus;
    uint32_t lost_n; /* bytes that found no room: sent faster than the wire is */
} servos_world;

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

/* Until bytes come, something happens on the wire, or it is time for the next step. */
static void wait_for_bytes(const servos_world *w, double time_s)
{
    const double to_next_s = bus_wire_next_s(&w->bus.wire) - time_s;
    const double most_s = fmin(fmax(to_next_s, 0.0), (double)STEP_S);
    const struct timespec most = {.tv_nsec = (long)(most_s * 1e9)};
    struct pollfd poll_for = {.fd = w->line.fd, .events = POLLIN};
    (void)ppoll(&poll_for, 1, &most, NULL);
}

static void step(servos_world *w, const injection *script, double time_s)
{
    uint8_t bytes[1024];
    size_t n = line_read(&w->line, bytes, sizeof bytes);
    if (n > 0 && !bus_wire_send(&w->bus.wire, bytes, n, time_s)) {
        w->lost_n += (uint32_t)n;
    }
    bus_model_inject(&w->bus, script, time_s);
    bus_model_run(&w->bus, time_s);
    /* in one piece, so that what this machine does in between is no gap in an answer */
    n = bus_wire_read_whole(&w->bus.wire, bytes, sizeof bytes, time_s);
    (void)line_write(&w->line, bytes, n);
    line_flush(&w->line);
}

static void run(servos_world *w, const injection *script)
{
    const double start_s = now_s();
    for (double turned_s = 0.0, time_s = 0.0; !live_asked_to_stop();) {
        wait_for_bytes(w, time_s);
        time_s = now_s() - start_s;
        step(w, script, time_s);
        for (; turned_s < time_s; turned_s += (double)STEP_S) {
            servo_plant_tick(&w->plant, STEP_S);
        }
    }
}

static void print_counts(const servos_world *w)
{
    const bus_counts *c = &w->bus.counts;
    uint32_t torque_n = 0;
    for (int i = 0; i < w->bus.servos_n; i++) {
        torque_n += w->bus.servos[i].torque_n;
    }
    printf("ping         %u\nread         %u\nwrite        %u\nsync read    %u\nsync write   %u\n"
           "reboot       %u\nunknown      %u\ndamaged      %u\nanswers      %u\nrefused      %u\n"
           "clashes      %u\ngoals        %u\ntorque on    %u\nbytes lost   %u\n",
           c->pings, c->reads, c->writes, c->sync_reads, c->sync_writes, c->reboots, c->unknown,
           c->damaged, c->replies, c->refused, c->shared + w->bus.wire.clashes, c->goals, torque_n,
           w->lost_n);
}

static int serve(const choices *c)
{
    servos_world *w = calloc(1, sizeof *w);
    if (w == NULL) {
        return sim_give_up("out of memory");
    }
    servo_plant_init(&w->plant, 6, 15.0f); /* 3 ms late, as limber-sim device has them */
    bus_model_init(&w->bus, &w->plant, (int)c->count, c->set_baud);
    bus_wire_start(&w->bus.wire, c->baud);
    w->plant.powered = true;
    w->bus.any_baud = true;
    w->bus.wire.echo = c->echo != 0;
    w->line = (line){.fd = -1, .listen_fd = -1, .kept_fd = -1};
    const int result = live_open_line(&w->line, "limber-sim servos: ", c->pty, c->tcp);
    if (result == SIM_OK) {
        live_catch_signals();
        run(w, &c->script);
        print_counts(w);
    }
    line_close(&w->line);
    free(w);
    return result;
}

static int take_option(choices *c, int option, const char *text)
{
    switch (option) {
    case OPTION_PTY:
        return live_text(&c->pty, text);
    case OPTION_TCP:
        return live_text(&c->tcp, text);
    case OPTION_COUNT:
        return options_number("--count", text, 1.0, (double)SERVO_COUNT_MAX, &c->count);
    case OPTION_BAUD:
        return live_servo_baud("--baud", text, &c->baud);
    case OPTION_FACTORY:
        c->count = 1.0;
        c->set_baud = BUS_SERVO_FACTORY_BAUD;
        return SIM_OK;
    default:
        return injection_add(&c->script, text);
    }
}

static int take_options(poptContext context, choices *c, bool *help)
{
    int result = SIM_OK;
    *help = false;
    for (int option;
         result == SIM_OK && (option = options_next(context, "servos", EXAMPLES)) != 0;) {
        if (option < 0) {
            return SIM_BAD_INPUT;
        }
        if (option == OPTION_HELP) {
            *help = true;
            return SIM_OK;
        }
        char *text = poptGetOptArg(context);
        result = take_option(c, option, text);
        free(text);
    }
    if (result == SIM_OK && poptPeekArg(context) != NULL) {
        return sim_complain("servos: unexpected '%s'; try limber-sim servos --help",
                            poptPeekArg(context));
    }
    return result == SIM_OK && (c->pty == NULL) == (c->tcp == NULL)
               ? sim_complain("servos: give either --pty LINK or --tcp ADDRESS:PORT")
               : result;
}

int sim_servos_command(int argc, const char **argv)
{
    choices c = {.count = 8.0, .baud = AT_ONCE_BAUD, .set_baud = 1000000};
    const struct poptOption table[] = {
        {"pty", 0, POPT_ARG_STRING, NULL, OPTION_PTY, "be found as a serial port under this name",
         "LINK"},
        {"tcp", 0, POPT_ARG_STRING, NULL, OPTION_TCP, "listen there for one controller at a time",
         "ADDRESS:PORT"},
        {"count", 0, POPT_ARG_STRING, NULL, OPTION_COUNT, "servos, with ids 1, 2, ... (8)", "N"},
        {"baud", 0, POPT_ARG_STRING, NULL, OPTION_BAUD, "bytes take the time of this rate (none)",
         "BAUD"},
        {"factory", 0, POPT_ARG_NONE, NULL, OPTION_FACTORY,
         "one servo as it comes from the factory: id 1, 57600 baud", NULL},
        {"echo", 0, POPT_ARG_NONE, &c.echo, 0, "the controller hears itself", NULL},
        {"inject", 0, POPT_ARG_STRING, NULL, OPTION_INJECT,
         "let something go wrong: servo, unplug (ID), lose, garble (share), slow (s)",
         "KIND@START[+SECONDS][:AMOUNT]"},
        OPTIONS_END,
    };
    argv[0] = "limber-sim servos"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    bool help;
    int result = take_options(context, &c, &help);
    if (result == SIM_OK && !help) {
        result = serve(&c);
    }
    free(c.pty);
    free(c.tcp);
    poptFreeContext(context);
    return result;
}
