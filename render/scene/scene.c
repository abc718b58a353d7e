#include "render/scene/scene.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/page/picture_file.h"
#include "render/page/png_file.h"
#include "render/page/text.h"
#include "render/plot/opened_run.h"
#include "render/scene/floor.h"
#include "render/scene/labels.h"
#include "src/base/instant.h"
#include "src/base/numbers.h"
#include "src/base/version.h"
#include "src/base/whole_file.h"

enum {
    TRAIL_POINTS = 240,
    EXTENT_ROWS = 400, // of the trace, looked at for what must be seen
    EXTENT_POINTS = EXTENT_ROWS + 64,
    LEAST_PIXELS = 64,
    MOST_PIXELS = 4096,
    PICTURE_DPI = 144,
};

// Sizes in beam lengths.
#define BEAM_HEIGHT    0.050
#define BEAM_THICKNESS 0.011
#define HUB_RADIUS     0.062
#define HUB_TOP        0.046
#define MOTOR_RADIUS   0.082
#define FLOOR_LEVEL    (-0.150)
#define PIN_RADIUS     0.014
#define PIN_TOP        0.062
#define SLAB_FROM      0.965 // of the flat wall, along the arm
#define SLAB_TO        1.10
#define SLAB_THICKNESS 0.030
#define SLAB_TOP       0.075
#define TRAIL_RADIUS   0.0032
#define ARROW_LENGTH   0.26 // of the largest force
#define ARROW_RADIUS   0.0060
#define FLASH_RADIUS   0.075
#define FLASH_FADE     0.010 // the flash has faded to a third after that [s]
#define PALEST         0.80  // share of the ground in the palest of several arms
#define TIP_AROUND     0.04  // what the camera at the tip shows round the contact
#define INSET_SHARE    0.30  // of the picture's width, for the inset
#define INSET_MARGIN   0.02  // of the picture's width

static const material beam_steel = {{0.00, 0.447, 0.698}, 0.7};
static const material hub_steel = {{0.31, 0.34, 0.39}, 0.8};
static const material motor_case = {{0.66, 0.68, 0.71}, 0.4};
static const material wall_stone = {{0.76, 0.73, 0.68}, 0.1};
static const material pin_steel = {{0.40, 0.40, 0.42}, 0.9};
static const material force_paint = {{0.835, 0.369, 0.0}, 0.3};
static const material trail_paint = {{0.902, 0.624, 0.0}, 0.1};

// Colours of what surrounds the arm.
typedef struct surroundings {
    colour page, ground, line; // beyond the floor, of it and of its grid
    colour far;                // what is long past tends to it
    colour strong, faint;      // of letters
} surroundings;

static const surroundings light_surroundings = {.page = {1, 1, 1},
                                                .ground = {0.953, 0.957, 0.965},
                                                .line = {0.816, 0.835, 0.859},
                                                .far = {0.94, 0.945, 0.955},
                                                .strong = {0.13, 0.14, 0.16},
                                                .faint = {0.34, 0.36, 0.39}};
static const surroundings dark_surroundings = {.page = {0.07, 0.075, 0.085},
                                               .ground = {0.12, 0.13, 0.145},
                                               .line = {0.23, 0.245, 0.27},
                                               .far = {0.14, 0.15, 0.165},
                                               .strong = {0.94, 0.945, 0.955},
                                               .faint = {0.72, 0.74, 0.77}};

struct scene {
    const scenario *scenario;
    const run_result *result;
    scene_options options;
    int links;
    double length;  // of the beam [m]
    double largest; // force [N]
    double impulse; // largest of an impact [N s]
    double grid;    // [m]
    camera camera;
    vector light;
    scene_floor floor;
    scene_painter *painter;
    PangoContext *context;
    const surroundings *around;
    struct scene *tip; // the inset's own scene, or NULL
    mesh mesh, ghost;
    vector *joints, *curve;
    vector trail[TRAIL_POINTS];
    material trail_of[TRAIL_POINTS];
};

// ---- solids

static double between(double a, double b, double share)
{
    return a + share * (b - a);
}

static material paler(const scene *sc, material m, double share)
{
    const colour *far = &sc->around->far;
    m.colour.red = between(m.colour.red, far->red, share);
    m.colour.green = between(m.colour.green, far->green, share);
    m.colour.blue = between(m.colour.blue, far->blue, share);
    m.shine *= 1 - share;
    return m;
}

static vector at_angle(double angle, double x, double y, double z)
{
    return (vector){x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle), z};
}

static void build_hub(scene *sc, double angle)
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

static void build_wall(scene *sc)
{
    const wall_parameters *w = &sc->scenario->parameters.wall;
    const double l = sc->length, floor_z = FLOOR_LEVEL * l;

    if (w->kind == WALL_POINT) {
        double off = (PIN_RADIUS + BEAM_THICKNESS / 2) * l, r = PIN_RADIUS * l, top = PIN_TOP * l;
        vector foot = at_angle(w->angle, l, off, 0);
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
        const box slab = {
            .centre = at_angle(w->angle, (SLAB_FROM + SLAB_TO) / 2 * l, off, floor_z + rise),
            .u = at_angle(w->angle, half, 0, 0),
            .v = at_angle(w->angle, 0, SLAB_THICKNESS / 2 * l, 0),
            .w = {0, 0, rise}};
        mesh_box(&sc->mesh, &slab, 0.03 * l, wall_stone);
    }
}

// Where the force acts: the contact point, on the beam's near side.
static vector contact_place(const scene *sc, const vector *joints)
{
    const wall_parameters *w = &sc->scenario->parameters.wall;
    return w->kind == WALL_POINT ? at_angle(w->angle, sc->length, 0, 0) : joints[sc->links];
}

// The wall's force on the beam, as an arrow from the contact point away from the wall.
static bool force_arrow(const scene *sc, const sample *row, vector *start, vector *end)
{
    double l = sc->length, length = row->force / sc->largest * ARROW_LENGTH * l;
    const wall_parameters *w = &sc->scenario->parameters.wall;
    double across = w->kind == WALL_PLANE ? w->angle : row->last_angle;
    vector away = at_angle(across, 0, -1, 0);
    *start = vector_sum(contact_place(sc, sc->joints), BEAM_THICKNESS / 2 * l, away);
    *end = vector_sum(*start, length, away);
    return row->contact > 0 && row->force > 0 && length > 0.01 * l;
}

// The joints at an instant, with the bending as it is to be drawn.
static sample shape_at(scene *sc, double time)
{
    sample row = scene_joints(&sc->result->trace, &sc->scenario->parameters, time, sc->joints);
    scene_exaggerate(sc->joints, sc->links, sc->options.exaggerate);
    return row;
}

static void build_arm(scene *sc, mesh *into, double time)
{
    const double l = sc->length;
    vector start, end;
    sample row = shape_at(sc, time);
    int count = scene_curve(sc->joints, sc->links, sc->curve);

    mesh_ribbon(into, sc->curve, count, BEAM_HEIGHT * l, BEAM_THICKNESS * l, beam_steel);

    // the wall's force; the ghosts of a film go without
    bool bare = into == &sc->ghost && sc->options.keyless;
    if (!bare && force_arrow(sc, &row, &start, &end)) {
        vector along = vector_sum(end, -1, start);
        mesh_arrow(into, start, vector_unit(along), sqrt(vector_dot(along, along)),
                   ARROW_RADIUS * l, force_paint);
    }
}

// The tip's path until `time`, paler the longer ago.
static void build_trail(scene *sc, double from, double time)
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
            sc->trail_of[count++] = paler(sc, trail_paint, 0.85 * (1 - share) * (1 - share));
        }
    }

    if (count > 1) {
        mesh_tube(&sc->mesh, sc->trail, sc->trail_of, count, TRAIL_RADIUS * sc->length);
    }
}

// ---- view

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
        vector tip = contact_place(sc, sc->joints);
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
        if (sc->largest > 0) {
            points[count++] = at_angle(p->wall.angle, l, -(ARROW_LENGTH + 0.05) * l, 0);
        }
    }
    return count;
}

// 1, 2 or 5 times a power of ten, next below a tenth of the length.
static double grid_of(double length)
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

static status set_view(scene *sc, fault *f)
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

    // a lamp to the left of who looks
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

static status check_options(const scene *sc, fault *f)
{
    const scene_options *o = &sc->options;
    if (o->width < LEAST_PIXELS || o->width > MOST_PIXELS || o->height < LEAST_PIXELS ||
        o->height > MOST_PIXELS) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "a scene of %d x %d pixels, expected %d to %d along each edge", o->width,
                         o->height, LEAST_PIXELS, MOST_PIXELS);
    }
    if (sc->result->trace.row_count == 0) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "the run has no rows to draw");
    }
    return text_check_font(f);
}

// The inset: a scene of its own, from near by.
static status open_inset(scene *sc, fault *f)
{
    scene_options o = sc->options;
    o.camera = (camera_view){.kind = CAMERA_TIP};
    o.width = (int)(INSET_SHARE * o.width) / 2 * 2;
    o.height = (int)(0.72 * o.width) / 2 * 2;
    o.plain = true;
    o.inset = o.transparent = false;
    return scene_create(&sc->tip, sc->scenario, sc->result, &o, f);
}

static status prepare(scene *sc, fault *f)
{
    const trace *t = &sc->result->trace;
    status code = check_options(sc, f);
    if (code != STATUS_OK) {
        return code;
    }

    // room for one shape
    sc->joints = malloc(((size_t)sc->links + 1) * sizeof *sc->joints);
    sc->curve = malloc((size_t)scene_curve_length(sc->links) * sizeof *sc->curve);
    if (sc->joints == NULL || sc->curve == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "no memory for a scene of %d links", sc->links);
    }

    // arrows and flashes are drawn relative to the largest force and impulse
    for (size_t i = 0; i < t->row_count; i++) {
        sc->largest = fmax(sc->largest, t->rows[i].force);
    }
    for (size_t i = 0; i < t->event_count; i++) {
        sc->impulse = fmax(sc->impulse, t->events[i].impulse);
    }

    sc->context = text_context_create();
    code = set_view(sc, f);
    if (code == STATUS_OK) {
        int samples = sc->options.samples > 0 ? sc->options.samples : SAMPLES_FINE;
        code = scene_painter_create(&sc->painter, sc->options.renderer, sc->options.width,
                                    sc->options.height, samples, f);
    }
    return code == STATUS_OK && sc->options.inset ? open_inset(sc, f) : code;
}

status scene_create(scene **out, const scenario *s, const run_result *result,
                    const scene_options *options, fault *f)
{
    assert(out != NULL && s != NULL && result != NULL);
    scene *sc = calloc(1, sizeof *sc);
    *out = NULL;
    if (sc == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "no memory for a scene");
    }

    sc->scenario = s;
    sc->result = result;
    sc->options = *options;
    sc->around = options->theme == THEME_DARK ? &dark_surroundings : &light_surroundings;

    if (options->width == 0 && options->height == 0) {
        sc->options.width = 1280;
        sc->options.height = 720;
    }

    sc->links = s->parameters.arm.links;
    sc->length = s->parameters.arm.length;
    sc->grid = grid_of(sc->length);

    status code = prepare(sc, f);
    if (code != STATUS_OK) {
        scene_destroy(sc);
        return code;
    }
    *out = sc;
    return STATUS_OK;
}

void scene_destroy(scene *sc)
{
    if (sc != NULL) {
        scene_destroy(sc->tip);
        scene_painter_destroy(sc->painter);
        scene_floor_finish(&sc->floor);
        mesh_finish(&sc->mesh);
        mesh_finish(&sc->ghost);
        g_clear_object(&sc->context);
        free(sc->joints);
        free(sc->curve);
        free(sc);
    }
}

const char *scene_renderer_name(const scene *sc)
{
    assert(sc != NULL);
    return scene_painter_name(sc->painter);
}

// ---- the picture

// The flash of every impact shortly before `time`.
static void draw_flashes(scene *sc, const labels *l, double time)
{
    const trace *t = &sc->result->trace;
    for (size_t i = 0; i < t->event_count && t->events[i].time <= time; i++) {
        const event *e = &t->events[i];
        double strength = exp(-(time - e->time) / FLASH_FADE);
        if (e->kind == EVENT_IMPACT && e->impulse > 0 && strength > 0.03) {
            double size = FLASH_RADIUS * sqrt(e->impulse / sc->impulse);
            scene_joints(t, &sc->scenario->parameters, e->time, sc->joints);
            labels_flash(l, contact_place(sc, sc->joints), size * sc->length, strength);
        }
    }
}

// Of letters and lines: 1 for a picture 720 pixels high.
static double letter_scale(const scene *sc)
{
    return sc->options.letters > 0 ? sc->options.letters
                                   : fmin(sc->camera.height / 720, sc->camera.width / 800);
}

static void draw_labels(scene *sc, const double *times, const colour *inks, int count,
                        cairo_surface_t *onto)
{
    labels l = {.cr = cairo_create(onto),
                .context = sc->context,
                .camera = &sc->camera,
                .strong = sc->around->strong,
                .faint = sc->around->faint,
                .scale = letter_scale(sc)};
    double time = times[count - 1];
    vector start, end;
    draw_flashes(sc, &l, time);

    // what a plain scene goes without
    if (!sc->options.plain) {
        char facts[160], bending[64] = "";
        sample row = shape_at(sc, time);

        if (force_arrow(sc, &row, &start, &end)) {
            bool dark = sc->options.theme == THEME_DARK;
            labels_force(&l, start, end, row.force,
                         dark ? (colour){1, 0.62, 0.30} : (colour){0.70, 0.28, 0});
        }

        // what is not as it is has to be said
        if (sc->options.exaggerate > 0 && sc->options.exaggerate != 1) {
            decimal_print(bending, sizeof bending, " \u00b7 bending drawn %g times as large",
                          sc->options.exaggerate);
        }
        decimal_print(facts, sizeof facts, "<i>t</i> = %.1f\u2009ms \u00b7 grid %g\u2009m%s",
                      1e3 * time, sc->grid, bending);
        labels_caption(&l, sc->scenario->title, facts);
        if (count > 1 && !sc->options.keyless) {
            labels_instants(&l, times, inks, count);
        }
    }
    cairo_destroy(l.cr);
}

// The ground on which all else is painted, with the shadow of what does not hover.
static void paint_ground(scene *sc, cairo_surface_t *onto)
{
    if (!sc->options.transparent) {
        scene_floor_paint(&sc->floor, &sc->mesh, onto);
        return;
    }
    cairo_t *cr = cairo_create(onto);
    cairo_set_operator(cr, CAIRO_OPERATOR_CLEAR);
    cairo_paint(cr);
    cairo_destroy(cr);
}

// The contact from near by, framed, in the upper right corner.
static status paint_inset(scene *sc, const double *times, int count, cairo_surface_t *onto,
                          fault *f)
{
    scene *tip = sc->tip;
    int width = tip->options.width, height = tip->options.height;
    cairo_surface_t *view = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    status code = scene_paint(tip, times, count, view, f);

    // its frame and how much larger it is than the picture, at the contact
    if (code == STATUS_OK) {
        double margin = INSET_MARGIN * sc->options.width, left = sc->options.width - width - margin;
        vector at = contact_place(sc, sc->joints);
        const double larger =
            labels_pixels(&tip->camera, at, 1) / labels_pixels(&sc->camera, at, 1);
        labels l = {.cr = cairo_create(onto),
                    .context = sc->context,
                    .camera = &sc->camera,
                    .strong = sc->around->strong,
                    .faint = sc->around->faint,
                    .scale = letter_scale(sc)};
        cairo_set_source_surface(l.cr, view, left, margin);
        cairo_paint(l.cr);
        set_colour(l.cr, sc->around->faint);
        cairo_set_line_width(l.cr, fmax(1, l.scale));
        cairo_rectangle(l.cr, left, margin, width, height);
        cairo_stroke(l.cr);
        if (!sc->options.plain) {
            labels_inset(&l, left, margin + height, larger);
        }
        cairo_destroy(l.cr);
    }
    cairo_surface_destroy(view);
    return code;
}

status scene_paint(scene *sc, const double *times, int count, cairo_surface_t *onto, fault *f)
{
    assert(sc != NULL && times != NULL && count > 0 && onto != NULL);
    colour inks[SCENE_INSTANTS];
    status code = STATUS_OK;
    double now = times[count - 1];
    painting full = {.mesh = &sc->mesh, .camera = &sc->camera, .light = sc->light, .opacity = 1};

    // what is there now, and its shadow
    mesh_clear(&sc->mesh);
    build_arm(sc, &sc->mesh, now);
    sample last = scene_joints(&sc->result->trace, &sc->scenario->parameters, now, sc->joints);
    build_hub(sc, last.hub_angle);
    build_wall(sc);
    paint_ground(sc, onto);

    // ghosts of earlier instants behind it
    for (int i = 0; i < count && code == STATUS_OK; i++) {
        double pale = count > 1 ? PALEST * (count - 1 - i) / (count - 1) : 0;
        inks[i] = paler(sc, beam_steel, pale).colour;
        if (i < count - 1) {
            painting ghost = full;
            ghost.mesh = &sc->ghost;
            ghost.opacity = 1 - pale;
            mesh_clear(&sc->ghost);
            build_arm(sc, &sc->ghost, times[i]);
            code = scene_painter_paint(sc->painter, &ghost, onto, f);
        }
    }

    // the trail hovers and throws no shadow
    build_trail(sc, sc->result->trace.rows[0].time, now);
    if (code == STATUS_OK) {
        code = scene_painter_paint(sc->painter, &full, onto, f);
    }
    if (code == STATUS_OK) {
        draw_labels(sc, times, inks, count, onto);
    }
    return code == STATUS_OK && sc->tip != NULL ? paint_inset(sc, times, count, onto, f) : code;
}

// ---- files

status scene_check_path(const char *path, fault *f)
{
    assert(path != NULL);
    if (picture_format_of(path) != FORMAT_PNG || strchr(path, '.') == NULL) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "'%s' is no name for a scene: expected one that ends in .png", path);
    }
    return whole_file_check(path, f);
}

static status check_instants(const run_result *result, const double *times, int count, fault *f)
{
    const trace *t = &result->trace;

    if (count < 1 || count > SCENE_INSTANTS) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "a scene of %d instants, expected 1 to %d", count,
                         SCENE_INSTANTS);
    }

    for (int i = 0; i < count; i++) {
        double end = t->row_count > 0 ? t->rows[t->row_count - 1].time : 0;
        if (!(times[i] >= 0 && !instant_after(times[i], end))) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "a scene at %g s, expected an instant of the run, 0 to %g s", times[i],
                             end);
        }
    }
    return STATUS_OK;
}

static status write_surface(const scene *sc, cairo_surface_t *surface, const char *path, fault *f)
{
    whole_file file;
    char software[64], *values = parameters_line(sc->scenario);
    snprintf(software, sizeof software, "impactlab %s", lab_version());
    const png_note notes[] = {{"Title", sc->scenario->title},
                              {"Software", software},
                              {"Parameters", values},
                              {"Renderer", scene_renderer_name(sc)}};

    status code = whole_file_open(&file, path, f);
    if (code == STATUS_OK) {
        code = png_file_write(file.stream, surface, PICTURE_DPI, notes, 4, f);
        code = whole_file_close(&file, code, f);
    }
    g_free(values);
    return code;
}

status scene_write(const scenario *s, const run_result *result, const scene_options *options,
                   const double *times, int count, const char *path, fault *f)
{
    assert(s != NULL && result != NULL && times != NULL && path != NULL);
    scene *sc;

    status code = scene_check_path(path, f);
    if (code == STATUS_OK) {
        code = check_instants(result, times, count, f);
    }
    if (code == STATUS_OK) {
        code = scene_create(&sc, s, result, options, f);
    }
    if (code != STATUS_OK) {
        return code;
    }

    cairo_surface_t *surface =
        cairo_image_surface_create(options->transparent ? CAIRO_FORMAT_ARGB32 : CAIRO_FORMAT_RGB24,
                                   sc->options.width, sc->options.height);
    code = scene_paint(sc, times, count, surface, f);
    if (code == STATUS_OK) {
        code = write_surface(sc, surface, path, f);
    }
    cairo_surface_destroy(surface);
    scene_destroy(sc);
    return code;
}
