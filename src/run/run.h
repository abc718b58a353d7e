// Runs a scenario and sums it up.
#pragma once

#include <stdatomic.h>

#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

// Simulates the scenario. Returns STATUS_OK, or what stopped the run: then summary.message says
// what, when and where, and everything computed until then is kept. run_finish in either case.
// keep_trace = false keeps no rows (events and summary only).
status run_scenario(const scenario *s, bool keep_trace, run_result *result);
// The same with options. STATUS_STOPPED if the monitor asked for it.
status run_scenario_with(const scenario *s, const run_options *options, run_result *result);

// Runs several scenarios, summaries only, their series side by side in the processor's vectors:
// each result is the same to the last bit as that of a run by itself but for its computing time,
// which is an equal share. RUN_TOGETHER of them are a good number. Where *abandon becomes true
// those that are not through end with STATUS_STOPPED; abandon may be NULL.
enum { RUN_TOGETHER = 64 };
void run_together(const scenario *scenarios, int count, const atomic_bool *abandon,
                  run_result *results);

// Compares the summary with the scenario's expectations. Returns the number of those not met and
// reports each as "file:line:column: quantity is ..., expected ...".
int run_check_expectations(const scenario *s, const run_result *result, fault_handler report,
                           void *context);
