/* servo_plant.h - servos that are slower and later than their goals, as real ones are; what turns, whatever tells it
 * to: pulses, or packets on a bus (bus_model.h). */
#ifndef LIMBER_SERVO_PLANT_H
#define LIMBER_SERVO_PLANT_H

#include <stdbool.h>

#include "servo_types.h"

enum { PLANT_DELAY_MAX_TICKS = 32 };

typedef struct {
    int delay_ticks;   /* from a goal to its servo's acting on it, below PLANT_DELAY_MAX_TICKS */
    float speed_rad_s; /* most it can do */
    bool powered;      /* the supply of all of them */
    bool torque[SERVO_COUNT_MAX];
    long tick;
    float goals_rad[PLANT_DELAY_MAX_TICKS][SERVO_COUNT_MAX]; /* ring, by tick */
    float newest_rad[SERVO_COUNT_MAX];
    float positions_rad[SERVO_COUNT_MAX];
} servo_plant;

void servo_plant_init(servo_plant *plant, int delay_ticks, float speed_rad_s);

/* A servo that is given torque starts from where it is and knows of no goal from before. */
void servo_plant_torque(servo_plant *plant, int servo, bool on);
void servo_plant_goal(servo_plant *plant, int servo, float goal_rad);

/* Whether any of them has both supply and torque. */
bool servo_plant_has_torque(const servo_plant *plant);

/* One tick later. Without supply or torque a servo stays where it is. */
void servo_plant_tick(servo_plant *plant, float tick_s);

#endif
