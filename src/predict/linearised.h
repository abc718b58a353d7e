// The project's own predictor: closed-form response of the linearised constrained arm.
#pragma once

#include "src/arm/arm.h"
#include "src/predict/predict.h"
#include "src/solve/motion.h"

// What a touch at this very instant would do, for any N and either hub joint. In free flight the
// wall is imagined where the contact point of the arm is now. Exact are: the impact, (4.10)-(4.17)
// for N links; whether the touch holds (the force just after it); motor torque, back EMF, friction
// (in its present direction) and the hub. The motion after it is the closed form of a linear
// constrained arm, see linearised.c. q[dof], w[dof]: the state before the touch.
// work: a motion created for this arm, used as scratch; its state is not touched.
// Costs about a microsecond for two links on a rigid hub, a matrix exponential otherwise.
status predict_linearised(const arm *a, motion *work, const double *q, const double *w,
                          prediction *out);
