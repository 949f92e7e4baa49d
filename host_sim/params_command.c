/* params_command.c - limber-sim params: a complete parameter file to start from. */
#include <stdio.h>
#include <stdlib.h>

#include "options.h"
#include "params_derived.h"
#include "params_material.h"
#include "params_text.h"
#include "sim.h"

enum {
    OPTION_PRESET = 1,
    OPTION_MODEL,
    OPTION_SET,
    OPTION_LIST,
    OPTION_MATERIAL,
    OPTION_LENGTH,
    OPTION_DIAMETER,
    OPTION_BORE,
    OPTION_LINKS
};

static const char EXAMPLES[] =
    "  limber-sim params --preset whip > my-whip.ini\n"
    "  limber-sim params --preset foil --set links=20 --set spring=400\n"
    "  limber-sim params --preset foil --model elastic > my-foil.ini\n"
    "  limber-sim params --material carbon --length 1.8 --diameter 0.012,0.002 --links 20\n"
    "  limber-sim params --preset fishing-rod --material bamboo --bore 0\n"
    "  limber-sim params --list\n";

static void list(void)
{
    printf("presets\n");
    for (int i = 0; i < ROD_PRESETS_N; i++) {
        printf("  %-12s %2d links  %s\n", rod_presets[i].name, rod_presets[i].links_n,
               rod_presets[i].what);
    }
    printf("materials: Young's modulus, density, damping ratio\n");
    for (int i = 0; i < MATERIALS_N; i++) {
        const material *m = &materials[i];
        printf("  %-12s %5.1f GPa %5.0f kg/m^3  %.3f  %s\n", material_names[i],
               (double)m->youngs_modulus_pa * 1e-9, (double)m->density_kg_m3,
               (double)m->damping_ratio, m->what);
    }
}

static int take_option(params_text *text, int option, const char *value)
{
    switch (option) {
    case OPTION_PRESET:
        return params_text_preset(text, value);
    case OPTION_MODEL:
        return params_text_model(text, value);
    case OPTION_SET:
        return params_text_set(text, value);
    case OPTION_MATERIAL:
        return params_text_key(text, "--material", "material", value);
    case OPTION_LENGTH:
        return params_text_key(text, "--length", "total_length", value);
    case OPTION_DIAMETER:
        return params_text_key(text, "--diameter", "diameter", value);
    case OPTION_BORE:
        return params_text_key(text, "--bore", "bore", value);
    default:
        return params_text_key(text, "--links", "links", value);
    }
}

/* "limber rod: foil, a fencing blade ...", and what follows from its material. */
static void write_title(const params_text *text, const rod_params *params, FILE *out)
{
    rod_blank blank;
    if (!params_material_is_asked(text)) {
        fprintf(out, "limber rod: %s%s%s",
                text->preset != NULL ? text->preset->name : "the defaults", ", ",
                text->preset != NULL ? text->preset->what : "the paper's four 30 mm links");
    } else if (params_material_blank(text, &blank) == SIM_OK) {
        fprintf(out, "limber rod of a material%s%s",
                text->preset != NULL ? ", after the preset " : "",
                text->preset != NULL ? text->preset->name : "");
        params_derived_write(&blank, params, out);
        params_material_replaced(text, out);
        params_derived_warn(&blank, params);
    }
}

static int write_rod(const params_text *text)
{
    rod_params params;
    const int result = params_text_resolve(text, 1000.0, &params);
    char *title = NULL;
    size_t size;
    FILE *out = result == SIM_OK ? open_memstream(&title, &size) : NULL;
    if (out == NULL) {
        return result == SIM_OK ? sim_give_up("out of memory") : result;
    }
    write_title(text, &params, out);
    fclose(out);
    params_text_write_ini(&params, title, stdout);
    free(title);
    return SIM_OK;
}

static int run(poptContext context, params_text *text)
{
    for (int option; (option = options_next(context, "params", EXAMPLES)) != 0;) {
        if (option == OPTION_LIST) {
            list();
            return SIM_OK;
        }
        if (option < 0 || option == OPTION_HELP) {
            return option == OPTION_HELP ? SIM_OK : SIM_BAD_INPUT;
        }
        char *value = poptGetOptArg(context);
        const int result = take_option(text, option, value);
        free(value);
        if (result != SIM_OK) {
            return result;
        }
    }
    if (poptPeekArg(context) != NULL) {
        return sim_complain("params: unexpected '%s'; try limber-sim params --help",
                            poptPeekArg(context));
    }
    return write_rod(text);
}

int sim_params_command(int argc, const char **argv)
{
    const struct poptOption table[] = {
        {"preset", 'p', POPT_ARG_STRING, NULL, OPTION_PRESET, "start from a preset", "NAME"},
        {"model", 'm', POPT_ARG_STRING, NULL, OPTION_MODEL, "the mathematics: contour or elastic",
         "NAME"},
        {"set", 's', POPT_ARG_STRING, NULL, OPTION_SET, "change a key; as often as you like",
         "KEY=VALUE"},
        {"material", 'M', POPT_ARG_STRING, NULL, OPTION_MATERIAL,
         "a rod made of this; --list says of what there is", "NAME"},
        {"length", 'L', POPT_ARG_STRING, NULL, OPTION_LENGTH, "from the hand to the tip, m", "M"},
        {"diameter", 'd', POPT_ARG_STRING, NULL, OPTION_DIAMETER, "outside, m; or butt and tip",
         "M[,M]"},
        {"bore", 'b', POPT_ARG_STRING, NULL, OPTION_BORE, "of a tube: inner / outer diameter",
         "RATIO"},
        {"links", 'n', POPT_ARG_STRING, NULL, OPTION_LINKS, "links to cut it into", "N"},
        {"list", 'l', POPT_ARG_NONE, NULL, OPTION_LIST, "list the presets and the materials", NULL},
        OPTIONS_END,
    };
    params_text text = {0};
    argv[0] = "limber-sim params"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    const int result = run(context, &text);
    poptFreeContext(context);
    return result;
}
