// Panes that are not over time, and the panel of statistics.
#include "tests/explorer_on_screen.h"

#include <unistd.h>

TEST(test_a_spectrum_names_the_highest_line)
{
    SCOPED(explorer_finish) explorer ex;

    // the command follows a sine of 5 Hz on the commanded force
    open_explorer(&ex, "compare/force-pd");
    press(&ex, ":set control.force_amplitude 0.2<Enter>:set control.force_frequency 5<Enter><End>");
    press(&ex, ":zoom 0.7 1.5<Enter>:spectrum command<Enter>e");
    char *text = picture(&ex, 120, 40, GLYPHS_BRAILLE);
    assert_non_null(strstr(text, "highest at 5 Hz"));
    free(text);

    // a rise has no line at 0 Hz, where its mean was
    press(&ex, ":set control.force_amplitude 0<Enter>:zoom all<Enter>");
    text = picture(&ex, 120, 40, GLYPHS_BRAILLE);
    assert_non_null(strstr(text, "highest at "));
    assert_null(strstr(text, "highest at 0 Hz"));
    free(text);

    // a constant has none at all, rounding aside
    press(&ex,
          ":set control.law none<Enter>:set motor.voltage 0.1<Enter>:spectrum command<Enter>e");
    text = picture(&ex, 120, 40, GLYPHS_BRAILLE);
    assert_non_null(strstr(text, "constant, to [Hz]"));
    assert_null(strstr(text, "highest at "));
    free(text);
    press(&ex, ":spectrum<Enter>");
    assert_true(ex.state.message.warning);
    press(&ex, ":spectrum force gap<Enter>");
    assert_true(ex.state.message.warning);
}

TEST(test_a_phase_pane_ends_where_the_signals_end)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<End>:phase force gap<Enter>e");
    assert_int_equal(ex.state.panes.pane[PANES_OF_TABLE].signals[1], SIGNAL_INDEX(gap));
    char *text = picture(&ex, 120, 40, GLYPHS_BRAILLE);
    const trace *t = &ex.state.session.run.trace;
    char wanted[64], number[32];
    draw_number(number, sizeof number, trace_statistics(t, SIGNAL_INDEX(gap), 0, HUGE_VAL).maximum);
    snprintf(wanted, sizeof wanted, "gap %s", number);
    assert_non_null(strstr(text, wanted));
    assert_non_null(strstr(text, "force over gap"));
    free(text);

    // neither its axis nor a click in it does anything to the time
    const double now = ex.state.session.now;
    press(&ex, "vVaz");
    for (int i = 0; i < ex.layout.hit_count; i++) {
        const hit_area h = ex.layout.hits[i];
        if (h.part == PART_VIEW) {
            explorer_point(
                &ex, (pointer_event){POINTER_PRESS, h.area.x + 2, h.area.y + 1, false, false});
        }
    }
    check_close(ex.state.session.now, now, 0);
    press(&ex, ":trace force<Enter>");
    assert_int_equal(ex.state.panes.pane[PANES_OF_TABLE + 1].view, VIEW_TIME);
}

TEST(test_statistics_are_from_the_mark_to_the_cursor)
{
    char wanted[64], number[32];
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<End>:seek 0.45<Enter>m:seek 0.25<Enter>X");
    const signal_statistics s =
        trace_statistics(&ex.state.session.run.trace, SIGNAL_INDEX(force), 0.25, 0.45);
    draw_number(number, sizeof number, s.maximum);
    snprintf(wanted, sizeof wanted, "max %s", number);
    assert_shows(&ex, "mark and cursor, 0.25 to 0.45 s");
    assert_shows(&ex, wanted);
    draw_number(number, sizeof number, s.integral);
    snprintf(wanted, sizeof wanted, "integral %s N s", number);
    assert_shows(&ex, wanted);
    press(&ex, "X");
    assert_hides(&ex, "mark and cursor,");
}

// Rows of a run, written and laid under another one, are shifted so that both touch at once, or as
// they are told; what cannot be read leaves what is there.
TEST(test_measured_data_touch_when_the_run_does)
{
    char path[] = "/tmp/impactlab-data-XXXXXX", line[96];
    OPEN_EXPLORER(ex, "corrected/first-impact");
    const int file = mkstemp(path);
    FILE *stream = fdopen(file, "w");
    assert_non_null(stream);
    const trace *t = &ex.state.session.run.trace;
    fputs("time[ms],force[mN],encoder[rad]\n", stream);
    for (size_t r = 0; r < t->row_count; r++) {
        fprintf(stream, "%.17g,%.17g,\n", 1e3 * (t->rows[r].time + 0.125), 1e3 * t->rows[r].force);
    }
    fclose(stream);
    snprintf(line, sizeof line, ":data %s<Enter>", path);
    press(&ex, line);
    assert_int_equal(ex.state.measured.row_count, t->row_count);
    for (size_t r = 0; r < t->row_count; r++) {
        check_close(ex.state.measured.rows[r].time, t->rows[r].time, 1e-9);
        check_close(ex.state.measured.rows[r].force, t->rows[r].force, 1e-9);
        assert_true(isnan(ex.state.measured.rows[r].encoder));
    }
    static const struct {
        int width, height;
    } sizes[] = {{80, 24}, {100, 30}, {200, 60}};
    for (size_t i = 0; i < 3; i++) {
        assert_shows_at(&ex, sizes[i].width, sizes[i].height, "shifted by -0.125 s");
    }
    press(&ex, ":data /nowhere.csv<Enter>");
    assert_true(ex.state.message.warning);
    assert_int_equal(ex.state.measured.row_count, t->row_count);

    // beside pins, a difference, a sweep and another scenario, and by hand
    press(&ex, "b:set arm.k2 5<Enter>DD:sweep arm.k2=4:8:3<Enter>");
    free(picture(&ex, 80, 24, GLYPHS_BRAILLE));
    press(&ex, ":open compare/hybrid<Enter>u");
    free(picture(&ex, 100, 30, GLYPHS_BRAILLE));
    snprintf(line, sizeof line, ":data %s@0.5<Enter>", path);
    press(&ex, line);
    check_close(ex.state.measured.rows[0].time, 0.625, 1e-9);
    press(&ex, ":data off<Enter>");
    assert_int_equal(ex.state.measured.row_count, 0);
    free(picture(&ex, 200, 60, GLYPHS_BRAILLE));
    unlink(path);
}
