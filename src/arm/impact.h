// The impact law: jump of the velocities, impulse and energy loss.
#pragma once

#include "src/arm/chain.h"

typedef struct impact_result {
    double speed;   // approach speed of the contact point to the wall's face, J w [m/s]
    double impulse; // p of the wall [N s]
    double loss;    // energy lost [J]
    double work;    // of a wall that moves [J]
} impact_result;

// Instantaneous velocity increments, (4.10)-(4.17) for N links. While the impulse acts,
// angles and the finite torques of springs, motor and friction change nothing, so
//
//     M dw = -J^T p,      J (w + dw) = -e J w,
//
// which gives p = (1 + e) J w / (J M^-1 J^T). A hub behind a spring keeps its velocity,
// (4.10); a rigid one jumps with the first link, sticking or not (errata B6). The loss of
// energy,
//
//     loss = p (1 - e) J w / 2,
//
// is never negative. A wall's face of mass M_f gains the velocity p/M_f: J w is then
// replaced by the relative speed (J w less the face's velocity), and J M^-1 J^T by J M^-1
// J^T + 1/M_f.
//
// On a wall that moves, J w is the speed relative to it, too; it then does the work of
// the impulse at its own speed.
//
// q[dof], w[dof]: the state before; face: velocity of the wall's face [m/s], 0 without a
// mass; work: links elements of scratch; increment[dof]: dw [rad/s].
impact_result impact_velocity_increments(const arm *a, chain_link *work, const double *q,
                                         const double *w, double face, double restitution,
                                         double *increment);
