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

void servo_plant_write(servo_plant *plant, const float *goals_rad, int servos_n)
{
    plant->servos_n = servos_n;
    memcpy(plant->newest_rad, goals_rad, (size_t)servos_n * sizeof *goals_rad);
}

void servo_plant_tick(servo_plant *plant, float tick_s)
{
    float *now = plant->goals_rad[plant->tick % PLANT_DELAY_MAX_TICKS];
    memcpy(now, plant->newest_rad, sizeof plant->newest_rad);
    const long heard = plant->tick > plant->delay_ticks ? plant->tick - plant->delay_ticks : 0;
    const float *goals = plant->goals_rad[heard % PLANT_DELAY_MAX_TICKS];
    const float reach = plant->speed_rad_s * tick_s;
    for (int i = 0; i < plant->servos_n && plant->powered && !plant->failed; i++) {
        const float way = goals[i] - plant->positions_rad[i];
        plant->positions_rad[i] += fminf(fmaxf(way, -reach), reach);
    }
    plant->tick++;
}
