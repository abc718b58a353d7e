// Reading scenarios: what a file may say, and the place and sentence of everything it may
// not.
#include "tests/given_parameters.h"
#include "tests/scenario_fixture.h"

#include "src/run/run.h"

// ---- what a file may say --------------------------------------------------------------

TEST(a_whole_scenario_is_read)
{
    KEPT_SCENARIO(s) = good("# a comment\n"
                            "title: 'Contact force: 1 V'\n"
                            "description: >\n"
                            "  Two lines\n"
                            "  become one.\n"
                            "arm:\n"
                            "  model: printed\n"
                            "  k2: 49.2 N m/rad # ten times\n"
                            "motor: {voltage: -2}\n"
                            "script:\n"
                            "  - at: 0.6 s\n"
                            "    set: {motor.voltage: 3 V, arm.k2: 5}\n"
                            "  - {at: 0.4, set: {motor.voltage: 2 V}}\n"
                            "expect:\n"
                            "  first_contact_s: {value: 0.312, tolerance: 0.002}\n"
                            "  first_pulse_s: null\n");
    assert_string_equal(s.name, "f.yaml");
    assert_string_equal(s.title, "Contact force: 1 V");
    assert_string_equal(s.description, "Two lines become one.");
    assert_int_equal(s.parameters.arm.model, ARM_PRINTED);
    assert_int_equal(s.parameters.arm.hub_joint, HUB_SPRING); // resolved, not given
    check_close(s.parameters.arm.k2, 49.2, 0);
    check_close(s.parameters.motor.voltage, -2, 0);
    // in the order of time, and of one instant in the order of the file
    assert_int_equal(s.action_count, 3);
    check_close(s.actions[0].time, 0.4, 0);
    check_close(s.actions[0].value, 2, 0);
    check_close(s.actions[1].value, 3, 0);
    assert_int_equal(s.actions[2].parameter, PARAMETER_INDEX(arm.k2));
    assert_int_equal(s.expectation_count, 2);
    assert_int_equal(s.expectations[0].quantity, SUMMARY_INDEX(first_contact_s));
    check_close(s.expectations[0].value, 0.312, 0);
    check_close(s.expectations[0].tolerance, 0.002, 0);
    assert_false(s.expectations[0].is_null);
    assert_int_equal(s.expectations[0].line, 15);
    assert_int_equal(s.expectations[0].column, 3);
    assert_true(s.expectations[1].is_null);
}

TEST(what_is_left_out_has_a_default)
{
    KEPT_SCENARIO(s) = good("{}");
    const parameters p = defaults_of(ARM_CORRECTED);
    assert_memory_equal(&s.parameters, &p, sizeof p);
    assert_string_equal(s.title, "f.yaml");
    assert_string_equal(s.description, "");
    assert_int_equal(s.action_count, 0);
    assert_int_equal(s.expectation_count, 0);
    scenario_finish(&s);
    scenario_finish(&s); // a finished one may be finished again

    // a list without numbers is none
    s = good("arm: {link_lengths: []}");
    assert_string_equal(s.parameters.arm.link_lengths, "");
}

TEST(the_order_of_groups_does_not_matter)
{
    KEPT_SCENARIO(s) =
        good("script: [{at: 4 s, push: -0.02 N s}]\nrun: {duration: 5 s}\n");
    assert_int_equal(s.actions[0].kind, ACTION_PUSH);
    check_close(s.actions[0].value, -0.02, 0);
}

TEST(a_byte_order_mark_and_windows_lines_are_fine)
{
    KEPT_SCENARIO(s) = good("\xef\xbb\xbf"
                            "title: x\r\narm:\r\n  k2: 5\r\n");
    assert_string_equal(s.title, "x");
    check_close(s.parameters.arm.k2, 5, 0);
    check_fault("\xef\xbb\xbf"
                "titel: x\r\n",
                1, 1, "'title'");
}

TEST(times_at_both_ends_of_the_run_are_inside)
{
    KEPT_SCENARIO(s) = good("script: [{at: 0, push: 1}, {at: 1 s, push: 2}]");
    assert_int_equal(s.action_count, 2);
}

// ---- faults of parameters -------------------------------------------------------------

TEST(unknown_keys_suggest_what_was_meant)
{
    check_fault("titel: x\n", 1, 1, "did you mean 'title'?");
    check_fault("title: x\nmotr: {voltage: 1}\n", 2, 1, "did you mean 'motor'?");
    check_fault("title: x\nqwertyuiop: 1\n", 2, 1,
                "expected title, description, panes, arm, motor, wall");
    check_fault("arm:\n  k3: 5\n", 2, 3, "in arm, did you mean 'k1'?");
    check_fault("wall:\n  kind: point\n  angel: 0.1\n", 3, 3, "did you mean 'angle'?");
    check_fault("wall: {kind: point, voltage: 1}\n", 1, 21,
                "did you mean motor.voltage?");
    check_fault("control: {k2_factor: 1}\n", 1, 11, "did you mean belief.k2_factor?");
    check_fault("wall: {height_above: 1}\n", 1, 8,
                "expected one of kind, angle, restitution");
    check_fault("wall: {stiffness: -1}\n", 1, 19, "out of range");
    check_fault("wall: {contact: kelvin-voigt, restitution: 0.5}\n", 1, 44,
                "for wall.contact = rigid");
    check_fault("arm.k2: 5\n", 1, 1, "expected 'k2:' under 'arm:'");
}

TEST(wrong_values_are_named_with_their_place)
{
    check_fault("arm:\n  k2: stiff\n", 2, 7, "arm.k2 = 'stiff' is not a number");
    check_fault("arm:\n  k2: -1\n", 2, 7,
                "out of range, expected 1e-06 to 1e+09 N m/rad");
    check_fault("arm:\n  k2: 5 N/m\n", 2, 7, "expected N m/rad");
    check_fault("arm:\n  k2: .inf\n", 2, 7, "arm.k2");
    check_fault("arm:\n  k2: nan\n", 2, 7, "not finite");
    check_fault("arm:\n  k2: 1e999\n", 2, 7, "finite");
    check_fault("arm:\n  links: 2.5\n", 2, 10, "whole number");
    check_fault("arm: {model: prnted}\n", 1, 14, "corrected|printed");
    check_fault("printed: {sign_dead_band: perhaps}\n", 1, 27, "true nor false");
}

TEST(wrong_shapes_are_named_with_their_place)
{
    check_fault("arm: 3\n", 1, 6, "arm is a single value, expected keys");
    check_fault("arm: [1]\n", 1, 6, "arm is a list, expected keys");
    check_fault("title: x\narm:\n", 2, 5, "arm is empty, expected keys");
    check_fault("arm:\n  k2: {a: 1}\n", 2, 7,
                "arm.k2 is a map of keys, expected a value");
    check_fault("arm:\n  k2: [5]\n", 2, 7, "arm.k2 is a list, expected a value");
    check_fault("arm:\n  k2:\n", 2, 6, "arm.k2 is empty, expected a value");
    check_fault("- arm\n", 1, 1, "the file is a list");
    check_fault("just words\n", 1, 1, "the file is a single value");
    check_fault("title: [x]\n", 1, 8, "title is a list, expected text");
    check_fault("title: |\n  a\n  b\n", 1, 8, "several lines");
    check_fault("title: \"a\\eb\"\n", 1, 8, "control character");
    check_fault("description: \"a\\x85b\"\n", 1, 14, "control character");
    check_fault("? [a, b]\n: 1\n", 1, 3, "the key is a list, expected a word");
}

TEST(a_key_may_be_there_once)
{
    check_fault("arm:\n  k2: 5\n  k1: 7\n  k2: 6\n", 4, 3, "first at line 2");
    check_fault("arm: {k2: 5}\nmotor: {voltage: 1}\narm: {k1: 7}\n", 3, 1,
                "'arm' is there twice");
    check_fault("title: x\ntitle: x\n", 2, 1, "first at line 1");
}

TEST(impossible_combinations_point_at_the_key)
{
    check_fault("arm:\n  model: printed\n  links: 5\n", 3, 10,
                "the printed model has two links");
    check_fault("arm: {model: printed}\nwall: {kind: plane}\n", 2, 14, "not plane");
    check_fault("arm:\n  links: 3\n  link_inertia: 1e-5\n", 3, 17, "two links only");
    check_fault("arm:\n  EI: 2.46\n  k2: 4.92\n", 2, 7, "both given");
    check_fault("arm: {hub_joint: beam, k1: 90}\n", 1, 28, "arm.hub_joint = spring");
    // lists of the beam
    check_fault("arm:\n  links: 4\n  joint_stiffness: [10, 12]\n", 3, 20, "expected 3");
    check_fault("arm:\n  links: 4\n  joint_stiffness: [10, -3, 9]\n", 3, 25,
                "-3 is out of range");
    check_fault("arm:\n  links: 3\n  link_lengths:\n    - 0.3\n    - long\n    - 1\n", 5,
                7, "'long' is not a number");
    check_fault("arm:\n  k2: 5\n  joint_stiffness: [7]\n", 3, 20, "both given");
    check_fault("arm: {hub_joint: beam}\nscript:\n  - at: 0.1 s\n    set: {arm.k1: 90}\n",
                4, 19, "arm.k1 is for arm.hub_joint = spring");
    check_fault(
        "arm: {joint_stiffness: [7]}\nscript:\n  - at: 0.1 s\n    set: {arm.EI: 9}\n", 4,
        19, "follows from arm.joint_stiffness");
    // all of them, not the first one only
    check_faults("arm: {model: printed, links: 5, hub_joint: rigid}\n"
                 "wall: {kind: plane}\n"
                 "method: {name: event}\n",
                 4,
                 (const char *const[]){"f.yaml:1:30: ", "f.yaml:1:44: ", "f.yaml:2:14: ",
                                       "f.yaml:3:16: "});
}

// However the reader comes upon them: the keys of the whole before those within.
TEST(faults_of_one_line_are_told_from_left_to_right)
{
    scenario s;
    sentences all;
    const char *text = "{wall: {knd: 3}, script: [{at: x}], w: 1, arm: {lnks: 3}}\n";
    assert_int_equal(parse(&s, text, &all), STATUS_BAD_SCENARIO);
    const char *before = all.text;
    for (EACH_TEXT(c, "'knd'", "at", "'w'", "'lnks'")) {
        const char *at = strstr(before, *c);
        assert_non_null(at);
        before = at;
    }
}

// Blanks alone are no text, and a unit's sign is no control character.
TEST(prose_is_text)
{
    check_fault("title: ' '\n", 1, 8, "title is empty, expected text");
    check_fault("title: t\ndescription: \" \\n \"\n", 2, 14, "expected text");
    check_fault("title: \"a \\x9b\"\n", 1, 8, "a control character");
    KEPT_SCENARIO(s) = good("title: '5 \u00b5s  '\n");
    assert_string_equal(s.title, "5 \u00b5s");
}

TEST(a_title_has_a_limit)
{
    check_fault(formatted("title: %s", repeated('x', 300)), 1, 8, "at most 200");
}

// ---- faults of script and expect ------------------------------------------------------

TEST(faults_of_actions)
{
    check_fault("script: {at: 1}\n", 1, 9, "script is a map of keys, expected a list");
    check_fault("script:\n  - at\n", 2, 5, "an action is a single value");
    check_fault("script:\n  - push: 1\n", 2, 5, "without a time");
    check_fault("script:\n  - at: 0.5 s\n", 2, 5, "does nothing");
    check_fault("script:\n  - at: soon\n    push: 1\n", 2, 9, "at = 'soon'");
    check_fault("script:\n  - at: [1]\n    push: 1\n", 2, 9,
                "at is a list, expected a number in s");
    check_fault("script:\n  - at:\n    push: 1\n", 2, 8, "at is empty");
    check_fault("script:\n  - at: 1.5 s\n    push: 1\n", 2, 9, "expected 0 to 1 s");
    check_fault("script:\n  - at: -1 s\n    push: 1\n", 2, 9, "outside the run");
    check_fault("script:\n  - at: 500 ms\n    push: 1\n", 2, 9, "expected s");
    check_fault("script:\n  - at: 0.5\n    push: 1 N\n", 3, 11, "expected N s");
    check_fault("script:\n  - at: 0.5\n    push: inf\n", 3, 11, "finite");
    check_fault("script:\n  - at: 0.5\n    push: 1e999\n", 3, 11, "finite");
    check_fault("script:\n  - at: 0.5\n    pish: 1\n", 3, 5, "did you mean 'push'?");
    check_fault("script:\n  - at: 0.5\n    push: 1\n    set: {motor.voltage: 1}\n", 4, 5,
                "'set' after 'push' in one action");
    check_fault("script:\n  - at: 0.5\n    at: 0.6\n    push: 1\n", 3, 5, "twice");
    check_fault("arm: {model: printed}\nscript:\n  - at: 0.5\n    push: 1\n", 4, 5,
                "takes no pushes");
}

TEST(faults_of_set)
{
    check_fault("script:\n  - at: 0.5\n    set: 3\n", 3, 10, "set is a single value");
    check_fault("script:\n  - at: 0.5\n    set: {arm.links: 3}\n", 3, 11,
                "cannot change during");
    check_fault("script:\n  - at: 0.5\n    set: {motor.voltag: 3}\n", 3, 11,
                "did you mean 'motor.voltage'?");
    check_fault("script:\n  - at: 0.5\n    set: {x: 3}\n", 3, 11,
                "unknown parameter 'x'");
    check_fault(
        "control: {law: force-pd}\nscript:\n  - at: 0.5\n    set: {control.delay: 0.5}\n",
        3, 3,
        "from 0.5 s on control.delay_periods = 0 and control.delay = 0.5 s are together");
    check_fault("script:\n  - at: 0.5\n    set: {motor.voltage: 1e9}\n", 3, 26,
                "out of range");
    check_fault("script:\n  - at: 0.5\n    set: {motor.voltage: [1]}\n", 3, 26,
                "is a list");
    check_fault("script:\n  - at: 0.5\n    set: {motor.voltage: 1, motor.voltage: 2}\n",
                3, 29, "twice");
}

// What a script may change is what the table says, from its first parameter to its last.
TEST(only_timed_parameters_are_set_by_a_script)
{
    for (int i = 0; i < parameter_count; i++) {
        const char *text = formatted("script:\n  - at: 0.5\n    set: {%s: no}\n",
                                     parameter_table[i].path);
        if (!parameter_table[i].timed) {
            check_fault(text, 3, 11, "cannot change during a run");
        } else {
            scenario s;
            sentences all;
            if (parse(&s, text, &all) == STATUS_OK) {
                scenario_finish(&s);
            } else {
                assert_null(strstr(all.text, "cannot change during a run"));
            }
        }
    }
}

TEST(faults_of_expectations)
{
    check_fault("expect: 3\n", 1, 9, "expect is a single value");
    check_fault("expect:\n  impact: {value: 1, tolerance: 0}\n", 2, 3,
                "did you mean 'impacts'?");
    check_fault("expect:\n  beauty_of_it_all: null\n", 2, 3, "unknown quantity");
    check_fault("expect:\n  wall_time_s: null\n", 2, 3, "depends on the computer");
    check_fault("expect:\n  impacts: 3\n", 2, 12,
                "expected {value: ..., tolerance: ...} or null");
    check_fault("expect:\n  impacts: \"null\"\n", 2, 12, "expected {value");
    check_fault("expect:\n  impacts: {value: 3}\n", 2, 12, "no tolerance");
    check_fault("expect:\n  impacts: {value: 3, tolerance: 1, value: 2}\n", 2, 37,
                "twice");
    check_fault("expect:\n  impacts: {tolerance: 3}\n", 2, 12, "no value");
    check_fault("expect:\n  impacts: {value: 3, tolerance: -1}\n", 2, 34, "negative");
    check_fault("expect:\n  impacts: {value: nan, tolerance: 1}\n", 2, 20, "finite");
    check_fault("expect:\n  impacts: {value: 3 N, tolerance: 1}\n", 2, 20,
                "without a unit");
    check_fault("expect:\n  impacts: {value: 3, tolerance: 1, by: 2}\n", 2, 37,
                "unknown key 'by'");
}

TEST(several_faults_are_all_reported)
{
    check_faults("titel: x\n"
                 "arm:\n"
                 "  k2: stiff\n"
                 "  links: 0\n"
                 "  k22: 1\n"
                 "motor: 5\n"
                 "run: {duration: 2 s}\n"
                 "script:\n"
                 "  - at: 9 s\n"
                 "    set: {arm.links: 3, motor.voltage: x}\n"
                 "  - push: 3\n"
                 "expect:\n"
                 "  impacts: {value: 3, tolerance: -1}\n"
                 "  nonsense: null\n",
                 11,
                 (const char *const[]){
                     "f.yaml:1:1: unknown key 'titel'", "f.yaml:3:7: arm.k2 = 'stiff'",
                     "f.yaml:4:10: arm.links = 0", "f.yaml:5:3: unknown key 'k22'",
                     "f.yaml:6:8: motor is", "f.yaml:10:11: arm.links cannot change",
                     "f.yaml:10:40: motor.voltage = 'x'",
                     "f.yaml:11:5: an action without a time", "f.yaml:13:34: tolerance",
                     "f.yaml:14:3: unknown quantity", "f.yaml:9:9: at = 9 s is outside"});
}

// A list may be written as YAML's or as text; in either it has an end.
TEST(lists_are_read_in_both_forms)
{
    for (EACH_TEXT(c, "[10, 12.5]", "'10,12.5'")) {
        KEPT_SCENARIO(s) =
            good(formatted("title: t\narm: {links: 3, joint_stiffness: %s}\n", *c));
        assert_string_equal(s.parameters.arm.joint_stiffness, "10, 12.5");
    }
    scenario s;

    char text[2000] = "arm: {links: 32, link_lengths: [0.03125";
    for (int k = 1; k < 32; k++) {
        strcat(text, ", 0.031250000000000000000000000000000000000");
    }
    strcat(text, "]}\n");
    sentences all;
    assert_int_equal(parse(&s, text, &all), STATUS_BAD_SCENARIO);
    assert_non_null(strstr(all.text, "arm.link_lengths is too long"));
}

// A value that the parameter does not accept changes nothing, for any origin of the
// action.
TEST(an_action_that_cannot_be_changes_nothing)
{
    KEPT_SCENARIO(s) = good("title: t\n");
    const parameters before = s.parameters;
    const action wrong = {.kind = ACTION_SET,
                          .parameter = PARAMETER_INDEX(arm.k2),
                          .value = -1};
    REFUSED(STATUS_BAD_SCENARIO, "arm.k2", action_apply(&wrong, &s.parameters, &f));
    assert_memory_equal(&s.parameters, &before, sizeof before);
}

// One that the law does not know from the start is said even where a script follows. A
// list may be as long as a text: with one character more it is refused where it becomes
// too long.
TEST(a_list_has_a_limit)
{
    for (int over = -1; over < 2; over++) {
        const int digits = PARAMETER_VALUE_SIZE - 1 - (int)strlen(", 7.5") + over;
        const char *text =
            formatted("arm:\n  links: 3\n  joint_stiffness:\n  - 6.%0*d\n  - 7.5\n",
                      digits - 2, 0);
        if (over > 0) {
            check_fault(text, 5, 5, "too long");
            continue;
        }
        KEPT_SCENARIO(s) = good(text);
        double numbers[PARAMETER_LIST_MOST];
        assert_int_equal(parameter_list_numbers(s.parameters.arm.joint_stiffness,
                                                numbers),
                         2);
        check_close(numbers[0], 6, 0);
        check_close(numbers[1], 7.5, 0);
    }
}

// What the parser complains about at the end is not what stands behind the text.
TEST(nothing_is_read_behind_the_end)
{
    scenario s;
    sentences all = {0};
    const char *text = "arm: [1\t";
    assert_int_equal(scenario_parse(&s, text, strlen(text) - 1, "f.yaml", NULL,
                                    keep_sentence, &all),
                     STATUS_BAD_SCENARIO);
    assert_int_equal(all.count, 1);
    assert_null(strstr(all.text, "a tab"));
}

TEST(a_lock_is_one_of_the_laws_modes)
{
    KEPT_SCENARIO(s) = good("title: t\ncontrol: {law: hybrid}\n"
                            "script: [{at: 0.1, set: {control.lock: force}}, "
                            "{at: 0.2, set: {control.lock: none}}]\n");
    check_fault("title: t\ncontrol: {law: hybrid, lock: nonsense}\n"
                "script: [{at: 0.1, set: {motor.voltage: 1}}]\n",
                2, 30, "control.lock = 'nonsense' is no mode of");
    check_fault("title: t\ncontrol: {law: hybrid}\n"
                "script: [{at: 0.1, set: {control.lock: nonsense}}]\n",
                3, 40, "control.lock = 'nonsense' is no mode of");
}

TEST(an_expectation_may_be_exact)
{
    KEPT_SCENARIO(s) = good("title: t\nexpect: {impacts: {value: 2, tolerance: 0}}\n");
    check_close(s.expectations[0].tolerance, 0, 0);
    check_fault("title: t\nexpect: {impacts: {value: 2, tolerance: -1}}\n", 2, 41,
                "tolerance");
}

// What a fit leaves open is read, and written so that it reads back the same.
TEST(a_fit_is_read_and_written)
{
    KEPT_SCENARIO(s) = good("arm: {k2: 5}\nfit:\n  arm.k2: [0.05]\n"
                            "  arm.hub_inertia: [1e-5, 0.5]\n"
                            "  motor.stiction: [2e-4, -0.1, 0]\n");
    KEPT_TEXT(text) = scenario_as_text(&s);
    KEPT_SCENARIO(again) = good(text);
    const scenario *const both[] = {&s, &again};
    for (int i = 0; i < 2; i++) {
        const scenario_fit *fit = both[i]->fit;
        assert_int_equal(fit->count, 3);
        assert_int_equal(fit->parameters[1], parameter_find("arm.hub_inertia"));
        check_close(fit->errors[2], 2e-4, 0);
        check_close(fit->correlation[1], 0.5, 0);
        check_close(fit->correlation[2 * 3 + 0], -0.1, 0);
        check_close(fit->correlation[4], 1, 0);
    }
}

TEST(faults_of_fits)
{
    check_fault("fit: 3\n", 1, 6, "fit is a single value");
    check_fault("fit: {}\n", 1, 6, "fit is empty");
    check_fault("fit:\n  arm.k9: [1]\n", 2, 3, "'arm.k9' is no parameter with a real");
    check_fault("fit:\n  arm.links: [1]\n", 2, 3, "no parameter with a real value");
    check_fault("fit:\n  arm.k2: 0.1\n", 2, 11, "its standard error and 0 correl");
    check_fault("fit:\n  arm.k2: [0]\n", 2, 12, "a standard error above 0");
    check_fault("fit:\n  arm.k2: [1 kg]\n", 2, 12, "expected N m/rad");
    check_fault("fit:\n  arm.k2: [1, 0.5]\n", 2, 11, "0 correlations");
    check_fault("fit:\n  arm.k2: [1]\n  arm.mass: [1]\n", 3, 13, "1 correlations");
    check_fault("fit:\n  arm.k2: [1]\n  arm.mass: [1, 1.5]\n", 3, 17, "of -1 to 1");
    check_fault("fit:\n  arm.k2: [1]\n  arm.mass: [1, 0.9]\n"
                "  arm.hub_inertia: [1, 0.9, -0.9]\n",
                2, 3, "no parameters have such correlations");
}
