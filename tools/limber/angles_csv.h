/* angles_csv.h - ANGLES as the simulator's CSV: t,theta1,phi1,... in s and rad; nan where there is no angle. */
#ifndef LIMBER_ANGLES_CSV_H
#define LIMBER_ANGLES_CSV_H

#include <stdbool.h>
#include <stdint.h>

#include "messages.h"
#include "output.h"

typedef struct {
    output out;
    bool begun;
    uint32_t first_tick, last_tick;
    double tick_hz;
    int joints_n;
    uint64_t rows_n, left_out_n; /* left out: of a rod with another number of joints */
} angles_csv;

/* SIM_OK, or SIM_BAD_INPUT after complaining. A path of NULL: nothing is written, and that is fine. */
int angles_csv_open(angles_csv *csv, const char *path, double tick_hz);
void angles_csv_add(angles_csv *csv, const message_angles *angles);

/* The file appears whole; an empty one is no file. Returns `result`, or SIM_BAD_INPUT if the disk refuses. */
int angles_csv_close(angles_csv *csv, int result);

#endif
