/* preset_command.c - limber preset: another rod, also while it moves. */
#include <stdio.h>

#include "link_options.h"
#include "texts.h"

static const char EXAMPLES[] = "  limber preset             # which there are\n"
                               "  limber preset whip\n"
                               "  limber preset --json\n\n"
                               "The rod passes over to the preset through a blend; limber params "
                               "save makes it last.\n";

static int list(session *s, bool json)
{
    cJSON *const all = json ? cJSON_CreateArray() : NULL;
    int result = SIM_OK;
    for (int i = 0, presets_n = 1; result == SIM_OK && i < presets_n; i++) {
        result = session_request(
            s, &(message){.type = MESSAGE_PRESET_LIST, .preset_list = {.index = (uint16_t)i}});
        if (result != SIM_OK) {
            break;
        }
        const message_preset_info *const info = &s->answer.preset_info;
        presets_n = info->presets_n;
        if (json) {
            cJSON *const one = cJSON_CreateObject();
            cJSON_AddStringToObject(one, "name", info->name);
            cJSON_AddStringToObject(one, "text", info->text);
            cJSON_AddItemToArray(all, one);
        } else {
            printf("%-14s %s\n", info->name, info->text);
        }
    }
    if (json && result == SIM_OK) {
        texts_print_json(all);
    } else {
        cJSON_Delete(all);
    }
    return result;
}

static int apply(session *s, const char *name)
{
    message ask = {.type = MESSAGE_PRESET};
    snprintf(ask.preset.name, sizeof ask.preset.name, "%.24s", name);
    const int result = session_request(s, &ask);
    if (result == SIM_OK) {
        printf("the rod is a %s now; limber params save makes it last\n", name);
    }
    return result;
}

static int act(link_options *link, session *s, poptContext context)
{
    const char *const name = poptGetArg(context);
    int result = link_no_more_arguments(context, "preset");
    if (result == SIM_OK) {
        result = link_open(link, s);
    }
    if (result == SIM_OK) {
        result = name == NULL ? list(s, link->json != 0) : apply(s, name);
    }
    return result;
}

int limber_preset_command(int argc, const char **argv)
{
    link_options link = {0};
    const struct poptOption table[] = {LINK_PORT_OPTION(&link), LINK_JSON_OPTION(&link),
                                       OPTIONS_END};
    session s = {0};
    bool help;
    argv[0] = "limber preset"; /* what the help calls it */
    poptContext context = poptGetContext(argv[0], argc, argv, table, 0);
    poptSetOtherOptionHelp(context, "[NAME] [OPTION...]");
    int result = link_take_options(context, "preset", EXAMPLES, &help);
    if (result == SIM_OK && !help) {
        result = act(&link, &s, context);
    }
    poptFreeContext(context);
    link_close(&link, &s);
    return result;
}
