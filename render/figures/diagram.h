// What the thesis's diagrams share: a drawing with the numbers it shows.
#pragma once

#include "render/figures/artwork.h"
#include "render/page/sketch.h"
#include "src/predict/predict.h"

enum { DIAGRAM_VALUES = 16, CURVE_POINTS = 400 };

// A number that a diagram shows or is drawn from.
typedef struct diagram_value {
    const char *name, *unit;
    double value;
} diagram_value;

typedef struct diagram {
    sketch_frame frame;
    char *title, *caption, *parameters;
    void (*draw)(sketch *s, const struct diagram *d);
    parameters p;
    diagram_value values[DIAGRAM_VALUES];
    int value_count;
    three_body_state before;   // 4.2: the instant before the impact
    double after[3];           // angular velocities just after it [rad/s]
    double impulse;            // [N s]
    double *curve_x, *curve_y; // 2.1: force and output
} diagram;

// A diagram with the corrected arm's default parameters; title and caption are copied, `body` is
// the drawing's height [pt]. Set `draw`, then give it to artwork_of_diagram.
diagram *diagram_create(const char *title, const char *caption, double body,
                        const figure_options *o);
void diagram_release(void *what);

// Adds a number to those that the diagram's CSV lists.
void diagram_add_value(diagram *d, const char *name, double value, const char *unit);

// The diagram as an artwork, which owns it.
artwork artwork_of_diagram(diagram *d);
