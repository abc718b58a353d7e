// Smallest and largest values of blocks of rows, so that long runs can be drawn and their ranges
// found without reading every row.
#pragma once

#include "src/tables/signals.h"
#include "src/run/trace.h"

enum { EXTREMES_BLOCK = 64, EXTREMES_SIGNALS = 64 };

typedef struct extremes {
    unsigned long run; // the run of the rows; 0: none
    size_t blocks;     // number of blocks of EXTREMES_BLOCK rows, the last one perhaps incomplete
    double *pairs[EXTREMES_SIGNALS]; // by signal: low, high of each block; NULL if not computed yet
    size_t rows[EXTREMES_SIGNALS];   // by signal: number of rows included
} extremes;

// Extends the blocks of a signal to all rows of a trace, including those that a growing run has
// gained. `run` identifies the trace and is not 0. Without memory the signal has no blocks.
void extremes_update(extremes *e, unsigned long run, const trace *t, int signal);

// Low and high of each block, low above high in a block without a finite value; NULL if they do not
// cover all rows of the trace.
const double *extremes_pairs(const extremes *e, unsigned long run, const trace *t, int signal);

void extremes_forget(extremes *e);
