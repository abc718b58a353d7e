#include "render/scene/film.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "render/page/text.h"
#include "render/plot/opened_run.h"
#include "render/plot/trace_plot.h"
#include "render/scene/film_file.h"
#include "render/scene/labels.h"
#include "src/base/numbers.h"
#include "src/base/version.h"

enum { CLOCK_CELLS = 4000 };

#define TRACE_SHARE   0.36 // of the picture's width, for the traces
#define TRACE_LETTERS 2.5  // scale of the traces for a picture 720 pixels high
#define GHOST_TIME    0.02 // of the run between one ghost and the next [s]
#define VEIL          0.82 // how far the future of the traces is faded out

// A film in the making.
typedef struct film {
    const scenario *scenario;
    const run_result *result;
    film_options options;
    film_clock clock;
    scene *scene;
    int scene_width;
    PangoContext *context;
    cairo_surface_t *view;   // of the scene
    cairo_surface_t *traces; // drawn once
    cairo_surface_t *frame;
    figure_report *report; // where the traces' panels are
    double trace_scale;    // pixels per point of the traces
} film;

// ---- the clock

film_clock film_clock_round(double start, double end, double instant, double slow)
{
    assert(end >= start && isfinite(instant));
    const double span = end - start;
    return (film_clock){.start = start,
                        .end = end,
                        .slow = slow,
                        .slow_from = instant - 0.01 * span,
                        .slow_to = instant + 0.04 * span,
                        .taper = 0.03 * span};
}

film_clock film_clock_of(const run_result *result, double seconds, double slow)
{
    assert(result != NULL && result->trace.row_count > 0 && seconds > 0);
    const trace *t = &result->trace;
    const double contact = result->summary.first_contact_s;
    film_clock c = {.start = t->rows[0].time, .end = t->rows[t->row_count - 1].time, .slow = 1};

    // slow from shortly before the first contact
    if (!isnan(contact)) {
        c = film_clock_round(c.start, c.end, contact, slow);
    }
    c.seconds = seconds;
    return c;
}

double film_clock_slowness(const film_clock *c, double time)
{
    assert(c != NULL);
    double outside = fmax(fmax(c->slow_from - time, time - c->slow_to), 0);
    if (c->slow <= 1 || outside >= c->taper) {
        return 1;
    }
    return 1 + (c->slow - 1) * 0.5 * (1 + cos(M_PI * outside / c->taper));
}

double film_clock_time(const film_clock *c, double film_time, double *speed)
{
    assert(c != NULL && c->seconds > 0 && speed != NULL);
    double span = c->end - c->start, cell = span / CLOCK_CELLS, total = 0, passed = 0;
    for (int i = 0; i < CLOCK_CELLS; i++) {
        total += film_clock_slowness(c, c->start + (i + 0.5) * cell);
    }

    // the cell in which the share of the film's time is passed
    double wanted = fmin(1, fmax(0, film_time / c->seconds)) * total;
    for (int i = 0; i < CLOCK_CELLS; i++) {
        double here = film_clock_slowness(c, c->start + (i + 0.5) * cell);
        if (passed + here >= wanted) {
            *speed = total * cell / c->seconds / here;
            return c->start + (i + (wanted - passed) / here) * cell;
        }
        passed += here;
    }

    // rounding passed the last cell
    *speed = total * cell / c->seconds / film_clock_slowness(c, c->end);
    return c->end;
}

// ---- the traces

static colour page_of(const film *m)
{
    return palette_of(m->options.view.theme)->page;
}

// Paints all of the traces once; frames veil what has not happened yet.
static status paint_traces(film *m, fault *f)
{
    static const trace_panel panels[] = {
        {.signals = {"force"}, .with_zero = true, .impulses = true, .weight = 1.2},
        {.label = "Angle", .signals = {"hub_angle", "first_angle", "last_angle"}, .wall = true},
        {.label = "Angular velocity",
         .signals = {"hub_velocity", "first_velocity", "last_velocity"}},
    };

    // a figure of the one run
    const trace_run run = {m->scenario, m->result, NULL};
    trace_figure t;
    status code = trace_figure_init(&t, NULL, panels, (int)G_N_ELEMENTS(panels), &run, 1, f);
    if (code != STATUS_OK) {
        return code;
    }

    // its size: what the scene leaves of the picture
    int width = m->options.width - m->scene_width, height = m->options.height;
    m->trace_scale = TRACE_LETTERS * fmin(height / 720.0, m->options.width / 1280.0);

    // the scene has the title
    t.figure.title = t.figure.caption = NULL;
    t.figure.theme = m->options.view.theme;
    t.figure.x.low = m->clock.start;
    t.figure.x.high = m->clock.end;
    t.figure.width = width / m->trace_scale * 25.4 / 72;
    t.figure.height = height / m->trace_scale * 25.4 / 72;

    m->traces = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    cairo_t *cr = cairo_create(m->traces);
    set_colour(cr, page_of(m));
    cairo_paint(cr);
    cairo_scale(cr, m->trace_scale, m->trace_scale);
    code = figure_paint(cr, &t.figure, m->report, f);
    cairo_destroy(cr);
    trace_figure_finish(&t);
    return code;
}

// The traces with the present as a line, and what comes after it under a veil.
static void draw_traces(const film *m, cairo_t *cr, double time)
{
    // all of it
    const figure_report *r = m->report;
    const colour page = page_of(m);
    cairo_set_source_surface(cr, m->traces, m->scene_width, 0);
    cairo_paint(cr);

    // the present as a line over each panel
    cairo_save(cr);
    cairo_translate(cr, m->scene_width, 0);
    cairo_scale(cr, m->trace_scale, m->trace_scale);
    for (int i = 0; i < r->panel_count; i++) {
        figure_rect p = r->panels[i];
        double x = p.x + p.width * (time - m->clock.start) / (m->clock.end - m->clock.start);
        cairo_rectangle(cr, x, p.y, p.x + p.width - x, p.height);
        cairo_set_source_rgba(cr, page.red, page.green, page.blue, VEIL);
        cairo_fill(cr);
        cairo_move_to(cr, x, p.y);
        cairo_line_to(cr, x, p.y + p.height);
        cairo_set_line_width(cr, 1.1);
        cairo_set_source_rgb(cr, 0.835, 0.369, 0);
        cairo_stroke(cr);
    }
    cairo_restore(cr);

    // keys are of the past and the future
    for (int i = 0; i < r->panel_count; i++) {
        figure_rect key = r->legends[i];
        cairo_rectangle(cr, m->scene_width + key.x * m->trace_scale, key.y * m->trace_scale,
                        key.width * m->trace_scale, key.height * m->trace_scale);
    }

    cairo_set_source_surface(cr, m->traces, m->scene_width, 0);
    cairo_fill(cr);
}

// ---- frames

// Lets the scene's floor run out into the page of the traces.
static void soften_seam(const film *m, cairo_t *cr)
{
    double width = 0.06 * m->scene_width, from = m->scene_width - width;
    cairo_pattern_t *fade = cairo_pattern_create_linear(from, 0, m->scene_width, 0);
    const colour page = page_of(m);
    cairo_pattern_add_color_stop_rgba(fade, 0, page.red, page.green, page.blue, 0);
    cairo_pattern_add_color_stop_rgba(fade, 1, page.red, page.green, page.blue, 1);
    cairo_set_source(cr, fade);
    cairo_rectangle(cr, from, 0, width, m->options.height);
    cairo_fill(cr);
    cairo_pattern_destroy(fade);
}

static void draw_speed(const film *m, cairo_t *cr, double speed)
{
    char text[64];
    double scale = fmin(m->options.height / 720.0, m->scene_width / 800.0);

    // the number that is larger than one
    if (speed < 1) {
        double times = 1 / speed;
        decimal_print(text, sizeof text, "%.*f times slower than real", times < 9.95 ? 1 : 0,
                      times);
    } else {
        decimal_print(text, sizeof text, "%.1f times faster than real", speed);
    }

    const text_block t = {.markup = text, .size = LABELS_LEAST * scale};
    set_colour(cr, palette_of(m->options.view.theme)->faint_text);
    cairo_move_to(cr, 22 * scale, 20 * scale);
    text_draw(cr, m->context, &t);
}

// A frame of the scene at `time`, with the traces until `present`, added to the file.
static status add_frame(film *m, film_file *file, double time, double present, double speed,
                        fault *f)
{
    double times[SCENE_INSTANTS];
    int count = 0;
    for (int i = m->options.ghosts; i >= 0; i--) {
        double earlier = time - i * GHOST_TIME;
        if (i == 0 || earlier >= m->clock.start) {
            times[count++] = earlier;
        }
    }

    status code = scene_paint(m->scene, times, count, m->view, f);
    if (code != STATUS_OK) {
        return code;
    }

    cairo_t *cr = cairo_create(m->frame);
    cairo_set_source_surface(cr, m->view, 0, 0);
    cairo_paint(cr);
    soften_seam(m, cr);
    draw_traces(m, cr, present);
    draw_speed(m, cr, speed);
    cairo_destroy(cr);
    return film_file_add(file, m->frame, f);
}

// A frame just after the first impact, with flash, arrow and traces: every colour of the film.
static status add_palette(film *m, film_file *file, fault *f)
{
    double contact = m->result->summary.first_contact_s;
    double wanted = isnan(contact) ? m->clock.end : fmin(m->clock.end, contact + 0.008);
    return add_frame(m, file, wanted, m->clock.end, 1, f);
}

static status add_frames(film *m, film_file *file, fault *f)
{
    const film_options *o = &m->options;
    int total = (int)fmax(2, round(o->seconds * o->frames_per_second));
    status code = film_file_wants_palette(file) ? add_palette(m, file, f) : STATUS_OK;

    for (int i = 0; i < total && code == STATUS_OK; i++) {
        if (o->stop != NULL && *o->stop != 0) {
            return fault_set(f, STATUS_STOPPED, "interrupted after %d of %d frames", i, total);
        }

        double speed, time = film_clock_time(&m->clock, o->seconds * i / (total - 1), &speed);
        code = add_frame(m, file, time, time, speed, f);
        if (code == STATUS_OK && o->progress != NULL) {
            o->progress(o->context, i + 1, total);
        }
    }
    return code;
}

// ---- the film

static status check_options(const film_options *o, fault *f)
{
    if (o->width < 320 || o->width > 4096 || o->height < 240 || o->height > 4096 ||
        o->width % 2 != 0 || o->height % 2 != 0) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "a film of %d x %d pixels, expected even numbers from 320 x 240 to 4096 x "
                         "4096",
                         o->width, o->height);
    }

    if (o->frames_per_second < 1 || o->frames_per_second > 120) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "%d frames per second, expected 1 to 120",
                         o->frames_per_second);
    }

    if (!(o->seconds >= 0.1 && o->seconds <= 3600)) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "a film of %g s, expected 0.1 to 3600",
                         o->seconds);
    }

    if (o->ghosts < 0 || o->ghosts >= SCENE_INSTANTS) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "%d ghosts, expected 0 to %d", o->ghosts,
                         SCENE_INSTANTS - 1);
    }

    if (!(o->slow >= 1 && o->slow <= 1000)) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "the impact slowed down %g times, expected 1 to 1000", o->slow);
    }
    return STATUS_OK;
}

static film_options completed(const film_options *options)
{
    film_options o = *options;
    if (o.width == 0 && o.height == 0) {
        o.width = 1280;
        o.height = 720;
    }
    o.frames_per_second = o.frames_per_second ? o.frames_per_second : 30;
    o.seconds = o.seconds != 0 ? o.seconds : 10;
    o.slow = o.slow != 0 ? o.slow : 8;
    return o;
}

static status prepare(film *m, fault *f)
{
    status code = check_options(&m->options, f);

    if (code == STATUS_OK && m->result->trace.row_count == 0) {
        code = fault_set(f, STATUS_BAD_ARGUMENT, "the run has no rows to draw");
    }
    if (code != STATUS_OK) {
        return code;
    }

    // the scene takes what the traces leave
    m->scene_width = (int)(m->options.width * (1 - TRACE_SHARE));
    scene_options view = m->options.view;
    view.width = m->scene_width;
    view.height = m->options.height;
    view.samples = SAMPLES_QUICK;
    view.keyless = true;
    view.transparent = false;

    m->clock = film_clock_of(m->result, m->options.seconds, m->options.slow);
    code = scene_create(&m->scene, m->scenario, m->result, &view, f);
    if (code != STATUS_OK) {
        return code;
    }

    // what the frames are made of
    m->report = calloc(1, sizeof *m->report);
    if (m->report == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "no memory for a film");
    }
    m->context = text_context_create();
    m->view = cairo_image_surface_create(CAIRO_FORMAT_RGB24, view.width, view.height);
    m->frame = cairo_image_surface_create(CAIRO_FORMAT_RGB24, m->options.width, m->options.height);
    return paint_traces(m, f);
}

static void finish(film *m)
{
    scene_destroy(m->scene);
    cairo_surface_destroy(m->view);
    cairo_surface_destroy(m->traces);
    cairo_surface_destroy(m->frame);
    g_clear_object(&m->context);
    free(m->report);
}

static status record(film *m, const char *path, fault *f)
{
    // the same notes as a picture's
    char software[64], *values = parameters_line(m->scenario);
    snprintf(software, sizeof software, "impactlab %s", lab_version());
    const png_note notes[] = {{"Title", m->scenario->title},
                              {"Software", software},
                              {"Parameters", values},
                              {"Renderer", scene_renderer_name(m->scene)}};

    const film_facts facts = {.width = m->options.width,
                              .height = m->options.height,
                              .frames_per_second = m->options.frames_per_second,
                              .notes = notes,
                              .note_count = 4,
                              .stop = m->options.stop};
    film_file *file;

    status code = film_file_open(&file, path, &facts, f);
    if (code == STATUS_OK) {
        code = add_frames(m, file, f);
        if (code == STATUS_OK) {
            code = film_file_commit(file, f);
        } else {
            film_file_abandon(file);
        }
    }
    g_free(values);
    return code;
}

status film_write(const scenario *s, const run_result *result, const film_options *options,
                  const char *path, fault *f)
{
    assert(s != NULL && result != NULL && options != NULL && path != NULL);
    film m = {.scenario = s, .result = result, .options = completed(options)};
    status code = prepare(&m, f);
    if (code == STATUS_OK) {
        code = record(&m, path, f);
    }
    finish(&m);
    return code;
}
