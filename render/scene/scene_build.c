// A scene: the arm's shape over time, the meshes of arm, wall and arrow, camera, light
// and floor.
#include <assert.h>
#include <math.h>

#include "render/scene/scene_parts.h"

enum { CURVE_PIECES = 96 }; // of a beam with few links

static double between(double a, double b, double share)
{
    return a + share * (b - a);
}

sample scene_joints(const trace *t, const parameters *p, double time, vector *joints)
{
    assert(t->row_count > 0 && isfinite(time));
    size_t links = (size_t)p->arm.links, first = (size_t)t->angle_count - links;
    double lengths[PARAMETER_LINKS_MOST];

    // the rows on both sides of the instant and the share of the second
    size_t until = trace_rows_until(t, time), before = until > 0 ? until - 1 : 0;
    size_t after = until > 0 && until < t->row_count ? until : before;
    double span = t->rows[after].time - t->rows[before].time;
    double share = span > 0 ? (time - t->rows[before].time) / span : 0;
    const double *a = t->angles + before * (size_t)t->angle_count + first;
    const double *b = t->angles + after * (size_t)t->angle_count + first;
    parameters_link_lengths(&p->arm, lengths);

    // link by link from the hub
    joints[0] = (vector){0};
    for (size_t k = 0; k < links; k++) {
        double angle = between(a[k], b[k], share);
        joints[k + 1] =
            vector_sum(joints[k], lengths[k], (vector){cos(angle), sin(angle), 0});
    }

    // the row between the two
    sample row = t->rows[before];
    const sample *next = &t->rows[after];
    row.time = time;
    row.hub_angle = between(row.hub_angle, next->hub_angle, share);
    row.first_angle = between(row.first_angle, next->first_angle, share);
    row.last_angle = between(row.last_angle, next->last_angle, share);
    row.force = between(row.force, next->force, share);
    row.wall_place = between(row.wall_place, next->wall_place, share);
    return row;
}

vector scene_wall_shift(const parameters *p, const sample *row)
{
    const double place = isnan(row->wall_place) ? 0 : row->wall_place;
    return (vector){place * sin(p->wall.angle), -place * cos(p->wall.angle), 0};
}

void scene_exaggerate(vector *joints, int links, double factor)
{
    assert(links > 0 && factor >= 0);
    const vector along = vector_unit(vector_sum(joints[links], -1, joints[0]));
    const vector across = {-along.y, along.x, 0};
    for (int i = 0; i <= links && factor > 0; i++) {
        const double off = vector_dot(vector_sum(joints[i], -1, joints[0]), across);
        joints[i] = vector_sum(joints[i], (factor - 1) * off, across);
    }
}

static int pieces_of_span(int links)
{
    int spans = links > 1 ? links - 1 : 1, pieces = CURVE_PIECES / spans;
    if (pieces > 1) {
        return pieces;
    }
    return 1;
}

int scene_curve_length(int links)
{
    return (links > 1 ? links - 1 : 1) * pieces_of_span(links) + 1;
}

int scene_curve(const vector *joints, int links, vector *curve)
{
    assert(links > 0);
    int spans = links > 1 ? links - 1 : 1, pieces = pieces_of_span(links), count = 0;

    for (int span = 0; span < spans; span++) {
        // a parabola from a link's middle to the next one's, with the joint as its
        // control point
        vector bend = links > 1 ? joints[span + 1]
                                : vector_scaled(vector_add(joints[0], joints[1]), 0.5);

        // it starts at a joint of its own only where the arm starts, and ends at one
        // where it ends
        vector from = joints[span], to = joints[links];
        if (span > 0) {
            from = vector_scaled(vector_add(joints[span], bend), 0.5);
        }
        if (span + 1 < spans) {
            to = vector_scaled(vector_add(bend, joints[span + 2]), 0.5);
        }

        // neighbouring pieces share their point
        for (int i = span > 0; i <= pieces; i++) {
            double s = (double)i / pieces, r = 1 - s;
            vector place = vector_sum(vector_scaled(from, r * r), 2 * r * s, bend);
            curve[count++] = vector_sum(place, s * s, to);
        }
    }
    return count;
}

void scene_instants(const run_result *result, double *times, int count)
{
    assert(result->trace.row_count > 0 && count > 0);
    const trace *t = &result->trace;
    const summary *m = &result->summary;
    double end = t->rows[t->row_count - 1].time, path = 0, done = 0;

    // until the force is largest, or the end of a run without contact
    if (!isnan(m->first_contact_s)) {
        double delay = isnan(m->first_pulse_time_to_peak_s)
                           ? m->time_to_peak_s
                           : m->first_pulse_time_to_peak_s;
        end = fmin(end, m->first_contact_s + (isnan(delay) ? 0 : delay));
    }

    // the length of the tip's path, as an angle
    size_t last = trace_row_at(t, end);
    for (size_t i = 1; i <= last; i++) {
        path += fabs(t->rows[i].last_angle - t->rows[i - 1].last_angle);
    }

    // instants at even parts of it
    times[0] = t->rows[0].time;
    size_t row = 0;
    for (int k = 1; k < count; k++) {
        double wanted = path * k / (count - 1);
        while (row < last && done + 1e-12 < wanted) {
            row++;
            done += fabs(t->rows[row].last_angle - t->rows[row - 1].last_angle);
        }
        if (path > 0) {
            times[k] = t->rows[row].time;
        } else {
            times[k] = end * k / (count - 1);
        }
    }
    times[count - 1] = end;
}

// ==== solids

// Sizes in beam lengths.
#define HUB_RADIUS   0.062
#define HUB_TOP      0.046
#define PIN_RADIUS   0.014
#define SLAB_TOP     0.075
#define TRAIL_RADIUS 0.0032
#define ARROW_RADIUS 0.0060

const material beam_steel = {{0.00, 0.447, 0.698}, 0.7};
static const material hub_steel = {{0.31, 0.34, 0.39}, 0.8};
static const material motor_case = {{0.66, 0.68, 0.71}, 0.4};
static const material wall_stone = {{0.76, 0.73, 0.68}, 0.1};
static const material pin_steel = {{0.40, 0.40, 0.42}, 0.9};
static const material force_paint = {{0.835, 0.369, 0.0}, 0.3};
static const material trail_paint = {{0.902, 0.624, 0.0}, 0.1};

material scene_paler(const scene *sc, material m, double share)
{
    m.colour = colour_between(m.colour, sc->around->far, share);
    m.shine *= 1 - share;
    return m;
}

// The point at distance x along a direction [rad] in the plane, y across it, and z above.
static vector at_angle(double angle, double x, double y, double z)
{
    return (vector){x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle), z};
}

void scene_build_hub(scene *sc, double angle)
{
    const double l = sc->length, edge = 0.006 * l;

    // solids of revolution, from the floor up
    const vector up = {0, 0, 1};
    const lathe_ring motor[] = {{FLOOR_LEVEL * l, MOTOR_RADIUS * l * 1.25},
                                {FLOOR_LEVEL * l + 2 * edge, MOTOR_RADIUS * l * 1.25},
                                {FLOOR_LEVEL * l + 2 * edge, MOTOR_RADIUS * l},
                                {-0.062 * l - edge, MOTOR_RADIUS * l},
                                {-0.062 * l, MOTOR_RADIUS * l - edge},
                                {-0.062 * l, 0}};
    const lathe_ring hub[] = {{-0.054 * l, 0},
                              {-0.054 * l, HUB_RADIUS * l - edge},
                              {-0.054 * l + edge, HUB_RADIUS * l},
                              {HUB_TOP * l - edge, HUB_RADIUS * l},
                              {HUB_TOP * l, HUB_RADIUS * l - edge},
                              {HUB_TOP * l, 0.020 * l},
                              {(HUB_TOP + 0.012) * l, 0.018 * l},
                              {(HUB_TOP + 0.012) * l, 0}};

    mesh_lathe(&sc->mesh, (vector){0}, up, motor, 6, motor_case);
    mesh_lathe(&sc->mesh, (vector){0, 0, -0.066 * l}, up,
               (lathe_ring[]){{0, 0.03 * l}, {0.014 * l, 0.03 * l}}, 2, pin_steel);
    mesh_lathe(&sc->mesh, (vector){0}, up, hub, 8, hub_steel);

    // the jaws that hold the beam
    for (int side = -1; side <= 1; side += 2) {
        const box jaw = {.centre = at_angle(angle, 0.078 * l, side * 0.014 * l, 0),
                         .u = at_angle(angle, 0.030 * l, 0, 0),
                         .v = at_angle(angle, 0, 0.008 * l, 0),
                         .w = {0, 0, 0.036 * l}};
        mesh_box(&sc->mesh, &jaw, 0.02 * l, hub_steel);
    }
}

void scene_build_wall(scene *sc, const sample *row)
{
    const wall_parameters *w = &sc->scenario->parameters.wall;
    const double l = sc->length, floor_z = FLOOR_LEVEL * l;
    const vector shift = scene_wall_shift(&sc->scenario->parameters, row);

    if (w->kind == WALL_POINT) {
        double off = (PIN_RADIUS + BEAM_THICKNESS / 2) * l, r = PIN_RADIUS * l,
               top = PIN_TOP * l;
        const vector foot = vector_add(at_angle(w->angle, l, off, 0), shift);
        const lathe_ring rings[] = {{floor_z, 3.4 * r},
                                    {floor_z + 0.7 * r, 3.4 * r},
                                    {floor_z + r, 3.1 * r},
                                    {floor_z + r, r},
                                    {top - 0.3 * r, r},
                                    {top, 0.7 * r},
                                    {top, 0}};
        mesh_lathe(&sc->mesh, foot, (vector){0, 0, 1}, rings, 7, pin_steel);

    } else if (w->kind == WALL_PLANE) {
        double off = (SLAB_THICKNESS / 2 + BEAM_THICKNESS / 2) * l;
        double half = (SLAB_TO - SLAB_FROM) / 2 * l, rise = (SLAB_TOP * l - floor_z) / 2;
        const box slab = {.centre =
                              vector_add(at_angle(w->angle, (SLAB_FROM + SLAB_TO) / 2 * l,
                                                  off, floor_z + rise),
                                         shift),
                          .u = at_angle(w->angle, half, 0, 0),
                          .v = at_angle(w->angle, 0, SLAB_THICKNESS / 2 * l, 0),
                          .w = {0, 0, rise}};
        mesh_box(&sc->mesh, &slab, 0.03 * l, wall_stone);
    }
}

vector scene_contact(const scene *sc, const sample *row)
{
    const parameters *p = &sc->scenario->parameters;
    if (p->wall.kind == WALL_POINT) {
        return vector_add(at_angle(p->wall.angle, sc->length, 0, 0),
                          scene_wall_shift(p, row));
    }
    return sc->joints[sc->links];
}

bool scene_force_arrow(const scene *sc, const sample *row, vector *start, vector *end)
{
    double l = sc->length, length = row->force / sc->options.force * ARROW_LENGTH * l;
    const wall_parameters *w = &sc->scenario->parameters.wall;
    double across = w->kind == WALL_PLANE ? w->angle : row->last_angle;
    vector away = at_angle(across, 0, -1, 0);
    *start = vector_sum(scene_contact(sc, row), BEAM_THICKNESS / 2 * l, away);
    *end = vector_sum(*start, length, away);
    return row->contact > 0 && row->force > 0 && length > 0.01 * l;
}

sample scene_shape(scene *sc, double time)
{
    sample row =
        scene_joints(&sc->result->trace, &sc->scenario->parameters, time, sc->joints);
    scene_exaggerate(sc->joints, sc->links, sc->options.exaggerate);
    return row;
}

void scene_build_arm(scene *sc, mesh *into, double time)
{
    const double l = sc->length;
    vector start, end;
    sample row = scene_shape(sc, time);
    int count = scene_curve(sc->joints, sc->links, sc->curve);

    mesh_ribbon(into, sc->curve, count, BEAM_HEIGHT * l, BEAM_THICKNESS * l, beam_steel);

    // the wall's force; the ghosts of a film go without
    bool bare = into == &sc->ghost && sc->options.keyless;
    if (!bare && scene_force_arrow(sc, &row, &start, &end)) {
        vector along = vector_sum(end, -1, start);
        mesh_arrow(into, start, vector_unit(along), sqrt(vector_dot(along, along)),
                   ARROW_RADIUS * l, force_paint);
    }
}

void scene_build_trail(scene *sc, double from, double time)
{
    const trace *t = &sc->result->trace;
    const parameters *p = &sc->scenario->parameters;
    int count = 0;

    for (int i = 0; i < TRAIL_POINTS; i++) {
        double share = (double)i / (TRAIL_POINTS - 1);
        scene_joints(t, p, between(from, time, share), sc->joints);
        vector tip = sc->joints[sc->links];
        tip.z = BEAM_HEIGHT / 2 * sc->length;
        vector step = vector_sum(tip, -1, sc->trail[count > 0 ? count - 1 : 0]);

        // a tip at rest leaves one point, not a knot of them
        if (count == 0 || vector_dot(step, step) > 1e-6 * sc->length * sc->length) {
            sc->trail[count] = tip;
            sc->trail_of[count++] =
                scene_paler(sc, trail_paint, 0.85 * (1 - share) * (1 - share));
        }
    }

    if (count > 1) {
        mesh_tube(&sc->mesh, sc->trail, sc->trail_of, count, TRAIL_RADIUS * sc->length);
    }
}

// ==== camera, light and floor

enum {
    EXTENT_ROWS = 400, // of the trace, looked at for what must be seen
    EXTENT_POINTS = EXTENT_ROWS + 64,
};

// what the camera at the tip shows round the contact, in beam lengths
#define TIP_AROUND 0.04

// Points round everything that is ever to be seen. Returns their number.
static int extent(scene *sc, vector *points)
{
    const trace *t = &sc->result->trace;
    const parameters *p = &sc->scenario->parameters;
    const double l = sc->length, low = FLOOR_LEVEL * l, high = PIN_TOP * l;
    int count = 0;

    // the contact alone, or where the tip ends
    if (sc->options.camera.kind == CAMERA_TIP) {
        const sample last =
            scene_joints(t, p, t->rows[t->row_count - 1].time, sc->joints);
        vector tip = scene_contact(sc, &last);
        for (int i = 0; i < 8; i++) {
            double a = i & 1 ? TIP_AROUND * l : -TIP_AROUND * l;
            double b = i & 2 ? TIP_AROUND * l : -TIP_AROUND * l;
            points[count++] = (vector){tip.x + a, tip.y + b, i & 4 ? high : -high};
        }
        return count;
    }

    // the motor
    for (int i = 0; i < 8; i++) {
        vector rim =
            at_angle(i * M_PI / 4, 1.1 * MOTOR_RADIUS * l, 0, i % 2 ? low : high);
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
    vector points[EXTENT_POINTS], low = {HUGE_VAL, HUGE_VAL, 0},
                                  high = {-HUGE_VAL, -HUGE_VAL, 0};
    int count = extent(sc, points);

    // text stands below the picture
    camera_window window = {0.05, 0.05, 0.95, sc->options.plain ? 0.95 : 0.88};
    sc->camera = camera_fit(sc->options.camera, heading(sc), points, count,
                            sc->options.width, sc->options.height, window);
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
    const double reach = 0.62 * hypot(high.x - low.x, high.y - low.y) + 0.35 * sc->length;
    return scene_floor_init(sc, vector_scaled(vector_add(low, high), 0.5), reach, f);
}
