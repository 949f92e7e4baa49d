/* params_derived.h - what a rod of a material comes to: its figures for people, and what to be warned of. */
#ifndef LIMBER_PARAMS_DERIVED_H
#define LIMBER_PARAMS_DERIVED_H

#include <stdio.h>

#include "rod.h"

enum { PARAMS_MODES_N = 3 };

/* The first natural frequencies of an elastic rod in a still hand without gravity, Hz; as many as it has links, the
 * rest are 0. */
void params_modes_hz(const rod_params *elastic, double hz[PARAMS_MODES_N]);

/* How far the tip of an elastic rod sinks below straight when held out level, m, as long as that is little. */
double params_droop_m(const rod_params *elastic);

/* What to add to an INI file's title: the blank, and what the rod that follows from it is like. Each line begins with
 * an end of line and a comment sign. */
void params_derived_write(const rod_blank *blank, const rod_params *params, FILE *out);

/* One line on stderr for each thing that the rod, or a device at this tick, will not do as its blank would. */
void params_derived_warn(const rod_blank *blank, const rod_params *params);

#endif
