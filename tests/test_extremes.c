// Parameters at the ends of their ranges: a run ends with bounded effort, and nothing
// that is no finite number passes for a result.
#include <signal.h>

#include "tests/arm_fixture.h"
#include "tests/scenario_fixture.h"

// Runs an arm of so many links that is pushed, and says how it ended.
static status ends_of_push(int links, double impulse)
{
    KEPT_RUN(result);
    KEPT_SCENARIO(s) =
        good(formatted("title: Pushed\narm: {links: %d}\nwall: {kind: none}\nscript:\n"
                       "  - {at: 0.1 s, push: %g N s}\n",
                       links, impulse));
    const status code = run_scenario(&s, false, &result);
    assert_int_equal(code == STATUS_OK, result.summary.message[0] == '\0');
    return code;
}

TEST(a_push_of_any_size_ends_a_run_or_lets_it_go_on)
{
    for (EACH_OF(int, c, 1, 2, 3, 8)) {
        assert_int_equal(ends_of_push(*c, 1e300), STATUS_NOT_FINITE);
        assert_int_equal(ends_of_push(*c, -1e300), STATUS_NOT_FINITE);
        assert_int_equal(ends_of_push(*c, 1e-300), STATUS_OK);
    }
    assert_int_equal(ends_of_push(2, 0.1), STATUS_OK);
}

// Whoever asks a run of either model to end gets its first rows, and hears at which
// instant.
TEST(a_run_that_is_asked_to_end_does)
{
    for (EACH_TEXT(c, "printed", "corrected")) {
        KEPT_SCENARIO(s) = good(
            formatted("title: Ended\narm: {model: %s}\nrun: {duration: 0.5 s}\n", *c));
        KEPT_RUN(whole) = run_done(&s, true);
        KEPT_RUN(ended);
        run_monitor monitor = {.stop = true};
        const run_options options = {.keep_trace = true, .monitor = &monitor};
        assert_int_equal(run_scenario_with(&s, &options, &ended), STATUS_STOPPED);
        assert_true(ended.trace.row_count >= 1);
        assert_true(ended.trace.row_count < whole.trace.row_count / 2);
        assert_memory_equal(ended.trace.rows, whole.trace.rows,
                            ended.trace.row_count * sizeof *whole.trace.rows);
        assert_int_equal(strncmp(ended.summary.message, "at t = ", 7), 0);
    }
}

// At 1e16 rad/s a turn takes less than a last bit of the time.
TEST(strides_that_pass_no_time_end_a_run)
{
    assert_int_equal(ends_of_push(1, 1e15), STATUS_NO_PROGRESS);
    assert_int_equal(ends_of_push(1, -1e20), STATUS_NO_PROGRESS);
}

// The force just after an impact of a chain that is damped beyond all vibration: the last
// joint's damper, which grows with N, turns at the speed over a link's length, its lever
// arm. So the peak grows with N^3, and it is at the first contact.
TEST(the_peak_of_a_damped_chain_is_at_its_impact)
{
    double before = 0;
    for (EACH_OF(int, c, 16, 24, 28, 32, 40)) {
        KEPT_RUN(result) = run_told(
            formatted("title: Damped\nmotor: {voltage: 5 V}\nwall: {kind: plane}\n"
                      "arm: {links: %d, damping_ratio: 1}\nrun: {duration: 0.2 s}\n",
                      *c));
        const double coefficient = result.summary.peak_force_N / pow(*c, 3);
        check_close(result.summary.time_to_peak_s, 0, 1e-9);
        check_relative(coefficient, before > 0 ? before : coefficient, 0.03);
        before = coefficient;
    }
}

// An arm that turns away from a point comes to it with the line behind its last link.
TEST(a_touch_behind_the_link_is_told)
{
    for (int way = -1; way <= 1; way += 2) {
        KEPT_RUN(result) = run_told(
            formatted("title: Round\nmotor: {voltage: %d V}\nwall: {angle: 2.9 rad}\n"
                      "run: {duration: 3 s}\n",
                      way));
        assert_true(result.summary.impacts > 0);
        assert_int_equal(result.summary.message[0] != '\0', way < 0);
    }
}

static volatile sig_atomic_t stop;
static atomic_bool abandoned;

static void give_up(void *context, const sweep_progress *p)
{
    (void)context;
    (void)p;
    stop = 1;
    abandoned = true;
}

TEST(runs_without_an_end_are_abandoned_and_not_stored)
{
    const char *text =
        "title: Nearly for ever\ninitial: {velocity: 0.01 rad/s}\n"
        "wall: {angle: 3 rad}\narm: {links: 24}\nrun: {duration: 90000 s}\n";
    char *vary[] = {"motor.voltage=0.001:0.002:3"};
    const sweep_request request = {.vary = vary, .vary_count = 1};
    const sweep_options options = {.jobs = 2,
                                   .stop = &stop,
                                   .abandon = &abandoned,
                                   .report = give_up};
    KEPT_SCENARIO(base) = good(text);
    KEPT_SWEEP(s);
    KEPT_STORE(store);
    sweep_progress progress;
    DONE(sweep_init(&s, &base, &request, &f));
    DONE(sweep_store_open(&store, NULL, &s, &f));

    DONE(sweep_run(&s, store, &options, &progress, &f));
    assert_int_equal(progress.total, 3);
    assert_int_equal(progress.done, 0);
    assert_int_equal(progress.failed, 0);
}

TEST(runs_abandoned_before_they_begin_are_not_set_up)
{
    const atomic_bool already = true;
    for (EACH_TEXT(c, "title: Corrected\n", "title: Printed\narm: {model: printed}\n",
                   "title: Under a law\ncontrol: {law: hybrid}\n")) {
        KEPT_SCENARIO(s) = good(*c);
        KEPT_RUN(result);
        side_by_side *storage = NULL;
        run_together(&s, 1, &already, &result, &storage);
        assert_int_equal(result.summary.status, STATUS_STOPPED);
        assert_true(isnan(result.summary.steps) || result.summary.steps == 0);
        assert_int_equal(result.trace.event_count, 0);
        side_by_side_destroy(storage);
    }
}
