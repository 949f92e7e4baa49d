/* replay_pose_log.c - the joint angles that a device should have come to, from what it says it was given.
 *
 *     replay_pose_log NAME=VALUE... <poses >angles
 *
 * The parameters are those it was told to change. A line of poses is a POSE_LOG message: its tick, state and flags, and
 * the base's position and quaternion as the bits of their floats, in hexadecimal. All ticks, from the first
 * with a base on. A line of angles is the tick, and theta and phi of each joint as such bits.
 *
 * A device without servos: torque, and with it each state's blend, begins with the state.
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "body.h"

static float from_bits(uint32_t bits)
{
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static uint32_t to_bits(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static bool change(params *p, const char *text)
{
    char name[64];
    float value;
    params_refusal why;
    if (sscanf(text, "%63[^=]=%f", name, &value) != 2 ||
        !params_stage(p, name, 0, &value, 1, &why)) {
        fprintf(stderr, "replay_pose_log: cannot set %s\n", text);
        return false;
    }
    return true;
}

/* How long the joints pass over when the state changes. */
static uint32_t blend_us(supervisor_state before, supervisor_state now)
{
    for (int i = 0; i < SUPERVISOR_RULES_N; i++) {
        const supervisor_rule *rule = &supervisor_rules[i];
        if ((rule->from & 1u << before) != 0 && rule->to == now && before != now) {
            return rule->blend_us;
        }
    }
    return 0;
}

/* One line; false at the end. */
static bool read_tick(uint32_t *tick, supervisor_state *state, body_input *input)
{
    unsigned now, flags;
    uint32_t b[7];
    if (scanf("%" SCNu32 " %u %u %" SCNx32 " %" SCNx32 " %" SCNx32 " %" SCNx32 " %" SCNx32
              " %" SCNx32 " %" SCNx32,
              tick, &now, &flags, &b[0], &b[1], &b[2], &b[3], &b[4], &b[5], &b[6]) != 10 ||
        now >= SUPERVISOR_STATES_N) {
        return false;
    }
    *input = (body_input){
        .blend_us = blend_us(*state, now),
        .follow = (uint8_t)supervisor_duties[now].follow,
        .has_base = true,
        .restart = (flags & POSE_LOG_RESTART) != 0,
        .base = {{from_bits(b[0]), from_bits(b[1]), from_bits(b[2])},
                 {from_bits(b[3]), from_bits(b[4]), from_bits(b[5]), from_bits(b[6])}}};
    *state = now;
    return true;
}

static void tell(uint32_t tick, const body *b)
{
    rod_joint angles_rad[ROD_MAX_LINKS];
    body_angles(b, angles_rad);
    printf("%" PRIu32, tick);
    for (int i = 0; i < b->map.servos_n; i++) {
        printf(" %08" PRIx32, to_bits(angles_rad[i / 2][i % 2]));
    }
    printf("\n");
}

int main(int argc, char **argv)
{
    static params p;
    static body b;
    params_refusal why;
    params_init(&p);
    for (int i = 1; i < argc; i++) {
        if (!change(&p, argv[i])) {
            return 2;
        }
    }
    if (!params_commit(&p, true, &why) || !body_init(&b, &p.in_force, &why)) {
        fprintf(stderr, "replay_pose_log: %s: %s\n", why.field, why.text);
        return 2;
    }
    uint32_t tick;
    supervisor_state state = SUPERVISOR_DISARMED;
    body_input input;
    while (read_tick(&tick, &state, &input)) {
        body_tick(&b, &input);
        tell(tick, &b);
    }
    return 0;
}
