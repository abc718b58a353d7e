// The instant before a run's first contact after a free flight, and what the predictors say of it.
#pragma once

#include "src/predict/predictors.h"
#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

// The last row in free flight before the landing, of an impact the one before its jump; NULL if
// there was none, or no rows.
const sample *row_before_landing(const run_result *result);

// A row's hub, first and last link.
three_body_state row_bodies(const sample *row);

// The current in a row of a motor with inductance, 0 of one that gives no torque [A].
double row_current(const motor_parameters *motor, const sample *row);

// Asks all predictors about that row, with the parameters and the
// voltage in effect then; `then` is what the motor is to be given from the touch on, NULL: the
// same. Returns the row; NULL if there is none, and then no answers.
const sample *predict_first_contact(const scenario *s, const run_result *result,
                                    const voltage_profile *then,
                                    prediction_answer answers[PREDICTOR_COUNT]);
