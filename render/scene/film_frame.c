// The frames of a film: arms in space, and their traces with the present as a line.
#include "render/scene/film.h"

#include <assert.h>
#include <math.h>

#include "render/page/picture_file.h"
#include "render/page/text.h"
#include "render/plot/trace_plot.h"
#include "render/scene/scene_parts.h"

#define TRACE_SHARE   0.36 // of the picture's width, for the traces next to one arm
#define STRIP_SHARE   0.30 // of its height, for those below several
#define TRACE_LETTERS 2.5  // scale of the traces for a picture 720 pixels high
#define GHOST_TIME    0.02 // of the run between one ghost and the next [s]
#define VEIL          0.82 // how far the future of the traces is faded out
#define GAP           2    // between views [pixels]

// ---- what is painted once

static colour page_of(const film_painter *p)
{
    return palette_of(p->options.view.theme)->page;
}

// Of letters: 1 for a film of 1280 x 720.
static double film_scale(const film_painter *p)
{
    return fmin(p->options.height / 720.0, p->options.width / 1280.0);
}

// One arm next to its traces; several arms in two columns above theirs.
static void place_views(film_painter *p)
{
    int width = p->options.width, height = p->options.height;
    if (p->run_count == 1) {
        int scene_width = (int)(width * (1 - TRACE_SHARE));
        p->views[0] = (pixel_box){0, 0, scene_width, height};
        p->strip = (pixel_box){scene_width, 0, width - scene_width, height};
        return;
    }

    int rows = (p->run_count + 1) / 2, strip = (int)(height * STRIP_SHARE);
    int view_width = (width - GAP) / 2,
        view_height = (height - strip - (rows - 1) * GAP) / rows;
    for (int i = 0; i < p->run_count; i++) {
        p->views[i] = (pixel_box){i % 2 * (view_width + GAP), i / 2 * (view_height + GAP),
                                  view_width, view_height};
    }
    p->strip = (pixel_box){0, height - strip, width, strip};
}

// The traces: force, angles and velocities of one run, the forces of several.
static owned_figure *describe_traces(const film_painter *p)
{
    static const trace_panel several = {.signals = {"force"}, .with_zero = true};
    trace_panel one[] = {usual_panels[0], usual_panels[1], usual_panels[2]};
    trace_run runs[FILM_RUNS];
    one[0].inset = false;

    for (int i = 0; i < p->run_count; i++) {
        runs[i] = (trace_run){p->runs[i].scenario, p->runs[i].result, p->runs[i].name,
                              .rank = i + 1};
    }
    if (p->run_count == 1) {
        runs[0].rank = 0;
        return trace_figure_create(NULL, one, (int)G_N_ELEMENTS(one), runs, 1);
    }
    return trace_figure_create(NULL, &several, 1, runs, p->run_count);
}

// Paints all of the traces once; frames veil what has not happened yet.
static status paint_traces(film_painter *p, fault *f)
{
    owned_figure *drawn = describe_traces(p);
    figure *t = &drawn->figure;

    // its size: what the views leave of the picture
    const pixel_box *strip = &p->strip;
    p->trace_scale = TRACE_LETTERS * film_scale(p);

    // the views have the titles
    t->title = t->caption = NULL;
    t->theme = p->options.view.theme;
    t->x.low = p->clock.start;
    t->x.high = p->clock.end;
    t->width = strip->width / p->trace_scale * 25.4 / 72;
    t->height = strip->height / p->trace_scale * 25.4 / 72;

    p->traces =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, strip->width, strip->height);
    cairo_t *cr = cairo_create(p->traces);
    set_colour(cr, page_of(p));
    cairo_paint(cr);
    cairo_scale(cr, p->trace_scale, p->trace_scale);
    status code = picture_end_drawing(cr, figure_paint(cr, t, &p->report, f), f);
    owned_figure_destroy(drawn);
    return code;
}

// A scene for each run, as large as its view.
static status create_scenes(film_painter *p, fault *f)
{
    for (int i = 0; i < p->run_count; i++) {
        scene_options view = p->options.view;
        view.width = p->views[i].width;
        view.height = p->views[i].height;
        view.keyless = true;
        view.transparent = false;
        if (p->run_count > 1) {
            view.rank = i + 1;
        }

        // what moves needs fewer samples than what stands still
        if (!(view.samples > 0)) {
            view.samples = SAMPLES_QUICK;
        }

        // left to choose, the lab's own painter: of few samples it takes half of OpenGL's
        // time
        if (view.renderer == RENDER_AUTO) {
            view.renderer = RENDER_CAIRO;
        }

        // small views have the letters of the whole
        if (p->run_count > 1) {
            view.letters = film_scale(p);
        } else {
            view.letters = 0;
        }
        TRY(scene_create(&p->scenes[i], p->runs[i].scenario, p->runs[i].result, &view,
                         f));
        p->pictures[i] =
            cairo_image_surface_create(CAIRO_FORMAT_RGB24, view.width, view.height);
    }
    return STATUS_OK;
}

// Paints what does not change, and prepares a scene for each run.
status film_painter_create(film_painter **out, const film_run *runs, int run_count,
                           const film_options *options, fault *f)
{
    assert(run_count >= 1 && run_count <= FILM_RUNS);
    assert(options->width > 0 && options->slow >= 1);
    *out = NULL;
    g_autoptr(film_painter) p = g_new0(film_painter, 1);
    p->runs = runs;
    p->run_count = run_count;
    p->options = *options;
    p->context = text_context_create();

    // all arms share the clock, the scale of forces, and how much bending is enlarged
    const run_result *results[FILM_RUNS];
    double bending = HUGE_VAL;
    for (int i = 0; i < run_count; i++) {
        results[i] = runs[i].result;
        scene_options_scale(&p->options.view, &results[i]->trace);
        bending = fmin(bending, scene_bending_auto(runs[i].scenario, results[i]));
    }
    if (!(p->options.view.exaggerate > 0)) {
        p->options.view.exaggerate = bending;
    }
    p->clock = film_clock_of(results, run_count, options->seconds, options->slow);

    place_views(p);
    TRY(paint_traces(p, f));
    TRY(create_scenes(p, f));
    *out = g_steal_pointer(&p);
    return STATUS_OK;
}

void film_painter_destroy(film_painter *p)
{
    if (p == NULL) {
        return;
    }
    for (int i = 0; i < FILM_RUNS; i++) {
        scene_destroy(p->scenes[i]);
        cairo_surface_destroy(p->pictures[i]);
    }
    cairo_surface_destroy(p->traces);
    g_clear_object(&p->context);
    g_free(p);
}

// ---- what lies round the arms

// Lets the floor of a single view run out into the page of the traces.
static void soften_seam(const film_painter *p, cairo_t *cr)
{
    double end = p->views[0].width, width = 0.06 * end, from = end - width;
    cairo_pattern_t *fade = cairo_pattern_create_linear(from, 0, end, 0);
    const colour page = page_of(p);
    cairo_pattern_add_color_stop_rgba(fade, 0, page.red, page.green, page.blue, 0);
    cairo_pattern_add_color_stop_rgba(fade, 1, page.red, page.green, page.blue, 1);
    cairo_set_source(cr, fade);
    cairo_rectangle(cr, from, 0, width, p->options.height);
    cairo_fill(cr);
    cairo_pattern_destroy(fade);
}

// The page, and lines between several views.
static void draw_gaps(const film_painter *p, cairo_t *cr)
{
    const pixel_box *first = &p->views[0];
    set_colour(cr, page_of(p));
    cairo_paint(cr);

    set_colour(cr, palette_of(p->options.view.theme)->grid);
    if (p->run_count > 1) {
        cairo_rectangle(cr, first->width, 0, GAP, p->strip.y);
    }
    if (p->run_count > 2) {
        cairo_rectangle(cr, 0, first->height, p->options.width, GAP);
    }
    cairo_fill(cr);
}

// The traces with the present as a line, and what comes after it under a veil.
static void draw_traces(const film_painter *p, cairo_t *cr, double time)
{
    // all of it
    const figure_report *r = &p->report;
    const colour page = page_of(p);
    const pixel_box *strip = &p->strip;
    cairo_set_source_surface(cr, p->traces, strip->x, strip->y);
    cairo_paint(cr);

    // the present as a line over each panel
    cairo_save(cr);
    cairo_translate(cr, strip->x, strip->y);
    cairo_scale(cr, p->trace_scale, p->trace_scale);
    for (int i = 0; i < r->panel_count; i++) {
        const figure_rect panel = r->panels[i];
        const double share = (time - p->clock.start) / (p->clock.end - p->clock.start);
        const double x = panel.x + panel.width * share;
        cairo_rectangle(cr, x, panel.y, panel.x + panel.width - x, panel.height);
        cairo_set_source_rgba(cr, page.red, page.green, page.blue, VEIL);
        cairo_fill(cr);

        cairo_move_to(cr, x, panel.y);
        cairo_line_to(cr, x, panel.y + panel.height);
        cairo_set_line_width(cr, 1.1);
        set_colour(cr, palette_of(p->options.view.theme)->text);
        cairo_stroke(cr);
    }
    cairo_restore(cr);

    // keys are of the past and the future
    for (int i = 0; i < r->panel_count; i++) {
        figure_rect key = r->legends[i];
        cairo_rectangle(cr, strip->x + key.x * p->trace_scale,
                        strip->y + key.y * p->trace_scale, key.width * p->trace_scale,
                        key.height * p->trace_scale);
    }

    cairo_set_source_surface(cr, p->traces, strip->x, strip->y);
    cairo_fill(cr);
}

// "8.0 times slower than real": the number is the one that is larger than one. Free with
// g_free.
static char *describe_speed(double speed)
{
    const double slower = 1 / speed;
    if (!(speed < 1)) {
        return text_printf("%.1f times faster than real", speed);
    }
    if (slower < 9.95) {
        return text_printf("%.1f times slower than real", slower);
    }
    return text_printf("%.0f times slower than real", slower);
}

// Says how much slower or faster than real the film runs just now.
static void draw_speed(const film_painter *p, cairo_t *cr, double speed)
{
    const double scale = film_scale(p);
    g_autofree char *text = describe_speed(speed);
    const text_block t = {.markup = text, .size = SCENE_LETTERS * scale};

    // with several arms there is a free corner next to the axis of the traces
    double y = 20 * scale;
    anchor from = {0, 0};
    if (p->run_count > 1) {
        y = p->options.height - 6 * scale;
        from = (anchor){0, 1};
    }
    text_put(cr, p->context, &t, 22 * scale, y, from,
             palette_of(p->options.view.theme)->faint_text);
}

// ---- frames

// The arms at an instant of the run, with the traces until `present`.
static status paint_frame(film_painter *p, double time, double present, double speed,
                          cairo_surface_t *onto, fault *f)
{
    double times[SCENE_INSTANTS];

    // earlier arms, and the one of now
    int count = 0;
    for (int i = p->options.ghosts; i >= 0; i--) {
        const double earlier = time - i * GHOST_TIME;
        if (i == 0 || earlier >= p->clock.start) {
            times[count++] = earlier;
        }
    }

    cairo_t *cr = cairo_create(onto);
    draw_gaps(p, cr);
    status code = STATUS_OK;
    for (int i = 0; i < p->run_count && code == STATUS_OK; i++) {
        code = scene_paint(p->scenes[i], times, count, p->pictures[i], f);
        cairo_set_source_surface(cr, p->pictures[i], p->views[i].x, p->views[i].y);
        cairo_paint(cr);
    }

    // what lies round and over them
    if (code == STATUS_OK) {
        if (p->run_count == 1) {
            soften_seam(p, cr);
        }
        draw_traces(p, cr, present);
        draw_speed(p, cr, speed);
    }
    return picture_end_drawing(cr, code, f);
}

status film_painter_frame(film_painter *p, double film_time, cairo_surface_t *onto,
                          fault *f)
{
    double speed;
    const double time = film_clock_time(&p->clock, film_time, &speed);
    return paint_frame(p, time, time, speed, onto, f);
}

status film_painter_palette(film_painter *p, cairo_surface_t *onto, fault *f)
{
    const film_clock *c = &p->clock;
    double time = c->end;
    if (c->impact_count > 0) {
        time = fmin(c->end, c->impacts[0] + 0.008);
    }
    return paint_frame(p, time, c->end, 1, onto, f);
}
