// Axes: ticks by a published example and by what must hold for any axis, logarithmic ones
// by the pixels of an image; contour lines and the colour scale of maps.
#include "tests/plot_fixture.h"

#include "render/page/page.h"
#include "render/plot/drawing.h"

// Middle of the pixels of a series' colour between two columns; false if there is none.
static bool middle_of(cairo_surface_t *image, int slot, int from, int to, double *x,
                      double *y)
{
    const unsigned char *data = cairo_image_surface_get_data(image);
    int stride = cairo_image_surface_get_stride(image), count = 0;
    colour c = palette_series(THEME_COLOUR, slot, 0);
    double wanted[3] = {c.blue, c.green, c.red};
    *x = *y = 0;
    for (int row = 0; row < cairo_image_surface_get_height(image); row++) {
        for (int column = from; column < to; column++) {
            double off = 0;
            for (int k = 0; k < 3; k++) {
                off += fabs(data[row * stride + 4 * column + k] / 255.0 - wanted[k]);
            }
            if (off < 0.02) {
                *x += column;
                *y += row;
                count++;
            }
        }
    }
    *x /= count;
    *y /= count;
    return count > 0;
}

static figure figure_of(const figure_panel *panel)
{
    return (figure){
        .x = {.name = "n", .label = "number", .scale = SCALE_LOGARITHMIC, .room = 0.04},
        .panels = panel,
        .panel_count = 1,
        .width = 100,
        .height = 80};
}

// Three markers at 1, 10, 100: evenly spaced for any values between.
TEST(decades_are_evenly_spaced)
{
    static const double x[] = {1, 10, 100}, y[] = {1e-6, 1e-4, 1e-2};
    static const int slots[] = {0, 5, 2};
    figure_series series[3];
    double at_x[3], at_y[3];
    for (int i = 0; i < 3; i++) {
        series[i] = (figure_series){.name = "s",
                                    .x = &x[i],
                                    .y = &y[i],
                                    .count = 1,
                                    .colour = slots[i],
                                    .marker = MARKER_CIRCLE,
                                    .no_line = true};
    }
    const figure_panel panel = {.y = {.name = "p",
                                      .label = "p",
                                      .scale = SCALE_LOGARITHMIC},
                                .series = series,
                                .series_count = 3};
    figure fig = figure_of(&panel);
    PIXELS(image) = paint_pixels(&fig, 2, NULL);
    for (int i = 0; i < 3; i++) {
        assert_true(middle_of(image, slots[i], 0, cairo_image_surface_get_width(image),
                              &at_x[i], &at_y[i]));
    }
    check_close(at_x[2] - at_x[1], at_x[1] - at_x[0], 1);
    check_close(at_y[2] - at_y[1], at_y[1] - at_y[0], 1);
    assert_true(at_x[1] - at_x[0] > 50);
    assert_true(at_y[0] - at_y[1] > 50); // upwards
}

TEST(points_at_or_below_zero_are_left_out)
{
    static const double x[] = {1, 10, 100}, y[] = {1, 0, 3}, none[] = {0, -1, 0};
    const figure_series some = {.name = "s", .x = x, .y = y, .count = 3};
    const figure_series nothing = {.name = "s", .x = x, .y = none, .count = 3};
    const figure_panel panel = {.y = {.name = "p", .scale = SCALE_LOGARITHMIC},
                                .series = &some,
                                .series_count = 1};
    const figure_panel empty = {.y = {.name = "empty", .scale = SCALE_LOGARITHMIC},
                                .series = &nothing,
                                .series_count = 1};
    figure fig = figure_of(&panel);
    cairo_surface_destroy(paint_pixels(&fig, 2, NULL));
    PIXELS(image) = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 300, 300);
    cairo_t *cr = cairo_create(image);
    fig = figure_of(&empty);
    REFUSED(STATUS_BAD_ARGUMENT, "empty", figure_paint(cr, &fig, NULL, &f));
    cairo_destroy(cr);
}

// However narrow, an axis of two decades or more has two labels: one alone gives no
// scale.
TEST(a_narrow_axis_has_two_labels)
{
    const figure_axis from = {.scale = SCALE_LOGARITHMIC};
    for (double low = -9; low < 3; low += 0.21) {
        for (double decades = 2.1; decades < 16; decades += 0.37) {
            axis a = {.scale = {SCALE_LOGARITHMIC, low, low + decades}};
            axis_choose_ticks(&a, &from, 2);
            assert_true(a.count >= 2);
            assert_true(a.count <= 4);
        }
    }
}

// ---- labels of marks

// The text of a mark as it was drawn, with an arrow or not; fails if it is not there.
static const figure_text *text_of_mark(const figure_report *r, const figure_mark *m)
{
    const figure_text *found = NULL;
    g_autofree char *wanted = text_plain(m->label);
    for (int i = 0; i < r->text_count; i++) {
        found = g_str_has_prefix(r->texts[i].text, wanted) ? &r->texts[i] : found;
    }
    fail_if(found == NULL, "'%s' is not drawn", wanted);
    return found;
}

// What begins at a line stands on that side of it, or points there where the page ends;
// the label of a peak stands at its point. Returns the number of labels that point.
static int check_labels(const figure *fig)
{
    static figure_report r;
    int arrows = 0;
    record(fig, &r);
    expect_tidy(fig);
    assert_true(fig->mark_count > 0);
    for (int i = 0; i < fig->mark_count; i++) {
        const figure_mark *m = &fig->marks[i];
        const figure_range *range = &r.ranges[0];
        const figure_rect *box = &r.panels[0];
        if (m->x < range->x_low || m->x > range->x_high) {
            continue;
        }
        const figure_text *t = text_of_mark(&r, m);
        const figure_rect *at = &t->place;
        double x =
            box->x + box->width * (m->x - range->x_low) / (range->x_high - range->x_low);
        double y = box->y +
                   box->height * (range->y_high - m->y) / (range->y_high - range->y_low);
        if (m->onwards) {
            const bool arrow = g_str_has_suffix(t->text, "\u2192");
            arrows += arrow;
            assert_true(arrow ? at->x + at->width < x : at->x > x);
        } else if (g_str_has_prefix(m->label, "peak")) {
            check_below(hypot(fmax(0, fmax(at->x - x, x - at->x - at->width)),
                              fmax(0, fmax(at->y - y, y - at->y - at->height))),
                        5);
        }
    }
    return arrows;
}

// Wherever there is room for a word; no text meets another, not in the insets of short
// pulses either.
TEST(labels_stand_where_they_belong)
{
    static const struct {
        const char *name;
        double from, to;
        int arrows; // on both widths
    } cases[] = {{"compare/hybrid", 0, 0, 0},         {"compare/bang-bang", 0, 0, 0},
                 {"compare/reverse-torque", 0, 0, 0}, {"compare/hybrid", 0.2, 0.66, 2},
                 {"corrected/first-impact", 0, 0, 0}, {"corrected/stiff-beam", 0, 0, 0},
                 {"corrected/five-links", 0, 0, 0},   {"corrected/spring-hub", 0, 0, 0},
                 {"corrected/plane-wall", 0, 0, 0},   {"corrected/fast-impact", 0, 0, 0},
                 {"thesis/fig-3-4", 0, 0, 0}};
    for (EACH(c, cases)) {
        KEPT_SCENARIO(s) = shipped(c->name);
        KEPT_RUN(result);
        DONE(run_scenario(&s, true, &result));
        const trace_run run = {&s, &result, NULL};
        int arrows = 0;
        for (EACH_OF(double, width, 85, 170)) {
            owned_figure *t =
                trace_figure_create(NULL, usual_panels, USUAL_PANELS, &run, 1);
            t->figure.width = *width;
            t->figure.x.low = c->from;
            t->figure.x.high = c->to;
            arrows += check_labels(&t->figure);
            owned_figure_destroy(t);
        }
        assert_int_equal(arrows, c->arrows);
    }
}

// ---- ticks

static void expect_ticks(const ticks *t, int count, const double *expected)
{
    assert_int_equal(t->count, count);
    for (int i = 0; i < count; i++) {
        check_close(t->value[i], expected[i], 0);
    }
}

static void expect_labels(const ticks *t, int count, const char *const *expected)
{
    char label[TICK_TEXT];
    assert_int_equal(t->count, count);
    for (int i = 0; i < count; i++) {
        tick_label(t, i, label);
        assert_string_equal(label, expected[i]);
    }
}

// 8, 10, 12, 14 are the ticks of extended(8.1, 14.1, 4) of the R package labeling; on an
// axis that ends at the outermost of them none is left out
TEST(published_example)
{
    ticks t;
    ticks_between(&t, 8, 14, 4);
    expect_ticks(&t, 4, (double[]){8, 10, 12, 14});
    check_close(t.step, 2, 0);
    ticks_between(&t, 14, 8, 4);
    expect_ticks(&t, 4, (double[]){8, 10, 12, 14});
}

TEST(round_ranges)
{
    ticks t;
    ticks_between(&t, 0, 1, 6);
    expect_ticks(&t, 6, (double[]){0, 0.2, 0.4, 0.6, 0.8, 1});
    ticks_between(&t, -100, 100, 5);
    expect_ticks(&t, 5, (double[]){-100, -50, 0, 50, 100});
}

// 0.04, 0.06 and never 0.045, 0.055: a reader looks for whole multiples of the step
TEST(ticks_are_multiples_of_their_step)
{
    for (double low = 0.031; low < 0.06; low += 0.0013) {
        for (int wanted = 2; wanted < 9; wanted++) {
            ticks t;
            ticks_between(&t, low, low + 0.0431, wanted);
            for (int i = 0; i < t.count && t.step > 0; i++) {
                double share = t.value[i] / t.step;
                check_close(share, round(share), 1e-9);
            }
        }
    }
}

// every tick is the double nearest to its decimal number, so that printing shows no noise
TEST(values_are_decimal)
{
    for (int power = -12; power <= 12; power++) {
        ticks t;
        double scale = pow(10, power);
        ticks_between(&t, -0.31 * scale, 0.94 * scale, 6);
        assert_true(t.count >= 3);
        for (int i = 0; i < t.count; i++) {
            check_close(t.value[i], strtod(formatted("%.10g", t.value[i]), NULL), 0);
            assert_false(signbit(t.value[i]) && t.value[i] == 0);
        }
    }
}

TEST(between_stays_inside_and_misses_none)
{
    random_generator g = seeded(7);
    for (int trial = 0; trial < 3000; trial++) {
        ticks t;
        double centre = (random_uniform(&g) - 0.5) * pow(10, 6 * random_uniform(&g) - 3);
        double width = pow(10, 8 * random_uniform(&g) - 4);
        double low = centre - width * random_uniform(&g), high = low + width;
        int wanted = 2 + (int)(8 * random_uniform(&g));
        ticks_between(&t, low, high, wanted);
        assert_true(t.count >= 2);
        assert_true(t.count <= 2 * wanted + 1);
        assert_true(t.value[0] >= low - 1e-8 * width);
        assert_true(t.value[t.count - 1] <= high + 1e-8 * width);
        assert_true(t.value[0] - t.step < low + 1e-8 * width);
        assert_true(t.value[t.count - 1] + t.step > high - 1e-8 * width);
        for (int i = 1; i < t.count; i++) {
            check_close(t.value[i] - t.value[i - 1], t.step,
                        1e-9 * fmax(fabs(centre), width));
        }
    }
}

// Two ticks inside an axis may stand far from its ends.
TEST(an_axis_between_round_numbers_has_ticks)
{
    ticks t;
    ticks_between(&t, -0.0571, -0.000155, 2);
    assert_in_range(t.count, 2, 5);
    assert_true(t.value[0] >= -0.0571 && t.value[t.count - 1] <= -0.000155);
}

TEST(about_as_many_as_wanted)
{
    random_generator g = seeded(11);
    for (int wanted = 3; wanted <= 10; wanted++) {
        double total = 0;
        for (int trial = 0; trial < 300; trial++) {
            ticks t;
            double low = 100 * random_uniform(&g) - 50;
            ticks_between(&t, low, low + 1 + 100 * random_uniform(&g), wanted);
            total += t.count;
        }
        check_close(total / 300, wanted, 0.35 * wanted);
    }
}

TEST(labels_are_short_and_have_a_true_minus)
{
    ticks t;
    ticks_between(&t, -1.2, 1.2, 5);
    expect_labels(&t, 5, (const char *[]){"\u22121.0", "\u22120.5", "0.0", "0.5", "1.0"});
    ticks_between(&t, 8, 14, 4);
    expect_labels(&t, 4, (const char *[]){"8", "10", "12", "14"});
}

TEST(small_and_large_numbers_get_a_factor)
{
    ticks t;
    char factor[64];
    static const struct {
        double high;
        int wanted;
        const char *factor;
    } cases[] = {{2e6, 3, "\u00d710<sup>6</sup>"},
                 {1, 5, ""},
                 {4e-6, 5, "\u00d710<sup>\u22126</sup>"}};
    for (EACH(c, cases)) {
        ticks_between(&t, 0, c->high, c->wanted);
        tick_factor(&t, factor, sizeof factor);
        assert_string_equal(factor, c->factor);
    }
    expect_labels(&t, 5, (const char *[]){"0", "1", "2", "3", "4"});
}

TEST(narrow_range_far_from_zero)
{
    ticks t;
    char first[TICK_TEXT], second[TICK_TEXT];
    ticks_between(&t, 0.293412, 0.293462, 4);
    assert_true(t.count >= 2);
    tick_label(&t, 0, first);
    tick_label(&t, 1, second);
    assert_string_not_equal(first, second);
    check_close(strtod(first, NULL), t.value[0], 1e-12);
}

TEST(hopeless_limits)
{
    ticks t;
    for (EACH_OF(double, c, (double)NAN, (double)INFINITY, -(double)INFINITY)) {
        ticks_between(&t, 0, *c, 5);
        assert_int_equal(t.count, 0);
        ticks_between(&t, *c, 0, 5);
        assert_int_equal(t.count, 0);
    }
    ticks_between(&t, 3, 3, 5);
    assert_true(t.count >= 2);
    ticks_between(&t, 0, 0, 5);
    assert_true(t.count >= 2);
    ticks_between(&t, -1e308, 1e308, 5);
    assert_int_equal(t.count, 0);
    ticks_between(&t, 0, 1, -5);
    assert_true(t.count >= 2);
}

TEST(minor_ticks_are_round)
{
    random_generator g = seeded(3);
    for (int trial = 0; trial < 300; trial++) {
        ticks t;
        ticks_between(&t, 0, pow(10, 4 * random_uniform(&g)), 5);
        // a minor step has one digit, or is 25, or is no minor step at all
        double part = t.step / t.minor,
               digits = part / pow(10, floor(log10(part * (1 + 1e-12))));
        bool round_number =
            fabs(digits - round(digits)) < 1e-9 || fabs(digits - 2.5) < 1e-9;
        assert_true(round_number || t.minor == 1);
    }
}

// ---- maps

TEST(contours_lie_where_a_plane_has_the_level)
{
    contour_piece pieces[2];
    // z = 1 + 2 x + 4 y at the corners
    const double tilted[4] = {1, 3, 5, 7};
    assert_int_equal(contour_square(tilted, 0, pieces), 0);
    assert_int_equal(contour_square(tilted, 8, pieces), 0);
    for (double level = 1.5; level < 7; level += 1) {
        assert_int_equal(contour_square(tilted, level, pieces), 1);
        check_close(1 + 2 * pieces[0].x0 + 4 * pieces[0].y0, level, 1e-14);
        check_close(1 + 2 * pieces[0].x1 + 4 * pieces[0].y1, level, 1e-14);
    }
    const double hole[4] = {1, 3, (double)NAN, 7};
    assert_int_equal(contour_square(hole, 2, pieces), 0);
}

TEST(a_saddle_is_cut_by_its_middle)
{
    contour_piece pieces[2];
    // high at (0, 0) and (1, 1); the middle is at 5
    const double saddle[4] = {10, 0, 0, 10};
    for (double level = 4; level < 7; level += 2) {
        assert_int_equal(contour_square(saddle, level, pieces), 2);
        for (int i = 0; i < 2; i++) {
            // below the middle the low corners are cut off, where x - y is far from 0;
            // above it the high ones, where x + y is far from 1
            double x = (pieces[i].x0 + pieces[i].x1) / 2,
                   y = (pieces[i].y0 + pieces[i].y1) / 2;
            check_close(level < 5 ? x + y : x - y, level < 5 ? 1 : 0, 1e-14);
        }
    }
}

enum { MAP_COLUMNS = 6, MAP_ROWS = 4, MAP_PARTS = 8 };

// A map over columns and rows at uneven places of the unit square.
static const double map_x[MAP_COLUMNS] = {0, 0.1, 0.3, 0.6, 0.8, 1};
static const double map_y[MAP_ROWS] = {0, 0.2, 0.7, 1};
static const plane map_plane = {{0, 0, 100, 60},
                                {SCALE_LINEAR, 0, 1},
                                {SCALE_LINEAR, 0, 1}};

static fine_grid refined(const double *z)
{
    const figure_map map = {map_x, map_y, MAP_COLUMNS, MAP_ROWS, z};
    return map_refine(&map, &map_plane, SCALE_LINEAR, MAP_PARTS);
}

// Whatever the values, steps among them: those of the points stay, and no other leaves
// what the corners of its cell span, so that no contour line enters a cell uncalled for.
TEST(a_refined_map_stays_within_its_cells)
{
    random_generator g = seeded(5);
    for (int trial = 0; trial < 300; trial++) {
        double z[MAP_COLUMNS * MAP_ROWS];
        for (int i = 0; i < MAP_COLUMNS * MAP_ROWS; i++) {
            z[i] = random_uniform(&g) - 0.5;
            z[i] = trial % 2 == 0 ? z[i] : copysign(1 + 1e-3 * z[i], z[i]);
        }
        SCOPED(fine_grid_finish) fine_grid fine = refined(z);
        assert_int_equal(fine.columns, (MAP_COLUMNS - 1) * MAP_PARTS + 1);
        assert_int_equal(fine.rows, (MAP_ROWS - 1) * MAP_PARTS + 1);
        for (size_t i = 0; i < fine.columns; i++) {
            for (size_t j = 0; j < fine.rows; j++) {
                const size_t column = MIN(i / MAP_PARTS, MAP_COLUMNS - 2);
                const size_t row = MIN(j / MAP_PARTS, MAP_ROWS - 2);
                const double *corner = &z[column * MAP_ROWS + row];
                const double low = fmin(fmin(corner[0], corner[1]),
                                        fmin(corner[MAP_ROWS], corner[MAP_ROWS + 1]));
                const double high = fmax(fmax(corner[0], corner[1]),
                                         fmax(corner[MAP_ROWS], corner[MAP_ROWS + 1]));
                const double here = fine.z[i * fine.rows + j];
                assert_true(here >= low - 1e-14 && here <= high + 1e-14);
                if (i % MAP_PARTS == 0 && j % MAP_PARTS == 0) {
                    check_close(here, z[i / MAP_PARTS * MAP_ROWS + j / MAP_PARTS], 0);
                }
            }
        }
    }
}

// A plane stays one, at the places where it is looked at, and a missing value leaves out
// the cells round it, no more.
TEST(a_refined_map_follows_a_plane)
{
    double z[MAP_COLUMNS * MAP_ROWS];
    for (int i = 0; i < MAP_COLUMNS; i++) {
        for (int j = 0; j < MAP_ROWS; j++) {
            z[i * MAP_ROWS + j] = 1 + 3 * map_x[i] - 2 * map_y[j];
        }
    }
    z[MAP_ROWS] = (double)NAN; // second column, first row
    SCOPED(fine_grid_finish) fine_grid fine = refined(z);
    for (size_t i = 0; i < fine.columns; i++) {
        for (size_t j = 0; j < fine.rows; j++) {
            const double here = fine.z[i * fine.rows + j];
            const bool near_hole = i > 0 && i < 2 * MAP_PARTS && j < MAP_PARTS;
            if (!near_hole) {
                const double x = fine.x[i] / 100, y = 1 - fine.y[j] / 60;
                check_close(here, 1 + 3 * x - 2 * y, 1e-12);
            } else if (i % MAP_PARTS != 0 && j % MAP_PARTS != 0) {
                assert_true(isnan(here));
            }
        }
    }
}

TEST(the_colour_scale_grows_lighter_all_the_way)
{
    double before = -1;
    for (int i = 0; i <= 100; i++) {
        colour c = palette_shade(THEME_COLOUR, i / 100.0);
        double light = 0.2126 * pow(c.red, 2.2) + 0.7152 * pow(c.green, 2.2) +
                       0.0722 * pow(c.blue, 2.2);
        check_below(before, light);
        before = light;
    }
}

ALL_BETWEEN(enter_folder, leave_plot_folder)
