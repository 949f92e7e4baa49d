/* scene_command.c - limber scene: what stands in the rod's way: send, show, put, move, remove, clear. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "link_options.h"
#include "scene_requests.h"
#include "scene_show.h"

enum { OPTION_PLACE = 1, OPTION_ORIGIN };

static const char EXAMPLES[] =
    "  limber scene send table.ini           # these objects, and no others\n"
    "  limber scene show                     # what is there, and how hard the rod presses\n"
    "  limber scene put \"sphere centre=0,0,0.5 radius=0.1 friction=0.3\"\n"
    "  limber scene put \"plane point=0,0,-0.2 normal=0,0,1\" --place 2\n"
    "  limber scene move 1 0,0.1,0.5         # the object in place 1\n"
    "  limber scene remove 1\n"
    "  limber scene clear\n\n"
    "Up to eight objects, in places 1 to 8: [plane], [sphere], [capsule] and [box], as in "
    "limber-sim replay --scene.\n"
    "m, in the world of the poses that the device gets, which limber stream counts from the first "
    "one:\n--origin x,y,z says where that is in the scene's own world. limber stream --scene "
    "FILE.ini "
    "knows.\n"
    "The device forgets its scene when it restarts; presets and parameters leave it alone.\n";

typedef struct {
    link_options link;
    session s;
    int place;    /* from 1; 0: not given */
    bool shifted; /* --origin was given */
    vec3 origin_m;
} scene_command;

typedef enum { SEND, SHOW, PUT, MOVE, REMOVE, CLEAR, VERBS_N } verb;
static const struct {
    const char *name, *needs;
    int arguments_n;
} VERBS[VERBS_N] = {
    {"send", "a FILE.ini", 1},
    {"show", "nothing", 0},
    {"put", "an object in quotes, \"sphere centre=0,0,0.5 radius=0.1\"", 1},
    {"move", "a PLACE from 1 to 8 and x,y,z", 2},
    {"remove", "a PLACE from 1 to 8", 1},
    {"clear", "nothing", 0},
};

/* What is to be done, read and checked before the device is asked anything. */
typedef struct {
    verb verb;
    scene_text file;          /* SEND */
    scene_text_object object; /* PUT */
    vec3 place_m;             /* MOVE */
} task;

/* --- what they do ---------------------------------------------------------------------------------- */

static int find_free(scene_command *c)
{
    int result = SIM_OK;
    for (int i = 0; i < SCENE_OBJECTS_MAX && result == SIM_OK; i++) {
        message_scene_object object;
        result = scene_requests_get(&c->s, i, &object);
        if (result == SIM_OK && object.kind == OBJECT_NONE) {
            c->place = i + 1;
            return SIM_OK;
        }
    }
    return result == SIM_OK
               ? limber_refuse("all %d places are taken; say which to take with --place",
                               SCENE_OBJECTS_MAX)
               : result;
}

static int put(scene_command *c, const scene_object *object)
{
    int result = c->place == 0 ? find_free(c) : SIM_OK;
    if (result == SIM_OK) {
        result = scene_requests_put(&c->s, c->place - 1, object);
    }
    if (result == SIM_OK) {
        printf("a %s stands in place %d\n", scene_kinds[object->kind], c->place);
    }
    return result;
}

static int move(scene_command *c, vec3 place_m)
{
    message_scene_object there;
    int result = scene_requests_get(&c->s, c->place - 1, &there);
    if (result == SIM_OK && there.kind == OBJECT_NONE) {
        result = limber_refuse(
            "scene move: nothing stands in place %d; limber scene show tells what does", c->place);
    }
    if (result == SIM_OK) {
        scene_object object = scene_requests_object(&there);
        object.place_m = place_m;
        result = scene_requests_put(&c->s, c->place - 1, &object);
    }
    if (result == SIM_OK) {
        printf("the %s in place %d is at %g,%g,%g\n", scene_kinds[there.kind], c->place,
               (double)place_m.x, (double)place_m.y, (double)place_m.z);
    }
    return result;
}

static int take_away(scene_command *c)
{
    static const scene_object NOTHING = {.kind = SCENE_NONE};
    const int result = scene_requests_put(&c->s, c->place - 1, &NOTHING);
    if (result == SIM_OK) {
        printf("nothing stands in place %d\n", c->place);
    }
    return result;
}

static int send_all(scene_command *c, const scene_text *file)
{
    const int result = scene_requests_send(&c->s, file);
    if (result == SIM_OK) {
        printf("%d object%s there\n", file->objects_n,
               file->objects_n == 1 ? " stands" : "s stand");
    }
    return result;
}

static int clear(scene_command *c)
{
    const int result = scene_requests_clear(&c->s);
    if (result == SIM_OK) {
        printf("nothing stands there\n");
    }
    return result;
}

/* --- the command line ------------------------------------------------------------------------------ */

static int take_place(const char *title, const char *text, int *place)
{
    double number;
    if (link_number(title, text, 1.0, SCENE_OBJECTS_MAX, &number) != SIM_OK) {
        return SIM_BAD_INPUT;
    }
    *place = (int)number;
    return number > *place ? sim_complain("%s %.40s: must be a whole number", title, text) : SIM_OK;
}

static int take_argument(scene_command *c, task *t, int argument, const char *word)
{
    switch (t->verb) {
    case SEND:
        return scene_text_read_ini(word, &t->file);
    case PUT:
        return scene_text_read_line("scene put", word, &t->object);
    case MOVE:
        return argument == 0 ? take_place("scene move", word, &c->place)
                             : scene_text_read_place("scene move", word, &t->place_m);
    default:
        return take_place("scene remove", word, &c->place);
    }
}

/* The options that the verb has no use for, or cannot have twice. */
static int check_options(const scene_command *c, verb what)
{
    if (c->place != 0 && what != PUT) {
        return sim_complain("scene %s: --place is for put only", VERBS[what].name);
    }
    return c->shifted && (what == SHOW || what == REMOVE || what == CLEAR)
               ? sim_complain("scene %s: --origin is for send, put and move only", VERBS[what].name)
               : SIM_OK;
}

static int take_arguments(scene_command *c, poptContext context, task *t)
{
    const char *word = poptGetArg(context);
    if (word == NULL) {
        return sim_complain(
            "scene: say what: send, show, put, move, remove or clear; try limber scene --help");
    }
    for (t->verb = SEND; t->verb < VERBS_N && strcmp(word, VERBS[t->verb].name) != 0; ++t->verb) {
    }
    if (t->verb == VERBS_N) {
        return sim_complain("scene %.40s: must be send, show, put, move, remove or clear", word);
    }
    int result = check_options(c, t->verb);
    for (int i = 0; i < VERBS[t->verb].arguments_n && result == SIM_OK; i++) {
        word = poptGetArg(context);
        result = word == NULL ? sim_complain("scene %s: needs %s; try limber scene --help",
                                             VERBS[t->verb].name, VERBS[t->verb].needs)
                              : take_argument(c, t, i, word);
    }
    return result == SIM_OK ? link_no_more_arguments(context, "scene") : result;
}

/* From the scene's own world to that of the poses. */
static void shift(const scene_command *c, task *t)
{
    for (int i = 0; i < t->file.objects_n; i++) {
        scene_object *object = &t->file.objects[i].object;
        object->place_m = vec3_sub(object->place_m, c->origin_m);
    }
    t->object.object.place_m = vec3_sub(t->object.object.place_m, c->origin_m);
    t->place_m = vec3_sub(t->place_m, c->origin_m);
}

static int act(scene_command *c, poptContext context)
{
    task t = {.verb = SEND};
    int result = take_arguments(c, context, &t);
    if (result == SIM_OK) {
        shift(c, &t);
        result = link_open(&c->link, &c->s);
    }
    if (result == SIM_OK) {
        result = scene_requests_known(&c->s);
    }
    if (result == SIM_OK) {
        result = t.verb == SEND     ? send_all(c, &t.file)
                 : t.verb == SHOW   ? scene_show(&c->s, c->link.json != 0)
                 : t.verb == PUT    ? put(c, &t.object.object)
                 : t.verb == MOVE   ? move(c, t.place_m)
                 : t.verb == REMOVE ? take_away(c)
                                    : clear(c);
    }
    return result;
}

static int run(scene_command *c, poptContext context)
{
    int result = SIM_OK;
    for (int option;
         result == SIM_OK && (option = options_next(context, "scene", EXAMPLES)) != 0;) {
        if (option == OPTION_HELP) {
            return SIM_OK;
        }
        if (option < 0) {
            return SIM_BAD_INPUT;
        }
        char *const text = poptGetOptArg(context);
        c->shifted = c->shifted || option == OPTION_ORIGIN;
        result = option == OPTION_PLACE ? take_place("--place", text, &c->place)
                                        : scene_text_read_place("--origin", text, &c->origin_m);
        free(text);
    }
    return result == SIM_OK ? act(c, context) : result;
}

/* popt would take "-0.1,0,0.5" for options. A blank in front keeps it from that, and no number minds. */
enum { SHIELDED_MAX = 4, SHIELDED_BYTES = 80 };

static void shield_negative(int argc, const char **argv,
                            char shielded[SHIELDED_MAX][SHIELDED_BYTES])
{
    for (int i = 1, n = 0; i < argc && n < SHIELDED_MAX; i++) {
        if (argv[i][0] == '-' && strchr("0123456789.", argv[i][1]) != NULL && argv[i][1] != '\0') {
            snprintf(shielded[n], SHIELDED_BYTES, " %s", argv[i]);
            argv[i] = shielded[n++];
        }
    }
}

int limber_scene_command(int argc, const char **argv)
{
    char shielded[SHIELDED_MAX][SHIELDED_BYTES];
    shield_negative(argc, argv, shielded);
    scene_command c = {.place = 0};
    const struct poptOption table[] = {
        LINK_PORT_OPTION(&c.link),
        LINK_JSON_OPTION(&c.link),
        {"place", 0, POPT_ARG_STRING, NULL, OPTION_PLACE,
         "put: into this place, instead of what is there (the first free one)", "1...8"},
        {"origin", 0, POPT_ARG_STRING, NULL, OPTION_ORIGIN,
         "send, put, move: where the poses' world begins in the scene's, m (0,0,0)", "x,y,z"},
        OPTIONS_END};
    argv[0] = "limber scene"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    poptSetOtherOptionHelp(
        context,
        "send FILE.ini | show | put OBJECT | move PLACE x,y,z | remove PLACE | clear [OPTION...]");
    const int result = run(&c, context);
    poptFreeContext(context);
    link_close(&c.link, &c.s);
    return result;
}
