/* param_command.c - limber params: list, get, set, load, save, defaults. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "link_options.h"
#include "param_set.h"
#include "texts.h"

static const char EXAMPLES[] =
    "  limber params list\n"
    "  limber params get spring damper --json\n"
    "  limber params set spring=400 links=12          # together, or not at all\n"
    "  limber params set spring[1]=0                  # the first joint turns freely\n"
    "  limber params list --ini > my-rod.ini\n"
    "  limber params load my-rod.ini                  # also what limber-sim params prints\n"
    "  limber params save                             # to the device's flash; while disarmed\n"
    "  limber params defaults\n\n"
    "set, load and defaults change what runs, through a blend; save makes it last.\n";

typedef struct {
    link_options link;
    int ini;
    session s;
    param_table table;
} params_command;

/* --- list and get ---------------------------------------------------------------------------------- */

static void print_row(const message_param_info *info, const message_param_value *value)
{
    char minimum[32], maximum[32], initial[32];
    param_text_value(info, info->minimum, minimum);
    param_text_value(info, info->maximum, maximum);
    param_text_value(info, info->initial, initial);
    printf("%-20s ", info->name);
    param_text_values(info, value, "\n    ", stdout);
    printf(" %s%s(%s ... %s, default %s%s%s)\n    %s\n", info->unit, *info->unit == '\0' ? "" : " ",
           minimum, maximum, initial,
           (info->flags & PARAM_READ_ONLY) != 0       ? "; read only"
           : (info->flags & PARAM_DISARMED_ONLY) != 0 ? "; only while disarmed"
                                                      : "",
           (info->flags & PARAM_LIST) != 0 ? "; one an entry" : "", info->text);
}

static void print_ini(const message_param_info *info, const message_param_value *value)
{
    char minimum[32], maximum[32];
    if ((info->flags & PARAM_READ_ONLY) != 0) {
        return;
    }
    param_text_value(info, info->minimum, minimum);
    param_text_value(info, info->maximum, maximum);
    printf("\n# %s\n# %s ... %s%s%s\n%s = ", info->text, minimum, maximum,
           *info->unit == '\0' ? "" : " ", info->unit, info->name);
    param_text_values(info, value, "\n    ", stdout);
    printf("\n");
}

static cJSON *row_json(const message_param_info *info, const message_param_value *value)
{
    static const char *const KINDS[] = {"choice", "whole", "number"};
    cJSON *json = cJSON_CreateObject();
    char text[32];
    cJSON_AddStringToObject(json, "name", info->name);
    cJSON_AddStringToObject(json, "unit", info->unit);
    cJSON_AddStringToObject(json, "text", info->text);
    cJSON_AddStringToObject(json, "kind", info->kind < 3 ? KINDS[info->kind] : "?");
    cJSON_AddItemToObject(json, "minimum", texts_float_json(info->minimum));
    cJSON_AddItemToObject(json, "maximum", texts_float_json(info->maximum));
    cJSON_AddItemToObject(json, "default", texts_float_json(info->initial));
    cJSON_AddBoolToObject(json, "list", (info->flags & PARAM_LIST) != 0);
    cJSON_AddBoolToObject(json, "disarmed_only", (info->flags & PARAM_DISARMED_ONLY) != 0);
    cJSON_AddBoolToObject(json, "read_only", (info->flags & PARAM_READ_ONLY) != 0);
    cJSON *values = cJSON_AddArrayToObject(json, "values");
    for (int i = 0; i < value->values_n; i++) {
        cJSON_AddItemToArray(values, texts_float_json(value->values[i]));
    }
    if (info->kind == PARAM_CHOICE && value->values_n > 0) {
        param_text_value(info, value->values[0], text);
        cJSON_AddStringToObject(json, "choice", text);
    }
    return json;
}

/* One parameter to wherever it goes; `all` is the JSON list, or NULL. */
static int show(params_command *c, const message_param_info *info, cJSON *all)
{
    message_param_value value;
    const int result = param_table_values(&c->s, info->name, PARAM_IN_FORCE, &value);
    if (result != SIM_OK) {
        return result;
    }
    if (all != NULL) {
        cJSON_AddItemToArray(all, row_json(info, &value));
    } else if (c->ini) {
        print_ini(info, &value);
    } else {
        print_row(info, &value);
    }
    return SIM_OK;
}

/* The named parameters, or all if none is named. */
static int show_many(params_command *c, poptContext context)
{
    int result = SIM_OK, named_n = 0;
    cJSON *const all = c->link.json ? cJSON_CreateArray() : NULL;
    if (c->ini && all == NULL) {
        printf("# limber rod: parameters of %s %s\n# Read by: limber params load THIS_FILE\n\n"
               "[rod]\n",
               c->s.device.device, c->s.device.build);
    }
    for (const char *name; result == SIM_OK && (name = poptGetArg(context)) != NULL; named_n++) {
        const message_param_info *const info = param_table_find(&c->table, name);
        result = info == NULL ? sim_complain("params get: the device has no parameter '%.40s'; "
                                             "limber params list tells the names",
                                             name)
                              : show(c, info, all);
    }
    for (int i = 0; result == SIM_OK && named_n == 0 && i < c->table.infos_n; i++) {
        result = show(c, &c->table.infos[i], all);
    }
    if (all != NULL && result == SIM_OK) {
        texts_print_json(all);
    } else {
        cJSON_Delete(all);
    }
    return result;
}

/* --- save and defaults ---------------------------------------------------------------------------- */

static int save(params_command *c)
{
    const int result = session_request(&c->s, &(message){.type = MESSAGE_PARAM_SAVE});
    if (result == SIM_OK) {
        printf("saved to the device's flash\n");
    }
    return result;
}

static int defaults(params_command *c)
{
    int result = session_request(&c->s, &(message){.type = MESSAGE_PARAM_DEFAULTS});
    if (result == SIM_OK) {
        result = session_request(&c->s, &(message){.type = MESSAGE_PARAM_COMMIT});
    }
    if (result == SIM_OK) {
        printf("all parameters at their defaults; limber params save makes it last\n");
    }
    return result;
}

/* --- the command ----------------------------------------------------------------------------------- */

typedef enum { LIST, GET, SET, LOAD, SAVE, DEFAULTS, VERBS_N } verb;
static const char *const VERBS[VERBS_N] = {"list", "get", "set", "load", "save", "defaults"};

/* What is to be done is read completely before the device is asked anything. */
static int take_arguments(poptContext context, verb *what, param_assignments *all)
{
    const char *word = poptGetArg(context);
    if (word == NULL) {
        return sim_complain("params: say what: list, get, set, load, save or defaults; try limber "
                            "params --help");
    }
    for (*what = LIST; *what < VERBS_N && strcmp(word, VERBS[*what]) != 0; ++*what) {
    }
    if (*what == VERBS_N) {
        return sim_complain("params %.40s: must be list, get, set, load, save or defaults", word);
    }
    int result = SIM_OK;
    if (*what == SET || *what == LOAD) {
        while (result == SIM_OK && (word = poptGetArg(context)) != NULL) {
            result = *what == SET ? param_assignments_take(all, word)
                                  : param_assignments_read_ini(all, word);
        }
        if (result == SIM_OK && all->items_n == 0) {
            result = sim_complain("params %s: say %s; try limber params --help", VERBS[*what],
                                  *what == SET ? "NAME=VALUE" : "which file");
        }
    } else if (*what == GET && poptPeekArg(context) == NULL) {
        result = sim_complain("params get: say which; limber params list shows all");
    } else if (*what != GET) {
        result = link_no_more_arguments(context, "params");
    }
    return result;
}

static int act(params_command *c, poptContext context)
{
    param_assignments all = {NULL, 0};
    verb what = LIST;
    int result = take_arguments(context, &what, &all);
    if (result == SIM_OK) {
        result = link_open(&c->link, &c->s);
    }
    if (result == SIM_OK && what != SAVE && what != DEFAULTS) {
        result = param_table_read(&c->s, &c->table);
    }
    if (result == SIM_OK) {
        switch (what) {
        case SET:
        case LOAD:
            result = param_set_all(&c->s, &c->table, &all);
            break;
        case SAVE:
            result = save(c);
            break;
        case DEFAULTS:
            result = defaults(c);
            break;
        default:
            result = show_many(c, context);
        }
    }
    param_assignments_free(&all);
    param_table_free(&c->table);
    return result;
}

int limber_params_command(int argc, const char **argv)
{
    params_command c = {0};
    const struct poptOption table[] = {
        LINK_PORT_OPTION(&c.link),
        LINK_JSON_OPTION(&c.link),
        {"ini", 0, POPT_ARG_NONE, &c.ini, 0, "print a file that params load reads", NULL},
        OPTIONS_END};
    bool help;
    argv[0] = "limber params"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    poptSetOtherOptionHelp(
        context, "list | get NAME... | set NAME=VALUE... | load FILE.ini | save | defaults "
                 "[OPTION...]");
    int result = link_take_options(context, "params", EXAMPLES, &help);
    if (result == SIM_OK && !help) {
        result = act(&c, context);
    }
    poptFreeContext(context);
    link_close(&c.link, &c.s);
    return result;
}
