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
    OPTION_RIGHT_HANDED,
    OPTION_SCALE,
    OPTION_MOUNT,
    OPTION_ARM,
    OPTION_DRY,
    OPTION_RECONNECT,
    OPTION_REARM,
    OPTION_GRAPHICS,
    OPTION_ANGLES,
    OPTION_POSES,
    OPTION_MONITOR,
    OPTION_SCENE
};

static const char EXAMPLES[] =
    "  limber stream hand.txt                            # arms, plays, disarms\n"
    "  limber stream hand.txt --dry                      # the rod only computes, nothing moves\n"
    "  limber stream slow.csv --resample 100 --speed 0.5\n"
    "  limber stream unity.txt --up y --left-handed --mount 0,0,0.12,0,90,0\n"
    "  limber stream hand.txt --port pty:build/rod --angles angles.csv --json\n"
    "  limber stream hand.txt --poses run.txt            # then: limber-sim replay run.txt "
    "--report "
    "run.html\n"
    "  limber stream hand.txt --scene table.ini          # see limber scene --help\n"
    "  limber stream vrpn:Tracker0@192.168.1.5           # OptiTrack, Vicon, any VRPN server\n"
    "  limber stream osc:39539                           # Vive, VMC apps, Unity on this PC\n"
    "  limber stream osc:0.0.0.0:39539#LHR-1B2C3D4E      # from another PC, that tracker\n"
    "  limber stream osc:39539 --graphics osc:127.0.0.1:9000\n"
    "  tracker | limber stream -                         # lines on stdin, sent as they come\n"
    "  limber stream - --speed 1 < hand.txt              # at their own times\n\n"
    "Tracks: TUM (timestamp tx ty tz qx qy qz qw) or CSV with named columns; lines on stdin: TUM. "
    "s, m.\n"
    "Live sources may come late, fall silent and come back: the device holds, and is armed again "
    "if it has\n"
    "relaxed or gone limp meanwhile.\n"
    "  -                                  TUM lines on standard input\n"
    "  vrpn:TRACKER@HOST[:3883][#SENSOR]  by TCP; sensor 0, axes as the server has them, often "
    "--up y\n"
    "  osc:[127.0.0.1:]PORT[#SERIAL]      by UDP, /VMC/Ext/Tra/Pos ,sfffffff; the first tracker "
    "heard;\n"
    "                                     Unity's axes unless --up or --right-handed tell others\n"
    "A pose is as old as its way here: by the source's times where it writes them (VRPN; the "
    "quickest of\n"
    "the last seconds counts as no way at all), else by its arrival.\n"
    "--graphics: /limber/angles ,iiff... (tick, state, theta and phi of each joint in rad) and\n"
    "/limber/nodes ,iiifff... (tick, first node, nodes of the rod, x y z of each in m, z up; for "
    "Unity\n"
    "-x z -y). Where the device's nodes_rate is 0 it is 60 for as long as that lasts.\n"
    "A track is held at its first pose until the device follows, then played; positions count from "
    "its first pose.\n"
    "--scene: in the track's or the tracker's own world. The objects stay after the stream.\n"
    "--mount: from the tracker to the rod's base, seen from the tracker: m along its axes, then "
    "degrees, yaw about z\n"
    "first, pitch about the new y, roll about the new x. It comes after --up, --left-handed and "
    "--scale.\n"
    "Ctrl-C disarms first. Every pose sent is accounted for: accepted, rejected by cause, lost.\n"
    "Exit codes: 0 fine, 1 poses unaccounted for, 2 bad input, 3 internal failure,\n"
    "            4 device not there, lost or refusing, 130 interrupted (and disarmed)\n";

enum { Y_UP = 1, Z_UP, LEFT_HANDED, RIGHT_HANDED }; /* 0: not told */

typedef struct {
    link_options link;
    stream_options stream;
    source_options source;
    bool speed_given, monitor;
    int up, handed;
    char *angles_path, *poses_path, *scene_path, *graphics;
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
    c->up = strcmp(text, "y") == 0 ? Y_UP : Z_UP;
    return c->up == Y_UP || strcmp(text, "z") == 0
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
        c->handed = LEFT_HANDED;
        return SIM_OK;
    case OPTION_RIGHT_HANDED:
        c->handed = RIGHT_HANDED;
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
    case OPTION_GRAPHICS:
        free(c->graphics);
        c->graphics = strdup(text);
        return SIM_OK;
    case OPTION_MONITOR:
        c->monitor = true;
        return SIM_OK;
    case OPTION_SCENE:
        free(c->scene_path);
        c->scene_path = strdup(text);
        return SIM_OK;
    case OPTION_POSES:
        free(c->poses_path);
        c->poses_path = strdup(text);
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

/* Axes that nobody has told are right-handed and z up, but for sources that come from Unity. */
static void settle_axes(choices *c)
{
    const bool unity = c->source.live != NULL && c->source.live->unity;
    c->source.track.y_up = c->up == Y_UP || (c->up == 0 && unity);
    c->source.track.left_handed = c->handed == LEFT_HANDED || (c->handed == 0 && unity);
}

/* The view needs the terminal for itself. */
static int settle_view(const choices *c)
{
    if (c->monitor && (c->link.json != 0 || !monitor_view_possible())) {
        return sim_complain("--monitor needs a terminal to draw on, and not --json");
    }
    return SIM_OK;
}

/* Standard input is live unless it is a file or somebody gave it a pace. */
static int settle_source(choices *c, const char *path)
{
    struct stat status;
    const bool is_file = fstat(STDIN_FILENO, &status) == 0 && S_ISREG(status.st_mode);
    c->source.live = strcmp(path, "-") == 0 ? (c->speed_given || is_file ? NULL : &live_lines_kind)
                                            : live_source_kind(path);
    settle_axes(c);
    if (c->source.live == &live_lines_kind && c->source.resample_hz > 0.0) {
        return sim_complain("--resample wants the whole track: add --speed 1, and standard input "
                            "is read to its end first");
    }
    if (c->source.live != NULL && (c->speed_given || c->source.resample_hz > 0.0)) {
        return sim_complain("%.100s: --speed and --resample are for tracks, this comes as it comes",
                            path);
    }
    return SIM_OK;
}

static int play(choices *c, source *src, graphics *drawn)
{
    angles_csv csv;
    stream st = {0};
    monitor_view view;
    pose_track poses;
    int result = angles_csv_open(&csv, c->angles_path, 0.0);
    if (result == SIM_OK) {
        result = pose_track_open(&poses, c->poses_path);
        result = result == SIM_OK ? SIM_OK : angles_csv_close(&csv, result);
        c->stream.poses = &poses;
    }
    if (result == SIM_OK) {
        interrupt_catch();
        c->stream.view = c->monitor && monitor_view_open(&view) ? &view : NULL;
        result = stream_run(&st, &c->stream, src, &csv, drawn);
        if (c->stream.view != NULL) {
            monitor_view_close(&view);
        }
        const int closed = pose_track_close(&poses);
        result = angles_csv_close(&csv, result);
        const int finished = outputs_finish(closed);
        result = result == SIM_OK ? finished : result;
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
    graphics drawn = {0};
    stream_scene objects;
    const char *const path = options_one_argument(context, "stream", "track");
    int result = path == NULL ? SIM_BAD_INPUT : settle_source(c, path);
    if (result == SIM_OK) {
        result = stream_scene_open(&objects, c->scene_path);
        c->stream.scene = &objects;
    }
    if (result == SIM_OK) {
        result = settle_view(c);
    }
    if (result == SIM_OK) {
        result = link_choose(&c->link);
    }
    if (result == SIM_OK && c->graphics != NULL) {
        result = graphics_open(&drawn, c->graphics);
    }
    if (result == SIM_OK) {
        c->stream.port = c->link.chosen;
        result = source_open(&src, path, &c->source);
        if (result == SIM_OK) {
            result = play(c, &src, c->graphics != NULL ? &drawn : NULL);
        }
        source_free(&src);
    }
    graphics_close(&drawn);
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
        {"poses", 0, POPT_ARG_STRING, NULL, OPTION_POSES,
         "write the poses that the device used, tick by tick: a track for limber-sim replay",
         "OUT.txt"},
        {"scene", 0, POPT_ARG_STRING, NULL, OPTION_SCENE,
         "objects that the rod touches, and no others; saved again while it runs, read again",
         "FILE.ini"},
        {"monitor", 0, POPT_ARG_NONE, NULL, OPTION_MONITOR,
         "show it live in the terminal; q stops, as Ctrl-C does", NULL},
        {"graphics", 'g', POPT_ARG_STRING, NULL, OPTION_GRAPHICS,
         "send angles and nodes on to whatever draws the rod", "osc:HOST:PORT"},
        {"up", 0, POPT_ARG_STRING, NULL, OPTION_UP,
         "the track's axis that points up: y or z (z; osc: y)", "AXIS"},
        {"left-handed", 0, POPT_ARG_NONE, NULL, OPTION_LEFT_HANDED,
         "the track's axes are left-handed (Unity): mirror x", NULL},
        {"right-handed", 0, POPT_ARG_NONE, NULL, OPTION_RIGHT_HANDED,
         "they are not (the default, but for osc:)", NULL},
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
    poptSetOtherOptionHelp(context, "TRACK|LIVE SOURCE [OPTION...]");
    bool help;
    int result = take_options(context, &c, &help);
    if (result == SIM_OK && !help) {
        result = run(context, &c);
    }
    free(c.angles_path);
    free(c.poses_path);
    free(c.scene_path);
    free(c.graphics);
    poptFreeContext(context);
    link_close(&c.link, NULL);
    return result;
}
