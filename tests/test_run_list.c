// Several runs: pinning, comparing, going on with one of them, differences and sweeps.
#include "tests/explorer_on_screen.h"

TEST(test_runs_are_pinned_with_what_was_changed)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    const run_list *list = &ex.model.pinned;
    press(&ex, "b:seek 0.1<Enter>:set motor.voltage 0.5<Enter>b");
    assert_int_equal(list->count, 2);
    assert_string_equal(list->runs[0].name, "as opened");
    assert_string_equal(list->runs[1].name, "voltage 0.5 from 0.1 s");

    // the same run is not pinned twice, another is the baseline again
    press(&ex, "b");
    assert_int_equal(list->count, 2);
    assert_int_equal(list->baseline, 1);
    press(&ex, ":baseline 1<Enter>");
    check_close(ex.model.session.other.summary.peak_force_N,
                list->runs[0].run.summary.peak_force_N, 0);

    // what differs, in both directions
    char text[LINE_TEXT];
    press(&ex, ":seek 0<Enter>:set arm.k2 5<Enter>");
    run_list_differences(&list->runs[1], &ex.model.session, text, sizeof text);
    assert_string_equal(text, "(now: k2 5)");
    press(&ex, "uu");
    run_list_differences(&list->runs[1], &ex.model.session, text, sizeof text);
    assert_string_equal(text, "voltage 0.5 from 0.1 s");
}

// A number that is cut reads like another one.
TEST(test_names_are_cut_between_words)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.1234<Enter>:set motor.voltage 0.25<Enter>b");
    const char name[] = "voltage 0.25 from 0.1234 s";
    assert_string_equal(ex.model.pinned.runs[0].name, name);
    assert_shows_at(&ex, 100, 40, "voltage 0.25 from… ");
    assert_shows_at(&ex, 100, 40, formatted("!%s", name));

    // where there is room it is whole, also one that is long
    press_shows(&ex,
                "B:pin of the second series, with 12345678901234567890 samples<Enter>R",
                "of the second series, with… ");
    press_shows(&ex, "r", "with 12345678901234567890 samples");
}

TEST(test_no_more_than_seven_and_none_is_lost)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    for (int i = 0; i < PINNED_RUNS; i++) {
        press_text(&ex, ":set arm.k2 %d<Enter>b", 4 + i);
    }
    assert_int_equal(ex.model.pinned.count, PINNED_RUNS);
    press_warns(&ex, ":set arm.k2 20<Enter>b", "7 runs are pinned already");
    assert_int_equal(ex.model.pinned.count, PINNED_RUNS);

    // dropping the baseline leaves another one, dropping all leaves none
    for (int i = 0; i < PINNED_RUNS; i++) {
        assert_true(ex.model.session.has_other);
        press(&ex, "B");
    }
    assert_int_equal(ex.model.pinned.count, 0);

    // then the run as opened is the reference again
    assert_true(ex.model.session.has_other);
    assert_string_equal(model_reference_name(&ex.model), "as opened");
}

TEST(test_taking_a_run_brings_all_of_it_back)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    const double opened = peak(&ex);
    press(&ex, ":seek 0.1<Enter>b:set motor.voltage 0.5<Enter>");
    const double halved = peak(&ex);
    assert_true(fabs(halved - opened) > 0.1);

    // the other way round: the present one is pinned and compared with
    press(&ex, ":take 1<Enter>");
    check_close(peak(&ex), opened, 0);
    check_close(ex.model.session.other.summary.peak_force_N, halved, 0);
    assert_int_equal(ex.model.session.input_count, 0);
    press(&ex, ":take 2<Enter>");
    check_close(peak(&ex), halved, 0);
    press(&ex, "u");
    check_close(peak(&ex), opened, 0);
}

TEST(test_hidden_runs_are_not_drawn)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "b:set arm.k2 5<Enter>b:set arm.k2 6<Enter>");
    assert_int_equal(model_run_count(&ex.model), 3);
    press(&ex, ":hide 1<Enter>");
    assert_int_equal(model_run_count(&ex.model), 2);
    assert_string_equal(ex.model.pinned.runs[1].name, "k2 5");

    // by keys on the page, and back
    press(&ex, "R<Up><Up> <Esc>");
    assert_int_equal(model_run_count(&ex.model), 3);
    press(&ex, ":rename 1 soft arm<Enter>");
    assert_string_equal(ex.model.pinned.runs[0].name, "soft arm");
}

TEST(test_a_run_of_a_few_rows_is_pinned_too)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":set run.duration 0.005<Enter>b");
    assert_int_equal(ex.model.pinned.count, 1);
    press(&ex, ":set motor.voltage<Enter>>");
    assert_int_equal(model_run_count(&ex.model), 3);
}

TEST(test_the_difference_is_that_of_the_runs)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":seek 0.1<Enter>b");

    // of the run from itself nothing
    press(&ex, "D");
    free(picture(&ex, 100, 30, GLYPHS_BRAILLE));
    check_close(difference_first_beyond(&ex.model.difference, SIGNAL_INDEX(force), 0), -1,
                0);

    // rows are the same up to a change, and then as far apart as the voltages
    press(&ex, ":set motor.voltage 0.5<Enter>");
    free(picture(&ex, 100, 30, GLYPHS_BRAILLE));
    const run_difference *d = &ex.model.difference;
    const int voltage = SIGNAL_INDEX(voltage), angle = SIGNAL_INDEX(hub_angle);
    check_close(difference_first_beyond(d, voltage, 0.1), 0.1, 1e-9);
    assert_true(difference_first_beyond(d, angle, 0) > 0.1);
    const trace *t = &d->trace;
    check_close(signal_value(LAST_ROW(t), voltage), -0.5, 1e-15);
    assert_shows(&ex, "minus baseline");
    press(&ex, "D");
    assert_int_equal(model_run_count(&ex.model), 2);
}

// Contact, sticking and modes are no amounts: beside the differences they are the present
// run's, in the curves, at the cursor, in the lanes and in the statistics.
TEST(test_states_are_not_subtracted)
{
    OPEN_EXPLORER(ex, "compare/hybrid");
    press_draws(&ex, ":seek 0.4<Enter>b:set control.force 2<Enter>:seek 1<Enter>8D");
    const trace *d = &ex.model.difference.trace, *run = &ex.model.session.run.trace;
    double forces = 0;
    assert_true(d->row_count > 1000);
    for (size_t i = 0; i < d->row_count; i++) {
        for (int k = 0; k < signal_count; k++) {
            const double value = signal_value(&d->rows[i], k);
            assert_true(!signal_is_state(k) || value == signal_value(&run->rows[i], k));
            forces += k == SIGNAL_INDEX(force) && value != signal_value(&run->rows[i], k);
        }
    }
    assert_true(forces > 100);
    assert_shows(&ex, "mode force  \u254c contact 1", "are this run's; D shows",
                 "!stick 1                    minus baseline");
    press_shows(&ex, "X", "minus baseline, visible part");
}

// An integral over time has a unit of its own, where the panel is narrow, too.
TEST(test_an_integral_has_its_own_unit)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, "X:trace force gap_velocity hub_acceleration contact<Enter>");
    for (int narrow = 0; narrow < 2; narrow++) {
        KEPT_TEXT(text) = picture(&ex, narrow ? 100 : 140, 40, GLYPHS_BRAILLE);
        char *line = text;
        for (EACH_TEXT(c, " N s ", " m ", " rad/s ")) {
            line = strstr(line + 1, narrow ? "\u222b" : "integral");
            assert_non_null(line);
            const size_t length = strcspn(line, "\n");
            const char *unit = memmem(line, length, *c, strlen(*c));
            fail_if(unit == NULL, "no '%s' in '%.*s'", *c, (int)length, line);
        }

        // a state has the time that it is on
        assert_non_null(strstr(line, " s in all"));
    }
}

TEST(test_a_sweep_gives_what_single_runs_give)
{
    OPEN_EXPLORER(ex, "corrected/first-impact");
    press(&ex, ":sweep motor.voltage=0.5:2:4<Enter>");
    const lab_sweep *swept = &ex.model.sweep;
    assert_int_equal(swept->count, 4);
    assert_int_equal(model_run_count(&ex.model), 5);
    assert_shows(&ex, "sweep motor.voltage, 4 of 4");

    // the run of a row, opened, is that run; u leads back
    const double opened = peak(&ex);
    press(&ex, "<Down><Down><Enter>");
    check_close(swept->runs[2].value, 1.5, 1e-15);
    check_close(peak(&ex), swept->runs[2].run.summary.peak_force_N, 0);
    press(&ex, "u");
    check_close(peak(&ex), opened, 0);

    // another metric, and the end
    press(&ex, ":metric contact_impulse_Ns<Enter>");
    assert_int_equal(swept->metric, SUMMARY_INDEX(contact_impulse_Ns));
    press(&ex, "<Esc>");
    assert_int_equal(model_run_count(&ex.model), 1);

    // what cannot be run says so
    press_warns(&ex, ":sweep motor.voltage=1:2:40<Enter>", "");
    press(&ex, ":sweep stiction=0.01:0.05:3<Enter>");
    assert_int_equal(swept->axis.parameter, PARAMETER_INDEX(motor.stiction));
    assert_shows_at(&ex, 80, 24, "sweep motor.stiction, 3 of 3");
    press(&ex, ":sweep viscous_friction=0.01:0.05:3<Enter>");
    assert_shows_at(&ex, 80, 24, "─ viscous_friction, 3 of 3 ─");
    press(&ex, ":sweep sensor.accelerometer_rise_time=0.001:0.002:3<Enter>");
    assert_shows_at(&ex, 80, 24, "─ accelerometer_rise.., 3 of 3 ─");
    press_shows(&ex, ":sweep motor.volts=1:2:4<Enter>", "did you mean");
}
