// The panes of curves: what each shows, which ones are shown, and how their axes are scaled.
#pragma once

#include <stdbool.h>

enum { PANES = 10, PANE_SIGNALS = 4 };

// What a pane's axis of values spans.
typedef enum axis_scaling {
    AXIS_AUTO,  // what the visible part of the run holds
    AXIS_GROW,  // everything that has been seen; never less
    AXIS_FIXED, // what the user says
    AXIS_SCALINGS
} axis_scaling;

// The words that commands and settings have for them.
extern const char *const axis_scaling_words[AXIS_SCALINGS];

// A range of values; nothing if low is above high.
typedef struct value_range {
    double low, high;
} value_range;

extern const value_range value_range_empty;

// Widens a range so that it holds another one.
void value_range_widen(value_range *r, value_range other);

// What a pane shows its signals over.
typedef enum pane_view {
    VIEW_TIME,
    VIEW_PHASE,   // the first one over the second
    VIEW_SPECTRUM // the amplitudes of the first one over frequency
} pane_view;

// A pane of curves: signals that are read on one axis.
typedef struct pane {
    int signals[PANE_SIGNALS]; // indices in the signal table
    int count;                 // 0: not defined
    bool shown;
    pane_view view;
    axis_scaling scaling;
    value_range fixed; // the axis where it is fixed
    value_range grown; // what has been seen, where it grows
} pane;

typedef struct pane_set {
    pane pane[PANES]; // the last one is the user's own
    bool controlled;  // they are those of a controlled run
    int room;         // that they were shown for
    bool chosen;      // by the user: another scenario shows the same ones
    int focus;        // pane that the keys for axes mean
    bool alone;       // that pane only
} pane_set;

// What panes are filled for.
typedef struct pane_wishes {
    bool controlled;    // the run has readings and commands too
    const int *signals; // to be shown first, indices in the signal table
    int signal_count;
    int room; // panes that have enough rows on the screen
} pane_wishes;

// Fills the panes with what a run has to show, and shows those wished for, then the usual ones as
// far as there is room, unless the user chose some.
void panes_define(pane_set *set, const pane_wishes *wishes);

// The pane the keys for axes mean: one that is shown, or -1.
int panes_focused(const pane_set *set);

// Fixes a pane's axis to limits, unless they are not finite, or nearly one, or far too wide.
void pane_fix_axis(pane *p, value_range limits);

// Forgets what has been seen and grows the axis from there.
void pane_grow_axis(pane *p);
