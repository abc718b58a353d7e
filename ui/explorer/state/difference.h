// The difference between the present run and the one kept beside it, row by row of the present one.
// Contact, sticking and the controller's mode are those of the present run.
#pragma once

#include "src/session/session.h"

typedef struct run_difference {
    bool on;             // panes show it in the place of the runs
    double tolerance;    // of the first signal of the pane in focus, 0 for none
    trace trace;         // the differences; empty if there is none
    unsigned long built; // counts the traces begun
    unsigned long run;   // what it was computed from
    size_t rows;         // of that
} run_difference;

// Brings the differences up to the rows there are, if they are wanted. `run` identifies the present
// run and the one beside it.
void difference_update(run_difference *d, unsigned long run, const session *s);

// The first instant at which a signal differs by more than a tolerance [s]; negative if it never
// does.
double difference_first_beyond(const run_difference *d, int signal, double tolerance);

void difference_finish(run_difference *d);
