// The rows of a sweep's store: one for each run that was computed.
#pragma once

#include <stdio.h>

#include "src/run/run_result.h"
#include "src/study/sweep_store.h"

// Marks present[run] = 1 for every run the store has, 0 for the others (run_count of them), and
// counts them.
status sweep_store_present(sweep_store *store, unsigned char *present, size_t *count, fault *f);

// Adds the result of run `run` to the transaction.
status sweep_store_put(sweep_store *store, size_t run, const summary *result, fault *f);

// One quantity of every run, in order: run_count numbers, NaN where a run failed, is missing, or
// the quantity did not occur. `failed` (may be NULL) receives the number of failed runs.
status sweep_store_quantity(sweep_store *store, const char *key, double *values, size_t *failed,
                            fault *f);

// Writes all rows in the order of the runs as CSV: run, varied values, status, message, then the
// quantities that do not depend on the machine; the header is name[unit]. Errors of the stream stay
// in it (ferror).
status sweep_store_csv(sweep_store *store, FILE *stream, fault *f);

// The same as JSON: scenario, sampling, and in `runs` an object for each row under the keys of
// `impactlab run --json`, the varied values under their paths. STATUS_NO_MEMORY.
status sweep_store_json(sweep_store *store, FILE *stream, fault *f);
