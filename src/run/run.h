// Runs a scenario and sums it up.
#pragma once

#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

// Simulates the scenario. Returns STATUS_OK, or what stopped the run: then summary.message says
// what, when and where, and everything computed until then is kept. run_finish in either case.
// keep_trace = false keeps no rows (events and summary only).
status run_scenario(const scenario *s, bool keep_trace, run_result *result);
// The same with options. STATUS_STOPPED if the monitor asked for it.
status run_scenario_with(const scenario *s, const run_options *options, run_result *result);

// Compares the summary with the scenario's expectations. Returns the number of those not met and
// reports each as "file:line:column: quantity is ..., expected ...".
int run_check_expectations(const scenario *s, const run_result *result, fault_handler report,
                           void *context);
