// The instant before the first contact of a run, and what the predictors say of it.
#pragma once

#include "src/predict/predictors.h"
#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

// Asks all predictors about the last row in free flight, with the parameters in effect then.
// Returns that row; NULL if the run kept no rows or touched nothing, and then no answers.
const sample *predict_first_contact(const scenario *s, const run_result *result,
                                    prediction_answer answers[PREDICTOR_COUNT]);
