/* device_command.c - limber-sim device: a board without a board, for the tool that will talk to the real one. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "host_device.h"
#include "live.h"
#include "options.h"
#include "scene_text.h"
#include "shape_text.h"
#include "sim.h"

enum {
    OPTION_PTY = 1,
    OPTION_TCP,
    OPTION_SPEED,
    OPTION_LOG,
    OPTION_FLASH,
    OPTION_LINKS,
    OPTION_BAUD,
    OPTION_INJECT,
    OPTION_SECONDS,
    OPTION_RATE,
    OPTION_SERVOS,
    OPTION_SERVO_BAUD,
    OPTION_FACTORY,
    OPTION_ECHO,
    OPTION_SCENE,
};

static const char EXAMPLES[] =
    "  limber-sim device --pty build/rod                        # one terminal\n"
    "  limber stream --port pty:build/rod build/tracks/star.txt # another\n"
    "  limber-sim device --tcp 127.0.0.1:5555 --flash build/flash.bin --log build/body.log\n"
    "  limber-sim device --pty build/rod --inject noise@2+1:0.001 --inject servo@5+0.1:3\n"
    "  limber-sim device --pty build/rod --scene host_sim/scenes/ball.ini\n"
    "  limber-sim device --pty build/rod --factory             # see limber servo --help\n\n"
    "Ends with Ctrl-C, and then prints the hash of all angles; limber-sim replay --per-tick LOG "
    "comes to "
    "the same.\n";

typedef struct {
    char *pty, *tcp, *log, *flash, *scene, *shape;
    double shape_strength_nm, shape_blend_s; /* strength below 0: not given */
    bool at_full_speed;
    long links_n, baud;
    double seconds, rate_hz;
    host_servos servos;
} choices;

static int take_servos(host_servos *servos, const char *text)
{
    static const char *const KINDS[SERVOS_KINDS_N] = {
        [SERVOS_NONE] = "none", [SERVOS_PWM] = "pwm", [SERVOS_BUS] = "bus"};
    for (int kind = 0; kind < SERVOS_KINDS_N; kind++) {
        if (strcmp(text, KINDS[kind]) == 0) {
            servos->kind = (servos_kind)kind;
            return SIM_OK;
        }
    }
    return sim_complain("--servos %.40s: must be bus, pwm or none", text);
}

static int take_option(choices *c, injection *faults, int option, char *text)
{
    double number = 0.0;
    int result = SIM_OK;
    switch (option) {
    case OPTION_PTY:
        return live_text(&c->pty, text);
    case OPTION_TCP:
        return live_text(&c->tcp, text);
    case OPTION_LOG:
        return live_text(&c->log, text);
    case OPTION_FLASH:
        return live_text(&c->flash, text);
    case OPTION_SCENE:
        return live_text(&c->scene, text);
    case OPTION_SHAPE:
        return live_text(&c->shape, text);
    case OPTION_SHAPE_STRENGTH:
        return options_number("--shape-strength", text, 0.0, (double)ROD_SHAPE_STRENGTH_MAX_NM,
                              &c->shape_strength_nm);
    case OPTION_SHAPE_BLEND:
        return options_number("--shape-blend", text, 0.0, (double)ROD_SHAPE_BLEND_MAX_S,
                              &c->shape_blend_s);
    case OPTION_INJECT:
        return injection_add(faults, text);
    case OPTION_SECONDS:
        return options_number("--seconds", text, 0.0, 1e9, &c->seconds);
    case OPTION_RATE:
        return options_number("--rate", text, 100.0, 2000.0, &c->rate_hz);
    case OPTION_LINKS:
        result = options_number("--links", text, 1.0, (double)ROD_MAX_LINKS, &number);
        c->links_n = (long)number;
        return result;
    case OPTION_BAUD:
        result = options_number("--baud", text, 0.0, 1e7, &number);
        c->baud = (long)number;
        return result;
    case OPTION_SERVOS:
        return take_servos(&c->servos, text);
    case OPTION_SERVO_BAUD:
        return live_servo_baud("--servo-baud", text, &c->servos.baud);
    case OPTION_FACTORY:
        c->servos.servos_n = 1;
        c->servos.baud = BUS_SERVO_FACTORY_BAUD;
        return SIM_OK;
    case OPTION_ECHO:
        c->servos.echo = true;
        return SIM_OK;
    default:
        c->at_full_speed = strcmp(text, "max") == 0;
        return c->at_full_speed || strcmp(text, "real") == 0
                   ? SIM_OK
                   : sim_complain("--speed %.40s: must be real or max", text);
    }
}

static int take_options(poptContext context, choices *c, injection *faults, bool *help)
{
    *help = false;
    for (int option; (option = options_next(context, "device", EXAMPLES)) != 0;) {
        if (option < 0) {
            return SIM_BAD_INPUT;
        }
        if (option == OPTION_HELP) {
            *help = true;
            return SIM_OK;
        }
        char *text = poptGetOptArg(context);
        const int result = take_option(c, faults, option, text);
        free(text);
        if (result != SIM_OK) {
            return result;
        }
    }
    if (poptPeekArg(context) != NULL) {
        return sim_complain("device: unexpected '%s'; try limber-sim device --help",
                            poptPeekArg(context));
    }
    if ((c->shape == NULL) != (c->shape_strength_nm < 0.0)) {
        return sim_complain("device: --shape and --shape-strength go together");
    }
    return (c->pty == NULL) == (c->tcp == NULL)
               ? sim_complain("device: give either --pty LINK or --tcp ADDRESS:PORT")
               : SIM_OK;
}

/* What is around the rod when it starts. Whether the device has time for it is told by place. */
typedef struct {
    scene_text objects;
    body_shape shape;
} surroundings;

static int read_surroundings(const choices *c, surroundings *around)
{
    *around = (surroundings){.shape = {.strength_nm = (float)c->shape_strength_nm,
                                       .blend_s = (float)c->shape_blend_s,
                                       .angles_n = (int32_t)c->links_n}};
    const int result = c->scene == NULL ? SIM_OK : scene_text_read_ini(c->scene, &around->objects);
    return result == SIM_OK && c->shape != NULL
               ? shape_text_read(c->shape, around->shape.angles_n, around->shape.angle_rad)
               : result;
}

/* Of a device that has started: what it had no time for is refused in its own words. */
static int place(host_device *h, const choices *c, const surroundings *around)
{
    char text[MESSAGES_TEXT_MAX + 1];
    params_refusal why;
    for (int i = 0; i < around->objects.objects_n; i++) {
        const scene_text_object *const o = &around->objects.objects[i];
        if (h->device.body.scene.body[i].object.kind == SCENE_NONE &&
            !device_put_object(&h->device, i, &o->object, text, &why)) {
            return sim_complain("%s: %s: %s", c->scene, o->name, why.text);
        }
    }
    return c->shape != NULL && !device_take_shape(&h->device, &around->shape, text, &why)
               ? sim_complain("%s: %s", c->shape, why.text)
               : SIM_OK;
}

static int open_all(host_device *h, const choices *c)
{
    int result = flash_file_open(&h->flash, c->flash);
    if (result == SIM_OK) {
        result = body_log_open(&h->log, c->log);
    }
    return result == SIM_OK
               ? live_open_line(&h->line, "limber-sim device: limber ... --port ", c->pty, c->tcp)
               : result;
}

static bool is_over(const struct timespec *moment)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec > moment->tv_sec ||
           (now.tv_sec == moment->tv_sec && now.tv_nsec > moment->tv_nsec);
}

/* The device's clock follows this machine's, tick by tick; late ticks are made up for. */
static void run(host_device *h, const choices *c)
{
    const long tick_ns = (long)(1e9 / c->rate_hz + 0.5);
    struct timespec next;
    clock_gettime(CLOCK_MONOTONIC, &next);
    while (!live_asked_to_stop() && (c->seconds <= 0.0 || h->elapsed_s < c->seconds)) {
        host_device_tick(h);
        if (c->at_full_speed) {
            continue;
        }
        next.tv_nsec += tick_ns;
        if (next.tv_nsec >= 1000000000L) {
            next.tv_nsec -= 1000000000L;
            next.tv_sec++;
        }
        h->late = is_over(&next);
        clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, NULL);
    }
}

static int run_device(const choices *c, const injection *faults)
{
    host_device *h = calloc(1, sizeof *h);
    if (h == NULL) {
        return sim_give_up("out of memory");
    }
    h->injection = *faults;
    h->servos = c->servos;
    h->line_baud = (uint32_t)c->baud;
    h->line = (line){.fd = -1, .listen_fd = -1, .kept_fd = -1};
    servo_plant_init(&h->plant, 3, 15.0f);
    surroundings around;
    int result = read_surroundings(c, &around);
    for (int i = 0; result == SIM_OK && i < around.objects.objects_n; i++) {
        (void)scene_put(&h->objects, i, &around.objects.objects[i].object, NULL); /* checked */
    }
    if (result == SIM_OK) {
        result = open_all(h, c);
    }
    if (result == SIM_OK) {
        live_catch_signals();
        host_device_start(h, (float)(1.0 / c->rate_hz), (int)c->links_n);
        result = place(h, c, &around);
    }
    if (result == SIM_OK) {
        run(h, c);
        printf("ticks      %" PRIu32 "\nhash       %016" PRIx64 "\n", h->log.ticks_n, h->log.hash);
    }
    const int closed = body_log_close(&h->log, c->log);
    line_close(&h->line);
    free(h);
    return result == SIM_OK ? closed : result;
}

int sim_device_command(int argc, const char **argv)
{
    const struct poptOption table[] = {
        {"pty", 0, POPT_ARG_STRING, NULL, OPTION_PTY, "be found as a serial port under this name",
         "LINK"},
        {"tcp", 0, POPT_ARG_STRING, NULL, OPTION_TCP, "listen there for one tool at a time",
         "ADDRESS:PORT"},
        {"speed", 0, POPT_ARG_STRING, NULL, OPTION_SPEED, "real time, or as fast as it goes (real)",
         "real|max"},
        {"log", 0, POPT_ARG_STRING, NULL, OPTION_LOG,
         "keep the exact pose of every tick, and all else that bends the rod", "FILE"},
        {"flash", 0, POPT_ARG_STRING, NULL, OPTION_FLASH, "keep settings in this file", "FILE"},
        {"links", 0, POPT_ARG_STRING, NULL, OPTION_LINKS, "links of the rod (4)", "N"},
        {"baud", 0, POPT_ARG_STRING, NULL, OPTION_BAUD,
         "refuse rates that a line of so many baud could not carry (0: it carries all)", "BAUD"},
        {"rate", 'r', POPT_ARG_STRING, NULL, OPTION_RATE, "ticks a second (1000)", "HZ"},
        {"inject", 0, POPT_ARG_STRING, NULL, OPTION_INJECT,
         "let something go wrong: noise, drop, stall, estop, cut, clock; of servos: servo, unplug "
         "(ID), lose, garble (share), slow (s)",
         "KIND@START[+SECONDS][:AMOUNT]"},
        {"seconds", 0, POPT_ARG_STRING, NULL, OPTION_SECONDS,
         "end after so long on the device's clock", "S"},
        {"servos", 0, POPT_ARG_STRING, NULL, OPTION_SERVOS,
         "what hangs on it: smart servos with ids 1, 2, ..., hobby servos, or nothing (bus)",
         "bus|pwm|none"},
        {"servo-baud", 0, POPT_ARG_STRING, NULL, OPTION_SERVO_BAUD,
         "what the smart servos are set to (1000000)", "BAUD"},
        {"factory", 0, POPT_ARG_NONE, NULL, OPTION_FACTORY,
         "one smart servo as it comes from the factory: id 1, 57600 baud", NULL},
        {"scene", 0, POPT_ARG_STRING, NULL, OPTION_SCENE,
         "things to touch, in the place of the poses that come", "FILE.ini"},
        OPTIONS_SHAPE,
        {"echo", 0, POPT_ARG_NONE, NULL, OPTION_ECHO, "the device hears itself on the servo bus",
         NULL},
        OPTIONS_END,
    };
    choices c = {.links_n = 4,
                 .rate_hz = 1000.0,
                 .shape_strength_nm = -1.0,
                 .shape_blend_s = 0.5,
                 .servos = {.kind = SERVOS_BUS, .baud = HOST_SERVOS_BAUD}};
    injection faults = {.faults_n = 0};
    argv[0] = "limber-sim device"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    bool help;
    int result = take_options(context, &c, &faults, &help);
    if (result == SIM_OK && !help) {
        result = run_device(&c, &faults);
    }
    free(c.pty);
    free(c.tcp);
    free(c.log);
    free(c.flash);
    free(c.scene);
    free(c.shape);
    poptFreeContext(context);
    return result;
}
