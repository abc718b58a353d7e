// Contents of the handles of libimpactlab, and queries for what they do not contain.
#include "handles.h"

TEST_OF_HANDLES(codes_have_texts)
{
    assert_string_equal(impactlab_status_text(IMPACTLAB_OK), "done");
    assert_string_equal(impactlab_status_text(IMPACTLAB_NO_MEMORY), "out of memory");
    assert_string_equal(impactlab_status_text(-1), impactlab_status_text(10000));
    assert_string_not_equal(impactlab_status_text(-1), "");
    for (int code = IMPACTLAB_OK; code <= IMPACTLAB_IMPOSSIBLE_MEAN; code++) {
        for (int other = IMPACTLAB_OK; other < code; other++) {
            assert_string_not_equal(impactlab_status_text(code),
                                    impactlab_status_text(other));
        }
    }
}

// Every row of the tables is whole, and the tables are those that names are looked up in.
TEST_OF_HANDLES(tables_are_whole)
{
    size_t rows = 0, timed = 0;
    double value;
    for (const impactlab_parameter *p; (p = impactlab_parameter_at(rows)) != NULL;
         rows++) {
        value = number_of(h->scenario, p->path);
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
        check_done(impactlab_run_signal(h->run, name, &series, &told));
        assert_true(series.count > 0);
    }
    double all[100];
    const size_t known = impactlab_run_quantities(h->run, all, COUNT(all));
    for (; impactlab_quantity_at(quantities) != NULL; quantities++) {
        const char *key = impactlab_quantity_at(quantities)->key;
        value = quantity_of(h->run, key);
        assert_memory_equal(&value, &all[quantities], sizeof value);
    }
    assert_int_equal(quantities, known);
    assert_true(strspn(impactlab_version(), "0123456789.") ==
                strlen(impactlab_version()));
}

TEST_OF_HANDLES(names_copies_and_defaults)
{
    own_scenario *copy, *made;
    char **names;
    size_t count, found = 0;
    check_done(impactlab_scenario_names(&names, &count, &told));
    for (size_t i = 0; i < count; i++) {
        found += strcmp(names[i], "corrected/first-impact") == 0;
        assert_true(i == 0 || strcmp(names[i - 1], names[i]) != 0);
    }
    assert_int_equal(found, 1);
    impactlab_names_free(names, count);

    // a copy goes its own way, as does what is made of defaults
    check_done(impactlab_scenario_copy(&copy, h->scenario, &told));
    check_done(impactlab_scenario_set_number(copy, "motor.voltage", 7, &told));
    assert_true(number_of(h->scenario, "motor.voltage") == 1);
    assert_string_equal(impactlab_scenario_name(copy), "corrected/first-impact");

    // its title says where it differs
    assert_non_null(strstr(impactlab_scenario_title(copy), ", with motor.voltage = 7 V"));
    assert_null(strstr(impactlab_scenario_title(h->scenario), "motor.voltage"));
    assert_string_not_equal(impactlab_scenario_description(copy), "");
    check_done(impactlab_scenario_create(&made, &told));
    assert_int_equal(impactlab_scenario_is_set(made, "motor.voltage"), 0);
}

// What a run has only where it is asked for, or where it came to pass.
TEST_OF_HANDLES(runs_have_what_was_asked_for)
{
    impactlab_series series;
    impactlab_table angles, velocities;
    impactlab_prediction said[2];
    size_t count;
    own_run *bare = run_of(h->scenario, 0);
    check_done(impactlab_run_signal(bare, "force", &series, &told));
    assert_int_equal(series.count, 0);
    check_refused(impactlab_run_predictions(bare, said, 2, &count, &told), "KEEP_ROWS");
    assert_string_equal(impactlab_run_status(bare), "ok");
    assert_string_equal(impactlab_run_message(bare), "");

    // angles and velocities are stored next to each other, the hub's first
    check_done(impactlab_run_angles(h->run, &angles, &told));
    check_done(impactlab_run_velocities(h->run, &velocities, &told));
    check_done(impactlab_run_signal(h->run, "hub_velocity", &series, &told));
    assert_true(angles.rows == velocities.rows && angles.columns == velocities.columns);
    assert_true(velocities.values[(angles.rows - 1) * angles.columns] ==
                *(const double *)(const void *)((const char *)series.values +
                                                (series.count - 1) * series.stride));

    // fewer predictions than there are; none without a contact
    check_done(impactlab_run_predictions(h->run, said, 2, &count, &told));
    assert_int_equal(count, 2);
    check_done(impactlab_scenario_set(h->scenario, "wall.kind", "none", &told));
    own_run *free_run = run_of(h->scenario, IMPACTLAB_KEEP_ROWS);
    check_refused(impactlab_run_predictions(free_run, said, 2, &count, &told),
                  "did not touch");
}

// The printed equations have no modes, and a run that fails has what it came to.
TEST_OF_HANDLES(what_there_is_not)
{
    impactlab_run *failed;
    double frequency;
    size_t count;
    check_done(impactlab_modes(h->scenario, 1, 0, &frequency, NULL, 1, &count, &told));
    assert_true(count == 1 && frequency > 0);
    check_done(impactlab_scenario_set(h->scenario, "control.command", "true", &told));
    check_done(impactlab_scenario_set(h->scenario, "control.law", "process", &told));
    assert_int_equal(impactlab_run_create(&failed, h->scenario, IMPACTLAB_KEEP_ROWS,
                                          &told),
                     IMPACTLAB_NOT_ALLOWED);
    assert_non_null(failed);
    assert_string_equal(impactlab_run_status(failed), "failed");
    assert_string_equal(impactlab_run_message(failed), told.sentence);
    impactlab_run_destroy(failed);

    check_done(impactlab_scenario_set(h->scenario, "control.law", "none", &told));
    check_done(impactlab_scenario_set(h->scenario, "arm.model", "printed", &told));
    assert_int_equal(impactlab_freedoms(h->scenario), 0);
    check_refused(impactlab_modes(h->scenario, 0, 0, &frequency, NULL, 1, &count, &told),
                  "natural frequencies");
    check_refused(impactlab_scenario_add_push(h->scenario, 0.1, 1e-3, &told), "pushes");
}

// The reason why a loop stopped is kept for all later calls; a law that is not available
// gives no loop.
TEST_OF_HANDLES(loops_stay_stopped)
{
    impactlab_error first;
    impactlab_run *run;
    check_done(impactlab_scenario_set(h->scenario, "control.command", "true", &told));
    check_done(impactlab_scenario_set(h->scenario, "control.law", "process", &told));
    impactlab_loop *loop = loop_of(h->scenario, 0);
    assert_int_equal(impactlab_loop_step(loop, &first), IMPACTLAB_NOT_ALLOWED);
    check_refused(impactlab_loop_step_until(loop, 1, &told), first.sentence);
    check_refused(impactlab_loop_set_input(loop, "motor.voltage", 1, &told),
                  first.sentence);
    check_refused(impactlab_loop_push(loop, 1, &told), first.sentence);
    check_done(impactlab_loop_run(loop, &run, &told));
    assert_string_equal(impactlab_run_status(run), "failed");
    impactlab_run_destroy(run);
    impactlab_loop_destroy(loop);

    check_done(impactlab_scenario_set(h->scenario, "control.plugin", "./none.so", &told));
    check_done(impactlab_scenario_set(h->scenario, "control.law", "plugin", &told));
    impactlab_scenario_allow_code(h->scenario, 1);
    check_refused(impactlab_loop_create(&loop, h->scenario, 0, &told), "none.so");
    assert_null(loop);
}
