// One correction of Newton's iteration for an implicit step of the chain, in O(N).
//
// Newton's linear system is solved by two sweeps like those of chain.h. With dw = gamma'
// dq and da = beta' dq, the acceleration of a node changes by da_k = da_{k-1} + l z_k
// dq_k,
//     z_k = t_k (beta' - w_k^2) - r_k (alpha_k + 2 gamma' w_k),
// and the links beyond node k answer with force and joint torque
//     dF = P da_{k-1} + p_f dq_{k-1} + F0,   dT = p_t' da_{k-1} + y dq_{k-1} + T0.
// Only the small change of the contact point's lever with the base's displacement is left
// out (it is of order f l against I / h^2), so Newton converges a little slower than
// quadratically.
#pragma once

#include "src/arm/chain.h"

// One link's share of the tangent system, kept between the two sweeps of its solution.
typedef struct implicit_sweep {
    double c, s;             // direction of the link
    double com_x, com_y;     // acceleration of its centre of mass [m/s2]
    double force_x, force_y; // force it gives to the links beyond [N]
    double zx, zy;           // d(node acceleration)/d(angle) / l [1/s2]
    double vx, vy;           // dependence on the base's acceleration, over the pivot
    double to_parent;        // dependence on the parent's angle, over the pivot
    double free, unit;       // right-hand sides over the pivot
} implicit_sweep;

// How rates follow the angles in the step.
typedef struct implicit_tangent {
    double beta;  // beta': acceleration per angle [1/s2]
    double gamma; // gamma': velocity per angle [1/s]
} implicit_tangent;

// What is iterated: the end of a step.
typedef struct implicit_iterate {
    const double *q, *w;        // angles and velocities of all bodies [rad, rad/s]
    const double *acceleration; // [rad/s2]
    double force;               // of the wall [N]
    bool contact, stuck;
    bool velocity_level; // the constraint is dg/dt = 0 instead of g = 0
    double sliding;      // Coulomb friction torque while sliding [N m]
    double excess; // out: what the balance of a stuck hub lacks, minus friction [N m]
} implicit_iterate;

// Solves the tangent system for the correction of the angles, dq[dof] [rad], and returns
// that of the force [N]: 0 without contact. link[links] and unit[dof], the angles' answer
// to a unit force, are scratch.
double implicit_correction(const arm *a, implicit_sweep *link, implicit_iterate *it,
                           implicit_tangent t, double *dq, double *unit);
