// What a pane over time is drawn on: its place, window and range, in cells or in pixels.
#pragma once

#include "render/plot/pane_curve.h"
#include "ui/explorer/panels/layout.h"
#include "ui/terminal/screen.h"

// A pane's place, time window and range.
typedef struct plot_frame {
    canvas canvas;
    double from, to; // [s]
    value_range axis;
    unsigned pattern; // of the curve that is drawn, as in run_lines.h
    ink colour;
    cairo_t *picture; // drawn on in the place of dots; NULL: none
    pane_frame pixels;
    colour_theme theme;
} plot_frame;

// Has the pane drawn in pixels where the screen has any; plot_frame_close ends that.
void plot_frame_open(const explorer_state *st, plot_frame *f);

void plot_frame_close(plot_frame *f);

// Draws one signal of a run up to the instant `until` [s] with the frame's pattern and colour:
// every row if they are few, else the smallest and the largest value of each column. `pairs`: these
// of blocks of EXTREMES_BLOCK rows, NULL: none are known.
void plot_frame_signal(const plot_frame *f, const trace *t, int signal, double until,
                       const double *pairs);

// A line at an instant [s], where nothing is drawn yet.
void plot_frame_cursor(const plot_frame *f, screen *s, double time);

// A setpoint or a limit across the pane, and what it is called, where nothing is drawn yet.
void plot_frame_level(const plot_frame *f, screen *s, double value, const char *name);
