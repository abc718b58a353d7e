#include "render/scene/scene_parts.h"

#include <math.h>

enum {
    EXTENT_ROWS = 400, // of the trace, looked at for what must be seen
    EXTENT_POINTS = EXTENT_ROWS + 64,
};

#define TIP_AROUND 0.04 // what the camera at the tip shows round the contact, in beam lengths

// Points round everything that is ever to be seen. Returns their number.
static int extent(scene *sc, vector *points)
{
    const trace *t = &sc->result->trace;
    const parameters *p = &sc->scenario->parameters;
    const double l = sc->length, low = FLOOR_LEVEL * l, high = PIN_TOP * l;
    int count = 0;

    // the contact alone, or where the tip ends
    if (sc->options.camera.kind == CAMERA_TIP) {
        scene_joints(t, p, t->rows[t->row_count - 1].time, sc->joints);
        vector tip = scene_contact(sc, sc->joints);
        for (int i = 0; i < 8; i++) {
            double a = i & 1 ? TIP_AROUND * l : -TIP_AROUND * l;
            double b = i & 2 ? TIP_AROUND * l : -TIP_AROUND * l;
            points[count++] = (vector){tip.x + a, tip.y + b, i & 4 ? high : -high};
        }
        return count;
    }

    // the motor
    for (int i = 0; i < 8; i++) {
        vector rim = at_angle(i * M_PI / 4, 1.1 * MOTOR_RADIUS * l, 0, i % 2 ? low : high);
        points[count++] = rim;
    }

    // wherever the tip comes
    for (int i = 0; i < EXTENT_ROWS; i++) {
        double time = t->rows[t->row_count - 1].time * i / (EXTENT_ROWS - 1);
        scene_joints(t, p, time, sc->joints);
        points[count] = sc->joints[sc->links];
        points[count++].z = i % 2 ? -BEAM_HEIGHT / 2 * l : BEAM_HEIGHT / 2 * l;
    }

    // the wall, and the longest arrow
    if (p->wall.kind != WALL_NONE) {
        bool slab = p->wall.kind == WALL_PLANE;
        double from = slab ? SLAB_FROM : 0.96, to = slab ? SLAB_TO : 1.05;
        double behind = slab ? SLAB_THICKNESS + BEAM_THICKNESS : 0.06;
        for (int i = 0; i < 8; i++) {
            points[count++] = at_angle(p->wall.angle, (i & 1 ? from : to) * l,
                                       i & 2 ? behind * l : 0, i & 4 ? low : high);
        }
        if (sc->options.force > 0) {
            points[count++] = at_angle(p->wall.angle, l, -(ARROW_LENGTH + 0.05) * l, 0);
        }
    }
    return count;
}

double scene_grid_of(double length)
{
    double power = pow(10, floor(log10(length / 10 * 1.0001))), share = length / 10 / power;
    return (share >= 5 ? 5 : share >= 2 ? 2 : 1) * power;
}

static double heading(const scene *sc)
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

status scene_set_view(scene *sc, fault *f)
{
    vector points[EXTENT_POINTS], low = {HUGE_VAL, HUGE_VAL, 0}, high = {-HUGE_VAL, -HUGE_VAL, 0};
    int count = extent(sc, points);

    // text stands below the picture
    camera_window window = {0.05, 0.05, 0.95, sc->options.plain ? 0.95 : 0.88};
    sc->camera = camera_fit(sc->options.camera, heading(sc), points, count, sc->options.width,
                            sc->options.height, window);
    if (sc->options.camera.kind == CAMERA_TIP) {
        // the rest of the arm lies before and behind what is looked at
        sc->camera.nearest *= 0.2;
        sc->camera.farthest += 2.5 * sc->length;
    }

    // a light to the left of the viewer
    for (int i = 0; i < count; i++) {
        low = (vector){fmin(low.x, points[i].x), fmin(low.y, points[i].y), 0};
        high = (vector){fmax(high.x, points[i].x), fmax(high.y, points[i].y), 0};
    }
    vector right = sc->camera.right, toward = {right.y, -right.x, 0};
    vector lamp = vector_sum(vector_scaled(right, -0.50), 0.32, toward);
    sc->light = vector_unit(vector_sum(lamp, 0.95, (vector){0, 0, 1}));

    // the floor, as far as its middle and beyond
    sc->floor =
        (scene_floor){.level = FLOOR_LEVEL * sc->length,
                      .grid = sc->grid,
                      .middle = vector_scaled(vector_add(low, high), 0.5),
                      .reach = 0.62 * hypot(high.x - low.x, high.y - low.y) + 0.35 * sc->length,
                      .page = sc->around->page,
                      .ground_colour = sc->around->ground,
                      .line = sc->around->line,
                      .light = sc->light};
    return scene_floor_init(&sc->floor, &sc->camera, f);
}
