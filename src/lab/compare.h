// One row for each of several runs: what a person asks first of a control law.
#pragma once

#include <jansson.h>
#include <stdio.h>

#include "src/lab/run.h"

enum { COMPARE_QUANTITIES = 8 };

typedef struct compare_quantity {
    const char *key;     // in JSON and CSV, its unit at the end
    const char *heading; // in the table
    const char *unit;    // in the table
} compare_quantity;
extern const compare_quantity compare_quantities[COMPARE_QUANTITIES];

typedef struct compare_row {
    const char *scenario; // its name, borrowed
    const char *law;      // control law, borrowed
    bool ok;              // the run reached its end
    double
        values[COMPARE_QUANTITIES]; // in the order of compare_quantities; NaN where there is none
} compare_row;

// The row of a run. Overshoot is that of the peak over the commanded force; without a rig, over the
// steady force.
compare_row compare_row_of(const scenario *s, const summary *m);

// Whether a value differs from the reference's by more than the tolerance, a share of the larger
// one. A quantity that only one of them has differs.
bool compare_differs(double value, double reference, double tolerance);

// Table for people; against (may be NULL) is a reference: what differs from it is marked with *.
void compare_text(FILE *stream, const compare_row *rows, int count, const compare_row *against,
                  double tolerance);

// {"runs": [{"scenario": ..., "law": ..., "status": "ok", KEY: number or null ...,
// "differs": [KEY ...] (with a reference only)}]}. NULL without memory.
json_t *compare_json(const compare_row *rows, int count, const compare_row *against,
                     double tolerance);

// One header row, one row a run; a quantity that there is not leaves its field empty.
void compare_csv(FILE *stream, const compare_row *rows, int count);
