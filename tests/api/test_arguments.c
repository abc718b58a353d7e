// What callers of libimpactlab may get wrong: each call says what it lacks and changes nothing.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <impactlab/controller.h>
#include <impactlab/impactlab.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

// Handles of each kind, and what calls write to.
typedef struct handles {
    impactlab_error error;
    impactlab_scenario *scenario;
    impactlab_run *run;
    impactlab_loop *loop; // commanded
} handles;

static void check_done(int status, const impactlab_error *error)
{
    if (status != IMPACTLAB_OK) {
        fail_msg("status %d: %s", status, error->sentence);
    }
}

static int make_handles(void **state)
{
    handles *h = calloc(1, sizeof *h);
    check_done(impactlab_scenario_open(&h->scenario, "corrected/first-impact", &h->error),
               &h->error);
    check_done(impactlab_scenario_set(h->scenario, "run.duration", "0.3", &h->error), &h->error);
    check_done(impactlab_run_create(&h->run, h->scenario, IMPACTLAB_KEEP_ROWS, &h->error),
               &h->error);
    check_done(impactlab_loop_create(&h->loop, h->scenario, IMPACTLAB_COMMAND, &h->error),
               &h->error);
    *state = h;
    return 0;
}

static int free_handles(void **state)
{
    handles *h = *state;
    impactlab_loop_destroy(h->loop);
    impactlab_run_destroy(h->run);
    impactlab_scenario_destroy(h->scenario);
    free(h);
    return 0;
}

// A call that must be refused with a sentence that has the words.
static void check_refused(const handles *h, int status, const char *words)
{
    if (status == IMPACTLAB_OK || h->error.status != status ||
        strstr(h->error.sentence, words) == NULL) {
        fail_msg("status %d, %d: '%s' has no '%s'", status, h->error.status, h->error.sentence,
                 words);
    }
}

// --- missing arguments ------------------------------------------------------------------------

// A call without the argument of that name is refused by its name, with an error and without.
#define LACKS(name, ...)                                                                           \
    do {                                                                                           \
        impactlab_error *error = &h->error;                                                        \
        check_refused(h, __VA_ARGS__, name);                                                       \
        error = NULL;                                                                              \
        assert_int_equal(__VA_ARGS__, IMPACTLAB_BAD_ARGUMENT);                                     \
    } while (0)

static void scenarios_say_what_they_lack(void **state)
{
    handles *h = *state;
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

static void runs_say_what_they_lack(void **state)
{
    handles *h = *state;
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
    LACKS("scenario", impactlab_modes(NULL, 0, 0, &value, NULL, 1, &count, error));
    LACKS("frequencies", impactlab_modes(h->scenario, 0, 0, NULL, NULL, 1, &count, error));
    LACKS("count", impactlab_modes(h->scenario, 0, 0, &value, NULL, 1, NULL, error));
}

static void loops_say_what_they_lack(void **state)
{
    handles *h = *state;
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
static void nothing_has_nothing(void **state)
{
    (void)state;
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
    assert_true(isnan(impactlab_loop_time(NULL)));
    assert_int_equal(impactlab_loop_ended(NULL), 1);
    assert_int_equal(impactlab_loop_state_size(NULL), 0);
    impactlab_scenario_allow_code(NULL, 1);
    impactlab_names_free(NULL, 3);
    impactlab_text_free(NULL);
}

// --- wrong arguments --------------------------------------------------------------------------

static void names_that_are_not_known(void **state)
{
    handles *h = *state;
    impactlab_error *error = &h->error;
    impactlab_series series;
    char room[16];
    double value;
    check_refused(h, impactlab_run_quantity(h->run, "peak_force", &value, error), "peak_force_N");
    check_refused(h, impactlab_run_quantity(h->run, "zzzzzzzzzzzz", &value, error), "no quantity");
    check_refused(h, impactlab_run_signal(h->run, "forse", &series, error), "'force'");
    check_refused(h, impactlab_loop_signal(h->loop, "zzzzzzzzzzzz", &value, error), "no signal");
    check_refused(h, impactlab_loop_set_input(h->loop, "motor.volt", 1, error), "motor.voltage");
    check_refused(h, impactlab_loop_set_text(h->loop, "motor.volt", "1", error), "motor.voltage");
    check_refused(h, impactlab_scenario_number(h->scenario, "arm.k", &value, error), "arm.k");
    check_refused(h, impactlab_scenario_text(h->scenario, "arm.k", room, 16, error), "arm.k");
    check_refused(h, impactlab_scenario_set_number(h->scenario, "arm.k", 1, error), "arm.k");
    check_refused(h, impactlab_scenario_add_change(h->scenario, 0, "motor.volt", "1", error),
                  "motor.voltage");
    assert_int_equal(impactlab_scenario_is_set(h->scenario, "arm.k"), 0);

    // a text that is too long for its room is not cut
    strcpy(room, "untouched");
    check_refused(h, impactlab_scenario_text(h->scenario, "wall.kind", room, 3, error), "3");
    assert_string_equal(room, "untouched");
}

static void numbers_that_cannot_be(void **state)
{
    handles *h = *state;
    impactlab_error *error = &h->error;
    impactlab_scenario *s = h->scenario;
    const double nan = (double)NAN;
    check_refused(h, impactlab_loop_step_until(h->loop, nan, error), "not finite");
    check_refused(h, impactlab_loop_command(h->loop, nan, error), "not finite");
    check_refused(h, impactlab_loop_push(h->loop, nan, error), "not finite");
    check_refused(h, impactlab_loop_set_input(h->loop, "wall.angle", nan, error), "wall.angle");
    check_refused(h, impactlab_loop_set_text(h->loop, "motor.voltage", "1 m", error), "V");
    check_refused(h, impactlab_loop_set_text(h->loop, "arm.links", "4", error), "arm.links");
    check_refused(h, impactlab_scenario_add_push(s, 0.1, nan, error), "not finite");
    check_refused(h, impactlab_scenario_add_push(s, 0.4, 1, error), "0.3 s");
    check_refused(h, impactlab_scenario_add_change(s, nan, "motor.voltage", "1", error), "instant");
    check_refused(h, impactlab_scenario_add_change(s, 0.1, "motor.voltage", "much", error),
                  "motor.voltage");
    check_refused(h, impactlab_scenario_add_change(s, 0.1, "arm.links", "4", error), "arm.links");
    check_refused(h, impactlab_loop_set_input(h->loop, "arm.links", 4, error), "arm.links");

    // none of it has left anything
    char *yaml;
    check_done(impactlab_scenario_yaml(s, &yaml, error), error);
    assert_null(strstr(yaml, "\nscript:"));
    impactlab_text_free(yaml);
    assert_true(impactlab_loop_time(h->loop) == 0);
    check_done(impactlab_loop_step(h->loop, error), error);
}

static void sets_are_taken_whole_or_not(void **state)
{
    handles *h = *state;
    const char *const wrong[] = {"motor.voltage=3", "arm.k2=soft"};
    const char *const holed[] = {"motor.voltage=3", NULL};
    const char *const together[] = {"arm.links=4", "wall.kind=plane", "motor.voltage=3 V"};
    double value;
    check_refused(h, impactlab_scenario_set_all(h->scenario, wrong, 2, &h->error), "arm.k2");
    check_refused(h, impactlab_scenario_set_all(h->scenario, holed, 2, &h->error),
                  "assignments[i]");
    check_done(impactlab_scenario_number(h->scenario, "motor.voltage", &value, &h->error),
               &h->error);
    assert_true(value == 1);
    check_done(impactlab_scenario_set_all(h->scenario, together, 3, &h->error), &h->error);
    check_done(impactlab_scenario_set_all(h->scenario, NULL, 0, &h->error), &h->error);
    check_done(impactlab_scenario_number(h->scenario, "motor.voltage", &value, &h->error),
               &h->error);
    assert_true(value == 3);
    assert_int_equal(impactlab_freedoms(h->scenario), 4);
}

static void push(void *memory, const controller_input *in, controller_output *out)
{
    (void)memory;
    (void)in;
    out->command = 1;
}

// The rig calls parts of a controller without asking again, so that one without them is refused.
static void controllers_are_whole(void **state)
{
    handles *h = *state;
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
        check_refused(h,
                      impactlab_run_create_with(&run, h->scenario, 0, &lacking[i], NULL, &h->error),
                      "the controller");
        assert_null(run);
    }
    check_done(impactlab_run_create_with(&run, h->scenario, 0, &whole, NULL, &h->error), &h->error);
    impactlab_run_destroy(run);
}

static int take(void *context, const impactlab_outcome *outcome)
{
    *(size_t *)context += outcome->status == IMPACTLAB_OK;
    return 0;
}

static void batches_look_before_they_run(void **state)
{
    handles *h = *state;
    impactlab_error *error = &h->error;
    const char *const paths[] = {"motor.voltage"}, *const unknown[] = {"motor.volt"};
    const char *const none[] = {NULL};
    const double volts[] = {1, 2, 3};
    size_t taken = 0;
    impactlab_scenario *s = h->scenario;
    check_refused(h, impactlab_batch(NULL, paths, 1, volts, 3, 1, take, &taken, error), "scenario");
    check_refused(h, impactlab_batch(s, NULL, 1, volts, 3, 1, take, &taken, error), "paths");
    check_refused(h, impactlab_batch(s, paths, 1, NULL, 3, 1, take, &taken, error), "values");
    check_refused(h, impactlab_batch(s, paths, 1, volts, 3, 1, NULL, &taken, error), "take");
    check_refused(h, impactlab_batch(s, unknown, 1, volts, 3, 1, take, &taken, error),
                  "motor.voltage");
    check_refused(h, impactlab_batch(s, none, 1, volts, 3, 1, take, &taken, error), "paths[i]");
    assert_int_equal(taken, 0);

    // on all processors, on far too many threads, and the same run several times
    check_done(impactlab_batch(s, paths, 1, volts, 3, 0, take, &taken, error), error);
    check_done(impactlab_batch(s, paths, 1, volts, 3, 1000000, take, &taken, error), error);
    check_done(impactlab_batch(s, NULL, 0, NULL, 2, 1, take, &taken, error), error);
    check_done(impactlab_batch(s, paths, 1, NULL, 0, 1, take, &taken, error), error);
    assert_int_equal(taken, 8);
}

static void states_of_others_are_refused(void **state)
{
    handles *h = *state;
    impactlab_loop *other;
    const size_t size = impactlab_loop_state_size(h->loop);
    void *bytes = malloc(size);
    check_refused(h, impactlab_loop_save_state(h->loop, bytes, size - 1, &h->error), "room");
    check_done(impactlab_loop_save_state(h->loop, bytes, size, &h->error), &h->error);
    check_done(impactlab_scenario_set(h->scenario, "motor.voltage", "2", &h->error), &h->error);
    check_done(impactlab_loop_create(&other, h->scenario, IMPACTLAB_COMMAND, &h->error), &h->error);
    check_refused(h, impactlab_loop_restore_state(other, bytes, size, &h->error),
                  "another scenario");
    impactlab_loop_destroy(other);

    // one with a script that sets a number or a text, likewise
    impactlab_loop *scripted;
    check_done(impactlab_scenario_add_change(h->scenario, 0.1, "motor.voltage", "1", &h->error),
               &h->error);
    check_done(impactlab_loop_create(&other, h->scenario, IMPACTLAB_COMMAND, &h->error), &h->error);
    check_done(impactlab_scenario_add_push(h->scenario, 0.1, 1e-3, &h->error), &h->error);
    check_done(impactlab_loop_create(&scripted, h->scenario, IMPACTLAB_COMMAND, &h->error),
               &h->error);
    check_done(impactlab_loop_save_state(other, bytes, size, &h->error), &h->error);
    check_refused(h, impactlab_loop_restore_state(scripted, bytes, size, &h->error),
                  "another scenario");
    impactlab_loop_destroy(other);
    impactlab_loop_destroy(scripted);
    free(bytes);
}

// --- what is there ----------------------------------------------------------------------------

static void codes_have_texts(void **state)
{
    (void)state;
    assert_string_equal(impactlab_status_text(IMPACTLAB_OK), "done");
    assert_string_equal(impactlab_status_text(IMPACTLAB_NO_MEMORY), "out of memory");
    assert_string_equal(impactlab_status_text(-1), impactlab_status_text(10000));
    assert_string_not_equal(impactlab_status_text(-1), "");
    for (int code = IMPACTLAB_OK; code <= IMPACTLAB_NOT_ALLOWED; code++) {
        for (int other = IMPACTLAB_OK; other < code; other++) {
            assert_string_not_equal(impactlab_status_text(code), impactlab_status_text(other));
        }
    }
}

// Every row of the tables is whole, and the tables are those that names are looked up in.
static void tables_are_whole(void **state)
{
    handles *h = *state;
    size_t rows = 0, timed = 0;
    double value;
    for (const impactlab_parameter *p; (p = impactlab_parameter_at(rows)) != NULL; rows++) {
        check_done(impactlab_scenario_number(h->scenario, p->path, &value, &h->error), &h->error);
        assert_true(p->description[0] != '\0' && p->minimum <= p->maximum);
        assert_int_equal(strcmp(p->type, "choice") == 0, p->choices[0] != '\0');
        timed += p->timed != 0;
    }
    assert_true(rows > 100 && timed > 10 && timed < rows);

    // the same for signals and quantities
    size_t quantities = 0;
    for (rows = 0; impactlab_signal_at(rows) != NULL; rows++) {
        impactlab_series series;
        const char *name = impactlab_signal_at(rows)->name;
        check_done(impactlab_run_signal(h->run, name, &series, &h->error), &h->error);
        assert_true(series.count > 0);
    }
    double all[100];
    const size_t known = impactlab_run_quantities(h->run, all, COUNT(all));
    for (; impactlab_quantity_at(quantities) != NULL; quantities++) {
        const char *key = impactlab_quantity_at(quantities)->key;
        check_done(impactlab_run_quantity(h->run, key, &value, &h->error), &h->error);
        assert_memory_equal(&value, &all[quantities], sizeof value);
    }
    assert_int_equal(quantities, known);
    assert_true(strspn(impactlab_version(), "0123456789.") == strlen(impactlab_version()));
}

static void names_copies_and_defaults(void **state)
{
    handles *h = *state;
    impactlab_scenario *copy, *made;
    char **names;
    size_t count, found = 0;
    double value;
    check_done(impactlab_scenario_names(&names, &count, &h->error), &h->error);
    for (size_t i = 0; i < count; i++) {
        found += strcmp(names[i], "corrected/first-impact") == 0;
        assert_true(i == 0 || strcmp(names[i - 1], names[i]) != 0);
    }
    assert_int_equal(found, 1);
    impactlab_names_free(names, count);

    // a copy goes its own way, as does what is made of defaults
    check_done(impactlab_scenario_copy(&copy, h->scenario, &h->error), &h->error);
    check_done(impactlab_scenario_set_number(copy, "motor.voltage", 7, &h->error), &h->error);
    check_done(impactlab_scenario_number(h->scenario, "motor.voltage", &value, &h->error),
               &h->error);
    assert_true(value == 1);
    assert_string_equal(impactlab_scenario_name(copy), "corrected/first-impact");
    assert_string_equal(impactlab_scenario_title(copy), impactlab_scenario_title(h->scenario));
    assert_string_not_equal(impactlab_scenario_description(copy), "");
    check_done(impactlab_scenario_create(&made, &h->error), &h->error);
    assert_int_equal(impactlab_scenario_is_set(made, "motor.voltage"), 0);
    impactlab_scenario_destroy(copy);
    impactlab_scenario_destroy(made);
}

// What a run has only where it is asked for, or where it came to pass.
static void runs_have_what_was_asked_for(void **state)
{
    handles *h = *state;
    impactlab_run *bare, *free_run;
    impactlab_series series;
    impactlab_table angles, velocities;
    impactlab_prediction said[2];
    size_t count;
    check_done(impactlab_run_create(&bare, h->scenario, 0, &h->error), &h->error);
    check_done(impactlab_run_signal(bare, "force", &series, &h->error), &h->error);
    assert_int_equal(series.count, 0);
    check_refused(h, impactlab_run_predictions(bare, said, 2, &count, &h->error), "KEEP_ROWS");
    assert_string_equal(impactlab_run_status(bare), "ok");
    assert_string_equal(impactlab_run_message(bare), "");
    impactlab_run_destroy(bare);

    // angles and velocities lie beside each other, the hub's first
    check_done(impactlab_run_angles(h->run, &angles, &h->error), &h->error);
    check_done(impactlab_run_velocities(h->run, &velocities, &h->error), &h->error);
    check_done(impactlab_run_signal(h->run, "hub_velocity", &series, &h->error), &h->error);
    assert_true(angles.rows == velocities.rows && angles.columns == velocities.columns);
    assert_true(velocities.values[(angles.rows - 1) * angles.columns] ==
                *(const double *)(const void *)((const char *)series.values +
                                                (series.count - 1) * series.stride));

    // fewer predictions than there are; none without a contact
    check_done(impactlab_run_predictions(h->run, said, 2, &count, &h->error), &h->error);
    assert_int_equal(count, 2);
    check_done(impactlab_scenario_set(h->scenario, "wall.kind", "none", &h->error), &h->error);
    check_done(impactlab_run_create(&free_run, h->scenario, IMPACTLAB_KEEP_ROWS, &h->error),
               &h->error);
    check_refused(h, impactlab_run_predictions(free_run, said, 2, &count, &h->error),
                  "did not touch");
    impactlab_run_destroy(free_run);
}

// The printed equations have no modes, and a run that fails has what it came to.
static void what_there_is_not(void **state)
{
    handles *h = *state;
    impactlab_run *failed;
    double frequency;
    size_t count;
    check_done(impactlab_modes(h->scenario, 1, 0, &frequency, NULL, 1, &count, &h->error),
               &h->error);
    assert_true(count == 1 && frequency > 0);
    check_done(impactlab_scenario_set(h->scenario, "control.command", "true", &h->error),
               &h->error);
    check_done(impactlab_scenario_set(h->scenario, "control.law", "process", &h->error), &h->error);
    assert_int_equal(impactlab_run_create(&failed, h->scenario, IMPACTLAB_KEEP_ROWS, &h->error),
                     IMPACTLAB_NOT_ALLOWED);
    assert_non_null(failed);
    assert_string_equal(impactlab_run_status(failed), "failed");
    assert_string_equal(impactlab_run_message(failed), h->error.sentence);
    impactlab_run_destroy(failed);

    check_done(impactlab_scenario_set(h->scenario, "control.law", "none", &h->error), &h->error);
    check_done(impactlab_scenario_set(h->scenario, "arm.model", "printed", &h->error), &h->error);
    assert_int_equal(impactlab_freedoms(h->scenario), 0);
    check_refused(h, impactlab_modes(h->scenario, 0, 0, &frequency, NULL, 1, &count, &h->error),
                  "natural frequencies");
    check_refused(h, impactlab_scenario_add_push(h->scenario, 0.1, 1e-3, &h->error), "pushes");
}

// What stopped a loop stays, whatever is asked of it next; a law that cannot be had makes none.
static void loops_stay_stopped(void **state)
{
    handles *h = *state;
    impactlab_error first;
    impactlab_loop *loop;
    impactlab_run *run;
    check_done(impactlab_scenario_set(h->scenario, "control.command", "true", &h->error),
               &h->error);
    check_done(impactlab_scenario_set(h->scenario, "control.law", "process", &h->error), &h->error);
    check_done(impactlab_loop_create(&loop, h->scenario, 0, &h->error), &h->error);
    assert_int_equal(impactlab_loop_step(loop, &first), IMPACTLAB_NOT_ALLOWED);
    check_refused(h, impactlab_loop_step_until(loop, 1, &h->error), first.sentence);
    check_refused(h, impactlab_loop_set_input(loop, "motor.voltage", 1, &h->error), first.sentence);
    check_refused(h, impactlab_loop_push(loop, 1, &h->error), first.sentence);
    check_done(impactlab_loop_run(loop, &run, &h->error), &h->error);
    assert_string_equal(impactlab_run_status(run), "failed");
    impactlab_run_destroy(run);
    impactlab_loop_destroy(loop);

    check_done(impactlab_scenario_set(h->scenario, "control.plugin", "./none.so", &h->error),
               &h->error);
    check_done(impactlab_scenario_set(h->scenario, "control.law", "plugin", &h->error), &h->error);
    impactlab_scenario_allow_code(h->scenario, 1);
    check_refused(h, impactlab_loop_create(&loop, h->scenario, 0, &h->error), "none.so");
    assert_null(loop);
}

#define TEST(test) cmocka_unit_test_setup_teardown(test, make_handles, free_handles)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(scenarios_say_what_they_lack),
        TEST(runs_say_what_they_lack),
        TEST(loops_say_what_they_lack),
        TEST(nothing_has_nothing),
        TEST(names_that_are_not_known),
        TEST(numbers_that_cannot_be),
        TEST(sets_are_taken_whole_or_not),
        TEST(controllers_are_whole),
        TEST(batches_look_before_they_run),
        TEST(states_of_others_are_refused),
        TEST(codes_have_texts),
        TEST(tables_are_whole),
        TEST(names_copies_and_defaults),
        TEST(runs_have_what_was_asked_for),
        TEST(what_there_is_not),
        TEST(loops_stay_stopped),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
