// Smallest and largest values of blocks of rows: long runs are drawn and ranged over without a look
// at every row.
#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "ui/explorer/lab.h"

void lab_forget_extremes(lab_extremes *e)
{
    for (size_t i = 0; i < sizeof e->pairs / sizeof e->pairs[0]; i++) {
        free(e->pairs[i]);
    }
    *e = (lab_extremes){0};
}

const double *lab_extremes_of(lab_extremes *e, unsigned version, const trace *t, int signal)
{
    assert(signal < LAB_SIGNALS);
    if (e->version != version) {
        lab_forget_extremes(e);
        e->version = version;
    }
    e->blocks = (t->row_count + EXTREMES_BLOCK - 1) / EXTREMES_BLOCK;
    if (e->pairs[signal] == NULL || e->rows[signal] != t->row_count) {
        double *pairs = realloc(e->pairs[signal], 2 * e->blocks * sizeof *pairs);
        if (pairs == NULL) {
            free(e->pairs[signal]);
        }
        for (size_t b = e->rows[signal] / EXTREMES_BLOCK; pairs != NULL && b < e->blocks; b++) {
            double low = (double)INFINITY, high = (double)-INFINITY;
            for (size_t r = b * EXTREMES_BLOCK; r < t->row_count && r < (b + 1) * EXTREMES_BLOCK;
                 r++) {
                double value = signal_value(&t->rows[r], signal);
                if (isfinite(value)) {
                    low = fmin(low, value);
                    high = fmax(high, value);
                }
            }
            pairs[2 * b] = low;
            pairs[2 * b + 1] = high;
        }
        e->pairs[signal] = pairs;
        e->rows[signal] = pairs != NULL ? t->row_count : 0;
    }
    return e->pairs[signal];
}
