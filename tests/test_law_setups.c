// The parameters given to laws on the rig: delays, motors, arms and changes at the ends
// of their ranges. A law works with them, or says why it cannot.

#include "tests/rig_fixture.h"

// A model-based law waits for its command not at all, for part of a period, or for all of
// it.
TEST(laws_know_any_delay)
{
    for (EACH_TEXT(c, "control.law=touch", "control.law=observer")) {
        for (EACH_TEXT(each, "control.delay_periods=0", "control.delay_periods=0.5",
                       "control.delay_periods=1")) {
            const summary s =
                rig_summary_with("%s %s control.delay=0 control.force=1", *c, *each);
            assert_true(s.impacts >= 1);
            check_relative(s.steady_force_N, 1.0, 0.1);
        }
    }
}

TEST(a_motor_without_torque_is_said)
{
    for (EACH_TEXT(c, "control.law=touch", "control.law=observer")) {
        check_refused(given("%s motor.amplifier_gain=0", *c), "it needs a motor");
    }
}

// A mass without inertia moves at its commanded speed.
TEST(an_admittance_may_have_no_mass)
{
    const summary s = rig_summary_with(
        "control.law=admittance control.settings=mass_time=0 run.duration=3");
    check_relative(s.steady_force_N, 1.0, 0.2);
}

// A forecast of the touch includes the spring between hub and beam.
TEST(a_forecast_knows_the_hubs_spring)
{
    const char *const *const joints[] = {
        given("control.law=speed-limit control.force_limit=2 arm.hub_joint=spring "
              "arm.k1=2000"),
        given("control.law=speed-limit control.force_limit=2")};
    for (int i = 0; i < 2; i++) {
        const summary s = rig_summary(joints[i]);
        assert_true(s.impacts >= 1);
        check_below(s.peak_force_N, 2);
    }
}

// The run of a script with one change at an instant.
static run_result run_with_change(const char *const *settings, const char *path,
                                  const char *text, double time)
{
    run_result r;
    scenario s = {.parameters = rig_parameters(settings)};
    parameters p = s.parameters;
    const int index = parameter_index(path);
    DONE(parameter_set_text(&p, index, text, &f));
    action change = {.time = time,
                     .kind = ACTION_SET,
                     .parameter = index,
                     .value = parameter_get(&p, index)};
    if (parameter_is_text(&parameter_table[index])) {
        parameter_format(&p, index, change.text, sizeof change.text);
    }
    s.actions = &change;
    s.action_count = 1;
    run_scenario(&s, true, &r);
    return r;
}

// A transition under way is planned anew to another force, or to another end; with no
// time left it goes on as it was.
TEST(a_transition_leads_where_it_is_told)
{
    const char *const *const settings = given("control.law=hybrid control.force=1");
    const double touch = rig_summary(settings).first_contact_s;
    static const struct {
        const char *path, *text;
        double after, force;
    } changes[] = {{"control.force", "1.4", 0.05, 1.4},
                   {"control.transition_time", "0.35", 0.05, 1},
                   {"control.transition_time", "0.06", 0.1, 1}};
    for (EACH(c, changes)) {
        KEPT_RUN(r) = run_with_change(settings, c->path, c->text, touch + c->after);
        assert_int_equal(r.summary.status, STATUS_OK);
        check_relative(r.summary.steady_force_N, c->force, 0.1);
    }
}

// A rate that a script sets at the start is the rig's from its first sample on.
TEST(a_rate_set_at_the_start_is_that_of_the_rig)
{
    KEPT_RUN(r) = run_with_change(given("control.law=hybrid control.rate=200"),
                                  "control.rate", "100", 0);
    assert_int_equal(r.summary.status, STATUS_OK);
    KEPT_RUN(from_the_start) =
        rig_run(given("control.law=hybrid control.rate=100"), false);
    check_relative(r.summary.peak_force_N, from_the_start.summary.peak_force_N, 1e-9);
    check_relative(r.summary.first_contact_s, from_the_start.summary.first_contact_s,
                   1e-9);
}

// A law that refuses a change says when.
TEST(a_refused_change_says_its_time)
{
    KEPT_RUN(r) = run_with_change(given("control.law=observer control.force=1"),
                                  "control.rate", "250", 0.3);
    assert_int_equal(r.summary.status, STATUS_BAD_SCENARIO);
    assert_non_null(strstr(r.summary.message,
                           "at t = 0.3 s the controller 'observer' refuses: "
                           "it takes its model and its rate at the start only"));
}

// A limit that changes during the run is passed to the forecast, too.
TEST(a_limit_may_change)
{
    const char *const *const settings =
        given("control.law=speed-limit control.force_limit=4 "
              "control.approach_voltage=5 control.speed_limit=100 "
              "control.force=0.3 initial.angle=-0.4");
    KEPT_RUN(r) = run_with_change(settings, "control.force_limit", "1", 0.05);
    assert_int_equal(r.summary.status, STATUS_OK);
    const summary high = rig_summary(settings);
    check_below(r.summary.peak_force_N, high.peak_force_N);
}
