// Panes that are not over time, and the panel of statistics.
#include "tests/explorer_on_screen.h"

TEST(test_a_spectrum_names_the_highest_line)
{
    SCOPED(explorer_finish) explorer ex;

    // the command follows a sine of 5 Hz on the commanded force
    open_changed(&ex, "compare/force-pd", "", HUGE_VAL);
    press_shows(&ex,
                ":set control.force_amplitude 0.2<Enter>:set control.force_frequency "
                "5<Enter><End>:zoom 0.7 1.5<Enter>:spectrum command<Enter>e",
                "highest at 5 Hz");

    // a rise has no line at 0 Hz, where its mean was
    press_shows(&ex, ":set control.force_amplitude 0<Enter>:zoom all<Enter>",
                "highest at ", "!highest at 0 Hz");

    // a constant has none at all, rounding aside
    press_shows(&ex,
                ":set control.law none<Enter>:set motor.voltage 0.1<Enter>:spectrum "
                "command<Enter>e",
                "constant, to [Hz]", "!highest at ");
    press_warns(&ex, ":spectrum<Enter>", "");
    press_warns(&ex, ":spectrum force gap<Enter>", "");
}

TEST(test_a_phase_pane_ends_where_the_signals_end)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<End>:phase force gap<Enter>e");
    assert_int_equal(ex.view.panes.pane[PANES_OF_TABLE].signals[1], SIGNAL_INDEX(gap));
    const trace *t = &ex.model.session.run.trace;
    const double most = trace_statistics(t, SIGNAL_INDEX(gap), 0, HUGE_VAL).maximum;
    assert_shows(&ex, formatted("gap %s", draw_number(most).text), "force over gap");

    // neither its axis nor a click in it does anything to the time
    const double now = ex.model.session.now;
    press(&ex, "vVaz");
    for (int i = 0; i < ex.layout.hit_count; i++) {
        const hit_area h = ex.layout.hits[i];
        if (h.part == PART_VIEW) {
            explorer_point(&ex, (pointer_event){POINTER_PRESS, h.area.x + 2, h.area.y + 1,
                                                false, false});
        }
    }
    check_close(ex.model.session.now, now, 0);
    press(&ex, ":trace force<Enter>");
    assert_int_equal(ex.view.panes.pane[PANES_OF_TABLE + 1].view, VIEW_TIME);
}

TEST(test_statistics_are_from_the_mark_to_the_cursor)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "<End>:seek 0.45<Enter>m:seek 0.25<Enter>X");
    const signal_statistics s =
        trace_statistics(&ex.model.session.run.trace, SIGNAL_INDEX(force), 0.25, 0.45);
    assert_shows(&ex, "mark and cursor, 0.25 to 0.45 s");
    assert_shows(&ex, formatted("max %s", draw_number(s.maximum).text));
    assert_shows(&ex, formatted("integral %s N s", draw_number(s.integral).text));
    press_shows(&ex, "X", "!mark and cursor,");
}

// Rows of a run, written and laid under another one, are shifted so that both touch at
// once, or as they are told; what cannot be read leaves what is there.
TEST_IN_FOLDER(test_measured_data_touch_when_the_run_does)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    FILE *stream = fopen("data.csv", "w");
    assert_non_null(stream);
    const trace *t = &ex.model.session.run.trace;
    fputs("time[ms],force[mN],encoder[rad]\n", stream);
    for (EACH_ROW(row, t)) {
        fprintf(stream, "%.17g,%.17g,\n", 1e3 * (row->time + 0.125), 1e3 * row->force);
    }
    fclose(stream);
    press(&ex, ":data data.csv<Enter>");
    assert_int_equal(ex.model.measured.row_count, t->row_count);
    for (size_t r = 0; r < t->row_count; r++) {
        check_close(ex.model.measured.rows[r].time, t->rows[r].time, 1e-9);
        check_close(ex.model.measured.rows[r].force, t->rows[r].force, 1e-9);
        assert_true(isnan(ex.model.measured.rows[r].encoder));
    }
    assert_shows_everywhere(&ex, "shifted by -0.125 s");
    press_warns(&ex, ":data /nowhere.csv<Enter>", "");
    assert_int_equal(ex.model.measured.row_count, t->row_count);

    // beside pins, a difference, a sweep and another scenario, and by hand
    press(&ex, "b:set arm.k2 5<Enter>DD:sweep arm.k2=4:8:3<Enter>");
    free(picture(&ex, 80, 24, GLYPHS_BRAILLE));
    press(&ex, ":open compare/hybrid<Enter>u");
    free(picture(&ex, 100, 30, GLYPHS_BRAILLE));
    press(&ex, ":data data.csv@0.5<Enter>");
    check_close(ex.model.measured.rows[0].time, 0.625, 1e-9);
    press(&ex, ":data off<Enter>");
    assert_int_equal(ex.model.measured.row_count, 0);
    free(picture(&ex, 200, 60, GLYPHS_BRAILLE));
}

TEST(test_a_pane_of_expressions)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press(&ex, "<End>:trace force - force_reading, max(force, 1)*2<Enter>");
    const pane *p = &ex.view.panes.pane[PANES_OF_TABLE];
    const sample *row = &ex.model.session.run.trace.rows[900];
    assert_int_equal(p->count, 2);
    check_close(signal_value(row, p->signals[0]), row->force - row->force_reading, 0);
    check_close(signal_value(row, p->signals[1]), 2 * fmax(row->force, 1), 0);
    assert_string_equal(signal_table[p->signals[0]].unit, "N");
    assert_shows(&ex, "force-force_reading");

    // units: of a product none, of a share that of the whole
    press(&ex, ":trace force*gap, gap/2, force+gap<Enter>");
    p = &ex.view.panes.pane[PANES_OF_TABLE + 1];
    assert_string_equal(signal_table[p->signals[0]].unit, "");
    assert_string_equal(signal_table[p->signals[1]].unit, "m");
    assert_string_equal(signal_table[p->signals[2]].unit, "");

    // a difference of an expression means nothing, the pane says so
    press_shows(&ex, "b:set arm.k2 5<Enter>D", "an expression has no difference");
    press(&ex, "XXD:signal gap/2 11<Enter>");
    assert_int_equal(p->hidden, 2);
    press(&ex, ":phase force*2, gap<Enter>:spectrum command-voltage<Enter>X");
    free(picture(&ex, 80, 24, GLYPHS_BRAILLE));

    // what cannot be read says where; nothing is added
    static const struct {
        const char *line, *says;
    } wrong[] = {{":trace force - forc<Enter>", "did you mean 'force'?"},
                 {":trace force -<Enter>", "at the end"},
                 {":trace force gap time contact impulse<Enter>", "at most 4"},
                 {":trace forc<Enter>", "there is no signal 'forc'"}};
    const int before = ex.view.panes.focus;
    for (EACH(c, wrong)) {
        press_warns(&ex, c->line, c->says);
        assert_int_equal(ex.view.panes.focus, before);
    }

    // more than there are places for: a sentence; one whose pane was replaced is free
    // again
    for (int i = 0; i < 40; i++) {
        press_text(&ex, ":trace force+%d, gap+%d<Enter>", i, i);
    }
    assert_non_null(strstr(ex.input.message.text, "expressions are shown already"));
    free(picture(&ex, 120, 40, GLYPHS_BRAILLE));
}

TEST(a_spike_of_a_reading_sets_no_range_beside_the_force)
{
    // the reading's spike of 6 N is a few samples long, the force stays below 2 N
    value_range wide, force;
    OPEN_EXPLORER(ex, "compare/hybrid");
    press_draws(&ex, ":trace force_reading<Enter><End>");
    assert_true(view_pane_axis(&ex.model, &ex.view, PANES_OF_TABLE, &wide));
    assert_true(wide.high > 4);

    // beside the force it sets no range: that is the force's and what is to be held
    assert_true(view_pane_axis(&ex.model, &ex.view, 0, &force));
    check_close(force.high, ex.model.session.run.summary.peak_force_N, 1e-9);
}
