// Bode and Nyquist plots of a loop whose margins are known: L = 4/(1 + s)^3, which
// crosses the negative real axis at w = sqrt(3) with a size of 1/2, and has |L| = 1 at
// w^2 = 4^(2/3) - 1.
#include "tests/plot_fixture.h"

#include "render/plot/study_plot.h"

enum { POINTS = 4001 };

static double complex block[2 * POINTS]; // frequencies in its first part, then gains

// The loop's answers from w = 0.01 to 100.
static linear_response known_loop(void)
{
    linear_response r = {POINTS, (double *)block, block + POINTS};
    for (int i = 0; i < POINTS; i++) {
        r.frequency[i] = pow(10, -2 + 4.0 * i / (POINTS - 1));
        const double complex s = complex_of(1, r.frequency[i]);
        r.gain[i] = 4 / (s * s * s);
    }
    return r;
}

static const double phase_crossover = 1.7320508075688772; // [rad/s]

static double gain_crossover(void)
{
    return sqrt(pow(4, 2.0 / 3) - 1);
}

// The phase margin: 180 degrees and the phase at |L| = 1, -3 atan(w).
static double phase_margin(void)
{
    return 180 - 3 * atan(gain_crossover()) * 180 / M_PI;
}

static scenario named_scenario(void)
{
    scenario s = {.name = (char *)"a loop"};
    return s;
}

static const figure_series *find_series(const figure_panel *panel, const char *name)
{
    for (int i = 0; i < panel->series_count; i++) {
        if (strcmp(panel->series[i].name, name) == 0) {
            return &panel->series[i];
        }
    }
    fail_if(true, "there is no series '%s'", name);
    return NULL;
}

TEST(margins_say_where_they_are)
{
    const linear_response r = known_loop();
    const linear_margins m = linear_margins_of(&r);
    check_close(m.gain_db, 20 * log10(2), 1e-4);
    check_relative(m.gain_at, phase_crossover, 1e-5);
    check_close(m.phase_deg, phase_margin(), 1e-3);
    check_relative(m.phase_at, gain_crossover(), 1e-5);
}

// A unit is as long on the one axis as on the other, on every page.
TEST(the_plane_has_equal_axes)
{
    static figure_report r;
    const scenario s = named_scenario();
    const linear_response loop = known_loop();
    const linear_margins m = linear_margins_of(&loop);
    for (EACH_OF(double, width, 60, 85, 120, 180, 400)) {
        for (EACH_OF(double, height, 0, 70, 150)) {
            owned_figure *o = nyquist_figure_create(&s, &loop, &m);
            o->figure.width = *width;
            o->figure.height = *height;
            record(&o->figure, &r);
            const figure_range *range = &r.ranges[0];
            check_relative(r.panels[0].width / (range->x_high - range->x_low),
                           r.panels[0].height / (range->y_high - range->y_low), 1e-9);
            fail_if(range->x_low > -1 || range->x_high < 4 || range->y_low > -1,
                    "the plane is cut off");
            owned_figure_destroy(o);
        }
    }
}

// Notes of frequencies lie on the loop gain, and margins between -1 and its crossings.
TEST(the_plane_tells_frequencies_and_margins)
{
    const scenario s = named_scenario();
    const linear_response loop = known_loop();
    const linear_margins m = linear_margins_of(&loop);
    owned_figure *o = nyquist_figure_create(&s, &loop, &m);
    const figure_panel *panel = &o->panels[0];
    assert_true(panel->note_count >= 4);
    for (int i = 0; i < panel->note_count; i++) {
        const figure_note *note = &panel->notes[i];
        const double w = 2 * M_PI * g_ascii_strtod(note->text, NULL);
        const double complex one = complex_of(1, w), gain = 4 / (one * one * one);
        check_close(note->x, creal(gain), 1e-4);
        check_close(note->y, cimag(gain), 1e-4);
    }

    const figure_series *gain = find_series(panel, "gain_margin");
    check_close(gain->x[0], -1, 0);
    check_close(gain->x[1], -0.5, 1e-4);
    const figure_series *phase = find_series(panel, "phase_margin");
    const size_t last = phase->count - 1;
    check_close(phase->x[0], -1, 1e-12);
    check_close(atan2(phase->y[last], phase->x[last]) * 180 / M_PI, phase_margin() - 180,
                1e-3);
    owned_figure_destroy(o);
}

// The margins of a Bode plot reach from the curves to 0 dB and to -180 degrees at the
// crossovers, which are marked, as is the end of the answers.
TEST(a_bode_plot_tells_crossovers_and_margins)
{
    const scenario s = named_scenario();
    const linear_curve loop = {"loop gain", known_loop()};
    const linear_margins m = linear_margins_of(&loop.response);
    owned_figure *o = bode_figure_create(&s, &loop, 1, &m);
    const figure_series *gain = find_series(&o->panels[0], "gain_margin");
    check_relative(gain->x[0], phase_crossover / (2 * M_PI), 1e-5);
    check_close(gain->y[0], -20 * log10(2), 1e-4);
    check_close(gain->y[1], 0, 0);
    const figure_series *phase = find_series(&o->panels[1], "phase_margin");
    check_relative(phase->x[0], gain_crossover() / (2 * M_PI), 1e-5);
    check_close(phase->y[0], phase_margin() - 180, 1e-3);
    check_close(phase->y[1], -180, 0);

    assert_int_equal(o->figure.mark_count, 3);
    check_relative(o->figure.marks[0].x, gain_crossover() / (2 * M_PI), 1e-5);
    check_relative(o->figure.marks[1].x, phase_crossover / (2 * M_PI), 1e-5);
    check_relative(o->figure.marks[2].x, 100 / (2 * M_PI), 1e-12);

    // ticks of 45 degrees from 0 to -270
    const figure_axis *phases = &o->panels[1].y;
    assert_int_equal(phases->tick_count, 7);
    for (int i = 0; i < phases->tick_count; i++) {
        check_close(phases->ticks[i].value, -270 + 45 * i, 0);
    }
    owned_figure_destroy(o);
}

// Nothing leaves the page and no text covers another.
TEST(pictures_of_loops_are_tidy)
{
    const scenario s = named_scenario();
    const linear_curve loop = {"loop gain", known_loop()};
    const linear_margins m = linear_margins_of(&loop.response);
    for (EACH_OF(double, width, 60, 85, 180)) {
        owned_figure *plane = nyquist_figure_create(&s, &loop.response, &m);
        owned_figure *bode = bode_figure_create(&s, &loop, 1, &m);
        plane->figure.width = bode->figure.width = *width;
        expect_tidy(&plane->figure);
        expect_tidy(&bode->figure);
        owned_figure_destroy(plane);
        owned_figure_destroy(bode);
    }
}

ALL_BETWEEN(enter_folder, leave_plot_folder)
