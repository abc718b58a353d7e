// Which part of the plane a plan of the arm shows.
#include "render/scene/plan.h"

#include <math.h>

// An angle beyond which the whole circle is shown [rad].
#define FAR_OUT    0.8
#define HUB_RADIUS 0.05 // of the length of the beam

void plan_extent_add(plan_extent *e, const trace *t, const arm_parameters *beam,
                     size_t first, size_t samples)
{
    double lengths[PARAMETER_LINKS_MOST];
    parameters_link_lengths(beam, lengths);
    const size_t stride = (t->row_count - first) / samples + 1;
    for (size_t r = first; r < t->row_count; r += stride) {
        // the beam's angles are the last of a row
        const double *angles = t->angles + (r + 1) * (size_t)t->angle_count - beam->links;
        double y = 0;
        for (int i = 0; i < beam->links; i++) {
            y += lengths[i] * sin(angles[i]);
            e->most_angle = fmax(e->most_angle, fabs(angles[i]));
            e->lowest = fmin(e->lowest, y);
            e->highest = fmax(e->highest, y);
        }
    }
}

bool plan_is_circle(const plan_extent *e)
{
    return e->most_angle > FAR_OUT;
}

// The largest of some round factors that is not above a bound, at least 1.
static double round_magnification(double most)
{
    static const double factors[] = {1.5, 2, 3, 4, 5, 10, 20};
    double chosen = 1;
    for (size_t i = 0; i < sizeof factors / sizeof factors[0]; i++) {
        if (factors[i] <= most) {
            chosen = factors[i];
        }
    }
    return chosen;
}

double plan_hub_radius(const plan_view *v, double length)
{
    return fmin(fmax(6, HUB_RADIUS * length * v->scale), 0.3 * v->height);
}

plan_view plan_whole(const plan_extent *e, const parameters *p, double width,
                     double height)
{
    const double length = p->arm.length;
    plan_view v = {.magnified = 1, .width = width, .height = height};

    // far out: the whole circle, undistorted
    if (plan_is_circle(e)) {
        v.scale = fmin(width, height) / (2.3 * length);
        v.left = -0.5 * width / v.scale;
        v.bottom = -0.5 * height / v.scale;
        return v;
    }

    // the wall belongs to it
    double low = e->lowest, high = e->highest;
    if (p->wall.kind != WALL_NONE) {
        low = fmin(low, length * sin(p->wall.angle));
        high = fmax(high, length * sin(p->wall.angle));
    }

    // the width is the arm's; heights are magnified as far as there is room
    v.scale = width / (1.25 * length);
    v.left = -0.1 * length;
    v.magnified = round_magnification(height * 0.62 / fmax(v.scale * (high - low), 1e-9));

    // the force's arrow comes from above, so more of the room is left there, if the hub
    // is seen whole without it
    const double spare = height / (v.scale * v.magnified) - (high - low);
    const double hub = (plan_hub_radius(&v, length) + 1) / (v.scale * v.magnified);
    v.bottom = fmin(low - 0.3 * spare, fmax(-hub, low - 0.45 * spare));
    return v;
}
