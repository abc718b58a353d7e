// The rows of a run on a uniform grid: one row at each of 0, every, 2 every ... up to the
// last instant that the run reached.
//
// A run records its rows at multiples of method.step and on both sides of each event, so
// that an instant may have several rows. On the grid it has one: the last of them, which
// is what the run goes on from. An instant without a row is straight between the rows
// around it (trace_between). A run that is asked for rows at these instants itself
// (run_options, rows_every) has computed each of them, but for the printed arm's, whose
// steps cannot be cut.
//
// Whatever writes rows every so often uses this: `run --every` while the run goes on, a
// program afterwards (row_grid_of_trace).
#pragma once

#include "src/run/trace.h"

typedef struct row_grid {
    double every;    // [s]
    size_t next;     // number of the grid's next instant
    int angle_count; // of each row
    row_taker *take; // gets the rows of the grid
    void *context;
    bool any;       // a row has come
    sample last;    // the latest row
    double *angles; // of the latest row, then of the one that is taken; owned
} row_grid;

// Begins a grid of rows `every` > 0 [s], which `take` gets in their order.
// STATUS_NO_MEMORY; row_grid_finish in either case.
status row_grid_begin(row_grid *g, double every, int angle_count, row_taker *take,
                      void *context) __attribute__((warn_unused_result));

// The run's next row. Rows come in the order of their times; those of one instant follow
// one another. The grid's rows before it are taken.
status row_grid_add(row_grid *g, const sample *row, const double *angles)
    __attribute__((warn_unused_result));

// The same as a row_taker, whose context is the grid.
status row_grid_taker(void *grid, const sample *row, const double *angles);

// There is no other row: the grid's row at the last one, if there is one, is taken.
status row_grid_end(row_grid *g) __attribute__((warn_unused_result));

void row_grid_finish(row_grid *g);

// All of that for the rows of a run that is over. What `take` returned, or
// STATUS_NO_MEMORY.
status row_grid_of_trace(const trace *t, double every, row_taker *take, void *context)
    __attribute__((warn_unused_result));
