/* body.h - the rod, what it touches, and the servos that follow it: everything of the device that computes angles.
 *
 * One tick takes one body_input and gives goals; beside it only the calls that change something get in, between two
 * ticks. So a log of both, replayed, gives the same goals to the bit (limber-sim replay --per-tick), and the rest of
 * the device (line, clock, states) can be tested without the rod.
 *
 *     base pose -> rod_step -> joint angles -> targets -> blend -> limits -> goals
 *
 * The rod is stepped at every tick, the servos are served every servo_period_ticks. Caller-owned, no heap; main
 * loop only; 20 KB at 64 links.
 */
#ifndef LIMBER_BODY_H
#define LIMBER_BODY_H

#include "params.h"
#include "rod.h"
#include "servo_blend.h"
#include "servo_map.h"
#include "supervisor.h"

/* All that happens to the body in one tick, in the order in which it is carried out. Plain values: a log
 * may keep it as it lies in memory. */
typedef struct {
    uint32_t blend_us; /* start a blend from rest over this time; 0: none */
    uint8_t follow;    /* supervisor_follow, from this tick on */
    bool new_params;   /* body_change has been called since the last tick (for logs) */
    bool placed;       /* body_place has (likewise) */
    bool has_base;     /* step the rod with this base */
    bool restart;      /* after laying it straight and at rest */
    rod_pose base;
} body_input;

/* A shape for the rod to take: as many angles as it has links, or none: then it is let go. Plain values, too. */
typedef struct {
    float strength_nm, blend_s;
    int32_t angles_n;
    rod_joint angle_rad[ROD_MAX_LINKS];
} body_shape;

typedef struct {
    rod rod;
    scene scene; /* what the rod may touch; empty after body_init */
    uint32_t
        shape_ticks; /* a shape will pull at the rod for so long; UINT32_MAX: until it is let go */
    servo_map map;
    servo_blend blend;
    float blend_s;
    int servo_period_ticks, ticks_to_servos;
    uint8_t follow;
    bool goals_new;   /* the servos were served in the last tick */
    bool finite;      /* the last rod_step was */
    uint32_t limited; /* SERVO_... flags of the last service */
} body;

/* False with *why filled where the parameters do not go together; b is then not to be used. */
bool body_init(body *b, const params_set *set, params_refusal *why);

/* Other parameters from the next tick on. all_new: the servo side too (only without torque: goals start from
 * straight); otherwise the rod's, through a blend from motion over blend_s. On false nothing has changed. */
bool body_change(body *b, const params_set *set, bool all_new, params_refusal *why);

/* Puts an object in a place of the scene (scene_put); it stays over changes of parameters. On an error nothing has
 * changed. */
rod_error body_put_object(body *b, int index, const scene_object *object, scene_refusal *refusal);

/* Pulls the rod into a shape, or lets it go (rod_set_shape); it stays over changes of parameters, but not of the
 * number of links. */
rod_error body_take_shape(body *b, const body_shape *shape);

/* How many nodes touch that object of the scene, or any (BODY_ANY_OBJECT), and what they are pushed with in all. */
enum { BODY_ANY_OBJECT = -1 };
int body_touch(const body *b, int object, vec3 *force_newton);

/* The goals are where the servos are: before they get torque. Returns SERVO_OK or SERVO_E_POSITION. */
servo_error body_place(body *b, const float *positions_rad);

/* One tick. */
void body_tick(body *b, const body_input *input);

/* Goals of the servos, rad of the shaft, map.servos_n of them. */
const float *body_goals(const body *b);

/* One of them as the angle of its joint's axis: what ANGLES reports. Servo 2i is theta of joint i, 2i + 1 its phi. */
static inline float body_angle_rad(const body *b, int servo)
{
    const servo_motion *s = &b->map.servo[servo];
    return (b->map.goals_rad[servo] - s->offset_rad) * s->sign;
}

/* All of them, links_n rows. */
void body_angles(const body *b, rod_joint *angles_rad);

#endif
