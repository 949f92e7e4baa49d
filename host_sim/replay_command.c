/* replay_command.c - limber-sim replay: options in, summary and files out. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "body_log.h"
#include "options.h"
#include "output.h"
#include "params_text.h"
#include "picture.h"
#include "replay.h"
#include "replay_files.h"
#include "report.h"
#include "sim.h"
#include "summary.h"

enum {
    OPTION_PRESET = 1,
    OPTION_PARAMS,
    OPTION_SET,
    OPTION_MODEL,
    OPTION_RATE,
    OPTION_UP,
    OPTION_SCALE,
    OPTION_MAX_SPEED,
    OPTION_LEFT_HANDED,
    OPTION_ANGLES,
    OPTION_NODES,
    OPTION_REPORT,
    OPTION_PICTURE,
    OPTION_CAPSULE,
    OPTION_PER_TICK,
    OPTION_EXPECT_HASH
};

static const char EXAMPLES[] =
    "  limber-sim replay build/tracks/shaking.txt --preset whip --report whip.html\n"
    "  limber-sim replay hand.csv --params my-rod.ini --set spring=400 --angles angles.csv\n"
    "  limber-sim replay hand.txt --preset foil --model elastic --report foil.html\n"
    "  limber-sim replay unity.txt --up y --left-handed --rate 500\n"
    "  limber-sim replay hand.txt --preset foil --expect-hash 0123456789abcdef   # in CI\n\n"
    "Tracks: TUM (timestamp tx ty tz qx qy qz qw) or CSV with named columns, EuRoC's included; s, "
    "m.\n"
    "Exit codes: 0 fine, 1 the hash differs, 2 bad input, 3 internal failure\n";

typedef struct {
    params_text params;
    track_options track;
    double rate_hz;
    char *angles_path, *nodes_path, *report_path, *picture_path, *capsule_path, *per_tick_path;
    bool expect;
    uint64_t expected_hash;
} choices;

static int take_number(const char *option, const char *text, double min, double max, double *value)
{
    char *end;
    *value = strtod(text, &end);
    if (end == text || *end != '\0' || !(*value >= min && *value <= max)) {
        return sim_complain("%s %.40s: must be a number from %g to %g", option, text, min, max);
    }
    return SIM_OK;
}

static int take_hash(choices *c, const char *text)
{
    if (strlen(text) != 16 || strspn(text, "0123456789abcdefABCDEF") != 16) {
        return sim_complain(
            "--expect-hash %.40s: must be the 16 hexadecimal digits that replay prints", text);
    }
    c->expect = true;
    c->expected_hash = strtoull(text, NULL, 16);
    return SIM_OK;
}

static int take_up(choices *c, const char *text)
{
    c->track.y_up = strcmp(text, "y") == 0;
    return c->track.y_up || strcmp(text, "z") == 0
               ? SIM_OK
               : sim_complain("--up %.40s: must be y or z: the track's axis that points up", text);
}

static int take_path(char **path, const char *text)
{
    free(*path);
    *path = strdup(text);
    return SIM_OK;
}

static int take_option(choices *c, int option, const char *text)
{
    switch (option) {
    case OPTION_PRESET:
        return params_text_preset(&c->params, text);
    case OPTION_SET:
        return params_text_set(&c->params, text);
    case OPTION_MODEL:
        return params_text_model(&c->params, text);
    case OPTION_RATE:
        return take_number("--rate", text, 10.0, 20000.0, &c->rate_hz);
    case OPTION_UP:
        return take_up(c, text);
    case OPTION_SCALE:
        return take_number("--scale", text, 1e-6, 1e6, &c->track.scale);
    case OPTION_MAX_SPEED:
        return take_number("--max-speed", text, 1e-3, 1e6, &c->track.max_speed_mps);
    case OPTION_LEFT_HANDED:
        c->track.left_handed = true;
        return SIM_OK;
    case OPTION_ANGLES:
        return take_path(&c->angles_path, text);
    case OPTION_NODES:
        return take_path(&c->nodes_path, text);
    case OPTION_REPORT:
        return take_path(&c->report_path, text);
    case OPTION_PICTURE:
        return take_path(&c->picture_path, text);
    case OPTION_CAPSULE:
        return take_path(&c->capsule_path, text);
    case OPTION_PER_TICK:
        return take_path(&c->per_tick_path, text);
    default:
        return take_hash(c, text);
    }
}

/* Reads all options; --params is looked at first, so that --set changes it wherever it stands. Returns
 * SIM_OK with *help where only the help was asked for. */
static int take_options(poptContext context, choices *c, bool *help)
{
    *help = false;
    char *ini_path = NULL;
    choices pending = *c; /* what --set and --preset say, kept until the file has been read */
    int result = SIM_OK;
    for (int option;
         result == SIM_OK && (option = options_next(context, "replay", EXAMPLES)) != 0;) {
        if (option < 0) {
            result = SIM_BAD_INPUT;
        } else if (option == OPTION_HELP) {
            *help = true;
            break;
        } else {
            char *text = poptGetOptArg(context);
            result = option == OPTION_PARAMS ? take_path(&ini_path, text)
                                             : take_option(&pending, option, text);
            free(text);
        }
    }
    if (result == SIM_OK && !*help && ini_path != NULL) {
        params_text file = {0};
        if (pending.params.preset != NULL) {
            result = sim_complain(
                "--params and --preset: give one of them; limber-sim params --preset NAME "
                "prints a preset as a file to edit");
        } else {
            result = params_text_read_ini(&file, ini_path);
        }
        for (int i = 0; i < ROD_FIELDS_N; i++) {
            if (pending.params.entries[i].values_n == 0) {
                pending.params.entries[i] = file.entries[i];
            }
        }
    }
    free(ini_path);
    *c = pending;
    return result;
}

static int write_files(const choices *c, const replay *r)
{
    int result = SIM_OK;
    if (c->angles_path != NULL) {
        result = replay_write_angles(r, c->angles_path);
    }
    if (result == SIM_OK && c->nodes_path != NULL) {
        result = replay_write_nodes(r, c->nodes_path);
    }
    if (result == SIM_OK && c->capsule_path != NULL) {
        result = replay_write_capsule(r, c->capsule_path);
    }
    if (result == SIM_OK && c->picture_path != NULL) {
        result = picture_write(r, c->picture_path);
    }
    if (result == SIM_OK && c->report_path != NULL) {
        const char *preset = c->params.preset != NULL ? c->params.preset->name : NULL;
        result = report_write(r, preset, c->report_path);
    }
    return result;
}

/* An output that is the track itself would destroy the recording. */
static int spare_the_track(const choices *c, const char *track)
{
    const char *outputs[] = {c->angles_path, c->nodes_path, c->report_path, c->picture_path,
                             c->capsule_path};
    struct stat of_track, of_output;
    for (size_t i = 0; i < sizeof outputs / sizeof outputs[0]; i++) {
        if (outputs[i] != NULL && stat(track, &of_track) == 0 &&
            stat(outputs[i], &of_output) == 0 && S_ISREG(of_track.st_mode) &&
            of_track.st_ino == of_output.st_ino && of_track.st_dev == of_output.st_dev) {
            return sim_complain("%s: is the track itself; name another file for the output",
                                outputs[i]);
        }
    }
    return SIM_OK;
}

static int hold_to_hash(const choices *c, uint64_t hash)
{
    if (!c->expect || hash == c->expected_hash) {
        return SIM_OK;
    }
    fprintf(stderr, "limber-sim: the hash differs: %016" PRIx64 ", expected %016" PRIx64 "\n", hash,
            c->expected_hash);
    return SIM_HASH_DIFFERS;
}

static int replay_per_tick(const choices *c)
{
    uint64_t hash;
    const int result = body_log_replay(c->per_tick_path, c->angles_path, &hash);
    return result == SIM_OK ? hold_to_hash(c, hash) : result;
}

static int replay_track(const choices *c, const char *path)
{
    rod_params params;
    track source;
    replay r;
    int result = params_text_resolve(&c->params, c->rate_hz, &params);
    if (result == SIM_OK) {
        result = spare_the_track(c, path);
    }
    if (result == SIM_OK) {
        result = track_read(path, &c->track, &source);
    }
    if (result != SIM_OK) {
        return result;
    }
    result = replay_run(&source, &params, c->rate_hz, &r);
    if (result == SIM_OK) {
        /* files before the summary: what is printed is only what all went well */
        result = outputs_finish(write_files(c, &r));
        if (result == SIM_OK) {
            summary_print(&r, c->params.preset != NULL ? c->params.preset->name : NULL, stdout);
            if (c->report_path != NULL) {
                printf("report     %s\n", c->report_path);
            }
            result = hold_to_hash(c, r.hash);
        }
        replay_free(&r);
    }
    track_free(&source);
    return result;
}

int sim_replay_command(int argc, const char **argv)
{
    const struct poptOption table[] = {
        {"preset", 'p', POPT_ARG_STRING, NULL, OPTION_PRESET,
         "a ready-made rod; limber-sim params --list", "NAME"},
        {"params", 'f', POPT_ARG_STRING, NULL, OPTION_PARAMS, "a parameter file", "FILE.ini"},
        {"set", 's', POPT_ARG_STRING, NULL, OPTION_SET,
         "change one parameter; as often as you like", "KEY=VALUE"},
        {"model", 'm', POPT_ARG_STRING, NULL, OPTION_MODEL, "the mathematics: contour or elastic",
         "NAME"},
        {"rate", 'r', POPT_ARG_STRING, NULL, OPTION_RATE, "ticks a second (1000)", "HZ"},
        {"up", 0, POPT_ARG_STRING, NULL, OPTION_UP, "the track's axis that points up: y or z (z)",
         "AXIS"},
        {"scale", 0, POPT_ARG_STRING, NULL, OPTION_SCALE,
         "metres per unit of the track's positions (1)", "METRES"},
        {"left-handed", 0, POPT_ARG_NONE, NULL, OPTION_LEFT_HANDED,
         "the track's axes are left-handed (Unity): mirror x", NULL},
        {"max-speed", 0, POPT_ARG_STRING, NULL, OPTION_MAX_SPEED,
         "drop samples that would need more m/s than this", "SPEED"},
        {"angles", 'a', POPT_ARG_STRING, NULL, OPTION_ANGLES,
         "write joint angles: t,theta1,phi1,... s, rad", "OUT.csv"},
        {"nodes", 'n', POPT_ARG_STRING, NULL, OPTION_NODES,
         "write node positions: t,x0,y0,z0,x1,... s, m", "OUT.csv"},
        {"report", 0, POPT_ARG_STRING, NULL, OPTION_REPORT,
         "write one HTML page with plots and a 3-D view", "OUT.html"},
        {"picture", 0, POPT_ARG_STRING, NULL, OPTION_PICTURE, "write a small moving picture",
         "OUT.svg"},
        {"capsule", 0, POPT_ARG_STRING, NULL, OPTION_CAPSULE,
         "write parameters and the float32 pose of every tick", "OUT"},
        {"per-tick", 0, POPT_ARG_STRING, NULL, OPTION_PER_TICK,
         "instead of a track: the log of limber-sim device, tick by tick, with its limits and "
         "blends",
         "LOG"},
        {"expect-hash", 'e', POPT_ARG_STRING, NULL, OPTION_EXPECT_HASH,
         "exit 1 unless the angles have this hash", "HASH"},
        OPTIONS_END,
    };
    choices c = {.track = {.scale = 1.0}, .rate_hz = 1000.0};
    argv[0] = "limber-sim replay"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    poptSetOtherOptionHelp(context, "TRACK [OPTION...]");
    bool help;
    int result = take_options(context, &c, &help);
    if (result == SIM_OK && !help && c.per_tick_path != NULL) {
        result = replay_per_tick(&c);
    } else if (result == SIM_OK && !help) {
        const char *path = options_one_argument(context, "replay", "track");
        result = path == NULL ? SIM_BAD_INPUT : replay_track(&c, path);
    }
    free(c.angles_path);
    free(c.nodes_path);
    free(c.report_path);
    free(c.picture_path);
    free(c.capsule_path);
    free(c.per_tick_path);
    poptFreeContext(context);
    return result;
}
