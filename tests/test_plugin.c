// Controllers from shared objects: test_plugin SOFT_PUSH BROKEN OUTDATED SILENT.
#include "src/rig/rig.h"
#include "tests/rig_fixture.h"

static const char *soft_push_file, *broken_file, *outdated_file, *silent_file;

static const char *plugin_setting(char *text, size_t size, const char *file)
{
    snprintf(text, size, "control.plugin=%s", file);
    return text;
}

TEST(plugin_controls_the_arm)
{
    char file[160];
    plugin_setting(file, sizeof file, soft_push_file);
    summary s = rig_summary_with("control.law=plugin %s control.force=1.5", file);
    check_close(s.separations, 0, 0);
    check_relative(s.steady_force_N, 1.5, 0.06);
    summary slow = rig_summary(SETTINGS("control.law=plugin", file, "control.force=1.5",
                                        "control.settings=rise_time=0.4 damping=1"));
    check_below(s.settling_time_s, slow.settling_time_s);
}

TEST(wrong_plugins_are_refused)
{
    char file[160];
    plugin_setting(file, sizeof file, soft_push_file);
    check_refused(given("control.law=plugin control.plugin=/nonexistent.so"), "/nonexistent.so");
    check_refused(given("control.law=plugin %s control.settings=dampin=1", file),
                  "did you mean 'damping'?");
    check_refused(given("control.law=plugin %s control.settings=damping=-1", file),
                  "from 0 to 100");
    check_refused(given("control.law=plugin %s control.lock=force", file),
                  "expected none, approach or push");
    check_refused(given("control.law=plugin %s control.settings=damping", file), "damping=NUMBER");
    check_refused(given("control.law=plugin %s motor.amplifier_gain=0", file), "no torque");
    plugin_setting(file, sizeof file, outdated_file);
    check_refused(given("control.law=plugin %s", file), "compile it again");
    plugin_setting(file, sizeof file, silent_file);
    check_refused(given("control.law=plugin %s", file), "has no function `sample`");

    // a shared object that is no controller
    check_refused(given("control.law=plugin control.plugin=libm.so.6"),
                  "libm.so.6 has no function " CONTROLLER_ENTRY);
}

// The modes of one that is open to code, and none of one that is not or cannot be opened.
TEST(modes_of_a_plugin_are_its_own)
{
    char file[160], names[4][MODE_NAME_SIZE];
    bool lockable;
    plugin_setting(file, sizeof file, soft_push_file);
    parameters p = rig_parameters_with("control.law=plugin %s", file);
    assert_true(rig_mode_names(&p, names, 4, &lockable) == 2 && lockable);
    assert_string_equal(names[0], "approach");
    assert_string_equal(names[1], "push");

    p.code_allowed = false;
    assert_true(rig_mode_names(&p, names, 4, &lockable) == 0 && !lockable);
    p = rig_parameters_with("control.law=plugin control.plugin=/nonexistent.so");
    assert_true(rig_mode_names(&p, names, 4, &lockable) == 0 && !lockable);
}

TEST(command_that_is_not_finite_stops_the_run)
{
    char file[160];
    for (EACH_TEXT(c, "arm.model=corrected", "arm.model=printed")) {
        KEPT_RUN(r);
        plugin_setting(file, sizeof file, broken_file);
        scenario s = {.parameters = rig_parameters_with("control.law=plugin %s %s", file, *c)};
        assert_int_equal(run_scenario(&s, true, &r), STATUS_NOT_FINITE);
        assert_non_null(strstr(r.summary.message, "at t = 0.1 s the controller 'broken'"));
        check_close(LAST_ROW(&r.trace)->time, 0.1, 0.0011);
    }
}

// The modes of a plug-in are its own, where it is the law and may be opened.
TEST(modes_are_the_plugins_own)
{
    char file[160], names[4][MODE_NAME_SIZE];
    bool lockable = false;
    plugin_setting(file, sizeof file, soft_push_file);
    parameters p = rig_parameters_with("control.law=plugin %s", file);
    assert_int_equal(rig_mode_names(&p, names, 4, &lockable), 2);
    assert_true(lockable);
    assert_string_equal(names[0], "approach");
    assert_string_equal(names[1], "push");
    p.code_allowed = false;
    assert_int_equal(rig_mode_names(&p, names, 4, &lockable), 0);
    assert_false(lockable);

    // named together with another law it is not opened
    p.code_allowed = true;
    p.control.law = LAW_HYBRID;
    assert_int_equal(rig_mode_names(&p, names, 4, &lockable), 3);
    assert_string_equal(names[1], "impact");
}

int main(int count, char **arguments)
{
    if (count != 5) {
        fprintf(stderr, "usage: test_plugin SOFT_PUSH.so BROKEN.so OUTDATED.so SILENT.so\n");
        return 2;
    }
    soft_push_file = arguments[1];
    broken_file = arguments[2];
    outdated_file = arguments[3];
    silent_file = arguments[4];
    return run_cases(NULL, NULL);
}
