// The arm from above on a screen that shows pixels: quick, over and over again.
#pragma once

#include "render/scene/scene.h"

// From metres to pixels, the height magnified.
typedef struct plan_view {
    double left, bottom;  // of the picture [m]
    double scale;         // [pixels/m] across
    double magnified;     // times that, up
    double width, height; // [pixels]
} plan_view;

typedef struct plan_colours {
    colour ground, arm, hub, wall, force, other, frame;
} plan_colours;

// An arm at an instant, and what is round it.
typedef struct plan {
    const trace *rows;
    const parameters *parameters;
    double time;           // [s]
    const trace *other;    // of a run beside it, of as many links; NULL: none
    double exaggerate;     // bending is drawn that many times as large; 1: as it is
    double peak;           // the force whose arrow has its full length [N]
    bool pulled;           // by a spring from the tip to a place
    double pull_x, pull_y; // that place [m]
    plan_colours colours;
} plan;

// Paints the plan over the whole picture, from the cairo context's origin on. False without memory.
bool plan_paint(cairo_t *cr, const plan *p, const plan_view *v);

// A view of the contact from near by: the place where the tip meets the wall in the middle of a
// picture of this size [pixels], undistorted.
plan_view plan_close_up(const parameters *p, double width, double height);

// The place of a point [m] on the picture [pixels, down from its upper edge].
double plan_x(const plan_view *v, double x);
double plan_y(const plan_view *v, double y);
