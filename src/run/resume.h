// Runs that reuse the beginning of another run, and runs that share equal rows in memory.
#pragma once

#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

// Lets `result` begin with what `from`, a run of the scenario `old`, has in common with a run of
// `s`, up to the last checkpoint before they differ: without a copy and to the last bit. False if
// there is nothing in common or no memory; then `result` is empty and the run begins at the start.
// Only runs of the corrected model without a controller have checkpoints.
bool run_resume(const run_result *from, const scenario *old, const scenario *s,
                size_t rows_expected, run_result *result);

// A second result of the same run that shares all rows. STATUS_NO_MEMORY if there is no room.
status run_share(const run_result *from, size_t rows_expected, run_result *result);

// Numbers of chunks (src/base/shared_array.h) that the rows, angles, velocities, events and forces
// of two results both begin with.
typedef struct shared_chunks {
    size_t rows, angles, velocities, events, forces;
} shared_chunks;

// Finds the chunks that the two results have in common; both must have their rows in shared arrays,
// or none.
shared_chunks run_compare_rows(const run_result *result, const run_result *other);

// Lets result take those chunks of `other` instead of its own equal ones. Nobody may be reading
// result's rows.
void run_merge(run_result *result, const run_result *other, const shared_chunks *same);
