// The first pulse of a touch, followed on a chain of linear arms.
//
// While the arm presses on the wall its equations of motion are linearised where it is,
// z' = A z + b with z = (q, w, 1), and followed exactly by the propagator exp(A h). At every sample
// the true equations say how far off the linear ones are; where that is no longer small, the next
// linear arm begins. Hub friction changes its direction, sticks and breaks away on the way, and a
// voltage may be prescribed. The current of a motor with inductance is one more element of z, and
// held where it is at its limit. The pulse ends where the force vanishes.
#pragma once

#include "src/arm/chain.h"
#include "src/base/fault.h"
#include "src/predict/predict.h"

// A pulse that has not ended after this time is followed no further [s]; one whose force still
// rises then is doubtful.
#define PULSE_HORIZON 1.0

// Where a pulse begins.
typedef struct pulse_start {
    const double *q;         // angles[dof] at the touch [rad]
    const double *w;         // velocities[dof] just after the impact [rad/s]
    contact_state mode;      // just after it, with the motor's current
    voltage_profile command; // from the touch on; empty: the arm's own command stays
} pulse_start;

typedef struct pulse {
    double peak;            // largest force [N]
    double delay;           // of the peak after the touch [s]
    double length;          // until the force vanishes [s]; NaN if it does not within the horizon
    double restitution;     // e_eq of 4.1.1 [-]; NaN if the pulse does not end
    prediction_doubt doubt; // why peak and delay are not to be relied on; else DOUBT_NONE
} pulse;

// Follows the pulse of the arm, whose wall must be where the arm touches it. work: links elements
// of scratch. Allocates; a tenth of a millisecond for two links, milliseconds for twelve.
// STATUS_NO_MEMORY.
status pulse_follow(const arm *a, chain_link *work, const pulse_start *start, pulse *out);
