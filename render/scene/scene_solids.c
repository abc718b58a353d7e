// The solids of a scene: the motor with the hub, the wall, the arm, the force on it, and
// the tip's path.
#include <assert.h>
#include <math.h>

#include "render/plot/run_style.h"
#include "render/scene/scene_parts.h"

// Sizes in beam lengths.
#define HUB_RADIUS   0.062
#define HUB_TOP      0.046
#define PIN_RADIUS   0.014
#define SLAB_TOP     0.075
#define TRAIL_RADIUS 0.0032
#define TRAIL_SHORT  0.016 // of the tip
#define ARROW_RADIUS 0.023 // of the longest arrow

static const material beam_steel = {{0.00, 0.447, 0.698}, 0.7};
static const material hub_steel = {{0.31, 0.34, 0.39}, 0.8};
static const material motor_case = {{0.66, 0.68, 0.71}, 0.4};
static const material wall_stone = {{0.76, 0.73, 0.68}, 0.1};
static const material pin_steel = {{0.40, 0.40, 0.42}, 0.9};
static const material force_paint = {{0.835, 0.369, 0.0}, 0.3};
static const material trail_paint = {{0.902, 0.624, 0.0}, 0.1};

// Of a run among others in the run's colour.
material scene_steel(const scene *sc)
{
    material steel = beam_steel;
    if (sc->options.rank > 0) {
        steel.colour = run_colour(sc->options.theme, sc->options.rank);
    }
    return steel;
}

// The arrow's: where arms have colours, none of them.
static material arrow_paint(const scene *sc)
{
    material paint = force_paint;
    if (sc->options.rank > 0) {
        paint.colour = sc->around->strong;
    }
    return paint;
}

// A material as it looks in the past: nearer to the ground's colour, and duller.
material scene_paler(const scene *sc, material m, double share)
{
    m.colour = colour_between(m.colour, sc->around->far, share);
    m.shine *= 1 - share;
    return m;
}

vector scene_at_angle(double angle, double x, double y, double z)
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
        const box jaw = {.centre = scene_at_angle(angle, 0.078 * l, side * 0.014 * l, 0),
                         .u = scene_at_angle(angle, 0.030 * l, 0, 0),
                         .v = scene_at_angle(angle, 0, 0.008 * l, 0),
                         .w = {0, 0, 0.036 * l}};
        mesh_box(&sc->mesh, &jaw, 0.02 * l, hub_steel);
    }
}

// A pin on a foot at a point, or a slab behind the arm.
void scene_build_wall(scene *sc, const sample *row)
{
    const wall_parameters *w = &sc->scenario->parameters.wall;
    const double l = sc->length, floor_z = FLOOR_LEVEL * l;
    const vector shift = scene_wall_shift(&sc->scenario->parameters, row);

    if (w->kind == WALL_POINT) {
        double off = (PIN_RADIUS + BEAM_THICKNESS / 2) * l, r = PIN_RADIUS * l,
               top = PIN_TOP * l;
        const vector foot = vector_add(scene_at_angle(w->angle, l, off, 0), shift);
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
                              vector_add(scene_at_angle(w->angle,
                                                        (SLAB_FROM + SLAB_TO) / 2 * l,
                                                        off, floor_z + rise),
                                         shift),
                          .u = scene_at_angle(w->angle, half, 0, 0),
                          .v = scene_at_angle(w->angle, 0, SLAB_THICKNESS / 2 * l, 0),
                          .w = {0, 0, rise}};
        mesh_box(&sc->mesh, &slab, 0.03 * l, wall_stone);
    }
}

vector scene_contact(const scene *sc, const sample *row)
{
    const parameters *p = &sc->scenario->parameters;
    if (p->wall.kind == WALL_POINT) {
        return vector_add(scene_at_angle(p->wall.angle, sc->length, 0, 0),
                          scene_wall_shift(p, row));
    }
    return sc->joints[sc->links];
}

// The longest arrow [m]: near by a short one, so that its point is in the picture.
double scene_longest_arrow(const scene *sc)
{
    if (sc->options.camera.kind == CAMERA_TIP) {
        return ARROW_NEAR_BY * sc->length;
    }
    return ARROW_LENGTH * sc->length;
}

// The arrow of the force that the wall exerts; false if there is none to be seen.
bool scene_force_arrow(const scene *sc, const sample *row, vector *start, vector *end)
{
    const double l = sc->length,
                 share = sc->options.force > 0 ? row->force / sc->options.force : 0;
    const double length = share * scene_longest_arrow(sc);
    const wall_parameters *w = &sc->scenario->parameters.wall;

    // across a flat wall, or across the last link at a point
    double across = row->last_angle;
    if (w->kind == WALL_PLANE) {
        across = w->angle;
    }
    vector away = scene_at_angle(across, 0, -1, 0);
    *start = vector_sum(scene_contact(sc, row), BEAM_THICKNESS / 2 * l, away);
    *end = vector_sum(*start, length, away);
    return row->contact > 0 && row->force > 0 && share > 0.04;
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

    mesh_ribbon(into, sc->curve, count, BEAM_HEIGHT * l, BEAM_THICKNESS * l,
                scene_steel(sc));

    // the wall's force; the ghosts of a film go without
    bool bare = into == &sc->ghost && sc->options.keyless;
    if (!bare && scene_force_arrow(sc, &row, &start, &end)) {
        vector along = vector_sum(end, -1, start);
        mesh_arrow(into, start, vector_unit(along), sqrt(vector_dot(along, along)),
                   ARROW_RADIUS * scene_longest_arrow(sc), arrow_paint(sc));
    }
}

// The way of the tip as a tube, paler towards its beginning.
void scene_build_trail(scene *sc, double from, double time)
{
    const trace *t = &sc->result->trace;
    const parameters *p = &sc->scenario->parameters;
    int count = 0;

    // the tip's place at the end, where its path stops short and leaves the contact bare
    scene_joints(t, p, time, sc->joints);
    const vector now = sc->joints[sc->links];

    for (int i = 0; i < TRAIL_POINTS; i++) {
        double share = (double)i / (TRAIL_POINTS - 1);
        scene_joints(t, p, from + share * (time - from), sc->joints);
        vector tip = sc->joints[sc->links];
        const vector left = vector_sum(now, -1, tip);
        if (vector_dot(left, left) < pow(TRAIL_SHORT * sc->length, 2)) {
            continue;
        }
        tip.z = BEAM_HEIGHT / 2 * sc->length;

        // a tip at rest leaves one point, not a knot of them
        if (count > 0) {
            const vector step = vector_sum(tip, -1, sc->trail[count - 1]);
            if (vector_dot(step, step) <= 1e-6 * sc->length * sc->length) {
                continue;
            }
        }
        sc->trail[count] = tip;
        sc->trail_of[count] =
            scene_paler(sc, trail_paint, 0.85 * (1 - share) * (1 - share));
        count++;
    }

    if (count > 1) {
        mesh_tube(&sc->mesh, sc->trail, sc->trail_of, count,
                  TRAIL_RADIUS *
                      sqrt(scene_longest_arrow(sc) / ARROW_LENGTH * sc->length));
    }
}
