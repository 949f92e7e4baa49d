/* shape_command.c - limber shape: pulls the rod into a shape, or lets it go. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "link_options.h"
#include "rod.h"
#include "scene_requests.h"
#include "shape_text.h"

enum { OPTION_STRENGTH = 1, OPTION_BLEND };

static const char EXAMPLES[] =
    "  limber shape arc:90                          # bent by 90 degrees in all\n"
    "  limber shape coil:2 --strength 20 --blend 2\n"
    "  limber shape bow.csv                         # theta,phi of each joint, or x,y,z of each "
    "node\n"
    "  limber shape --off                           # the rod is let go\n\n"
    "The shape pulls at each joint like a spring: a strong one wins over the rod's own springs, a "
    "weak one bends them a "
    "little. It stays over\npresets and parameters, until --off, another number of links, or a "
    "restart.\n";

typedef struct {
    link_options link;
    session s;
    int off;
    bool strength_given;
    double strength_nm, blend_s;
} shape_command;

static int pull(shape_command *c, const char *name)
{
    const int links_n = c->s.device.links_n;
    if (links_n > ROD_MAX_LINKS) {
        return limber_refuse("the rod has %d links, and this limber's shapes at most %d", links_n,
                             ROD_MAX_LINKS);
    }
    rod_joint angles_rad[ROD_MAX_LINKS];
    int result = shape_text_read(name, links_n, angles_rad);
    if (result != SIM_OK) {
        return result;
    }
    message m = {.type = MESSAGE_SHAPE,
                 .shape = {.strength_nm = (float)c->strength_nm,
                           .blend_s = (float)c->blend_s,
                           .angles_n = (uint16_t)links_n}};
    for (int i = 0; i < links_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            m.shape.angles_tenth_mrad[i][axis] = (int16_t)lrintf(1e4f * angles_rad[i][axis]);
        }
    }
    result = session_request(&c->s, &m);
    if (result == SIM_OK) {
        printf("%s pulls with %g N m within %g s; limber shape --off lets the rod go\n", name,
               c->strength_nm, c->blend_s);
    }
    return result;
}

static int let_go(shape_command *c)
{
    const int result = session_request(
        &c->s, &(message){.type = MESSAGE_SHAPE, .shape = {.blend_s = (float)c->blend_s}});
    if (result == SIM_OK) {
        printf("no shape pulls at the rod after %g s\n", c->blend_s);
    }
    return result;
}

static int act(shape_command *c, poptContext context)
{
    const char *const name = poptGetArg(context);
    if ((name == NULL) == (c->off == 0)) {
        return sim_complain("shape: give either a shape (arc:90, coil:2, FILE.csv) or --off; try "
                            "limber shape --help");
    }
    if (c->off && c->strength_given) {
        return sim_complain("shape: --strength has no use with --off");
    }
    int result = link_no_more_arguments(context, "shape");
    if (result == SIM_OK) {
        result = link_open(&c->link, &c->s);
    }
    if (result == SIM_OK) {
        result = scene_requests_known(&c->s);
    }
    if (result == SIM_OK) {
        result = c->off ? let_go(c) : pull(c, name);
    }
    return result;
}

static int run(shape_command *c, poptContext context)
{
    int result = SIM_OK;
    for (int option;
         result == SIM_OK && (option = options_next(context, "shape", EXAMPLES)) != 0;) {
        if (option == OPTION_HELP) {
            return SIM_OK;
        }
        if (option < 0) {
            return SIM_BAD_INPUT;
        }
        char *const text = poptGetOptArg(context);
        c->strength_given = c->strength_given || option == OPTION_STRENGTH;
        result =
            option == OPTION_STRENGTH
                ? link_number("--strength", text, 0.0, (double)ROD_SHAPE_STRENGTH_MAX_NM,
                              &c->strength_nm)
                : link_number("--blend", text, 0.0, (double)ROD_SHAPE_BLEND_MAX_S, &c->blend_s);
        free(text);
    }
    return result == SIM_OK ? act(c, context) : result;
}

int limber_shape_command(int argc, const char **argv)
{
    shape_command c = {.strength_nm = 5.0, .blend_s = 0.5};
    const struct poptOption table[] = {LINK_PORT_OPTION(&c.link),
                                       {"strength", 0, POPT_ARG_STRING, NULL, OPTION_STRENGTH,
                                        "of the pull at each joint, N m (5)", "N_M"},
                                       {"blend", 0, POPT_ARG_STRING, NULL, OPTION_BLEND,
                                        "comes, or goes, within this time, s (0.5)", "S"},
                                       {"off", 0, POPT_ARG_NONE, &c.off, 0, "let the rod go", NULL},
                                       OPTIONS_END};
    argv[0] = "limber shape"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    poptSetOtherOptionHelp(context, "arc:DEGREES | coil:TURNS | FILE.csv [OPTION...]");
    const int result = run(&c, context);
    poptFreeContext(context);
    link_close(&c.link, &c.s);
    return result;
}
