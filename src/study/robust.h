// Robustness of a control law against what it was not told: many runs over a set of beliefs,
// sensors, walls and starts, and the distribution of their results.
#pragma once

#include <jansson.h>
#include <stdio.h>

#include "src/study/robust_set.h"
#include "src/study/sweep_run.h"

// The quantiles that tables show: half of all runs, nine tenths, and the worst.
enum { ROBUST_MEDIAN, ROBUST_NINE_TENTHS, ROBUST_WORST, ROBUST_QUANTILES };

// A run without a commanded force cannot be judged. A run exceeds its limit with a peak above
// control.force_limit, or above ROBUST_EXCESS times the command where there is none.
#define ROBUST_EXCESS 1.3

// What the runs of one law come to. A run that failed, or never settled, has the worst of all
// values: NaN in a quantile that reaches so far.
typedef struct robust_law {
    const char *law;        // its word, borrowed
    const char *case_title; // of a case, borrowed; NULL without cases
    size_t runs, failed;
    double settled, separated, exceeded; // shares of the runs
    double raw[ROBUST_QUANTILES];        // peak of the force over the command [%]
    double smoothed[ROBUST_QUANTILES];   // smoothed_over_command_N, a mean over 5 ms, of it [%]
    double overshoot[ROBUST_QUANTILES];  // of each run the one or, with more than two links, the
                                         // other: a chain's peak depends on the number of links [%]
    size_t by_smoothed;                  // runs of the other kind
    double settling[ROBUST_QUANTILES];   // from first contact, or the last push after it [s]
    double from_start[ROBUST_QUANTILES]; // until it has settled, from the run's start;
                                         // NaN where the tip is pushed [s]
    double against; // ratio of its worst from_start to that of another law; NaN: none
    double error[ROBUST_QUANTILES]; // steady error either way, of the command [%]
    double back[ROBUST_QUANTILES];  // largest speed of the tip towards the wall in the air after
                                    // first contact over that before; 0 where it stays
    double *overshoots;             // of all runs, ascending, NaN last; owned [%]
} robust_law;

// Judges the runs of a law in a store of its sweep, all of which are there. STATUS_NO_MEMORY or
// what the store says. robust_law_finish in any case.
status robust_law_of(robust_law *out, const char *law, const sweep *s, sweep_store *store,
                     fault *f);
void robust_law_finish(robust_law *law);

// Which `overshoot` is: "peak", "smoothed", or "peak and smoothed" where the number of links is
// drawn.
const char *robust_overshoot_of(const robust_law *law);

// Laws to be shown together.
typedef struct robust_table {
    const char *scenario; // its name
    const robust_law *laws;
    int count;
    const char *against; // the law that `against` of each is held against; NULL if there is none
} robust_table;

// A line a law, or a law in a case, the latter with the worst of all runs only: for people, of a
// Markdown page, as CSV, and {"scenario": ..., "laws": [...]}, NULL without memory.
void robust_text(FILE *stream, const robust_table *t);
void robust_markdown(FILE *stream, const robust_table *t);
void robust_csv(FILE *stream, const robust_table *t);
json_t *robust_json(const robust_table *t);
