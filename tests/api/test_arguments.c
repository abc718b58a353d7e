// Wrong arguments to libimpactlab: each call reports what is wrong and changes nothing.
#include "handles.h"

// --- missing arguments -----------------------------------------------------------------

// A call without the argument of that name is refused by its name, with an error and
// without.
#define LACKS(name, ...)                                                                 \
    do {                                                                                 \
        impactlab_error *error = &told;                                                  \
        check_refused(__VA_ARGS__, name);                                                \
        error = NULL;                                                                    \
        assert_int_equal(__VA_ARGS__, IMPACTLAB_BAD_ARGUMENT);                           \
    } while (0)

TEST_OF_HANDLES(scenarios_say_what_they_lack)
{
    impactlab_scenario *s = h->scenario, *made;
    char **names, *text, room[16];
    size_t count;
    double value;
    LACKS("names", impactlab_scenario_names(NULL, &count, error));
    LACKS("count", impactlab_scenario_names(&names, NULL, error));
    LACKS("scenario", impactlab_scenario_open(NULL, "x", error));
    LACKS("name_or_file", impactlab_scenario_open(&made, NULL, error));
    LACKS("scenario", impactlab_scenario_parse(NULL, "x", 1, error));
    LACKS("text", impactlab_scenario_parse(&made, NULL, 1, error));
    LACKS("scenario", impactlab_scenario_create(NULL, error));
    LACKS("scenario", impactlab_scenario_copy(NULL, s, error));
    LACKS("from", impactlab_scenario_copy(&made, NULL, error));
    assert_null(made);

    LACKS("scenario", impactlab_scenario_set(NULL, "arm.k2", "1", error));
    LACKS("path", impactlab_scenario_set(s, NULL, "1", error));
    LACKS("text", impactlab_scenario_set(s, "arm.k2", NULL, error));
    LACKS("scenario", impactlab_scenario_set_number(NULL, "arm.k2", 1, error));
    LACKS("path", impactlab_scenario_set_number(s, NULL, 1, error));
    LACKS("scenario", impactlab_scenario_set_all(NULL, NULL, 1, error));
    LACKS("assignments", impactlab_scenario_set_all(s, NULL, 1, error));

    LACKS("scenario", impactlab_scenario_number(NULL, "arm.k2", &value, error));
    LACKS("path", impactlab_scenario_number(s, NULL, &value, error));
    LACKS("value", impactlab_scenario_number(s, "arm.k2", NULL, error));
    LACKS("scenario", impactlab_scenario_text(NULL, "arm.k2", room, sizeof room, error));
    LACKS("path", impactlab_scenario_text(s, NULL, room, sizeof room, error));
    LACKS("text", impactlab_scenario_text(s, "arm.k2", NULL, 0, error));

    LACKS("scenario", impactlab_scenario_add_change(NULL, 0, "arm.k2", "1", error));
    LACKS("path", impactlab_scenario_add_change(s, 0, NULL, "1", error));
    LACKS("text", impactlab_scenario_add_change(s, 0, "arm.k2", NULL, error));
    LACKS("scenario", impactlab_scenario_add_push(NULL, 0, 1, error));
    LACKS("scenario", impactlab_scenario_yaml(NULL, &text, error));
    LACKS("yaml", impactlab_scenario_yaml(s, NULL, error));
}

TEST_OF_HANDLES(runs_say_what_they_lack)
{
    impactlab_run *made;
    impactlab_series series;
    impactlab_table table;
    impactlab_prediction said[4];
    char *text;
    double value;
    size_t count;
    LACKS("run", impactlab_run_create(NULL, h->scenario, 0, error));
    LACKS("scenario", impactlab_run_create(&made, NULL, 0, error));
    assert_null(made);
    LACKS("run", impactlab_run_quantity(NULL, "impacts", &value, error));
    LACKS("key", impactlab_run_quantity(h->run, NULL, &value, error));
    LACKS("value", impactlab_run_quantity(h->run, "impacts", NULL, error));
    LACKS("run", impactlab_run_signal(NULL, "force", &series, error));
    LACKS("name", impactlab_run_signal(h->run, NULL, &series, error));
    LACKS("series", impactlab_run_signal(h->run, "force", NULL, error));
    LACKS("run", impactlab_run_angles(NULL, &table, error));
    LACKS("table", impactlab_run_angles(h->run, NULL, error));
    LACKS("run", impactlab_run_velocities(NULL, &table, error));
    LACKS("table", impactlab_run_velocities(h->run, NULL, error));
    LACKS("run", impactlab_run_json(NULL, &text, error));
    LACKS("json", impactlab_run_json(h->run, NULL, error));
    LACKS("run", impactlab_run_csv(NULL, &text, error));
    LACKS("csv", impactlab_run_csv(h->run, NULL, error));
    LACKS("run", impactlab_run_predictions(NULL, said, 4, &count, error));
    LACKS("predictions", impactlab_run_predictions(h->run, NULL, 4, &count, error));
    LACKS("written", impactlab_run_predictions(h->run, said, 4, NULL, error));
    LACKS("run", impactlab_run_grid(NULL, 1, &value, 1, &count, error));
    LACKS("count", impactlab_run_grid(h->run, 1, &value, 1, NULL, error));
    LACKS("run", impactlab_run_save(NULL, &value, 1, error));
    LACKS("bytes", impactlab_run_save(h->run, NULL, 1, error));
    LACKS("run", impactlab_run_restore(NULL, h->scenario, &value, 1, error));
    LACKS("scenario", impactlab_run_restore(&made, NULL, &value, 1, error));
    LACKS("bytes", impactlab_run_restore(&made, h->scenario, NULL, 1, error));
    assert_null(made);
    LACKS("scenario", impactlab_modes(NULL, 0, 0, &value, NULL, 1, &count, error));
    LACKS("frequencies",
          impactlab_modes(h->scenario, 0, 0, NULL, NULL, 1, &count, error));
    LACKS("count", impactlab_modes(h->scenario, 0, 0, &value, NULL, 1, NULL, error));
}

TEST_OF_HANDLES(loops_say_what_they_lack)
{
    impactlab_loop *l = h->loop, *made;
    impactlab_run *run;
    impactlab_reading reading;
    impactlab_table table;
    double value;
    char bytes[1];
    LACKS("loop", impactlab_loop_create(NULL, h->scenario, 0, error));
    LACKS("scenario", impactlab_loop_create(&made, NULL, 0, error));
    assert_null(made);
    LACKS("loop", impactlab_loop_step(NULL, error));
    LACKS("loop", impactlab_loop_step_until(NULL, 1, error));
    LACKS("loop", impactlab_loop_command(NULL, 1, error));
    LACKS("loop", impactlab_loop_set_input(NULL, "motor.voltage", 1, error));
    LACKS("path", impactlab_loop_set_input(l, NULL, 1, error));
    LACKS("loop", impactlab_loop_set_text(NULL, "motor.voltage", "1", error));
    LACKS("path", impactlab_loop_set_text(l, NULL, "1", error));
    LACKS("text", impactlab_loop_set_text(l, "motor.voltage", NULL, error));
    LACKS("loop", impactlab_loop_push(NULL, 1, error));
    LACKS("loop", impactlab_loop_read_sensors(NULL, &reading, error));
    LACKS("reading", impactlab_loop_read_sensors(l, NULL, error));
    LACKS("loop", impactlab_loop_signal(NULL, "force", &value, error));
    LACKS("name", impactlab_loop_signal(l, NULL, &value, error));
    LACKS("value", impactlab_loop_signal(l, "force", NULL, error));
    LACKS("loop", impactlab_loop_state(NULL, &table, error));
    LACKS("table", impactlab_loop_state(l, NULL, error));
    LACKS("loop", impactlab_loop_run(NULL, &run, error));
    LACKS("run", impactlab_loop_run(l, NULL, error));
    LACKS("loop", impactlab_loop_save_state(NULL, bytes, 1, error));
    LACKS("bytes", impactlab_loop_save_state(l, NULL, 1, error));
    LACKS("loop", impactlab_loop_restore_state(NULL, bytes, 1, error));
    LACKS("bytes", impactlab_loop_restore_state(l, NULL, 1, error));
}

// What has no error to fill answers as if there were nothing.
TEST_OF_HANDLES(nothing_has_nothing)
{
    impactlab_event event;
    double value;
    assert_string_equal(impactlab_scenario_name(NULL), "");
    assert_string_equal(impactlab_scenario_title(NULL), "");
    assert_string_equal(impactlab_scenario_description(NULL), "");
    assert_int_equal(impactlab_scenario_is_set(NULL, "arm.k2"), 0);
    assert_int_equal(impactlab_freedoms(NULL), 0);
    assert_string_equal(impactlab_run_status(NULL), "failed");
    assert_string_equal(impactlab_run_message(NULL), "");
    assert_true(impactlab_run_quantities(NULL, &value, 1) > 10);
    assert_int_equal(impactlab_run_event_count(NULL), 0);
    assert_int_equal(impactlab_run_event(NULL, 0, &event), 0);
    assert_int_equal(impactlab_run_event(h->run, 0, NULL), 0);
    assert_int_equal(impactlab_loop_step(h->loop, NULL), IMPACTLAB_OK);
    assert_true(impactlab_loop_time(h->loop) > 0);
    assert_true(isnan(impactlab_loop_time(NULL)));
    assert_int_equal(impactlab_loop_ended(NULL), 1);
    assert_int_equal(impactlab_loop_state_size(NULL), 0);
    impactlab_scenario_allow_code(NULL, 1);
    impactlab_names_free(NULL, 3);
    impactlab_text_free(NULL);
}

// --- wrong arguments -------------------------------------------------------------------

TEST_OF_HANDLES(names_that_are_not_known)
{
    impactlab_series series;
    char room[16];
    double value;
    check_refused(impactlab_run_quantity(h->run, "peak_force", &value, &told),
                  "peak_force_N");
    check_refused(impactlab_run_quantity(h->run, "zzzzzzzzzzzz", &value, &told),
                  "no quantity");
    check_refused(impactlab_run_signal(h->run, "forse", &series, &told), "'force'");
    check_refused(impactlab_loop_signal(h->loop, "zzzzzzzzzzzz", &value, &told),
                  "no signal");
    check_refused(impactlab_loop_set_input(h->loop, "motor.volt", 1, &told),
                  "motor.voltage");
    check_refused(impactlab_loop_set_text(h->loop, "motor.volt", "1", &told),
                  "motor.voltage");
    check_refused(impactlab_scenario_number(h->scenario, "arm.k", &value, &told),
                  "arm.k");
    check_refused(impactlab_scenario_text(h->scenario, "arm.k", room, 16, &told),
                  "arm.k");
    check_refused(impactlab_scenario_set_number(h->scenario, "arm.k", 1, &told), "arm.k");
    check_refused(impactlab_scenario_add_change(h->scenario, 0, "motor.volt", "1", &told),
                  "motor.voltage");
    assert_int_equal(impactlab_scenario_is_set(h->scenario, "arm.k"), 0);

    // a text that is too long for its room is not cut
    strcpy(room, "untouched");
    check_refused(impactlab_scenario_text(h->scenario, "wall.kind", room, 3, &told), "3");
    assert_string_equal(room, "untouched");
}

TEST_OF_HANDLES(numbers_that_cannot_be)
{
    impactlab_scenario *s = h->scenario;
    const double nan = (double)NAN;
    check_refused(impactlab_loop_step_until(h->loop, nan, &told), "not finite");
    check_refused(impactlab_loop_command(h->loop, nan, &told), "not finite");
    check_refused(impactlab_loop_push(h->loop, nan, &told), "not finite");
    check_refused(impactlab_loop_set_input(h->loop, "wall.angle", nan, &told),
                  "wall.angle");
    check_refused(impactlab_loop_set_text(h->loop, "motor.voltage", "1 m", &told), "V");
    check_refused(impactlab_loop_set_text(h->loop, "arm.links", "4", &told), "arm.links");
    check_refused(impactlab_scenario_add_push(s, 0.1, nan, &told), "not finite");
    check_refused(impactlab_scenario_add_push(s, 0.4, 1, &told), "0.3 s");
    check_refused(impactlab_scenario_add_change(s, nan, "motor.voltage", "1", &told),
                  "instant");
    check_refused(impactlab_scenario_add_change(s, 0.1, "motor.voltage", "much", &told),
                  "motor.voltage");
    check_refused(impactlab_scenario_add_change(s, 0.1, "arm.links", "4", &told),
                  "arm.links");
    check_refused(impactlab_scenario_set_number(s, "arm.k2", -1, &told), "arm.k2");
    check_refused(impactlab_loop_set_input(h->loop, "arm.links", 4, &told), "arm.links");

    // none of it has left anything
    char *yaml;
    check_done(impactlab_scenario_yaml(s, &yaml, &told));
    assert_null(strstr(yaml, "\nscript:"));
    impactlab_text_free(yaml);
    assert_true(impactlab_loop_time(h->loop) == 0);
    check_done(impactlab_loop_step(h->loop, &told));
}

// What follows from another parameter does not change by itself, neither now nor later.
TEST_OF_HANDLES(what_follows_cannot_be_scripted)
{
    check_done(impactlab_scenario_set(h->scenario, "arm.hub_joint", "beam", &told));
    check_refused(impactlab_scenario_add_change(h->scenario, 0.1, "arm.k1", "90", &told),
                  "arm.hub_joint = spring");
    assert_string_equal(told.parameter, "arm.k1");
}

TEST_OF_HANDLES(sets_are_taken_whole_or_not)
{
    const char *const wrong[] = {"motor.voltage=3", "arm.k2=soft"};
    const char *const holed[] = {"motor.voltage=3", NULL, "arm.k2=5"};
    const char *const together[] = {"arm.links=4", "wall.kind=plane",
                                    "motor.voltage=3 V"};
    check_refused(impactlab_scenario_set_all(h->scenario, wrong, 2, &told), "arm.k2");
    check_refused(impactlab_scenario_set_all(h->scenario, holed, 3, &told),
                  "assignments[i]");
    assert_true(number_of(h->scenario, "motor.voltage") == 1);
    check_done(impactlab_scenario_set_all(h->scenario, together, 3, &told));
    check_done(impactlab_scenario_set_all(h->scenario, NULL, 0, &told));
    assert_true(number_of(h->scenario, "motor.voltage") == 3);
    assert_int_equal(impactlab_freedoms(h->scenario), 4);
}

static void push(void *memory, const controller_input *in, controller_output *out)
{
    (void)memory;
    (void)in;
    out->command = 1;
}

// The rig calls parts of a controller without asking again, so that one without them is
// refused.
TEST_OF_HANDLES(controllers_are_whole)
{
    static const char *const modes[] = {"push", NULL};
    const controller whole = {.interface = CONTROLLER_INTERFACE,
                              .name = "whole",
                              .modes = modes,
                              .memory_size = sizeof(void *),
                              .sample = push};
    controller lacking[7];
    for (size_t i = 0; i < COUNT(lacking); i++) {
        lacking[i] = whole;
    }
    lacking[0].interface++;
    lacking[1].name = NULL;
    lacking[2].modes = NULL;
    lacking[3].memory_size = 1;
    lacking[4].sample = NULL;
    lacking[5].parameter_count = -1;
    lacking[6].parameter_count = 1;

    impactlab_run *run;
    for (size_t i = 0; i < COUNT(lacking); i++) {
        check_refused(impactlab_run_create_with(&run, h->scenario, 0, &lacking[i], NULL,
                                                &told),
                      "the controller");
        assert_null(run);
    }
    check_done(impactlab_run_create_with(&run, h->scenario, 0, &whole, NULL, &told));
    impactlab_run_destroy(run);

    // one that wants all the memory there could be gets none, and not less than it asked
    // for
    controller greedy = whole;
    greedy.memory_size = SIZE_MAX;
    assert_int_equal(impactlab_run_create_with(&run, h->scenario, 0, &greedy, NULL,
                                               &told),
                     IMPACTLAB_NO_MEMORY);
    impactlab_run_destroy(run);

    // and one with a number of its own
    const controller_parameter gain = {.name = "gain",
                                       .unit = "",
                                       .initial = 1,
                                       .maximum = 2,
                                       .description = "of nothing"};
    controller numbered = whole;
    numbered.parameters = &gain;
    numbered.parameter_count = 1;
    check_done(impactlab_run_create_with(&run, h->scenario, 0, &numbered, NULL, &told));
    impactlab_run_destroy(run);
}

static int take(void *context, const impactlab_outcome *outcome)
{
    *(size_t *)context += outcome->status == IMPACTLAB_OK;
    return 0;
}

TEST_OF_HANDLES(batches_look_before_they_run)
{
    const char *const paths[] = {"motor.voltage"}, *const unknown[] = {"motor.volt"};
    const char *const none[] = {NULL};
    const double volts[] = {1, 2, 3};
    size_t taken = 0;
    impactlab_scenario *s = h->scenario;
    check_refused(impactlab_batch(NULL, paths, 1, volts, 3, 1, take, &taken, &told),
                  "scenario");
    check_refused(impactlab_batch(s, NULL, 1, volts, 3, 1, take, &taken, &told), "paths");
    check_refused(impactlab_batch(s, paths, 1, NULL, 3, 1, take, &taken, &told),
                  "values");
    check_refused(impactlab_batch(s, paths, 1, volts, 3, 1, NULL, &taken, &told), "take");
    check_refused(impactlab_batch(s, unknown, 1, volts, 3, 1, take, &taken, &told),
                  "motor.voltage");
    check_refused(impactlab_batch(s, none, 1, volts, 3, 1, take, &taken, &told),
                  "paths[i]");
    assert_int_equal(taken, 0);

    // on all processors, on far too many threads, and the same run several times
    check_done(impactlab_batch(s, paths, 1, volts, 3, 0, take, &taken, &told));
    check_done(impactlab_batch(s, paths, 1, volts, 3, 1000000, take, &taken, &told));
    check_done(impactlab_batch(s, NULL, 0, NULL, 2, 1, take, &taken, &told));
    check_done(impactlab_batch(s, paths, 1, NULL, 0, 1, take, &taken, &told));
    assert_int_equal(taken, 8);

    // an impossible value is reported before any run
    const char *const two[] = {"arm.k2", "motor.voltage"};
    const double values[] = {5, 1, -5, 1};
    check_refused(impactlab_batch(s, two, 2, values, 2, 1, take, &taken, &told),
                  "arm.k2");
    assert_int_equal(taken, 8);
}

TEST_OF_HANDLES(states_of_others_are_refused)
{
    const size_t size = impactlab_loop_state_size(h->loop);
    SCOPED(free_kept) void *bytes = malloc(size);
    check_refused(impactlab_loop_save_state(h->loop, bytes, size - 1, &told), "room");
    check_done(impactlab_loop_save_state(h->loop, bytes, size, &told));
    check_done(impactlab_scenario_set(h->scenario, "motor.voltage", "2", &told));
    own_loop *other = loop_of(h->scenario, IMPACTLAB_COMMAND);
    check_refused(impactlab_loop_restore_state(other, bytes, size, &told),
                  "another scenario");

    // one with a script that sets a number or a text, likewise
    check_done(
        impactlab_scenario_add_change(h->scenario, 0.1, "motor.voltage", "1", &told));
    own_loop *changed = loop_of(h->scenario, IMPACTLAB_COMMAND);
    check_done(impactlab_scenario_add_push(h->scenario, 0.1, 1e-3, &told));
    own_loop *scripted = loop_of(h->scenario, IMPACTLAB_COMMAND);
    check_done(impactlab_loop_save_state(changed, bytes, size, &told));
    check_refused(impactlab_loop_restore_state(scripted, bytes, size, &told),
                  "another scenario");
}

// A caller who passes no fault gets the same status, on success and on failure.
TEST_OF_HANDLES(an_error_may_be_left_out)
{
    static const char *const wrong[] = {"arm.k2=stiff", "motor.voltage=high"};
    static const char *const right[] = {"arm.k2=5", "motor.voltage=1"};
    const char text[] = "title: t\narm: {k2: stiff}\n";
    impactlab_scenario *made = NULL;
    char *yaml = NULL;
    double value = 0;
    assert_int_equal(impactlab_scenario_open(&made, "no such scenario", NULL),
                     IMPACTLAB_BAD_ARGUMENT);
    assert_int_equal(impactlab_scenario_parse(&made, text, strlen(text), NULL),
                     IMPACTLAB_BAD_SCENARIO);
    assert_null(made);
    assert_int_not_equal(impactlab_scenario_set_all(h->scenario, wrong, COUNT(wrong),
                                                    NULL),
                         IMPACTLAB_OK);
    assert_int_equal(impactlab_scenario_set_all(h->scenario, right, COUNT(right), NULL),
                     IMPACTLAB_OK);
    assert_int_equal(impactlab_scenario_set(h->scenario, "arm.k2", "6", NULL),
                     IMPACTLAB_OK);
    assert_int_equal(impactlab_scenario_number(h->scenario, "arm.k2", &value, NULL),
                     IMPACTLAB_OK);
    assert_true(value == 6);
    assert_int_equal(impactlab_scenario_yaml(h->scenario, &yaml, NULL), IMPACTLAB_OK);
    impactlab_text_free(yaml);
    assert_int_equal(impactlab_run_quantity(h->run, "impacts", &value, NULL),
                     IMPACTLAB_OK);
    assert_int_equal(impactlab_run_quantity(h->run, "no such", &value, NULL),
                     IMPACTLAB_BAD_ARGUMENT);
}
