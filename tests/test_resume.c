// A run that is resumed at a checkpoint is the run from the start, to the last bit.
#include "tests/arm_fixture.h"

#include "src/run/resume.h"

enum { ROWS = 20000 };

static run_result run_keeping_history(const scenario *s)
{
    const run_options options = {.keep_trace = true, .rows_expected = ROWS};
    run_result result;
    assert_int_equal(run_scenario_with(s, &options, &result), STATUS_OK);
    return result;
}

// The run of s, resumed from that of `old`; false if nothing of it could be used.
static bool resumed(const run_result *from, const scenario *old, const scenario *s,
                    run_result *result)
{
    const run_options options = {.keep_trace = true,
                                 .rows_expected = ROWS,
                                 .resume = true};
    if (!run_resume(from, old, s, ROWS, result)) {
        return false;
    }
    assert_int_equal(run_scenario_with(s, &options, result), STATUS_OK);
    return true;
}

static void check_same_run(const run_result *a, const run_result *b)
{
    assert_int_equal(a->trace.row_count, b->trace.row_count);
    assert_memory_equal(a->trace.rows, b->trace.rows,
                        a->trace.row_count * sizeof(sample));
    assert_int_equal(a->trace.event_count, b->trace.event_count);
    assert_int_equal(a->history.forces.count, b->history.forces.count);
    assert_memory_equal(force_steps(&a->history.forces), force_steps(&b->history.forces),
                        a->history.forces.count * sizeof(force_step));
    assert_memory_equal(&a->landing, &b->landing, sizeof a->landing);
    assert_same_summary(&a->summary, &b->summary);
}

// A change at 2.5 s of the arm that presses on the wall.
static scenario changed_late(const scenario *s, action *change)
{
    scenario changed = *s;
    *change = SETS(2.5, motor.voltage, 0.5);
    changed.actions = change;
    changed.action_count = 1;
    return changed;
}

TEST(a_resumed_run_is_the_run_from_the_start)
{
    action change;
    scenario s = {.parameters = parameters_with("run.duration=4 motor.stiction=0")};
    scenario later = changed_late(&s, &change);
    run_result old = run_keeping_history(&s);
    KEPT_RUN(whole) = run_keeping_history(&later), result;
    assert_true(old.history.checkpoints.count > 2);
    assert_true(resumed(&old, &s, &later, &result));
    check_same_run(&result, &whole);
    assert_true(result.landing.before.velocity[0] >
                0); // the impact before it is still known
    run_finish(&old);
    check_same_run(&result, &whole);
}

// One link whose force is determined within bounds only, and arms that start on the wall
// and come back to it: bounds and landing are those of the whole run.
TEST(bounds_and_landing_are_resumed)
{
    const char *const *const arms[] = {
        given("run.duration=4 arm.links=1"), given("run.duration=2.55 arm.links=1"),
        given("run.duration=4 wall.angle=0 initial.velocity=0.5 "
              "arm.links=3 wall.contact=kelvin-voigt")};
    for (int i = 0; i < 3; i++) {
        action actions[] = {SETS(1.5, motor.voltage, 0.5), SETS(2.5, motor.voltage, 0.2)};
        scenario s = {.parameters = fixture_parameters(arms[i]), .actions = actions};
        scenario later = s;
        s.action_count = 1;
        later.action_count = 2;
        KEPT_RUN(old) = run_keeping_history(&s), whole = run_keeping_history(&later),
        result;
        assert_true(resumed(&old, &s, &later, &result));
        check_same_run(&result, &whole);
        assert_int_equal(isnan(result.summary.steady_force_low_N), i == 2);
        assert_true(whole.landing.time > 0);
        assert_memory_equal(&result.landing, &whole.landing, sizeof result.landing);
    }
}

// A face that the arm has left behind and that is on its way back when the runs part.
TEST(a_face_on_its_way_back_is_resumed_where_it_was)
{
    const char *const *const walls[] = {given("run.duration=4 wall.contact=kelvin-voigt "
                                              "wall.stiffness=100 wall.damping=500"),
                                        given("run.duration=4 wall.contact=hunt-crossley "
                                              "wall.stiffness=1e4 wall.damping=2e7")};
    for (int i = 0; i < 2; i++) {
        action actions[] = {SETS(1, motor.voltage, -0.5), SETS(2.5, motor.voltage, 2)};
        scenario s = {.parameters = fixture_parameters(walls[i]), .actions = actions};
        scenario later = s;
        s.action_count = 1;
        later.action_count = 2;
        KEPT_RUN(old) = run_keeping_history(&s), whole = run_keeping_history(&later),
        result;
        assert_true(run_resume(&old, &s, &later, ROWS, &result));
        const sample *last = LAST_ROW(&result.trace);
        assert_true(last->contact == 0 && last->face_depth > 1e-4);
        assert_true(last->gap > -last->face_depth);
        run_finish(&result);
        assert_true(resumed(&old, &s, &later, &result));
        check_same_run(&result, &whole);
        bool met = false;
        for (EACH_EVENT(e, &result.trace)) {
            met |= e->kind == EVENT_CONTACT && e->time > 2.5;
        }
        assert_true(met);
    }
}

// A hub that the script makes so stiff that another engine moves the arm: checkpoints
// after that are that engine's.
TEST(an_arm_made_stiff_is_resumed_as_it_is)
{
    for (int links = 2; links <= 3; links++) {
        action changes[2] = {SETS(1, arm.k1, 1e8)};
        scenario s = {
            .parameters = parameters_with(
                "run.duration=4 arm.hub_joint=spring arm.k1=500 arm.damping_ratio=0.02")};
        s.parameters.arm.links = links;
        scenario later = changed_late(&s, &changes[1]);
        s.actions = later.actions = changes;
        s.action_count = 1;
        later.action_count = 2;
        KEPT_RUN(old) = run_keeping_history(&s), whole = run_keeping_history(&later),
        result;
        assert_true(whole.summary.steps < 1e5);
        assert_true(resumed(&old, &s, &later, &result));
        check_same_run(&result, &whole);
    }
}

// Scripts of two runs that have their first actions in common: the run is resumed before
// the first one that differs in whatever, is missing or is new.
TEST(scripts_that_part_are_resumed_where_they_part)
{
    const action one = SETS(0.8, motor.voltage, 1.5), two = SETS(2.5, motor.voltage, 0.5),
                 three = SETS(3, motor.voltage, 0.8),
                 other = SETS(2.5, motor.voltage, 0.6),
                 later = SETS(2.7, motor.voltage, 0.5), elsewhere = SETS(2.5, arm.k2, 5);
    action pushed = two;
    pushed.kind = ACTION_PUSH;
    action scripts[][3] = {{one},
                           {one, two},
                           {one, two, three},
                           {one, other, three},
                           {one, later, three},
                           {one, elsewhere},
                           {one, three},
                           {one, pushed}};
    const int counts[] = {1, 2, 3, 3, 3, 2, 2, 2};
    enum { SCRIPTS = sizeof counts / sizeof counts[0] };

    scenario s[SCRIPTS];
    run_result whole[SCRIPTS];
    for (int i = 0; i < SCRIPTS; i++) {
        s[i] =
            (scenario){.parameters = parameters_with("run.duration=4 motor.stiction=0"),
                       .actions = scripts[i],
                       .action_count = counts[i]};
        whole[i] = run_keeping_history(&s[i]);
    }
    for (int i = 0; i < SCRIPTS; i++) {
        for (int j = 0; j < SCRIPTS; j++) {
            KEPT_RUN(result);
            assert_true(resumed(&whole[i], &s[i], &s[j], &result));
            check_same_run(&result, &whole[j]);
            run_finish(&result);

            // nearly all that they have in common is not computed again
            const int pair[] = {i, j};
            double first[2] = {4, 4};
            for (int k = 0; k < 2; k++) {
                const int own = pair[k], theirs = pair[1 - k];
                for (int a = counts[own] - 1; a >= 0; a--) {
                    const action *x = &scripts[own][a], *y = &scripts[theirs][a];
                    const bool both =
                        a < counts[theirs] && x->time == y->time && x->kind == y->kind &&
                        x->parameter == y->parameter && x->value == y->value;
                    first[k] = both ? first[k] : x->time;
                }
            }
            const double part = fmin(first[0], first[1]);
            assert_true(run_resume(&whole[i], &s[i], &s[j], ROWS, &result));
            const double shared = LAST_ROW(&result.trace)->time;
            check_below(shared, part);
            check_below(part - 0.7, shared);
        }
    }
    for (int i = 0; i < SCRIPTS; i++) {
        run_finish(&whole[i]);
    }
}

TEST(a_longer_run_goes_on_from_a_shorter_one)
{
    scenario s = {.parameters = parameters_with("run.duration=3")};
    scenario longer = {.parameters = parameters_with("run.duration=5")};
    KEPT_RUN(old) = run_keeping_history(&s), whole = run_keeping_history(&longer), result;
    assert_true(resumed(&old, &s, &longer, &result));
    check_same_run(&result, &whole);
}

TEST(another_arm_has_nothing_in_common)
{
    scenario s = {.parameters = parameters_with("run.duration=3")};
    scenario other = {.parameters = parameters_with("run.duration=3 arm.k2=5")};
    KEPT_RUN(old) = run_keeping_history(&s);
    run_result result;
    assert_false(run_resume(&old, &s, &other, ROWS, &result));
}

TEST(a_run_without_history_cannot_be_resumed)
{
    scenario s = {.parameters = parameters_with("run.duration=3")};
    KEPT_RUN(old) = run_done(&s, true);
    run_result result;
    assert_false(run_resume(&old, &s, &s, ROWS, &result));
}

TEST(a_shared_result_outlives_the_first)
{
    scenario s = {.parameters = parameters_with("run.duration=3")};
    run_result old = run_keeping_history(&s);
    KEPT_RUN(again) = run_keeping_history(&s), shared;
    assert_int_equal(run_share(&old, &shared), STATUS_OK);
    check_same_run(&shared, &old);

    // it takes no address space but for its rows
    const shared_array *rows = &shared.trace.arrays[TRACE_ROWS];
    check_below(rows->reserved, 2 * rows->size * (old.history.forces.count + ROWS));
    check_below(shared.history.checkpoints.reserved,
                2.0 * old.history.checkpoints.mapped);
    run_finish(&old);
    check_same_run(&shared, &again);
}

// On the rig runs have rows but no history, and none when they are shared.
TEST(a_run_of_the_rig_is_shared_without_history)
{
    scenario s = {.parameters = parameters_with("run.duration=1 control.law=open-loop")};
    KEPT_RUN(old) = run_keeping_history(&s), shared;
    assert_int_equal(run_share(&old, &shared), STATUS_OK);
    check_same_run(&shared, &old);
    assert_int_equal(shared.history.forces.reserved, 0);
    assert_int_equal(shared.history.checkpoints.reserved, 0);
}
