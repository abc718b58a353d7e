// Results as files: JSON of a run, CSV of a trace.
#pragma once

#include <jansson.h>
#include <stdio.h>

#include "src/base/csv.h"
#include "src/run/run.h"
#include "src/run/run_columns.h"

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

// Begins the CSV of a run: its one header row of name[unit].
csv_writer export_csv_begin(FILE *stream, const run_columns *columns);

// Writes a row of a run, with the angles of all links [rad].
void export_csv_row(csv_writer *csv, const run_columns *columns, const sample *row,
                    const double *angles);

// Writes the trace of a run of the scenario as CSV, with all columns that it has. Errors
// stay in the stream.
void export_csv(FILE *stream, const scenario *s, const trace *t);
