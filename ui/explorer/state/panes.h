// The panes of curves: their signals, which ones are shown, and how their axes are scaled.
#pragma once

#include <stdbool.h>

enum { PANES = 10, PANE_SIGNALS = 4 };

// The range of a pane's axis of values.
typedef enum axis_scaling {
    AXIS_AUTO,  // the values in the visible part of the run
    AXIS_GROW,  // all values shown so far; never shrinks
    AXIS_FIXED, // set by the user
    AXIS_SCALINGS
} axis_scaling;

// The words for them in commands and settings.
extern const char *const axis_scaling_words[AXIS_SCALINGS];

// A range of values; empty if low is above high.
typedef struct value_range {
    double low, high;
} value_range;

extern const value_range value_range_empty;

// Widens a range to include another one.
void value_range_widen(value_range *r, value_range other);

// The horizontal axis of a pane.
typedef enum pane_view {
    VIEW_TIME,
    VIEW_PHASE,   // the first one over the second
    VIEW_SPECTRUM // the amplitudes of the first one over frequency
} pane_view;

// A pane of curves: signals with a common axis.
typedef struct pane {
    int signals[PANE_SIGNALS]; // indices in the signal table
    int count;                 // 0: not defined
    bool shown;
    pane_view view;
    axis_scaling scaling;
    value_range fixed; // the range of a fixed axis
    value_range grown; // the range of a growing axis
} pane;

typedef struct pane_set {
    pane pane[PANES]; // the last one is defined by the user
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
    int room; // number of panes that have room on the screen
} pane_wishes;

// Fills the panes with the signals of a run and shows the requested ones, then the usual ones as
// far as there is room, unless the user has chosen panes.
void panes_define(pane_set *set, const pane_wishes *wishes);

// The pane to which the keys for axes apply: one that is shown, or -1.
int panes_focused(const pane_set *set);

// Whether a pane has a signal that is an amount: of states alone there is no difference.
bool pane_has_amounts(const pane *p);

// Fixes a pane's axis to limits, unless they are not finite, nearly equal or far too wide.
void pane_fix_axis(pane *p, value_range limits);

// Discards the range shown so far; the axis grows anew.
void pane_grow_axis(pane *p);
