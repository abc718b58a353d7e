// The view of a scene: camera, light and floor, so that the whole run is visible.
#include <assert.h>
#include <math.h>

#include "render/scene/scene_parts.h"

enum {
    EXTENT_ROWS = 400, // of the trace, looked at for what must be seen
    EXTENT_POINTS = EXTENT_ROWS + 64,
};

// what the camera at the tip shows round the contact, in beam lengths
#define TIP_AROUND 0.04

// Height of a strip for large letters: four lines of a title and facts, or a key of five
// instants [pixels at a scale of 1].
#define LARGE_LETTERS_STRIP 140.0

// The corners of a box, of which bit 0 of the corner's number chooses `along`, bit 1
// `across` and bit 2 `up`; the first of each pair where the bit is set.
typedef struct extent_box {
    double along[2], across[2], up[2];
} extent_box;

static vector box_corner(const extent_box *b, int corner)
{
    const int unset[] = {(corner & 1) == 0, (corner & 2) == 0, (corner & 4) == 0};
    return (vector){b->along[unset[0]], b->across[unset[1]], b->up[unset[2]]};
}

// The contact alone, or where the tip ends.
static int add_tip_extent(scene *sc, vector *points)
{
    const trace *t = &sc->result->trace;
    const double near = TIP_AROUND * sc->length, high = PIN_TOP * sc->length;
    const extent_box around = {{near, -near}, {near, -near}, {high, -high}};

    const sample last = scene_joints(t, &sc->scenario->parameters,
                                     t->rows[t->row_count - 1].time, sc->joints);
    const vector tip = scene_contact(sc, &last);

    // a box round it
    for (int i = 0; i < 8; i++) {
        const vector corner = box_corner(&around, i);
        points[i] = (vector){tip.x + corner.x, tip.y + corner.y, corner.z};
    }
    return 8;
}

// The wall, and the longest arrow. Returns the number of points.
static int add_wall_extent(const scene *sc, vector *points)
{
    const wall_parameters *w = &sc->scenario->parameters.wall;
    const double l = sc->length, low = FLOOR_LEVEL * l, high = PIN_TOP * l;
    extent_box around = {{0.96, 1.05}, {0.06 * l, 0}, {low, high}};
    if (w->kind == WALL_NONE) {
        return 0;
    }
    if (w->kind == WALL_PLANE) {
        around = (extent_box){{SLAB_FROM, SLAB_TO},
                              {(SLAB_THICKNESS + BEAM_THICKNESS) * l, 0},
                              {low, high}};
    }

    int count = 0;
    for (int i = 0; i < 8; i++) {
        const vector corner = box_corner(&around, i);
        points[count++] = scene_at_angle(w->angle, corner.x * l, corner.y, corner.z);
    }
    if (sc->options.force > 0) {
        points[count++] = scene_at_angle(w->angle, l, -(ARROW_LENGTH + 0.05) * l, 0);
    }
    return count;
}

// Points round everything that is ever to be seen. Returns their number.
static int points_of_extent(scene *sc, vector *points)
{
    const trace *t = &sc->result->trace;
    const parameters *p = &sc->scenario->parameters;
    const double l = sc->length, low = FLOOR_LEVEL * l, high = PIN_TOP * l;
    int count = 0;
    if (sc->options.camera.kind == CAMERA_TIP) {
        return add_tip_extent(sc, points);
    }

    // the motor, low and high in turn
    for (int i = 0; i < 8; i++) {
        const double z = i % 2 == 0 ? high : low;
        points[count++] = scene_at_angle(i * M_PI / 4, 1.1 * MOTOR_RADIUS * l, 0, z);
    }

    // wherever the tip comes, its upper and its lower edge in turn
    for (int i = 0; i < EXTENT_ROWS; i++) {
        const double time = t->rows[t->row_count - 1].time * i / (EXTENT_ROWS - 1);
        scene_joints(t, p, time, sc->joints);
        points[count] = sc->joints[sc->links];
        points[count++].z = i % 2 == 0 ? BEAM_HEIGHT / 2 * l : -BEAM_HEIGHT / 2 * l;
    }
    return count + add_wall_extent(sc, points + count);
}

// The direction from which "left" and "right" of the arm count [rad]: towards the wall,
// or the mean of where the last link points.
static double arm_heading(const scene *sc)
{
    const parameters *p = &sc->scenario->parameters;
    if (p->wall.kind != WALL_NONE) {
        return p->wall.angle;
    }
    const trace *t = &sc->result->trace;
    double sum = 0;
    for (size_t i = 0; i < t->row_count; i++) {
        sum += t->rows[i].last_angle;
    }
    return sum / (double)t->row_count;
}

// Chooses the camera, the light and the floor by what is ever to be seen.
void scene_set_view(scene *sc)
{
    vector points[EXTENT_POINTS];
    int count = points_of_extent(sc, points);

    // text stands below the picture; letters that are large in it want a strip of their
    // own
    camera_window window = {0.05, 0.05, 0.95, 0.88};
    if (labels_are_large(sc)) {
        window.bottom = 1 - LARGE_LETTERS_STRIP * labels_scale(sc) / sc->options.height;
    }
    if (sc->options.plain) {
        window.bottom = 0.95;
    }
    sc->camera = camera_fit(sc->options.camera, arm_heading(sc), points, count,
                            sc->options.width, sc->options.height, window);
    if (sc->options.camera.kind == CAMERA_TIP) {
        // nearer by, where that is asked for
        const vector middle = vector_scaled(vector_add(points[0], points[7]), 0.5);
        const double larger =
            sc->options.least_scale / labels_pixels(&sc->camera, middle, 1);
        sc->camera.focal_x *= fmax(1, larger);
        sc->camera.focal_y *= fmax(1, larger);

        // the rest of the arm lies before and behind what is looked at
        sc->camera.nearest *= 0.2;
        sc->camera.farthest += 2.5 * sc->length;
    }

    // how far all that is seen reaches over the floor
    vector low = {HUGE_VAL, HUGE_VAL, 0}, high = {-HUGE_VAL, -HUGE_VAL, 0};
    for (int i = 0; i < count; i++) {
        low = (vector){fmin(low.x, points[i].x), fmin(low.y, points[i].y), 0};
        high = (vector){fmax(high.x, points[i].x), fmax(high.y, points[i].y), 0};
    }

    // a light to the left of the viewer
    vector right = sc->camera.right, toward = {right.y, -right.x, 0};
    vector lamp = vector_sum(vector_scaled(right, -0.50), 0.32, toward);
    sc->light = vector_unit(vector_sum(lamp, 0.95, (vector){0, 0, 1}));

    // the floor, as far as its middle and beyond
    const double reach = 0.62 * hypot(high.x - low.x, high.y - low.y) + 0.35 * sc->length;
    scene_floor_init(sc, vector_scaled(vector_add(low, high), 0.5), reach);
}
