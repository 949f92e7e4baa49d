/* elastic.c - see elastic.h: what is prepared before a step, and ways into a state and out of it. */
#include "elastic.h"

#include <string.h>

#include "elastic_private.h"

int elastic_factor(const elastic *model, const float *stiffness, const float *tension,
                   penta *system)
{
    bending_bands bands;
    bending_assemble(model->link, model->links_n, stiffness, tension, &bands);
    return penta_factor(system, model->links_n, bending_diagonal(&bands), bending_off1(&bands),
                        bands.off2);
}

void elastic_straight_stiffness(const elastic *model, float *stiffness)
{
    for (int j = 0; j < model->links_n; j++) {
        stiffness[j] = model->row[j].spring + model->row[j].damper;
    }
}

/* And a little, for ticks that float32 makes a little longer: 0.01f is ten steps, not eleven. */
static const float STEP_S = 1.0001e-3f, LONGEST_STEP_S = 2.0002e-3f, LONGEST_AMONG_S = 4.0004e-3f;

int elastic_steps_n(float tick_s, bool among)
{
    const float longest_s = among ? LONGEST_AMONG_S : LONGEST_STEP_S;
    int steps_n = 1;
    while (tick_s > longest_s && tick_s > (float)steps_n * STEP_S) {
        steps_n++;
    }
    return steps_n;
}

static void stretch(vec3 *v, float ratio)
{
    *v = vec3_scale(*v, ratio);
}

void elastic_change_step(elastic_state *state, int links_n, float ratio)
{
    for (int i = 0; i < links_n; i++) {
        stretch(&state->link_step[i], ratio);
        stretch(&state->speed_step[i], ratio);
        state->tension[i] *= ratio * ratio;
        state->tension_step[i] *= ratio * ratio * ratio;
    }
    stretch(&state->base_step_m, ratio);
    stretch(&state->axis_step, ratio);
    state->spin_step *= ratio;
}

rod_error elastic_prepare(elastic *model, const rod_params *params, bool among, int *row_n)
{
    model->links_n = params->links_n;
    model->steps_n = elastic_steps_n(params->tick_s, among);
    model->step_share = 1.0f / (float)model->steps_n;
    model->h_s = params->tick_s * model->step_share * (2.0f / 3.0f);
    model->per_h = 1.0f / model->h_s;
    const float h_squared = model->h_s * model->h_s;
    model->fall_m = h_squared * params->gravity_m_s2;
    for (int i = 0; i < params->links_n; i++) {
        const float drag = model->h_s * params->drag[i];
        model->link[i] = (bending_link){.length_m = params->length_m[i],
                                        .per_length = 1.0f / params->length_m[i],
                                        .own_kg = params->mass_kg[i] + drag};
        model->row[i] = (elastic_row){
            .mass_kg = params->mass_kg[i],
            .per_mass = 1.0f / params->mass_kg[i],
            .drag = drag,
            .spring = h_squared * params->spring[i],
            .damper = model->h_s * params->damper[i],
        };
    }
    float stiffness[ROD_MAX_LINKS];
    penta system;
    elastic_straight_stiffness(model, stiffness);
    *row_n = elastic_factor(model, stiffness, NULL, &system);
    return *row_n == 0 ? ROD_OK : ROD_E_PIVOT;
}

/* --- from and to joint angles -------------------------------------------------------------------- */

/* Not inlined: it is long, and called twice a link where a rod is laid. */
static __attribute__((noinline)) void turn_frame(frame3 *frame, float theta_rad, float phi_rad)
{
    const joint_trig t = kinematics_trig((const rod_joint){theta_rad, phi_rad});
    *frame = kinematics_turn(frame, &t);
}

void elastic_lay(const elastic *model, const rod_pose *base, const rod_motion *motion,
                 const rod_joint *angle_rad, const rod_joint *increment_rad, elastic_state *state)
{
    const rod_pose before = kinematics_pose_before(base, motion);
    frame3 now_frame = quat_frame(base->orientation), before_frame = quat_frame(before.orientation);
    const float per_step = model->per_h * (2.0f / 3.0f), share = model->step_share;
    memset(state, 0, sizeof *state);
    state->axis_step = vec3_scale(vec3_sub(now_frame.z, before_frame.z), share);
    state->base_step_m = vec3_scale(vec3_sub(base->position_m, before.position_m), share);
    state->spin_step -= share * 2.0f * (motion->turn.w < 0.0f ? -motion->turn.z : motion->turn.z);
    vec3 step_m = state->base_step_m;
    for (int i = 0; i < model->links_n; i++) {
        const float *angles = angle_rad[i], *gained = increment_rad[i];
        turn_frame(&now_frame, angles[ROD_THETA], angles[ROD_PHI]);
        turn_frame(&before_frame, angles[ROD_THETA] - gained[ROD_THETA],
                   angles[ROD_PHI] - gained[ROD_PHI]);
        state->link[i] = now_frame.z;
        state->link_step[i] = vec3_scale(vec3_sub(now_frame.z, before_frame.z), share);
        step_m = vec3_add_scaled(step_m, state->link_step[i], model->link[i].length_m);
        state->speed_m_s[i] = vec3_scale(step_m, per_step);
        state->angle_rad[i][ROD_THETA] = angles[ROD_THETA];
        state->angle_rad[i][ROD_PHI] = angles[ROD_PHI];
    }
}

void elastic_increments(const elastic *model, const rod_pose *base, const rod_motion *motion,
                        const elastic_state *state, rod_joint *increment_rad)
{
    const rod_pose before = kinematics_pose_before(base, motion);
    vec3 links_before[ROD_MAX_LINKS];
    for (int i = 0; i < model->links_n; i++) {
        links_before[i] =
            vec3_add_scaled(state->link[i], state->link_step[i], -(float)model->steps_n);
        for (int axis = 0; axis < 2; axis++) {
            increment_rad[i][axis] = state->angle_rad[i][axis];
        }
    }
    kinematics_angles(&before, links_before, model->links_n, increment_rad);
    for (int i = 0; i < model->links_n; i++) {
        for (int axis = 0; axis < 2; axis++) {
            const float gained = state->angle_rad[i][axis] - increment_rad[i][axis];
            increment_rad[i][axis] = gained > TRIG_PI    ? gained - 2.0f * TRIG_PI
                                     : gained < -TRIG_PI ? gained + 2.0f * TRIG_PI
                                                         : gained;
        }
    }
}

void elastic_nodes(const elastic *model, const elastic_state *state, const rod_pose *base,
                   vec3 *nodes_m)
{
    nodes_m[0] = base->position_m;
    for (int i = 0; i < model->links_n; i++) {
        nodes_m[i + 1] = vec3_add_scaled(nodes_m[i], state->link[i], model->link[i].length_m);
    }
}
