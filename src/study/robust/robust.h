// Robustness of a control law against what it was not told: many runs over a set of
// beliefs, sensors, walls and starts, and the distribution of their results.
#pragma once

#include <jansson.h>
#include <stdio.h>

#include "src/scenario/scenario.h"
#include "src/study/sweep_run.h"

// --- the sets of arms ------------------------------------------------------------------

// What impactlab robust draws from, and the cases it looks at one by one: a file of
// lines.
//
//     PATH=a:b  PATH=v1,v2             drawn for every run, as a sweep takes them
//     with PATH=v1,v2                  drawn together with the line before: first with
//     first case TITLE: PATH=VALUE; ...      what differs in a case; push=IMPULSE@TIME [N
//     s]@[s] too
//
// Empty lines and those that begin with # are ignored. Without cases the runs are drawn
// over the scenario as it is, with cases over the scenario of each of them.

enum { ROBUST_CASE_PUSHES = 4 }; // at most

typedef struct robust_case {
    const char *file;                        // borrowed from the set
    int line;                                // in the file, from 1
    char *title;                             // borrowed from the set's text
    char **settings;                         // "PATH=VALUE"; borrowed from the set's list
    int setting_count;                       //
    double push_impulse[ROBUST_CASE_PUSHES]; // at the tip, positive towards growing angle
                                             // [N s]
    double push_time[ROBUST_CASE_PUSHES];    // [s]
    int push_count;
} robust_case;

typedef struct robust_set {
    char *file;                            // its path; owned
    char *text;                            // owned; the lines point into it
    char *lines[SWEEP_MOST_AXES + 1];      // what is drawn, up to one too many
    int line_numbers[SWEEP_MOST_AXES + 1]; // of each in the file, from 1
    int count;                             // of lines
    robust_case *cases;                    // owned
    int case_count;
    char **settings; // of all cases, one behind the other; owned
} robust_set;

// Reads a set file. STATUS_CANNOT_READ, STATUS_BAD_ARGUMENT (nothing is drawn, too long,
// a case that cannot be read) or STATUS_NO_MEMORY, with a sentence in f that names file
// and line; then the set is empty, and nothing is to be freed.
status robust_set_read(robust_set *set, const char *path, fault *f);
void robust_set_finish(robust_set *set);

// The scenario of a case, c NULL: the base's own. It borrows all but its parameters and
// its actions from the base; robust_case_finish. STATUS_BAD_ARGUMENT if a setting or a
// push does not go, with robust_case_fault's sentence, STATUS_NO_MEMORY.
status robust_case_scenario(scenario *derived, const scenario *base, const robust_case *c,
                            fault *f);
void robust_case_finish(scenario *derived);

// What is wrong with a case, with file, line and title before the sentence. Returns the
// code of why.
status robust_case_fault(const robust_case *c, const fault *why, fault *f);

// The quantiles that tables show: half of all runs, nine tenths, and the worst.
enum { ROBUST_MEDIAN, ROBUST_NINE_TENTHS, ROBUST_WORST, ROBUST_QUANTILES };

// A run without a commanded force cannot be judged. A run exceeds its limit with a peak
// above control.force_limit, or above ROBUST_EXCESS times the command where there is
// none.
#define ROBUST_EXCESS 1.3

// What the runs of one law come to. A run that failed, or never settled, has the worst of
// all values: NaN in a quantile that reaches so far.
typedef struct robust_law {
    const char *law;        // its word, borrowed
    const char *case_title; // of a case, borrowed; NULL without cases
    size_t runs, failed;
    double settled, separated, exceeded; // shares of the runs
    double raw[ROBUST_QUANTILES];        // peak of the force over the command [%]
    double smoothed[ROBUST_QUANTILES]; // smoothed_over_command_N, a mean over 5 ms, of it
                                       // [%]
    double overshoot[ROBUST_QUANTILES]; // of each run the one or, with more than two
                                        // links, the other: a chain's peak depends on the
                                        // number of links [%]
    size_t by_smoothed;                 // runs of the other kind
    const char *overshoot_of; // "peak", "smoothed", or "peak and smoothed" where the
                              // number of links is drawn
    double
        settling[ROBUST_QUANTILES]; // from first contact, or the last push after it [s]
    double from_start[ROBUST_QUANTILES]; // until it has settled, from the run's start;
                                         // NaN where the tip is pushed [s]
    double against; // ratio of its worst from_start to that of another law; NaN: none
    double error[ROBUST_QUANTILES]; // steady error either way, of the command [%]
    double
        back[ROBUST_QUANTILES]; // largest speed of the tip towards the wall in the air
                                // after first contact over that before; 0 where it stays
    double *overshoots;         // of all runs, ascending, NaN last; owned [%]
} robust_law;

// Judges a share of the runs of a law in a store of its sweep, those that are there.
// STATUS_NO_MEMORY or what the store says. robust_law_finish in any case.
status robust_law_of(robust_law *out, const char *law, const sweep *s, sweep_share share,
                     sweep_store *store, fault *f);
void robust_law_finish(robust_law *law);

// The numbers of a law under their keys of robust_json: the i-th key, NULL after the
// last.
const char *robust_key(int i);
double robust_value(const robust_law *law, int i);

// Laws to be shown together.
typedef struct robust_table {
    const char *scenario; // its name
    const robust_law *laws;
    int count;
    const char
        *against; // the law that `against` of each is held against; NULL if there is none
} robust_table;

// A line a law, or a law in a case, the latter with the worst of all runs only: for
// people, also of a Markdown page, as CSV, and {"scenario": ..., "laws": [...]}, NULL
// without memory.
void robust_text(FILE *stream, const robust_table *t, bool page);
void robust_csv(FILE *stream, const robust_table *t);
json_t *robust_json(const robust_table *t);
