/* servo_scan.h - limber servo scan: which servos there are. */
#ifndef LIMBER_SERVO_SCAN_H
#define LIMBER_SERVO_SCAN_H

#include <stdbool.h>

#include "session.h"

typedef struct {
    uint32_t baud;  /* 0: the device's servo_baud */
    bool all_bauds; /* one after the other */
    int first_id, last_id;
    bool json;
} servo_scan_options;

/* Prints them, and on a terminal how far it is. SIM_OK; LIMBER_DEVICE after complaining, also if there are none;
 * LIMBER_INTERRUPTED with those that had been found by then, after taking the servos' supply (servo_ask_stop).
 * all_bauds passes over rates that the board cannot make, with a note for each. */
int servo_scan(session *s, const servo_scan_options *options);

#endif
