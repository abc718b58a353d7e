// Smallest and largest values of blocks of rows: long runs are drawn and ranged over without a look
// at every row.
#pragma once

#include "src/quantities/signals.h"
#include "src/run/trace.h"

enum { EXTREMES_BLOCK = 64, EXTREMES_SIGNALS = 64 };

typedef struct extremes {
    unsigned long run;               // whose rows they are; 0: nothing is known
    size_t blocks;                   // number of whole or begun blocks of EXTREMES_BLOCK rows
    double *pairs[EXTREMES_SIGNALS]; // by signal: low, high of each block; NULL if not wanted yet
    size_t rows[EXTREMES_SIGNALS];   // by signal: rows that are in them, fewer of a growing run
} extremes;

// Makes the blocks of a signal cover all rows of a trace, also those that a growing run got since.
// `run` identifies the trace, not 0. Without memory nothing is known of the signal.
void extremes_update(extremes *e, unsigned long run, const trace *t, int signal);

// Low and high of each block, low above high in one without a finite value; NULL if they are not
// known for all rows of the trace.
const double *extremes_pairs(const extremes *e, unsigned long run, const trace *t, int signal);

void extremes_forget(extremes *e);
