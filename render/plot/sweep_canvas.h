// What the pictures of a sweep share: the page, its axes and frame.
#pragma once

#include "render/page/palette.h"
#include "render/plot/sweep_plot.h"
#include "render/page/text.h"
#include "render/plot/ticks.h"

#define MM          (72 / 25.4) // [pt]
#define PAGE_WIDTH  (150 * MM)
#define PAGE_HEIGHT (100 * MM)
#define MARGIN      9.0 // [pt]
#define TITLE_SIZE  9.0
#define LABEL_SIZE  8.0
#define TICK_SIZE   7.0
#define TICK_LENGTH 3.0

enum { MARK_TEXT = 64 };

typedef enum scale_kind { SCALE_LINEAR, SCALE_LOGARITHMIC, SCALE_WORDS } scale_kind;

typedef struct sweep_tick {
    double at; // coordinate
    char text[MARK_TEXT];
} sweep_tick;

// One axis of the picture. A coordinate is a value, its decimal logarithm, or the place of a word.
typedef struct sweep_scale {
    scale_kind kind;
    double low, high; // coordinates of its ends
    double *points;   // a grid's coordinates, ascending
    size_t *order;    // points[i] belongs to value order[i] of the sweep's axis
    size_t count;     // of points; 0 if the values were drawn
    sweep_tick ticks[TICKS_MOST];
    int tick_count;
    char label[256]; // markup
} sweep_scale;

// A panel of the picture and what its sides stand for.
typedef struct sweep_canvas {
    cairo_t *cr;
    PangoContext *context;
    const palette *colours;
    figure_rect box; // inside the axes [pt]
    sweep_scale x, y;
} sweep_canvas;

// --- axes: sweep_axes.c

// The coordinate of a value on an axis.
double sweep_coordinate(const sweep_scale *s, double value);

// Sets up the axis of a varied parameter with about `wanted` ticks. False without memory.
bool sweep_scale_of_axis(sweep_scale *s, const sweep_axis *axis, int wanted);

// Sets up the axis of the quantity itself, from `low` to `high`.
void sweep_scale_of_quantity(sweep_scale *s, const char *key, double low, double high, int wanted);

void sweep_scale_finish(sweep_scale *s);

// Makes room at both ends of an axis, as a share of its length.
void sweep_scale_widen(sweep_scale *s, double share);

// --- frame and text: sweep_frame.c

// Places of coordinates on the page [pt].
double sweep_page_x(const sweep_canvas *c, double at);
double sweep_page_y(const sweep_canvas *c, double at);

// Text at (x, y) [pt]; align 0: that is its left or upper edge, 0.5 its middle, 1 its other edge.
void sweep_text(sweep_canvas *c, double x, double y, const char *markup, double size,
                double align_x, double align_y);

// The same, turned to be read from the right, with the middle of its base at (x, y).
void sweep_upright_text(sweep_canvas *c, double x, double y, const char *markup, double size);

// Width of the widest tick label.
double sweep_widest_tick(sweep_canvas *c, const sweep_scale *s);

// A straight line on the page, in the present colour.
void sweep_draw_line(sweep_canvas *c, double x0, double y0, double x1, double y1);

// Lines across the box at all ticks.
void sweep_draw_grid(sweep_canvas *c);

// The box with its ticks outside, and what is written at them. A label that would touch the one
// before it is left out.
void sweep_draw_axes(sweep_canvas *c);

// What the picture shows, above it; below it what needs saying.
void sweep_draw_title(sweep_canvas *c, const sweep_picture *p, const char *note);

// Sets the box between the margins; `right` is what stands at its right side, `note` tells if there
// is one below.
void sweep_place_box(sweep_canvas *c, double right, bool note);

// Smallest and largest finite value; false if there is none.
bool sweep_value_range(const double *values, size_t count, double *low, double *high);

// Number of values that are not there, said in a few words.
void sweep_missing_note(const sweep_picture *p, char *note, size_t size, const char *how);

// Adds a dot to the path.
void sweep_dot(sweep_canvas *c, double x, double y, double radius);

// What stands in an empty box.
void sweep_no_value_text(sweep_canvas *c);

// Coordinates of the runs along an axis, and the quantity, in the order of the axis.
void sweep_gather(const sweep_picture *p, const sweep_scale *s, double *x, double *y);

// --- two parameters: sweep_map.c

// Draws the quantity over both varied parameters.
status sweep_paint_map(sweep_canvas *c, const sweep_picture *p, fault *f);
