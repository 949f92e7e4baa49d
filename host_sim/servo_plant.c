/* servo_plant.c - see servo_plant.h. */
#include "servo_plant.h"

#include <math.h>
#include <string.h>

void servo_plant_init(servo_plant *plant, int delay_ticks, float speed_rad_s)
{
    memset(plant, 0, sizeof *plant);
    plant->delay_ticks = delay_ticks;
    plant->speed_rad_s = speed_rad_s;
}

void servo_plant_torque(servo_plant *plant, int servo, bool on)
{
    if (on && !plant->torque[servo]) {
        for (int i = 0; i < PLANT_DELAY_MAX_TICKS; i++) {
            plant->goals_rad[i][servo] = plant->positions_rad[servo];
        }
        plant->newest_rad[servo] = plant->positions_rad[servo];
    }
    plant->torque[servo] = on;
}

void servo_plant_goal(servo_plant *plant, int servo, float goal_rad)
{
    plant->newest_rad[servo] = goal_rad;
}

bool servo_plant_has_torque(const servo_plant *plant)
{
    bool any = false;
    for (int i = 0; i < SERVO_COUNT_MAX; i++) {
        any = any || plant->torque[i];
    }
    return any && plant->powered;
}

void servo_plant_tick(servo_plant *plant, float tick_s)
{
    float *now = plant->goals_rad[plant->tick % PLANT_DELAY_MAX_TICKS];
    memcpy(now, plant->newest_rad, sizeof plant->newest_rad);
    const long heard = plant->tick > plant->delay_ticks ? plant->tick - plant->delay_ticks : 0;
    const float *goals = plant->goals_rad[heard % PLANT_DELAY_MAX_TICKS];
    const float reach = plant->speed_rad_s * tick_s;
    for (int i = 0; i < SERVO_COUNT_MAX && plant->powered; i++) {
        const float way = plant->torque[i] ? goals[i] - plant->positions_rad[i] : 0.0f;
        plant->positions_rad[i] += fminf(fmaxf(way, -reach), reach);
    }
    plant->tick++;
}
