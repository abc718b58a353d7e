#include "src/study/convergence.h"

#include <threads.h>

#include "tests/arm_fixture.h"

TEST(the_order_of_made_up_errors_is_found)
{
    for (int p = 1; p <= 4; p++) {
        double value[3];
        for (int i = 0; i < 3; i++) {
            value[i] = 5 + 0.3 * pow(0.5, p * i);
        }
        check_close(observed_order(value[0], value[1], value[2]), p, 1e-9);
    }
    // rounding, differences of two signs and such that grow tell nothing
    assert_true(isnan(observed_order(1, 1 + 1e-15, 1 - 1e-15)));
    assert_true(isnan(observed_order(1, 2, 1.5)));
    assert_true(isnan(observed_order(1, 1.1, 1.3)));
    assert_true(isnan(observed_order(1, 1.25, 1.5)));

    // differences that are rounding of large values
    assert_true(isnan(observed_order(0x1p20, 0x1p20 + 0x1p-28, 0x1p20 + 0x3p-29)));
    check_close(observed_order(0x1p20, 0x1p20 + 0x1p-18, 0x1p20 + 0x3p-19), 1, 1e-12);
    assert_true(isnan(observed_order((double)NAN, 1, 2)));
}

static convergence_panel panel_of(const char *const *settings)
{
    scenario s = {.name = (char *)"test", .parameters = fixture_parameters(settings)};
    convergence_panel panel;
    DONE(convergence_compute(&s, NULL, NULL, &panel, &f));
    return panel;
}

static const convergence_row *row_of(const convergence_panel *panel, const char *key)
{
    for (int i = 0; i < panel->row_count; i++) {
        if (strcmp(panel->rows[i].key, key) == 0) {
            return &panel->rows[i];
        }
    }
    fail_msg("no row %s", key);
    return NULL;
}

TEST(the_implicit_methods_are_of_second_order_through_impacts)
{
    for (EACH_TEXT(c, "method.name=newmark", "method.name=generalized-alpha")) {
        convergence_panel panel = panel_of(given("%s", *c));
        check_close(panel.setting[0], 1e-3, 0);
        check_close(panel.setting[2], 2.5e-4, 0);
        for (EACH_TEXT(key, "first_contact_s", "contact_impulse_Ns", "first_pulse_peak_N",
                       "steady_force_N", "motor_work_J")) {
            check_close(row_of(&panel, *key)->order, 2, 0.15);
        }
    }
}

TEST(the_event_method_needs_no_shorter_step)
{
    convergence_panel panel = panel_of(given("method.step=2e-3"));
    for (int i = 0; i < 2; i++) {
        const convergence_row *peak = row_of(&panel, "first_pulse_peak_N");
        check_relative(peak->value[i], peak->value[2], 1e-9);
        check_close(row_of(&panel, "first_contact_s")->value[i],
                    row_of(&panel, "first_contact_s")->value[2], 1e-10);
    }
}

TEST(the_digits_that_two_numbers_share_are_counted)
{
    for (int n = 1; n <= 12; n++) {
        check_close(shared_digits(3, 3 * (1 - pow(10, -n))), n, 1e-2);
        check_close(shared_digits(-3e-9 * (1 - pow(10, -n)), -3e-9), n, 1e-2);
    }
    check_close(shared_digits(0.1, 0.1), 15, 0);
    check_close(shared_digits(0, 0), 15, 0);
    check_close(shared_digits(1, -1), 0, 0);
    check_close(shared_digits(0, 1), 0, 0);
    assert_true(isnan(shared_digits(1, (double)NAN)));
}

// What the stiff engine integrates is refined by its tolerance: the first and the last
// run share the more digits the smaller it is. Of the first engine the step alone
// differs.
TEST(the_stiff_engine_is_refined_by_its_tolerance)
{
    double before = 0;
    for (EACH_TEXT(tolerance, "1e-4", "1e-6", "1e-8", "1e-10")) {
        const convergence_panel panel =
            panel_of(given("arm.links=3 method.tolerance=%s", *tolerance));
        assert_true(panel.of_tolerance);
        check_relative(panel.setting[2], 0.01 * panel.setting[0], 1e-15);
        const convergence_row *contact = row_of(&panel, "first_contact_s");
        assert_true(contact->digits > before);
        assert_true(isnan(contact->order));
        before = contact->digits;
    }
    assert_true(before > 11);
    const convergence_panel pair = panel_of(given("arm.links=2"));
    assert_false(pair.of_tolerance);
    assert_true(isnan(row_of(&pair, "first_contact_s")->digits));
}

// The least tolerance has no hundredth.
TEST(a_tolerance_without_a_hundredth_is_refused)
{
    const scenario s = {.name = (char *)"test",
                        .parameters =
                            parameters_with("arm.links=3 method.tolerance=5e-12")};
    convergence_panel panel;
    fault f = {0};
    assert_int_equal(convergence_compute(&s, NULL, NULL, &panel, &f),
                     STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "expected 1e-11 at least"));
    assert_int_equal(panel.done, 0);
}

// Before and after an event are two rows of one instant, which belong side by side: the
// force jumps by newtons there, and the runs differ by rounding.
TEST(rows_at_an_event_are_compared_in_their_order)
{
    enum { ROWS = 3000 };
    static double x[ROWS], y[ROWS];
    run_result results[2];
    for (int i = 0; i < 2; i++) {
        scenario s = {.name = (char *)"test", .parameters = fixture_parameters(NULL)};
        s.parameters.method.step = i == 0 ? 1e-3 : 5e-4;
        results[i] = run_done(&s, true);
    }
    const trace *coarse = &results[0].trace;
    assert_true(coarse->row_count < ROWS);
    size_t count = convergence_difference(coarse, &results[1].trace, x, y);
    assert_true(count >= 1000);
    for (size_t i = 0; i < count; i++) {
        check_close(y[i], 0, 1e-7);
    }
    run_finish(&results[0]);
    run_finish(&results[1]);
}

// Only instants that both traces have are compared, whichever has more, and each row
// once.
TEST(instants_of_one_trace_only_are_left_out)
{
    enum { ROWS = 40 };
    for (int kind = 0; kind < 6; kind++) {
        // multiples of two steps, one of which may begin later, end earlier or have
        // double rows
        const int step[2] = {(int[]){2, 3, 1, 4, 2, 5}[kind],
                             (int[]){1, 2, 3, 1, 3, 7}[kind]};
        const int from[2] = {kind % 2 ? 6 : 0, kind % 3 ? 0 : 12},
                  until[2] = {30, 22 + 3 * kind};
        sample rows[2][ROWS] = {0};
        trace both[2] = {{.rows = rows[0]}, {.rows = rows[1]}};
        for (int t = 0; t < 2; t++) {
            for (int time = from[t]; time <= until[t] && both[t].row_count < ROWS;
                 time += step[t]) {
                rows[t][both[t].row_count++] =
                    (sample){.time = time, .force = (t + 1) * time + 5 * t};
            }
        }

        double x[ROWS], y[ROWS];
        const size_t count = convergence_difference(&both[0], &both[1], x, y);
        size_t expected = 0;
        for (int time = 0; time <= 60; time++) {
            bool shared = true;
            for (int t = 0; t < 2; t++) {
                shared = shared && time >= from[t] && time <= until[t] &&
                         (time - from[t]) % step[t] == 0;
            }
            if (shared) {
                assert_true(expected < count);
                check_close(x[expected], time, 0);
                check_close(y[expected++], time - (2 * time + 5), 0);
            }
        }
        assert_int_equal(count, expected);
    }

    // nothing to compare with
    sample alone = {.time = 1, .force = 2};
    double x[1], y[1];
    const trace one = {.rows = &alone, .row_count = 1}, none = {0};
    assert_int_equal(convergence_difference(&one, &none, x, y), 0);
    assert_int_equal(convergence_difference(&none, &one, x, y), 0);
}

TEST(a_run_that_fails_is_told_with_its_step)
{
    scenario s = {.name = (char *)"test",
                  .parameters = parameters_with(
                      "method.name=newmark method.gamma=0.3 arm.links=8 run.duration=3")};
    convergence_panel panel;
    REFUSED(STATUS_UNSTABLE, "with a step of 0.001 s",
            convergence_compute(&s, NULL, NULL, &panel, &f));

    // and nothing of it or of those behind it is taken for a result
    assert_int_equal(panel.done, 0);
    for (int k = 0; k < panel.row_count; k++) {
        for (int i = 0; i < PANEL_STEPS; i++) {
            assert_true(isnan(panel.rows[k].value[i]));
        }
        assert_true(isnan(panel.rows[k].order));
    }
}

// The cheapest of the points that keep an error, and none beyond the first one that does
// not.
TEST(the_least_cost_is_read_off_a_study)
{
    method_study study;
    for (int i = 0; i < STUDY_STEPS; i++) {
        study.points[0][i] = (study_point){.step = pow(2, -i),
                                           .cost = 1 + i,
                                           .error = {pow(4, -i), (double)NAN, 0}};
    }
    study.points[0][2].error[0] = 1; // an accident among the long steps
    double step = 0;
    check_close(method_study_cost(&study, 0, 0, 1.01 * pow(4, -5), &step), 6, 0);
    check_close(step, pow(2, -5), 0);
    check_close(method_study_cost(&study, 0, 0, 0.9, &step), 4, 0);
    assert_true(isnan(method_study_cost(&study, 0, 0, 1e-30, &step)));

    // of equal costs the shorter step's, which has the smaller error
    for (int i = 0; i < STUDY_STEPS; i++) {
        study.points[1][i] =
            (study_point){.step = pow(2, -i), .cost = 3, .error = {0.1, 0.1, 0.1}};
    }
    check_close(method_study_cost(&study, 1, 0, 0.1, &step), 3, 0);
    check_close(step, pow(2, -(STUDY_STEPS - 1)), 0);
    study.points[1][0].cost = 2; // the longest
    check_close(method_study_cost(&study, 1, 0, 0.1, &step), 2, 0);
    check_close(step, 1, 0);
    assert_true(isnan(method_study_cost(&study, 0, 1, 1, &step)));
}

// Stops a study as soon as two of its runs are over.
static int stop_after_two(void *context)
{
    run_monitor *monitor = context;
    while (atomic_load(&monitor->pieces) < 2) {
        thrd_sleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    atomic_store(&monitor->stop, true);
    return 0;
}

TEST(a_study_that_is_stopped_keeps_the_runs_before)
{
    static method_study study;
    // its shortest steps would take hours
    scenario s = {.name = (char *)"test",
                  .parameters =
                      parameters_with("run.duration=50 wall.angle=3 motor.voltage=0.01")};
    run_monitor monitor = {0};
    fault f = {0};
    thrd_t other;
    assert_int_equal(thrd_create(&other, stop_after_two, &monitor), thrd_success);
    assert_int_equal(method_study_compute(&s, &monitor, &study, &f), STATUS_STOPPED);
    thrd_join(other, NULL);
    assert_int_equal(f.code, STATUS_STOPPED);

    // the steps are 10 ms, 5 ms, 2 ms and so on
    check_relative(study.points[0][0].step, 10e-3, 1e-15);
    check_relative(study.points[0][1].step, 5e-3, 1e-15);
    check_relative(study.points[0][2].step, 2e-3, 1e-15);
    check_relative(study.points[0][3].step, 1e-3, 1e-15);

    // the reference and the longest steps were run, the shortest ones were not
    assert_true(atomic_load(&monitor.pieces) < STUDY_RUNS);
    assert_true(study.points[0][0].cost > 0);
    for (int m = 0; m < STUDY_METHODS; m++) {
        assert_true(isnan(study.points[m][STUDY_STEPS - 1].cost));
    }
}

TEST(a_study_runs_each_method_at_each_step_once)
{
    static struct {
        method_study study;
        method_study untouched;
    } both;
    static const method_study none;
    scenario s = {
        .name = (char *)"test",
        .parameters = parameters_with(
            "run.duration=0.1 wall.angle=0 initial.angle=-1e-4 motor.voltage=1")};
    run_monitor monitor = {0};
    DONE(method_study_compute(&s, &monitor, &both.study, &f));
    assert_int_equal(atomic_load(&monitor.pieces), STUDY_RUNS);
    assert_memory_equal(&both.untouched, &none, sizeof none);
    for (int m = 0; m < STUDY_METHODS; m++) {
        for (int i = 0; i < STUDY_STEPS; i++) {
            assert_true(both.study.points[m][i].cost > 0);
        }
    }

    // an error is how far a run with that method and step is off
    int compared = 0;
    for (int m = 0; m < STUDY_METHODS; m++) {
        for (int i = 0; i < STUDY_STEPS; i += 4) {
            const study_point *point = &both.study.points[m][i];
            DONE(parameter_set_text(&s.parameters, PARAMETER_INDEX(method.name),
                                    study_methods[m], &f));
            s.parameters.method.step = point->step;
            KEPT_RUN(result) = run_done(&s, false);
            for (int k = 0; k < STUDY_QUANTITIES; k++) {
                const double value =
                    summary_value(&result.summary, summary_index(study_keys[k]));
                const double error = fabs(value - both.study.reference[k]);
                compared += isfinite(error);
                assert_true(point->error[k] == error ||
                            (isnan(error) && isnan(point->error[k])));
            }
        }
    }
    assert_true(compared > 2 * STUDY_METHODS);

    // nothing is resolved below what the methods that are not the reference's reach
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        double least = HUGE_VAL;
        for (int m = 0; m < STUDY_METHODS; m++) {
            for (int i = 0; i < STUDY_STEPS && strcmp(study_methods[m], "event") != 0;
                 i++) {
                least = fmin(least, both.study.points[m][i].error[k]);
            }
        }
        check_close(fmin(HUGE_VAL, both.study.resolved[k]), least, 0);
    }
}
