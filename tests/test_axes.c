// The axes of the explorer's curves: ranges, ticks, the visible part of the run, panes.
#include "tests/explorer_on_screen.h"

static void carry_out(explorer *ex, const char *line)
{
    fail_if(!explorer_carry_out(ex, line), "%s: %s", line, ex->input.message.text);
}

static void refuse(explorer *ex, const char *line)
{
    fail_if(explorer_carry_out(ex, line), "'%s' is taken", line);
    assert_true(ex->input.message.warning);
}

// A pane's axis after the screen was drawn.
static void check_axis(explorer *ex, int index, double low, double high)
{
    free(picture(ex, 120, 40, GLYPHS_BRAILLE));
    check_close(ex->layout.axes[index].low, low, 1e-9 + 1e-6 * fabs(low));
    check_close(ex->layout.axes[index].high, high, 1e-9 + 1e-6 * fabs(high));
}

// The automatic axis of the force ends at the largest force that is on the screen. The
// impact of this run is at 0.29 s, its peak at 0.36 s; later pulses stay below 0.95 N.
TEST(test_an_automatic_axis_spans_what_is_visible)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    double peak = ex.model.session.run.summary.first_pulse_peak_N;
    free(picture(&ex, 120, 40, GLYPHS_BRAILLE));
    check_relative(ex.layout.axes[0].high, peak, 1e-3);

    // before the impact there is no force, and the axis spans one newton about zero
    carry_out(&ex, "zoom 0.05 0.25");
    check_axis(&ex, 0, -0.5, 0.5);

    // late in the run the force is smaller than its peak
    carry_out(&ex, "zoom 0.85 1");
    free(picture(&ex, 120, 40, GLYPHS_BRAILLE));
    check_below(ex.layout.axes[0].high, 0.95);
}

// A range that was typed stays through zooms, the cursor and other runs. "axis in" halves
// it about its middle: from -1..4 to 1.5 +- 1.25; "axis up" moves it by a quarter of its
// length, 2.5/4 = 0.625.
TEST(test_a_fixed_axis_stays)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    carry_out(&ex, "axis -1 4 1");
    check_axis(&ex, 0, -1, 4);
    assert_shows(&ex, "fixed");
    carry_out(&ex, "zoom 0.3 0.4");
    carry_out(&ex, "seek 0.1");
    carry_out(&ex, "set motor.voltage 5");
    check_axis(&ex, 0, -1, 4);
    carry_out(&ex, "axis in 1");
    check_axis(&ex, 0, 0.25, 2.75);
    carry_out(&ex, "axis up 1");
    check_axis(&ex, 0, 0.875, 3.375);
    carry_out(&ex, "axis auto all");
    free(picture(&ex, 120, 40, GLYPHS_BRAILLE));
    assert_false(ex.view.panes.pane[0].is_fixed);
}

// Keys: w gives the next pane the focus, a fixes its axis and lets it go, v fixes
// the axis and zooms in, V zooms out, Shift with an arrow moves the axis, e shows the
// pane alone and then all again.
TEST(test_keys_change_the_axis_of_the_pane_in_focus)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    free(picture(&ex, 120, 40, GLYPHS_BRAILLE));
    press(&ex, "w");
    assert_int_equal(panes_focused(&ex.view.panes), 2);
    press(&ex, "a");
    assert_true(ex.view.panes.pane[2].is_fixed);
    check_close(ex.view.panes.pane[2].fixed.high, ex.layout.axes[2].high, 1e-12);
    press(&ex, "a");
    assert_false(ex.view.panes.pane[2].is_fixed);
    press(&ex, "v");
    assert_true(ex.view.panes.pane[2].is_fixed);
    assert_false(ex.view.panes.pane[0].is_fixed);
    press(&ex, "V<S-Up><S-Down>ww");
    assert_int_equal(panes_focused(&ex.view.panes), 0);

    // alone on the screen, the pane hides the legend of the others ("!": not shown)
    press_shows(&ex, "e", "!gap ");
    press_shows(&ex, "e", "gap ");

    // without any pane the keys say that there is none
    press_warns(&ex, ":panes<Enter>w", "");
    press_warns(&ex, "a", "");
    assert_shows(&ex, "no pane of curves");
}

// Ranges, scalings and panes that do not exist are refused and change no axis. The pane
// of chosen signals is number 10 for the user.
TEST(test_wrong_axes_are_told)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    for (EACH_TEXT(c, "axis", "axis 2 1", "axis 1 1", "axis 1", "axis nan 2",
                   "axis 0 x 1", "axis purple", "axis auto 25", "axis auto 0",
                   "axis 0 2 all more", "axis auto 1 2", "axis auto -1", "zoom", "zoom 1",
                   "zoom 2 1", "zoom 1 2 3", "pan", "pan nowhere", "pan left")) {
        refuse(&ex, *c);
    }
    assert_false(ex.view.panes.pane[0].is_fixed);
    carry_out(&ex, "trace impulse");
    carry_out(&ex, "axis 0 1 10");
    assert_shows(&ex, "10   N s");
    check_axis(&ex, PANES_OF_TABLE, 0, 1);

    // signals of different units each show their unit
    carry_out(&ex, "trace gap force");
    assert_shows(&ex, "gap 0.09983 m");
}

// Ticks stand at round numbers; where the part of the run is a millisecond long, at
// 0.2935 s with four digits.
TEST(test_ticks_are_round)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press_shows(&ex, ":seek 0.35<Enter>", "1.2\u2524", "0.0\u2524", "0.05\u2524",
                "0.5      ", "1.0 s");
    // the unit is next to the pane's number
    assert_shows(&ex, "\u25b81      N", " 3  rad/s");
    carry_out(&ex, "zoom 0.293 0.294");
    assert_shows(&ex, "0.2935");
}

// Keys: z halves the visible part; ( and ), or Shift-Left and Shift-Right, move it back
// and forth by a quarter; f lets it follow the cursor again; 0 shows the whole run of 1
// s.
TEST(test_the_visible_part_follows_the_cursor_until_it_is_panned)
{
    double from, to;
    OPEN_EXPLORER(ex, "corrected/first-impact");

    // half of a half: 0.25 s, with the cursor in it wherever it goes
    press(&ex, "zz");
    for (double t = 0; t <= 1; t += 0.07) {
        session_seek(&ex.model.session, t);
        free(picture(&ex, 120, 40, GLYPHS_BRAILLE));
        view_window(&ex.model, &ex.view, &from, &to);
        assert_true(from <= t && t <= to);
        check_close(to - from, 0.25, 1e-12);
    }

    // panned back by a quarter of it, 0.0625 s, and then to the start of the run
    carry_out(&ex, "seek 0.5");
    free(picture(&ex, 120, 40, GLYPHS_BRAILLE));
    view_window(&ex.model, &ex.view, &from, &to);
    press(&ex, "(");
    check_close(ex.view.window.from, from - 0.0625, 1e-12);
    press_draws(&ex, "<S-Left><S-Left><S-Left><S-Left><S-Left><S-Left><S-Left><S-Left>");
    check_close(ex.view.window.from, 0, 0);

    // following the cursor again; and the whole run
    press_draws(&ex, ")f");
    view_window(&ex.model, &ex.view, &from, &to);
    assert_true(from <= 0.5 && 0.5 <= to);
    carry_out(&ex, "pan 0.1");
    press(&ex, "0");
    view_window(&ex.model, &ex.view, &from, &to);
    check_close(from, 0, 0);
    check_close(to, 1, 0);

    // where the run became shorter, the visible part ends at its end
    carry_out(&ex, "zoom 0.9 1");
    carry_out(&ex, "set run.duration 0.5");
    free(picture(&ex, 120, 40, GLYPHS_BRAILLE));
    view_window(&ex.model, &ex.view, &from, &to);
    check_close(to, 0.5, 1e-12);
}

// The keys 2 and 8 switch panes: beside the physical signals a controlled run shows what
// its sensors read, what the law wants and what it commands.
TEST(test_a_controlled_run_shows_readings_and_commands)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":panes 123458<Enter>:seek 0.65<Enter>");
    KEPT_TEXT(text) = picture(&ex, 160, 60, GLYPHS_BRAILLE);
    for (EACH_TEXT(c, "force_reading", "calculated_force", "encoder", "desired_angle",
                   "tachometer", "command 2.284", "controller_mode force")) {
        fail_if(strstr(text, *c) == NULL, "'%s' is not on the screen:\n%s", *c, text);
    }

    // panes that the user chose stay in other scenarios; there the force's pane is
    // hidden, and with a control law it has three signals
    press(&ex, ":panes 4<Enter>:open corrected/first-impact<Enter>");
    assert_false(ex.view.panes.pane[0].shown);
    press(&ex, ":set control.law hybrid<Enter>");
    free(picture(&ex, 160, 60, GLYPHS_BRAILLE));
    assert_int_equal(ex.view.panes.pane[0].count, 3);
}

// The first row of the plot is the legend: a piece of each curve's line, beyond U+2000
// among the glyphs, stands before its name. The colours and lines of all of them differ.
TEST(test_curves_of_one_pane_look_different)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, ":panes 2<Enter>:seek 0.2<Enter>");
    SCOPED(screen_finish) screen s = {0};
    screen_resize(&s, 160, 50);
    explorer_draw(&ex, &s);
    area curves = ex.layout.plot;
    assert_true(curves.width > 0);

    // collect the pieces of lines in the legend
    ink inks[PANE_SIGNALS];
    uint32_t lines[PANE_SIGNALS];
    int count = 0;
    for (int x = curves.x; x < curves.x + curves.width && count < PANE_SIGNALS; x++) {
        cell c = s.cells[(long)curves.y * s.width + x];
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
}

// The range of an axis over a long run is taken from summaries of blocks of rows. It is
// exactly the range over the single rows of the visible part, which is computed here.
TEST(test_ranges_of_long_runs_are_exact)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    carry_out(&ex, "extend 99");
    carry_out(&ex, "seek end");
    const trace *t = &ex.model.session.run.trace;
    assert_true(t->row_count > 90000); // 100 s, some thousand rows a second
    int velocity = SIGNAL_INDEX(last_velocity), angle = SIGNAL_INDEX(last_angle);
    carry_out(&ex, "trace last_velocity last_angle");

    // parts with a start and an end within blocks [s]
    static const double parts[][2] = {{0.2, 0.7}, {0.3, 0.9}, {10, 90}, {0.29, 0.2935}};
    for (EACH(c, parts)) {
        double low = (double)INFINITY, high = (double)-INFINITY;
        carry_out(&ex, formatted("zoom %g %g", (*c)[0], (*c)[1]));
        state_update(&ex.model, &ex.view);
        for (size_t r = trace_row_at(t, ex.view.window.from);
             r <= trace_row_at(t, ex.view.window.to) + 1; r++) {
            const double one = signal_value(&t->rows[r], velocity);
            const double other = signal_value(&t->rows[r], angle);
            low = fmin(low, fmin(one, other));
            high = fmax(high, fmax(one, other));
        }

        // an axis about a constant is widened; every other one is the range itself
        value_range axis;
        assert_true(view_pane_axis(&ex.model, &ex.view, PANES_OF_TABLE, &axis));
        if (high - low > 1e-12) {
            check_close(axis.low, low, 0);
            check_close(axis.high, high, 0);
        }
    }

    // drawing the whole run with fixed axes is survived
    carry_out(&ex, "zoom all");
    carry_out(&ex, "axis fixed all");
    free(picture(&ex, 200, 60, GLYPHS_BRAILLE));
}

// Columns of the time axis that show contact, by a shaded glyph (U+2592). The row of the
// axis is known by its label, which begins with that glyph, too.
static int columns_in_contact(const screen *s)
{
    int columns = 0;
    for (int y = 0; y < s->height; y++) {
        const cell *row = s->cells + (long)y * s->width;
        bool of_axis = row[0].glyph == 0x2592;
        for (int x = 1; of_axis && x < s->width; x++) {
            columns += row[x].glyph == 0x2592;
        }
    }
    return columns;
}

// Touches of a few milliseconds are seen on an axis with some twenty milliseconds to the
// column: each of them shades those it lies in.
TEST(test_brief_touches_are_on_the_axis)
{
    SCOPED(screen_finish) screen s = {0};
    OPEN_EXPLORER(ex, "corrected/first-impact");
    carry_out(&ex, "set wall.contact hunt-crossley");
    carry_out(&ex, "seek 1");
    screen_resize(&s, 80, 24);
    explorer_draw(&ex, &s);
    assert_true(ex.model.session.run.summary.separations >= 5);

    // the columns that have a row in contact
    const trace *t = &ex.model.session.run.trace;
    const int width = ex.layout.plot.width;
    int columns = 0;
    for (int i = 0; i < width; i++) {
        bool touches = false;
        const size_t last = trace_row_at(t, (i + 1.0) / width);
        for (size_t r = trace_row_at(t, (double)i / width); r <= last; r++) {
            touches = touches || t->rows[r].contact != 0;
        }
        columns += touches;
    }
    assert_int_equal(columns_in_contact(&s), columns);
}
