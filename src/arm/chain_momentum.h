// Hamilton's side of the chain: momenta, and the velocities and forces that belong to them, in a
// time that grows linearly with N.
//
//     p = M(q) w,      p' = dT/dq + tau(q, w) - J^T f,
//     dT/dq_i = -sum_j A_ij sin(q_i - q_j) w_i w_j
//
// With the impulse of the contact force from some instant on, L' = f, the sum P = p + J^T L obeys
//
//     P' = dT/dq + tau + J'^T L,      M w + J^T L = P,      J w = 0 in contact,
//
// in which no force stands: L comes out of P like w. What vibrates fast enters these equations
// undifferentiated, which is why long strides are made with them (modal_stride.h).
#pragma once

#include "src/arm/chain.h"

// p[dof] at angles q[dof] and velocities w[dof].
void chain_momentum(const arm *a, const double *q, const double *w, double *p);

// Velocities w[dof] and the impulse L (zero without contact) that belong to P = momentum[dof], and
// rate[dof] = dT/dq + J'^T L. A stuck hub has no velocity. work: links elements of scratch.
void chain_from_momentum(const arm *a, chain_link *work, contact_state mode, const double *q,
                         const double *momentum, double *w, double *rate, double *impulse);
