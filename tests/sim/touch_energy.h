/* touch_energy.h - the energy of the touch fixture's rod and the virtual work on it, in double, from its joint angles. */
#ifndef LIMBER_TOUCH_ENERGY_H
#define LIMBER_TOUCH_ENERGY_H

#include "touch_fixture.h"

static inline bool is_elastic(void)
{
    return params.model == ROD_MODEL_ELASTIC;
}

/* k alpha^2 / 2 of every joint and m g z of every node. */
static inline double elastic_potential(const joint_double *angle_rad)
{
    static point_double place_m[ROD_MAX_LINKS + 1];
    double sum = 0.0;
    nodes_double(&hand, angle_rad, params.length_m, params.links_n, place_m);
    for (int i = 0; i < params.links_n; i++) {
        const double theta = angle_rad[i][ROD_THETA], phi = angle_rad[i][ROD_PHI];
        const double aside = hypot(cos(phi) * sin(theta), sin(phi));
        const double alpha = atan2(aside, cos(phi) * cos(theta));
        sum += 0.5 * (double)params.spring[i] * alpha * alpha +
               (double)params.mass_kg[i] * (double)params.gravity_m_s2 * place_m[i + 1][2];
    }
    return sum;
}

/* Eq. 7 and 8 and the smoothing, for both axes: MODEL.md, Section 3. */
static inline double contour_potential(const joint_double *angle_rad)
{
    double sum = 0.0;
    for (int axis = 0; axis < 2; axis++) {
        for (int i = 0; i < params.links_n; i++) {
            const double here = angle_rad[i][axis];
            const double before = i > 0 ? angle_rad[i - 1][axis] : 0.0;
            sum += 0.5 * (double)params.spring[i] * here * here +
                   0.5 * (double)params.coupling[i] * (here - before) * (here - before);
            if (i + 1 < params.links_n) {
                const double curl = angle_rad[i + 1][axis] - 2.0 * here + before;
                sum += 0.5 * (double)params.smoothing[i] * curl * curl;
            }
        }
    }
    return sum;
}

static inline double potential_of(const joint_double *angle_rad)
{
    return is_elastic() ? elastic_potential(angle_rad) : contour_potential(angle_rad);
}

static inline void read_angles(joint_double *angle_rad)
{
    for (int i = 0; i < params.links_n; i++) {
        angle_rad[i][ROD_THETA] = (double)rod_angles(&r)[i][ROD_THETA];
        angle_rad[i][ROD_PHI] = (double)rod_angles(&r)[i][ROD_PHI];
    }
}

/* How far the rod is from equilibrium with what the objects push it with: the virtual work on any one joint angle that is
 * left over, as a share of the largest that the forces do. */
static inline double out_of_balance(void)
{
    static joint_double angle_rad[ROD_MAX_LINKS];
    static point_double less[ROD_MAX_LINKS + 1], more[ROD_MAX_LINKS + 1];
    const double turn = 1e-5;
    double worst = 0.0, largest = 0.0;
    int contacts_n;
    const touch_contact *contact = rod_contacts(&r, &contacts_n);
    read_angles(angle_rad);
    for (int i = 0; i < 2 * params.links_n; i++) {
        double *angle = &angle_rad[i / 2][i % 2];
        const double here = *angle;
        double work = 0.0;
        *angle = here + turn;
        nodes_double(&hand, angle_rad, params.length_m, params.links_n, more);
        double left = potential_of(angle_rad);
        *angle = here - turn;
        nodes_double(&hand, angle_rad, params.length_m, params.links_n, less);
        left -= potential_of(angle_rad);
        *angle = here;
        for (int k = 0; k < contacts_n; k++) {
            const vec3 f = contact[k].force_newton;
            const double *to = more[contact[k].node], *from = less[contact[k].node];
            work += (double)f.x * (to[0] - from[0]) + (double)f.y * (to[1] - from[1]) +
                    (double)f.z * (to[2] - from[2]);
        }
        worst = worse(worst, fabs(left - work));
        largest = worse(largest, fabs(work));
    }
    return worst / largest;
}

/* --- energy while the hand is still --------------------------------------------------------------------- */

static inline double elastic_energy(void)
{
    static joint_double angle_rad[ROD_MAX_LINKS];
    double sum = 0.0;
    read_angles(angle_rad);
    for (int i = 0; i < params.links_n; i++) {
        const double speed = length_double(r.as.elastic.state.speed_m_s[i]);
        sum += 0.5 * (double)params.mass_kg[i] * speed * speed;
    }
    return sum + elastic_potential(angle_rad);
}

/* What a step keeps: the speed over the last tick, and the bend halfway through it. */
static inline double contour_energy(void)
{
    static joint_double halfway[ROD_MAX_LINKS];
    const rod_joint *increment = r.as.contour.state[r.as.contour.current].increment_rad;
    double sum = 0.0;
    read_angles(halfway);
    for (int i = 0; i < 2 * params.links_n; i++) {
        const double gained = (double)increment[i / 2][i % 2];
        const double speed = gained / (double)params.tick_s;
        sum += 0.5 * (double)params.inertia[i / 2] * speed * speed;
        halfway[i / 2][i % 2] -= 0.5 * gained;
    }
    return sum + contour_potential(halfway);
}

static inline double energy(void)
{
    return is_elastic() ? elastic_energy() : contour_energy();
}

#endif
