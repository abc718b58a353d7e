// Texts and marks on a scene.
#pragma once

#include <pango/pangocairo.h>

#include "render/scene/camera.h"

#define LABELS_LEAST 16.0 // least letters [pixels of a picture 720 high]

typedef struct labels {
    cairo_t *cr;
    PangoContext *context;
    const camera *camera;
    colour strong, faint; // inks of titles and of facts
    double scale;         // scale of letters and lines: 1 for a picture 720 pixels high
} labels;

// A flash at a point, with a radius [m] and a strength of 0 to 1.
void labels_flash(const labels *l, vector place, double radius, double strength);

// "1.34 N" next to the head of an arrow that starts at `from`.
void labels_force(const labels *l, vector from, vector end, double force, colour ink);

// Title, in lines of at most `width` [pixels], and a line of facts at the lower left corner;
// `facts` is markup, `title` plain.
void labels_caption(const labels *l, const char *title, const char *facts, double width);

// The length in pixels of a length [m] at a point.
double labels_pixels(const camera *c, vector place, double length);

// "contact, 1.8 times" below the left corner of an inset [pixels].
void labels_inset(const labels *l, double left, double bottom, double larger);

// A legend of instants [s] with their colours at the lower right corner.
void labels_instants(const labels *l, const double *times, const colour *inks, int count);
