// Laws held in a mode (control.lock): their behaviour, their continuation, and that a
// lock made in a session is an input like any other.

#include "src/rig/rig.h"
#include "tests/rig_fixture.h"
#include "tests/session_fixture.h"

#define LOCK_TIME    0.5 // [s]
#define RELEASE_TIME 0.9

static action locked_at(double time, const char *mode)
{
    action lock = SETS(time, control.lock, 0);
    strcpy(lock.text, mode);
    return lock;
}

// The rig's run with the law held in a mode from LOCK_TIME to RELEASE_TIME.
static run_result locked_run(const char *const *settings, const char *mode)
{
    action script[2] = {locked_at(LOCK_TIME, mode), locked_at(RELEASE_TIME, "none")};
    scenario s = {.parameters = rig_parameters(settings),
                  .actions = script,
                  .action_count = 2};
    run_result result;
    fail_if(run_scenario(&s, true, &result) != STATUS_OK, "%s: %s", mode,
            result.summary.message);
    return result;
}

// The row with the controller's answer to the sample at an instant.
static const sample *answer_at(const run_result *r, double time)
{
    return &r->trace.rows[trace_row_at(&r->trace, time + 1e-4)];
}

TEST(every_lockable_law_stays_in_every_mode_of_its_own)
{
    int lockable = 0;
    for (int law = LAW_NONE + 1; law < LAW_PLUGIN; law++) {
        const controller *c = controller_of(law);
        lockable += c->lockable;
        for (int mode = 0; c->lockable && c->modes[mode] != NULL; mode++) {
            KEPT_RUN(r) = locked_run(given("control.law=%s", c->name), c->modes[mode]);
            for (EACH_ROW(row, &r.trace)) {
                fail_if(row->time > LOCK_TIME && row->time < RELEASE_TIME &&
                            row->controller_mode != mode,
                        "%s leaves %s for mode %g at %g s", c->name, c->modes[mode],
                        row->controller_mode, row->time);
            }
        }
    }
    assert_true(lockable >= 8);
}

TEST(approach_means_the_approach_command)
{
    for (EACH_TEXT(c, "hybrid", "recovering", "reverse-torque", "force-pd",
                   "force-integral", "discontinuous")) {
        KEPT_RUN(r) = locked_run(given("control.law=%s control.approach_voltage=0.8", *c),
                                 "approach");
        check_close(answer_at(&r, 0.6)->command, 0.8, 0);
        check_close(answer_at(&r, 0.89)->command, 0.8, 0);
        // it is in contact, and detects it once it is free
        check_close(answer_at(&r, 0.89)->contact, 1, 0);
        assert_true(answer_at(&r, 0.92)->controller_mode > 0);
    }
}

TEST(force_means_the_force_law_at_once)
{
    // in free flight, from the first sample on
    RIG_RUN(r, "control.law=hybrid control.lock=force sensor.ideal=true");
    const sample *first = &r.trace.rows[0];
    double final = 0.5 / (2 * 4.92),
           torque = 2 * 1 * 0.5 + 10.15 * (final - first->hub_angle);
    check_close(first->controller_mode, 2, 0);
    check_close(first->desired_angle, final, 1e-12);
    parameters p = rig_parameters(NULL);
    check_relative(first->command, torque / motor_torque_per_volt(&p.motor), 1e-9);
    check_close(r.summary.steady_force_N, 1, 0.05);
}

TEST(impact_mode_is_planned_anew_and_waits_at_its_end)
{
    KEPT_RUN(r) = locked_run(
        given("control.law=hybrid sensor.ideal=true control.transition_time=0.2"),
        "impact");
    const sample *before = answer_at(&r, LOCK_TIME - 0.005),
                 *entry = answer_at(&r, LOCK_TIME);
    double final = 0.5 / (2 * 4.92);
    check_close(before->controller_mode, 2, 0);
    check_close(entry->desired_angle, entry->hub_angle, 1e-4);
    // the plan begins with the acceleration that the command in effect gives
    check_close(entry->command, before->voltage, 0.05);
    check_close(answer_at(&r, LOCK_TIME + 0.3)->desired_angle, final, 1e-9);
    check_close(answer_at(&r, LOCK_TIME + 0.3)->desired_velocity, 0, 1e-9);
    // released after t_f it enters the force mode, and its command continues from there
    const sample *last = answer_at(&r, RELEASE_TIME - 0.005),
                 *next = answer_at(&r, RELEASE_TIME);
    check_close(next->controller_mode, 2, 0);
    check_close(next->command, last->command, 0.15); // friction's part is the difference
}

TEST(release_goes_on_from_the_command_in_effect)
{
    static const char *const cases[][2] = {
        {"hybrid", "force"},
        {"recovering", "force"},
        {"force-pd", "contact"},
        {"force-integral", "contact"},
        {"force-integral", "approach"},
    };
    for (EACH(c, cases)) {
        KEPT_RUN(r) =
            locked_run(given("control.law=%s sensor.ideal=true", (*c)[0]), (*c)[1]);
        double last = answer_at(&r, RELEASE_TIME - 0.005)->command;
        double next = answer_at(&r, RELEASE_TIME)->command;
        fail_if(fabs(next - last) > 0.1, "%s released from %s jumps from %g V to %g V",
                (*c)[0], (*c)[1], last, next);
    }
}

TEST(unknown_modes_are_refused)
{
    static const struct {
        const char *law, *mode, *why;
    } cases[] = {
        {"control.law=hybrid", "press", "expected none, approach, impact or force"},
        {"control.law=open-loop", "approach", "cannot be held in a mode"},
        {"control.law=inverse-dynamics", "press", "cannot be held in a mode"},
    };
    for (EACH(c, cases)) {
        scenario s = {.parameters = rig_parameters_with("%s", c->law)};
        REFUSED(STATUS_BAD_SCENARIO, c->why,
                scenario_override(&s, formatted("control.lock=%s", c->mode), &f));
        check_close(parameter_get(&s.parameters, PARAMETER_INDEX(control.lock)), 0, 0);
        DONE(scenario_override(&s, "control.lock=none", &f));
    }
    // without a law it says nothing, like every parameter of the rig
    scenario bare = {.parameters = rig_parameters(NULL)};
    assert_int_equal(scenario_override(&bare, "control.lock=force", NULL), STATUS_OK);
}

// --- in a session ----------------------------------------------------------------------

TEST(lock_is_an_input_that_a_saved_scenario_repeats)
{
    const int lock = PARAMETER_INDEX(control.lock);
    scenario s = shipped("compare/hybrid");
    KEPT_SESSION(e);
    KEPT_RUN(free_run) = run_done(&s, true);
    DONE(session_open(&e, &s, HUGE_VAL, &f));
    session_seek(&e, 0.4);
    DONE(session_change(&e, lock, "approach", &f));
    session_seek(&e, 0.7);
    DONE(session_change(&e, lock, "none", &f));
    REFUSED(STATUS_BAD_SCENARIO, "", session_change(&e, lock, "nonsense", &f));
    assert_int_equal(e.input_count, 2);
    parameters then = session_parameters_at(&e, 0.5),
               later = session_parameters_at(&e, 0.8);
    assert_string_equal(then.control.lock, "approach");
    assert_string_equal(later.control.lock, "none");

    free(save_and_compare(&e));

    DONE(session_undo(&e, &f));
    DONE(session_undo(&e, &f));
    assert_same_trace(&e.run.trace, &free_run.trace);
    DONE(session_redo(&e, &f));
    check_close(e.run.trace.rows[trace_row_at(&e.run.trace, 0.6)].controller_mode, 0, 0);
}

// Every law that can be locked goes from each of its modes to each other, in flight as in
// contact, with the corrected and with the printed model of the arm. The loop counts
// through the laws twice, once for each model.
TEST(every_mode_is_gone_into_from_every_other)
{
    enum { MOST = 32 };
    const char *const models[] = {"arm.model=corrected", "arm.model=printed"};
    for (int law = LAW_NONE + 1; law < 2 * LAW_PLUGIN; law++) {
        const controller *c =
            law % LAW_PLUGIN == LAW_NONE ? NULL : controller_of(law % LAW_PLUGIN);
        if (c == NULL || !c->lockable) {
            continue;
        }

        // all pairs of modes in flight, and again in contact
        action script[MOST];
        int count = 0, modes = 0, mode[MOST];
        while (c->modes[modes] != NULL) {
            modes++;
        }
        for (int part = 0; part < 2; part++) {
            double time = part == 0 ? 0.006 : 0.601; // in flight, in contact
            for (int i = 0; i < modes; i++) {
                for (int j = 0; j < modes && count + 2 <= MOST; j++) {
                    for (int k = 0; k < 2; k++, time += 0.01, count++) {
                        mode[count] = k == 0 ? i : j;
                        script[count] = locked_at(time, c->modes[mode[count]]);
                    }
                }
            }
        }

        scenario s = {.parameters =
                          rig_parameters_with("control.law=%s %s run.duration=0.8",
                                              c->name, models[law / LAW_PLUGIN]),
                      .actions = script,
                      .action_count = count};
        KEPT_RUN(r);
        fail_if(run_scenario(&s, true, &r) != STATUS_OK, "%s: %s", c->name,
                r.summary.message);

        // one sample after each change the law is in the mode that was asked for
        for (int i = 0; i < count; i++) {
            const double then = script[i].time + 0.006,
                         is = answer_at(&r, then)->controller_mode;
            fail_if(is != mode[i], "%s, %s: mode %g, not %d, at %g s", c->name,
                    models[law / LAW_PLUGIN], is, mode[i], then);
        }
    }
}

// No more names are written than there is room for.
TEST(names_of_modes_keep_to_their_room)
{
    parameters p = rig_parameters_with("control.law=hybrid");
    char names[3][MODE_NAME_SIZE] = {"", "", "untouched"};
    bool lockable;
    assert_int_equal(rig_mode_names(&p, names, 1, &lockable), 1);
    assert_string_equal(names[0], controller_of(LAW_HYBRID)->modes[0]);
    assert_string_equal(names[1], "");
    assert_true(rig_mode_names(&p, names, 2, &lockable) == 2 && lockable);
    assert_string_equal(names[1], controller_of(LAW_HYBRID)->modes[1]);
    assert_string_equal(names[2], "untouched");
}

// The names of a law's modes are those of its own table, and whether it can be held in a
// mode is said there, too. The scenario names a plug-in that does not exist: under
// another law it must not matter, and under the law "plugin" (which has no table of its
// own) it gives no modes, whether code may be loaded or not.
TEST(only_the_law_itself_gives_modes)
{
    char names[8][MODE_NAME_SIZE];
    bool lockable = false;
    parameters p = rig_parameters_with("control.law=hybrid");
    strcpy(p.control.plugin, "/nowhere/at-all.so");
    for (int allowed = 0; allowed < 2; allowed++) {
        p.code_allowed = allowed;
        for (int law = LAW_NONE; law <= LAW_PLUGIN; law++) {
            p.control.law = law;
            const controller *c = controller_of(law);

            // how many modes the law's own table has
            int modes = 0;
            while (c != NULL && c->modes != NULL && c->modes[modes] != NULL) {
                modes++;
            }

            // the rig names the same modes
            assert_int_equal(rig_mode_names(&p, names, 8, &lockable), modes);
            assert_int_equal(lockable, c != NULL && c->lockable);
            for (int i = 0; i < modes; i++) {
                assert_string_equal(names[i], c->modes[i]);
            }
        }
    }
}

// A law with an empty list of modes, with a single mode, and without a list. "none" and
// "" hold the law in no mode (-1); any other name has to be in the list, and the refusal
// says what is.
TEST(a_law_of_no_modes_has_none_to_be_held_in)
{
    static const char *const none[] = {NULL}, *const one[] = {"only", NULL};
    controller law = {.name = "own", .lockable = true, .modes = none};
    fault f = {0};
    int mode = 7; // no answer: to be overwritten
    assert_int_equal(rig_find_mode(&law, "none", &mode, &f), STATUS_OK);
    assert_int_equal(mode, -1);
    assert_int_equal(rig_find_mode(&law, "only", &mode, &f), STATUS_BAD_SCENARIO);
    assert_int_equal(mode, -1);
    assert_string_equal(
        f.text, "control.lock = 'only' is no mode of the law 'own', expected none, ");
    assert_string_equal(f.path, "control.lock");

    law.modes = one;
    assert_int_equal(rig_find_mode(&law, "only", &mode, &f), STATUS_OK);
    assert_int_equal(mode, 0);
    assert_int_equal(rig_find_mode(&law, "onl", &mode, &f), STATUS_BAD_SCENARIO);
    assert_string_equal(
        f.text, "control.lock = 'onl' is no mode of the law 'own', expected none, only");
    law.modes = NULL;
    assert_int_equal(rig_find_mode(&law, "only", &mode, &f), STATUS_BAD_SCENARIO);
    assert_int_equal(rig_find_mode(&law, "", &mode, &f), STATUS_OK);
}
