// Limits of a parameter for a condition on a result.
#include "src/study/solve.h"

#include "tests/shipped_scenario.h"

static sweep_axis axis_of(const char *path, double low, double high)
{
    sweep_axis axis = {.low = low, .high = high, .is_range = true};
    DONE(sweep_axis_find(&axis, path, &f));
    return axis;
}

static solve_condition condition_of(const char *text)
{
    solve_condition c;
    DONE(solve_condition_read(text, &c, &f));
    return c;
}

static solution solved(const scenario *s, const sweep_axis *axis, const char *text,
                       int points, int jobs)
{
    solution found;
    const solve_condition c = condition_of(text);
    DONE(solve(s, axis, &c, points, jobs, NULL, &found, &f));
    return found;
}

// The quantity of a run of its own with another value of the parameter.
static double quantity_at(const scenario *s, const char *path, double value,
                          const char *key)
{
    scenario changed = *s;
    parameters p = s->parameters;
    assert_int_equal(parameter_set_number(&p, parameter_find(path), value, NULL),
                     STATUS_OK);
    assert_int_equal(scenario_take_parameters(&changed, &p, NULL), STATUS_OK);
    KEPT_RUN(result) = run_done(&changed, false);
    return summary_value(&result.summary, summary_find(key));
}

// One link at rest on the wall presses with the hub's torque, which is proportional to
// the voltage where there is no friction: twice the force takes twice the voltage.
TEST(statics_have_the_limit_of_statics)
{
    KEPT_SCENARIO(s) = shipped_with(
        "corrected/first-impact",
        "motor.stiction=0 arm.links=1 initial.angle=0 wall.angle=0 run.duration=0.2");
    sweep_axis axis = axis_of("motor.voltage", 0.1, 4);
    const double at_one = quantity_at(&s, "motor.voltage", 1, "steady_force_N");

    const solution found =
        solved(&s, &axis, formatted("steady_force_N <= %.17g", 2 * at_one), 9, 1);
    assert_int_equal(found.count, 1);
    check_close(found.limits[0].value, 2, 1e-12);
    check_relative(found.limits[0].reached, 2 * at_one, 1e-12);
    assert_true(found.limits[0].holds_below);
}

// The condition holds at the limit and no longer a little beyond it, and neither the
// number of values nor that of threads has a say in where it is.
TEST(limits_are_where_the_condition_ceases_to_hold)
{
    KEPT_SCENARIO(s) = shipped("corrected/first-impact");
    sweep_axis axis = axis_of("motor.voltage", 0.5, 5);
    const solution few = solved(&s, &axis, "peak_force_N<2", 5, 1),
                   many = solved(&s, &axis, "peak_force_N<2", 40, 3);
    assert_int_equal(few.count, 1);
    assert_int_equal(many.count, 1);
    check_close(few.limits[0].value, many.limits[0].value, 1e-11);

    const double limit = few.limits[0].value;
    check_close(few.limits[0].reached,
                quantity_at(&s, "motor.voltage", limit, "peak_force_N"), 0);
    check_below(few.limits[0].reached, 2.0);
    check_below(2.0, quantity_at(&s, "motor.voltage", limit + 1e-11, "peak_force_N"));
    assert_false(few.limits[0].jumps);

    // the other way round it holds from there on
    const solution above = solved(&s, &axis, "peak_force_N >= 2", 5, 1);
    assert_int_equal(above.count, 1);
    assert_false(above.limits[0].holds_below);
    check_close(above.limits[0].value, limit, 1e-11);
}

// A count jumps; its limits come in the order of the range, each with a value that holds
// beside those that do not. Within 1e-9 V of a grazing impact rounding decides whether it
// is one.
TEST(jumps_are_located_and_told)
{
    KEPT_SCENARIO(s) = shipped("corrected/first-impact");
    sweep_axis axis = axis_of("motor.voltage", 5, 0.5);
    const solution found = solved(&s, &axis, "impacts<3", 65, 1);
    assert_true(found.count >= 2);
    for (int i = 0; i < found.count; i++) {
        const solve_limit *limit = &found.limits[i];
        const double beyond = limit->value + (limit->holds_below ? 1e-7 : -1e-7);
        assert_true(limit->jumps);
        assert_true(limit->reached < 3);
        assert_true(quantity_at(&s, "motor.voltage", beyond, "impacts") >= 3);
        assert_true(i == 0 || limit->value > found.limits[i - 1].value);
        assert_true(i == 0 || limit->holds_below != found.limits[i - 1].holds_below);
    }
}

TEST(whole_numbers_have_a_last_one)
{
    KEPT_SCENARIO(s) = shipped("corrected/first-impact");
    sweep_axis axis = axis_of("arm.links", 2, 20);

    // run one by one, and with most of them left out
    const solution all = solved(&s, &axis, "peak_force_N<6", 65, 1),
                   some = solved(&s, &axis, "peak_force_N<6", 3, 1);
    assert_int_equal(all.points, 19);
    assert_int_equal(all.count, 1);
    assert_int_equal(some.count, 1);
    const double last = all.limits[0].value;
    check_close(some.limits[0].value, last, 0);
    assert_true(quantity_at(&s, "arm.links", last, "peak_force_N") < 6);
    assert_true(quantity_at(&s, "arm.links", last + 1, "peak_force_N") >= 6);
}

// Where the quantity is missing or the run fails, there is no limit of its value.
TEST(what_is_not_there_has_no_limit)
{
    KEPT_SCENARIO(s) = shipped("corrected/first-impact");

    // a voltage too small to reach the wall
    sweep_axis axis = axis_of("motor.voltage", 0, 1);
    const solution found = solved(&s, &axis, "peak_force_N<100", 21, 1);
    assert_int_equal(found.count, 0);
    assert_true(found.missing > 0 && found.holding > 0);
    assert_int_equal(found.missing + found.holding, 21);

    // starts behind the wall are refused
    sweep_axis start = axis_of("initial.angle", -0.1, 0.3);
    const solution behind = solved(&s, &start, "peak_force_N<100", 5, 1);
    assert_int_equal(behind.unknown, 2);
    assert_non_null(strstr(behind.reason, "wall"));
}

TEST(conditions_say_what_they_lack)
{
    const struct {
        const char *text, *expected;
    } wrong[] = {
        {"peak_force_N", "KEY<VALUE"},
        {"peak_forc_N<2", "did you mean 'peak_force_N'?"},
        {"peak_force_N<", "a number in N"},
        {"peak_force_N<2N", "a number in N"},
        {"peak_force_N<nan", "a number in N"},
        {"<2", "no quantity ''"},
        {"cpu_time_s<1", "depends on the machine"},
    };
    for (EACH(one, wrong)) {
        solve_condition c;
        REFUSED(STATUS_BAD_ARGUMENT, one->expected,
                solve_condition_read(one->text, &c, &f));
    }

    const solve_condition c = condition_of("  impacts >= 3 ");
    assert_true(c.equal && !c.below && c.bound == 3);
    assert_true(solve_condition_holds(&c, 3) && !solve_condition_holds(&c, 2));
}

TEST(parameters_that_are_no_numbers_have_no_range)
{
    KEPT_SCENARIO(s) = shipped("corrected/first-impact");
    sweep_axis axis = axis_of("method.name", 0, 1);
    REFUSED(STATUS_BAD_ARGUMENT, "", solve_usual_range(&axis, &s, &f));
    axis = axis_of("motor.voltage", 0, 0);
    DONE(solve_usual_range(&axis, &s, &f));
    assert_true(axis.low < 1 && axis.high > 1);
}

TEST(one_can_be_stopped)
{
    solution found;
    run_monitor monitor = {0};
    KEPT_SCENARIO(s) = shipped("corrected/first-impact");
    sweep_axis axis = axis_of("motor.voltage", 0, 5);
    const solve_condition c = condition_of("peak_force_N<2");
    atomic_store(&monitor.stop, true);
    REFUSED(STATUS_STOPPED, "", solve(&s, &axis, &c, 5, 1, &monitor, &found, &f));
}

TEST(a_parameter_that_no_run_takes_has_no_limit)
{
    KEPT_SCENARIO(s) = shipped("corrected/first-impact");
    sweep_axis axis = {0};
    REFUSED(STATUS_BAD_ARGUMENT, "wall.stiffness has no effect in any run",
            solve_axis_read(&axis, "wall.stiffness=1000:2000", &s, &f));
    sweep_axis_finish(&axis);
    DONE(solve_axis_read(&axis, "motor.voltage=1:2", &s, &f));
    sweep_axis_finish(&axis);
}
