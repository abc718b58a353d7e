// Long runs: computed in the background of the session, stopped, continued, resumed from
// another run's rows, which are then kept once.
#include "tests/shared_memory.h"
#include "tests/trace_check.h"

#include <time.h>

#include "tests/session_fixture.h"

static void open_lasting(session *s, const char *name, const char *duration,
                         double patience)
{
    scenario base;
    assert_int_equal(scenario_open(&base, name, fail_on_fault, NULL), STATUS_OK);
    DONE(scenario_override(&base, formatted("run.duration=%s", duration), &f));
    DONE(session_open(s, &base, patience, &f));
}

// Opens a session on a run of twenty links and looks until it has `rows` rows. Where a
// busy machine ends the run before anybody looks, a longer one is opened. Returns the
// run's duration [s].
static int open_while_computing(session *s, size_t rows)
{
    for (int duration = 4;; duration *= 2) {
        open_lasting(s, "corrected/twenty-links", formatted("%d", duration), 0);
        while (s->computing != NULL && s->run.trace.row_count < rows) {
            session_follow(s);
        }
        if (s->computing != NULL) {
            return duration;
        }
        session_finish(s);
        assert_true(duration < 100);
    }
}

// Follows a run until it is over and reads what there is meanwhile, as drawing does.
static int wait_for_run(session *s)
{
    int looks = 0;
    while (s->computing != NULL) {
        const trace *t = &s->run.trace;
        size_t before = t->row_count;
        double sum =
            t->rows[before - 1].force + t->angles[before * (size_t)t->angle_count - 1];
        assert_true(isfinite(sum));
        for (size_t i = 1; i < t->event_count; i++) {
            assert_true(t->events[i].time >= t->events[i - 1].time);
        }
        nanosleep(&(struct timespec){.tv_nsec = 500000}, NULL);
        session_follow(s);
        assert_true(s->run.trace.row_count >= before);
        looks++;
    }
    return looks;
}

// The session's run is that of its scenario from the start, to the last bit.
static void assert_as_from_the_start(const session *s)
{
    KEPT_RUN(whole);
    run_scenario(&s->effective, true, &whole);
    const trace *a = &s->run.trace, *b = &whole.trace;
    assert_null(s->computing);
    assert_same_trace(a, b);
    check_same_events(a, b, a->event_count);
    for (int i = 0; i < summary_count; i++) {
        double one = summary_value(&s->run.summary, i);
        double other = summary_value(&whole.summary, i);
        fail_if(!summary_table[i].timing && memcmp(&one, &other, sizeof one) != 0,
                "%s is %.17g, from the start %.17g", summary_table[i].key, one, other);
    }
    assert_string_equal(s->run.summary.message, whole.summary.message);
    assert_int_equal(s->run.summary.status, whole.summary.status);
    assert_memory_equal(&s->run.landing, &whole.landing, sizeof whole.landing);
}

TEST(a_resumed_run_is_the_run_from_the_start)
{
    random_generator random = seeded(7);
    for (EACH_TEXT(c, "corrected/first-impact", "corrected/newmark",
                   "corrected/restitution", "corrected/spring-hub", "corrected/stuck-hub",
                   "corrected/five-links", "corrected/pull-away", "compare/hybrid",
                   "thesis/fig-3-4")) {
        KEPT_SESSION(s);
        fault f = {0};
        open_lasting(&s, *c, "3", HUGE_VAL);
        for (int k = 0; k < 8; k++) {
            session_seek(&s, session_end(&s) * random_uniform(&random));
            if (k % 3 == 0 && seek_next_event(&s)) {
                session_seek(&s, s.now + 3e-4 * random_uniform(&random));
            }
            if (k % 4 == 1 && s.run.summary.status == STATUS_OK &&
                session_push(&s, 0.02 * (random_uniform(&random) - 0.5), &f) !=
                    STATUS_OK) {
                assert_non_null(strstr(f.text, "knows no pushes"));
            } else if (k % 4 == 2) {
                change(&s, "run.duration", k < 6 ? "3.5" : "2.8");
            } else if (k % 4 == 3) {
                assert_int_equal(session_undo(&s, &f), STATUS_OK);
            } else {
                change(&s, "motor.voltage", k % 8 ? "0.7" : "1.3");
            }
            assert_as_from_the_start(&s);
        }
    }
}

TEST(test_a_long_run_is_looked_at_while_it_is_computed)
{
    KEPT_SESSION(s);
    open_while_computing(&s, 0);
    assert_true(wait_for_run(&s) > 0);
    assert_as_from_the_start(&s);
}

TEST(test_a_change_supersedes_a_run_being_computed)
{
    KEPT_SESSION(s);
    fault f = {0};
    open_lasting(&s, "corrected/twenty-links", "4", 0);
    session_seek(&s, 1e-3);
    for (int i = 0; i < 20; i++) {
        change(&s, "motor.voltage", i % 2 ? "0.8" : "1.2");
        session_follow(&s);
        if (i % 3 == 0) {
            assert_int_equal(session_undo(&s, &f), STATUS_OK);
        }
        // a change that is refused lets the run go on
        assert_int_not_equal(session_change(&s, PARAMETER_INDEX(arm.link_inertia), "-1",
                                            &f),
                             0);
    }
    wait_for_run(&s);
    assert_as_from_the_start(&s);
}

TEST(test_a_run_is_stopped_and_gone_on_with)
{
    KEPT_SESSION(s);
    int duration = open_while_computing(&s, 1000);
    REFUSED(STATUS_BAD_ARGUMENT, "", session_go_on(&s, &f));
    while (!session_stop(&s)) {
        // it ended just now
        session_finish(&s);
        duration = open_while_computing(&s, 1000);
    }
    assert_false(session_stop(&s));
    assert_int_equal(s.run.summary.status, STATUS_STOPPED);
    assert_non_null(strstr(s.run.summary.message, "stopped"));
    size_t rows = s.run.trace.row_count;
    assert_true(rows >= 1000 && session_end(&s) < duration);
    DONE(session_go_on(&s, &f));
    wait_for_run(&s);
    assert_true(s.run.trace.row_count > rows);
    assert_as_from_the_start(&s);
}

TEST(test_the_cursor_waits_for_rows_to_come)
{
    KEPT_SESSION(s);
    open_lasting(&s, "corrected/twenty-links", "4", 0);
    wait_for_run(&s);
    session_seek(&s, 3.5);
    change(&s, "arm.k2", "9");
    change(&s, "arm.mass", "0.3");
    check_close(s.now, 3.5, 0);
    session_seek(&s, 3.6);
    check_close(s.now, 3.5, 0);
    assert_true(session_sample(&s)->time <= 3.5);
    wait_for_run(&s);
    check_close(s.now, 3.5, 0);
    check_close(session_sample(&s)->time, 3.5, 2e-3);
    // and is taken back where none came
    change(&s, "run.duration", "2");
    wait_for_run(&s);
    check_close(s.now, 2, 1e-12);
}

TEST(test_runs_end_with_their_session)
{
    for (int i = 0; i < 10; i++) {
        KEPT_SESSION(s);
        open_lasting(&s, "corrected/twenty-links", "30", 1e-3 * i);
    }
    assert_int_equal(shared_array_memory(), 0);
}

static void check_shared_rows(const char *name)
{
    session s;
    open_lasting(&s, name, "60", HUGE_VAL);
    size_t alone = shared_array_memory(), chunk = ARRAY_CHUNK, arrays = 5;
    assert_true(s.run.trace.row_count >= 60000);
    for (int i = 0; i < 8; i++) {
        session_seek(&s, 59 + 0.1 * i);
        DONE(session_keep_beside(&s, &s.run, &f));
        change(&s, "arm.k2", i % 2 ? "7.5" : "6.5");
        // two runs with the same rows but for the last second and chunks that are not
        // full
        assert_true(shared_array_memory() < alone + alone / 60 + 2 * arrays * chunk);
    }
    assert_as_from_the_start(&s);
    session_finish(&s);
    assert_int_equal(shared_array_memory(), 0);
}

TEST(test_branches_share_the_rows_before_them)
{
    check_shared_rows("corrected/free-vibration");
}
