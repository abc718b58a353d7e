// A synthetic run, and checks of what a figure draws.
#pragma once

#include "tests/shipped_scenario.h"

#include <png.h>
#include <zlib.h>

#include "render/figures/figures.h"
#include "render/page/text.h"
#include "render/plot/trace_plot.h"

enum { ROWS = 1001 };

// ---- a run that looks like one

static const double first_contact = 0.31, first_release = 0.38;

static inline double force_at(double t)
{
    const double begins[] = {first_contact, 0.45, 0.52},
                 ends[] = {first_release, 0.49, 0.545};
    const double peaks[] = {2.1, 0.9, 0.5};
    for (int i = 0; i < 3; i++) {
        if (t >= begins[i] && t <= ends[i]) {
            return peaks[i] * sin(M_PI * (t - begins[i]) / (ends[i] - begins[i]));
        }
    }
    return t > 0.56 ? 0.4 + 0.2 * exp(-(t - 0.56) / 0.08) * cos(60 * (t - 0.56)) : 0;
}

static inline double angle_at(double t, double phase)
{
    double settled = 0.1 + 0.02 * phase * exp(-3 * fabs(t - first_contact)) * cos(25 * t);
    return t < first_contact
               ? 0.1 * pow(t / first_contact, 2) + 0.003 * phase * sin(40 * t)
               : settled;
}

typedef struct synthetic {
    scenario scenario;
    run_result result;
    owned_figure *plot;
} synthetic;

static inline void synthetic_init(synthetic *s, const trace_panel *panels, int count)
{
    static const double impulses[] = {0.044, 0.009, 0.0021};
    static const double times[] = {0.31, 0.45, 0.52};
    memset(s, 0, sizeof *s);
    parameters_defaults(&s->scenario.parameters, ARM_PRINTED);
    DONE(parameters_resolve(&s->scenario.parameters, &f));
    s->scenario.name = (char *)"synthetic";
    s->scenario.title = (char *)"Synthetic run & <more>";
    trace_init(&s->result.trace, 3);
    for (int i = 0; i < ROWS; i++) {
        double t = 1e-3 * i, angles[3] = {0};
        sample row = {.time = t,
                      .hub_angle = angle_at(t, 1),
                      .first_angle = angle_at(t, 0.8),
                      .last_angle = angle_at(t, -1),
                      .hub_velocity = 0.6 * cos(9 * t),
                      .first_velocity = 0.7 * cos(9 * t + 0.2),
                      .last_velocity = -0.9 * sin(21 * t) * exp(-t),
                      .force = force_at(t),
                      .contact = force_at(t) > 0,
                      .voltage = 1};
        assert_int_equal(trace_add_row(&s->result.trace, &row, angles, angles),
                         STATUS_OK);
    }
    for (int i = 0; i < 3; i++) {
        event e = {.time = times[i],
                   .kind = EVENT_IMPACT,
                   .impulse = impulses[i],
                   .index = -1};
        assert_int_equal(trace_add_event(&s->result.trace, e), STATUS_OK);
    }
    s->result.summary.first_contact_s = first_contact;
    s->result.summary.first_pulse_s = first_release - first_contact;
    s->result.summary.first_pulse_time_to_peak_s = 0.035;
    s->result.summary.first_pulse_peak_N = 2.1;
    const trace_run run = {&s->scenario, &s->result, NULL};
    s->plot = trace_figure_create(NULL, panels, count, &run, 1);
}

static inline void synthetic_finish(synthetic *s)
{
    owned_figure_destroy(s->plot);
    run_finish(&s->result);
}

// A synthetic run that goes when its block is left.
#define SYNTHETIC(s, panels, count)                                                      \
    SCOPED(synthetic_finish) synthetic s;                                                \
    synthetic_init(&s, panels, count)

static const trace_panel run_panels[] = {
    {.signals = {"force"}, .with_zero = true, .impulses = true, .inset = true},
    {.label = "Angle",
     .signals = {"hub_angle", "first_angle", "last_angle"},
     .wall = true},
    {.label = "Angular velocity",
     .signals = {"hub_velocity", "first_velocity", "last_velocity"}},
    {.label = "Voltage", .signals = {"voltage"}, .with_zero = true, .weight = 0.5},
};
enum { RUN_PANELS = 4 };

// ---- looking at what was drawn

// Pixels that go when their block is left: PIXELS(image) = paint_pixels(...);
GIVEN_BACK(cairo_surface_t, cairo_surface_destroy)
#define PIXELS(name) SCOPED(cairo_surface_destroy_kept) cairo_surface_t *name

// A figure of the catalogue.
static inline artwork open_figure(const char *id, figure_options o)
{
    fault f = {0};
    artwork drawn;
    const thesis_figure *which = thesis_figure_find(id);
    assert_non_null(which);
    fail_if(figure_open(which, &o, &drawn, &f) != STATUS_OK, "%s: %s", id, f.text);
    return drawn;
}

// Paints it on an unbounded recording; reports, and gives what the ink covers.
static inline figure_rect record_page(const artwork *a, figure_report *report)
{
    figure_rect ink;
    cairo_surface_t *surface =
        cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, NULL);
    cairo_t *cr = cairo_create(surface);
    DONE(artwork_paint(a, cr, report, &f));
    assert_int_equal(cairo_status(cr), CAIRO_STATUS_SUCCESS);
    cairo_recording_surface_ink_extents(surface, &ink.x, &ink.y, &ink.width, &ink.height);
    cairo_destroy(cr);
    cairo_surface_destroy(surface);
    return ink;
}

static inline figure_rect record(const figure *fig, figure_report *report)
{
    SCOPED(artwork_finish) artwork a = artwork_of_figure(fig);
    return record_page(&a, report);
}

// The whole page as pixels, `scale` to a point.
static inline cairo_surface_t *page_pixels(const artwork *a, double scale,
                                           figure_report *report)
{
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)ceil(a->width * scale),
                                   (int)ceil(a->height * scale));
    cairo_surface_set_device_scale(surface, scale, scale);
    cairo_t *cr = cairo_create(surface);
    DONE(artwork_paint(a, cr, report, &f));
    cairo_destroy(cr);
    cairo_surface_flush(surface);
    return surface;
}

static inline cairo_surface_t *paint_pixels(const figure *fig, double scale,
                                            figure_report *report)
{
    SCOPED(artwork_finish) artwork a = artwork_of_figure(fig);
    return page_pixels(&a, scale, report);
}

// The place of a text, NULL if it is not drawn.
static inline const figure_rect *find_text(const figure_report *r, const char *wanted)
{
    for (int i = 0; i < r->text_count; i++) {
        if (strcmp(r->texts[i].text, wanted) == 0) {
            return &r->texts[i].place;
        }
    }
    return NULL;
}

// The same, which must be drawn.
static inline const figure_rect *expect_text(const figure_report *r, const char *wanted)
{
    const figure_rect *place = find_text(r, wanted);
    for (int i = 0; i < r->text_count && place == NULL; i++) {
        print_message("'%s'\n", r->texts[i].text);
    }
    fail_if(place == NULL, "the text '%s' is not drawn", wanted);
    return place;
}

static inline double bottom_of(const figure_rect *r)
{
    return r->y + r->height;
}

// Whether r lies within `outer`, to a slack [pt].
static inline bool rect_is_within(const figure_rect *r, const figure_rect *outer,
                                  double slack)
{
    return r->x >= outer->x - slack && r->y >= outer->y - slack &&
           r->x + r->width <= outer->x + outer->width + slack &&
           r->y + r->height <= outer->y + outer->height + slack;
}

static inline void expect_inside(const figure_rect *r, const figure_rect *outer,
                                 const char *what)
{
    fail_if(!rect_is_within(r, outer, 0.5),
            "%s at %g, %g of %g x %g is not within %g, %g of %g x %g", what, r->x, r->y,
            r->width, r->height, outer->x, outer->y, outer->width, outer->height);
}

// Whether the letters of two texts overlap; their line boxes are taller than the letters.
static inline bool overlap(const figure_rect *a, const figure_rect *b)
{
    double down = fmin(a->y + a->height, b->y + b->height) - fmax(a->y, b->y);
    double across = fmin(a->x + a->width, b->x + b->width) - fmax(a->x, b->x);
    return across > 0.5 && down > 0.3 * fmin(a->height, b->height);
}

// Nothing leaves the page and no text covers another.
static inline void expect_tidy_page(const artwork *a, figure_report *r)
{
    // the ink is known in whole points only
    figure_rect ink = record_page(a, r), page = {0, 0, ceil(a->width), ceil(a->height)};
    expect_inside(&ink, &page, a->title != NULL ? a->title : "the ink");
    for (int i = 0; i < r->text_count; i++) {
        expect_inside(&r->texts[i].place, &page, r->texts[i].text);
        for (int k = 0; k < i; k++) {
            fail_if(overlap(&r->texts[i].place, &r->texts[k].place),
                    "%s: '%s' covers '%s'", a->title, r->texts[i].text, r->texts[k].text);
        }
    }
}

static inline void expect_tidy(const figure *fig)
{
    static figure_report r;
    SCOPED(artwork_finish) artwork a = artwork_of_figure(fig);
    expect_tidy_page(&a, &r);
    assert_int_equal(r.panel_count, fig->panel_count);
    const int columns = fig->columns > 0 ? fig->columns : 1;
    for (int i = 0; i < r.panel_count; i++) {
        expect_inside(&r.panels[i], &r.page, "a panel");
        check_close(r.panels[i].x, r.panels[i % columns].x, 0);
        check_close(r.panels[i].width, r.panels[0].width, 1e-9);
        if (i >= columns) {
            check_below(bottom_of(&r.panels[i - columns]), r.panels[i].y);
        }
        if (r.insets[i].width > 0) {
            expect_inside(&r.insets[i], &r.panels[i], "an inset");
        }
    }
}

typedef struct pixel {
    int red, green, blue;
} pixel;

static inline pixel pixel_at(cairo_surface_t *surface, int x, int y)
{
    uint32_t value;
    assert_true(x >= 0 && x < cairo_image_surface_get_width(surface));
    assert_true(y >= 0 && y < cairo_image_surface_get_height(surface));
    memcpy(&value,
           cairo_image_surface_get_data(surface) +
               (ptrdiff_t)y * cairo_image_surface_get_stride(surface) + 4 * (ptrdiff_t)x,
           sizeof value);
    return (pixel){value >> 16 & 255, value >> 8 & 255, value & 255};
}

static inline int saturation(pixel p)
{
    int most = p.red > p.green ? p.red : p.green,
        least = p.red < p.green ? p.red : p.green;
    most = most > p.blue ? most : p.blue;
    least = least < p.blue ? least : p.blue;
    return most - least;
}

// Number of strongly coloured pixels (curves) in a rectangle given in points.
static inline int coloured_pixels(cairo_surface_t *surface, double scale, figure_rect r)
{
    int count = 0;
    for (int y = (int)ceil(r.y * scale); y < (int)floor((r.y + r.height) * scale); y++) {
        for (int x = (int)ceil(r.x * scale); x < (int)floor((r.x + r.width) * scale);
             x++) {
            count += saturation(pixel_at(surface, x, y)) > 60;
        }
    }
    return count;
}

static inline void expect_same_bytes(const char *a, const char *b)
{
    size_t a_length, b_length;
    KEPT_TEXT(a_bytes) = file_bytes(a, &a_length), *b_bytes = file_bytes(b, &b_length);
    assert_true(a_length > 50);
    assert_int_equal(a_length, b_length);
    assert_memory_equal(a_bytes, b_bytes, a_length);
}

static inline void write_csv(const figure *fig, const char *path)
{
    SCOPED(artwork_finish) artwork a = artwork_of_figure(fig);
    DONE(artwork_write_csv(&a, path, &f));
}

static inline void write_figure(const figure *fig, const char *path)
{
    DONE(figure_write(fig, path, &f));
}

// ---- a folder for files

static inline int leave_plot_folder(void **state)
{
    pango_cairo_font_map_set_default(NULL); // what Pango keeps for later figures
    return leave_folder(state);
}

// The number behind a part of a text that must be there.
static inline double number_behind(const char *text, const char *part)
{
    const char *at = strstr(text, part);
    fail_if(at == NULL, "'%s' is not there", part);
    return atof(at + strlen(part));
}
