// Runs a scenario and sums it up.
#pragma once

#include "src/predict/predictors.h"
#include "src/run/run_result.h"
#include "src/scenario/scenario.h"
#include <stdatomic.h>

// Simulates the scenario. Returns STATUS_OK, or what stopped the run: then
// summary.message says what, when and where, and everything computed until then is kept.
// run_finish in either case. keep_trace = false keeps no rows (events and summary only).
status run_scenario(const scenario *s, bool keep_trace, run_result *result);
// The same with options. STATUS_STOPPED if the monitor asked for it.
status run_scenario_with(const scenario *s, const run_options *options,
                         run_result *result);

// Compares the summary with the scenario's expectations. Returns the number of those not
// met and reports each as "file:line:column: quantity is ..., expected ...".
int run_check_expectations(const scenario *s, const run_result *result,
                           fault_handler report, void *context);

// Runs side by side: the series of several two-link arms are computed in the lanes of the
// processor's vectors.

// Storage that one call after the other uses.
typedef struct side_by_side side_by_side;

enum { RUN_TOGETHER = 64 }; // scenarios are a good number

// Runs several scenarios, summaries without rows and events: each result is the same to
// the last bit as that of a run by itself but for its computing time, which it does not
// have. Where *abandon becomes true those that are not through end with STATUS_STOPPED;
// abandon may be NULL. *storage is NULL before the first call and kept for the next one;
// without memory for it they go one after the other.
void run_together(const scenario *scenarios, int count, const atomic_bool *abandon,
                  run_result *results, side_by_side **storage);

void side_by_side_destroy(side_by_side *storage); // may be NULL

// The instant before a run's first contact after a free flight, and what the predictors
// say of it.

// The last row in free flight before the landing, of an impact the one before its jump;
// NULL if there was none, or no rows.
const sample *row_before_landing(const run_result *result);

// A row's hub, first and last link.
three_body_state row_bodies(const sample *row);

// The current in a row of a motor with inductance, 0 of one that gives no torque [A].
double row_current(const motor_parameters *motor, const sample *row);

// Asks all predictors about that row, with the parameters and the voltage in effect then;
// `then` is what the motor is to be given from the touch on, NULL: the same. Returns the
// row; NULL if there is none, and then no answers.
const sample *predict_first_contact(const scenario *s, const run_result *result,
                                    const voltage_profile *then,
                                    prediction_answer answers[PREDICTOR_COUNT]);
