/* stream_command.c - limber stream: options in, summary out. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "interrupt.h"
#include "link_options.h"
#include "stream.h"

enum {
    OPTION_SPEED = 1,
    OPTION_RESAMPLE,
    OPTION_UP,
    OPTION_LEFT_HANDED,
    OPTION_SCALE,
    OPTION_MOUNT,
    OPTION_ARM,
    OPTION_DRY,
    OPTION_RECONNECT,
    OPTION_REARM,
    OPTION_ANGLES
};

static const char EXAMPLES[] =
    "  limber stream hand.txt                            # arms, plays, disarms\n"
    "  limber stream hand.txt --dry                      # the rod only computes, nothing moves\n"
    "  limber stream slow.csv --resample 100 --speed 0.5\n"
    "  limber stream unity.txt --up y --left-handed --mount 0,0,0.12,0,90,0\n"
    "  limber stream hand.txt --port pty:build/rod --angles angles.csv --json\n"
    "  tracker | limber stream -                         # lines on stdin, sent as they come\n"
    "  limber stream - --speed 1 < hand.txt              # at their own times\n\n"
    "Tracks: TUM (timestamp tx ty tz qx qy qz qw) or CSV with named columns; lines on stdin: TUM. "
    "s, m.\n"
    "A track is held at its first pose until the device follows, then played; positions count from "
    "its first pose.\n"
    "--mount: from the tracker to the rod's base, seen from the tracker: m along its axes, then "
    "degrees, yaw about z\n"
    "first, pitch about the new y, roll about the new x. It comes after --up, --left-handed and "
    "--scale.\n"
    "Ctrl-C disarms first. Every pose sent is accounted for: accepted, rejected by cause, lost.\n"
    "Exit codes: 0 fine, 1 poses unaccounted for, 2 bad input, 3 internal failure,\n"
    "            4 device not there, lost or refusing, 130 interrupted (and disarmed)\n";

typedef struct {
    link_options link;
    stream_options stream;
    source_options source;
    bool speed_given;
    char *angles_path;
} choices;

static int take_speed(choices *c, const char *text)
{
    c->speed_given = true;
    if (strcmp(text, "max") == 0) {
        c->stream.speed = 0.0;
        return SIM_OK;
    }
    char *end;
    c->stream.speed = strtod(text, &end);
    if (end == text || *end != '\0' || !(c->stream.speed >= 0.01 && c->stream.speed <= 1000.0)) {
        return sim_complain("--speed %.40s: must be max or a number from 0.01 to 1000", text);
    }
    return SIM_OK;
}

static int take_up(choices *c, const char *text)
{
    c->source.track.y_up = strcmp(text, "y") == 0;
    return c->source.track.y_up || strcmp(text, "z") == 0
               ? SIM_OK
               : sim_complain("--up %.40s: must be y or z: the track's axis that points up", text);
}

static int take_option(choices *c, int option, const char *text)
{
    switch (option) {
    case OPTION_SPEED:
        return take_speed(c, text);
    case OPTION_RESAMPLE:
        return link_number("--resample", text, 1.0, 2000.0, &c->source.resample_hz);
    case OPTION_UP:
        return take_up(c, text);
    case OPTION_LEFT_HANDED:
        c->source.track.left_handed = true;
        return SIM_OK;
    case OPTION_SCALE:
        return link_number("--scale", text, 1e-6, 1e6, &c->source.track.scale);
    case OPTION_MOUNT:
        return mount_parse(text, &c->source.mount);
    case OPTION_ARM:
        c->stream.arm = true;
        return SIM_OK;
    case OPTION_DRY:
        c->stream.arm = false;
        return SIM_OK;
    case OPTION_RECONNECT:
        c->stream.reconnect = true;
        return SIM_OK;
    case OPTION_REARM:
        c->stream.reconnect = c->stream.rearm = true;
        return SIM_OK;
    default:
        free(c->angles_path);
        c->angles_path = strdup(text);
        return SIM_OK;
    }
}

static int take_options(poptContext context, choices *c, bool *help)
{
    int result = SIM_OK;
    *help = false;
    for (int option;
         result == SIM_OK && (option = options_next(context, "stream", EXAMPLES)) != 0;) {
        if (option < 0) {
            return SIM_BAD_INPUT;
        }
        if (option == OPTION_HELP) {
            *help = true;
            return SIM_OK;
        }
        char *const text = poptGetOptArg(context);
        result = take_option(c, option, text);
        free(text);
    }
    return result;
}

/* Standard input is live unless it is a file or somebody gave it a pace. */
static int settle_source(choices *c, const char *path)
{
    struct stat status;
    const bool is_file = fstat(STDIN_FILENO, &status) == 0 && S_ISREG(status.st_mode);
    c->source.live = strcmp(path, "-") == 0 && !c->speed_given && !is_file;
    if (c->source.live && c->source.resample_hz > 0.0) {
        return sim_complain("--resample wants the whole track: add --speed 1, and standard input "
                            "is read to its end first");
    }
    return SIM_OK;
}

static int play(choices *c, source *src)
{
    angles_csv csv;
    stream st = {0};
    int result = angles_csv_open(&csv, c->angles_path, 0.0);
    if (result == SIM_OK) {
        interrupt_catch();
        result = stream_run(&st, &c->stream, src, &csv);
        result = angles_csv_close(&csv, result);
        if (st.account.sent > 0 && c->link.json) {
            stream_print_json(&st, result);
        } else if (st.account.sent > 0) {
            stream_print_summary(&st);
        }
        stream_free(&st);
    }
    return result;
}

static int run(poptContext context, choices *c)
{
    source src;
    const char *const path = options_one_argument(context, "stream", "track");
    int result = path == NULL ? SIM_BAD_INPUT : settle_source(c, path);
    if (result == SIM_OK) {
        result = link_choose(&c->link);
    }
    if (result == SIM_OK) {
        c->stream.port = c->link.chosen;
        result = source_open(&src, path, &c->source);
    }
    if (result == SIM_OK) {
        result = play(c, &src);
        source_free(&src);
    }
    return result;
}

int limber_stream_command(int argc, const char **argv)
{
    choices c = {.stream = {.arm = true, .speed = 1.0},
                 .source = {.track = {.scale = 1.0}, .mount = mount_none()}};
    const struct poptOption table[] = {
        LINK_PORT_OPTION(&c.link),
        LINK_JSON_OPTION(&c.link),
        {"dry", 'n', POPT_ARG_NONE, NULL, OPTION_DRY, "do not arm: the device only computes", NULL},
        {"arm", 0, POPT_ARG_NONE, NULL, OPTION_ARM, "arm first, disarm at the end (the default)",
         NULL},
        {"speed", 's', POPT_ARG_STRING, NULL, OPTION_SPEED,
         "times the track's own pace, or max: as fast as the line takes it (1)", "X"},
        {"resample", 'r', POPT_ARG_STRING, NULL, OPTION_RESAMPLE,
         "poses a second, filled in between those of the track", "HZ"},
        {"angles", 'a', POPT_ARG_STRING, NULL, OPTION_ANGLES,
         "write the angles that come back: t,theta1,phi1,... s, rad", "OUT.csv"},
        {"up", 0, POPT_ARG_STRING, NULL, OPTION_UP, "the track's axis that points up: y or z (z)",
         "AXIS"},
        {"left-handed", 0, POPT_ARG_NONE, NULL, OPTION_LEFT_HANDED,
         "the track's axes are left-handed (Unity): mirror x", NULL},
        {"scale", 0, POPT_ARG_STRING, NULL, OPTION_SCALE,
         "metres per unit of the track's positions (1)", "METRES"},
        {"mount", 0, POPT_ARG_STRING, NULL, OPTION_MOUNT, "from the tracker to the rod's base",
         "X,Y,Z[,ROLL,PITCH,YAW]"},
        {"reconnect", 0, POPT_ARG_NONE, NULL, OPTION_RECONNECT,
         "if the device is lost try again until it is back, then go on without torque", NULL},
        {"rearm", 0, POPT_ARG_NONE, NULL, OPTION_REARM,
         "--reconnect, and arm it again: the rod moves by itself when the cable is back", NULL},
        OPTIONS_END,
    };
    argv[0] = "limber stream"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    poptSetOtherOptionHelp(context, "TRACK [OPTION...]");
    bool help;
    int result = take_options(context, &c, &help);
    if (result == SIM_OK && !help) {
        result = run(context, &c);
    }
    free(c.angles_path);
    poptFreeContext(context);
    link_close(&c.link, NULL);
    return result;
}
