/* stats_request.c - see stats_request.h. */
#include "stats_request.h"

#include <string.h>

int stats_request(session *s, message_stats *stats)
{
    const int result = session_request(s, &(message){.type = MESSAGE_STATS_GET});
    if (result == SIM_OK) {
        *stats = s->answer.stats;
    }
    return result;
}

void stats_each(const message_stats *stats,
                void (*take)(void *context, const char *name, uint32_t value), void *context)
{
    const message_info *const info = messages_info(MESSAGE_STATS);
    const message m = {.type = MESSAGE_STATS, .stats = *stats};
    for (int i = 0; i < info->fields_n; i++) {
        uint32_t value;
        if (info->fields[i].type == WIRE_U32) {
            memcpy(&value, (const char *)&m + info->fields[i].offset, sizeof value);
            take(context, info->fields[i].name, value);
        }
    }
}
