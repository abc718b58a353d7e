// Two links on a rigid hub against a rigid wall, in closed form: what chain.h has of any
// chain, for the arm that nearly every run is of. With the bend d = q2 - q1, S and C the
// sine and cosine of a link's angle from the wall times its reach (taylor_order.h):
//
//     m11 a1 + m12 cos d a2 = hub torque + joint + m12 sin d w2^2 - J1 f
//     m12 cos d a1 + m22 a2 =           - joint - m12 sin d w1^2 - J2 f
#pragma once

#include "src/arm/chain_link.h"
#include "src/base/sincos.h"

// Whether an arm is such a pair.
static inline bool pair_suits(const arm *a)
{
    return a->links == 2 && !a->hub_spring && wall_stands(&a->wall) &&
           !wall_gives(&a->wall) && arm_is_plain(a);
}

// How the wall meets the arm: the gap, the entries of dg/dq for the penetration g = -gap,
// and what is needed for g's second derivative.
typedef struct pair_contact {
    double sine, cosine; // of the bend
    double gap;          // [m]
    double j1, j2;       // [m]
    double s1, s2;       // plane: S of both links; point: l sin d and S2 [m]
} pair_contact;

// Computes that at the angles q.
static inline pair_contact pair_contact_at(const arm *a, const double *q)
{
    const wall_model *wall = &a->wall;
    const double l = a->link_length;
    double sine1, cosine1, sine2, cosine2;
    inline_sincos(q[0], &sine1, &cosine1);
    inline_sincos(q[1], &sine2, &cosine2);
    pair_contact at = {.sine = sine2 * cosine1 - cosine2 * sine1,
                       .cosine = cosine2 * cosine1 + sine2 * sine1};

    if (wall->kind == WALL_POINT) {
        at.s1 = l * at.sine;
        at.s2 = wall->x * sine2 - wall->y * cosine2;
        at.j1 = l * at.cosine;
        at.j2 = wall->x * cosine2 + wall->y * sine2 - at.j1;
        at.gap = at.s1 - at.s2;
    } else {
        at.s1 = l * (wall->cosine * sine1 - wall->sine * cosine1);
        at.s2 = l * (wall->cosine * sine2 - wall->sine * cosine2);
        at.j1 = l * (wall->cosine * cosine1 + wall->sine * sine1);
        at.j2 = l * (wall->cosine * cosine2 + wall->sine * sine2);
        at.gap = -(at.s1 + at.s2);
    }
    return at;
}

// Entries of the mass matrix [kg m2].
typedef struct pair_mass {
    double m11, m12, m22; // m12 without the bend's cosine
} pair_mass;

static inline pair_mass pair_mass_of(const arm *a)
{
    const double square = a->link_mass * a->link_length * a->link_length;
    const double m22 = a->link_inertia + square / 4;
    return (pair_mass){m22 + square + a->hub_inertia, square / 2, m22};
}

// Solves M x = b; `coupling` is m12 times the bend's cosine. If the hub is stuck, its
// friction balances b1, and x1 is 0.
static inline void pair_solve(const pair_mass *m, double coupling, bool stuck, double b1,
                              double b2, double *x1, double *x2)
{
    if (stuck) {
        *x1 = 0;
        *x2 = b2 / m->m22;
        return;
    }
    const double per_det = 1 / (m->m11 * m->m22 - coupling * coupling);
    *x1 = (m->m22 * b1 - coupling * b2) * per_det;
    *x2 = (m->m11 * b2 - coupling * b1) * per_det;
}

// Accelerations and reactions of a pair, as chain_accelerations gives them: those without
// the wall, then the force that keeps the penetration's second derivative zero.
static inline void pair_accelerations(const arm *a, const double *q, const double *w,
                                      contact_state mode, double *alpha,
                                      chain_reaction *reaction)
{
    const pair_contact at = pair_contact_at(a, q);
    const pair_mass m = pair_mass_of(a);
    const double bend = q[1] - q[0], rate = w[1] - w[0], coupling = m.m12 * at.cosine;
    const double first = w[0] * w[0], second = w[1] * w[1];
    const bool stuck = mode.friction == HUB_STICK;

    // the accelerations without the wall
    const double sliding = -mode.friction * a->motor.stiction;
    const double joint = a->joint_stiffness * bend + a->joint_damping * rate;
    const double swing = m.m12 * at.sine;
    const double b1 =
        a->motor.torque - a->motor.damping * w[0] + sliding + joint + swing * second;
    const double b2 = -joint - swing * first;
    double a1, a2;
    pair_solve(&m, coupling, stuck, b1, b2, &a1, &a2);

    // g's second derivative, which in contact the force makes zero
    const double convective = a->wall.kind == WALL_POINT
                                  ? at.s1 * rate * rate - at.s2 * second
                                  : -(at.s1 * first + at.s2 * second);
    double closing = at.j1 * a1 + at.j2 * a2 + convective, force = 0;
    if (mode.contact) {
        double y1, y2;
        pair_solve(&m, coupling, stuck, at.j1, at.j2, &y1, &y2);
        force = closing / (at.j1 * y1 + at.j2 * y2);
        a1 -= y1 * force;
        a2 -= y2 * force;
        closing = 0;
    }

    alpha[0] = a1;
    alpha[1] = a2;
    *reaction = (chain_reaction){
        .force = force,
        .friction = stuck ? coupling * a2 + at.j1 * force - b1 : sliding,
        .gap_acceleration = -closing,
        .gap = at.gap,
        .gap_velocity = -(at.j1 * w[0] + at.j2 * w[1]),
        .viscous_power = a->motor.damping * first,
        .damping_power = a->joint_damping * rate * rate,
    };
}

// chain_contact_response of a pair: [1/(kg m)], and the compliance J M^-1 J^T [1/kg].
static inline double pair_contact_response(const arm *a, const double *q, bool hub_locked,
                                           double *response)
{
    const pair_contact at = pair_contact_at(a, q);
    const pair_mass m = pair_mass_of(a);
    pair_solve(&m, m.m12 * at.cosine, hub_locked, -at.j1, -at.j2, &response[0],
               &response[1]);
    return -(at.j1 * response[0] + at.j2 * response[1]);
}
