// Figures, judged by their drawing: texts and their places, pixels.
#include "tests/plot_fixture.h"
#include "render/plot/run_style.h"

TEST(all_texts_of_a_run_are_drawn)
{
    static figure_report r;
    SYNTHETIC(s, run_panels, RUN_PANELS);
    record(&s.plot->figure, &r);
    for (EACH_TEXT(c, "Synthetic run & <more>", "Time t (s)", "Contact force f (N)",
                   "Angle (rad)", "Angular velocity (rad\u2060/\u2060s)", "\u03b81  hub",
                   "\u03b83  last link", "wall", "contact", "peak 2.10\u2009N", "release",
                   "Impulse\n(N\u00b7s)", "0.044", "0.009", "\u22120.4", "0.4")) {
        expect_text(&r, *c);
    }
    assert_int_equal(r.panel_count, RUN_PANELS);
    assert_true(r.insets[0].width > 0);
    assert_true(r.insets[1].width == 0);
}

TEST(nothing_is_clipped_or_covered)
{
    for (EACH_OF(double, c, 0, 85, 120, 260)) {
        for (int theme = THEME_COLOUR; theme <= THEME_DARK; theme++) {
            SYNTHETIC(s, run_panels, RUN_PANELS);
            s.plot->figure.width = *c;
            s.plot->figure.theme = theme;
            expect_tidy(&s.plot->figure);
        }
    }
}

TEST(many_marks_and_impulses_stay_readable)
{
    static figure_mark marks[60];
    static figure_impulse impulses[300];
    for (int i = 0; i < 60; i++) {
        marks[i] = (figure_mark){i < 5 ? 0.5 : i / 59.0, "event"};
    }
    for (int i = 0; i < 300; i++) {
        impulses[i] =
            (figure_impulse){0.3 + 0.5 * i / 299.0, i % 7 == 0 ? 1e-5 : 0.01 / (1 + i)};
    }
    SYNTHETIC(s, run_panels, RUN_PANELS);
    s.plot->figure.marks = marks;
    s.plot->figure.mark_count = 60;
    s.plot->panels[0].impulses = impulses;
    s.plot->panels[0].impulse_count = 300;
    expect_tidy(&s.plot->figure);
}

TEST(layout_is_the_same_on_every_surface)
{
    static figure_report reference, other;
    SYNTHETIC(s, run_panels, RUN_PANELS);
    record(&s.plot->figure, &reference);
    for (double scale = 1; scale < 4; scale += 0.77) {
        cairo_surface_destroy(paint_pixels(&s.plot->figure, scale, &other));
        assert_int_equal(other.text_count, reference.text_count);
        for (int i = 0; i < reference.text_count; i++) {
            assert_string_equal(other.texts[i].text, reference.texts[i].text);
            check_close(other.texts[i].place.x, reference.texts[i].place.x, 1e-6);
            check_close(other.texts[i].place.y, reference.texts[i].place.y, 1e-6);
            check_close(other.texts[i].place.width, reference.texts[i].place.width, 1e-6);
        }
    }
}

// A run with one impulse of a size, as pixels of a quarter of a point.
enum { FINE = 4 };

static cairo_surface_t *paint_impulse(double size, figure_report *r)
{
    SYNTHETIC(s, run_panels, 1);
    s.plot->panels[0].impulses = &(figure_impulse){0.31, size};
    s.plot->panels[0].impulse_count = 1;
    return paint_pixels(&s.plot->figure, FINE, r);
}

// An impulse has no place on the force axis: a huge one changes nothing there.
TEST(impulses_do_not_touch_the_force_axis)
{
    static figure_report r;
    cairo_surface_destroy(paint_impulse(5000, &r));
    expect_text(&r, "2");
    expect_inside(&r.panels[0], &r.page, "the panel");
    check_below(bottom_of(expect_text(&r, "5\u00b7103")), r.panels[0].y + 1);
}

// The unit of small impulses, a power of ten and all, is wider than their name: it has
// its place. Its raised exponent does not reach the letters of the name above: an empty
// row is between them.
TEST(the_unit_of_small_impulses_has_its_place)
{
    static figure_report r;
    enum { DARK = 128 };
    PIXELS(image) = paint_impulse(4.02e-3, &r);
    expect_text(&r, "4.02");

    // lines of letters, counted down the text's place
    int lines = 0;
    for (int i = 0; i < r.text_count; i++) {
        const figure_rect p = r.texts[i].place;
        bool inked = false;
        expect_inside(&p, &r.page, r.texts[i].text);
        for (int y = (int)(FINE * p.y);
             strstr(r.texts[i].text, "Impulse") != NULL && y < FINE * (p.y + p.height);
             y++) {
            bool ink = false;
            for (int x = (int)(FINE * p.x); x < FINE * (p.x + p.width); x++) {
                ink = ink || pixel_at(image, x, y).green < DARK;
            }
            lines += ink && !inked;
            inked = ink;
        }
    }
    assert_int_equal(lines, 2);
}

// ---- curves

TEST(a_spike_of_one_sample_is_visible)
{
    enum { COUNT = 100000, SPIKE = 50003 };
    SCOPED(free_kept) double *x = calloc(COUNT, sizeof *x), *y = calloc(COUNT, sizeof *y);
    assert_non_null(x);
    assert_non_null(y);
    for (int i = 0; i < COUNT; i++) {
        x[i] = (double)i / COUNT;
    }
    for (int sign = -1; sign <= 1; sign += 2) {
        y[SPIKE] = sign;
        figure_series series = {.x = x, .y = y, .count = COUNT, .colour = 5};
        figure_panel panel = {.series = &series,
                              .series_count = 1,
                              .y.low = -1.1,
                              .y.high = 1.1};
        figure fig = {.panels = &panel, .panel_count = 1, .width = 100, .dpi = 100};
        static figure_report r;
        record(&fig, &r);
        write_figure(&fig, "spike.png");
        PIXELS(image) = cairo_image_surface_create_from_png("spike.png");
        assert_int_equal(cairo_surface_status(image), CAIRO_STATUS_SUCCESS);
        double scale = 100.0 / 72, middle = r.panels[0].y + r.panels[0].height / 2;
        double spike = r.panels[0].x + r.panels[0].width * x[SPIKE] / x[COUNT - 1];
        double quarter = r.panels[0].height / 4;
        // the outer half of the spike, in the spike's place and nowhere else
        figure_rect here = {spike - 2, sign > 0 ? r.panels[0].y + 6 : middle + quarter, 4,
                            quarter - 6};
        figure_rect left = {r.panels[0].x, here.y, spike - 3 - r.panels[0].x,
                            quarter - 6};
        int most = (int)((quarter - 6) * scale);
        assert_true(coloured_pixels(image, scale, here) >= most - 2);
        assert_int_equal(coloured_pixels(image, scale, left), 0);
    }
}

TEST(points_that_are_not_finite_leave_a_gap)
{
    enum { COUNT = 101 };
    for (EACH_OF(double, c, (double)NAN, (double)INFINITY, -(double)INFINITY)) {
        double x[COUNT], y[COUNT];
        for (int i = 0; i < COUNT; i++) {
            x[i] = i / 100.0;
            y[i] = i > 40 && i < 60 ? *c : 0.5;
        }
        x[80] = *c;
        figure_series series = {.x = x, .y = y, .count = COUNT, .colour = 5};
        figure_panel panel = {.series = &series,
                              .series_count = 1,
                              .y.low = 0,
                              .y.high = 1};
        figure fig = {.panels = &panel, .panel_count = 1};
        static figure_report r;
        PIXELS(image) = paint_pixels(&fig, 2, &r);
        figure_rect p = r.panels[0];
        figure_rect before = {p.x, p.y, 0.39 * p.width, p.height};
        figure_rect gap = {p.x + 0.41 * p.width, p.y, 0.18 * p.width, p.height};
        figure_rect hole = {p.x + 0.792 * p.width, p.y, 0.016 * p.width, p.height};
        assert_true(coloured_pixels(image, 2, before) > 100);
        assert_int_equal(coloured_pixels(image, 2, gap), 0);
        assert_int_equal(coloured_pixels(image, 2, hole), 0);
        expect_tidy(&fig);
    }
}

TEST(one_lone_point_is_visible)
{
    double x[] = {0, 1, 2}, y[] = {(double)NAN, 1, (double)NAN};
    figure_series series = {.x = x, .y = y, .count = 3, .colour = 0};
    figure_panel panel = {.series = &series, .series_count = 1};
    figure fig = {.panels = &panel, .panel_count = 1};
    static figure_report r;
    PIXELS(image) = paint_pixels(&fig, 4, &r);
    assert_true(coloured_pixels(image, 4, r.panels[0]) > 4);
}

TEST(empty_and_hopeless_series_are_drawn_without_fuss)
{
    double none[] = {(double)NAN, (double)NAN}, huge[] = {-1e308, 1e308, 0, 1e300};
    double x[] = {0, 0.3, 0.6, 1}, same[] = {2, 2, 2, 2};
    figure_series series[] = {{.x = x, .y = x, .count = 0, .label = "empty"},
                              {.x = none, .y = none, .count = 2, .label = "none"},
                              {.label = "null"},
                              {.x = x, .y = huge, .count = 4},
                              {.x = same, .y = x, .count = 4},
                              {.x = x, .y = same, .count = 4}};
    for (int i = 0; i < 6; i++) {
        figure_panel panel = {.series = &series[i],
                              .series_count = 1,
                              .y = {.label = "y", .unit = "N"}};
        figure fig = {.panels = &panel, .panel_count = 1};
        expect_tidy(&fig);
    }
    figure_panel panels[] = {{.series = series, .series_count = 3}, {0}};
    figure fig = {.panels = panels, .panel_count = 2};
    expect_tidy(&fig);
}

// Lines to far away points keep their direction inside the panel and stay out of
// everything else.
TEST(far_away_points_are_clipped)
{
    double x[] = {0, 0.25, 0.5, 0.75, 1}, y[] = {0.5, 1e12, 0.5, -1e300, 0.5};
    figure_series series = {.x = x, .y = y, .count = 5, .colour = 5};
    figure_panel panel = {.series = &series, .series_count = 1, .y.low = 0, .y.high = 1};
    figure fig = {.panels = &panel, .panel_count = 1};
    static figure_report r;
    PIXELS(image) = paint_pixels(&fig, 2, &r);
    figure_rect p = r.panels[0];
    figure_rect centre = {p.x + p.width / 2 - 3, p.y, 6, p.height};
    figure_rect between = {p.x + 0.05 * p.width, p.y, 0.4 * p.width, p.height};
    figure_rect above = {0, 0, r.page.width, p.y - 3};
    assert_true(coloured_pixels(image, 2, centre) > (int)(1.5 * p.height));
    assert_int_equal(coloured_pixels(image, 2, between), 0);
    assert_int_equal(coloured_pixels(image, 2, above), 0);
}

// Whatever is asked for, an inset enlarges twice or more, or the figure fails: so does
// one of its own, which is left out instead.
TEST(an_inset_enlarges_at_least_twice)
{
    static figure_report r;
    int shown = 0, refused = 0, left_out = 0;
    for (EACH_OF(double, width, 85, 120, 180, 300)) {
        for (double length = 0.02; length < 0.5; length *= 1.5) {
            for (int asked = 0; asked < 2; asked++) {
                SYNTHETIC(s, run_panels, 2);
                s.plot->figure.width = *width;
                s.plot->panels[0].zoom_from = 0.31;
                s.plot->panels[0].zoom_to = 0.31 + length;
                s.plot->panels[0].zoom_asked = asked == 1;
                SCOPED(artwork_finish) artwork a = artwork_of_figure(&s.plot->figure);
                fault f = {0};
                cairo_surface_t *surface =
                    cairo_recording_surface_create(CAIRO_CONTENT_COLOR, NULL);
                cairo_t *cr = cairo_create(surface);
                const status code = artwork_paint(&a, cr, &r, &f);
                cairo_destroy(cr);
                cairo_surface_destroy(surface);
                if (code != STATUS_OK) {
                    assert_int_equal(code, STATUS_BAD_ARGUMENT);
                    assert_non_null(strstr(f.text, "expected a shorter stretch"));
                    assert_int_equal(asked, 1);
                    refused++;
                } else if (r.insets[0].width > 0) {
                    // the inset with its labels is larger than what it shows
                    const double range = r.ranges[0].x_high - r.ranges[0].x_low;
                    assert_true(r.insets[0].width / length >=
                                2 * r.panels[0].width / range);
                    shown++;
                } else {
                    left_out++;
                }
            }
        }
    }
    assert_true(shown > 8 && refused > 4 && left_out > 4);
}

TEST(legend_and_inset_keep_off_the_data)
{
    static figure_report with, without;
    SYNTHETIC(s, run_panels, RUN_PANELS);
    figure *fig = &s.plot->figure;
    record(fig, &with);
    for (int i = 0; i < RUN_PANELS; i++) {
        s.plot->panels[i].keyless = true;
        s.plot->panels[i].zoom_to = s.plot->panels[i].zoom_from;
    }
    PIXELS(image) = paint_pixels(fig, 3, &without);
    for (int i = 0; i < RUN_PANELS; i++) {
        if (with.legends[i].width > 0 && with.legends[i].y > with.panels[i].y) {
            assert_int_equal(coloured_pixels(image, 3, with.legends[i]), 0);
        }
    }
    assert_true(with.legends[1].width > 0);
    assert_true(with.insets[0].width > 0);
    assert_int_equal(coloured_pixels(image, 3, with.insets[0]), 0);
}

// Data in one corner after the other: the legend has to go elsewhere and stay inside.
TEST(legend_goes_to_a_free_corner)
{
    enum { COUNT = 200 };
    for (int corner = 0; corner < 4; corner++) {
        double x[COUNT], y[COUNT], z[COUNT];
        for (int i = 0; i < COUNT; i++) {
            double t = i / (COUNT - 1.0);
            x[i] = corner % 2 ? -t : t;
            y[i] = (corner / 2 ? -1 : 1) * t * t * (1 + 0.1 * sin(200 * t));
            z[i] = 0.9 * y[i];
        }
        figure_series series[] = {
            {.x = x, .y = y, .count = COUNT, .label = "one"},
            {.x = x, .y = z, .count = COUNT, .label = "two", .colour = 1}};
        figure_panel panel = {.series = series, .series_count = 2};
        figure fig = {.panels = &panel, .panel_count = 1};
        static figure_report r, none;
        record(&fig, &r);
        panel.keyless = true;
        PIXELS(image) = paint_pixels(&fig, 3, &none);
        assert_true(r.legends[0].width > 0);
        expect_inside(&r.legends[0], &r.panels[0], "the legend");
        assert_int_equal(coloured_pixels(image, 3, r.legends[0]), 0);
    }
}

TEST(legend_leaves_a_full_panel)
{
    enum { COUNT = 2000 };
    static double x[COUNT], y[COUNT], z[COUNT];
    for (int i = 0; i < COUNT; i++) {
        x[i] = i;
        y[i] = i % 2 ? 1 : -1;
        z[i] = -y[i];
    }
    figure_series series[] = {
        {.x = x, .y = y, .count = COUNT, .label = "one"},
        {.x = x, .y = z, .count = COUNT, .label = "two", .colour = 1}};
    figure_panel panels[] = {
        {.series = series, .series_count = 2, .zoom_from = 3, .zoom_to = 9},
        {.heading = "heading", .series = series, .series_count = 2}};
    figure fig = {.panels = panels, .panel_count = 2};
    static figure_report r;
    record(&fig, &r);
    for (int i = 0; i < 2; i++) {
        assert_true(r.legends[i].width > 0);
        check_below(bottom_of(&r.legends[i]), r.panels[i].y + 0.01);
    }
    // a heading stands below it
    check_below(bottom_of(&r.legends[1]), expect_text(&r, "heading")->y + 2);
    assert_true(r.insets[0].width == 0);
    expect_tidy(&fig);
}

static void expect_grey(cairo_surface_t *surface)
{
    for (int y = 0; y < cairo_image_surface_get_height(surface); y++) {
        for (int x = 0; x < cairo_image_surface_get_width(surface); x++) {
            assert_int_equal(saturation(pixel_at(surface, x, y)), 0);
        }
    }
    cairo_surface_destroy(surface);
}

TEST(mono_has_no_colour)
{
    static figure_report r;
    SYNTHETIC(s, run_panels, RUN_PANELS);
    PIXELS(coloured) = paint_pixels(&s.plot->figure, 1.5, &r);
    assert_true(coloured_pixels(coloured, 1.5, r.page) > 1000);
    s.plot->figure.theme = THEME_MONO;
    expect_grey(paint_pixels(&s.plot->figure, 1.5, &r));

    // a map neither
    double x[] = {0, 1, 2}, y[] = {0, 1}, z[] = {1, 2, 3, 4, 5, 6};
    figure_map map = {.x = x, .y = y, .columns = 3, .rows = 2, .z = z, .contours = true};
    figure_colours colours = {.axis = {.label = "z"}, .bar = true};
    figure_panel panel = {.map = &map, .colours = &colours};
    figure fig = {.panels = &panel, .panel_count = 1, .theme = THEME_MONO};
    expect_grey(paint_pixels(&fig, 1.5, &r));
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
    figure_panel panel = {.series = series,
                          .series_count = 2,
                          .y = {.low = 0, .high = 30}};
    figure fig = {.panels = &panel, .panel_count = 1, .theme = THEME_MONO};
    const double scale = 6;
    PIXELS(surface) = paint_pixels(&fig, scale, &r);

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
                pixel p = pixel_at(surface, (int)((legend->x + along) * scale),
                                   (int)((y + off) * scale));
                darkest = p.red < darkest ? p.red : darkest;
            }
            lightest = darkest > lightest ? darkest : lightest;
        }
        lightness[entry] = lightest;
    }
    assert_true(lightness[0] < 200);
    assert_true(lightness[1] < 40);
    assert_true(lightness[0] > lightness[1] + 60);
}

// ---- runs side by side

// Names of runs side by side, and the runs: all of one result.
static void fill_runs(trace_run *runs, char names[][32], int count, const scenario *s,
                      const run_result *result)
{
    for (int i = 0; i < count; i++) {
        snprintf(names[i], 32, "run number %d", i + 1);
        runs[i] = (trace_run){s, result, names[i], .rank = i + 1};
    }
}

// How often a text is on a page.
static int times_of(const figure_report *r, const char *text)
{
    int times = 0;
    for (int i = 0; i < r->text_count; i++) {
        times += strcmp(r->texts[i].text, text) == 0;
    }
    return times;
}

// A signal has a panel of its own, in which each run has its colour and its dash, those
// of its entry in the one key above all panels.
TEST(a_run_is_a_colour_and_a_dash_and_a_signal_a_panel)
{
    static const trace_panel panels[] = {
        {.signals = {"last_velocity", "first_velocity"}},
        {.label = "Angle", .signals = {"hub_angle", "first_angle", "last_angle"}},
        {.signals = {"force"}, .impulses = true}};
    enum { SIGNALS = 6 };
    trace_run runs[TRACE_RUNS];
    char names[TRACE_RUNS][32];
    SYNTHETIC(s, run_panels, RUN_PANELS);
    const int count = RUNS_TOGETHER;
    fill_runs(runs, names, count, &s.scenario, &s.result);
    owned_figure *t = trace_figure_create("Runs", panels, 3, runs, count);

    assert_int_equal(t->figure.panel_count, SIGNALS);
    for (int p = 0; p < SIGNALS; p++) {
        assert_int_equal(t->panels[p].series_count, count);
        for (int i = 0; i < count; i++) {
            const figure_series *one = &t->panels[p].series[i];
            const figure_series *key = &t->figure.key->series[i];
            assert_int_equal(one->run, i + 1);
            assert_int_equal(key->run, i + 1);
            assert_string_equal(one->name, names[i]);
            for (int k = 0; k < i; k++) {
                const figure_series *other = &t->panels[p].series[k];
                assert_int_not_equal(one->colour, other->colour);
                assert_int_not_equal(one->style, other->style);
            }
        }
    }

    // impulses are each run's
    const figure_panel *force = &t->panels[SIGNALS - 1];
    assert_int_equal(force->impulse_count % count, 0);
    assert_int_equal(force->impulses[force->impulse_count - 1].run, count);

    // the key is drawn once, above the panels
    for (int narrow = 0; narrow < 2; narrow++) {
        static figure_report r;
        t->figure.width = narrow ? 85 : 170;
        t->figure.height = 0;
        record(&t->figure, &r);
        expect_tidy(&t->figure);
        assert_int_equal(times_of(&r, names[0]), 1);
    }
    owned_figure_destroy(t);
}

// More runs than dashes have a row each, named once, with the first run behind the others
// and one range for each signal.
TEST(many_runs_become_small_multiples)
{
    static const trace_panel panels[] = {{.signals = {"hub_angle", "last_angle"}}};
    enum { SIGNALS = 2 };
    trace_run runs[TRACE_RUNS];
    char names[TRACE_RUNS][32];
    SYNTHETIC(s, run_panels, RUN_PANELS);
    fill_runs(runs, names, TRACE_RUNS, &s.scenario, &s.result);
    assert_int_equal(trace_compare_panels(panels, 1, runs, TRACE_RUNS),
                     SIGNALS * TRACE_RUNS);
    owned_figure *t = trace_figure_create("Runs", panels, 1, runs, TRACE_RUNS);

    for (int p = 0; p < SIGNALS * TRACE_RUNS; p++) {
        const figure_panel *panel = &t->panels[p];
        const int run = p / SIGNALS;
        assert_int_equal(panel->series_count, run == 0 ? 1 : 2);
        assert_int_equal(panel->series[panel->series_count - 1].run, run + 1);
    }
    for (int narrow = 0; narrow < 2; narrow++) {
        static figure_report r;
        t->figure.width = narrow ? 85 : 170;
        record(&t->figure, &r);
        expect_tidy(&t->figure);
        for (int i = 0; i < TRACE_RUNS; i++) {
            assert_int_equal(times_of(&r, names[i]), 1);
        }
        for (int p = SIGNALS; p < r.panel_count; p++) {
            check_close(r.ranges[p].y_high, r.ranges[p - SIGNALS].y_high, 1e-12);
            check_close(r.ranges[p].y_low, r.ranges[p - SIGNALS].y_low, 1e-12);
        }
    }
    owned_figure_destroy(t);
}

// What the runs share stands in the caption, what differs in the key; a parameter that
// follows from another one (EI from k2) is no difference of its own.
TEST(the_key_says_what_differs)
{
    fault f = {0};
    opened_run *one = run_open("corrected/first-impact", NULL, &f);
    opened_run *other = run_open("corrected/first-impact", "arm.k2=10", &f);
    assert_true(one != NULL && other != NULL);
    const trace_run runs[] = {{&one->scenario, &one->result, "soft", .rank = 1},
                              {&other->scenario, &other->result, "stiff", .rank = 2}};
    owned_figure *t = trace_figure_create("Runs", usual_panels, USUAL_PANELS, runs, 2);
    const figure_series *key = t->figure.key->series;
    g_autofree char *soft = text_plain(key[0].label), *stiff = text_plain(key[1].label);
    assert_string_equal(soft, "soft: k2 = 4.92\u2009N·m/rad");
    assert_string_equal(stiff, "stiff: k2 = 10\u2009N·m/rad");

    g_autofree char *caption = text_plain(t->figure.caption);
    assert_non_null(strstr(caption, "Both runs: corrected model, 2 links, rigid hub"));
    assert_non_null(strstr(caption, "They differ in arm.k2 (k2)."));
    owned_figure_destroy(t);
    run_close(one);
    run_close(other);
}

// ---- runs and the thesis's figures

TEST(the_last_of_twenty_links_is_body_21)
{
    static figure_report r;
    SYNTHETIC(s, run_panels, RUN_PANELS);
    const trace_run run = {&s.scenario, &s.result, NULL};
    owned_figure_destroy(s.plot);
    s.scenario.parameters.arm.links = 20;
    s.plot = trace_figure_create(NULL, run_panels, RUN_PANELS, &run, 1);
    record(&s.plot->figure, &r);
    expect_text(&r, "\u03b821  last link");
    assert_null(find_text(&r, "\u03b83  last link"));
}

TEST(a_scenario_is_plotted)
{
    KEPT_SCENARIO(s) = shipped("corrected/first-impact");
    run_result result = run_done(&s, true);
    DONE(plot_run(&s, &result, NULL, NULL, 0, "run.png", &f));
    assert_int_equal(access("run.png", F_OK), 0);
    run_finish(&result);
    // a run without rows still says what it is
    memset(&result, 0, sizeof result);
    result.summary.first_contact_s = (double)NAN;
    result.summary.status = STATUS_NOT_FINITE;
    strcpy(result.summary.message, "at t = 0 s: <nothing>");
    DONE(plot_run(&s, &result, NULL, NULL, 0, "none.pdf", &f));
}

ALL_BETWEEN(enter_folder, leave_plot_folder)
