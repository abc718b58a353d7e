// Figures, judged by what is drawn: texts and where they are, pixels, bytes of files.
#include "tests/check.h"

#include <png.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <zlib.h>

#include "render/plot/figure_file.h"
#include "render/page/text.h"
#include "render/plot/trace_plot.h"

// fontconfig keeps its cache until the process ends
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libfontconfig\n";
}

enum { ROWS = 1001 };

static char folder[64];

static char *path_of(const char *name)
{
    static char paths[4][256];
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

// ---- a run that looks like one
// --------------------------------------------------------------------

static const double first_contact = 0.31, first_release = 0.38;

static double force_at(double t)
{
    const double begins[] = {first_contact, 0.45, 0.52}, ends[] = {first_release, 0.49, 0.545};
    const double peaks[] = {2.1, 0.9, 0.5};
    for (int i = 0; i < 3; i++) {
        if (t >= begins[i] && t <= ends[i]) {
            return peaks[i] * sin(M_PI * (t - begins[i]) / (ends[i] - begins[i]));
        }
    }
    return t > 0.56 ? 0.4 + 0.2 * exp(-(t - 0.56) / 0.08) * cos(60 * (t - 0.56)) : 0;
}

static double angle_at(double t, double phase)
{
    double settled = 0.1 + 0.02 * phase * exp(-3 * fabs(t - first_contact)) * cos(25 * t);
    return t < first_contact ? 0.1 * pow(t / first_contact, 2) + 0.003 * phase * sin(40 * t)
                             : settled;
}

typedef struct synthetic {
    scenario scenario;
    run_result result;
    trace_figure figure;
} synthetic;

static void synthetic_init(synthetic *s, const trace_panel *panels, int count)
{
    static const double impulses[] = {0.044, 0.009, 0.0021};
    static const double times[] = {0.31, 0.45, 0.52};
    fault f = {0};
    memset(s, 0, sizeof *s);
    parameters_defaults(&s->scenario.parameters, ARM_PRINTED);
    assert_int_equal(parameters_resolve(&s->scenario.parameters, &f), STATUS_OK);
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
        assert_int_equal(trace_add_row(&s->result.trace, &row, angles, angles), STATUS_OK);
    }
    for (int i = 0; i < 3; i++) {
        event e = {.time = times[i], .kind = EVENT_IMPACT, .impulse = impulses[i], .index = -1};
        assert_int_equal(trace_add_event(&s->result.trace, e), STATUS_OK);
    }
    s->result.summary.first_contact_s = first_contact;
    s->result.summary.first_pulse_s = first_release - first_contact;
    s->result.summary.first_pulse_time_to_peak_s = 0.035;
    s->result.summary.first_pulse_peak_N = 2.1;
    const trace_run run = {&s->scenario, &s->result, NULL};
    assert_int_equal(trace_figure_init(&s->figure, NULL, panels, count, &run, 1, &f), STATUS_OK);
}

static void synthetic_finish(synthetic *s)
{
    trace_figure_finish(&s->figure);
    run_finish(&s->result);
}

static const trace_panel run_panels[] = {
    {.signals = {"force"}, .with_zero = true, .impulses = true, .inset = true},
    {.label = "Angle", .signals = {"hub_angle", "first_angle", "last_angle"}, .wall = true},
    {.label = "Angular velocity", .signals = {"hub_velocity", "first_velocity", "last_velocity"}},
    {.label = "Voltage", .signals = {"voltage"}, .with_zero = true, .weight = 0.5},
};
enum { RUN_PANELS = 4 };

// ---- looking at what was drawn
// --------------------------------------------------------------------

// Draws on an unbounded recording; reports, and gives what the ink covers.
static figure_rect record(const figure *fig, figure_report *report)
{
    fault f = {0};
    figure_rect ink;
    cairo_surface_t *surface = cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, NULL);
    cairo_t *cr = cairo_create(surface);
    status code = figure_paint(cr, fig, report, &f);
    if (code != STATUS_OK) {
        fail_msg("%s", f.text);
    }
    assert_int_equal(cairo_status(cr), CAIRO_STATUS_SUCCESS);
    cairo_recording_surface_ink_extents(surface, &ink.x, &ink.y, &ink.width, &ink.height);
    cairo_destroy(cr);
    cairo_surface_destroy(surface);
    return ink;
}

static bool has_text(const figure_report *r, const char *wanted)
{
    for (int i = 0; i < r->text_count; i++) {
        if (strcmp(r->texts[i].text, wanted) == 0) {
            return true;
        }
    }
    return false;
}

static void expect_text(const figure_report *r, const char *wanted)
{
    if (!has_text(r, wanted)) {
        for (int i = 0; i < r->text_count; i++) {
            print_message("'%s'\n", r->texts[i].text);
        }
        fail_msg("the text '%s' is not drawn", wanted);
    }
}

static void expect_inside(const figure_rect *r, const figure_rect *outer, const char *what)
{
    const double slack = 0.01;
    if (r->x < outer->x - slack || r->y < outer->y - slack ||
        r->x + r->width > outer->x + outer->width + slack ||
        r->y + r->height > outer->y + outer->height + slack) {
        fail_msg("%s at %g, %g of %g x %g is not within %g, %g of %g x %g", what, r->x, r->y,
                 r->width, r->height, outer->x, outer->y, outer->width, outer->height);
    }
}

static bool overlap(const figure_rect *a, const figure_rect *b)
{
    // line boxes are taller than letters
    double down = fmin(a->y + a->height, b->y + b->height) - fmax(a->y, b->y);
    double across = fmin(a->x + a->width, b->x + b->width) - fmax(a->x, b->x);
    return across > 0.5 && down > 0.3 * fmin(a->height, b->height);
}

static void expect_tidy(const figure *fig)
{
    static figure_report r;
    figure_rect ink = record(fig, &r);
    // the ink is known in whole points only
    figure_rect page = {0, 0, ceil(r.page.width), ceil(r.page.height)};
    expect_inside(&ink, &page, "the ink");
    assert_int_equal(r.panel_count, fig->panel_count);
    for (int i = 0; i < r.text_count; i++) {
        expect_inside(&r.texts[i].place, &r.page, r.texts[i].text);
        for (int k = 0; k < i; k++) {
            if (overlap(&r.texts[i].place, &r.texts[k].place)) {
                fail_msg("'%s' covers '%s'", r.texts[i].text, r.texts[k].text);
            }
        }
    }
    for (int i = 0; i < r.panel_count; i++) {
        expect_inside(&r.panels[i], &r.page, "a panel");
        check_close(r.panels[i].x, r.panels[0].x, 0);
        check_close(r.panels[i].width, r.panels[0].width, 0);
        if (i > 0) {
            check_below(r.panels[i - 1].y + r.panels[i - 1].height, r.panels[i].y);
        }
        if (r.insets[i].width > 0) {
            expect_inside(&r.insets[i], &r.panels[i], "an inset");
        }
    }
}

// The whole figure as pixels, `scale` to a point.
static cairo_surface_t *paint_pixels(const figure *fig, double scale, figure_report *report)
{
    fault f = {0};
    double width, height;
    figure_size(fig, &width, &height);
    cairo_surface_t *surface = cairo_image_surface_create(
        CAIRO_FORMAT_RGB24, (int)ceil(width * scale), (int)ceil(height * scale));
    cairo_surface_set_device_scale(surface, scale, scale);
    cairo_t *cr = cairo_create(surface);
    assert_int_equal(figure_paint(cr, fig, report, &f), STATUS_OK);
    cairo_destroy(cr);
    cairo_surface_flush(surface);
    return surface;
}

typedef struct pixel {
    int red, green, blue;
} pixel;

static pixel pixel_at(cairo_surface_t *surface, int x, int y)
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

static int saturation(pixel p)
{
    int most = p.red > p.green ? p.red : p.green, least = p.red < p.green ? p.red : p.green;
    most = most > p.blue ? most : p.blue;
    least = least < p.blue ? least : p.blue;
    return most - least;
}

// Number of strongly coloured pixels (curves) in a rectangle given in points.
static int coloured_pixels(cairo_surface_t *surface, double scale, figure_rect r)
{
    int count = 0;
    for (int y = (int)ceil(r.y * scale); y < (int)floor((r.y + r.height) * scale); y++) {
        for (int x = (int)ceil(r.x * scale); x < (int)floor((r.x + r.width) * scale); x++) {
            count += saturation(pixel_at(surface, x, y)) > 60;
        }
    }
    return count;
}

static char *read_file(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    *length = 0;
    if (file == NULL) {
        fail_msg("there is no file %s", path);
        return NULL;
    }
    char *bytes = malloc(1 << 24);
    assert_non_null(bytes);
    *length = fread(bytes, 1, (1 << 24) - 1, file);
    bytes[*length] = '\0';
    fclose(file);
    return bytes;
}

static void expect_same_bytes(const char *a, const char *b)
{
    size_t a_length, b_length;
    char *a_bytes = read_file(a, &a_length), *b_bytes = read_file(b, &b_length);
    assert_true(a_length > 500);
    assert_int_equal(a_length, b_length);
    assert_memory_equal(a_bytes, b_bytes, a_length);
    free(a_bytes);
    free(b_bytes);
}

static void write_figure(const figure *fig, const char *path)
{
    fault f = {0};
    if (figure_write(fig, path, &f) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
}

// ---- the font
// -------------------------------------------------------------------------------------

// comes first: fontconfig reads its configuration once
static void missing_font_is_reported(void **state)
{
    (void)state;
    pid_t child = fork();
    if (child == 0) {
        FILE *file = fopen(path_of("fonts.conf"), "w");
        fputs("<fontconfig><dir>/nowhere</dir></fontconfig>", file);
        fclose(file);
        setenv("FONTCONFIG_FILE", path_of("fonts.conf"), 1);
        fault f = {0};
        double x[] = {0, 1};
        figure_series series = {.x = x, .y = x, .count = 2, .label = "a<sub>1</sub>"};
        figure_panel panel = {.series = &series, .series_count = 1};
        figure fig = {.panels = &panel, .panel_count = 1};
        status code = figure_write(&fig, path_of("no-font.png"), &f);
        bool named = strstr(f.text, "fonts-dejavu-core") != NULL;
        bool nothing_written = access(path_of("no-font.png"), F_OK) != 0;
        _exit(code == STATUS_CANNOT_READ && named && nothing_written ? 0 : 1);
    }
    int result;
    assert_int_equal(waitpid(child, &result, 0), child);
    assert_true(WIFEXITED(result));
    assert_int_equal(WEXITSTATUS(result), 0);
}

static void indices_are_small_and_scale_with_the_letters(void **state)
{
    (void)state;
    PangoContext *context = text_context_create();
    double plain, lowered, twice, height, narrow;
    text_measure(context, &(text_block){.markup = "x111", .size = 8}, &plain, &height);
    text_measure(context, &(text_block){.markup = "x<sub>111</sub>", .size = 8}, &lowered, &height);
    text_measure(context, &(text_block){.markup = "x<sub>111</sub>", .size = 16}, &twice, &height);
    text_measure(context, &(text_block){.markup = "x", .size = 8}, &narrow, &height);
    check_close(lowered - narrow, 0.7 * (plain - narrow), 0.1);
    check_close(twice, 2 * lowered, 0.1);
    g_object_unref(context);
}

static void markup_that_is_none_is_shown_as_it_stands(void **state)
{
    (void)state;
    PangoContext *context = text_context_create();
    PangoLayout *layout =
        text_layout_create(context, &(text_block){.markup = "a < b & c", .size = 8});
    assert_string_equal(pango_layout_get_text(layout), "a < b & c");
    g_object_unref(layout);
    layout = text_layout_create(context, &(text_block){.markup = "\xff\xfe", .size = 8});
    assert_true(g_utf8_validate(pango_layout_get_text(layout), -1, NULL));
    g_object_unref(layout);
    g_object_unref(context);
}

static void units_are_set_as_the_si_brochure_has_them(void **state)
{
    (void)state;
    static const char *const units[][2] = {{"rad/s2", "rad/s\u00b2"},
                                           {"kg m2", "kg\u00b7m\u00b2"},
                                           {"N m", "N\u00b7m"},
                                           {"N m/rad", "N\u00b7m/rad"},
                                           {"N s", "N\u00b7s"},
                                           {"s-1", "s\u207b\u00b9"},
                                           {"", ""}};
    for (size_t i = 0; i < G_N_ELEMENTS(units); i++) {
        char shown[64];
        text_unit(units[i][0], shown, sizeof shown);
        assert_string_equal(shown, units[i][1]);
    }
}

// ---- layout
// ---------------------------------------------------------------------------------------

static void all_texts_of_a_run_are_drawn(void **state)
{
    (void)state;
    static figure_report r;
    synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    record(&s.figure.figure, &r);
    static const char *const wanted[] = {"Synthetic run & <more>",
                                         "Time t (s)",
                                         "Contact force f (N)",
                                         "Angle (rad)",
                                         "Angular velocity (rad\u2060/\u2060s)",
                                         "\u03b81  hub",
                                         "\u03b83  last link",
                                         "wall",
                                         "contact",
                                         "peak 2.1\u2009N",
                                         "release",
                                         "Impulse\n(N\u00b7s)",
                                         "0.044",
                                         "0.009",
                                         "\u22120.4",
                                         "0.4"};
    for (size_t i = 0; i < G_N_ELEMENTS(wanted); i++) {
        expect_text(&r, wanted[i]);
    }
    assert_int_equal(r.panel_count, RUN_PANELS);
    assert_true(r.insets[0].width > 0);
    assert_true(r.insets[1].width == 0);
    synthetic_finish(&s);
}

static void nothing_is_clipped_or_covered(void **state)
{
    (void)state;
    static const double widths[] = {0, 85, 120, 260};
    for (int i = 0; i < 4; i++) {
        for (int theme = THEME_COLOUR; theme <= THEME_DARK; theme++) {
            synthetic s;
            synthetic_init(&s, run_panels, RUN_PANELS);
            s.figure.figure.width = widths[i];
            s.figure.figure.theme = theme;
            expect_tidy(&s.figure.figure);
            for (int p = 0; p < RUN_PANELS; p++) {
                s.figure.panels[p].legend = LEGEND_ENDS;
            }
            expect_tidy(&s.figure.figure);
            synthetic_finish(&s);
        }
    }
}

static void many_marks_and_impulses_stay_readable(void **state)
{
    (void)state;
    static figure_mark marks[60];
    static figure_impulse impulses[300];
    for (int i = 0; i < 60; i++) {
        marks[i] = (figure_mark){i < 5 ? 0.5 : i / 59.0, "event"};
    }
    for (int i = 0; i < 300; i++) {
        impulses[i] = (figure_impulse){0.3 + 0.5 * i / 299.0, i % 7 == 0 ? 1e-5 : 0.01 / (1 + i)};
    }
    synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    s.figure.figure.marks = marks;
    s.figure.figure.mark_count = 60;
    s.figure.panels[0].impulses = impulses;
    s.figure.panels[0].impulse_count = 300;
    expect_tidy(&s.figure.figure);
    synthetic_finish(&s);
}

static void layout_is_the_same_on_every_surface(void **state)
{
    (void)state;
    static figure_report reference, other;
    synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    record(&s.figure.figure, &reference);
    for (double scale = 1; scale < 4; scale += 0.77) {
        cairo_surface_destroy(paint_pixels(&s.figure.figure, scale, &other));
        assert_int_equal(other.text_count, reference.text_count);
        for (int i = 0; i < reference.text_count; i++) {
            assert_string_equal(other.texts[i].text, reference.texts[i].text);
            check_close(other.texts[i].place.x, reference.texts[i].place.x, 1e-6);
            check_close(other.texts[i].place.y, reference.texts[i].place.y, 1e-6);
            check_close(other.texts[i].place.width, reference.texts[i].place.width, 1e-6);
        }
    }
    synthetic_finish(&s);
}

// An impulse has no place on the force axis: a huge one changes nothing there.
static void impulses_do_not_touch_the_force_axis(void **state)
{
    (void)state;
    static figure_report r;
    synthetic s;
    synthetic_init(&s, run_panels, 1);
    figure_impulse huge[] = {{0.31, 5000}};
    s.figure.panels[0].impulses = huge;
    s.figure.panels[0].impulse_count = 1;
    record(&s.figure.figure, &r);
    expect_text(&r, "5\u00d7103");
    expect_text(&r, "2");
    expect_inside(&r.panels[0], &r.page, "the panel");
    for (int i = 0; i < r.text_count; i++) {
        if (strcmp(r.texts[i].text, "5\u00d7103") == 0) {
            check_below(r.texts[i].place.y + r.texts[i].place.height, r.panels[0].y + 1);
        }
    }
    synthetic_finish(&s);
}

// ---- curves
// ---------------------------------------------------------------------------------------

static void a_spike_of_one_sample_is_visible(void **state)
{
    (void)state;
    enum { COUNT = 100000, SPIKE = 50003 };
    double *x = calloc(COUNT, sizeof *x), *y = calloc(COUNT, sizeof *y);
    assert_non_null(x);
    assert_non_null(y);
    for (int i = 0; i < COUNT; i++) {
        x[i] = (double)i / COUNT;
    }
    for (int sign = -1; sign <= 1; sign += 2) {
        y[SPIKE] = sign;
        figure_series series = {.x = x, .y = y, .count = COUNT, .colour = 5};
        figure_panel panel = {.series = &series, .series_count = 1, .y.low = -1.1, .y.high = 1.1};
        figure fig = {.panels = &panel, .panel_count = 1, .width = 100, .dpi = 100};
        static figure_report r;
        record(&fig, &r);
        write_figure(&fig, path_of("spike.png"));
        cairo_surface_t *image = cairo_image_surface_create_from_png(path_of("spike.png"));
        assert_int_equal(cairo_surface_status(image), CAIRO_STATUS_SUCCESS);
        double scale = 100.0 / 72, middle = r.panels[0].y + r.panels[0].height / 2;
        double spike = r.panels[0].x + r.panels[0].width * x[SPIKE] / x[COUNT - 1];
        double quarter = r.panels[0].height / 4;
        // the outer half of the spike, in the spike's place and nowhere else
        figure_rect here = {spike - 2, sign > 0 ? r.panels[0].y + 6 : middle + quarter, 4,
                            quarter - 6};
        figure_rect left = {r.panels[0].x, here.y, spike - 3 - r.panels[0].x, quarter - 6};
        int most = (int)((quarter - 6) * scale);
        assert_true(coloured_pixels(image, scale, here) >= most - 2);
        assert_int_equal(coloured_pixels(image, scale, left), 0);
        cairo_surface_destroy(image);
    }
    free(x);
    free(y);
}

static void points_that_are_not_finite_leave_a_gap(void **state)
{
    (void)state;
    enum { COUNT = 101 };
    const double bad[] = {(double)NAN, (double)INFINITY, -(double)INFINITY};
    for (int kind = 0; kind < 3; kind++) {
        double x[COUNT], y[COUNT];
        for (int i = 0; i < COUNT; i++) {
            x[i] = i / 100.0;
            y[i] = i > 40 && i < 60 ? bad[kind] : 0.5;
        }
        x[80] = bad[kind];
        figure_series series = {.x = x, .y = y, .count = COUNT, .colour = 5};
        figure_panel panel = {.series = &series, .series_count = 1, .y.low = 0, .y.high = 1};
        figure fig = {.panels = &panel, .panel_count = 1};
        static figure_report r;
        cairo_surface_t *image = paint_pixels(&fig, 2, &r);
        figure_rect p = r.panels[0];
        figure_rect before = {p.x, p.y, 0.39 * p.width, p.height};
        figure_rect gap = {p.x + 0.41 * p.width, p.y, 0.18 * p.width, p.height};
        figure_rect hole = {p.x + 0.792 * p.width, p.y, 0.016 * p.width, p.height};
        assert_true(coloured_pixels(image, 2, before) > 100);
        assert_int_equal(coloured_pixels(image, 2, gap), 0);
        assert_int_equal(coloured_pixels(image, 2, hole), 0);
        cairo_surface_destroy(image);
        expect_tidy(&fig);
    }
}

static void one_lone_point_is_visible(void **state)
{
    (void)state;
    double x[] = {0, 1, 2}, y[] = {(double)NAN, 1, (double)NAN};
    figure_series series = {.x = x, .y = y, .count = 3, .colour = 0};
    figure_panel panel = {.series = &series, .series_count = 1};
    figure fig = {.panels = &panel, .panel_count = 1};
    static figure_report r;
    cairo_surface_t *image = paint_pixels(&fig, 4, &r);
    assert_true(coloured_pixels(image, 4, r.panels[0]) > 4);
    cairo_surface_destroy(image);
}

static void empty_and_hopeless_series_are_drawn_without_fuss(void **state)
{
    (void)state;
    double none[] = {(double)NAN, (double)NAN}, huge[] = {-1e308, 1e308, 0, 1e300};
    double x[] = {0, 0.3, 0.6, 1}, same[] = {2, 2, 2, 2};
    figure_series series[] = {{.x = x, .y = x, .count = 0, .label = "empty"},
                              {.x = none, .y = none, .count = 2, .label = "none"},
                              {.label = "null"},
                              {.x = x, .y = huge, .count = 4},
                              {.x = same, .y = x, .count = 4},
                              {.x = x, .y = same, .count = 4}};
    for (int i = 0; i < 6; i++) {
        figure_panel panel = {
            .series = &series[i], .series_count = 1, .y = {.label = "y", .unit = "N"}};
        figure fig = {.panels = &panel, .panel_count = 1};
        expect_tidy(&fig);
    }
    figure_panel panels[] = {{.series = series, .series_count = 3, .legend = LEGEND_ENDS}, {0}};
    figure fig = {.panels = panels, .panel_count = 2};
    expect_tidy(&fig);
}

// Lines to far away points keep their direction inside the panel and stay out of everything else.
static void far_away_points_are_clipped(void **state)
{
    (void)state;
    double x[] = {0, 0.25, 0.5, 0.75, 1}, y[] = {0.5, 1e12, 0.5, -1e300, 0.5};
    figure_series series = {.x = x, .y = y, .count = 5, .colour = 5};
    figure_panel panel = {.series = &series, .series_count = 1, .y.low = 0, .y.high = 1};
    figure fig = {.panels = &panel, .panel_count = 1};
    static figure_report r;
    cairo_surface_t *image = paint_pixels(&fig, 2, &r);
    figure_rect p = r.panels[0];
    figure_rect centre = {p.x + p.width / 2 - 3, p.y, 6, p.height};
    figure_rect between = {p.x + 0.05 * p.width, p.y, 0.4 * p.width, p.height};
    figure_rect above = {0, 0, r.page.width, p.y - 3};
    assert_true(coloured_pixels(image, 2, centre) > (int)(1.5 * p.height));
    assert_int_equal(coloured_pixels(image, 2, between), 0);
    assert_int_equal(coloured_pixels(image, 2, above), 0);
    cairo_surface_destroy(image);
}

static void legend_and_inset_keep_off_the_data(void **state)
{
    (void)state;
    static figure_report with, without;
    synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    figure *fig = &s.figure.figure;
    record(fig, &with);
    for (int i = 0; i < RUN_PANELS; i++) {
        s.figure.panels[i].legend = LEGEND_NONE;
        s.figure.panels[i].zoom_to = s.figure.panels[i].zoom_from;
    }
    cairo_surface_t *image = paint_pixels(fig, 3, &without);
    for (int i = 0; i < RUN_PANELS; i++) {
        if (with.legends[i].width > 0 && with.legends[i].y > with.panels[i].y) {
            assert_int_equal(coloured_pixels(image, 3, with.legends[i]), 0);
        }
    }
    assert_true(with.legends[1].width > 0);
    assert_true(with.insets[0].width > 0);
    assert_int_equal(coloured_pixels(image, 3, with.insets[0]), 0);
    cairo_surface_destroy(image);
    synthetic_finish(&s);
}

// Data in one corner after the other: the legend has to go elsewhere and stay inside.
static void legend_goes_to_a_free_corner(void **state)
{
    (void)state;
    enum { COUNT = 200 };
    for (int corner = 0; corner < 4; corner++) {
        double x[COUNT], y[COUNT], z[COUNT];
        for (int i = 0; i < COUNT; i++) {
            double t = i / (COUNT - 1.0);
            x[i] = corner % 2 ? -t : t;
            y[i] = (corner / 2 ? -1 : 1) * t * t * (1 + 0.1 * sin(200 * t));
            z[i] = 0.9 * y[i];
        }
        figure_series series[] = {{.x = x, .y = y, .count = COUNT, .label = "one"},
                                  {.x = x, .y = z, .count = COUNT, .label = "two", .colour = 1}};
        figure_panel panel = {.series = series, .series_count = 2};
        figure fig = {.panels = &panel, .panel_count = 1};
        static figure_report r, none;
        record(&fig, &r);
        panel.legend = LEGEND_NONE;
        cairo_surface_t *image = paint_pixels(&fig, 3, &none);
        assert_true(r.legends[0].width > 0);
        expect_inside(&r.legends[0], &r.panels[0], "the legend");
        assert_int_equal(coloured_pixels(image, 3, r.legends[0]), 0);
        cairo_surface_destroy(image);
    }
}

static void legend_leaves_a_full_panel(void **state)
{
    (void)state;
    enum { COUNT = 2000 };
    static double x[COUNT], y[COUNT], z[COUNT];
    for (int i = 0; i < COUNT; i++) {
        x[i] = i;
        y[i] = i % 2 ? 1 : -1;
        z[i] = -y[i];
    }
    figure_series series[] = {{.x = x, .y = y, .count = COUNT, .label = "one"},
                              {.x = x, .y = z, .count = COUNT, .label = "two", .colour = 1}};
    figure_panel panels[] = {{.series = series, .series_count = 2, .zoom_from = 3, .zoom_to = 9},
                             {.series = series, .series_count = 2}};
    figure fig = {.panels = panels, .panel_count = 2};
    static figure_report r;
    record(&fig, &r);
    for (int i = 0; i < 2; i++) {
        assert_true(r.legends[i].width > 0);
        check_below(r.legends[i].y + r.legends[i].height, r.panels[i].y + 0.01);
    }
    assert_true(r.insets[0].width == 0);
    expect_tidy(&fig);
}

static void mono_has_no_colour(void **state)
{
    (void)state;
    static figure_report r;
    synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    cairo_surface_t *colour = paint_pixels(&s.figure.figure, 1.5, &r);
    assert_true(coloured_pixels(colour, 1.5, r.page) > 1000);
    s.figure.figure.theme = THEME_MONO;
    cairo_surface_t *mono = paint_pixels(&s.figure.figure, 1.5, &r);
    for (int y = 0; y < cairo_image_surface_get_height(mono); y++) {
        for (int x = 0; x < cairo_image_surface_get_width(mono); x++) {
            assert_int_equal(saturation(pixel_at(mono, x, y)), 0);
        }
    }
    cairo_surface_destroy(colour);
    cairo_surface_destroy(mono);
    synthetic_finish(&s);
}

// ---- files
// ----------------------------------------------------------------------------------------

static void same_bytes_also_for_later_figures(void **state)
{
    (void)state;
    static const char *const formats[] = {"png", "pdf", "svg"};
    synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    for (int n = 1; n <= 20; n++) {
        for (int i = 0; i < 3; i++) {
            char name[64];
            snprintf(name, sizeof name, "same-%d.%s", n, formats[i]);
            write_figure(&s.figure.figure, path_of(name));
            if (n == 2 || n == 20) {
                char first[64];
                snprintf(first, sizeof first, "same-1.%s", formats[i]);
                expect_same_bytes(path_of(first), path_of(name));
            }
        }
    }
    synthetic_finish(&s);
}

// All bytes of a PDF with its packed streams unpacked behind them.
static GString *unpack_pdf(const char *path)
{
    size_t length;
    char *bytes = read_file(path, &length);
    GString *all = g_string_new_len(bytes, (gssize)length);
    for (size_t at = 0; at + 7 < length; at++) {
        if (memcmp(bytes + at, "stream\n", 7) != 0) {
            continue;
        }
        static unsigned char out[1 << 20];
        z_stream z = {.next_in = (Bytef *)bytes + at + 7,
                      .avail_in = (uInt)(length - at - 7),
                      .next_out = out,
                      .avail_out = sizeof out};
        if (inflateInit(&z) == Z_OK) {
            inflate(&z, Z_FINISH);
            g_string_append_len(all, (const char *)out, (gssize)z.total_out);
            inflateEnd(&z);
        }
    }
    free(bytes);
    return all;
}

static bool contains(const GString *bytes, const char *wanted)
{
    return memmem(bytes->str, bytes->len, wanted, strlen(wanted)) != NULL;
}

static void pdf_embeds_fonts_and_has_no_type_3(void **state)
{
    (void)state;
    synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    write_figure(&s.figure.figure, path_of("fonts.pdf"));
    GString *pdf = unpack_pdf(path_of("fonts.pdf"));
    assert_true(contains(pdf, "/FontFile2"));
    assert_true(contains(pdf, "DejaVuSans"));
    assert_false(contains(pdf, "/Type3"));
    assert_true(contains(pdf, "Synthetic run & <more>"));
    assert_true(contains(pdf, "arm.model=printed"));
    // cairo 1.16 leaves out the D:
    assert_true(contains(pdf, "(20000101") || contains(pdf, "(D:20000101"));
    // curves are lines, not pictures
    assert_false(contains(pdf, "/Subtype /Image"));
    g_string_free(pdf, TRUE);
    synthetic_finish(&s);
}

static void png_knows_its_resolution_and_origin(void **state)
{
    (void)state;
    synthetic s;
    synthetic_init(&s, run_panels, 2);
    s.figure.figure.width = 127;
    s.figure.figure.height = 101.6;
    s.figure.figure.dpi = 300;
    write_figure(&s.figure.figure, path_of("notes.png"));
    FILE *file = fopen(path_of("notes.png"), "rb");
    assert_non_null(file);
    png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_read_info(png, info);
    assert_int_equal(png_get_image_width(png, info), 1500);
    assert_int_equal(png_get_image_height(png, info), 1200);
    assert_int_equal(png_get_pixels_per_meter(png, info), 11811);
    png_textp notes;
    int count = 0, found = 0;
    png_get_text(png, info, &notes, &count);
    for (int i = 0; i < count; i++) {
        found += strcmp(notes[i].key, "Title") == 0 &&
                 strcmp(notes[i].text, "Synthetic run & <more>") == 0;
        found +=
            strcmp(notes[i].key, "Software") == 0 && strncmp(notes[i].text, "impactlab ", 10) == 0;
        found += strcmp(notes[i].key, "Parameters") == 0 &&
                 strstr(notes[i].text, "motor.voltage=1") != NULL;
    }
    assert_int_equal(found, 3);
    png_destroy_read_struct(&png, &info, NULL);
    fclose(file);
    synthetic_finish(&s);
}

static void svg_ids_are_unique_and_all_references_resolve(void **state)
{
    (void)state;
    synthetic s;
    size_t length;
    synthetic_init(&s, run_panels, RUN_PANELS);
    write_figure(&s.figure.figure, path_of("ids.svg"));
    char *svg = read_file(path_of("ids.svg"), &length);
    assert_non_null(strstr(svg, "<metadata>"));
    assert_non_null(strstr(svg, "<title>Synthetic run &amp; &lt;more&gt;</title>"));
    GHashTable *ids = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    for (char *c = strstr(svg, " id=\""); c != NULL; c = strstr(c, " id=\"")) {
        c += 5;
        assert_true(g_hash_table_add(ids, g_strndup(c, strcspn(c, "\""))));
    }
    int references = 0;
    static const char *const openings[] = {"href=\"#", "url(#"};
    for (int kind = 0; kind < 2; kind++) {
        for (char *c = strstr(svg, openings[kind]); c != NULL; c = strstr(c, openings[kind])) {
            c += strlen(openings[kind]);
            char *id = g_strndup(c, strcspn(c, "\")"));
            assert_true(g_hash_table_contains(ids, id));
            g_free(id);
            references++;
        }
    }
    assert_true(references > 100);
    g_hash_table_destroy(ids);
    free(svg);
    synthetic_finish(&s);
}

static void csv_holds_what_is_drawn(void **state)
{
    (void)state;
    double x[] = {0, 0.1, 0.2}, y[] = {1, (double)NAN, -2.5};
    figure_series series = {.name = "force, \"raw\"", .x = x, .y = y, .count = 3};
    figure_impulse impulse = {0.1, 0.04};
    figure_panel panel = {.y = {.name = "force", .unit = "N"},
                          .series = &series,
                          .series_count = 1,
                          .impulses = &impulse,
                          .impulse_count = 1,
                          .impulse_unit = "N s"};
    figure_mark mark = {0.1, "<i>contact</i>"};
    figure fig = {.panels = &panel, .panel_count = 1, .marks = &mark, .mark_count = 1};
    fault f = {0};
    size_t length;
    assert_int_equal(figure_write_csv(&fig, path_of("data.csv"), &f), STATUS_OK);
    char *csv = read_file(path_of("data.csv"), &length);
    assert_string_equal(csv, "panel,series,x,y\n"
                             "force[N],\"force, \"\"raw\"\"\",0,1\n"
                             "force[N],\"force, \"\"raw\"\"\",0.1,\n"
                             "force[N],\"force, \"\"raw\"\"\",0.2,-2.5\n"
                             "force[N],impulse[N s],0.1,0.04\n"
                             "mark,contact,0.1,\n");
    free(csv);
}

static void faults_are_sentences(void **state)
{
    (void)state;
    fault f = {0};
    synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    figure *fig = &s.figure.figure;
    assert_int_equal(figure_write(fig, path_of("x.gif"), &f), STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, ".svg"));
    assert_int_equal(figure_write(fig, path_of("png"), &f), STATUS_BAD_ARGUMENT);
    assert_int_equal(figure_write(fig, path_of("nowhere/x.png"), &f), STATUS_CANNOT_WRITE);
    assert_non_null(strstr(f.text, "nowhere/x.png"));
    fig->dpi = 1e6;
    assert_int_equal(figure_write(fig, path_of("x.png"), &f), STATUS_BAD_ARGUMENT);
    fig->dpi = 0;
    fig->width = 20;
    assert_int_equal(figure_write(fig, path_of("x.png"), &f), STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "larger page"));
    fig->panel_count = 0;
    assert_int_equal(figure_write(fig, path_of("x.pdf"), &f), STATUS_BAD_ARGUMENT);
    // nothing was left behind
    assert_int_not_equal(access(path_of("x.png"), F_OK), 0);
    assert_int_not_equal(access(path_of("x.pdf"), F_OK), 0);
    synthetic_finish(&s);
}

static void a_full_disk_is_noticed(void **state)
{
    (void)state;
    static const char *const names[] = {"full.png", "full.pdf", "full.svg"};
    synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    for (int i = 0; i < 3; i++) {
        fault f = {0};
        assert_int_equal(symlink("/dev/full", path_of(names[i])), 0);
        assert_int_equal(figure_write(&s.figure.figure, path_of(names[i]), &f),
                         STATUS_CANNOT_WRITE);
        assert_true(strlen(f.text) > 10);
    }
    synthetic_finish(&s);
}

// ---- runs and the thesis's figures
// ----------------------------------------------------------------

static void ignore(void *context, const char *sentence)
{
    (void)context;
    (void)sentence;
}

static void a_scenario_is_plotted(void **state)
{
    (void)state;
    fault f = {0};
    scenario s;
    run_result result;
    assert_int_equal(scenario_open(&s, "corrected/first-impact", ignore, NULL), STATUS_OK);
    assert_int_equal(run_scenario(&s, true, &result), STATUS_OK);
    assert_int_equal(plot_run(&s, &result, path_of("run.png"), &f), STATUS_OK);
    assert_int_equal(access(path_of("run.png"), F_OK), 0);
    run_finish(&result);
    // a run without rows still says what it is
    memset(&result, 0, sizeof result);
    result.summary.first_contact_s = (double)NAN;
    result.summary.status = STATUS_NOT_FINITE;
    strcpy(result.summary.message, "at t = 0 s: <nothing>");
    assert_int_equal(plot_run(&s, &result, path_of("none.pdf"), &f), STATUS_OK);
    scenario_finish(&s);
}

// ---------------------------------------------------------------------------------------------------

static int make_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/impactlab-plot-XXXXXX");
    return mkdtemp(folder) == NULL;
}

static int remove_folder(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    text_release();
    return system(command) != 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(missing_font_is_reported),
        cmocka_unit_test(indices_are_small_and_scale_with_the_letters),
        cmocka_unit_test(markup_that_is_none_is_shown_as_it_stands),
        cmocka_unit_test(units_are_set_as_the_si_brochure_has_them),
        cmocka_unit_test(all_texts_of_a_run_are_drawn),
        cmocka_unit_test(nothing_is_clipped_or_covered),
        cmocka_unit_test(many_marks_and_impulses_stay_readable),
        cmocka_unit_test(layout_is_the_same_on_every_surface),
        cmocka_unit_test(impulses_do_not_touch_the_force_axis),
        cmocka_unit_test(a_spike_of_one_sample_is_visible),
        cmocka_unit_test(points_that_are_not_finite_leave_a_gap),
        cmocka_unit_test(one_lone_point_is_visible),
        cmocka_unit_test(empty_and_hopeless_series_are_drawn_without_fuss),
        cmocka_unit_test(far_away_points_are_clipped),
        cmocka_unit_test(legend_and_inset_keep_off_the_data),
        cmocka_unit_test(legend_goes_to_a_free_corner),
        cmocka_unit_test(legend_leaves_a_full_panel),
        cmocka_unit_test(mono_has_no_colour),
        cmocka_unit_test(same_bytes_also_for_later_figures),
        cmocka_unit_test(pdf_embeds_fonts_and_has_no_type_3),
        cmocka_unit_test(png_knows_its_resolution_and_origin),
        cmocka_unit_test(svg_ids_are_unique_and_all_references_resolve),
        cmocka_unit_test(csv_holds_what_is_drawn),
        cmocka_unit_test(faults_are_sentences),
        cmocka_unit_test(a_full_disk_is_noticed),
        cmocka_unit_test(a_scenario_is_plotted),
    };
    return cmocka_run_group_tests_name("plot", tests, make_folder, remove_folder) != 0;
}
