// Curves of a run on a screen that shows pixels: quick, without axes, over and over again.
#pragma once

#include <cairo.h>

#include "render/page/palette.h"
#include "src/run/trace.h"

// What the edges of a pane stand for.
typedef struct pane_frame {
    double from, to;      // [s]
    double low, high;     // in the signal's unit
    double width, height; // [pixels]
    double line;          // width of a line [pixels]
} pane_frame;

typedef struct pane_curve {
    const trace *rows;
    int signal;
    double until;        // of the run that is shown [s]
    const double *pairs; // lowest and highest value of each block of rows; NULL: not known
    size_t block;        // rows of a block
    unsigned pattern;    // sixteen pieces of the line, of `piece` pixels each: bit i is drawn
    double piece;
    colour colour;
} pane_curve;

// Draws a signal over time. Where several rows lie in one column of pixels the line goes through
// the smallest and the largest of them, so that no spike is lost. Values that are not finite leave
// gaps.
void pane_curve_paint(cairo_t *cr, const pane_frame *f, const pane_curve *c);

// A dotted line across the pane at a value; nothing for one outside it.
void pane_level_paint(cairo_t *cr, const pane_frame *f, double value, colour in);

// A line down the pane at an instant [s]; nothing for one outside it.
void pane_instant_paint(cairo_t *cr, const pane_frame *f, double time, colour in);
