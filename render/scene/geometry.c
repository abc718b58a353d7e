// Geometry of scenes: vectors, solids as triangles, and the camera that sees them.
#include "render/scene/geometry.h"

#include <assert.h>
#include <glib.h>
#include <math.h>
#include <string.h>

#include "src/base/numbers.h"

enum { LATHE_SIDES = 56, TUBE_SIDES = 8, BOX_CELLS = 40 };

vector vector_add(vector a, vector b)
{
    return (vector){a.x + b.x, a.y + b.y, a.z + b.z};
}

vector vector_scaled(vector a, double factor)
{
    return (vector){factor * a.x, factor * a.y, factor * a.z};
}

vector vector_sum(vector a, double factor, vector b)
{
    return vector_add(a, vector_scaled(b, factor));
}

static vector vector_cross(vector a, vector b)
{
    return (vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double vector_dot(vector a, vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

vector vector_unit(vector a)
{
    double length = sqrt(vector_dot(a, a));
    if (length > 0) {
        return vector_scaled(a, 1 / length);
    }
    return (vector){1, 0, 0};
}

void mesh_finish(mesh *m)
{
    g_free(m->vertices);
    g_free(m->corners);
    *m = (mesh){0};
}

// Room for `more` items of a size after `count`, by doubling. Returns the items. One
// doubling is enough: every call for an array asks for the same `more`, and the first
// capacity is 4096 times that.
static void *grown(void *items, size_t count, size_t more, size_t *capacity, size_t size)
{
    if (count + more <= *capacity) {
        return items;
    }
    if (*capacity > 0) {
        *capacity = 2 * *capacity;
    } else {
        *capacity = 4096 * more;
    }
    return g_realloc_n(items, *capacity, size);
}

// Adds a vertex and returns its number.
static unsigned add_vertex(mesh *m, vector place, vector normal, material of)
{
    m->vertices =
        grown(m->vertices, m->vertex_count, 1, &m->vertex_capacity, sizeof *m->vertices);
    m->vertices[m->vertex_count] = (mesh_vertex){place, normal, of};
    return (unsigned)m->vertex_count++;
}

// Adds two triangles.
static void add_quad(mesh *m, unsigned a, unsigned b, unsigned c, unsigned d)
{
    const unsigned corners[] = {a, b, c, a, c, d};
    m->corners =
        grown(m->corners, m->corner_count, 6, &m->corner_capacity, sizeof *m->corners);
    memcpy(m->corners + m->corner_count, corners, sizeof corners);
    m->corner_count += 6;
}

// A quadrilateral of one normal.
static void add_flat(mesh *m, const vector corners[4], vector normal, material of)
{
    const unsigned first = (unsigned)m->vertex_count;
    for (int i = 0; i < 4; i++) {
        add_vertex(m, corners[i], normal, of);
    }
    add_quad(m, first, first + 1, first + 2, first + 3);
}

// Two unit vectors that make a right-handed frame with the axis.
static void frame_of(vector axis, vector *across, vector *other)
{
    vector least = {1, 0, 0};
    if (fabs(axis.z) < 0.9) {
        least = (vector){0, 0, 1};
    }
    *across = vector_unit(vector_cross(least, axis));
    *other = vector_cross(axis, *across);
}

// The unit vector across the axis of that frame at step `i` of a circle of `sides`.
static vector circle_at(vector across, vector other, int i, int sides)
{
    const double angle = 2 * M_PI * i / sides;
    return vector_sum(vector_scaled(across, cos(angle)), sin(angle), other);
}

// A solid of revolution, by a ring of quadrilaterals between two circles each.
void mesh_lathe(mesh *m, vector base, vector axis, const lathe_ring *rings, int count,
                material of)
{
    vector across, other;
    assert(count > 1);
    frame_of(axis, &across, &other);

    // one ring of quadrilaterals between each circle and the next
    for (int k = 0; k + 1 < count; k++) {
        const lathe_ring *low = &rings[k], *high = &rings[k + 1];
        // the normal of a cone's flank leans against its taper
        double rise = high->along - low->along, taper = low->radius - high->radius;
        unsigned before_low = 0, before_high = 0;

        for (int i = 0; i <= LATHE_SIDES; i++) {
            vector out = circle_at(across, other, i, LATHE_SIDES);
            vector normal =
                vector_unit(vector_sum(vector_scaled(out, rise), taper, axis));

            vector foot = vector_sum(base, low->along, axis);
            vector head = vector_sum(base, high->along, axis);
            unsigned at_low =
                add_vertex(m, vector_sum(foot, low->radius, out), normal, of);
            unsigned at_high =
                add_vertex(m, vector_sum(head, high->radius, out), normal, of);

            if (i > 0) {
                add_quad(m, before_low, at_low, at_high, before_high);
            }
            before_low = at_low;
            before_high = at_high;
        }
    }
}

// Into how many cells of about a size an edge is divided, of which half is given.
static int cells_along(vector half, double cell)
{
    double cells = ceil(2 * sqrt(vector_dot(half, half)) / cell);
    if (cells < 1) {
        return 1;
    }
    if (cells > BOX_CELLS) {
        return BOX_CELLS;
    }
    return (int)cells;
}

// The face of a box that `out` points at.
static void add_face(mesh *m, vector centre, vector out, vector u, vector v, double cell,
                     material of)
{
    int across = cells_along(u, cell), down = cells_along(v, cell);
    vector middle = vector_add(centre, out), normal = vector_unit(out);

    // one quadrilateral a cell: light is computed at vertices alone
    for (int i = 0; i < across; i++) {
        for (int j = 0; j < down; j++) {
            static const int di[] = {0, 1, 1, 0}, dj[] = {0, 0, 1, 1};
            vector corners[4];
            for (int k = 0; k < 4; k++) {
                double a = 2.0 * (i + di[k]) / across - 1,
                       b = 2.0 * (j + dj[k]) / down - 1;
                corners[k] = vector_sum(vector_sum(middle, a, u), b, v);
            }
            add_flat(m, corners, normal, of);
        }
    }
}

void mesh_box(mesh *m, const box *b, double cell, material of)
{
    assert(cell > 0);
    const vector half[] = {b->u, b->v, b->w};
    for (int face = 0; face < 3; face++) {
        vector out = half[face], along = half[(face + 1) % 3],
               across = half[(face + 2) % 3];
        add_face(m, b->centre, out, along, across, cell, of);
        add_face(m, b->centre, vector_scaled(out, -1), across, along, cell, of);
    }
}

// A cross-section: corners and, of the edge from each to the next, the normal.
typedef struct section {
    double across[8], up[8], normal_across[8], normal_up[8];
} section;

// A rectangle with chamfered edges, which reflect light.
static section broken_rectangle(double thickness, double height)
{
    double a = thickness / 2, b = height / 2, c = thickness / 4, d = M_SQRT1_2;
    return (section){.across = {a, a, a - c, -(a - c), -a, -a, -(a - c), a - c},
                     .up = {-(b - c), b - c, b, b, b - c, -(b - c), -b, -b},
                     .normal_across = {1, d, 0, -d, -1, -d, 0, d},
                     .normal_up = {0, d, 1, d, 0, -d, -1, -d}};
}

// Direction of a polyline at a place, by its neighbours.
static vector direction_at(const vector *places, int count, int i)
{
    const int before = MAX(i - 1, 0), after = MIN(i + 1, count - 1);
    return vector_unit(vector_sum(places[after], -1, places[before]));
}

static vector section_point(const section *s, int corner, vector place, vector across)
{
    vector p = vector_sum(place, s->across[corner], across);
    p.z += s->up[corner];
    return p;
}

// Closes a ribbon's end: the eight-sided section as three quadrilaterals. `forward`: the
// one that looks along the ribbon.
static void cap_ribbon(mesh *m, const section *s, vector place, vector along,
                       bool forward, material of)
{
    static const int quads[3][4] = {{0, 1, 4, 5}, {1, 2, 3, 4}, {5, 6, 7, 0}};
    const vector across = {-along.y, along.x, 0};
    vector normal = along;
    if (!forward) {
        normal = vector_scaled(along, -1);
    }

    // corners run counterclockwise as seen from outside
    for (int q = 0; q < 3; q++) {
        vector corners[4];
        for (int i = 0; i < 4; i++) {
            const int at = forward ? i : 3 - i;
            corners[i] = section_point(s, quads[q][at], place, across);
        }
        add_flat(m, corners, normal, of);
    }
}

// A bar of eight sides along the points, with a flat end at each.
void mesh_ribbon(mesh *m, const vector *places, int count, double height,
                 double thickness, material of)
{
    assert(count > 0);
    const section s = broken_rectangle(thickness, height);

    // edge by edge, as each has a normal of its own
    for (int edge = 0; edge < 8; edge++) {
        unsigned before_low = 0, before_high = 0;
        for (int i = 0; i < count; i++) {
            vector along = direction_at(places, count, i),
                   across = {-along.y, along.x, 0};
            vector normal = vector_scaled(across, s.normal_across[edge]);
            normal.z = s.normal_up[edge];
            unsigned low =
                add_vertex(m, section_point(&s, edge, places[i], across), normal, of);
            unsigned high =
                add_vertex(m, section_point(&s, (edge + 1) % 8, places[i], across),
                           normal, of);

            if (i > 0) {
                add_quad(m, before_low, before_high, high, low);
            }
            before_low = low;
            before_high = high;
        }
    }

    // the ends
    if (count > 1) {
        cap_ribbon(m, &s, places[0], direction_at(places, count, 0), false, of);
        cap_ribbon(m, &s, places[count - 1], direction_at(places, count, count - 1), true,
                   of);
    }
}

// A tube along the points, open at its ends.
void mesh_tube(mesh *m, const vector *places, const material *of, int count,
               double radius)
{
    unsigned before = 0;
    for (int i = 0; i < count; i++) {
        vector across, other;
        frame_of(direction_at(places, count, i), &across, &other);

        // a circle of vertices
        const unsigned first = (unsigned)m->vertex_count;
        for (int k = 0; k <= TUBE_SIDES; k++) {
            vector out = circle_at(across, other, k, TUBE_SIDES);
            add_vertex(m, vector_sum(places[i], radius, out), out, of[i]);
        }

        // joined with the circle before
        for (unsigned k = 0; k < TUBE_SIDES && i > 0; k++) {
            add_quad(m, before + k, before + k + 1, first + k + 1, first + k);
        }
        before = first;
    }
}

void mesh_arrow(mesh *m, vector start, vector direction, double length, double radius,
                material of)
{
    assert(length >= 0 && radius > 0);
    double head = fmin(7 * radius, 0.6 * length),
           broad = 2.6 * radius * head / (7 * radius);
    double shaft = fmin(radius, 0.5 * broad);
    const lathe_ring rings[] = {
        {0, 0}, {0, shaft}, {length - head, shaft}, {length - head, broad}, {length, 0}};
    mesh_lathe(m, start, direction, rings, 5, of);
}

// ==== the camera

// Names, and where each camera stands: to the left of the arm's heading, and above the
// floor. Narrow views keep parallels parallel; a plan is nearly without perspective.
static const struct {
    const char *name;
    double azimuth, elevation; // [degrees]
    double half_view;          // half of the narrower angle of view [rad]
} kinds[] = {
    [CAMERA_THREE_QUARTER] = {"three-quarter", -44, 40, 0.15},
    [CAMERA_TOP] = {"top", -90, 90, 0.02},
    // not straight along the force's arrow, which would be a point
    [CAMERA_SIDE] = {"side", -52, 13, 0.10},
    [CAMERA_TIP] = {"tip", -32, 46, 0.15},
    [CAMERA_FREE] = {NULL, 0, 0, 0.12},
};

// A named view, or two angles of its own.
bool camera_read(const char *text, camera_view *view)
{
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

// The smallest distance, and the sideways place, from which all points lie between two
// planes:
// |x_i - side| focal <= distance - z_i needs distance + side focal >= max(x_i focal +
// z_i) and distance - side focal >= max(z_i - x_i focal).
static double fit_axis(const vector *points, int count, vector axis, vector back,
                       double focal, double *side)
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

// The camera that sees all points within a window, from as near as can be.
camera camera_fit(camera_view view, double heading, const vector *points, int count,
                  int width, int height, camera_window window)
{
    assert(count > 0 && width > 0 && height > 0);
    if (view.kind != CAMERA_FREE) {
        view.azimuth = kinds[view.kind].azimuth;
        view.elevation = kinds[view.kind].elevation;
    }

    // three axes of the view
    const double azimuth = heading + view.azimuth * M_PI / 180;
    const double elevation = view.elevation * M_PI / 180;
    double c = cos(elevation), s = sin(elevation);
    camera out = {.right = {-sin(azimuth), cos(azimuth), 0},
                  .up = {-s * cos(azimuth), -s * sin(azimuth), c},
                  .back = {c * cos(azimuth), c * sin(azimuth), s},
                  .width = width,
                  .height = height};

    // the half angle is that of the shorter edge
    double shorter = fmin(width, height);
    out.focal_x = shorter / width / tan(kinds[view.kind].half_view);
    out.focal_y = shorter / height / tan(kinds[view.kind].half_view);

    // as near as the window, in which the view is narrower, lets all points be seen, with
    // the eye at (x, y) across
    const double share_x = window.right - window.left;
    const double share_y = window.bottom - window.top;
    double x, y;
    const double far_x =
        fit_axis(points, count, out.right, out.back, out.focal_x / share_x, &x);
    const double far_y =
        fit_axis(points, count, out.up, out.back, out.focal_y / share_y, &y);
    const double distance = fmax(far_x, far_y);

    // the depths between which the points lie
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i < count; i++) {
        double depth = distance - vector_dot(points[i], out.back);
        low = fmin(low, depth);
        high = fmax(high, depth);
    }

    // the eye shifted so that their middle falls into the window's middle
    const double middle = (low + high) / 2;
    x -= (window.left + window.right - 1) * middle / out.focal_x;
    y += (window.top + window.bottom - 1) * middle / out.focal_y;
    out.eye = vector_sum(vector_sum(vector_scaled(out.right, x), y, out.up), distance,
                         out.back);

    // the points are only the outermost ones of what is seen
    out.nearest = fmax(0.1 * low, low - (high - low));
    out.farthest = high + (high - low);
    return out;
}

vector camera_project(const camera *c, vector point)
{
    vector to = vector_sum(point, -1, c->eye);
    double depth = -vector_dot(to, c->back);
    return (vector){(1 + c->focal_x * vector_dot(to, c->right) / depth) * c->width / 2,
                    (1 - c->focal_y * vector_dot(to, c->up) / depth) * c->height / 2,
                    depth};
}

vector camera_ray(const camera *c, double x, double y)
{
    double across = (2 * x / c->width - 1) / c->focal_x,
           up = (1 - 2 * y / c->height) / c->focal_y;
    vector ray = vector_scaled(c->back, -1);
    return vector_sum(vector_sum(ray, across, c->right), up, c->up);
}
