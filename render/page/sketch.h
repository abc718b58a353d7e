// Pages that are drawn rather than plotted: diagrams and tables, with a title above and a
// caption below. Lengths are in points of the page as designed. On a page of another
// width lengths are scaled, while letters and lines keep their size as far as needed to
// be readable.
#pragma once

#include "render/page/page.h"
#include "render/page/text.h"

#define SKETCH_WIDTH  370.0 // a page as designed (130 mm)
#define SKETCH_MARGIN 8.0

// Title, caption and size of a drawing.
typedef struct sketch_frame {
    const char *title;   // plain
    const char *caption; // markup, wrapped; NULL for none
    double body_height;  // of the drawing itself [pt]
    double design_width; // of the page on which the drawing is designed [pt]; 0:
                         // SKETCH_WIDTH
    page_look look;
} sketch_frame;

typedef struct sketch {
    cairo_t *cr;
    PangoContext *context;
    const palette *colours;
    figure_theme theme;
    const sketch_frame *frame; // NULL: letters unchanged
    figure_report *report;     // may be NULL
    double scale;              // points of the page per designed point
    double left, right;        // of the drawing
    double top, bottom;
    status code; // of what was drawn so far, with its fault in f (may be NULL)
    fault *f;
} sketch;

// Size of letters in designed points for `size` points on the page; they shrink less than
// the page.
double sketch_letters(const sketch_frame *frame, double size);

// Size of the page in its own points.
void sketch_size(const sketch_frame *frame, double *width, double *height);

// Paints page, title and caption and begins the drawing, to be ended with sketch_end.
// STATUS_CANNOT_READ if the font is missing.
status sketch_begin(sketch *s, cairo_t *cr, const sketch_frame *frame,
                    figure_report *report, fault *f);
status sketch_end(sketch *s); // returns s->code

// Instead of a palette slot: the colours of axes and text, and of secondary parts.
enum { SKETCH_INK = -1, SKETCH_FAINT = -2 };

// A place on the page, or in a model that is drawn [pt, m].
typedef struct point {
    double x, y;
} point;

// The point `right` and `down` of another.
point shifted(point from, double right, double down);

// Lines of a given width in a slot's colour.
void sketch_line(const sketch *s, point from, point to, double width, int slot);
void sketch_dashed(const sketch *s, point from, point to, int slot);

// An arrow with its head at `to`.
void sketch_arrow(const sketch *s, point from, point to, int slot);
void sketch_dashed_arrow(const sketch *s, point from, point to, int slot);

// A line with a head at each end.
void sketch_measure(const sketch *s, point from, point to);

// An arc from one angle to another, counterclockwise from the right [rad].
typedef struct arc {
    point centre;
    double radius, from, to;
    bool head; // at its end
} arc;
void sketch_arc(const sketch *s, arc a, int slot);

void sketch_disc(const sketch *s, point centre, double radius, int slot, bool filled);

// A link: a bar with round ends between two points.
void sketch_bar(const sketch *s, point from, point to, double thickness);

// A centre of mass.
void sketch_mass_point(const sketch *s, point at);

// A spiral spring round a joint.
void sketch_spiral(const sketch *s, point centre, double radius, int slot);

// A coil spring and a resistor along a line.
void sketch_coil(const sketch *s, point from, point to, int turns, int slot);
void sketch_resistor(const sketch *s, point from, point to);

// A fixed surface: a line, hatched on its right-hand side as seen from its start.
void sketch_wall(const sketch *s, point from, point to);

// A text with its anchor at a place, printed as by text_printf, in letters of a size;
// those of labels and smaller ones.
void sketch_text(sketch *s, double size, point at, anchor part, const char *format, ...)
    __attribute__((format(printf, 5, 6)));
#define sketch_label(s, ...) sketch_text(s, 8, __VA_ARGS__)
#define sketch_small(s, ...) sketch_text(s, 7, __VA_ARGS__)

// A text that begins at a point, wrapped at its width; its size is that of a designed
// page. The frame's family replaces the block's.
void sketch_wrapped(sketch *s, point at, const text_block *text);
