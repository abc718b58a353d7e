// control.settings.NAME: one number of the text, by --set, in files, in scripts and as an
// axis.
#include "src/session/session.h"
#include "src/study/sweep_axis.h"
#include "src/tables/settings.h"
#include "tests/rig_fixture.h"

static const char observer_file[] = "title: t\n"
                                    "initial:\n  angle: -0.1\n"
                                    "wall:\n  angle: 0\n"
                                    "run:\n  duration: 0.3 s\n"
                                    "control:\n  law: %s\n%s";

static void keep_fault(void *context, const char *sentence)
{
    snprintf(context, 1024, "%s", sentence);
}

// A scenario with these lines under `control:` and behind; the caller finishes it.
static status parse(scenario *s, const char *law, const char *lines,
                    char fault_text[1024])
{
    const char *text = formatted(observer_file, law, lines);
    fault_text[0] = '\0';
    return scenario_parse(s, text, strlen(text), "arm.yaml", NULL, keep_fault,
                          fault_text);
}

TEST(one_number_is_exchanged_and_the_others_stay)
{
    static const struct {
        const char *before, *name, *text, *after;
    } cases[] = {
        {"", "a", "1", "a=1"},
        {"a=1", "b", "0.1", "a=1 b=0.1"},
        {"a=1 b=2 c=3", "b", "-5e-7", "a=1 b=-5e-07 c=3"},
        {"a=1 b=2 a=3", "a", "4", "a=4 b=2"},
        {"ab=1", "a", "2", "ab=1 a=2"},
        {"mode=fast", "gain", "0.30000000000000004",
         "mode=fast gain=0.30000000000000004"},
    };
    for (EACH(c, cases)) {
        parameters p = fresh(ARM_CORRECTED);
        double value = 0;
        give(&p, "control.settings", c->before);
        assert_int_equal(settings_set_text(&p, c->name, c->text, NULL), STATUS_OK);
        assert_string_equal(p.control.settings, c->after);
        assert_true(settings_get(&p, c->name, &value));
        check_close(value, atof(c->text), 0);
        assert_false(settings_get(&p, "none", &value));
    }
}

TEST(what_is_no_number_or_no_name_is_refused)
{
    static const struct {
        const char *assignment, *sentence;
    } cases[] = {
        {"control.settings.a=x", "control.settings.a = 'x' is not a number"},
        {"control.settings.a=", "control.settings.a = '' is not a number"},
        {"control.settings.a=3 b=4", "'3 b=4' is not a number"},
        {"control.settings.a=1e999", "is not"},
        {"control.settings.=3", "names no setting"},
        {"control.settings.a b=3", "names no setting"},
        {"control.settings.name_of_a_number_that_is_far_too_long_to_be_one=3",
         "names no setting"},
    };
    char said[1024];
    KEPT_SCENARIO(s);
    assert_int_equal(parse(&s, "observer", "", said), STATUS_OK);
    for (EACH(c, cases)) {
        fault f = {0};
        assert_int_not_equal(scenario_override(&s, c->assignment, &f), STATUS_OK);
        fail_if(strstr(f.text, c->sentence) == NULL, "'%s' does not say '%s'", f.text,
                c->sentence);
    }

    // beside the others there must be room
    for (int i = 0; i < 9; i++) {
        fault f = {0};
        const status code =
            scenario_override(&s, formatted("control.settings.setting%d=0.12345", i), &f);
        assert_int_equal(code, i < 7 ? STATUS_OK : STATUS_BAD_SCENARIO);
        assert_true(i < 7 || strstr(f.text, "has no room") != NULL);
    }

    // the text of all of them and one of them at once
    char *both[] = {"control.settings.a=1", "control.settings=b=2"};
    assert_int_not_equal(scenario_override_all(&s, both, 2, keep_fault, said), STATUS_OK);
    assert_non_null(strstr(said, "are set together"));
}

TEST(a_file_has_a_map_or_the_text)
{
    static const struct {
        const char *lines, *settings, *sentence;
    } cases[] = {
        {"  settings: {wall_doubt: 0.01, b: 2}\n", "wall_doubt=0.01 b=2", NULL},
        {"  settings:\n    wall_doubt: 0.01\n", "wall_doubt=0.01", NULL},
        {"  settings: wall_doubt=0.01 b=2\n", "wall_doubt=0.01 b=2", NULL},
        {"  settings: {wall_doubt: near}\n", NULL, "arm.yaml:10:26"},
        {"  settings: {\"a b\": 1}\n", NULL, "arm.yaml:10:14"},
        {"  settings: {a: 1}\n  settings: a=1\n", NULL, "arm.yaml:11:3"},
        {"  settings: {a: 1, a: 2}\n", NULL, "arm.yaml:10:20"},
        {"  settings: [1]\n", NULL, "arm.yaml:10:13"},
    };
    for (EACH(c, cases)) {
        char said[1024];
        scenario s;
        const status code = parse(&s, "observer", c->lines, said);
        if (c->settings != NULL) {
            assert_int_equal(code, STATUS_OK);
            assert_string_equal(s.parameters.control.settings, c->settings);
            scenario_finish(&s);
        } else {
            assert_int_equal(code, STATUS_BAD_SCENARIO);
            fail_if(strstr(said, c->sentence) == NULL, "'%s' does not say '%s'", said,
                    c->sentence);
        }
    }
}

// A number set during the run is what the law has from then on: the run is another, its
// rows until then are the same; what is written reads back as the same script.
TEST(a_script_sets_one_of_them)
{
    char said[1024];
    KEPT_SCENARIO(plain), scripted, again;
    const char *law = "impedance";
    assert_int_equal(parse(&plain, law, "  settings: {force: 0.5}\n", said), STATUS_OK);
    assert_int_equal(
        parse(&scripted, law,
              "  settings: {force: 0.5}\n"
              "script:\n  - at: 0.2 s\n    set: {control.settings.stiffness: 300}\n",
              said),
        STATUS_OK);
    const parameters changed = scenario_parameters_at(&scripted, 0.25);
    assert_string_equal(changed.control.settings, "force=0.5 stiffness=300");

    // the runs
    KEPT_RUN(before) = run_done(&plain, true), after = run_done(&scripted, true);
    assert_true(before.summary.steady_force_N != after.summary.steady_force_N);
    const size_t rows = trace_rows_until(&before.trace, 0.19);
    assert_true(rows > 10);
    check_close(before.trace.rows[rows - 1].hub_angle,
                after.trace.rows[rows - 1].hub_angle, 0);

    // written and read
    SCOPED(free_kept) WRITTEN(text, scenario_write(stream, &scripted));
    assert_non_null(strstr(text, "set: {control.settings.stiffness: 300}"));
    assert_int_equal(scenario_parse(&again, text, strlen(text), "again.yaml", NULL,
                                    keep_fault, said),
                     STATUS_OK);
    assert_int_equal(again.action_count, 1);
    assert_string_equal(again.actions[0].text, scripted.actions[0].text);
}

// Two of them adjusted at one instant are two inputs, each undone by itself.
TEST(a_session_undoes_each_by_itself)
{
    char said[1024];
    scenario s;
    KEPT_SESSION(lab);
    const int index = PARAMETER_INDEX(control.settings);
    assert_int_equal(parse(&s, "impedance", "", said), STATUS_OK);
    assert_int_equal(session_open(&lab, &s, 10, NULL), STATUS_OK);
    session_seek(&lab, 0.1);
    assert_int_equal(session_adjust(&lab, index, ".stiffness=50", NULL), STATUS_OK);
    assert_int_equal(session_adjust(&lab, index, ".damping=2", NULL), STATUS_OK);
    assert_int_equal(session_adjust(&lab, index, ".damping=3", NULL), STATUS_OK);
    assert_int_equal(lab.input_count, 2);
    parameters p = session_parameters_at(&lab, 0.2);
    assert_string_equal(p.control.settings, "stiffness=50 damping=3");
    assert_int_equal(session_undo(&lab, NULL), STATUS_OK);
    p = session_parameters_at(&lab, 0.2);
    assert_string_equal(p.control.settings, "stiffness=50");
}

TEST(an_axis_varies_one_of_them)
{
    SCOPED(sweep_axis_finish) sweep_axis axis = {0};
    char values[] = "0.1:0.3:3", text[64];
    parameters p = rig_parameters(NULL);
    DONE(sweep_axis_find(&axis, "control.settings.gain", &f));
    DONE(sweep_axis_parse(&axis, values, false, &f));
    assert_int_equal(axis.count, 3);
    assert_true(isnan(sweep_axis_get(&axis, &p)));
    DONE(sweep_axis_apply(&axis, sweep_axis_value(&axis, 1), &p, &f));
    check_close(sweep_axis_get(&axis, &p), 0.2, 1e-15);
    sweep_axis_format(&axis, 0.2, text, sizeof text);
    assert_string_equal(text, "0.2");
    assert_string_equal(axis.name, "control.settings.gain");
}

// A name that the law does not have is known when the run starts.
TEST(the_start_of_the_run_checks_the_names)
{
    check_refused(SETTINGS("control.law=hybrid", "control.settings=.bogus=3"),
                  "has no parameter 'bogus'");
}
