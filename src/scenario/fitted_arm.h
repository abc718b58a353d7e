// Arms that recordings leave possible: drawn from the errors and correlations of a fit
// that a scenario has (scenario_fit), around its own values.
#pragma once

#include "src/base/random.h"
#include "src/scenario/scenario.h"

// Cholesky's factor of a fit's correlations, in the lower triangle of factor[count x
// count]. False if no parameters can have them: their matrix has a negative eigenvalue
// beyond rounding.
bool fitted_arm_factor(const scenario_fit *fit,
                       double factor[SCENARIO_FIT * SCENARIO_FIT]);

// Draws the fitted parameters of one arm: values[around->fit->count], each in its
// parameter's unit. They are distributed normally about the scenario's, but not beyond
// the parameters' limits. The scenario has a fit.
void fitted_arm_draw(const scenario *around, random_generator *chance, double *values);

// The factor by which a law is told a parameter, as the index of belief.*; -1: a law is
// not told it.
int fitted_arm_belief(int parameter);

// The value of that factor with which a law believes the scenario's value where the true
// one is `value`.
double fitted_arm_believed(const scenario *around, int parameter, double value);
