// Frames of a film, and the instants that they show.
#include "render/scene/film.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "render/page/picture_file.h"
#include "render/page/text.h"
#include "render/plot/trace_plot.h"
#include "render/scene/scene_parts.h"
#include "src/base/numbers.h"

// ==== the clock

enum { CLOCK_CELLS = 4000 };

#define LEAST_IMPULSE 0.05 // of the largest

// Parts of the run's length.
#define BEFORE 0.01
#define AFTER  0.04
#define TAPER  0.03

static void add_impact(film_clock *c, double time)
{
    if (c->impact_count < FILM_IMPACTS) {
        c->impacts[c->impact_count++] = time;
    }
}

// The impacts of a run, or where contact begins in one without impulses.
static void add_impacts(film_clock *c, const trace *t)
{
    double largest = 0;
    for (size_t i = 0; i < t->event_count; i++) {
        largest = fmax(largest, t->events[i].kind == EVENT_IMPACT ? t->events[i].impulse : 0);
    }

    for (size_t i = 0; i < t->event_count && largest > 0; i++) {
        const event *e = &t->events[i];
        if (e->kind == EVENT_IMPACT && e->impulse >= LEAST_IMPULSE * largest) {
            add_impact(c, e->time);
        }
    }

    // a force that grows from nothing
    for (size_t i = 1; i < t->row_count && !(largest > 0); i++) {
        if (t->rows[i].contact > 0.5 && !(t->rows[i - 1].contact > 0.5)) {
            add_impact(c, t->rows[i].time);
        }
    }
}

static void set_windows(film_clock *c)
{
    const double span = c->end - c->start;
    c->before = BEFORE * span;
    c->after = AFTER * span;
    c->taper = TAPER * span;
}

film_clock film_clock_of(const run_result *const *results, int count, double seconds, double slow)
{
    assert(count > 0 && seconds > 0 && slow >= 1);
    film_clock c = {.start = -HUGE_VAL, .end = HUGE_VAL, .slow = slow, .seconds = seconds};

    // what all of them have
    for (int i = 0; i < count; i++) {
        const trace *t = &results[i]->trace;
        assert(t->row_count > 0);
        c.start = fmax(c.start, t->rows[0].time);
        c.end = fmin(c.end, t->rows[t->row_count - 1].time);
        add_impacts(&c, t);
    }
    qsort(c.impacts, (size_t)c.impact_count, sizeof c.impacts[0], compare_numbers);

    set_windows(&c);
    return c;
}

film_clock film_clock_round(double start, double end, double instant, double slow)
{
    assert(end >= start && isfinite(instant) && slow >= 1);
    film_clock c = {start, end, .slow = slow, .impacts = {instant}, .impact_count = 1};
    set_windows(&c);
    return c;
}

double film_clock_slowness(const film_clock *c, double t)
{
    double outside = HUGE_VAL;
    for (int i = 0; i < c->impact_count; i++) {
        double until = c->impacts[i] - c->before - t, since = t - c->impacts[i] - c->after;
        outside = fmin(outside, fmax(fmax(until, since), 0));
    }
    if (outside >= c->taper) {
        return 1;
    }
    return 1 + (c->slow - 1) * 0.5 * (1 + cos(M_PI * outside / c->taper));
}

double film_clock_time(const film_clock *c, double film_time, double *speed)
{
    assert(c->seconds > 0);
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

#define TRACE_SHARE   0.36 // of the picture's width, for the traces next to one arm
#define STRIP_SHARE   0.30 // of its height, for those below several
#define TRACE_LETTERS 2.5  // scale of the traces for a picture 720 pixels high
#define GHOST_TIME    0.02 // of the run between one ghost and the next [s]
#define VEIL          0.82 // how far the future of the traces is faded out
#define GAP           2    // between views [pixels]

// ---- the plan

static colour page_of(const film_plan *plan)
{
    return palette_of(plan->options.view.theme)->page;
}

// Of letters: 1 for a film of 1280 x 720.
static double film_scale(const film_plan *plan)
{
    return fmin(plan->options.height / 720.0, plan->options.width / 1280.0);
}

// One arm next to its traces; several arms in two columns above theirs.
static void place_views(film_plan *plan)
{
    int width = plan->options.width, height = plan->options.height;
    if (plan->run_count == 1) {
        int scene_width = (int)(width * (1 - TRACE_SHARE));
        plan->views[0] = (pixel_box){0, 0, scene_width, height};
        plan->strip = (pixel_box){scene_width, 0, width - scene_width, height};
        return;
    }

    int rows = (plan->run_count + 1) / 2, strip = (int)(height * STRIP_SHARE);
    int view_width = (width - GAP) / 2, view_height = (height - strip - (rows - 1) * GAP) / rows;
    for (int i = 0; i < plan->run_count; i++) {
        plan->views[i] = (pixel_box){i % 2 * (view_width + GAP), i / 2 * (view_height + GAP),
                                     view_width, view_height};
    }
    plan->strip = (pixel_box){0, height - strip, width, strip};
}

// The traces: force, angles and velocities of one run, the forces of several.
static owned_figure *describe_traces(const film_plan *plan)
{
    static const trace_panel several = {.signals = {"force"}, .with_zero = true};
    trace_panel one[] = {usual_panels[0], usual_panels[1], usual_panels[2]};
    trace_run runs[FILM_RUNS];
    one[0].inset = false;

    for (int i = 0; i < plan->run_count; i++) {
        runs[i] = (trace_run){plan->runs[i].scenario, plan->runs[i].result, plan->runs[i].name,
                              .rank = plan->run_count > 1 ? i + 1 : 0};
    }
    return plan->run_count == 1 ? trace_figure_create(NULL, one, (int)G_N_ELEMENTS(one), runs, 1)
                                : trace_figure_create(NULL, &several, 1, runs, plan->run_count);
}

// Paints all of the traces once; frames veil what has not happened yet.
static status paint_traces(film_plan *plan, fault *f)
{
    owned_figure *drawn = describe_traces(plan);
    figure *t = &drawn->figure;

    // its size: what the views leave of the picture
    const pixel_box *strip = &plan->strip;
    plan->trace_scale = TRACE_LETTERS * film_scale(plan);

    // the views have the titles
    t->title = t->caption = NULL;
    t->theme = plan->options.view.theme;
    t->x.low = plan->clock.start;
    t->x.high = plan->clock.end;
    t->width = strip->width / plan->trace_scale * 25.4 / 72;
    t->height = strip->height / plan->trace_scale * 25.4 / 72;

    plan->traces = cairo_image_surface_create(CAIRO_FORMAT_RGB24, strip->width, strip->height);
    cairo_t *cr = cairo_create(plan->traces);
    set_colour(cr, page_of(plan));
    cairo_paint(cr);
    cairo_scale(cr, plan->trace_scale, plan->trace_scale);
    status code = picture_end_drawing(cr, figure_paint(cr, t, plan->report, f), f);
    owned_figure_destroy(drawn);
    return code;
}

status film_plan_init(film_plan *plan, const film_run *runs, int run_count,
                      const film_options *options, fault *f)
{
    assert(run_count >= 1 && run_count <= FILM_RUNS);
    assert(options->width > 0 && options->slow >= 1);
    *plan = (film_plan){.runs = runs, .run_count = run_count, .options = *options};

    const run_result *results[FILM_RUNS];
    for (int i = 0; i < run_count; i++) {
        results[i] = runs[i].result;
        scene_options_scale(&plan->options.view, &results[i]->trace);
    }
    plan->clock = film_clock_of(results, run_count, options->seconds, options->slow);
    place_views(plan);

    plan->report = g_new0(figure_report, 1);
    return paint_traces(plan, f);
}

void film_plan_finish(film_plan *plan)
{
    cairo_surface_destroy(plan->traces);
    g_free(plan->report);
    *plan = (film_plan){0};
}

// ---- painters

status film_painter_create(film_painter **out, const film_plan *plan, fault *f)
{
    g_autoptr(film_painter) p = g_new0(film_painter, 1);
    *out = NULL;
    p->plan = plan;
    p->context = text_context_create();

    // a scene for each run, as large as its view
    for (int i = 0; i < plan->run_count; i++) {
        scene_options view = plan->options.view;
        view.width = plan->views[i].width;
        view.height = plan->views[i].height;
        view.keyless = true;
        view.transparent = false;
        // left to choose, the lab's own painter: of 4 x 4 samples it takes half of OpenGL's time
        view.renderer = view.renderer == RENDER_AUTO ? RENDER_CAIRO : view.renderer;
        // small views have the letters of the whole
        view.letters = plan->run_count > 1 ? film_scale(plan) : 0;
        TRY(scene_create(&p->scenes[i], plan->runs[i].scenario, plan->runs[i].result, &view, f));
        p->views[i] = cairo_image_surface_create(CAIRO_FORMAT_RGB24, view.width, view.height);
    }
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
        cairo_surface_destroy(p->views[i]);
    }
    g_clear_object(&p->context);
    g_free(p);
}

// ---- what lies round the arms

// Lets the floor of a single view run out into the page of the traces.
static void soften_seam(const film_plan *plan, cairo_t *cr)
{
    double end = plan->views[0].width, width = 0.06 * end, from = end - width;
    cairo_pattern_t *fade = cairo_pattern_create_linear(from, 0, end, 0);
    const colour page = page_of(plan);
    cairo_pattern_add_color_stop_rgba(fade, 0, page.red, page.green, page.blue, 0);
    cairo_pattern_add_color_stop_rgba(fade, 1, page.red, page.green, page.blue, 1);
    cairo_set_source(cr, fade);
    cairo_rectangle(cr, from, 0, width, plan->options.height);
    cairo_fill(cr);
    cairo_pattern_destroy(fade);
}

// The page, and lines between several views.
static void draw_gaps(const film_plan *plan, cairo_t *cr)
{
    const pixel_box *first = &plan->views[0];
    set_colour(cr, page_of(plan));
    cairo_paint(cr);
    set_colour(cr, palette_of(plan->options.view.theme)->grid);
    if (plan->run_count > 1) {
        cairo_rectangle(cr, first->width, 0, GAP, plan->strip.y);
    }
    if (plan->run_count > 2) {
        cairo_rectangle(cr, 0, first->height, plan->options.width, GAP);
    }
    cairo_fill(cr);
}

// The traces with the present as a line, and what comes after it under a veil.
static void draw_traces(const film_plan *plan, cairo_t *cr, double time)
{
    // all of it
    const figure_report *r = plan->report;
    const colour page = page_of(plan);
    const pixel_box *strip = &plan->strip;
    cairo_set_source_surface(cr, plan->traces, strip->x, strip->y);
    cairo_paint(cr);

    // the present as a line over each panel
    cairo_save(cr);
    cairo_translate(cr, strip->x, strip->y);
    cairo_scale(cr, plan->trace_scale, plan->trace_scale);
    for (int i = 0; i < r->panel_count; i++) {
        figure_rect p = r->panels[i];
        double x =
            p.x + p.width * (time - plan->clock.start) / (plan->clock.end - plan->clock.start);
        cairo_rectangle(cr, x, p.y, p.x + p.width - x, p.height);
        cairo_set_source_rgba(cr, page.red, page.green, page.blue, VEIL);
        cairo_fill(cr);
        cairo_move_to(cr, x, p.y);
        cairo_line_to(cr, x, p.y + p.height);
        cairo_set_line_width(cr, 1.1);
        cairo_set_source_rgb(cr, 0.835, 0.369, 0);
        picture_stroke(cr);
    }
    cairo_restore(cr);

    // keys are of the past and the future
    for (int i = 0; i < r->panel_count; i++) {
        figure_rect key = r->legends[i];
        cairo_rectangle(cr, strip->x + key.x * plan->trace_scale,
                        strip->y + key.y * plan->trace_scale, key.width * plan->trace_scale,
                        key.height * plan->trace_scale);
    }

    cairo_set_source_surface(cr, plan->traces, strip->x, strip->y);
    cairo_fill(cr);
}

static void draw_speed(const film_painter *p, cairo_t *cr, double speed)
{
    const film_plan *plan = p->plan;
    const double scale = film_scale(plan), times = 1 / speed;

    // the number that is larger than one
    g_autofree char *text =
        speed < 1 ? text_printf("%.*f times slower than real", times < 9.95 ? 1 : 0, times)
                  : text_printf("%.1f times faster than real", speed);
    const text_block t = {.markup = text, .size = LABELS_LEAST * scale};
    // with several arms there is a free corner next to the axis of the traces
    const bool alone = plan->run_count == 1;
    text_put(cr, p->context, &t, 22 * scale, alone ? 20 * scale : plan->options.height - 6 * scale,
             (anchor){0, !alone}, palette_of(plan->options.view.theme)->faint_text);
}

// ---- frames

// The arms at `time`, with the traces until `present`.
static status paint_frame(film_painter *p, double time, double present, double speed,
                          cairo_surface_t *onto, fault *f)
{
    // earlier arms, and the one of now
    const film_plan *plan = p->plan;
    double times[SCENE_INSTANTS];
    int count = 0;
    for (int i = plan->options.ghosts; i >= 0; i--) {
        double earlier = time - i * GHOST_TIME;
        if (i == 0 || earlier >= plan->clock.start) {
            times[count++] = earlier;
        }
    }

    cairo_t *cr = cairo_create(onto);
    draw_gaps(plan, cr);
    status code = STATUS_OK;
    for (int i = 0; i < plan->run_count && code == STATUS_OK; i++) {
        code = scene_paint(p->scenes[i], times, count, p->views[i], f);
        cairo_set_source_surface(cr, p->views[i], plan->views[i].x, plan->views[i].y);
        cairo_paint(cr);
    }

    // what lies round and over them
    if (code == STATUS_OK) {
        if (plan->run_count == 1) {
            soften_seam(plan, cr);
        }
        draw_traces(plan, cr, present);
        draw_speed(p, cr, speed);
    }
    return picture_end_drawing(cr, code, f);
}

status film_painter_frame(film_painter *p, double film_time, cairo_surface_t *onto, fault *f)
{
    double speed, time = film_clock_time(&p->plan->clock, film_time, &speed);
    return paint_frame(p, time, time, speed, onto, f);
}

status film_painter_palette(film_painter *p, cairo_surface_t *onto, fault *f)
{
    const film_clock *c = &p->plan->clock;
    double wanted = c->impact_count > 0 ? fmin(c->end, c->impacts[0] + 0.008) : c->end;
    return paint_frame(p, wanted, c->end, 1, onto, f);
}
