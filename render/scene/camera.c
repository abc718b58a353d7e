#include "render/scene/camera.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/numbers.h"

// Names, and where each camera stands: to the left of the arm's heading, and above the floor.
// Narrow views keep parallels parallel; a plan is nearly without perspective.
static const struct {
    const char *name;
    double azimuth, elevation; // [degrees]
    double half_view;          // half of the narrower angle of view [rad]
} kinds[] = {
    [CAMERA_THREE_QUARTER] = {"three-quarter", -60, 40, 0.15},
    [CAMERA_TOP] = {"top", -90, 90, 0.02},
    // not straight along the force's arrow, which would be a point
    [CAMERA_SIDE] = {"side", -52, 13, 0.10},
    [CAMERA_TIP] = {"tip", -70, 46, 0.15},
    [CAMERA_FREE] = {NULL, 0, 0, 0.12},
};

bool camera_read(const char *text, camera_view *view)
{
    assert(text != NULL && view != NULL);
    for (size_t i = 0; i < CAMERA_FREE; i++) {
        if (strcmp(kinds[i].name, text) == 0) {
            *view = (camera_view){.kind = (camera_kind)i};
            return true;
        }
    }

    // two angles
    const char *rest;
    camera_view free_view = {.kind = CAMERA_FREE};
    if (!decimal_read(text, &free_view.azimuth, &rest) || *rest != ',' ||
        !decimal_read(rest + 1, &free_view.elevation, &rest) || *rest != '\0' ||
        !(fabs(free_view.azimuth) <= 360) ||
        !(free_view.elevation >= 1 && free_view.elevation <= 90)) {
        return false;
    }
    *view = free_view;
    return true;
}

// The smallest distance, and the sideways place, from which all points lie between two planes:
// |x_i - side| focal <= distance - z_i needs distance + side focal >= max(x_i focal + z_i) and
// distance - side focal >= max(z_i - x_i focal).
static double fit_axis(const vector *points, int count, vector axis, vector back, double focal,
                       double *side)
{
    double right = -HUGE_VAL, left = -HUGE_VAL;
    for (int i = 0; i < count; i++) {
        double x = vector_dot(points[i], axis) * focal, z = vector_dot(points[i], back);
        right = fmax(right, z + x);
        left = fmax(left, z - x);
    }
    *side = (right - left) / (2 * focal);
    return (right + left) / 2;
}

camera camera_fit(camera_view view, double heading, const vector *points, int count, int width,
                  int height, camera_window window)
{
    assert(points != NULL && count > 0 && width > 0 && height > 0);
    // three axes of the view; the half angle is that of the shorter edge
    bool own = view.kind == CAMERA_FREE;
    double azimuth = heading + (own ? view.azimuth : kinds[view.kind].azimuth) * M_PI / 180;
    double elevation = (own ? view.elevation : kinds[view.kind].elevation) * M_PI / 180;
    double c = cos(elevation), s = sin(elevation);
    camera out = {.right = {-sin(azimuth), cos(azimuth), 0},
                  .up = {-s * cos(azimuth), -s * sin(azimuth), c},
                  .back = {c * cos(azimuth), c * sin(azimuth), s},
                  .width = width,
                  .height = height};
    double shorter = fmin(width, height);
    out.focal_x = shorter / width / tan(kinds[view.kind].half_view);
    out.focal_y = shorter / height / tan(kinds[view.kind].half_view);

    // within the window the view is narrower, and its middle is not the picture's
    double share_x = window.right - window.left, share_y = window.bottom - window.top;

    double x, y, far_x = fit_axis(points, count, out.right, out.back, out.focal_x / share_x, &x);
    double far_y = fit_axis(points, count, out.up, out.back, out.focal_y / share_y, &y);
    double distance = fmax(far_x, far_y), low = HUGE_VAL, high = -HUGE_VAL, middle;

    // shift the eye so that the points' middle depth falls into the window's middle
    for (int i = 0; i < count; i++) {
        double depth = distance - vector_dot(points[i], out.back);
        low = fmin(low, depth);
        high = fmax(high, depth);
    }
    middle = (low + high) / 2;
    x -= (window.left + window.right - 1) * middle / out.focal_x;
    y += (window.top + window.bottom - 1) * middle / out.focal_y;
    out.eye = vector_sum(vector_sum(vector_scaled(out.right, x), y, out.up), distance, out.back);

    // the points are only the outermost ones of what is seen
    out.nearest = fmax(0.1 * low, low - (high - low));
    out.farthest = high + (high - low);
    return out;
}

vector camera_project(const camera *c, vector point)
{
    assert(c != NULL);
    vector to = vector_sum(point, -1, c->eye);
    double depth = -vector_dot(to, c->back);
    return (vector){(1 + c->focal_x * vector_dot(to, c->right) / depth) * c->width / 2,
                    (1 - c->focal_y * vector_dot(to, c->up) / depth) * c->height / 2, depth};
}

vector camera_ray(const camera *c, double x, double y)
{
    assert(c != NULL);
    double across = (2 * x / c->width - 1) / c->focal_x, up = (1 - 2 * y / c->height) / c->focal_y;
    vector ray = vector_scaled(c->back, -1);
    return vector_sum(vector_sum(ray, across, c->right), up, c->up);
}
