// The visible part of the run.
#pragma once

#include <stdbool.h>

typedef struct time_window {
    double from, to; // [s]; to <= from: the whole run
    bool adrift;     // it was shifted by the user and does not follow the cursor
} time_window;

// The visible part of a run of the given duration [s].
void time_window_range(const time_window *w, double duration, double *from, double *to);

// Makes a part visible, limited to the run and not too short [s].
void time_window_show(time_window *w, double duration, double from, double to);

// Makes the whole run visible.
void time_window_show_all(time_window *w);

// Moves the window so that the cursor (at `now` [s]) is in it, unless it is adrift.
void time_window_follow(time_window *w, double duration, double now);
