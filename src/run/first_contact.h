// The instant before the first contact of a run, and what the predictors say of it.
#pragma once

#include "src/predict/predictors.h"
#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

// The last row in free flight before the first contact, of an impact the one before its jump; NULL
// if there was no contact.
const sample *row_before_contact(const trace *t);

// A row's hub, first and last link.
three_body_state row_bodies(const sample *row);

// Asks all predictors about the last row in free flight, with the parameters and the
// voltage in effect then; `then` is what the motor is to be given from the touch on, NULL: the
// same. Returns that row; NULL if the run kept no rows or touched nothing, and then no answers.
const sample *predict_first_contact(const scenario *s, const run_result *result,
                                    const voltage_profile *then,
                                    prediction_answer answers[PREDICTOR_COUNT]);
