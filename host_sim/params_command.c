/* params_command.c - limber-sim params: a complete parameter file to start from. */
#include <stdio.h>
#include <stdlib.h>

#include "options.h"
#include "params_text.h"
#include "sim.h"

enum { OPTION_PRESET = 1, OPTION_MODEL, OPTION_SET, OPTION_LIST };

static const char EXAMPLES[] = "  limber-sim params --preset whip > my-whip.ini\n"
                               "  limber-sim params --preset foil --set links=20 --set spring=400\n"
                               "  limber-sim params --preset foil --model elastic > my-foil.ini\n"
                               "  limber-sim params --list\n";

static int run(poptContext context, params_text *text)
{
    double rate_hz = 1000.0;
    char title[200] = "limber rod: the defaults, the paper's four 30 mm links";
    for (int option; (option = options_next(context, "params", EXAMPLES)) != 0;) {
        char *value = poptGetOptArg(context);
        int result = SIM_OK;
        if (option == OPTION_PRESET) {
            result = params_text_preset(text, value);
        } else if (option == OPTION_MODEL) {
            result = params_text_model(text, value);
        } else if (option == OPTION_SET) {
            result = params_text_set(text, value);
        } else if (option == OPTION_LIST) {
            for (int i = 0; i < ROD_PRESETS_N; i++) {
                printf("%-12s %2d links  %s\n", rod_presets[i].name, rod_presets[i].links_n,
                       rod_presets[i].what);
            }
            return SIM_OK;
        } else {
            return option == OPTION_HELP ? SIM_OK : SIM_BAD_INPUT;
        }
        free(value);
        if (result != SIM_OK) {
            return result;
        }
    }
    if (poptPeekArg(context) != NULL) {
        return sim_complain("params: unexpected '%s'; try limber-sim params --help",
                            poptPeekArg(context));
    }
    rod_params params;
    const int result = params_text_resolve(text, rate_hz, &params);
    if (result == SIM_OK) {
        if (text->preset != NULL) {
            snprintf(title, sizeof title, "limber rod: %s, %s", text->preset->name,
                     text->preset->what);
        }
        params_text_write_ini(&params, title, stdout);
    }
    return result;
}

int sim_params_command(int argc, const char **argv)
{
    const struct poptOption table[] = {
        {"preset", 'p', POPT_ARG_STRING, NULL, OPTION_PRESET, "start from a preset", "NAME"},
        {"model", 'm', POPT_ARG_STRING, NULL, OPTION_MODEL, "the mathematics: contour or elastic",
         "NAME"},
        {"set", 's', POPT_ARG_STRING, NULL, OPTION_SET, "change a key; as often as you like",
         "KEY=VALUE"},
        {"list", 'l', POPT_ARG_NONE, NULL, OPTION_LIST, "list the presets", NULL},
        OPTIONS_END,
    };
    params_text text = {0};
    argv[0] = "limber-sim params"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    const int result = run(context, &text);
    poptFreeContext(context);
    return result;
}
