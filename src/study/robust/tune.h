// Tuning: the values of some parameters that make an expression of results smallest.
//
// An evaluation is one batch of runs with the same draws each time (common random
// numbers), judged as impactlab robust does; without a set of draws it is one run. A
// search over the whole ranges finds where to look, Nelder and Mead's simplex descends
// from there, both of NLopt. Values rank by the expression, behind them those that miss
// the condition, by how much, last those that fail.
#pragma once

#include "src/study/robust/robust.h"

enum {
    TUNE_RUNS = 4000,
    TUNE_RUNS_ALONE = 200,
    TUNE_MOST_RUNS = 100000,
    TUNE_UNSEEN = 200
};

// The rank of values that are not allowed; higher ones are those of what cannot be
// judged.
#define TUNE_REFUSED 1e100

typedef struct tune_request {
    const scenario *base;
    char *const *vary; // "PATH=a:b" or "PATH=a:b:log"
    int vary_count;
    const char *minimise; // an expression of keys of robust --json, of run --json without
                          // a set, and growth_per_s of linear: of the loop as it is,
                          // nothing drawn
    const char *subject;  // "EXPR<=EXPR", or with >=; NULL: everything is allowed
    const robust_set *over; // what is drawn, without cases; NULL: nothing
    size_t runs;            // at most, 1 ... TUNE_MOST_RUNS
    uint64_t seed;
    status (*growth)(const scenario *s, double *growth,
                     fault *f); // growth_per_s: linear_growth
} tune_request;

typedef struct tune_result {
    double value;    // of the expression; not finite where it cannot be judged
    double rank;     // less is better: the value, or from TUNE_REFUSED on
    size_t computed; // of its runs, those that the store did not have
    robust_law law;  // of a set; robust_law_finish
} tune_result;

typedef struct tuning {
    tune_request asked;
    size_t each, most;             // runs of an evaluation, evaluations
    sweep plan;                    // evaluation e has every most-th run from e on
    char *chosen_by;               // of the plan
    scenario other;                // of one unseen run: borrows all but its parameters
    size_t done;                   // evaluations
    double *ranks;                 // of each
    double found[SWEEP_MOST_AXES]; // the best values so far
    tune_result best; // and what they came to; its rank infinite before the first
    // called with the best values after an evaluation that was computed, if they changed
    // since the call before: what the store has is only replayed; its failure ends the
    // search
    status (*improved)(void *context, const struct tuning *t, fault *f);
    void *context;
} tuning;

// Reads and checks what is asked for. STATUS_BAD_ARGUMENT with a sentence, also where the
// program was built without NLopt; then nothing is to be freed.
status tune_init(tuning *t, const tune_request *asked, fault *f);

// As many evaluations on draws that a search did not see: TUNE_UNSEEN runs, without a set
// one whose sensors have another seed. No search is made of it.
status tune_unseen(tuning *unseen, const tuning *t, size_t evaluations, fault *f);
void tune_finish(tuning *t);

// The scenario with values of the varied parameters; it borrows all but its parameters.
status tune_apply(const tuning *t, const double *values, scenario *s, fault *f);

// Evaluates values of the varied parameters, unless the store of t->plan has their runs;
// `name` is the law's in the result, which is to be finished in any case. STATUS_STOPPED
// if it was stopped.
status tune_evaluate(tuning *t, size_t evaluation, const double *values, const char *name,
                     sweep_store *store, const sweep_options *options, tune_result *out,
                     fault *f);

// Searches until the runs are spent. The same for any number of threads, and where a
// search that was stopped goes on in its store.
status tune_run(tuning *t, sweep_store *store, const sweep_options *options, fault *f);
