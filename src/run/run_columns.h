// The columns of a run's table: recorded signals, and angles of links.
//
// Which there are follows from the scenario and its script, not from what happened, so
// that the rows of a run can be written while it goes on and the tables of many runs of
// one scenario have the same columns.
#pragma once

#include "src/run/trace.h"
#include "src/scenario/scenario.h"

typedef struct run_column {
    const char *name; // "force"; angle_1 ... are those of the links from the hub outwards
    const char *unit; // "N", "" for none
    int signal;       // its index; -1: an angle
    int angle;        // which of the row's
} run_column;

typedef struct run_columns {
    run_column *all;
    int count;
    char *names; // of the angles
} run_columns;

// The columns of a scenario: its signals, then the angle of every body of an arm of more
// than two links, of which the signals show the first and the last only. With `chosen`,
// "A,B", those columns in that order. STATUS_BAD_ARGUMENT, with a sentence, where that
// names nothing, no column, one twice, or a signal that such a run has no value of;
// STATUS_NO_MEMORY. run_columns_finish in any case.
status run_columns_init(run_columns *c, const scenario *s, const char *chosen, fault *f)
    __attribute__((warn_unused_result));

void run_columns_finish(run_columns *c);

// How many link angles a row of a run of the scenario has.
int run_angle_count(const scenario *s);

// The number of a row, with the angles of all links [rad], in a column; NaN: it has none.
static inline double run_column_value(const run_column *c, const sample *row,
                                      const double *angles)
{
    if (c->signal < 0) {
        return angles[c->angle];
    }
    return signal_value(row, c->signal);
}
