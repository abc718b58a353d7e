// The runs of a sweep and their store.
#include "src/engines/pair/taylor_lanes.h"
#include "src/study/sweep_definition.h"
#include "tests/sweep_fixture.h"

TEST(every_run_is_what_the_scenario_gives_alone)
{
    SWEPT(s, SWEEP_GRID, 0, "motor.voltage=0.5:2:4", NULL);
    KEPT_STORE(store) = must_open(NULL, &s);
    must_run(&s, store, 2);
    double peaks[4], contacts[4];
    DONE(sweep_store_quantity(store, (sweep_share){0}, "peak_force_N", peaks, NULL, &f));
    DONE(sweep_store_quantity(store, (sweep_share){0}, "first_contact_s", contacts, NULL,
                              &f));
    for (int run = 0; run < 4; run++) {
        scenario alone = base;
        alone.parameters.motor.voltage = 0.5 + 0.5 * run;
        KEPT_RUN(result) = run_done(&alone, false);
        check_close(peaks[run], result.summary.peak_force_N, 0);
        check_close(contacts[run], result.summary.first_contact_s, 0);
    }
    // a higher voltage brings the arm to the wall earlier
    check_below(contacts[3], contacts[0]);
}

TEST(the_number_of_jobs_does_not_change_a_byte)
{
    SWEPT(s, SWEEP_LATIN, 60, "motor.voltage=0.5:5", "arm.links=1:4");
    KEPT_TEXT(one) = uninterrupted(&s, 1), *two = uninterrupted(&s, 2),
    *many = uninterrupted(&s, 7);
    assert_string_equal(one, two);
    assert_string_equal(one, many);
    static const char header[] = "run[],motor.voltage[V],arm.links[],status[],message[],"
                                 "first_contact[s],contact_impulse[N "
                                 "s],";
    assert_int_equal(strncmp(one, header, sizeof header - 1), 0);
    assert_non_null(strstr(one, "peak_force[N]"));
    assert_null(strstr(one, "wall_time"));
}

// A row says which of its values changes nothing; a sweep of which all act has no such
// column.
TEST(idle_rows_say_so)
{
    SWEPT(s, SWEEP_GRID, 0, "wall.stiffness=1000,2000",
          "wall.contact=rigid,kelvin-voigt");
    KEPT_STORE(store) = must_open(NULL, &s);
    must_run(&s, store, 1);
    KEPT_TEXT(csv) = csv_of(store);
    assert_non_null(strstr(csv, ",without_effect[]\n1,"));
    const char *first = strstr(csv, "wall.stiffness\n2,");
    const char *third = strstr(csv, "wall.stiffness\n4,");
    assert_true(first != NULL && third != NULL);
    assert_non_null(strstr(first, ",\n3,"));

    WRITTEN(json, DONE(sweep_store_write(store, stream, true, &f)));
    KEPT_TEXT(kept) = json;
    const char *told = strstr(json, "\"without_effect\"");
    assert_non_null(told);
    assert_non_null(told = strstr(told + 1, "\"without_effect\""));
    assert_null(strstr(told + 1, "\"without_effect\""));

    SWEPT(acting, SWEEP_GRID, 0, "motor.voltage=1,2", "arm.k2=5,6");
    KEPT_TEXT(all) = uninterrupted(&acting, 1);
    assert_null(strstr(all, "without_effect"));
}

// Runs of two links go side by side in the processor's vectors: with one lane, with all
// of them, on one thread and on several, and where some of the runs are there already.
TEST(the_number_of_lanes_does_not_change_a_byte)
{
    SWEPT(s, SWEEP_LATIN, 201, "motor.voltage=0.5:5", "wall.restitution=0:1");
    taylor_limit_width(1);
    KEPT_TEXT(alone) = uninterrupted(&s, 1);
    taylor_limit_width(0);
    for (int jobs = 1; jobs <= 3; jobs++) {
        KEPT_TEXT(together) = uninterrupted(&s, jobs);
        assert_string_equal(together, alone);
    }

    // every third run first, the rest around them
    KEPT_STORE(store) = must_open(NULL, &s);
    sweep_progress progress;
    const sweep_options third = {.jobs = 2, .share = {.part = 2, .parts = 3}};
    DONE(sweep_run(&s, store, &third, &progress, &f));
    assert_int_equal(progress.done_now, 67);
    must_run(&s, store, 2);
    KEPT_TEXT(csv) = csv_of(store);
    assert_string_equal(csv, alone);
}

static void assert_refused(const char *path, const sweep *s, status code,
                           const char *says)
{
    sweep_store *store;
    fault f = {0};
    assert_int_equal(sweep_store_open(&store, path, s, &f), code);
    assert_null(store);
    fail_if(strstr(f.text, says) == NULL || strstr(f.text, path) == NULL,
            "'%s' does not say '%s' of '%s'", f.text, says, path);
}

TEST(another_sweep_is_refused_with_the_difference)
{
    sweep s, other;
    must_sweep(&s, SWEEP_GRID, 0, "motor.voltage=1:2:3", NULL);
    sweep_store_close(must_open("one.sqlite", &s));
    must_sweep(&other, SWEEP_GRID, 0, "motor.voltage=1:2:4", NULL);
    assert_refused("one.sqlite", &other, STATUS_BAD_ARGUMENT,
                   "--vary 1 was motor.voltage=1:2:3, now it is motor.voltage=1:2:4");
    sweep_finish(&other);
    must_sweep(&other, SWEEP_RANDOM, 3, "motor.voltage=1:2:3", NULL);
    assert_refused("one.sqlite", &other, STATUS_BAD_ARGUMENT,
                   "sample was grid, now it is random");
    sweep_finish(&other);
    scenario changed = base;
    DONE(scenario_override(&changed, "arm.k2=5", &f));
    other = s;
    other.base = &changed;
    assert_refused("one.sqlite", &other, STATUS_BAD_ARGUMENT,
                   "arm.k2 was 4.92, now it is 5");
    // the same one in other words is the same
    must_sweep(&other, SWEEP_GRID, 0, "motor.voltage=1.0 V:2.0:3", NULL);
    sweep_store_close(must_open("one.sqlite", &other));
    sweep_finish(&other);
    sweep_finish(&s);
    unlink("one.sqlite");
}

// A script belongs to what is swept, and an empty text is reported as such.
TEST(a_changed_script_is_another_sweep)
{
    scenario with = base, without = base, settled = base;
    action script[] = {SETS(0.1, control.lock, 0), PUSHES(0.2, 0.01)};
    strcpy(script[0].text, "none");
    with.actions = script;
    with.action_count = 2;
    DONE(scenario_override(&settled, "control.settings=kp=2", &f));
    sweep s;
    KEPT_SWEEP(other);
    must_sweep(&s, SWEEP_GRID, 0, "motor.voltage=1:2:3", NULL);
    other = s;
    s.base = &with;
    sweep_store_close(must_open("script.sqlite", &s));
    sweep_store_close(must_open("script.sqlite", &s));
    other.base = &without;
    assert_refused(
        "script.sqlite", &other, STATUS_BAD_ARGUMENT,
        "script was at 0.1 control.lock = none; at 0.2 push = 0.01, now it is empty");
    unlink("script.sqlite");

    sweep_store_close(must_open("script.sqlite", &other));
    s.base = &settled;
    assert_refused("script.sqlite", &s, STATUS_BAD_ARGUMENT,
                   "control.settings was empty, now it is kp=2");
    unlink("script.sqlite");
}

// A push acts on the corrected arm only, also where the model is varied.
TEST(a_script_goes_with_every_run)
{
    fault f = {.text = ""};
    sweep s;
    base.actions = &PUSHES(0.2, 0.01);
    base.action_count = 1;
    assert_int_equal(sweep_of(&s, SWEEP_GRID, 0, 1, &f, "arm.model=corrected,printed",
                              "motor.voltage=1,2"),
                     STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "run 3 (arm.model = printed, motor.voltage = 1)"));
    assert_non_null(strstr(f.text, "takes no pushes"));
    base.actions = NULL;
    base.action_count = 0;
}

// A list as long as no command line can be.
TEST(lists_have_an_end)
{
    enum { VALUES = 400000 };
    sweep s;
    KEPT_TEXT(text) = malloc(16 + 8 * VALUES);
    char *end = text + sprintf(text, "control.seed=0");
    for (int i = 1; i < VALUES; i++) {
        end += sprintf(end, ",%d", i);
    }
    REFUSED(STATUS_BAD_ARGUMENT, "at most 20000 values, here are 400000",
            sweep_of(&s, SWEEP_GRID, 0, 1, &f, text, NULL));
}

// Values that are drawn together stay pairs, through a database's definition too.
TEST(values_drawn_together_stay_pairs)
{
    for (sweep_sampling how = SWEEP_RANDOM; how <= SWEEP_LATIN; how++) {
        KEPT_SWEEP(s);
        KEPT_SWEEP(again);
        must_sweep(&s, how, 60, "arm.k2=1,2,3", "with arm.mass=0.1,0.2,0.2");
        SCOPED(definition_finish) definition d = {0};
        DONE(definition_init(&d, &s, &f));
        DONE(definition_plan(&d, "here", &again, &f));
        bool seen[4] = {false};
        for (size_t run = 0; run < 60; run++) {
            const double k2 = sweep_value(&s, run, 0), mass = sweep_value(&s, run, 1);
            seen[(int)k2] = true;
            check_close(mass, k2 < 1.5 ? 0.1 : 0.2, 0);
            check_close(sweep_value(&again, run, 0), k2, 0);
            check_close(sweep_value(&again, run, 1), mass, 0);
        }
        assert_true(seen[1] && seen[2] && seen[3]);
    }

    static const struct {
        sweep_sampling how;
        const char *first, *second, *says;
    } refused[] = {
        {SWEEP_GRID, "arm.k2=1,2", "with arm.mass=0.1,0.2", "goes with drawn values"},
        {SWEEP_LATIN, "with arm.k2=1,2", "arm.mass=0.1,0.2", "behind those"},
        {SWEEP_LATIN, "arm.k2=1,2", "with arm.mass=0.1,0.2,0.3",
         "as many values: 2, not 3"},
        {SWEEP_LATIN, "arm.k2=1:2", "with arm.mass=0.1,0.2", "as many values"},
    };
    for (EACH(c, refused)) {
        sweep s;
        REFUSED(STATUS_BAD_ARGUMENT, c->says,
                sweep_of(&s, c->how, c->how == SWEEP_GRID ? 0 : 4, 1, &f, c->first,
                         c->second));
    }
}

// A name that begins with a colon is a file like any other.
TEST(a_colon_begins_a_name)
{
    SWEPT(s, SWEEP_GRID, 0, "motor.voltage=1:2:3", NULL);
    sweep_store_close(must_open(":memory:", &s));
    assert_int_equal(access("./:memory:", F_OK), 0);
    unlink("./:memory:");
}

TEST(more_axes_than_there_may_be_are_refused)
{
    enum { TOO_MANY = SWEEP_MOST_AXES + 1 };
    char *vary[TOO_MANY];
    int count = 0;
    for (int i = 0; i < parameter_count && count < TOO_MANY; i++) {
        const parameter_info *info = &parameter_table[i];
        if (info->type == PARAMETER_REAL && info->minimum <= 1 && info->maximum >= 2) {
            vary[count++] = formatted("%s=1:2:2", info->path);
        }
    }
    assert_int_equal(count, TOO_MANY);
    sweep s;
    const sweep_request request = {.vary = vary,
                                   .vary_count = TOO_MANY,
                                   .sampling = SWEEP_LATIN,
                                   .runs = 3};
    REFUSED(STATUS_BAD_ARGUMENT, "at most 32 parameters",
            sweep_init(&s, &base, &request, &f));
}

// Rows of runs that the sweep does not have are the work of others.
TEST(rows_that_are_no_runs_are_refused)
{
    for (EACH_TEXT(c, "UPDATE run SET run = 0 WHERE run = 1",
                   "UPDATE run SET run = 9 WHERE run = 1")) {
        SWEPT(s, SWEEP_GRID, 0, "motor.voltage=1:2:3", NULL);
        sweep_store *store = must_open("rows.sqlite", &s);
        must_run(&s, store, 1);
        tamper("rows.sqlite", *c);

        // whoever reads from it, and whoever goes on with it
        double values[3];
        size_t failed;
        REFUSED(STATUS_BAD_ARGUMENT, "no run of the sweep",
                sweep_store_quantity(store, (sweep_share){0}, "peak_force_N", values,
                                     &failed, &f));
        sweep_store_close(store);
        assert_refused("rows.sqlite", &s, STATUS_BAD_ARGUMENT, "of a sweep of 3");
        unlink("rows.sqlite");
    }
}

TEST(what_is_no_sweep_is_left_alone)
{
    SWEPT(s, SWEEP_GRID, 0, "motor.voltage=1:2:3", NULL);
    put_file("text", "my notes, which are longer than a few bytes\n");
    assert_refused("text", &s, STATUS_BAD_ARGUMENT, "no SQLite database");
    struct stat about;
    assert_int_equal(stat("text", &about), 0);
    assert_int_equal(about.st_size, 44);
    tamper("theirs.sqlite", "CREATE TABLE run (x)");
    assert_refused("theirs.sqlite", &s, STATUS_BAD_ARGUMENT, "holds no sweep");
    assert_refused("nowhere/x.sqlite", &s, STATUS_CANNOT_WRITE, "No such file");
    unlink("text");
    unlink("theirs.sqlite");
}

TEST(two_sweeps_do_not_write_to_one_file_at_once)
{
    SWEPT(s, SWEEP_GRID, 0, "motor.voltage=1:2:3", NULL);
    sweep_store *store = must_open("busy.sqlite", &s);
    assert_refused("busy.sqlite", &s, STATUS_CANNOT_WRITE, "another sweep is writing");
    sweep_store_close(store);
    sweep_store_close(must_open("busy.sqlite", &s));
    unlink("busy.sqlite");
}

TEST(a_file_deleted_within_a_transaction_is_missed)
{
    SWEPT(s, SWEEP_GRID, 0, "motor.voltage=1:2:3", NULL);
    KEPT_STORE(store) = must_open("gone.sqlite", &s);
    const summary result = {.peak_force_N = 2};
    DONE(sweep_store_put(store, 0, &result, &f));
    DONE(sweep_store_commit(store, &f));
    DONE(sweep_store_put(store, 1, &result, &f));
    unlink("gone.sqlite");
    REFUSED(STATUS_CANNOT_WRITE, "'gone.sqlite' was deleted, moved or replaced",
            sweep_store_commit(store, &f));
}

TEST(a_failed_run_is_a_row_with_its_message)
{
    KEPT_SWEEP(s);
    fault f = {0};
    must_sweep(&s, SWEEP_GRID, 0, "arm.hub_joint=rigid,spring", NULL);
    KEPT_STORE(store) = must_open(NULL, &s);
    summary good = {.peak_force_N = 2, .impacts = (double)NAN},
            bad = {.peak_force_N = 1e9};
    bad.status = STATUS_UNSTABLE;
    strcpy(bad.message, "went off, \"far\"");
    assert_int_equal(sweep_store_put(store, 1, &bad, &f), STATUS_OK);
    assert_int_equal(sweep_store_put(store, 0, &good, &f), STATUS_OK);
    // a run cannot be there twice
    assert_int_not_equal(sweep_store_put(store, 0, &good, &f), STATUS_OK);
    double values[2];
    size_t failed;
    assert_int_equal(sweep_store_quantity(store, (sweep_share){0}, "peak_force_N", values,
                                          &failed, &f),
                     STATUS_OK);
    check_close(values[0], 2, 0);
    assert_true(isnan(values[1]));
    assert_int_equal(failed, 1);
    KEPT_TEXT(csv) = csv_of(store);
    assert_non_null(strstr(csv, "\n1,rigid,ok,,"));
    assert_non_null(strstr(csv, "\n2,spring,failed,\"went off, \"\"far\"\"\","));
    assert_null(strstr(csv, "nan"));
}

ALL_BETWEEN(sweep_fixture_open, sweep_fixture_close)
