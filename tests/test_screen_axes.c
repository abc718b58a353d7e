// The axes of the terminal lab's curves: ranges, ticks, the visible part of the run, panes.
#include "tests/lab_on_screen.h"

#include <time.h>

static void carry_out(lab *l, const char *line)
{
    if (!lab_carry_out(l, line)) {
        fail_msg("%s: %s", line, l->message);
    }
}

static void refuse(lab *l, const char *line)
{
    if (lab_carry_out(l, line)) {
        fail_msg("'%s' is taken", line);
    }
    assert_true(l->warning);
}

// A pane's axis after the screen was drawn.
static void check_axis(lab *l, int pane, double low, double high)
{
    free(picture(l, 120, 40, GLYPHS_BRAILLE));
    check_close(l->panes[pane].drawn_low, low, 1e-9 + 1e-6 * fabs(low));
    check_close(l->panes[pane].drawn_high, high, 1e-9 + 1e-6 * fabs(high));
}

static void test_an_automatic_axis_spans_what_is_visible(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    double peak = l.session.run.summary.first_pulse_peak_N;
    free(picture(&l, 120, 40, GLYPHS_BRAILLE));
    check_relative(l.panes[0].drawn_high, peak, 1e-3);
    // before the impact there is no force, and then a smaller one
    carry_out(&l, "zoom 0.05 0.25");
    check_axis(&l, 0, -0.5, 0.5);
    carry_out(&l, "zoom 0.85 1");
    free(picture(&l, 120, 40, GLYPHS_BRAILLE));
    check_below(l.panes[0].drawn_high, 0.95);
    lab_finish(&l);
}

static void test_a_growing_axis_never_shrinks(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    carry_out(&l, "axis grow 1");
    double highest = 0;
    for (double t = 0; t <= 1; t += 0.05) {
        session_seek(&l.session, t);
        free(picture(&l, 120, 40, GLYPHS_BRAILLE));
        assert_true(l.panes[0].drawn_high >= highest);
        highest = l.panes[0].grown_high > highest ? l.panes[0].grown_high : highest;
        // what is still to come does not count
        assert_true(t > 0.36 ||
                    l.panes[0].grown_high < l.session.run.summary.first_pulse_peak_N * 0.999);
    }
    check_relative(highest, l.session.run.summary.first_pulse_peak_N, 1e-3);
    // neither going back nor a weaker run makes it shrink
    carry_out(&l, "seek 0.1");
    carry_out(&l, "set motor.voltage 0.3");
    check_axis(&l, 0, 0, highest);
    lab_finish(&l);
}

static void test_a_fixed_axis_stays(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    carry_out(&l, "axis -1 4 1");
    check_axis(&l, 0, -1, 4);
    assert_shows(&l, "fixed");
    carry_out(&l, "zoom 0.3 0.4");
    carry_out(&l, "seek 0.1");
    carry_out(&l, "set motor.voltage 5");
    check_axis(&l, 0, -1, 4);
    carry_out(&l, "axis in 1");
    check_axis(&l, 0, 0.25, 2.75);
    carry_out(&l, "axis up 1");
    check_axis(&l, 0, 0.875, 3.375);
    carry_out(&l, "axis auto all");
    free(picture(&l, 120, 40, GLYPHS_BRAILLE));
    assert_int_equal(l.panes[0].axis, AXIS_AUTO);
    lab_finish(&l);
}

static void test_keys_change_the_axis_of_the_pane_in_focus(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    free(picture(&l, 120, 40, GLYPHS_BRAILLE));
    press(&l, "w");
    assert_int_equal(lab_focused_pane(&l), 2);
    press(&l, "a");
    assert_int_equal(l.panes[2].axis, AXIS_GROW);
    press(&l, "a");
    assert_int_equal(l.panes[2].axis, AXIS_FIXED);
    press(&l, "a");
    assert_int_equal(l.panes[2].axis, AXIS_AUTO);
    press(&l, "v");
    assert_int_equal(l.panes[2].axis, AXIS_FIXED);
    assert_int_equal(l.panes[0].axis, AXIS_AUTO);
    press(&l, "V<S-Up><S-Down>ww");
    assert_int_equal(lab_focused_pane(&l), 0);
    // alone it has all rows
    press(&l, "e");
    assert_hides(&l, "gap ");
    press(&l, "e");
    assert_shows(&l, "gap ");
    press(&l, ":panes<Enter>w");
    assert_true(l.warning);
    press(&l, "a");
    assert_true(l.warning);
    assert_shows(&l, "no pane of curves");
    lab_finish(&l);
}

static void test_wrong_axes_are_told(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    static const char *const wrong[] = {
        "axis",          "axis 2 1",     "axis 1 1",     "axis 1",      "axis nan 2",
        "axis 0 x 1",    "axis purple",  "axis auto 11", "axis auto 0", "axis 0 2 all more",
        "axis auto 1 2", "axis auto -1", "zoom",         "zoom 1",      "zoom 2 1",
        "zoom 1 2 3",    "pan",          "pan nowhere",  "pan left"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        refuse(&l, wrong[i]);
    }
    assert_int_equal(l.panes[0].axis, AXIS_AUTO);
    carry_out(&l, "trace impulse");
    carry_out(&l, "axis 0 1 0");
    assert_shows(&l, "0    N s");
    check_axis(&l, LAB_PANES - 1, 0, 1);
    // signals of several units tell each its own
    carry_out(&l, "trace gap force");
    assert_shows(&l, "gap 0.09983 m");
    lab_finish(&l);
}

static void test_ticks_are_round(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    press(&l, ":seek 0.35<Enter>");
    assert_shows(&l, "1.2\u2524");
    assert_shows(&l, "0.0\u2524");
    assert_shows(&l, "0.05\u2524");
    assert_shows(&l, "0.5      ");
    assert_shows(&l, "1.0 s");
    // the unit stands beside the pane's number
    assert_shows(&l, "\u25b81      N");
    assert_shows(&l, " 3  rad/s");
    carry_out(&l, "zoom 0.293 0.294");
    assert_shows(&l, "0.2935");
    lab_finish(&l);
}

static void test_the_visible_part_follows_the_cursor_until_it_is_panned(void **state)
{
    (void)state;
    lab l;
    double from, to;
    open_lab(&l, "corrected/first-impact");
    press(&l, "zz");
    for (double t = 0; t <= 1; t += 0.07) {
        session_seek(&l.session, t);
        free(picture(&l, 120, 40, GLYPHS_BRAILLE));
        lab_window(&l, &from, &to);
        assert_true(from <= t && t <= to);
        check_close(to - from, 0.25, 1e-12);
    }
    carry_out(&l, "seek 0.5");
    free(picture(&l, 120, 40, GLYPHS_BRAILLE));
    lab_window(&l, &from, &to);
    press(&l, "(");
    check_close(l.from, from - 0.0625, 1e-12);
    press(&l, "<S-Left><S-Left><S-Left><S-Left><S-Left><S-Left><S-Left><S-Left>");
    free(picture(&l, 120, 40, GLYPHS_BRAILLE));
    check_close(l.from, 0, 0);
    press(&l, ")f");
    free(picture(&l, 120, 40, GLYPHS_BRAILLE));
    lab_window(&l, &from, &to);
    assert_true(from <= 0.5 && 0.5 <= to);
    carry_out(&l, "pan 0.1");
    press(&l, "0");
    lab_window(&l, &from, &to);
    check_close(from, 0, 0);
    check_close(to, 1, 0);
    // a run that became shorter
    carry_out(&l, "zoom 0.9 1");
    carry_out(&l, "set run.duration 0.5");
    free(picture(&l, 120, 40, GLYPHS_BRAILLE));
    lab_window(&l, &from, &to);
    check_close(to, 0.5, 1e-12);
    lab_finish(&l);
}

static void test_a_controlled_run_shows_readings_and_commands(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "compare/hybrid");
    press(&l, ":seek 0.65<Enter>28");
    char *text = picture(&l, 160, 60, GLYPHS_BRAILLE);
    static const char *const wanted[] = {
        "force_reading", "calculated_force",     "encoder", "desired_angle", "tachometer",
        "command 2.284", "controller_mode force"};
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        if (strstr(text, wanted[i]) == NULL) {
            fail_msg("'%s' is not on the screen:\n%s", wanted[i], text);
        }
    }
    free(text);
    // the same panes as before where the user chose them
    press(&l, ":panes 4<Enter>:open corrected/first-impact<Enter>");
    assert_false(l.panes[0].shown);
    press(&l, ":set control.law hybrid<Enter>");
    free(picture(&l, 160, 60, GLYPHS_BRAILLE));
    assert_int_equal(l.panes[0].count, 3);
    lab_finish(&l);
}

static void test_curves_of_one_pane_look_different(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "compare/hybrid");
    press(&l, ":panes 2<Enter>:seek 0.2<Enter>");
    screen s = {0};
    assert_true(screen_resize(&s, 160, 50));
    lab_draw(&l, &s);
    const lab_spot *curves = NULL;
    for (int i = 0; i < l.spot_count; i++) {
        curves = l.spots[i].part == PART_CURVES ? &l.spots[i] : curves;
    }
    assert_non_null(curves);
    // each of the four in the legend has its own colour and line
    ink inks[PANE_SIGNALS];
    uint32_t lines[PANE_SIGNALS];
    int count = 0;
    for (int x = curves->x; x < curves->x + curves->width && count < PANE_SIGNALS; x++) {
        cell c = s.cells[(long)curves->y * s.width + x];
        if (c.glyph > 0x2000) {
            inks[count] = c.ink;
            lines[count++] = c.glyph;
        }
    }
    assert_int_equal(count, PANE_SIGNALS);
    for (int i = 0; i < count; i++) {
        for (int j = 0; j < i; j++) {
            assert_int_not_equal(inks[i], inks[j]);
            assert_int_not_equal(lines[i], lines[j]);
        }
    }
    screen_finish(&s);
    lab_finish(&l);
}

// Blocks of rows give the same range as the rows themselves.
static void test_ranges_of_long_runs_are_exact_and_quick(void **state)
{
    (void)state;
    lab l;
    open_lab(&l, "corrected/first-impact");
    carry_out(&l, "extend 99");
    carry_out(&l, "seek end");
    const trace *t = &l.session.run.trace;
    assert_true(t->row_count > 90000);
    int velocity = SIGNAL_INDEX(last_velocity), angle = SIGNAL_INDEX(last_angle);
    carry_out(&l, "trace last_velocity last_angle");
    static const double parts[][2] = {{0.2, 0.7}, {0.3, 0.9}, {10, 90}, {0.29, 0.2935}};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        char line[64];
        double low = (double)INFINITY, high = (double)-INFINITY;
        snprintf(line, sizeof line, "zoom %g %g", parts[i][0], parts[i][1]);
        carry_out(&l, line);
        for (size_t r = trace_row_at(t, l.from); r <= trace_row_at(t, l.to) + 1; r++) {
            low = fmin(low,
                       fmin(signal_value(&t->rows[r], velocity), signal_value(&t->rows[r], angle)));
            high = fmax(
                high, fmax(signal_value(&t->rows[r], velocity), signal_value(&t->rows[r], angle)));
        }
        double from, to;
        assert_true(lab_pane_axis(&l, LAB_PANES - 1, &from, &to));
        if (high - low > 1e-12) {
            check_close(from, low, 0);
            check_close(to, high, 0);
        }
    }
    carry_out(&l, "zoom all");
    carry_out(&l, "axis grow all");
    struct timespec before, after;
    free(picture(&l, 200, 60, GLYPHS_BRAILLE));
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &before);
    for (int i = 0; i < 10; i++) {
        free(picture(&l, 200, 60, GLYPHS_BRAILLE));
    }
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &after);
    double seconds =
        (double)(after.tv_sec - before.tv_sec) + 1e-9 * (double)(after.tv_nsec - before.tv_nsec);
    // far below a sixtieth of a second without a sanitizer
    check_below(seconds / 10, 0.1);
    lab_finish(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_an_automatic_axis_spans_what_is_visible),
        cmocka_unit_test(test_a_growing_axis_never_shrinks),
        cmocka_unit_test(test_a_fixed_axis_stays),
        cmocka_unit_test(test_keys_change_the_axis_of_the_pane_in_focus),
        cmocka_unit_test(test_wrong_axes_are_told),
        cmocka_unit_test(test_ticks_are_round),
        cmocka_unit_test(test_the_visible_part_follows_the_cursor_until_it_is_panned),
        cmocka_unit_test(test_a_controlled_run_shows_readings_and_commands),
        cmocka_unit_test(test_curves_of_one_pane_look_different),
        cmocka_unit_test(test_ranges_of_long_runs_are_exact_and_quick),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
