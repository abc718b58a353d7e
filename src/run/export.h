// Results as files: JSON of a run, CSV of a trace.
#pragma once

#include <jansson.h>
#include <stdio.h>

#include "src/run/run.h"

// The object of `run --json`: scenario, version, status, message, parameters, those
// without effect, the summary, expectations (if the scenario has any) and events.
// Quantities that did not occur are null. NULL without memory. The caller calls
// json_decref.
json_t *export_run(const scenario *s, const run_result *result);

// The value of every parameter by its path, as it stands there. The caller calls
// json_decref.
json_t *export_parameters(const parameters *p);

// The values that somebody gave and that have no effect: [{path, why}]. The caller calls
// json_decref.
json_t *export_without_effect(const scenario *s);

// The object of `predict --json`: what the predictors answered about a row of the run
// (predict_first_contact), beside the simulation. The caller calls json_decref.
json_t *export_predictions(const scenario *s, const run_result *result, const sample *row,
                           const prediction_answer answers[PREDICTOR_COUNT]);

// Writes a trace as CSV: one header row of name[unit], then a row for each sample; for
// more than two links the angle of every body follows as angle_1[rad], angle_2[rad]...
// Errors stay in the stream.
void export_csv(FILE *stream, const trace *t, int links);
