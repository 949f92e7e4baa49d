/* control_commands.c - limber arm, disarm, estop, clear: one request each, and what came of it. */
#include <stdio.h>

#include "link_options.h"

typedef struct {
    const char *name;
    message_type request;
    const char *done;
    const char *examples;
} control;

/* An ESTOP goes out before anything else, so that no handshake delays it; the answered one follows. */
static void stop_first(const char *name)
{
    port p;
    port_why why;
    uint8_t wire[FRAME_WIRE_MAX];
    const message stop = {.type = MESSAGE_ESTOP, .estop = {1}};
    if (port_open(&p, name, why)) {
        const size_t n = messages_encode(&stop, 0, 0, (uint32_t)limber_now_us(), wire, sizeof wire);
        (void)port_write(&p, wire, n, why);
        port_close(&p);
    }
}

static int ask(const control *c, link_options *link, session *s)
{
    int result = link_choose(link);
    if (result == SIM_OK && c->request == MESSAGE_ESTOP) {
        stop_first(link->chosen);
    }
    if (result == SIM_OK) {
        result = session_start(s, link->chosen, 0.0f);
    }
    if (result == SIM_OK) {
        const message request = {.type = (uint8_t)c->request};
        result = session_request(s, &request);
    }
    if (result == SIM_OK) {
        s->heartbeat_known = false; /* the state from here on */
        result = session_wait_for_state(s);
    }
    if (result == SIM_OK) {
        printf("%s; state %s\n", c->done, session_state_name(s));
    }
    return result;
}

static int run(const control *c, int argc, const char **argv)
{
    link_options link = {0};
    const struct poptOption table[] = {LINK_PORT_OPTION(&link), OPTIONS_END};
    session s = {0};
    bool help;
    char title[32];
    snprintf(title, sizeof title, "limber %s", c->name);
    argv[0] = title; /* what the help calls it */
    poptContext context = poptGetContext(title, argc, argv, table, 0);
    int result = link_take_options(context, c->name, c->examples, &help);
    if (result == SIM_OK && !help) {
        result = link_no_more_arguments(context, c->name);
    }
    if (result == SIM_OK && !help) {
        result = ask(c, &link, &s);
    }
    poptFreeContext(context);
    link_close(&link, &s);
    return result;
}

int limber_arm_command(int argc, const char **argv)
{
    static const control ARM = {
        "arm", MESSAGE_ARM, "armed",
        "  limber arm --port pty:build/rod\n\n"
        "ARM wants a stream of poses to be there already; limber stream sends one and arms by "
        "itself.\n"};
    return run(&ARM, argc, argv);
}

int limber_disarm_command(int argc, const char **argv)
{
    static const control DISARM = {"disarm", MESSAGE_DISARM, "disarmed: the servos have no torque",
                                   "  limber disarm\n"
                                   "  limber disarm --port serial:/dev/ttyUSB0\n"};
    return run(&DISARM, argc, argv);
}

int limber_estop_command(int argc, const char **argv)
{
    static const control ESTOP = {
        "estop", MESSAGE_ESTOP, "stopped, latched; limber clear to go on",
        "  limber estop\n  limber estop --port tcp:127.0.0.1:5555\n\n"
        "Torque off within one tick. Whoever relies on it wires the e-stop input: a cable and a PC "
        "can fail.\n"};
    return run(&ESTOP, argc, argv);
}

int limber_clear_command(int argc, const char **argv)
{
    static const control CLEAR = {"clear", MESSAGE_CLEAR_FAULT, "cleared",
                                  "  limber info          # what had happened\n"
                                  "  limber clear\n"};
    return run(&CLEAR, argc, argv);
}
