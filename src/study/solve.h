// The limit of a parameter for a condition on a result: "up to which voltage does the
// peak stay below 2 N?"
//
// The range is run at evenly spaced values. Wherever the condition holds at one of two
// neighbours and not at the other, the limit between them is located by further runs, by
// the secant with bisection in reserve, to a part in 1e13 of the range or the last whole
// number.
#pragma once

#include "src/run/run_result.h"
#include "src/scenario/scenario.h"
#include "src/study/sweep_axis.h"

enum { SOLVE_POINTS = 65, SOLVE_MOST_POINTS = 100000, SOLVE_MOST_LIMITS = 64 };

// KEY<VALUE, KEY<=VALUE, KEY>VALUE or KEY>=VALUE.
typedef struct solve_condition {
    int quantity; // index in summary_table
    bool below;   // "<" or "<="
    bool equal;   // "<=" or ">="
    double bound; // in the quantity's unit
} solve_condition;

typedef struct solve_limit {
    double
        value; // the outermost at which the condition was seen to hold [parameter's unit]
    double reached;   // the quantity there [its unit]
    bool holds_below; // the condition holds below the limit, else above it
    bool jumps;       // the quantity jumps over the bound there
    double
        beyond; // the nearest value at which it was seen not to hold [parameter's unit]
} solve_limit;

typedef struct solution {
    solve_limit limits[SOLVE_MOST_LIMITS]; // by value, from low to high of the range
    int count;
    bool more;    // there are more limits than fit
    int points;   // values of the range
    int done;     // of them: they were run, all but of a search that was stopped
    bool stopped; // then limits are not located, only known to lie before `beyond`
    int holding, failing; // of them: the condition holds, it does not
    int missing;          // of them: the quantity did not occur
    int unknown;          // of them: the run failed or is inaccurate, or cannot be made
    char reason[512];     // why the first of the unknown ones is, "" if there are none
} solution;

// Reads a condition; its blanks do not matter. On failure f says what was expected.
status solve_condition_read(const char *text, solve_condition *c, fault *f);

// Whether the condition holds for a value of its quantity (not NaN).
bool solve_condition_holds(const solve_condition *c, double value);

// A range for an axis that was given none, about the scenario's value and within what the
// parameter allows. STATUS_BAD_ARGUMENT where the parameter is not a number.
status solve_usual_range(sweep_axis *axis, const scenario *s, fault *f);

// Reads PATH or PATH=a:b[:n][:log] into an axis of zeroes, a range about the scenario's
// value where none is given. sweep_axis_finish in either case.
status solve_axis_read(sweep_axis *axis, const char *text, const scenario *s, fault *f);

// Finds the limits of the axis (a range) within which the condition holds, in `points`
// values (at least 2; fewer where fewer whole numbers lie in the range) on `jobs`
// threads. STATUS_STOPPED if the monitor (may be NULL) asked for it, with what was found
// until then; STATUS_NO_MEMORY. Runs that fail are counted as unknown.
status solve(const scenario *s, const sweep_axis *axis, const solve_condition *condition,
             int points, int jobs, run_monitor *monitor, solution *found, fault *f);
