// The project's own predictor: closed-form response of the linearised constrained arm.
#pragma once

#include "src/arm/arm.h"
#include "src/predict/predict.h"

// The pulse of a touch at this very instant, for any number of links, either hub joint
// and any wall at rest. In free flight the wall is assumed to be where the contact point
// of the arm is now. Two links on a rigid hub that press on a rigid wall have a closed
// form, that of a linear constrained arm by pieces (linearised.c), with the exact impact,
// (4.10)-(4.17), force just after it, motor and friction. The pulse of any other arm is
// followed by its engine. q[dof], w[dof]: the state before the touch. Where no number can
// be told, it is `doubtful` and the prediction does not hold. STATUS_NO_MEMORY, or what
// motion_step returns where a step fails. A motor with inductance, whose current the
// state does not tell, is for predict_pulse. Costs about a microsecond in closed form, as
// much as a run of the pulse otherwise.
status predict_linearised(const arm *a, const method_parameters *method, const double *q,
                          const double *w, prediction *out);

// A pulse that has not ended after this time is followed no further [s]; one whose force
// still rises then is doubtful.
#define PULSE_HORIZON 1.0

// The same by its engine for any arm and motor, for a voltage that is prescribed from the
// touch on (command; NULL or empty: the one in force stays); `energies` asks for e_eq of
// 4.1.1, too, and looks at them every tenth of a millisecond at least. Followed to where
// the force vanishes, by the event method; a touch that does not hold, or a pulse that
// cannot be followed to its peak, has no numbers but the impulse.
status predict_pulse(const arm *a, const method_parameters *method, const double *q,
                     const double *w, const voltage_profile *command, bool energies,
                     prediction *out);

// The arm with the wall moved to where the arm touches it now.
arm arm_touching_now(const arm *a, const double *q);
