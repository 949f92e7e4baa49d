/* servo_plant.h - servos that are slower and later than their goals, as real ones are. */
#ifndef LIMBER_SERVO_PLANT_H
#define LIMBER_SERVO_PLANT_H

#include <stdbool.h>

#include "servo_map.h"

enum { PLANT_DELAY_MAX_TICKS = 32 };

typedef struct {
    int delay_ticks;   /* from a goal to its servo's hearing of it, below PLANT_DELAY_MAX_TICKS */
    float speed_rad_s; /* most it can do */
    bool powered, failed; /* failed: reports an error */
    int servos_n;
    long tick;
    float goals_rad[PLANT_DELAY_MAX_TICKS][SERVOS_MAX]; /* ring, by tick */
    float newest_rad[SERVOS_MAX];
    float positions_rad[SERVOS_MAX];
} servo_plant;

void servo_plant_init(servo_plant *plant, int delay_ticks, float speed_rad_s);
void servo_plant_write(servo_plant *plant, const float *goals_rad, int servos_n);

/* One tick later. Without power a servo stays where it is. */
void servo_plant_tick(servo_plant *plant, float tick_s);

#endif
