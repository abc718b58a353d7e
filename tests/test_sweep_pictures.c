// Pictures of each kind of sweep.

#include "render/page/text.h"
#include "render/plot/figure_description.h"
#include "render/plot/study_plot.h"
#include "tests/sweep_fixture.h"

// Leaves the folder of the tests, after what Pango keeps is given back.
static int close_all(void **state)
{
    pango_cairo_font_map_set_default(NULL); // what Pango keeps for later figures
    return sweep_fixture_close(state);
}

// A sweep of one or two parameters and the file that its picture is written to.
typedef struct drawn_sweep {
    const char *vary, *and_vary; // as after --vary; `and_vary` may be NULL
    sweep_sampling sampling;
    size_t runs; // of a random sampling
    const char *path;
    double offset; // added to all values that are drawn
} drawn_sweep;

// Draws invented values of a sweep: offset + 0 to 10, with a gap (NAN) in each seventh
// run.
static void must_draw(drawn_sweep c)
{
    SWEPT(s, c.sampling, c.runs, c.vary, c.and_vary);
    SCOPED(free_kept) double *values = malloc(s.run_count * sizeof *values);
    assert_non_null(values);
    for (size_t run = 0; run < s.run_count; run++) {
        values[run] = run % 7 == 3 ? (double)NAN : c.offset + (double)(run % 11);
    }

    // the picture
    sweep_picture shown = {.sweep = &s, .key = "peak_force_N", .values = values};
    DONE(sweep_plot_check(&s, c.path, &f));
    owned_figure *drawn = sweep_figure_create(&shown);
    DONE(figure_write(&drawn->figure, c.path, &f));
    owned_figure_destroy(drawn);

    // a file of some size
    struct stat about;
    assert_int_equal(stat(c.path, &about), 0);
    assert_true(about.st_size > 1000);
    unlink(c.path);
}

// Lines, logarithmic axes, words, a single point, random samples, and maps of two
// parameters. The offsets make axes hard: values that differ by a hundred-millionth of
// their size, values that are all missing, and values a millionth away from whole
// numbers.
TEST(every_kind_of_sweep_can_be_drawn)
{
    const drawn_sweep sweeps[] = {
        // one parameter
        {.vary = "motor.voltage=1:2:9", .path = "a.png"},
        {.vary = "motor.voltage=3,1,2", .path = "a.pdf"},
        {.vary = "arm.k2=1:1e6:200:log", .path = "a.svg"},
        {.vary = "method.name=newmark,event", .path = "a.png"},
        {.vary = "motor.voltage=1", .path = "a.png"},
        {.vary = "motor.voltage=1:2",
         .sampling = SWEEP_RANDOM,
         .runs = 30,
         .path = "a.svg",
         .offset = -1e9},

        // two parameters
        {.vary = "motor.voltage=2:1:9",
         .and_vary = "arm.k2=1:1e-5:5:log",
         .path = "a.png"},
        {.vary = "motor.voltage=1:2:9",
         .and_vary = "method.name=event,newmark",
         .path = "a.pdf"},
        {.vary = "motor.voltage=1",
         .and_vary = "arm.k2=3",
         .path = "a.png",
         .offset = (double)NAN},
        {.vary = "motor.voltage=1:2",
         .and_vary = "arm.k2=3,4",
         .sampling = SWEEP_LATIN,
         .runs = 30,
         .path = "a.png",
         .offset = 1e-6},
    };
    for (EACH(c, sweeps)) {
        must_draw(*c); // SWEEP_GRID where no sampling is given
    }
}

// Two methods and three voltages give six runs, drawn as a curve over the voltage for
// each method, whichever was varied first. The values that are drawn are the voltage
// itself for the first method and the voltage + 100 for the second, so that each curve
// shows which runs it is made of.
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
            double volts = sweep_value(&s, run, 1 - k);
            values[run] =
                volts + (sweep_value(&s, run, k) == s.axes[k].values[1] ? 100 : 0);
        }

        // not a map, but two curves over the voltage
        sweep_picture shown = {.sweep = &s, .key = "peak_force_N", .values = values};
        owned_figure *drawn = sweep_figure_create(&shown);
        const figure *fig = &drawn->figure;
        assert_null(fig->panels[0].map);
        assert_int_equal(fig->panels[0].series_count, 2);
        assert_string_equal(fig->x.name, "motor.voltage");
        assert_string_equal(fig->panels[0].series[1].label, "newmark");

        // each curve has the values of its method
        for (int i = 0; i < 3; i++) {
            assert_true(fig->panels[0].series[0].y[i] == fig->panels[0].series[0].x[i]);
            assert_true(fig->panels[0].series[1].y[i] ==
                        100 + fig->panels[0].series[1].x[i]);
        }
        owned_figure_destroy(drawn);
    }
}

// Three parameters are refused before anything is drawn, and so is a file of no known
// kind.
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
