// The session of the terminal lab: cursor, changes, undo, branches, and files that
// reproduce a run.
#include "tests/trace_check.h"

#include "tests/session_fixture.h"

TEST(test_stepping_back_and_forth_gives_the_same_states)
{
    OPEN_SESSION(s, "corrected/first-impact");
    change(&s, "run.duration", "12");
    session_seek(&s, 11.5);
    sample before = *session_sample(&s);
    for (int i = 0; i < 10000; i++) {
        assert_true(session_step(&s, -1));
    }
    assert_true(session_sample(&s)->time < 2);
    for (int i = 0; i < 10000; i++) {
        assert_true(session_step(&s, 1));
    }
    assert_memory_equal(&before, session_sample(&s), sizeof before);
}

TEST(test_a_run_that_cannot_start_names_its_parameter)
{
    fault f = {.path = ""};
    OPEN_SESSION(s, "corrected/first-impact");
    change(&s, "control.law", "hybrid");
    unsigned version = s.version;
    assert_int_equal(session_change(&s, PARAMETER_INDEX(control.lock), "nowhere", &f),
                     STATUS_BAD_SCENARIO);
    assert_string_equal(f.path, "control.lock");
    // the run there was stays
    assert_int_equal(s.version, version);
}

TEST(test_the_cursor_stays_within_the_run)
{
    OPEN_SESSION(s, "corrected/first-impact");
    assert_false(session_step(&s, -1));
    session_seek(&s, -5);
    check_close(s.now, 0, 0);
    session_seek(&s, 1e9);
    check_close(s.now, 1, 1e-12);
    assert_false(session_step(&s, 1));
    session_seek(&s, (double)NAN);
    check_close(s.now, 0, 0);
}

TEST(test_the_cursor_stands_behind_an_event)
{
    OPEN_SESSION(s, "corrected/first-impact");
    assert_null(session_event(&s));
    do {
        assert_true(seek_next_event(&s));
    } while (session_event(&s)->kind != EVENT_IMPACT);

    // on the far side of the impact
    check_close(s.now, 0.293412296, 1e-6);
    check_close(session_sample(&s)->contact, 1, 0);
}

TEST(test_a_lower_voltage_before_contact_hits_less_hard)
{
    OPEN_SESSION(s, "corrected/first-impact");
    double hard = s.run.summary.first_pulse_peak_N;
    session_seek(&s, 0.25);
    sample before = *session_sample(&s);
    DONE(session_keep_beside(&s, &s.run, &f));
    change(&s, "motor.voltage", "0.5");
    assert_int_equal(s.inputs[0].kind, SESSION_INPUT_TIMED);
    check_below(s.run.summary.first_pulse_peak_N, hard);
    // what was before the change is what it was, and the run branched from is still there
    check_close(session_sample(&s)->last_angle, before.last_angle, 1e-9);
    assert_true(s.has_other);
    check_close(s.other.summary.first_pulse_peak_N, hard, 0);
    check_close(session_parameters_at(&s, 0.2).motor.voltage, 1, 0);
    check_close(session_parameters_at(&s, 0.3).motor.voltage, 0.5, 0);
}

// Rows and events before an instant are the same to the last bit.
static void assert_same_before(const trace *a, const trace *b, double time)
{
    size_t rows = 0, events = 0;
    while (rows < a->row_count && a->rows[rows].time < time) {
        rows++;
    }
    while (events < a->event_count && a->events[events].time < time) {
        events++;
    }
    assert_true(rows <= b->row_count && events <= b->event_count);
    for (size_t i = 0; i < rows; i++) {
        fail_if(memcmp(&a->rows[i], &b->rows[i], sizeof a->rows[i]) != 0,
                "row %zu at %.17g s (or %.17g s) differs before %.17g s", i,
                a->rows[i].time, b->rows[i].time, time);
    }
    assert_memory_equal(a->angles, b->angles,
                        rows * (size_t)a->angle_count * sizeof *a->angles);
    check_same_events(a, b, events);
    assert_true(rows == b->row_count || b->rows[rows].time >= time);
}

TEST(test_what_is_before_a_change_stays_to_the_last_bit)
{
    random_generator random = seeded(6);
    for (EACH_TEXT(c, "corrected/first-impact", "corrected/generalized-alpha",
                   "corrected/newmark", "corrected/five-links", "corrected/restitution",
                   "corrected/stuck-hub", "compare/hybrid", "thesis/fig-3-4",
                   "corrected/spring-hub")) {
        OPEN_SESSION(s, *c);
        for (int k = 0; k < 24; k++) {
            session_seek(&s, random_uniform(&random) * session_end(&s));
            // most changes are right behind an event, where a stride is likely to span
            // both
            if (k % 4 != 0 && seek_next_event(&s)) {
                session_seek(&s, s.now + (k % 4 == 1 ? 3e-6 : 3e-4) *
                                             random_uniform(&random));
            } else if (k % 8 == 0) {
                session_step(&s, 1);
            }
            DONE(session_keep_beside(&s, &s.run, &f));
            // the cursor may go on to a touch that rounding puts right behind the change
            double instant = s.now;
            change(&s, "arm.k2", k % 2 ? "7.5" : "6.5");
            check_close(s.now, instant, 1e-12);
            assert_same_before(&s.other.trace, &s.run.trace, instant);
            DONE(session_undo(&s, &f));
        }
    }
}

TEST(test_undo_and_redo)
{
    OPEN_SESSION(s, "corrected/first-impact");
    double first = s.run.summary.peak_force_N;
    REFUSED(STATUS_BAD_ARGUMENT, "", session_undo(&s, &f));
    change(&s, "wall.angle", "0.2");
    double second = s.run.summary.peak_force_N;
    session_seek(&s, 0.1);
    DONE(session_push(&s, 0.02, &f));
    double third = s.run.summary.peak_force_N;
    assert_true(first != second && second != third);
    DONE(session_undo(&s, &f));
    check_close(s.run.summary.peak_force_N, second, 0);
    DONE(session_undo(&s, &f));
    check_close(s.run.summary.peak_force_N, first, 0);
    DONE(session_redo(&s, &f));
    DONE(session_redo(&s, &f));
    check_close(s.run.summary.peak_force_N, third, 0);
    REFUSED(STATUS_BAD_ARGUMENT, "", session_redo(&s, &f));
    // a new change forgets what was undone
    DONE(session_undo(&s, &f));
    change(&s, "arm.k2", "10");
    REFUSED(STATUS_BAD_ARGUMENT, "", session_redo(&s, &f));
}

TEST(test_an_input_taken_out_is_put_in_again)
{
    OPEN_SESSION(s, "corrected/first-impact");
    change(&s, "wall.angle", "0.2");
    change(&s, "arm.k2", "10");
    const double both = s.run.summary.peak_force_N;
    DONE(session_drop_input(&s, 0, &f));
    assert_int_equal(s.input_count, 1);
    check_close(s.effective.parameters.wall.angle, 0.1, 0);
    check_close(s.effective.parameters.arm.k2, 10, 0);
    DONE(session_redo(&s, &f));
    assert_int_equal(s.input_count, 2);
    check_close(s.effective.parameters.wall.angle, 0.2, 0);
    check_close(s.run.summary.peak_force_N, both, 0);
    REFUSED(STATUS_BAD_ARGUMENT, "", session_redo(&s, &f));
}

TEST(test_a_refused_change_changes_nothing)
{
    fault f = {0};
    OPEN_SESSION(s, "corrected/first-impact");
    unsigned version = s.version;
    assert_int_not_equal(session_change(&s, PARAMETER_INDEX(motor.voltage), "strong", &f),
                         0);
    assert_non_null(strstr(f.text, "motor.voltage"));
    assert_int_not_equal(session_change(&s, PARAMETER_INDEX(wall.angle), "77", &f), 0);
    assert_int_not_equal(session_change(&s, PARAMETER_INDEX(method.step), "1e-7", &f), 0);
    assert_non_null(strstr(f.text, "MiB"));
    assert_int_not_equal(session_push(&s, (double)NAN, &f), 0);
    change(&s, "motor.voltage", "2");
    assert_int_equal(s.version, version + 1);
    // a combination that is refused takes its input out again
    assert_int_not_equal(session_change(&s, PARAMETER_INDEX(arm.link_inertia), "-1", &f),
                         0);
    assert_int_equal(s.input_count, 1);
}

TEST(test_no_change_puts_the_arm_behind_the_wall)
{
    fault f = {0};
    OPEN_SESSION(s, "corrected/first-impact");
    change(&s, "wall.angle", "2.9");
    assert_int_not_equal(session_change(&s, PARAMETER_INDEX(initial.angle), "-0.4", &f),
                         0);
    assert_non_null(strstr(f.text, "initial.angle = -0.4 rad lies behind the wall"));
    change(&s, "initial.angle", "-0.2");
    assert_int_not_equal(session_change(&s, PARAMETER_INDEX(wall.angle), "2.95", &f), 0);
    assert_non_null(strstr(f.text, "lies behind the wall"));
    assert_int_equal(s.input_count, 2);
}

TEST(test_a_saved_scenario_reproduces_the_run)
{
    for (EACH_TEXT(c, "corrected/first-impact", "corrected/voltage-step",
                   "corrected/three-links")) {
        OPEN_SESSION(s, *c);
        session_seek(&s, 0.123);
        change(&s, "motor.voltage", "0.7");
        change(&s, "arm.k2", "6.1");
        session_seek(&s, 0.3333);
        DONE(session_push(&s, -0.01, &f));
        change(&s, "wall.restitution", "0.3");
        free(save_and_compare(&s));
    }
    // a run that ends before an action of its script
    OPEN_SESSION(shorter, "corrected/voltage-step");
    change(&shorter, "run.duration", "0.7");
    free(save_and_compare(&shorter));
    OPEN_SESSION(printed, "thesis/fig-3-4");
    session_seek(&printed, 0.1);
    change(&printed, "motor.voltage", "2");
    free(save_and_compare(&printed));
}

TEST(test_the_model_can_be_exchanged)
{
    OPEN_SESSION(s, "corrected/first-impact");
    double corrected = s.run.summary.first_contact_s;
    change(&s, "arm.model", "printed");
    assert_int_equal(s.effective.parameters.arm.hub_joint, HUB_SPRING);
    assert_true(s.run.summary.first_contact_s != corrected);
}
