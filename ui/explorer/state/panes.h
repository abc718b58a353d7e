// The panes of curves: their signals, which ones are shown, how their axes are scaled,
// and which part of the run is visible.
#pragma once

#include <math.h>
#include <stdbool.h>

#include "src/tables/signals.h"

// The panes of the table, and those that users define.
enum { PANES_OF_TABLE = 9, PANES = 24, PANE_SIGNALS = 4 };

// A range of values; empty if low is above high.
typedef struct value_range {
    double low, high;
} value_range;

extern const value_range value_range_empty;

// Widens a range to include another one, or a value if it is finite.
static inline void value_range_widen(value_range *r, value_range other)
{
    r->low = fmin(r->low, other.low);
    r->high = fmax(r->high, other.high);
}

static inline void value_range_add(value_range *r, double value)
{
    if (isfinite(value)) {
        value_range_widen(r, (value_range){value, value});
    }
}

// A range, or one about its only value.
value_range value_range_opened(value_range r);

// The horizontal axis of a pane.
typedef enum pane_view {
    VIEW_TIME,
    VIEW_PHASE,    // the first one over the second
    VIEW_RESIDUAL, // over time: measured data minus the run
    VIEW_SPECTRUM  // the amplitudes of the first one over frequency
} pane_view;

// A pane of curves: signals with a common axis.
typedef struct pane {
    int signals[PANE_SIGNALS]; // indices in the signal table
    int count;                 // 0: not defined
    unsigned hidden;           // bit k: signals[k] is only in the legend
    bool shown;
    pane_view view;
    bool is_fixed;     // the axis of values has a range that the user set, else that of
                       // the values in the visible part of the run
    value_range fixed; // that range
} pane;

typedef struct pane_set {
    pane pane[PANES]; // those of the table come first
    bool controlled;  // they suit a controlled run
    int room;         // the room for panes when they were chosen
    bool chosen;      // chosen by the user: kept for another scenario
    int focus;        // the pane to which the keys for axes apply
    bool alone;       // only that pane is shown
} pane_set;

// The run and screen for which panes are filled.
typedef struct pane_wishes {
    bool controlled;    // the run has readings and commands
    const int *signals; // to be shown first, indices in the signal table
    int signal_count;
    bool only; // nothing but these signals in their panes
    int room;  // number of panes that have room on the screen
} pane_wishes;

// Fills the panes with the signals of a run and shows the requested ones, then the usual
// ones as far as there is room, unless the user has chosen panes.
void panes_define(pane_set *set, const pane_wishes *wishes);

// The pane to which the keys for axes apply: one that is shown, or -1.
int panes_focused(const pane_set *set);

// Whether a pane has a signal that is an amount: of states alone there is no difference.
bool pane_has_amounts(const pane *p);

// Whether a pane's axis is time.
bool pane_is_over_time(const pane *p);

// Whether a pane has a signal that is computed from others: of differences it means
// nothing.
bool pane_is_derived(const pane *p);

// Adds a pane of the user's and returns its index: one that is not used, else the first
// that is hidden, else the last.
int panes_add(pane_set *set, const pane *own);

// Fixes a pane's axis to limits, unless they are not finite, nearly equal or far too
// wide.
void pane_fix_axis(pane *p, value_range limits);

// --- the visible part ------------------------------------------------------------------

typedef struct time_window {
    double from, to; // [s]; to <= from: the whole run
    bool adrift;     // it was shifted by the user and does not follow the cursor
} time_window;

// --- extremes --------------------------------------------------------------------------
// Smallest and largest values of blocks of rows, so that long runs can be drawn and their
// ranges found without reading every row.

enum { EXTREMES_BLOCK = 64, EXTREMES_SIGNALS = 64 };

typedef struct extremes {
    unsigned long run;               // the run of the rows; 0: none
    double *pairs[EXTREMES_SIGNALS]; // by signal: low, high of each block; NULL if not
                                     // computed yet
    size_t rows[EXTREMES_SIGNALS];   // by signal: number of rows included
} extremes;

void extremes_forget(extremes *e);
