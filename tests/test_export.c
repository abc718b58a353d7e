#include "src/run/export.h"

#include "tests/shipped_scenario.h"

static scenario parse(const char *text)
{
    scenario s;
    assert_int_equal(scenario_parse(&s, text, strlen(text), "t.yaml", NULL, fail_on_fault,
                                    NULL),
                     STATUS_OK);
    return s;
}

// A result as a run that was stopped would leave it.
static run_result stopped_result(void)
{
    run_result result = {0};
    summary_init(&result.summary);
    result.summary.status = STATUS_NEWTON_FAILED;
    strcpy(result.summary.message, "stopped");
    result.summary.first_contact_s = 0.25;
    result.summary.impacts = 1;
    trace_init(&result.trace, 3);
    trace_add_event(&result.trace, (event){0.1, EVENT_CHANGE, 0, 0, 0, 0});
    trace_add_event(&result.trace, (event){0.25, EVENT_IMPACT, 0.5, 0.75, 0.125, -1});
    trace_add_event(&result.trace, (event){0.25, EVENT_CONTACT, 0, 0, 0, -1});
    return result;
}

TEST(object_holds_every_key)
{
    KEPT_SCENARIO(s) =
        parse("title: T\narm: {links: 3}\nwall: {kind: plane}\n"
              "expect:\n  impacts: {value: 1, tolerance: 0}\n  peak_force_N: null\n"
              "  first_contact_s: {value: 0.3, tolerance: 0.01}\n"
              "script:\n  - {at: 0.1 s, set: {motor.voltage: 2 V}}\n");
    KEPT_RUN(result) = stopped_result();
    json_t *object = export_run(&s, &result);
    assert_string_equal(json_string_value(json_object_get(object, "scenario")), "t.yaml");
    assert_string_equal(json_string_value(json_object_get(object, "status")), "failed");
    assert_string_equal(json_string_value(json_object_get(object, "message")), "stopped");
    assert_non_null(json_object_get(object, "version"));
    for (int i = 0; i < summary_count; i++) {
        assert_non_null(json_object_get(object, summary_table[i].key));
    }
    // what did not occur is null, what did is a number
    assert_true(json_is_null(json_object_get(object, "peak_force_N")));
    check_close(json_number_value(json_object_get(object, "first_contact_s")), 0.25, 0);

    // every parameter, each in its own type
    json_t *p = json_object_get(object, "parameters");
    assert_int_equal(json_object_size(p), parameter_count);
    check_close(json_number_value(json_object_get(p, "arm.links")), 3, 0);
    assert_string_equal(json_string_value(json_object_get(p, "wall.kind")), "plane");
    assert_true(json_is_boolean(json_object_get(p, "printed.force_at_link_end")));

    json_t *events = json_object_get(object, "events");
    assert_int_equal(json_array_size(events), 3);
    json_t *change = json_array_get(events, 0), *impact = json_array_get(events, 1);
    assert_string_equal(json_string_value(json_object_get(change, "parameter")),
                        "motor.voltage");
    check_close(json_number_value(json_object_get(change, "value")), 2, 0);
    check_close(json_number_value(json_object_get(impact, "speed_m_s")), 0.75, 0);
    check_close(json_number_value(json_object_get(impact, "loss_J")), 0.125, 0);
    assert_null(json_object_get(json_array_get(events, 2), "impulse_Ns"));

    // expectations: met, met by not occurring, not met
    json_t *expected = json_object_get(object, "expectations");
    assert_int_equal(json_array_size(expected), 3);
    for (size_t i = 0; i < 3; i++) {
        json_t *e = json_array_get(expected, i);
        const char *quantity = json_string_value(json_object_get(e, "quantity"));
        assert_int_equal(json_is_true(json_object_get(e, "met")),
                         strcmp(quantity, "first_contact_s") != 0);
    }
    json_decref(object);
}

// A change of a word is told as the word; one whose place in the script is not known as
// an event alone.
TEST(changes_are_told_as_they_were_written)
{
    KEPT_SCENARIO(s) = parse("title: T\ncontrol: {law: hybrid}\n"
                             "script:\n  - {at: 0.1 s, set: {control.lock: force}}\n");
    KEPT_RUN(result) = stopped_result();
    trace_add_event(&result.trace, (event){0.3, EVENT_CHANGE, 0, 0, 0, 7});
    trace_add_event(&result.trace, (event){0.4, EVENT_CHANGE, 0, 0, 0, -1});
    json_t *object = export_run(&s, &result), *events = json_object_get(object, "events");
    json_t *change = json_array_get(events, 0);
    assert_string_equal(json_string_value(json_object_get(change, "parameter")),
                        "control.lock");
    assert_string_equal(json_string_value(json_object_get(change, "value")), "force");
    for (size_t i = 3; i < 5; i++) {
        assert_non_null(json_array_get(events, i));
        assert_null(json_object_get(json_array_get(events, i), "parameter"));
    }
    json_decref(object);
}

// What a missed expectation says, one sentence after the other.
static void keep_sentences(void *context, const char *sentence)
{
    strcat(context, sentence);
    strcat(context, "\n");
}

TEST(missed_expectations_say_what_is_and_what_was_expected)
{
    char said[1024] = "";
    KEPT_SCENARIO(s) = parse("title: T\nexpect:\n"
                             "  impacts: null\n"
                             "  peak_force_N: {value: 2, tolerance: 0.5}\n"
                             "  first_contact_s: {value: 0.25, tolerance: 0.01}\n");
    KEPT_RUN(result) = stopped_result();
    assert_int_equal(run_check_expectations(&s, &result, keep_sentences, said), 2);
    assert_string_equal(
        said, "t.yaml:3:3: impacts is 1, expected null\n"
              "t.yaml:4:3: peak_force_N is nothing (null), expected 2 within 0.5\n");
}

// CSV of two rows with three angles each, of a scenario.
static char *csv_of(const char *told, double film)
{
    KEPT_SCENARIO(s) = parse(told);
    SCOPED(trace_finish) trace t;
    trace_init(&t, 3);
    for (int i = 0; i < 2; i++) {
        sample row = {.time = 0.1 * i, .force = 2.5, .film = film};
        double angles[] = {0.1, 0.2, 0.3};
        assert_int_equal(trace_add_row(&t, &row, angles, angles), STATUS_OK);
    }
    WRITTEN(text, export_csv(stream, &s, &t));
    return text;
}

static int count_of(const char *text, char wanted)
{
    int count = 0;
    for (; *text != '\0' && *text != '\n'; text++) {
        count += *text == wanted;
    }
    return count;
}

TEST(csv_has_one_header_and_a_column_for_each_value)
{
    for (int links = 2; links <= 3; links++) {
        KEPT_TEXT(text) =
            csv_of(links == 2 ? "arm: {links: 2}\n" : "arm: {links: 3}\n", (double)NAN);
        int columns = (links > 2 ? 3 : 0);
        for (int i = 0; i < signal_count; i++) {
            columns += signal_table[i].needs == 0; // the run has nothing more
        }
        assert_int_equal(strncmp(text, "time[s],hub_angle[rad],", 23), 0);
        assert_int_equal(strstr(text, ",angle_3[rad]\n") != NULL, links > 2);
        char *line = text;
        for (int i = 0; i < 3; i++) {
            assert_int_equal(count_of(line, ',') + 1, columns);
            line = strchr(line, '\n') + 1;
        }
        assert_int_equal(*line, '\0');
    }
}

TEST(csv_has_columns_of_fitted_sensors_only)
{
    KEPT_TEXT(without) = csv_of("arm: {links: 2}\n", -0.125),
    *with = csv_of("sensor: {film: true}\n", -0.125);
    assert_null(strstr(without, "film[rad]"));
    assert_non_null(strstr(with, ",film[rad],"));
    assert_non_null(strstr(with, ",-0.125,"));
    assert_null(strstr(with, "piezo_force"));
    assert_null(strstr(with, "accelerometer"));
    assert_int_equal(count_of(with, ','), count_of(without, ',') + 1);
}

// What a scenario's JSON names of values without effect, with a blank behind each.
static void check_idle(const char *text, const char *expected)
{
    char paths[512] = "";
    KEPT_SCENARIO(s) = parse(text);
    json_t *all = export_without_effect(&s);
    for (size_t i = 0; i < json_array_size(all); i++) {
        const json_t *one = json_array_get(all, i);
        const char *path = json_string_value(json_object_get(one, "path"));
        snprintf(paths + strlen(paths), sizeof paths - strlen(paths), "%s ", path);
        assert_true(strlen(json_string_value(json_object_get(one, "why"))) > 5);
    }
    json_decref(all);
    fail_if(strcmp(paths, expected) != 0, "%s: %s, expected %s", text, paths, expected);
}

TEST(values_without_effect_are_named)
{
    check_idle("motor: {voltage: 2 V}\n", "");
    check_idle("wall: {stiffness: 1000 N/m}\narm: {k1: 10}\n", "arm.k1 wall.stiffness ");
    check_idle("wall: {stiffness: 1000 N/m, contact: kelvin-voigt}\n", "");
    check_idle("control: {law: hybrid}\nmotor: {voltage: 5 V}\n", "motor.voltage ");
    check_idle("control: {law: open-loop, kp: 5, approach_voltage: 2 V}\nbelief: "
               "{k2_factor: 2}\n",
               "control.kp belief.k2_factor ");

    // a bound is none, reached or not
    check_idle("motor: {voltage_limit: 9 V, current_limit: 5 A}\n", "");

    // a script can let a value act, take it away before it does, or give one in vain
    check_idle("control: {law: hybrid}\nsensor: {ideal: true, fsr_noise: 0.1 V}\n",
               "sensor.fsr_noise ");
    check_idle("control: {law: hybrid}\nsensor: {ideal: true, fsr_noise: 0.1 V}\n"
               "script:\n  - {at: 0.5 s, set: {sensor.ideal: false}}\n",
               "");
    check_idle("control: {law: hybrid}\nsensor: {ideal: true, fsr_noise: 0.1 V}\n"
               "script:\n  - {at: 0.4 s, set: {sensor.fsr_noise: 0.2 V}}\n"
               "  - {at: 0.5 s, set: {sensor.ideal: false}}\n",
               "sensor.fsr_noise ");
    check_idle("control: {law: hybrid, force_rate: 5 N/s}\n", "control.force_rate ");
    check_idle("control: {law: hybrid, force_rate: 5 N/s}\n"
               "script:\n  - {at: 0.5 s, set: {control.force: 2 N}}\n",
               "");
    check_idle("script:\n  - {at: 0.5 s, set: {arm.k1: 20}}\n", "arm.k1 ");
}
