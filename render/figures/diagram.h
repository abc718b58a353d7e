// Shared by the thesis's diagrams: a drawing with the numbers it shows.
#pragma once

#include "render/figures/figures.h"
#include "render/page/sketch.h"
#include "src/predict/predict.h"

// A number that a diagram shows or depends on.
typedef struct diagram_value {
    const char *name, *unit;
    double value;
} diagram_value;

// The arm at an instant.
typedef struct arm_shape {
    double first, last; // angles of the links [rad]
    double force;       // contact force [N]
    double time;        // [s]
} arm_shape;

// What is drawn: 3.1 one step and the next; 4.6 the peak, first contact, and the energy
// principle's.
typedef struct arm_shapes {
    arm_shape one, other, assumed;
} arm_shapes;

typedef struct diagram {
    sketch_frame frame;
    char *title, *caption, *parameters;
    void (*draw)(sketch *s, const struct diagram *d);
    opened_run *run; // of its scenario; NULL without one
    parameters p;
    GArray *values;          // diagram_value
    three_body_state before; // 4.2: the instant before the impact
    double after[3];         // angular velocities just after it [rad/s]
    double impulse;          // [N s]
    arm_shapes shapes;       // 3.1, 4.6
} diagram;

// The transformation from metres of the model, y upwards, to the page. `across` enlarges
// distances from the line to the right.
typedef struct view {
    double x, y, metre, across;
} view;

// A point of the model on the page.
point view_place(const view *v, point at);

// End of a piece of length `length` at `angle` [rad] from a point of the model.
point view_end(point from, double length, double angle);

// An angle at a point, from one direction on the page to another, counterclockwise [rad],
// with its symbol at the middle of the arc.
typedef struct angle_arc {
    double radius, from, to;
    const char *markup;
} angle_arc;
void diagram_angle(sketch *s, point at, angle_arc a);

// An angle from a dashed line to the right.
void diagram_link_angle(sketch *s, point at, double radius, double to,
                        const char *markup);

// A diagram of the run of the order's scenario, with one parameter changed if `change` is
// not NULL, or without a scenario of the corrected arm's default parameters. It is drawn
// by `draw`; `body` is the drawing's height [pt]. NULL with the reason if the run fails.
diagram *diagram_create(const figure_order *order, const char *change, double body,
                        void (*draw)(sketch *s, const diagram *d), fault *f);
void diagram_release(void *what);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(diagram, diagram_release)

// The first impact of the run: its impulse, the arm the instant before, and *speed that
// of the contact point [m/s]. Fails as diagram_lacks if there is none.
status diagram_take_impact(diagram *d, double *speed, fault *f);

// STATUS_BAD_SCENARIO for a diagram whose run has not what it shows.
status diagram_lacks(const diagram *d, const char *what, fault *f);

// Adds a number to those that the diagram's CSV lists.
void diagram_add_value(diagram *d, const char *name, double value, const char *unit);

// Gives the diagram its caption, printed as by text_printf, and opens it: the artwork
// owns it, and
// *held is NULL.
status diagram_open(diagram **held, artwork *out, const char *caption, ...)
    __attribute__((format(printf, 3, 4)));
