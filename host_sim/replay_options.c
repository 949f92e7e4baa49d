/* replay_options.c - see replay_options.h. */
#include "replay_options.h"

#include <stdlib.h>
#include <string.h>

#include "options.h"
#include "sim.h"

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
    OPTION_EXPECT_HASH,
    OPTION_SCENE,
    OPTION_CONTACTS
};

static const char EXAMPLES[] =
    "  limber-sim replay build/tracks/shaking.txt --preset whip --report whip.html\n"
    "  limber-sim replay hand.csv --params my-rod.ini --set spring=400 --angles angles.csv\n"
    "  limber-sim replay hand.txt --preset foil --model elastic --report foil.html\n"
    "  limber-sim replay build/tracks/pressing.txt --preset foil --scene "
    "host_sim/scenes/ball.ini\n"
    "  limber-sim replay hand.txt --preset whip --shape coil:2 --shape-strength 40\n"
    "  limber-sim replay unity.txt --up y --left-handed --rate 500\n"
    "  limber-sim replay hand.txt --preset foil --expect-hash 0123456789abcdef   # in CI\n\n"
    "Tracks: TUM (timestamp tx ty tz qx qy qz qw) or CSV with named columns, EuRoC's included; s, "
    "m.\n"
    "Exit codes: 0 fine, 1 the hash differs, 2 bad input, 3 internal failure\n";

static int take_hash(replay_choices *c, const char *text)
{
    if (strlen(text) != 16 || strspn(text, "0123456789abcdefABCDEF") != 16) {
        return sim_complain(
            "--expect-hash %.40s: must be the 16 hexadecimal digits that replay prints", text);
    }
    c->expect = true;
    c->expected_hash = strtoull(text, NULL, 16);
    return SIM_OK;
}

static int take_up(replay_choices *c, const char *text)
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

static int take_option(replay_choices *c, int option, const char *text)
{
    switch (option) {
    case OPTION_PRESET:
        return params_text_preset(&c->params, text);
    case OPTION_SET:
        return params_text_set(&c->params, text);
    case OPTION_MODEL:
        return params_text_model(&c->params, text);
    case OPTION_RATE:
        return options_number("--rate", text, 10.0, 20000.0, &c->rate_hz);
    case OPTION_UP:
        return take_up(c, text);
    case OPTION_SCALE:
        return options_number("--scale", text, 1e-6, 1e6, &c->track.scale);
    case OPTION_MAX_SPEED:
        return options_number("--max-speed", text, 1e-3, 1e6, &c->track.max_speed_mps);
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
    case OPTION_CONTACTS:
        return take_path(&c->contacts_path, text);
    case OPTION_SCENE:
        return take_path(&c->scene_path, text);
    case OPTION_SHAPE:
        return take_path(&c->shape, text);
    case OPTION_SHAPE_STRENGTH:
        c->shape_strength_given = true;
        return options_number("--shape-strength", text, 0.0, (double)ROD_SHAPE_STRENGTH_MAX_NM,
                              &c->shape_strength_nm);
    case OPTION_SHAPE_BLEND:
        return options_number("--shape-blend", text, 0.0, (double)ROD_SHAPE_BLEND_MAX_S,
                              &c->shape_blend_s);
    case OPTION_PER_TICK:
        return take_path(&c->per_tick_path, text);
    default:
        return take_hash(c, text);
    }
}

/* Reads all options; --params is looked at first, so that --set changes it wherever it stands. Returns
 * SIM_OK with *help where only the help was asked for. */
static int take_options(poptContext context, replay_choices *c, bool *help)
{
    *help = false;
    char *ini_path = NULL;
    replay_choices pending =
        *c; /* what --set and --preset say, kept until the file has been read */
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
        params_text_beneath(&pending.params, &file);
    }
    free(ini_path);
    *c = pending;
    return result;
}

/* What only goes together, or not at all. */
static int check_pairs(const replay_choices *c)
{
    if (c->per_tick_path != NULL && (c->scene_path != NULL || c->shape != NULL)) {
        return sim_complain("--per-tick: the log holds what the device had to touch and what shape "
                            "it took; leave out %s",
                            c->scene_path != NULL ? "--scene" : "--shape");
    }
    if (c->contacts_path != NULL && c->scene_path == NULL) {
        return sim_complain("--contacts: there is nothing to touch; give --scene FILE.ini");
    }
    if (c->shape != NULL && !c->shape_strength_given) {
        return sim_complain("--shape: needs --shape-strength too, N m; as strong as the rod's "
                            "springs goes half way");
    }
    return c->shape == NULL && c->shape_strength_given
               ? sim_complain("--shape-strength: there is no shape; give --shape FILE or "
                              "--shape arc:90")
               : SIM_OK;
}

int replay_options_take(int argc, const char **argv, replay_choices *c, bool *help)
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
        {"scene", 0, POPT_ARG_STRING, NULL, OPTION_SCENE,
         "things to touch, in the place of the track", "FILE.ini"},
        OPTIONS_SHAPE,
        {"angles", 'a', POPT_ARG_STRING, NULL, OPTION_ANGLES,
         "write joint angles: t,theta1,phi1,... s, rad", "OUT.csv"},
        {"nodes", 'n', POPT_ARG_STRING, NULL, OPTION_NODES,
         "write node positions: t,x0,y0,z0,x1,... s, m", "OUT.csv"},
        {"contacts", 0, POPT_ARG_STRING, NULL, OPTION_CONTACTS,
         "write what touched: t,node,object,name,fx,fy,fz s, N", "OUT.csv"},
        {"report", 0, POPT_ARG_STRING, NULL, OPTION_REPORT,
         "write one HTML page with plots and a 3-D view", "OUT.html"},
        {"picture", 0, POPT_ARG_STRING, NULL, OPTION_PICTURE, "write a small moving picture",
         "OUT.svg"},
        {"capsule", 0, POPT_ARG_STRING, NULL, OPTION_CAPSULE,
         "write parameters, what is around, and the float32 pose of every tick", "OUT"},
        {"per-tick", 0, POPT_ARG_STRING, NULL, OPTION_PER_TICK,
         "instead of a track: the log of limber-sim device, tick by tick, with its limits and "
         "blends",
         "LOG"},
        {"expect-hash", 'e', POPT_ARG_STRING, NULL, OPTION_EXPECT_HASH,
         "exit 1 unless the angles have this hash", "HASH"},
        OPTIONS_END,
    };
    *c = (replay_choices){.track = {.scale = 1.0}, .rate_hz = 1000.0, .shape_blend_s = 0.5};
    argv[0] = "limber-sim replay"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    poptSetOtherOptionHelp(context, "TRACK [OPTION...]");
    int result = take_options(context, c, help);
    if (result == SIM_OK && !*help) {
        result = check_pairs(c);
    }
    if (result == SIM_OK && !*help && c->per_tick_path == NULL) {
        const char *path = options_one_argument(context, "replay", "track");
        result = path == NULL ? SIM_BAD_INPUT : take_path(&c->track_path, path);
    }
    poptFreeContext(context);
    return result;
}

void replay_options_free(replay_choices *c)
{
    char *const texts[] = {c->track_path,  c->angles_path,  c->nodes_path,   c->contacts_path,
                           c->report_path, c->picture_path, c->capsule_path, c->per_tick_path,
                           c->scene_path,  c->shape};
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        free(texts[i]);
    }
    *c = (replay_choices){0};
}
