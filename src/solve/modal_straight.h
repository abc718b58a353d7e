// Products with the straight chain's mass and stiffness (modal_shapes.h) in O(N), as inline
// functions of numbers of the type `real`, which whoever includes this names.
#pragma once

#include "src/arm/arm.h"

#define STRAIGHT static inline __attribute__((always_inline))

// y = M0 x.
STRAIGHT void straight_mass_times(const arm *a, const real *x, real *y)
{
    const int N = a->links;
    const double l = a->link_length, m = a->link_mass, unit = m * l * l;
    const double own = a->link_inertia - 0.25 * unit; // A_ii beyond what A_ij would give
    const real *in = x + a->first;
    real *out = y + a->first;

    // A_ij = unit (N - 1 - max(i, j) + 1/2): links beyond, then links before
    real beyond = {0}, before = {0};
    for (int i = N - 1; i >= 0; i--) {
        out[i] = beyond;
        beyond += unit * (N - 0.5 - i) * in[i];
    }
    for (int i = 0; i < N; i++) {
        before += in[i];
        out[i] += unit * (N - 0.5 - i) * before + own * in[i];
    }

    const real hub = a->hub_inertia * x[0];
    y[0] = a->first > 0 ? hub : y[0] + hub;
}

// y = K x.
STRAIGHT void straight_stiffness_times(const arm *a, const real *x, real *y)
{
    real inner = {0};
    for (int k = 0; k < a->dof; k++) {
        real outer = {0};
        if (k + 1 < a->dof) {
            outer = (k + 1 == a->first ? a->hub_stiffness : a->joint_stiffness) * (x[k + 1] - x[k]);
        }
        y[k] = inner - outer;
        inner = outer;
    }
}

// g' x (modal_basis.h), the wall holding the last link `lever` of its lengths beyond its end.
STRAIGHT real straight_across(const arm *a, double lever, const real *x)
{
    real sum = lever * x[a->dof - 1];
    for (int k = a->first; k < a->dof; k++) {
        sum += x[k];
    }
    return sum;
}

// What moves the chain beyond the springs' torques at angles q that are small: `rate` of
// chain_from_momentum, those torques but for a sign, structural damping at velocities w, a torque
// on the hub [N m].
STRAIGHT void straight_forces_left(const arm *a, double torque, const real *q, const real *w,
                                   const real *rate, real *force)
{
    straight_stiffness_times(a, q, force);
    real inner = {0}; // torque of structural damping in the joint before
    for (int k = 0; k < a->dof; k++) {
        real outer = {0};
        if (k + 1 < a->dof) {
            const double damping = k + 1 == a->first ? a->hub_joint_damping : a->joint_damping;
            outer = damping * (w[k + 1] - w[k]);
        }
        force[k] = rate[k] - force[k] + outer - inner;
        inner = outer;
    }
    force[0] += torque;
}
