// The first pulse of a touch, followed by the arm's own engine from the touch on.
#pragma once

#include "src/arm/arm.h"
#include "src/predict/predict.h"

// A pulse that has not ended after this time is followed no further [s]; one whose force still
// rises then is doubtful.
#define PULSE_HORIZON 1.0

// What is asked of a pulse.
typedef struct pulse_question {
    const double *q, *w;     // angles [rad] and velocities [rad/s] before the touch, [dof]
    voltage_profile command; // from the touch on; empty: the arm's own command stays
    bool energies;           // e_eq of 4.1.1, too: looks at energies every tenth of a millisecond
} pulse_question;

// Follows the pulse of the arm, whose wall must be where the arm touches it, to where the force
// vanishes, by the event method. A touch that does not hold, or a pulse that cannot be followed to
// its peak (out->doubt), has no numbers but the impulse. STATUS_NO_MEMORY, or what motion_step
// returns where a step fails.
status pulse_follow(const arm *a, const method_parameters *method, const pulse_question *question,
                    prediction *out);
