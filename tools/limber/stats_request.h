/* stats_request.h - the device's counters, asked for. */
#ifndef LIMBER_STATS_REQUEST_H
#define LIMBER_STATS_REQUEST_H

#include "session.h"

/* SIM_OK with *stats, or LIMBER_DEVICE after complaining. */
int stats_request(session *s, message_stats *stats);

/* Calls `take` with the name and value of each counter. */
void stats_each(const message_stats *stats,
                void (*take)(void *context, const char *name, uint32_t value), void *context);

#endif
