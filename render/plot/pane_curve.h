// Curves of a run on a screen with pixels: without axes, drawn quickly and repeatedly.
#pragma once

#include <cairo.h>

#include "render/page/page.h"
#include "src/run/trace.h"

// The values at the edges of a pane.
typedef struct pane_frame {
    double from, to;      // [s]
    double low, high;     // in the signal's unit
    double width, height; // [pixels]
    double line;          // width of a line [pixels]
} pane_frame;

typedef struct pane_curve {
    const trace *rows;
    int signal;
    double until; // of the run that is shown [s]
    const double
        *pairs;   // lowest and highest value of each block of rows; NULL: not known
    size_t block; // rows of a block
    unsigned
        pattern; // sixteen pieces of the line, of `piece` pixels each: bit i is drawn
    double piece;
    colour colour;
} pane_curve;

// Draws a signal over time. Where several rows lie in one column of pixels the line goes
// through the smallest and the largest of them, so that no spike is lost. Values that are
// not finite leave gaps.
void pane_curve_paint(cairo_t *cr, const pane_frame *f, const pane_curve *c);

// A dotted horizontal line at a value; nothing if it is outside the pane.
void pane_level_paint(cairo_t *cr, const pane_frame *f, double value, colour in);

// A vertical line at an instant [s]; nothing if it is outside the pane.
void pane_instant_paint(cairo_t *cr, const pane_frame *f, double time, colour in);
