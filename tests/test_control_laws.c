// The list of control laws: a law's name, word, controller and line of the manual belong
// together.
#include "src/rig/controller_values.h"
#include "src/rig/external/process_lines.h"
#include "src/rig/rig.h"
#include "tests/rig_fixture.h"

TEST(every_word_chooses_the_controller_of_that_name)
{
    for (int law = LAW_NONE; law < LAW_COUNT; law++) {
        parameters p = fresh(ARM_CORRECTED);
        const char *word = control_law_table[law].word;
        give(&p, "control.law", word);
        assert_int_equal(p.control.law, law);
        const controller *c = controller_of(law);
        assert_true((c == NULL) ==
                    (law == LAW_NONE || law == LAW_PLUGIN || law == LAW_PROCESS));
        if (c != NULL) {
            assert_string_equal(c->name, word);
        }
    }
}

TEST(parameters_of_the_scenario_are_described_there_alone)
{
    for (int law = LAW_NONE + 1; law < LAW_PLUGIN; law++) {
        const controller *c = controller_of(law);
        for (int i = 0; i < c->parameter_count; i++) {
            const char *path = formatted("control.%s", c->parameters[i].name);
            assert_int_equal(controller_find_parameter(c, c->parameters[i].name), i);
            assert_int_equal(controller_find_parameter(c, path), -1);
            int index = parameter_find(path);
            if (index < 0) {
                // one of the law's own, from control.settings
                assert_true(c->parameters[i].unit != NULL &&
                            c->parameters[i].description != NULL);
                continue;
            }
            fail_if(c->parameters[i].unit != NULL || c->parameters[i].initial != 0,
                    "%s describes %s, which the parameter table does", c->name, path);
            controller_parameter known = controller_parameter_at(c, i);
            assert_string_equal(known.unit, parameter_table[index].unit);
            check_close(known.initial, parameter_table[index].default_corrected, 0);
        }
    }
}

// The value of the hybrid law's parameter `index` in its table, under settings of the
// scenario.
static double value_of(int index, const char *const *settings)
{
    double values[16];
    parameters p = rig_parameters(settings);
    DONE(controller_values(controller_of(LAW_HYBRID), &p, values, &f));
    return values[index];
}

TEST(settings_go_before_the_scenario_and_that_before_the_default)
{
    const controller *law = controller_of(LAW_HYBRID);
    int kp = 0;
    while (strcmp(law->parameters[kp].name, "kp") != 0) {
        kp++;
    }
    double initial = parameter_table[PARAMETER_INDEX(control.kp)].default_corrected;
    check_close(value_of(kp, given("control.law=hybrid")), initial, 0);
    check_close(value_of(kp, given("control.law=hybrid control.kp=3")), 3, 0);
    check_close(value_of(kp,
                         given("control.law=hybrid control.kp=3 control.settings=kp=4")),
                4, 0);
}

TEST(initial_values_of_ones_own_parameters_take_effect)
{
    const controller_parameter table[] = {{"kp", "", 7, 0, 10, "own initial value"},
                                          {"calm", "s", 0.5, 0, 1,
                                           "of this controller alone"},
                                          {.name = "kv"}};
    const controller own = {.name = "own", .parameters = table, .parameter_count = 3};
    double values[3];
    parameters p = rig_parameters(NULL);
    DONE(controller_values(&own, &p, values, &f));
    check_close(values[0], 7, 0);
    check_close(values[1], 0.5, 0);
    check_close(values[2], parameter_table[PARAMETER_INDEX(control.kv)].default_corrected,
                0);
    p = rig_parameters_with("control.kp=2");
    DONE(controller_values(&own, &p, values, &f));
    check_close(values[0], 2, 0);

    // with a unit or a sentence it is the controller's own, for any name
    const controller_parameter parts[] = {
        {.name = "kp", .unit = "1/s", .initial = 5, .maximum = 6},
        {.name = "kv", .description = "own", .initial = 3, .minimum = 1, .maximum = 4},
        {.name = "kp"}};
    const controller partly = {.name = "partly",
                               .parameters = parts,
                               .parameter_count = 3};
    const parameter_info *info = &parameter_table[PARAMETER_INDEX(control.kp)];
    p = rig_parameters(NULL);
    DONE(controller_values(&partly, &p, values, &f));
    check_close(values[0], 5, 0);
    check_close(values[1], 3, 0);
    check_close(values[2], info->default_corrected, 0);
    for (int i = 0; i < 2; i++) {
        const controller_parameter told = controller_parameter_at(&partly, i);
        assert_memory_equal(&told, &parts[i], sizeof told);
    }
    const controller_parameter told = controller_parameter_at(&partly, 2);
    assert_string_equal(told.name, "kp");
    assert_ptr_equal(told.unit, info->unit);
    assert_ptr_equal(told.description, info->description);
    check_close(told.initial, info->default_corrected, 0);
    check_close(told.minimum, info->minimum, 0);
    check_close(told.maximum, info->maximum, 0);

    const controller_parameter unknown[] = {{.name = "nothing"}};
    const controller vague = {.name = "vague",
                              .parameters = unknown,
                              .parameter_count = 1};
    REFUSED(STATUS_BAD_SCENARIO, "", controller_values(&vague, &p, values, &f));
}

// A setting that is none says which one and what was expected; of a name the nearest.
TEST(wrong_settings_are_told)
{
    const controller_parameter table[] = {{"kp", "1/s", 7, 0, 10, "with a unit"},
                                          {"calm", "", 0.5, 0, 1, "without one"},
                                          {"bare", NULL, 0.5, 0, 1,
                                           "with nothing said of it"}};
    const controller own = {.name = "own", .parameters = table, .parameter_count = 3};
    static const struct {
        const char *settings, *sentence;
    } cases[] = {
        {"kq=4", "no parameter 'kq', did you mean 'kp'?"},
        {"unheardof=4", "the controller 'own' has no parameter 'unheardof'"},
        {"calm=1 kp", "'kp' is wrong, expected kp=NUMBER from 0 to 10 1/s"},
        {"kp=4x", "'kp=4x' is wrong"},
        {"kp=", "'kp=' is wrong"},
        {"kp=-1", "'kp=-1' is wrong"},
        {"kp=11 calm=1", "'kp=11' is wrong"},
        {"calm=2", "'calm=2' is wrong, expected calm=NUMBER from 0 to 1"},
        {"bare=2", "'bare=2' is wrong, expected bare=NUMBER from 0 to 1"},
    };
    for (EACH(c, cases)) {
        double values[3];
        fault f = {.text = ""};
        parameters p = rig_parameters(NULL);
        strcpy(p.control.settings, c->settings);
        assert_int_equal(controller_values(&own, &p, values, &f), STATUS_BAD_SCENARIO);
        fail_if(strstr(f.text, c->sentence) == NULL, "'%s': '%s'", c->settings, f.text);
    }

    // without a controller with parameters there is no name to suggest
    const controller none = {.name = "none"};
    double values[1];
    fault f = {.text = ""};
    parameters p = rig_parameters(NULL);
    strcpy(p.control.settings, "kp=1");
    assert_int_equal(controller_values(&none, &p, values, &f), STATUS_BAD_SCENARIO);
    assert_null(strstr(f.text, "did you mean"));
}

// --- a controller in a program of its own ----------------------------------------------

// It hears its settings as numbers where they are numbers, else as texts.
TEST(settings_are_told_as_numbers_or_texts)
{
    parameters p = rig_parameters(NULL);
    strcpy(p.control.settings, "gain=2.5 way=fast mixed=3x bare");
    const controller_setup setup = {.period = 0.005};
    const controller_input in = {.time = 0.25, .piezo_force = (double)NAN};
    KEPT_TEXT(first) = process_question(&setup, &p.control, &in);
    KEPT_TEXT(later) = process_question(NULL, &p.control, &in);
    assert_true(first != NULL && later != NULL);
    assert_non_null(
        strstr(first, "\"gain\":2.5,\"way\":\"fast\",\"mixed\":\"3x\",\"bare\":\"\""));
    assert_non_null(strstr(first, "\"protocol\":"));
    assert_null(strstr(later, "settings"));
    assert_int_equal(first[strlen(first) - 1], '\n');
}

// An answer is an object with a command; what else it names has to be a number or null.
TEST(answers_are_numbers)
{
    static const struct {
        const char *line;
        status answer;
    } cases[] = {
        {"{\"command\": 1.5}", STATUS_OK},
        {"{\"command\": 1.5, \"desired_angle\": 2, \"calculated_force\": null}",
         STATUS_OK},
        {"{\"command\": \"1.5\"}", STATUS_CONTROLLER_FAILED},
        {"{\"command\": null}", STATUS_CONTROLLER_FAILED},
        {"{}", STATUS_CONTROLLER_FAILED},
        {"[1.5]", STATUS_CONTROLLER_FAILED},
        {"1.5", STATUS_CONTROLLER_FAILED},
        {"{\"command\": 1.5", STATUS_CONTROLLER_FAILED},
        {"{\"command\": 1.5, \"desired_angle\": true}", STATUS_CONTROLLER_FAILED},
        {"{\"command\": 1.5, \"desired_velocity\": []}", STATUS_CONTROLLER_FAILED},
        {"{\"command\": 1.5, \"calculated_force\": \"2\"}", STATUS_CONTROLLER_FAILED},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        controller_output out = {0};
        const char *line = cases[i].line;
        fail_if(process_read_answer(line, strlen(line), &out) != cases[i].answer, "%s",
                line);
        if (cases[i].answer == STATUS_OK) {
            check_close(out.command, 1.5, 0);
            assert_true(isnan(out.desired_velocity) && isnan(out.calculated_force));
            assert_true(i == 0 ? isnan(out.desired_angle) : out.desired_angle == 2);
        }
    }
}
