// Pictures of each kind of sweep.

#include "render/page/text.h"
#include "render/plot/figure_description.h"
#include "render/plot/study_plot.h"
#include "tests/sweep_fixture.h"

static int close_all(void **state)
{
    pango_cairo_font_map_set_default(NULL); // what Pango keeps for later figures
    return sweep_fixture_close(state);
}

static void must_draw(const char *a, const char *b, sweep_sampling sampling, size_t runs,
                      const char *path, double offset)
{
    SWEPT(s, sampling, runs, a, b);
    SCOPED(free_kept) double *values = malloc(s.run_count * sizeof *values);
    assert_non_null(values);
    for (size_t run = 0; run < s.run_count; run++) {
        values[run] = run % 7 == 3 ? (double)NAN : offset + (double)(run % 11);
    }
    sweep_picture shown = {.sweep = &s, .key = "peak_force_N", .values = values};
    DONE(sweep_plot_check(&s, path, &f));
    owned_figure *drawn = sweep_figure_create(&shown);
    DONE(figure_write(&drawn->figure, path, &f));
    owned_figure_destroy(drawn);
    struct stat about;
    assert_int_equal(stat(path, &about), 0);
    assert_true(about.st_size > 1000);
    unlink(path);
}

TEST(every_kind_of_sweep_can_be_drawn)
{
    must_draw("motor.voltage=1:2:9", NULL, SWEEP_GRID, 0, "a.png", 0);
    must_draw("motor.voltage=3,1,2", NULL, SWEEP_GRID, 0, "a.pdf", 0);
    must_draw("arm.k2=1:1e6:200:log", NULL, SWEEP_GRID, 0, "a.svg", 0);
    must_draw("method.name=newmark,event", NULL, SWEEP_GRID, 0, "a.png", 0);
    must_draw("motor.voltage=1", NULL, SWEEP_GRID, 0, "a.png", 0);
    must_draw("motor.voltage=1:2", NULL, SWEEP_RANDOM, 30, "a.svg", -1e9);
    must_draw("motor.voltage=2:1:9", "arm.k2=1:1e-5:5:log", SWEEP_GRID, 0, "a.png", 0);
    must_draw("motor.voltage=1:2:9", "method.name=event,newmark", SWEEP_GRID, 0, "a.pdf",
              0);
    must_draw("motor.voltage=1", "arm.k2=3", SWEEP_GRID, 0, "a.png", (double)NAN);
    must_draw("motor.voltage=1:2", "arm.k2=3,4", SWEEP_LATIN, 30, "a.png", 1e-6);
}

// Methods beside a number: a curve for each over the number, whichever was varied first.
TEST(words_have_a_curve_each)
{
    static const char *const varied[2][2] = {{"method.name=event,newmark",
                                              "motor.voltage=1,2,4"},
                                             {"motor.voltage=1,2,4",
                                              "method.name=event,newmark"}};
    for (int k = 0; k < 2; k++) {
        KEPT_SWEEP(s);
        double values[6];
        must_sweep(&s, SWEEP_GRID, 0, varied[k][0], varied[k][1]);
        assert_int_equal(s.run_count, 6);
        for (size_t run = 0; run < 6; run++) {
            // 100 for the second method, and the voltage
            double volts = sweep_value(&s, run, 1 - k);
            values[run] =
                volts + (sweep_value(&s, run, k) == s.axes[k].values[1] ? 100 : 0);
        }
        sweep_picture shown = {.sweep = &s, .key = "peak_force_N", .values = values};
        owned_figure *drawn = sweep_figure_create(&shown);
        const figure *fig = &drawn->figure;
        assert_null(fig->panels[0].map);
        assert_int_equal(fig->panels[0].series_count, 2);
        assert_string_equal(fig->x.name, "motor.voltage");
        assert_string_equal(fig->panels[0].series[1].label, "newmark");
        for (int i = 0; i < 3; i++) {
            assert_true(fig->panels[0].series[0].y[i] == fig->panels[0].series[0].x[i]);
            assert_true(fig->panels[0].series[1].y[i] ==
                        100 + fig->panels[0].series[1].x[i]);
        }
        owned_figure_destroy(drawn);
    }
}

TEST(a_picture_shows_two_parameters_at_most)
{
    char *vary[] = {"arm.k1=1,2", "arm.k2=1,2", "arm.mass=1,2"};
    sweep_request request = {.vary = vary, .vary_count = 3};
    KEPT_SWEEP(s);
    DONE(sweep_init(&s, &base, &request, &f));
    assert_int_equal(s.run_count, 8);
    REFUSED(STATUS_BAD_ARGUMENT, "3 are varied", sweep_plot_check(&s, "a.png", &f));
    sweep_finish(&s);
    must_sweep(&s, SWEEP_GRID, 0, "arm.k1=1,2", NULL);
    REFUSED(STATUS_BAD_ARGUMENT, "", sweep_plot_check(&s, "a.jpg", &f));
}

ALL_BETWEEN(sweep_fixture_open, close_all)
