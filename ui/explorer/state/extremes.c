#include "ui/explorer/state/extremes.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

void extremes_forget(extremes *e)
{
    assert(e != NULL);
    for (size_t i = 0; i < sizeof e->pairs / sizeof e->pairs[0]; i++) {
        free(e->pairs[i]);
    }
    *e = (extremes){0};
}

// The blocks from `first` on, from the rows of a trace.
static void fill_blocks(double *pairs, size_t first, size_t blocks, const trace *t, int signal)
{
    for (size_t b = first; b < blocks; b++) {
        double low = (double)INFINITY, high = (double)-INFINITY;
        size_t end = (b + 1) * EXTREMES_BLOCK;

        // what has no value is left out
        for (size_t r = b * EXTREMES_BLOCK; r < t->row_count && r < end; r++) {
            double value = signal_value(&t->rows[r], signal);
            if (isfinite(value)) {
                low = fmin(low, value);
                high = fmax(high, value);
            }
        }

        // without any value low stays above high
        pairs[2 * b] = low;
        pairs[2 * b + 1] = high;
    }
}

void extremes_update(extremes *e, unsigned long run, const trace *t, int signal)
{
    assert(e != NULL && t != NULL && run != 0);
    assert(signal >= 0 && signal < EXTREMES_SIGNALS);

    // another run: nothing of the old one holds
    if (e->run != run) {
        extremes_forget(e);
        e->run = run;
    }
    if (extremes_pairs(e, run, t, signal) != NULL) {
        return;
    }

    // the last block may have been begun only: it is done again, and then what is new
    e->blocks = (t->row_count + EXTREMES_BLOCK - 1) / EXTREMES_BLOCK;
    double *pairs = realloc(e->pairs[signal], 2 * e->blocks * sizeof *pairs);
    if (pairs == NULL) {
        free(e->pairs[signal]);
    } else {
        fill_blocks(pairs, e->rows[signal] / EXTREMES_BLOCK, e->blocks, t, signal);
    }
    e->pairs[signal] = pairs;
    e->rows[signal] = pairs != NULL ? t->row_count : 0;
}

const double *extremes_pairs(const extremes *e, unsigned long run, const trace *t, int signal)
{
    assert(e != NULL && t != NULL);
    assert(signal >= 0 && signal < EXTREMES_SIGNALS);
    bool covers = e->run == run && e->rows[signal] == t->row_count;
    return covers ? e->pairs[signal] : NULL;
}
