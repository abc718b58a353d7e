// Runs side by side: the series of several two-link arms are computed in the lanes of the
// processor's vectors.
#pragma once

#include <stdatomic.h>

#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

// Storage that one call after the other uses.
typedef struct side_by_side side_by_side;

enum { RUN_TOGETHER = 64 }; // scenarios are a good number

// Runs several scenarios, summaries only: each result is the same to the last bit as that of a run
// by itself but for its computing time, which is an equal share. Where *abandon becomes true those
// that are not through end with STATUS_STOPPED; abandon may be NULL. *storage is NULL before the
// first call and kept for the next one; without memory for it they go one after the other.
void run_together(const scenario *scenarios, int count, const atomic_bool *abandon,
                  run_result *results, side_by_side **storage);

void side_by_side_destroy(side_by_side *storage); // may be NULL
