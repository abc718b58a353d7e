// Controllers from shared objects: test_plugin SOFT_PUSH BROKEN OUTDATED SILENT.
#include "src/rig/rig.h"
#include "tests/rig_fixture.h"

static const char *soft_push_file, *broken_file, *outdated_file, *silent_file;

#define PLUGIN "control.law=plugin control.plugin=%s"

TEST(plugin_controls_the_arm)
{
    const char *const file = soft_push_file;
    summary s = rig_summary_with(PLUGIN " control.force=1.5", file);
    check_close(s.separations, 0, 0);
    check_relative(s.steady_force_N, 1.5, 0.06);
    summary slow = rig_summary(
        SETTINGS("control.law=plugin", formatted("control.plugin=%s", file),
                 "control.force=1.5", "control.settings=rise_time=0.4 damping=1"));
    check_below(s.settling_time_s, slow.settling_time_s);
}

TEST(wrong_plugins_are_refused)
{
    const char *const file = soft_push_file;
    check_refused(given("control.law=plugin control.plugin=/nonexistent.so"),
                  "/nonexistent.so");
    check_refused(given(PLUGIN " control.settings=dampin=1", file),
                  "did you mean 'damping'?");
    check_refused(given(PLUGIN " control.settings=damping=-1", file), "from 0 to 100");
    check_refused(given(PLUGIN " control.lock=force", file),
                  "expected none, approach or push");
    check_refused(given(PLUGIN " control.settings=damping", file), "damping=NUMBER");
    check_refused(given(PLUGIN " motor.amplifier_gain=0", file), "no torque");
    check_refused(given(PLUGIN, outdated_file), "compile it again");
    check_refused(given(PLUGIN, silent_file), "has no function `sample`");

    // a shared object that is no controller
    check_refused(given("control.law=plugin control.plugin=libm.so.6"),
                  "libm.so.6 has no function " CONTROLLER_ENTRY);
}

// The modes of one that is open to code, and none of one that is not or cannot be opened.
TEST(modes_of_a_plugin_are_its_own)
{
    char names[4][MODE_NAME_SIZE];
    bool lockable;
    parameters p = rig_parameters_with(PLUGIN, soft_push_file);
    assert_true(rig_mode_names(&p, names, 4, &lockable) == 2 && lockable);
    assert_string_equal(names[0], "approach");
    assert_string_equal(names[1], "push");

    p.code_allowed = false;
    assert_true(rig_mode_names(&p, names, 4, &lockable) == 0 && !lockable);

    // named together with another law it is not opened
    p.code_allowed = true;
    p.control.law = LAW_HYBRID;
    assert_int_equal(rig_mode_names(&p, names, 4, &lockable), 3);
    assert_string_equal(names[1], "impact");
    p = rig_parameters_with("control.law=plugin control.plugin=/nonexistent.so");
    assert_true(rig_mode_names(&p, names, 4, &lockable) == 0 && !lockable);
}

TEST(command_that_is_not_finite_stops_the_run)
{
    for (EACH_TEXT(c, "arm.model=corrected", "arm.model=printed")) {
        KEPT_RUN(r);
        scenario s = {.parameters = rig_parameters_with(PLUGIN " %s", broken_file, *c)};
        assert_int_equal(run_scenario(&s, true, &r), STATUS_NOT_FINITE);
        assert_non_null(
            strstr(r.summary.message, "at t = 0.1 s the controller 'broken'"));
        check_close(LAST_ROW(&r.trace)->time, 0.1, 0.0011);
    }
}

int main(int count, char **arguments)
{
    if (count != 5) {
        fprintf(stderr,
                "usage: test_plugin SOFT_PUSH.so BROKEN.so OUTDATED.so SILENT.so\n");
        return 2;
    }
    soft_push_file = arguments[1];
    broken_file = arguments[2];
    outdated_file = arguments[3];
    silent_file = arguments[4];
    return run_cases(NULL, NULL);
}
