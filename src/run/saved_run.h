// A run as bytes: its summary, rows, events and what predictions need, for the same
// program and machine. What a run that goes on elsewhere keeps (run_history) is no part
// of it.
#pragma once

#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

// The size of the block, and the block, of a run of the scenario.
size_t run_saved_size(const run_result *result);
void run_save(const run_result *result, const scenario *s, void *bytes);

// The same run again, in a result of zeroes. STATUS_BAD_ARGUMENT, with a sentence in f,
// if the bytes are damaged or of another scenario or version; STATUS_NO_MEMORY.
// run_finish is due in any case.
status run_restore(run_result *result, const scenario *s, const void *bytes, size_t size,
                   fault *f);
