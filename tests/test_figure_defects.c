// Former defects of figures that a program can detect.
#include "tests/plot_fixture.h"

#include "render/page/palette.h"
#include "render/plot/curve.h"
#include "render/plot/study_plot.h"

TEST(the_last_of_twenty_links_is_body_21)
{
    static figure_report r;
    SCOPED(synthetic_finish) synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    const trace_run run = {&s.scenario, &s.result, NULL};
    trace_figure_finish(&s.figure);
    s.scenario.parameters.arm.links = 20;
    DONE(trace_figure_init(&s.figure, NULL, run_panels, RUN_PANELS, &run, 1, &f));
    record(&s.figure.plot.figure, &r);
    expect_text(&r, "\u03b821  last link");
    assert_false(has_text(&r, "\u03b83  last link"));
}

// The peak lies between two rows: the mark's force must be among the drawn.
TEST(the_peak_is_on_the_curve)
{
    SCOPED(synthetic_finish) synthetic s;
    synthetic_init(&s, run_panels, RUN_PANELS);
    const trace_run run = {&s.scenario, &s.result, NULL};
    trace_figure_finish(&s.figure);
    s.result.summary.first_pulse_peak_N = 2.125;
    s.result.summary.first_pulse_time_to_peak_s = 0.0354;
    DONE(trace_figure_init(&s.figure, NULL, run_panels, RUN_PANELS, &run, 1, &f));
    const figure_series *force = &s.figure.plot.panels[0].series[0];
    bool found = false;
    double before = -1;
    for (size_t i = 0; i < force->count; i++) {
        found = found || (series_y(force, i) == 2.125 && fabs(series_x(force, i) - 0.3454) < 1e-12);
        assert_true(series_x(force, i) >= before);
        before = series_x(force, i);
    }
    assert_true(found);
    assert_int_equal(force->count, s.result.trace.row_count + 1);
}

// ---- labels of marks

// The text of a mark as it was drawn, with an arrow or not; fails if it is not there.
static const figure_text *text_of_mark(const figure_report *r, const figure_mark *m)
{
    char *wanted = text_plain(m->label);
    const figure_text *found = NULL;
    for (int i = 0; i < r->text_count; i++) {
        found = g_str_has_prefix(r->texts[i].text, wanted) ? &r->texts[i] : found;
    }
    fail_if(found == NULL, "'%s' is not drawn", wanted);
    g_free(wanted);
    return found;
}

// Draws a shipped scenario at both widths, from a time on and to another one, and looks at each
// mark.
static void check_labels(const char *name, double from, double to,
                         void (*check)(const figure_mark *m, const figure_text *t, double x,
                                       double y))
{
    SCOPED(scenario_finish) scenario s = shipped(name);
    SCOPED(run_finish) run_result result;
    assert_int_equal(run_scenario(&s, true, &result), STATUS_OK);
    const trace_run run = {&s, &result, NULL};
    for (int narrow = 0; narrow < 2; narrow++) {
        static figure_report r;
        static trace_figure t;
        assert_int_equal(trace_figure_init(&t, NULL, usual_panels, USUAL_PANELS, &run, 1, NULL),
                         STATUS_OK);
        t.plot.figure.width = narrow ? 85 : 170;
        t.plot.figure.x.low = from;
        t.plot.figure.x.high = to;
        record(&t.plot.figure, &r);
        expect_tidy(&t.plot.figure);
        assert_true(t.plot.figure.mark_count > 0);
        for (int i = 0; i < t.plot.figure.mark_count; i++) {
            const figure_mark *m = &t.plot.figure.marks[i];
            const figure_range *range = &r.ranges[0];
            const figure_rect *box = &r.panels[0];
            if (m->x < range->x_low || m->x > range->x_high) {
                continue;
            }
            check(m, text_of_mark(&r, m),
                  box->x + box->width * (m->x - range->x_low) / (range->x_high - range->x_low),
                  box->y + box->height * (range->y_high - m->y) / (range->y_high - range->y_low));
        }
        trace_figure_finish(&t);
    }
}

static int arrows;

static void check_mode(const figure_mark *m, const figure_text *t, double x, double y)
{
    (void)m;
    (void)y;
    const bool arrow = g_str_has_suffix(t->text, "\u2192");
    arrows += arrow;
    assert_true(arrow ? t->place.x + t->place.width < x : t->place.x > x);
}

// What begins at a line stands on that side of it, or points there where the page ends.
TEST(labels_of_modes_stand_where_the_mode_is)
{
    check_labels("compare/hybrid", 0, 0, check_mode);
    check_labels("compare/bang-bang", 0, 0, check_mode);
    check_labels("compare/reverse-torque", 0, 0, check_mode);
    assert_int_equal(arrows, 0);
    check_labels("compare/hybrid", 0.2, 0.66, check_mode);
    assert_int_equal(arrows, 2);
}

static void check_peak(const figure_mark *m, const figure_text *t, double x, double y)
{
    if (!g_str_has_prefix(m->label, "peak")) {
        return;
    }
    const figure_rect *r = &t->place;
    const double across = fmax(0, fmax(r->x - x, x - r->x - r->width));
    const double down = fmax(0, fmax(r->y - y, y - r->y - r->height));
    check_below(hypot(across, down), 5);
}

// Wherever there is room for a word; no text meets another, not in the insets of short pulses
// either.
TEST(the_label_of_the_peak_stands_at_its_point)
{
    for (EACH_TEXT(c, "corrected/first-impact", "corrected/stiff-beam", "corrected/five-links",
                   "corrected/spring-hub", "corrected/plane-wall", "corrected/fast-impact",
                   "thesis/fig-3-4")) {
        check_labels(*c, 0, 0, check_peak);
    }
}

TEST(quantities_have_the_same_digits)
{
    static const struct {
        double value;
        const char *shown;
    } cases[] = {{5.4, "5.40\u2009N"},
                 {1.752, "1.75\u2009N"},
                 {12, "12.0\u2009N"},
                 {123, "123\u2009N"},
                 {-0.5, "\u22120.500\u2009N"}};
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        char *shown = text_quantity(cases[i].value, 3, "N");
        assert_string_equal(shown, cases[i].shown);
        g_free(shown);
    }
}

// However narrow the page, no line begins with what belongs to the end of the one before.
TEST(numbers_keep_their_units)
{
    const char *caption = "At 1 V and 10 ms, <i>β</i> = 0.4, <i>h</i> = 10\u2009ms, a peak of "
                          "5.40\u2009N after 12.5 ms, <i>k</i><sub>1</sub> = 0.4 at "
                          "4.92\u2009N·m/rad, 3\u2009V·s/rad. impactlab 0.1.0.";
    PangoContext *context = text_context_create();
    for (double width = 60; width < 300; width += 7) {
        PangoLayout *layout = text_layout_create(
            context, &(text_block){.markup = caption, .size = 8, .width = width});
        const char *text = pango_layout_get_text(layout);
        for (int i = 1; i < pango_layout_get_line_count(layout); i++) {
            const char *line =
                text + pango_layout_line_get_start_index(pango_layout_get_line_readonly(layout, i));
            for (EACH_TEXT(c, "V", "ms", "= ", "=\u00a0", "rad", "0.4", "N", "0.1.0", "10 ms,")) {
                fail_if(strncmp(line, *c, strlen(*c)) == 0,
                        "at %g points a line begins with '%.12s'", width, line);
            }
        }
        g_object_unref(layout);
    }
    g_object_unref(context);
}

// An index can be read where it is printed, however the page of a diagram is scaled: its letters
// have 6 points there, or those of the text about it.
TEST(indices_can_be_read_on_scaled_pages)
{
    PangoContext *context = text_context_create();
    for (EACH_OF(double, c, 0.65, 1, 1.38)) {
        const text_block t = {.markup = "<sub>2</sub>", .size = 8 / *c, .scale = *c};
        PangoLayout *layout = text_layout_create(context, &t);
        PangoLayoutRun *run = pango_layout_get_line_readonly(layout, 0)->runs->data;
        PangoFontDescription *font = pango_font_describe(run->item->analysis.font);
        check_close(*c * pango_font_description_get_size(font) / PANGO_SCALE, 6, 0.01);
        pango_font_description_free(font);
        g_object_unref(layout);
    }
    g_object_unref(context);
}

// A title of two lines ends with more than a word, and lines are as far apart with an exponent in
// one of them as without.
TEST(lines_are_even)
{
    PangoContext *context = text_context_create();
    double widths[2], plain, raised, width;
    text_block title = {.markup = "Optical encoder under a constant 1 V",
                        .size = 9,
                        .width = 166,
                        .balanced = true};
    PangoLayout *layout = text_layout_create(context, &title);
    assert_int_equal(pango_layout_get_line_count(layout), 2);
    for (int i = 0; i < 2; i++) {
        PangoRectangle logical;
        pango_layout_line_get_extents(pango_layout_get_line_readonly(layout, i), NULL, &logical);
        widths[i] = logical.width;
    }
    check_close(widths[1] / widths[0], 1, 0.35);
    g_object_unref(layout);

    text_measure(context, &(text_block){.markup = "one\ntwo\nthree", .size = 8}, &width, &plain);
    text_measure(context, &(text_block){.markup = "one\n10<sup>−5</sup>\nthree", .size = 8}, &width,
                 &raised);
    check_close(raised, plain, 0.01);
    g_object_unref(context);
}

TEST(apostrophes_are_the_printers)
{
    static const char *const cases[][2] = {{"Newmark's", "Newmark\u2019s"},
                                           {"Newmark&apos;s", "Newmark\u2019s"},
                                           {"Newmark&#39;s", "Newmark\u2019s"},
                                           {"named 'a'", "named 'a'"}};
    for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
        char *shown = text_translate(cases[i][0], 8, 1);
        assert_string_equal(shown, cases[i][1]);
        g_free(shown);
    }
}

// A curve that is cut by the axis begins at it: no colour left of it.
TEST(curves_begin_at_the_axis)
{
    static figure_report r;
    double x[] = {0, 1, 2, 3}, y[] = {1, 1.2, 1.1, 1.4};
    figure_series series = {.x = x, .y = y, .count = 4};
    figure_panel panel = {.series = &series, .series_count = 1};
    figure fig = {.panels = &panel, .panel_count = 1, .x = {.low = 0.5, .high = 2.5}, .width = 100};
    const double scale = 4;
    cairo_surface_t *surface = paint_pixels(&fig, scale, &r);
    const figure_rect *box = &r.panels[0];
    figure_rect left = {box->x - 6, box->y, 5.7, box->height};
    figure_rect right = {box->x + box->width + 0.3, box->y, 4, box->height};
    assert_int_equal(coloured_pixels(surface, scale, left), 0);
    assert_int_equal(coloured_pixels(surface, scale, right), 0);
    assert_true(coloured_pixels(surface, scale, *box) > 100);
    cairo_surface_destroy(surface);
}

enum { STAIRS = 1200 };

// Pixels of a grey between black and the page's own greys in the legend's swatch.
TEST(a_busy_line_has_no_dashes)
{
    static figure_report r;
    static double x[STAIRS], stairs[STAIRS], smooth[STAIRS];
    for (int i = 0; i < STAIRS; i++) {
        x[i] = i;
        smooth[i] = 10;
        stairs[i] = 10 + (i / 4 % 2 ? 1 : -1);
    }
    figure_series series[] = {
        {.label = "stairs", .x = x, .y = stairs, .count = STAIRS, .style = LINE_DASHED},
        {.label = "smooth", .x = x, .y = smooth, .count = STAIRS}};
    figure_panel panel = {.series = series, .series_count = 2, .y = {.low = 0, .high = 30}};
    figure fig = {.panels = &panel, .panel_count = 1, .theme = THEME_MONO};
    const double scale = 6;
    cairo_surface_t *surface = paint_pixels(&fig, scale, &r);

    // the first entry's swatch: an unbroken line, lighter than the second one's
    const figure_rect *legend = &r.legends[0];
    assert_true(legend->width > 0);
    int lightness[2];
    for (int entry = 0; entry < 2; entry++) {
        double y = legend->y + legend->height / 2 * (entry + 0.55);
        int lightest = 0;
        for (double along = 2; along < 16; along += 0.25) {
            int darkest = 255;
            for (double off = -2; off <= 2; off += 0.25) {
                pixel p =
                    pixel_at(surface, (int)((legend->x + along) * scale), (int)((y + off) * scale));
                darkest = p.red < darkest ? p.red : darkest;
            }
            lightest = darkest > lightest ? darkest : lightest;
        }
        lightness[entry] = lightest;
    }
    assert_true(lightness[0] < 200);
    assert_true(lightness[1] < 40);
    assert_true(lightness[0] > lightness[1] + 60);
    cairo_surface_destroy(surface);
}

TEST(a_map_without_colours_is_grey)
{
    static figure_report r;
    double x[] = {0, 1, 2}, y[] = {0, 1}, z[] = {1, 2, 3, 4, 5, 6};
    figure_map map = {.x = x, .y = y, .columns = 3, .rows = 2, .z = z, .contours = true};
    figure_colours colours = {.axis = {.label = "z"}, .bar = true};
    figure_panel panel = {.map = &map, .colours = &colours};
    figure fig = {.panels = &panel, .panel_count = 1, .theme = THEME_MONO};
    cairo_surface_t *surface = paint_pixels(&fig, 1.5, &r);
    for (int j = 0; j < cairo_image_surface_get_height(surface); j++) {
        for (int i = 0; i < cairo_image_surface_get_width(surface); i++) {
            assert_int_equal(saturation(pixel_at(surface, i, j)), 0);
        }
    }
    cairo_surface_destroy(surface);
}

// The CSV of a figure is headed by the axes' names and units.
TEST(numbers_have_names_and_units)
{
    size_t length;
    double x[] = {0, 1};
    figure_series series = {.name = "run", .x = x, .y = x, .count = 2};
    figure_panel panels[2] = {
        {.y = {.name = "force", .unit = "N"}, .series = &series, .series_count = 1},
        {.y = {.name = "angle", .unit = "rad"}, .series = &series, .series_count = 1}};
    figure fig = {.x = {.name = "time", .unit = "s"}, .panels = panels, .panel_count = 1};
    DONE(figure_write_csv(&fig, "one.csv", &f));
    SCOPED(free_kept) char *csv = read_file("one.csv", &length);
    assert_ptr_equal(strstr(csv, "panel,series,time[s],force[N]\n"), csv);
    free(csv);
    fig.panel_count = 2;
    DONE(figure_write_csv(&fig, "two.csv", &f));
    csv = read_file("two.csv", &length);
    assert_ptr_equal(strstr(csv, "panel,series,time[s],value\n"), csv);
    assert_non_null(strstr(csv, "\nangle[rad],run,1,1\n"));
}

// A legend that found no room inside stands above the panel's heading, not over it.
TEST(a_legend_keeps_off_the_heading)
{
    static figure_report r;
    enum { POINTS = 60, CURVES = 3 };
    double x[POINTS], y[CURVES][POINTS];
    figure_series series[CURVES];
    for (int k = 0; k < CURVES; k++) {
        for (int i = 0; i < POINTS; i++) {
            x[i] = i;
            y[k][i] = (i + k) % 2 ? 1 : -1;
        }
        series[k] = (figure_series){.label = "a curve", .x = x, .y = y[k], .count = POINTS};
    }
    figure_panel panel = {.heading = "heading", .series = series, .series_count = CURVES};
    figure fig = {.panels = &panel, .panel_count = 1, .width = 60};
    record(&fig, &r);
    for (int i = 0; i < r.text_count; i++) {
        for (int k = 0; k < i; k++) {
            assert_false(overlap(&r.texts[i].place, &r.texts[k].place));
        }
        if (strcmp(r.texts[i].text, "heading") == 0) {
            check_below(r.legends[0].y + r.legends[0].height, r.texts[i].place.y + 2);
        }
    }
}

// Upright lines of the page: columns of pixels that are dark all the way along a third of it, those
// beside each other taken for one.
static int count_uprights(cairo_surface_t *surface)
{
    int width = cairo_image_surface_get_width(surface), count = 0;
    int height = cairo_image_surface_get_height(surface);
    bool before = false;
    for (int x = 0; x < width; x++) {
        int run = 0, longest = 0;
        for (int y = 0; y < height; y++) {
            pixel p = pixel_at(surface, x, y);
            run = p.red + p.green + p.blue < 3 * 150 && saturation(p) < 30 ? run + 1 : 0;
            longest = run > longest ? run : longest;
        }
        bool upright = 3 * longest > height;
        count += upright && !before;
        before = upright;
    }
    return count;
}

// Paints a sweep of a quantity that grows from run to run.
static cairo_surface_t *paint_sweep(const char *one, const char *other, figure_report *r)
{
    static char name[] = "test";
    char *vary[] = {(char *)one, (char *)other};
    scenario base = {.name = name};
    parameters_defaults(&base.parameters, ARM_CORRECTED);
    sweep_request request = {.vary = vary, .vary_count = other != NULL ? 2 : 1};
    SCOPED(sweep_finish) sweep s;
    DONE(sweep_init(&s, &base, &request, &f));
    double values[64];
    assert_true(s.run_count <= 64);
    for (size_t i = 0; i < s.run_count; i++) {
        values[i] = 1 + 0.1 * (double)i;
    }
    const sweep_picture shown = {.sweep = &s, .key = "peak_force_N", .values = values};
    owned_figure *drawn = sweep_figure_create(&shown);
    cairo_surface_t *surface = paint_pixels(&drawn->figure, 2, r);
    owned_figure_destroy(drawn);
    return surface;
}

// Sweeps and errors over costs have two axes and no box round them, as recorded signals do.
TEST(all_plots_have_axes_of_one_style)
{
    static figure_report r;
    double x[] = {0.01, 0.1, 1, 10}, y[] = {1, 3, 20, 50};
    figure_series series = {.x = x, .y = y, .count = 4, .marker = MARKER_CIRCLE};
    figure_panel panel = {.y = {.scale = SCALE_LOGARITHMIC}, .series = &series, .series_count = 1};
    figure study = {.panels = &panel,
                    .panel_count = 1,
                    .x = {.label = "x", .scale = SCALE_LOGARITHMIC},
                    .width = 100,
                    .height = 80};
    figure signals = {.panels = &panel, .panel_count = 1, .x = {.label = "x"}, .width = 100};
    cairo_surface_t *pictures[] = {paint_sweep("motor.voltage=1:2:6", NULL, &r),
                                   paint_pixels(&study, 2, &r), paint_pixels(&signals, 2, &r)};
    for (size_t i = 0; i < G_N_ELEMENTS(pictures); i++) {
        assert_int_equal(count_uprights(pictures[i]), 1);
        cairo_surface_destroy(pictures[i]);
    }
}

// A number over a list of words is a line for each word, and no map with colours between them.
TEST(words_are_lines_not_colours)
{
    static figure_report r;
    cairo_surface_t *surface =
        paint_sweep("motor.voltage=1:2:6", "method.name=event,newmark,generalized-alpha", &r);
    colour darkest = palette_shade(THEME_COLOUR, 0);
    for (int y = 0; y < cairo_image_surface_get_height(surface); y++) {
        for (int x = 0; x < cairo_image_surface_get_width(surface); x++) {
            pixel p = pixel_at(surface, x, y);
            double off = fabs(p.red - 255 * darkest.red) + fabs(p.green - 255 * darkest.green) +
                         fabs(p.blue - 255 * darkest.blue);
            assert_true(off > 12);
        }
    }
    for (EACH_TEXT(c, "event", "newmark", "generalized-alpha")) {
        expect_text(&r, *c);
    }
    cairo_surface_destroy(surface);
}

ALL_BETWEEN(enter_folder, leave_plot_folder)
