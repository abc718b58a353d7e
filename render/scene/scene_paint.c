// A scene: prepared for a run, painted at its instants with ghosts of earlier ones and
// with labels, and written to a file.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "render/page/picture_file.h"
#include "render/page/text.h"
#include "render/plot/trace_plot.h"
#include "render/scene/scene_parts.h"
#include "src/base/instant.h"
#include "src/base/whole_file.h"

enum {
    LEAST_PIXELS = 64,
    MOST_PIXELS = 4096,
};

#define FLASH_RADIUS 0.075 // [beam lengths]
#define FLASH_FADE   0.010 // the flash has faded to a third after that [s]
#define PALEST       0.80  // share of the ground in the palest of several arms
#define TITLE_SHARE  0.72  // of the picture's width, beside the key of instants
#define INSET_SHARE  0.30  // of the picture's width, for the inset
#define INSET_LARGE  0.38  // of it, where letters are large
#define INSET_MARGIN 0.02  // of the picture's width
#define INSET_LARGER 2.5   // times as large as the picture, at least

// Page, ground, lines, the distant past; strong and faint letters.
static const surroundings light_surroundings = {
    {1.00, 1.000, 1.000}, {0.953, 0.957, 0.965}, {0.816, 0.835, 0.859},
    {0.94, 0.945, 0.955}, {0.130, 0.140, 0.160}, {0.340, 0.360, 0.390},
};
static const surroundings dark_surroundings = {
    {0.07, 0.075, 0.085}, {0.12, 0.13, 0.145},  {0.23, 0.245, 0.27},
    {0.14, 0.15, 0.165},  {0.94, 0.945, 0.955}, {0.72, 0.74, 0.77},
};

// Whether there is something to draw, and a picture and a font to draw it with.
static status check_scene_options(const scene *sc, fault *f)
{
    const scene_options *o = &sc->options;
    FAULT_IF(o->width < LEAST_PIXELS || o->width > MOST_PIXELS ||
                 o->height < LEAST_PIXELS || o->height > MOST_PIXELS,
             f, STATUS_BAD_ARGUMENT,
             "a scene of %d x %d pixels, expected %d to %d along each edge", o->width,
             o->height, LEAST_PIXELS, MOST_PIXELS);
    FAULT_IF(sc->result->trace.row_count == 0, f, STATUS_BAD_ARGUMENT,
             "the run has no rows to draw");
    return text_check_font(f);
}

void scene_options_scale(scene_options *o, const trace *t)
{
    for (size_t i = 0; i < t->row_count; i++) {
        o->force = fmax(o->force, t->rows[i].force);
    }
    for (size_t i = 0; i < t->event_count; i++) {
        o->impulse = fmax(o->impulse, t->events[i].impulse);
    }
}

// The inset: a scene of its own, from near by.
static status create_inset(scene *sc, fault *f)
{
    scene_options o = sc->options;
    o.camera = (camera_view){.kind = CAMERA_TIP};
    double share = INSET_SHARE;
    if (labels_are_large(sc)) {
        share = INSET_LARGE;
    }
    o.width = (int)(share * o.width) / 2 * 2;
    o.height = (int)(0.72 * o.width) / 2 * 2;
    o.plain = true;
    o.inset = o.transparent = false;

    // larger than the picture where the contact is
    const sample first = scene_shape(sc, sc->result->trace.rows[0].time);
    o.least_scale =
        INSET_LARGER * labels_pixels(&sc->camera, scene_contact(sc, &first), 1);
    return scene_create(&sc->tip, sc->scenario, sc->result, &o, f);
}

// Makes what all pictures of the scene share.
static status prepare_scene(scene *sc, fault *f)
{
    TRY(check_scene_options(sc, f));

    // room for one shape
    sc->joints = g_new(vector, sc->links + 1);
    sc->curve = g_new(vector, scene_curve_length(sc->links));
    scene_options_scale(&sc->options, &sc->result->trace);
    if (!(sc->options.exaggerate > 0)) {
        sc->options.exaggerate = scene_bending_auto(sc->scenario, sc->result);
    }
    sc->context = text_context_create();

    // the viewpoint, and what paints from there
    scene_set_view(sc);
    TRY(scene_painter_create(&sc->painter, sc->options.renderer, sc->options.width,
                             sc->options.height, sc->options.samples, f));
    if (sc->options.inset) {
        TRY(create_inset(sc, f));
    }
    return STATUS_OK;
}

// The distance of the floor's grid lines: the largest of 1, 2 or 5 times a power of ten
// that is at most a tenth of a length.
static double grid_of(double length)
{
    const double power = pow(10, floor(log10(length / 10 * 1.0001)));
    const double share = length / 10 / power;
    if (share >= 5) {
        return 5 * power;
    }
    if (share >= 2) {
        return 2 * power;
    }
    return 1 * power;
}

status scene_create(scene **out, const scenario *s, const run_result *result,
                    const scene_options *options, fault *f)
{
    g_autoptr(scene) sc = g_new0(scene, 1);
    *out = NULL;
    sc->scenario = s;
    sc->result = result;
    sc->options = *options;
    if (options->theme == THEME_DARK) {
        sc->around = &dark_surroundings;
    } else {
        sc->around = &light_surroundings;
    }

    // what the options leave to us
    if (options->width == 0 && options->height == 0) {
        sc->options.width = 1280;
        sc->options.height = 720;
    }
    if (!(options->samples > 0)) {
        sc->options.samples = SAMPLES_FINE;
    }

    sc->links = s->parameters.arm.links;
    sc->length = s->parameters.arm.length;
    sc->grid = grid_of(sc->length);
    TRY(prepare_scene(sc, f));
    *out = g_steal_pointer(&sc);
    return STATUS_OK;
}

void scene_destroy(scene *sc)
{
    if (sc == NULL) {
        return;
    }
    scene_destroy(sc->tip);
    scene_painter_destroy(sc->painter);
    scene_floor_finish(&sc->floor);
    mesh_finish(&sc->mesh);
    mesh_finish(&sc->ghost);
    taken_finish(&sc->taken);
    g_clear_object(&sc->context);
    g_free(sc->joints);
    g_free(sc->curve);
    g_free(sc);
}

const char *scene_renderer_name(const scene *sc)
{
    return sc->painter->name;
}

// ---- the picture

// The flash of every impact shortly before `time`.
static void draw_flashes(scene *sc, cairo_t *cr, double time)
{
    const trace *t = &sc->result->trace;
    for (size_t i = 0; i < t->event_count && t->events[i].time <= time; i++) {
        const event *e = &t->events[i];
        double strength = exp(-(time - e->time) / FLASH_FADE);
        if (e->kind != EVENT_IMPACT || !(e->impulse > 0) || !(strength > 0.03)) {
            continue;
        }

        // its area grows with the impulse
        const double size = FLASH_RADIUS * sqrt(e->impulse / sc->options.impulse);
        const sample row =
            scene_joints(t, &sc->scenario->parameters, e->time, sc->joints);
        labels_flash(sc, cr, scene_contact(sc, &row), size * sc->length, strength);
    }
}

// The line of facts of a picture at an instant, as markup. Free with g_free.
static char *line_of_facts(const scene *sc, double time)
{
    const double larger = sc->options.exaggerate;
    char *facts = text_printf("<i>t</i> = %.1f\u2009ms \u00b7 grid %g\u2009m", 1e3 * time,
                              sc->grid);
    if (larger == 1) {
        return facts;
    }

    // what is not as it is has to be said
    g_autofree char *plain = facts;
    return text_printf("%s \u00b7 bending %g times as large", plain, larger);
}

// The texts: title and facts, the key of the instants, and the force at its arrow.
static void draw_texts(scene *sc, cairo_t *cr, const double *times, const colour *inks,
                       int count)
{
    const double time = times[count - 1];
    g_autofree char *facts = line_of_facts(sc, time);
    g_autofree char *title = scenario_title(sc->scenario);
    labels_caption(sc, cr, title, facts, TITLE_SHARE * sc->camera.width);
    if (count > 1 && !sc->options.keyless) {
        labels_instants(sc, cr, times, inks, count);
    }

    // the force, clear of all of them
    vector start, end;
    const sample row = scene_shape(sc, time);
    if (scene_force_arrow(sc, &row, &start, &end)) {
        labels_force(sc, cr, start, end, row.force);
    }
}

// Draws over the picture what is no solid: flashes of impacts, and texts.
static status draw_labels(scene *sc, const double *times, const colour *inks, int count,
                          cairo_surface_t *onto, fault *f)
{
    cairo_t *cr = cairo_create(onto);
    draw_flashes(sc, cr, times[count - 1]);
    if (!sc->options.plain) {
        draw_texts(sc, cr, times, inks, count);
    }
    return picture_end_drawing(cr, STATUS_OK, f);
}

// The ground on which all else is painted, with the shadow of what does not hover.
static status paint_background(scene *sc, cairo_surface_t *onto, fault *f)
{
    if (!sc->options.transparent) {
        return scene_floor_paint(sc, onto, f);
    }
    cairo_t *cr = cairo_create(onto);
    cairo_set_operator(cr, CAIRO_OPERATOR_CLEAR);
    cairo_paint(cr);
    return picture_end_drawing(cr, STATUS_OK, f);
}

// The contact from near by, framed, in the upper right corner.
static status paint_inset(scene *sc, const double *times, int count,
                          cairo_surface_t *onto, fault *f)
{
    scene *tip = sc->tip;
    int width = tip->options.width, height = tip->options.height;
    g_autoptr(cairo_surface_t) view =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    TRY(scene_paint(tip, times, count, view, f));

    // the view
    double margin = INSET_MARGIN * sc->options.width,
           left = sc->options.width - width - margin;
    cairo_t *cr = cairo_create(onto);
    cairo_set_source_surface(cr, view, left, margin);
    cairo_paint(cr);
    taken_add_box(&sc->taken, (figure_rect){left, margin, width, height});

    // how much larger it is than the picture, at the contact
    const sample row = scene_shape(sc, times[count - 1]);
    const vector at = scene_contact(sc, &row);
    const double larger =
        labels_pixels(&tip->camera, at, 1) / labels_pixels(&sc->camera, at, 1);
    if (!sc->options.plain) {
        labels_inset(sc, cr, left, margin + height, larger);
    }
    set_colour(cr, sc->around->faint);
    cairo_set_line_width(cr, fmax(1, labels_scale(sc)));
    cairo_rectangle(cr, left, margin, width, height);
    cairo_stroke(cr);
    return picture_end_drawing(cr, STATUS_OK, f);
}

// Paints the arm at an earlier instant, with an opacity of 0 to 1.
static status paint_ghost(scene *sc, double time, double opacity, cairo_surface_t *onto,
                          fault *f)
{
    const painting ghost = {.mesh = &sc->ghost,
                            .camera = &sc->camera,
                            .light = sc->light,
                            .opacity = opacity};
    sc->ghost.vertex_count = sc->ghost.corner_count = 0;
    scene_build_arm(sc, &sc->ghost, time);
    taken_add_mesh(&sc->taken, &sc->ghost, &sc->camera);
    return scene_painter_paint(sc->painter, &ghost, onto, f);
}

// Makes every pixel as grey as it is bright, as a print in black does.
static void take_colours_out(cairo_surface_t *onto)
{
    cairo_surface_flush(onto);
    unsigned char *data = cairo_image_surface_get_data(onto);
    const ptrdiff_t stride = cairo_image_surface_get_stride(onto);
    for (int y = 0; y < cairo_image_surface_get_height(onto); y++) {
        uint32_t *row = (uint32_t *)(void *)(data + y * stride);
        for (int x = 0; x < cairo_image_surface_get_width(onto); x++) {
            const uint32_t red = row[x] >> 16 & 255, green = row[x] >> 8 & 255;
            const uint32_t grey =
                (2126 * red + 7152 * green + 722 * (row[x] & 255)) / 10000;
            row[x] = (row[x] & 0xFF000000) | grey << 16 | grey << 8 | grey;
        }
    }
    cairo_surface_mark_dirty(onto);
}

// The arm at the last instant in full colour, at earlier ones as ghosts behind it.
status scene_paint(scene *sc, const double *times, int count, cairo_surface_t *onto,
                   fault *f)
{
    assert(count > 0 && count <= SCENE_INSTANTS);
    colour inks[SCENE_INSTANTS];
    const double now = times[count - 1];

    // what is there now, and its shadow; a bend that is enlarged turns the hub with it
    taken_begin(&sc->taken, &sc->camera);
    sc->mesh.vertex_count = sc->mesh.corner_count = 0;
    scene_build_arm(sc, &sc->mesh, now);
    const sample last = scene_shape(sc, now);
    const vector first_link = sc->joints[1];
    scene_build_hub(sc, last.hub_angle + atan2(first_link.y, first_link.x) -
                            last.first_angle);
    scene_build_wall(sc, &last);
    TRY(paint_background(sc, onto, f));

    // ghosts of earlier instants behind it
    for (int i = 0; i < count - 1; i++) {
        const double pale = PALEST * (count - 1 - i) / (count - 1);
        inks[i] = scene_paler(sc, scene_steel(sc), pale).colour;
        TRY(paint_ghost(sc, times[i], 1 - pale, onto, f));
    }
    inks[count - 1] = scene_steel(sc).colour;

    // the trail hovers and throws no shadow
    const painting full = {.mesh = &sc->mesh,
                           .camera = &sc->camera,
                           .light = sc->light,
                           .opacity = 1};
    scene_build_trail(sc, sc->result->trace.rows[0].time, now);
    TRY(scene_painter_paint(sc->painter, &full, onto, f));
    taken_add_mesh(&sc->taken, &sc->mesh, &sc->camera);
    if (sc->tip != NULL) {
        TRY(paint_inset(sc, times, count, onto, f));
    }
    TRY(draw_labels(sc, times, inks, count, onto, f));
    if (sc->options.theme == THEME_MONO) {
        take_colours_out(onto);
    }
    return STATUS_OK;
}

// ==== files

enum { PICTURE_DPI = 144 };

status scene_check_path(const char *path, fault *f)
{
    FAULT_IF(picture_format_of(path) != FORMAT_PNG || strchr(path, '.') == NULL, f,
             STATUS_BAD_ARGUMENT,
             "'%s' is no name for a scene: expected one that ends in .png", path);
    return whole_file_check(path, f);
}

// Whether all instants lie within the run.
static status check_instants(const scene_picture *p, fault *f)
{
    const trace *t = &p->result->trace;

    FAULT_IF(p->count < 1 || p->count > SCENE_INSTANTS, f, STATUS_BAD_ARGUMENT,
             "a scene of %d instants, expected 1 to %d", p->count, SCENE_INSTANTS);

    double end = 0;
    if (t->row_count > 0) {
        end = t->rows[t->row_count - 1].time;
    }
    for (int i = 0; i < p->count; i++) {
        FAULT_IF(!(p->times[i] >= 0 && !instant_after(p->times[i], end)), f,
                 STATUS_BAD_ARGUMENT,
                 "a scene at %g s, expected an instant of the run, 0 to %g s",
                 p->times[i], end);
    }
    return STATUS_OK;
}

// A picture of the run as a PNG file.
status scene_write(const scene_picture *p, const char *path, fault *f)
{
    g_autoptr(scene) sc = NULL;
    TRY(scene_check_path(path, f));
    TRY(check_instants(p, f));
    TRY(scene_create(&sc, p->scenario, p->result, &p->options, f));

    cairo_format_t format = CAIRO_FORMAT_RGB24;
    if (p->options.transparent) {
        format = CAIRO_FORMAT_ARGB32;
    }
    g_autoptr(cairo_surface_t) surface =
        cairo_image_surface_create(format, sc->options.width, sc->options.height);
    TRY(scene_paint(sc, p->times, p->count, surface, f));

    // with what it was made from
    whole_file file;
    g_autofree char *values = parameters_line(sc->scenario);
    g_autofree char *title = scenario_title(sc->scenario);
    const png_note notes[] = {{"Title", title},
                              {"Software", picture_software()},
                              {"Parameters", values},
                              {"Renderer", scene_renderer_name(sc)}};
    TRY(whole_file_open(&file, path, f));
    double dpi = PICTURE_DPI;
    if (p->options.dpi > 0) {
        dpi = p->options.dpi;
    }
    const status code = png_file_write(file.stream, surface, dpi, notes, 4, f);
    return whole_file_close(&file, code, f);
}
