// Figures over logarithmic axes, judged by the pixels of an image.
#include "tests/plot_fixture.h"

#include "render/page/palette.h"
#include "render/plot/axis.h"

// Middle of the pixels of a series' colour between two columns; false if there is none.
static bool middle_of(cairo_surface_t *image, int slot, int from, int to, double *x, double *y)
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
    return (figure){.x = {.name = "n", .label = "number", .scale = SCALE_LOGARITHMIC, .room = 0.04},
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
    const figure_panel panel = {.y = {.name = "p", .label = "p", .scale = SCALE_LOGARITHMIC},
                                .series = series,
                                .series_count = 3};
    figure fig = figure_of(&panel);
    cairo_surface_t *image = paint_pixels(&fig, 2, NULL);
    for (int i = 0; i < 3; i++) {
        assert_true(middle_of(image, slots[i], 0, cairo_image_surface_get_width(image), &at_x[i],
                              &at_y[i]));
    }
    check_close(at_x[2] - at_x[1], at_x[1] - at_x[0], 1);
    check_close(at_y[2] - at_y[1], at_y[1] - at_y[0], 1);
    assert_true(at_x[1] - at_x[0] > 50);
    assert_true(at_y[0] - at_y[1] > 50); // upwards
    cairo_surface_destroy(image);
}

TEST(points_at_or_below_zero_are_left_out)
{
    static const double x[] = {1, 10, 100}, y[] = {1, 0, 3}, none[] = {0, -1, 0};
    const figure_series some = {.name = "s", .x = x, .y = y, .count = 3};
    const figure_series nothing = {.name = "s", .x = x, .y = none, .count = 3};
    const figure_panel panel = {
        .y = {.name = "p", .scale = SCALE_LOGARITHMIC}, .series = &some, .series_count = 1};
    const figure_panel empty = {
        .y = {.name = "empty", .scale = SCALE_LOGARITHMIC}, .series = &nothing, .series_count = 1};
    figure fig = figure_of(&panel);
    cairo_surface_destroy(paint_pixels(&fig, 2, NULL));
    cairo_surface_t *image = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 300, 300);
    cairo_t *cr = cairo_create(image);
    fig = figure_of(&empty);
    REFUSED(STATUS_BAD_ARGUMENT, "empty", figure_paint(cr, &fig, NULL, &f));
    cairo_destroy(cr);
    cairo_surface_destroy(image);
}

TEST(file_and_data_are_written)
{
    static const double x[] = {2, 20}, y[] = {0.5, 0.25};
    const figure_series s = {.name = "cost", .label = "cost", .x = x, .y = y, .count = 2};
    const figure_panel panel = {.y = {.name = "step", .unit = "s", .scale = SCALE_LOGARITHMIC},
                                .series = &s,
                                .series_count = 1};
    const figure fig = figure_of(&panel);
    size_t length;
    DONE(figure_write(&fig, "a.svg", &f));
    DONE(figure_write_csv(&fig, "a.csv", &f));
    SCOPED(free_kept) char *text = read_file("a.csv", &length);
    assert_non_null(strstr(text, "cost"));
    assert_non_null(strstr(text, "20,0.25"));
    REFUSED(STATUS_BAD_ARGUMENT, "a.txt", figure_write(&fig, "a.txt", &f));
}

// However narrow, an axis of two decades or more has two labels: one alone gives no scale.
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

ALL_BETWEEN(enter_folder, leave_plot_folder)
