/* param_set.h - parameters to the device: all of them or none. */
#ifndef LIMBER_PARAM_SET_H
#define LIMBER_PARAM_SET_H

#include "param_text.h"

/* Stages every assignment and commits them together. If one is refused, what had been staged before is taken
 * back. SIM_OK after saying so, or an exit code after complaining. */
int param_set_all(session *s, const param_table *table, const param_assignments *all);

#endif
