/* answers.h - ACK and NACK: what a request came to, and the same again when it is repeated. */
#ifndef LIMBER_ANSWERS_H
#define LIMBER_ANSWERS_H

#include "device.h"

/* Done. */
void answers_acknowledge(device *d, uint16_t request_id, uint8_t type);

/* Not done; why->text NULL: the reason's own words. */
void answers_refuse(device *d, uint16_t request_id, uint8_t type, const params_refusal *why);

/* The same where there is no field to name; text may be NULL. */
void answers_refuse_for(device *d, uint16_t request_id, uint8_t type, uint8_t reason,
                        const char *text);

/* Requests that change something are done once, however often they arrive: true if this one has been, and
 * has now been answered as it was then. */
bool answers_repeat(device *d, uint16_t request_id, uint8_t type);

#endif
