// Drawing in the panes of curves: lines and their patterns, the frame of a pane, axes;
// panes that are not over time; the lanes below.
#pragma once

#include "render/plot/pane_curve.h"
#include "src/tables/signals.h"
#include "ui/explorer/panels/panel.h"
#include "ui/terminal/screen.h"

// --- the frame -------------------------------------------------------------------------
// The area of a pane over time, with its window and range, in cells or in pixels.

// The colour of an ink in pictures, for what draws them.
colour picture_colour(const screen *s, colour_theme theme, ink i);

// A pane's place, time window and range.
typedef struct plot_frame {
    canvas canvas;
    double from, to; // [s]
    value_range axis;
    unsigned pattern; // of the curve that is drawn, as of style_pattern
    ink colour;
    cairo_t *picture; // used instead of dots; NULL: none
    pane_frame pixels;
    colour_theme theme;
} plot_frame;

// Begins a picture of the pane if the screen has pixels; it is to be ended.
void plot_frame_open(const explorer_view *view, plot_frame *f);

// Draws one signal of a run up to the instant `until` [s] with the frame's pattern and
// colour: every row if there are few, otherwise the smallest and largest value of each
// column. `pairs`: the smallest and largest values of blocks of EXTREMES_BLOCK rows;
// NULL: not known.
void plot_frame_signal(const plot_frame *f, const trace *t, int signal, double until,
                       const double *pairs);

// A vertical line at an instant [s], behind everything already drawn.
void plot_frame_cursor(const plot_frame *f, screen *s, double time);

// A setpoint or limit across the pane, with its name, behind everything already drawn.
void plot_frame_level(const plot_frame *f, screen *s, double value, const char *name);

// An arrow upwards at an instant [s] with a short text beside it, in the uppermost row
// that has room for the text. False if none has, and nothing is drawn.
bool plot_frame_arrow(const plot_frame *f, screen *s, double time, const char *text);

// --- axes ------------------------------------------------------------------------------
// The axes of the curves: values on the left of each pane, time below all of them.

// An axis of values in its column, its line at the right; the area's rows are the axis.
void draw_value_axis(screen *s, area a, value_range axis);

// The time axis below the curves in one or two rows: contact as a bar, impacts and
// changes as marks with labels, seconds. Returns the area of its line and numbers.
area draw_time_axis(const explorer_model *model, const explorer_view *view, screen *s,
                    area a);

// --- the mouse -------------------------------------------------------------------------

// Handles the mouse on a part of the panel of curves.
bool curves_point(explorer_model *model, explorer_view *view, explorer_input *input,
                  const panel_gesture *g);
