// The arm from above, drawn quickly and repeatedly.
#pragma once

#include <assert.h>
#include <math.h>

#include "render/scene/plan_extent.h"
#include "render/scene/scene.h"

// The transformation from metres to pixels, with magnified height.
typedef struct plan_view {
    double left, bottom;  // of the picture [m]
    double scale;         // [pixels/m] across
    double magnified;     // times that, up
    double width, height; // [pixels]
} plan_view;

// The radius of the hub's disc in a view of a beam of some length [m], in pixels.
double plan_hub_radius(const plan_view *v, double length);

// What shows all that the arm sweeps over, and its wall, on a picture of this size
// [pixels or dots].
plan_view plan_whole(const plan_extent *e, const parameters *p, double width,
                     double height);

typedef struct plan_colours {
    colour ground, arm, hub, wall, force, other, frame;
} plan_colours;

// An arm at an instant with its surroundings.
typedef struct plan {
    const trace *rows;
    const parameters *parameters;
    double time;           // [s]
    const trace *other;    // of a second run with the same number of links; NULL: none
    double exaggerate;     // factor by which bending is enlarged; 1: none
    double peak;           // the force whose arrow has its full length [N]
    bool pulled;           // pulled by a spring from the tip to a point
    double pull_x, pull_y; // that point [m]
    plan_colours colours;
} plan;

// Paints the plan over the whole picture, from the origin of the cairo context.
void plan_paint(cairo_t *cr, const plan *p, const plan_view *v);

#define PLAN_CLOSE_WIDTH 0.10 // what a close-up shows across, in beam lengths

// A close-up of the contact: the point where the tip meets the wall is in the middle of a
// picture of this size [pixels], undistorted.
static inline plan_view plan_close_up(const parameters *p, double width, double height)
{
    assert(width > 0 && height > 0);
    const double length = p->arm.length, scale = width / (PLAN_CLOSE_WIDTH * length);
    return (plan_view){.left = length * cos(p->wall.angle) - 0.6 * width / scale,
                       .bottom = length * sin(p->wall.angle) - 0.5 * height / scale,
                       .scale = scale,
                       .magnified = 1,
                       .width = width,
                       .height = height};
}

// The position of a point [m] on the picture [pixels, down from its upper edge].
static inline double plan_x(const plan_view *v, double x)
{
    return (x - v->left) * v->scale;
}

static inline double plan_y(const plan_view *v, double y)
{
    return v->height - (y - v->bottom) * v->scale * v->magnified;
}
