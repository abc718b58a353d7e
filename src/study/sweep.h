// A sweep: many runs derived from one scenario, each with its own values of some
// parameters.
//
// Run i of a sweep (from 0) is defined by the sweep alone, so results depend neither on
// the number of threads nor on the order in which they were computed, and any part can be
// computed later.
#pragma once

#include <stdint.h>

#include "src/scenario/scenario.h"
#include "src/study/sweep_axis.h"

enum { SWEEP_MOST_AXES = 32 };

// How the values are chosen: every combination, independently at random, or so that each
// of as many equal parts of every range as there are runs is met exactly once (Latin
// hypercube).
typedef enum sweep_sampling { SWEEP_GRID, SWEEP_RANDOM, SWEEP_LATIN } sweep_sampling;

// "grid", "random", "latin"; the one of a name, -1 if there is none.
const char *sweep_sampling_name(sweep_sampling sampling);
int sweep_sampling_find(const char *name);

// Every parts-th run, beginning with number `part` (from 1): what one of several machines
// computes.
typedef struct sweep_share {
    int part, parts; // 0, 0: all runs
} sweep_share;

// Number of the i-th run of a share, and how many of `total` runs it has.
static inline size_t sweep_share_run(sweep_share share, size_t i)
{
    if (share.parts == 0) {
        return i;
    }
    return i * (size_t)share.parts + (size_t)share.part - 1;
}
static inline size_t sweep_share_count(sweep_share share, size_t total)
{
    if (share.parts == 0) {
        return total;
    }
    return (total + (size_t)(share.parts - share.part)) / (size_t)share.parts;
}

typedef struct sweep {
    const scenario *base; // borrowed; NULL in a plan
    sweep_axis axes[SWEEP_MOST_AXES];
    int axis_count;
    sweep_sampling sampling;
    uint64_t seed;
    size_t run_count;
    double *chosen; // owned, axis_count values a run that a search chooses, NaN where one
                    // is still free; NULL: the sampling gives them
    const char *chosen_by; // borrowed: by what free values are chosen, part of the
                           // definition; NULL
} sweep;

// What is asked for.
typedef struct sweep_request {
    char *const *vary; // "PATH=a:b:n", "PATH=a:b:n:log", "PATH=v1,v2,v3"; n may be left
                       // out if drawn, and "with PATH=v1,v2,v3" is drawn together with
                       // the one before
    int vary_count;
    sweep_sampling sampling;
    size_t
        runs; // random, latin: number of runs; 0 for a grid, which is as large as it is
    uint64_t seed;
    const char
        *file; // in whose lines `vary` stands, one number for each; NULL: a command line
    const int *lines;
    sweep_share share; // whose combinations are checked
} sweep_request;

// Reads a request and checks every value and combination of values. The last parameter of
// a grid changes fastest. A range of a whole-number parameter gives whole numbers, a list
// is drawn from with equal chances. `base` has to live as long as the sweep. On failure
// (STATUS_BAD_ARGUMENT, STATUS_NO_MEMORY) f says why and nothing is to be freed.
status sweep_init(sweep *s, const scenario *base, const sweep_request *request, fault *f);

// The same without a scenario: which values each run has, not whether they go together.
// What a database says of its sweep is enough for that.
status sweep_plan(sweep *s, const sweep_request *request, fault *f);
void sweep_finish(sweep *s);

// Why each axis has no effect in a run of the sweep, why[axis_count]: half a sentence,
// NULL if it has one or the run's values do not go together. A value that is free is one
// within its range. Returns whether some axis has none.
bool sweep_idle(const sweep *s, size_t run, const char *why[SWEEP_MOST_AXES]);

// STATUS_BAD_ARGUMENT, with a sentence in f, if it has none in any run.
status sweep_check_effect(const sweep *s, int axis, fault *f);

// Value of parameter axes[axis] in run `run`.
double sweep_value(const sweep *s, size_t run, int axis);

// The same as a scenario file would give it ("newmark", "0.1").
void sweep_value_text(const sweep *s, size_t run, int axis, char *text, size_t size);

// The scenario of one run. It borrows everything but its parameters from the base: do not
// call scenario_finish. Fails, with the reason in f, if the values do not go together.
status sweep_scenario(const sweep *s, size_t run, scenario *derived, fault *f);
