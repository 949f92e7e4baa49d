/* servo_pwm.h - hobby servos on the hal's PWM channels; servos.h is the way in.
 *
 * A hobby servo does not tell where it is: its first move, from wherever it is to its goal, is its own and as fast
 * as it can. So no two begin at once: channels get pulses one at a time, SERVOS_PWM_STEP_US apart, in the order of
 * config.id. From then on each follows its goals. Caller-owned, no heap, main loop only.
 */
#ifndef LIMBER_SERVO_PWM_H
#define LIMBER_SERVO_PWM_H

#include <stdbool.h>
#include <stdint.h>

#include "hal.h"
#include "servo_types.h"

enum {
    SERVOS_PWM_STEP_US = 100000,
    SERVOS_PWM_MIN_US = 500,
    SERVOS_PWM_MAX_US = 2500,
};

/* Where a test of one channel is. Private. */
typedef struct {
    uint8_t id;
    bool busy;
    float turn_rad;
    uint32_t since_us;
} servo_pwm_test;

/* Treat as private. *hal and *config must outlive it. */
typedef struct {
    const hal *hal;
    const servos_config *config;
    int enabled_n; /* the first so many of config.id have pulses */
    bool on;
    uint32_t step_us; /* when the last was enabled */
    float goals_rad[HAL_PWM_CHANNELS_N];
    servo_pwm_test test;
} servo_pwm;

/* Whether the configuration can be driven; *trouble says why not. */
bool servo_pwm_check(const servos_config *config, servo_trouble *trouble);

void servo_pwm_init(servo_pwm *p, const hal *hal, const servos_config *config);

/* Pulses at config.pwm_hz from now on, none on any channel yet; false where the board cannot. */
bool servo_pwm_start(servo_pwm *p);

/* The first channel at once, the others one by one. */
void servo_pwm_torque(servo_pwm *p, const float *goals_rad, uint32_t now_us);

void servo_pwm_goals(servo_pwm *p, const float *goals_rad);

void servo_pwm_off(servo_pwm *p);

/* Turns one channel from the middle of its travel by turn_rad and back, then stops its pulses: 1.6 s. */
void servo_pwm_test_start(servo_pwm *p, uint8_t id, float turn_rad, uint32_t now_us);

void servo_pwm_tick(servo_pwm *p, uint32_t now_us);

/* The pulse for a goal, us. */
uint32_t servo_pwm_width_us(const servos_config *config, float goal_rad);

#endif
