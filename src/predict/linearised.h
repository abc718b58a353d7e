// The project's own predictor: closed-form response of the linearised constrained arm.
#pragma once

#include "src/arm/arm.h"
#include "src/predict/predict.h"
#include "src/contact/motion.h"

// The pulse of a touch at this very instant, for any N and either hub joint. In free flight the
// wall is assumed to be where the contact point of the arm is now. Exact are: the impact,
// (4.10)-(4.17) for N links; whether the touch holds (the force just after it); motor torque, back
// EMF, friction (in its present direction) and the hub. The motion after it is the closed form of a
// linear constrained arm, see linearised.c. q[dof], w[dof]: the state before the touch.
// work: a motion created for this arm, used as scratch; its state is not touched.
// A wall that gives is taken as it is, a mass at the tip too. Where the number could not be relied
// on, `doubt` says why and the prediction does not hold.
// A motor with inductance, whose current the state does not tell, is for predict_pulse.
// Costs about a microsecond for two links on a rigid hub whose force peaks near standstill, a chain
// of matrix exponentials otherwise.
status predict_linearised(const arm *a, motion *work, const double *q, const double *w,
                          prediction *out);

// The same by pulse.h for any arm and motor, which also tells e_eq of 4.1.1, and for a voltage that
// is prescribed from the touch on (command; NULL or empty: the one in force stays).
status predict_pulse(const arm *a, motion *work, const double *q, const double *w,
                     const voltage_profile *command, prediction *out);
