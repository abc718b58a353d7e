// One row for each of several runs: what a person asks first of a control law.
#pragma once

#include <jansson.h>
#include <stdio.h>

#include "src/run/run.h"
#include "src/study/sweep_axis.h"

enum { COMPARE_QUANTITIES = 13, COMPARE_MOST_VARIED = 32 };

typedef struct compare_quantity {
    const char *key;     // in JSON, its unit at the end
    const char *name;    // in CSV
    const char *heading; // in the table
    const char *unit;    // in the table and in CSV
} compare_quantity;
extern const compare_quantity compare_quantities[COMPARE_QUANTITIES];

typedef struct compare_row {
    const char *scenario;               // its name, borrowed
    const char *law;                    // control law, borrowed
    double varied[COMPARE_MOST_VARIED]; // values of the table's varied parameters
    // why one of them has no effect here, borrowed; NULL: it has one
    const char *idle[COMPARE_MOST_VARIED];
    bool ok;                           // the run reached its end
    double values[COMPARE_QUANTITIES]; // in the order of compare_quantities; NaN where
                                       // there is none
} compare_row;

// Rows to be shown together.
typedef struct compare_table {
    const compare_row *rows;
    int count;
    const sweep_axis *varied; // whose values differ by row
    int varied_count;
    const compare_row
        *against;     // NULL, or references: row i is held against row i / group of these
    int group;        // at least 1
    double tolerance; // share of the larger value beyond which two of them differ
    bool hidden[COMPARE_QUANTITIES]; // columns left out, of the tables only
} compare_table;

// The row of a run; its varied values are the caller's to fill in. Overshoot is that of
// the peak over the commanded force; without a rig, over the steady force.
//
// best_peak_N and best_settling_s are what a controller with full knowledge of the state
// could do after the run's first impact (src/predict/best_stop.h): the least peak with
// which it can end in contact; and the least settling time into the band round the
// commanded force, with a peak not above this run's own (nor below the band). They hold
// on the corrected arm of two links on a rigid hub, without script, where the first
// impact was plastic; else they are NaN. from_start_s is the time from the run's start
// until it has settled, and least_time_s the least that any controller with this voltage
// takes for that from rest, pressing no harder (src/predict/least_time.h).
compare_row compare_row_of(const scenario *s, const run_result *result);

// Whether a value differs from the reference's by more than the tolerance, a share of the
// larger one. A quantity that only one of them has differs.
bool compare_differs(double value, double reference, double tolerance);

// Hides all columns but those named in "KEY,KEY...". STATUS_BAD_ARGUMENT, with a sentence
// in f, for an unknown key.
status compare_choose(compare_table *t, const char *keys, fault *f);

// Table for people, in columns of blanks, where * marks what differs from the reference,
// or of a Markdown page.
void compare_text(FILE *stream, const compare_table *t, bool page);

// {"runs": [{"scenario": ..., "law": ..., "varied": {PATH: value ...} (if there are any),
// "status": "ok", KEY: number or null ..., "without_effect": [{"path", "why"} ...] (if
// any), "differs": [KEY ...] (with a reference only)}]}. NULL without memory.
json_t *compare_json(const compare_table *t);

// One header row, one row a run; varied parameters as PATH; a quantity that there is not
// leaves its field empty.
void compare_csv(FILE *stream, const compare_table *t);
