// Panes and lessons of scenario files: the place and sentence of everything that is none.
#include "src/tables/summary.h"
#include "tests/scenario_fixture.h"

TEST(faults_of_panes)
{
    check_fault("panes: force\n", 1, 8,
                "panes is a single value, expected a list of signals");
    check_fault("panes: [force, forse]\n", 1, 16, "no signal 'forse'");
    check_fault("panes: [[force]]\n", 1, 9, "no signal 'a list'");
    const char *many = "panes: [force";
    for (int i = 0; i < SCENARIO_PANES; i++) {
        many = formatted("%s, gap", many);
    }
    scenario s;
    sentences all;
    assert_int_equal(parse(&s, formatted("%s]\n", many), &all), STATUS_BAD_SCENARIO);
    assert_int_equal(all.count, 1);
    assert_non_null(strstr(all.text, "more than"));
}

// A step of a lesson with this fault, and what its sentence says.
static void check_step(const char *step, const char *what)
{
    scenario s;
    sentences all;
    const char *text = formatted("lesson: {steps: [%s]}\n", step);
    const status code = parse(&s, text, &all);
    fail_if(code != STATUS_BAD_SCENARIO || all.count != 1 ||
                strstr(all.text, what) == NULL,
            "%s: %d faults, expected one about '%s':\n%s", text, all.count, what,
            all.text);
}

TEST(faults_of_lessons)
{
    KEPT_SCENARIO(s) =
        good("lesson: {steps: [{say: a, choice: {of: [a, b], right: 2}}]}\n");
    assert_int_equal(s.lesson.steps[0].right, 1);

    // the first of all parameters is one like the others
    KEPT_SCENARIO(first) =
        good("lesson: {steps: [{say: a, value: {arm.model: printed}}]}\n");
    assert_int_equal(first.lesson.steps[0].parameter, parameter_find("arm.model"));
    check_close(first.lesson.steps[0].value, ARM_PRINTED, 0);

    // the lesson as a whole
    check_fault("lesson: [a]\n", 1, 9, "lesson is a list");
    check_fault("lesson: {steps: []}\n", 1, 9, "no steps");
    check_fault("lesson: {parameters: [arm.k2]}\n", 1, 9, "no steps");
    check_fault("lesson: {steps: {say: a}}\n", 1, 9, "no steps");
    check_fault("lesson: {steps: [{say: a}], parameters: [motor.volts]}\n", 1, 41,
                "motor.volt");
    check_fault("lesson: {steps: [{say: a}], parameters: arm.k2}\n", 1, 41,
                "expected a list");
    check_fault("lesson: {steps: [{say: a}], parameters: [arm.k2, arm.k1, arm.EI, "
                "arm.mass, arm.length, arm.links, arm.model]}\n",
                1, 99, "more than 6");

    // its steps
    check_step("a", "a step is a single value");
    check_step("{hint: a}", "no 'say'");
    check_step("{say: [a]}", "say is a list, expected text");
    check_step("{say: ''}", "say is empty, expected text");
    check_step("{say: ' '}", "expected text");
    check_step("{say: a, saw: b}", "unknown key 'saw'");

    // a key that nobody reads is none of a check's or of the lesson's
    check_fault("lesson: {steps: [{say: a}], paramters: [arm.k2]}\n", 1, 29,
                "unknown key 'paramters'");
    check_step("{say: a, number: {quantity: impacts, within: 0, wihtin: 1}}",
               "unknown key 'wihtin'");
    check_step("{say: a, cursor: {at: first_contact_s, ofset: 1, within: 0.1}}",
               "unknown key 'ofset'");
    check_step("{say: a, choice: {of: [a, b], right: 1, wrong: 2}}",
               "unknown key 'wrong'");
    check_step("{say: a, ratio: {quantity: impacts, from: 0, to: 1, form: 2}}",
               "unknown key 'form'");
    check_step("{say: a, ratio: {quantity: impacts, from: 0, to: 1, from to: 2}}",
               "unknown key 'from to'");

    // nor is a step one that nothing can do
    check_step("{say: a, number: {quantity: impacts, within: -0.1}}",
               "within = -0.1, expected at least 0");
    check_step("{say: a, cursor: {at: first_contact_s, within: -1}}",
               "within = -1, expected at least 0");
    check_step("{say: a, ratio: {quantity: impacts, from: 2, to: 1}}",
               "to = 1, expected at least 2");
    check_step("{say: a, do: seek}", "do is a single value, expected a list");
    check_step("{say: a, do: [a, b, c, d, e, f, g, h, i]}", "more than 8");

    // and what has to be so before one is done
    check_step("{say: a, number: 3}", "expected");
    check_step("{say: a, number: {quantity: peek, within: 1}}", "no quantity of a run");
    check_step("{say: a, number: {within: 1}}", "no quantity of a run");
    check_step("{say: a, number: {quantity: [peak_force_N], within: 1}}",
               "no quantity of a run");
    check_step("{say: a, number: {quantity: peak_force_N}}", "no 'within'");
    check_step("{say: a, cursor: {at: first_contact_s}}", "no 'within'");
    check_step("{say: a, ratio: {quantity: peak_force_N, from: 1}}", "no 'to'");
    check_step("{say: a, choice: {right: 1}}", "no 'of'");
    check_step("{say: a, choice: {of: [], right: 1}}", "no 'of'");
    check_step("{say: a, choice: {of: a, right: 1}}",
               "of is a single value, expected a list");
    check_step("{say: a, choice: {of: [a, b]}}", "no 'right'");
    check_step("{say: a, choice: {of: [a, b], right: 3}}", "from 1 to 2");
    check_step("{say: a, choice: {of: [a, b], right: 1.5}}", "number of an answer");
    check_step("{say: a, choice: {of: [a, b], right: 1e300}}", "number of an answer");
    check_step("{say: a, choice: {of: [a, b], right: first}}", "not a finite number");
    check_step("{say: a, value: {motor.volts: 1}}", "motor.volt");
    check_step("{say: a, value: {motor.voltage: much}}", "not a number");
    check_step("{say: a, value: {motor.voltage: [1]}}", "list");
    check_step("{say: a, value: {control.settings: a=1}}", "one value");
    check_step("{say: a, value: {motor.voltage: 1, arm.k2: 5}}", "one parameter");
    check_step("{say: a, value: {}}", "one parameter");
    check_step("{say: a, value: {[motor.voltage]: 1}}", "the key is a list");
    check_step("{say: a, pinned: 1, value: {motor.voltage: 1}}", "second check");
    check_step("{say: a, pinned: 0}", "from 1 to 7");
    check_step("{say: a, pinned: 1e300}", "from 1 to 7");
    check_step("{say: a, pinned: [1]}", "expected a number");
}

// A key that is no word is said; what its value would have been is missing then.
TEST(keys_of_a_check_are_words)
{
    scenario s;
    sentences all;
    const char *text =
        "lesson: {steps: [{say: a, number: {[quantity]: peak_force_N, within: 1}}]}\n";
    assert_int_equal(parse(&s, text, &all), STATUS_BAD_SCENARIO);
    assert_non_null(strstr(all.text, "the key is a list, expected a word"));
    assert_non_null(strstr(all.text, "no quantity of a run"));
}

// Every field of every kind of step, and what is left out.
TEST(everything_of_a_lesson_is_read)
{
    KEPT_SCENARIO(s) = good(
        "lesson:\n"
        "  parameters: [arm.k2, motor.voltage, arm.k1, arm.EI, arm.mass, arm.model]\n"
        "  steps:\n"
        "    - {say: one, then: a, hint: b, do: [1, 2, 3, 4, 5, 6, 7, 8]}\n"
        "    - {say: two, number: {quantity: peak_force_N, within: 0.05}}\n"
        "    - {say: three, cursor: {at: first_contact_s, within: 0.01}}\n"
        "    - {say: four, cursor: {at: settling_time_s, offset: -0.2, within: 0.02}}\n"
        "    - {say: five, ratio: {quantity: impacts, from: 0.5, to: 0.75}}\n"
        "    - {say: six, pinned: 1}\n"
        "    - {say: seven, pinned: 7}\n"
        "    - {say: eight, value: {motor.voltage: 1.5}}\n"
        "    - {say: nine, choice: {of: [a, b, c, d, e, f], right: 1}}\n"
        "    - {say: ten, choice: {of: [a, b, c, d, e, f], right: 6}}\n"
        "    - say: >\n"
        "        eleven\n"
        "        words\n");
    static const lesson_check checks[] = {LESSON_READ,   LESSON_NUMBER, LESSON_CURSOR,
                                          LESSON_CURSOR, LESSON_RATIO,  LESSON_PINNED,
                                          LESSON_PINNED, LESSON_VALUE,  LESSON_CHOICE,
                                          LESSON_CHOICE, LESSON_READ};
    static const char *const says[] = {"one",  "two", "three",       "four",
                                       "five", "six", "seven",       "eight",
                                       "nine", "ten", "eleven words"};
    static const char *const paths[] = {"arm.k2", "motor.voltage", "arm.k1",
                                        "arm.EI", "arm.mass",      "arm.model"};
    const lesson *l = &s.lesson;
    assert_int_equal(l->parameter_count, 6);
    for (int i = 0; i < 6; i++) {
        assert_int_equal(l->parameters[i], parameter_find(paths[i]));
    }
    assert_int_equal(l->step_count, 11);
    for (int i = 0; i < 11; i++) {
        const lesson_step *step = &l->steps[i];
        assert_string_equal(step->say, says[i]);
        assert_int_equal(step->check, checks[i]);
        assert_string_equal(step->then, i == 0 ? "a" : "");
        assert_string_equal(step->hint, i == 0 ? "b" : "");
        assert_int_equal(step->command_count, i == 0 ? 8 : 0);
        check_close(step->within,
                    i == 1   ? 0.05
                    : i == 2 ? 0.01
                    : i == 3 ? 0.02
                    : i == 7 ? 0.001
                             : 0,
                    0);
        check_close(step->offset, i == 3 ? -0.2 : 0, 0);
        check_close(step->low, i == 4 ? 0.5 : 0, 0);
        check_close(step->high, i == 4 ? 0.75 : 0, 0);
        assert_int_equal(step->pinned, i == 5 ? 1 : i == 6 ? 7 : 0);
        assert_int_equal(step->choice_count, i == 8 || i == 9 ? 6 : 0);
        assert_int_equal(step->right, i == 9 ? 5 : 0);
        const char *quantity = i == 1   ? "peak_force_N"
                               : i == 2 ? "first_contact_s"
                               : i == 3 ? "settling_time_s"
                               : i == 4 ? "impacts"
                                        : NULL;
        assert_int_equal(step->quantity, quantity != NULL ? summary_find(quantity) : 0);
        for (int k = 0; k < step->command_count; k++) {
            const char number[2] = {(char)('1' + k), '\0'};
            assert_string_equal(step->commands[k], number);
        }
        for (int k = 0; k < step->choice_count; k++) {
            const char answer[2] = {(char)('a' + k), '\0'};
            assert_string_equal(step->choices[k], answer);
        }
    }
    assert_int_equal(l->steps[7].parameter, parameter_find("motor.voltage"));
    check_close(l->steps[7].value, 1.5, 0);

    // one beyond each limit, or below it
    check_step("{say: a, pinned: 8}", "from 1 to 7");
    check_step("{say: a, pinned: 1.5}", "from 1 to 7");
    check_step("{say: a, choice: {of: [a, b], right: 0}}", "from 1 to 2");
    check_step("{say: a, choice: {of: [a, b, c, d, e, f, g], right: 1}}", "more than 6");

    // sentences stand where the fault is
    check_fault("lesson: {steps: [{say: a, pinned: 8}]}\n", 1, 35, "pinned = 8");
    check_fault("lesson: {steps: [{say: a}, {hint: a}]}\n", 1, 28, "no 'say'");
    check_fault("lesson: {steps: [{say: a, ratio: {quantity: impacts, to: 1}}]}\n", 1, 34,
                "no 'from'");
    check_fault("lesson: {steps: [{say: a, number: {quantity: peek, within: 1}}]}\n", 1,
                46, "no quantity");
    check_fault("lesson: {steps: [{say: a}], parameters: [arm.k2, arm.kk]}\n", 1, 41,
                "arm.kk");
}
