#include <signal.h>
#include <sqlite3.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "render/plot/figure_file.h"
#include "render/plot/sweep_plot.h"
#include "render/page/text.h"
#include "src/run/run.h"
#include "src/solve/taylor_engine.h"
#include "src/study/sweep_rows.h"
#include "src/study/sweep_run.h"
#include "tests/check.h"

static char folder[] = "/tmp/sweep-XXXXXX";
static scenario base;

static void print_sentence(void *context, const char *sentence)
{
    (void)context;
    print_error("%s\n", sentence);
}

static int prepare(void **state)
{
    (void)state;
    static const char text[] = "title: Hit\nmotor: {voltage: 1 V}\nrun: {duration: 0.6 s}\n";
    return mkdtemp(folder) == NULL || chdir(folder) != 0 ||
           scenario_parse(&base, text, strlen(text), "hit.yaml", "hit", print_sentence, NULL) !=
               STATUS_OK;
}

static int clean_up(void **state)
{
    (void)state;
    scenario_finish(&base);
    text_release();
    return chdir("/") != 0 || rmdir(folder) != 0;
}

// --- what is varied -------------------------------------------------------------------------

// The sweep of up to three --vary; the others are NULL.
static status sweep_of(sweep *s, sweep_sampling sampling, size_t runs, uint64_t seed, fault *f,
                       const char *a, const char *b)
{
    char *vary[] = {(char *)a, (char *)b};
    sweep_request request = {.vary = vary,
                             .vary_count = (a != NULL) + (b != NULL),
                             .sampling = sampling,
                             .runs = runs,
                             .seed = seed};
    return sweep_init(s, &base, &request, f);
}

static void must_sweep(sweep *s, sweep_sampling sampling, size_t runs, const char *a, const char *b)
{
    fault f = {0};
    if (sweep_of(s, sampling, runs, 1, &f, a, b) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
}

static void the_last_parameter_of_a_grid_changes_fastest(void **state)
{
    (void)state;
    sweep s;
    must_sweep(&s, SWEEP_GRID, 0, "motor.voltage=1:2:3", "method.name=event,newmark");
    static const double voltage[] = {1, 1, 1.5, 1.5, 2, 2};
    assert_int_equal(s.run_count, 6);
    for (size_t run = 0; run < 6; run++) {
        scenario derived;
        fault f = {0};
        assert_int_equal(sweep_scenario(&s, run, &derived, &f), STATUS_OK);
        check_close(derived.parameters.motor.voltage, voltage[run], 0);
        assert_int_equal(derived.parameters.method.name, run % 2 ? METHOD_NEWMARK : METHOD_EVENT);
        check_close(derived.parameters.run.duration, 0.6, 0);
    }
    sweep_finish(&s);
}

static void ranges_meet_their_ends_and_are_spaced_as_asked(void **state)
{
    (void)state;
    sweep s;
    must_sweep(&s, SWEEP_GRID, 0, "arm.k2=0.1:0.7:7", NULL);
    check_close(sweep_value(&s, 0, 0), 0.1, 0);
    check_close(sweep_value(&s, 6, 0), 0.7, 0);
    check_close(sweep_value(&s, 2, 0), 0.3, 1e-16);
    sweep_finish(&s);
    must_sweep(&s, SWEEP_GRID, 0, "arm.k2=1000:0.1:5:log", NULL);
    for (size_t i = 0; i < 5; i++) {
        check_relative(sweep_value(&s, i, 0), pow(10, 3.0 - (double)i), 1e-14);
    }
    check_close(sweep_value(&s, 4, 0), 0.1, 0);
    sweep_finish(&s);
    must_sweep(&s, SWEEP_GRID, 0, "arm.links=2:64:6:log", NULL);
    for (size_t i = 0; i < 6; i++) {
        check_close(sweep_value(&s, i, 0), (double)(2 << i), 0);
    }
    sweep_finish(&s);
    must_sweep(&s, SWEEP_GRID, 0, "motor.voltage=0.5 V:1 V:2", NULL);
    check_close(sweep_value(&s, 0, 0), 0.5, 0);
    sweep_finish(&s);
}

// One number of a list, named with its place from 1 on; the others stay as the scenario has them.
static void a_number_of_a_list_is_varied_by_its_place(void **state)
{
    (void)state;
    static const char text[] = "title: Springs\narm: {links: 4, joint_stiffness: [12, 10, 8]}\n";
    scenario springs;
    sweep s;
    fault f = {0};
    assert_int_equal(scenario_parse(&springs, text, strlen(text), "springs.yaml", "springs",
                                    print_sentence, NULL),
                     STATUS_OK);
    char *vary[] = {(char[]){"arm.joint_stiffness[2]=0.1:0.3:3"},
                    (char[]){"arm.joint_stiffness[3]=7 N m/rad,8.5"}};
    const sweep_request request = {.vary = vary, .vary_count = 2};
    assert_int_equal(sweep_init(&s, &springs, &request, &f), STATUS_OK);
    assert_string_equal(s.axes[0].name, "arm.joint_stiffness[2]");
    assert_string_equal(s.axes[1].text, "7,8.5");

    // every run has its own list, to the last bit
    assert_int_equal(s.run_count, 6);
    for (size_t run = 0; run < s.run_count; run++) {
        scenario derived;
        double numbers[PARAMETER_LIST_MOST];
        assert_int_equal(sweep_scenario(&s, run, &derived, &f), STATUS_OK);
        assert_int_equal(parameter_list_numbers(derived.parameters.arm.joint_stiffness, numbers),
                         3);
        check_close(numbers[0], 12, 0);
        check_close(numbers[1], sweep_value(&s, run, 0), 0);
        check_close(numbers[2], run % 2 ? 8.5 : 7, 0);
    }
    sweep_finish(&s);

    // a place that the list does not have
    vary[0] = (char[]){"arm.joint_stiffness[4]=5,6"};
    assert_int_equal(sweep_init(&s, &springs, &request, &f), STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "has 3 numbers"));
    scenario_finish(&springs);
}

static void bad_requests_are_refused_with_a_sentence(void **state)
{
    (void)state;
    static const struct {
        const char *a, *b;
        sweep_sampling sampling;
        size_t runs;
        const char *says;
    } bad[] = {
        {NULL, NULL, SWEEP_GRID, 0, "--vary"},
        {"motor.voltage", NULL, SWEEP_GRID, 0, "PATH=a:b:n"},
        {"motor.voltage=", NULL, SWEEP_GRID, 0, "no value"},
        {"motor.voltge=1:2:3", NULL, SWEEP_GRID, 0, "did you mean 'motor.voltage'"},
        {"motor.voltage=1:2", NULL, SWEEP_GRID, 0, "a:b:n"},
        {"motor.voltage=1:2:3:4", NULL, SWEEP_GRID, 0, "a:b:n"},
        {"motor.voltage=1:2:3:4:log", NULL, SWEEP_GRID, 0, "a:b:n"},
        {"motor.voltage=1:2:1", NULL, SWEEP_GRID, 0, "'1' is no number of values"},
        {"motor.voltage=1:2:2.5", NULL, SWEEP_GRID, 0, "'2.5'"},
        {"motor.voltage=1:x:3", NULL, SWEEP_GRID, 0, "'x' is not a number"},
        {"motor.voltage=1:2000:3", NULL, SWEEP_GRID, 0, "out of range"},
        {"motor.voltage=1:1:3", NULL, SWEEP_GRID, 0, "two different ends"},
        {"motor.voltage=0:1:3:log", NULL, SWEEP_GRID, 0, "above zero"},
        {"motor.voltage=1,nan", NULL, SWEEP_GRID, 0, "finite"},
        {"motor.voltage=1,2,1", NULL, SWEEP_GRID, 0, "twice"},
        {"motor.voltage=1 m:2:3", NULL, SWEEP_GRID, 0, "expected V"},
        {"motor.voltage=1:2:3", "motor.voltage=4", SWEEP_GRID, 0, "varied twice"},
        {"arm.joint_stiffness=1,2", NULL, SWEEP_GRID, 0, "arm.joint_stiffness[1]"},
        {"arm.joint_stiffness[0]=1,2", NULL, SWEEP_GRID, 0, "no number of a list"},
        {"arm.joint_stiffness[1=1,2", NULL, SWEEP_GRID, 0, "no number of a list"},
        {"arm.joint_stiffness[1]=1,-2", NULL, SWEEP_GRID, 0, "out of range"},
        {"arm.joint_stiffness[1]=1:-2:3", NULL, SWEEP_GRID, 0, "out of range"},
        {"arm.k2[1]=1,2", NULL, SWEEP_GRID, 0, "no list"},
        {"arm.links=1:4:3", NULL, SWEEP_GRID, 0, "not a whole number"},
        {"arm.links=1:4:9:log", NULL, SWEEP_GRID, 0, "twice"},
        {"method.name=event:newmark:2", NULL, SWEEP_GRID, 0, "event,newmark,generalized-alpha"},
        {"method.name=event,newmrk", NULL, SWEEP_GRID, 0, "newmrk"},
        {"arm.model=corrected,printed", "arm.links=2,3", SWEEP_GRID, 0,
         "run 4 (arm.model = printed, arm.links = 3): the printed model has two links"},
        {"arm.k1=1:2:10000", "arm.k2=1:2:10000", SWEEP_GRID, 0, "more than"},
        {"arm.k2=1:2:4", NULL, SWEEP_GRID, 7, "--runs"},
        {"arm.k2=1:2", NULL, SWEEP_RANDOM, 0, "--runs"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        sweep s;
        fault f = {0};
        assert_int_equal(sweep_of(&s, bad[i].sampling, bad[i].runs, 0, &f, bad[i].a, bad[i].b),
                         STATUS_BAD_ARGUMENT);
        if (strstr(f.text, bad[i].says) == NULL) {
            fail_msg("'%s' does not say '%s'", f.text, bad[i].says);
        }
    }
}

static void a_latin_hypercube_meets_every_part_of_every_range_once(void **state)
{
    (void)state;
    enum { RUNS = 1000 };
    sweep s;
    must_sweep(&s, SWEEP_LATIN, RUNS, "motor.voltage=2:1", "arm.k2=0.1:1000:log");
    unsigned char seen[2][RUNS] = {{0}};
    double together = 0;
    for (size_t run = 0; run < RUNS; run++) {
        double share[] = {sweep_value(&s, run, 0) - 1, (log10(sweep_value(&s, run, 1)) + 1) / 4};
        for (int i = 0; i < 2; i++) {
            int part = (int)(share[i] * RUNS);
            assert_in_range(part, 0, RUNS - 1);
            assert_false(seen[i][part]);
            seen[i][part] = 1;
        }
        together += (share[0] - 0.5) * (share[1] - 0.5) * 12;
    }
    // the two are independent of each other: five standard deviations of their correlation
    check_close(together / RUNS, 0, 5 / sqrt(RUNS));
    sweep_finish(&s);
}

static void whole_numbers_and_words_are_drawn_evenly(void **state)
{
    (void)state;
    sweep s;
    must_sweep(&s, SWEEP_LATIN, 120, "arm.links=2:5", "method.name=event,newmark");
    int links[8] = {0}, methods[4] = {0};
    for (size_t run = 0; run < 120; run++) {
        double n = sweep_value(&s, run, 0);
        check_close(n, round(n), 0);
        links[(int)n]++;
        methods[(int)sweep_value(&s, run, 1)]++;
    }
    for (int n = 2; n <= 5; n++) {
        assert_int_equal(links[n], 30);
    }
    assert_int_equal(methods[METHOD_EVENT], 60);
    assert_int_equal(methods[METHOD_NEWMARK], 60);
    sweep_finish(&s);
}

static void the_seed_decides_what_is_drawn(void **state)
{
    (void)state;
    sweep a, b, c;
    fault f;
    assert_int_equal(sweep_of(&a, SWEEP_RANDOM, 50, 5, &f, "arm.k2=1:3", NULL), STATUS_OK);
    assert_int_equal(sweep_of(&b, SWEEP_RANDOM, 50, 5, &f, "arm.k2=1:3:10", NULL), STATUS_OK);
    assert_int_equal(sweep_of(&c, SWEEP_RANDOM, 50, 6, &f, "arm.k2=1:3", NULL), STATUS_OK);
    int same = 0;
    for (size_t run = 0; run < 50; run++) {
        double value = sweep_value(&a, run, 0);
        assert_true(value >= 1 && value < 3);
        check_close(value, sweep_value(&b, run, 0), 0);
        same += value == sweep_value(&c, run, 0);
    }
    assert_int_equal(same, 0);
    sweep_finish(&a);
    sweep_finish(&b);
    sweep_finish(&c);
}

// --- runs and their store -------------------------------------------------------------------

static sweep_store *must_open(const char *path, const sweep *s)
{
    sweep_store *store;
    fault f = {0};
    if (sweep_store_open(&store, path, s, &f) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
    return store;
}

// All rows as CSV; free it.
static char *csv_of(sweep_store *store)
{
    char *text;
    size_t size;
    fault f = {0};
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    assert_int_equal(sweep_store_csv(store, stream, &f), STATUS_OK);
    fclose(stream);
    return text;
}

static sweep_progress must_run(const sweep *s, sweep_store *store, int jobs)
{
    sweep_progress progress;
    fault f = {0};
    sweep_options options = {.jobs = jobs};
    if (sweep_run(s, store, &options, &progress, &f) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
    return progress;
}

// The CSV of the whole sweep, never interrupted.
static char *uninterrupted(const sweep *s, int jobs)
{
    sweep_store *store = must_open(NULL, s);
    sweep_progress progress = must_run(s, store, jobs);
    assert_int_equal(progress.done, s->run_count);
    assert_int_equal(progress.done_now, s->run_count);
    char *csv = csv_of(store);
    sweep_store_close(store);
    return csv;
}

static void every_run_is_what_the_scenario_gives_alone(void **state)
{
    (void)state;
    sweep s;
    must_sweep(&s, SWEEP_GRID, 0, "motor.voltage=0.5:2:4", NULL);
    sweep_store *store = must_open(NULL, &s);
    must_run(&s, store, 2);
    double peaks[4], contacts[4];
    fault f = {0};
    assert_int_equal(sweep_store_quantity(store, "peak_force_N", peaks, NULL, &f), STATUS_OK);
    assert_int_equal(sweep_store_quantity(store, "first_contact_s", contacts, NULL, &f), STATUS_OK);
    for (int run = 0; run < 4; run++) {
        scenario alone = base;
        run_result result;
        alone.parameters.motor.voltage = 0.5 + 0.5 * run;
        assert_int_equal(run_scenario(&alone, false, &result), STATUS_OK);
        check_close(peaks[run], result.summary.peak_force_N, 0);
        check_close(contacts[run], result.summary.first_contact_s, 0);
        run_finish(&result);
    }
    // a higher voltage brings the arm to the wall earlier
    check_below(contacts[3], contacts[0]);
    sweep_store_close(store);
    sweep_finish(&s);
}

static void the_number_of_jobs_does_not_change_a_byte(void **state)
{
    (void)state;
    sweep s;
    must_sweep(&s, SWEEP_LATIN, 60, "motor.voltage=0.5:5", "arm.links=1:4");
    char *one = uninterrupted(&s, 1), *two = uninterrupted(&s, 2), *many = uninterrupted(&s, 7);
    assert_string_equal(one, two);
    assert_string_equal(one, many);
    static const char header[] =
        "run[],motor.voltage[V],arm.links[],status[],message[],first_contact[s],"
        "contact_impulse[N s],";
    assert_int_equal(strncmp(one, header, sizeof header - 1), 0);
    assert_non_null(strstr(one, "peak_force[N]"));
    assert_null(strstr(one, "wall_time"));
    free(one);
    free(two);
    free(many);
    sweep_finish(&s);
}

// Runs of two links go side by side in the processor's vectors: with one lane, with all of them, on
// one thread and on several, and where some of the runs are there already.
static void the_number_of_lanes_does_not_change_a_byte(void **state)
{
    (void)state;
    sweep s;
    must_sweep(&s, SWEEP_LATIN, 201, "motor.voltage=0.5:5", "wall.restitution=0:1");
    taylor_limit_width(1);
    char *alone = uninterrupted(&s, 1);
    taylor_limit_width(0);
    for (int jobs = 1; jobs <= 3; jobs++) {
        char *together = uninterrupted(&s, jobs);
        assert_string_equal(together, alone);
        free(together);
    }

    // every third run first, the rest around them
    sweep_store *store = must_open(NULL, &s);
    sweep_progress progress;
    fault f = {0};
    const sweep_options third = {.jobs = 2, .share = {.part = 2, .parts = 3}};
    assert_int_equal(sweep_run(&s, store, &third, &progress, &f), STATUS_OK);
    assert_int_equal(progress.done_now, 67);
    must_run(&s, store, 2);
    char *csv = csv_of(store);
    assert_string_equal(csv, alone);
    sweep_store_close(store);
    free(csv);
    free(alone);
    sweep_finish(&s);
}

// What the child of the next test does at each report of progress: at the first one it commits, at
// the second, with rows that are not committed, it asks to be killed.
typedef struct doomed {
    sweep_store *store;
    int pipe, reports;
} doomed;

static void commit_then_wait_for_death(void *context, const sweep_progress *p)
{
    doomed *d = context;
    if (p->done_now == 0) {
        return;
    }
    if (d->reports++ == 0) {
        if (sweep_store_commit(d->store, NULL) != STATUS_OK) {
            _exit(1);
        }
        return;
    }
    if (write(d->pipe, "x", 1) != 1) {
        _exit(1);
    }
    for (;;) {
        pause();
    }
}

static void sweep_in_a_child_that_is_killed(const sweep *s, const char *path)
{
    int ends[2], how;
    char byte;
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        fault f = {0};
        sweep_progress progress;
        doomed d = {.pipe = ends[1]};
        sweep_options options = {.jobs = 1, .report = commit_then_wait_for_death, .context = &d};
        close(ends[0]);
        if (sweep_store_open(&d.store, path, s, &f) == STATUS_OK) {
            sweep_run(s, d.store, &options, &progress, &f);
        }
        _exit(1);
    }
    close(ends[1]);
    ssize_t got = read(ends[0], &byte, 1);
    kill(child, SIGKILL);
    assert_int_equal(waitpid(child, &how, 0), child);
    close(ends[0]);
    assert_int_equal(got, 1);
    assert_true(WIFSIGNALED(how));
}

static long long number_from(const char *path, const char *sql)
{
    sqlite3 *database;
    sqlite3_stmt *statement;
    assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
    assert_int_equal(sqlite3_prepare_v2(database, sql, -1, &statement, NULL), SQLITE_OK);
    assert_int_equal(sqlite3_step(statement), SQLITE_ROW);
    long long number = sqlite3_column_int64(statement, 0);
    sqlite3_finalize(statement);
    sqlite3_close(database);
    return number;
}

static void a_killed_sweep_goes_on_and_loses_and_doubles_nothing(void **state)
{
    (void)state;
    sweep s;
    must_sweep(&s, SWEEP_GRID, 0, "motor.voltage=0.5:5:6000", NULL);
    sweep_in_a_child_that_is_killed(&s, "killed.sqlite");
    long long kept = number_from("killed.sqlite", "SELECT count(*) FROM run");
    assert_in_range(kept, 1, 5999);
    sweep_store *store = must_open("killed.sqlite", &s);
    sweep_progress progress = must_run(&s, store, 2);
    assert_int_equal(progress.done, 6000);
    assert_int_equal(progress.done_now, 6000 - kept);
    char *resumed = csv_of(store), *whole = uninterrupted(&s, 2);
    sweep_store_close(store);
    assert_string_equal(resumed, whole);
    assert_int_equal(number_from("killed.sqlite", "SELECT count(*) FROM run"), 6000);
    assert_int_equal(number_from("killed.sqlite", "SELECT sum(run) FROM run"), 3000 * 6001);
    free(resumed);
    free(whole);
    sweep_finish(&s);
    unlink("killed.sqlite");
}

static volatile sig_atomic_t stop;

static void stop_soon(void *context, const sweep_progress *p)
{
    (void)context;
    stop = p->done_now > 0;
}

static void a_stopped_sweep_keeps_what_it_has_and_goes_on(void **state)
{
    (void)state;
    sweep s;
    sweep_progress progress;
    fault f = {0};
    sweep_options options = {.jobs = 2, .stop = &stop, .report = stop_soon};
    must_sweep(&s, SWEEP_GRID, 0, "motor.voltage=0.5:5:6000", NULL);
    sweep_store *store = must_open("stopped.sqlite", &s);
    stop = 0;
    assert_int_equal(sweep_run(&s, store, &options, &progress, &f), STATUS_OK);
    sweep_store_close(store);
    assert_in_range(progress.done, 1, 5999);
    assert_int_equal(number_from("stopped.sqlite", "SELECT count(*) FROM run"), progress.done);
    store = must_open("stopped.sqlite", &s);
    sweep_progress rest = must_run(&s, store, 2);
    assert_int_equal(rest.done_now, 6000 - progress.done);
    // nothing is left to do
    assert_int_equal(must_run(&s, store, 2).done_now, 0);
    sweep_store_close(store);
    sweep_finish(&s);
    unlink("stopped.sqlite");
}

static void assert_refused(const char *path, const sweep *s, status code, const char *says)
{
    sweep_store *store;
    fault f = {0};
    assert_int_equal(sweep_store_open(&store, path, s, &f), code);
    assert_null(store);
    if (strstr(f.text, says) == NULL || strstr(f.text, path) == NULL) {
        fail_msg("'%s' does not say '%s' of '%s'", f.text, says, path);
    }
}

static void another_sweep_is_refused_with_the_difference(void **state)
{
    (void)state;
    sweep s, other;
    must_sweep(&s, SWEEP_GRID, 0, "motor.voltage=1:2:3", NULL);
    sweep_store_close(must_open("one.sqlite", &s));
    must_sweep(&other, SWEEP_GRID, 0, "motor.voltage=1:2:4", NULL);
    assert_refused("one.sqlite", &other, STATUS_BAD_ARGUMENT,
                   "--vary 1 was motor.voltage=1:2:3, now it is motor.voltage=1:2:4");
    sweep_finish(&other);
    must_sweep(&other, SWEEP_RANDOM, 3, "motor.voltage=1:2:3", NULL);
    assert_refused("one.sqlite", &other, STATUS_BAD_ARGUMENT, "sample was grid, now it is random");
    sweep_finish(&other);
    scenario changed = base;
    fault f;
    assert_int_equal(scenario_override(&changed, "arm.k2=5", &f), STATUS_OK);
    other = s;
    other.base = &changed;
    assert_refused("one.sqlite", &other, STATUS_BAD_ARGUMENT, "arm.k2 was 4.92, now it is 5");
    // the same one in other words is the same
    must_sweep(&other, SWEEP_GRID, 0, "motor.voltage=1.0 V:2.0:3", NULL);
    sweep_store_close(must_open("one.sqlite", &other));
    sweep_finish(&other);
    sweep_finish(&s);
    unlink("one.sqlite");
}

static void what_is_no_sweep_is_left_alone(void **state)
{
    (void)state;
    sweep s;
    must_sweep(&s, SWEEP_GRID, 0, "motor.voltage=1:2:3", NULL);
    FILE *stream = fopen("text", "w");
    assert_non_null(stream);
    fputs("my notes, which are longer than a few bytes\n", stream);
    fclose(stream);
    assert_refused("text", &s, STATUS_BAD_ARGUMENT, "no SQLite database");
    struct stat about;
    assert_int_equal(stat("text", &about), 0);
    assert_int_equal(about.st_size, 44);
    sqlite3 *database;
    assert_int_equal(sqlite3_open("theirs.sqlite", &database), SQLITE_OK);
    sqlite3_exec(database, "CREATE TABLE run (x)", NULL, NULL, NULL);
    sqlite3_close(database);
    assert_refused("theirs.sqlite", &s, STATUS_BAD_ARGUMENT, "holds no sweep");
    assert_refused("nowhere/x.sqlite", &s, STATUS_CANNOT_WRITE, "No such file");
    sweep_finish(&s);
    unlink("text");
    unlink("theirs.sqlite");
}

static void two_sweeps_do_not_write_to_one_file_at_once(void **state)
{
    (void)state;
    sweep s;
    must_sweep(&s, SWEEP_GRID, 0, "motor.voltage=1:2:3", NULL);
    sweep_store *store = must_open("busy.sqlite", &s);
    assert_refused("busy.sqlite", &s, STATUS_CANNOT_WRITE, "another sweep is writing");
    sweep_store_close(store);
    sweep_store_close(must_open("busy.sqlite", &s));
    sweep_finish(&s);
    unlink("busy.sqlite");
}

static void a_failed_run_is_a_row_with_its_message(void **state)
{
    (void)state;
    sweep s;
    fault f = {0};
    must_sweep(&s, SWEEP_GRID, 0, "arm.hub_joint=rigid,spring", NULL);
    sweep_store *store = must_open(NULL, &s);
    summary good = {.peak_force_N = 2, .impacts = (double)NAN}, bad = {.peak_force_N = 1e9};
    bad.status = STATUS_UNSTABLE;
    strcpy(bad.message, "went off, \"far\"");
    assert_int_equal(sweep_store_put(store, 1, &bad, &f), STATUS_OK);
    assert_int_equal(sweep_store_put(store, 0, &good, &f), STATUS_OK);
    // a run cannot be there twice
    assert_int_not_equal(sweep_store_put(store, 0, &good, &f), STATUS_OK);
    double values[2];
    size_t failed;
    assert_int_equal(sweep_store_quantity(store, "peak_force_N", values, &failed, &f), STATUS_OK);
    check_close(values[0], 2, 0);
    assert_true(isnan(values[1]));
    assert_int_equal(failed, 1);
    char *csv = csv_of(store);
    assert_non_null(strstr(csv, "\n1,rigid,ok,,"));
    assert_non_null(strstr(csv, "\n2,spring,failed,\"went off, \"\"far\"\"\","));
    assert_null(strstr(csv, "nan"));
    free(csv);
    sweep_store_close(store);
    sweep_finish(&s);
}

// --- pictures -------------------------------------------------------------------------------

static void must_draw(const char *a, const char *b, sweep_sampling sampling, size_t runs,
                      const char *path, double offset)
{
    sweep s;
    fault f = {0};
    must_sweep(&s, sampling, runs, a, b);
    double *values = malloc(s.run_count * sizeof *values);
    assert_non_null(values);
    for (size_t run = 0; run < s.run_count; run++) {
        values[run] = run % 7 == 3 ? (double)NAN : offset + (double)(run % 11);
    }
    sweep_picture shown = {.sweep = &s, .key = "peak_force_N", .values = values};
    assert_int_equal(sweep_plot_check(&s, path, &f), STATUS_OK);
    owned_figure *drawn = sweep_figure_create(&shown);
    if (figure_write(&drawn->figure, path, &f) != STATUS_OK) {
        fail_msg("%s", f.text);
    }
    owned_figure_destroy(drawn);
    struct stat about;
    assert_int_equal(stat(path, &about), 0);
    assert_true(about.st_size > 1000);
    unlink(path);
    free(values);
    sweep_finish(&s);
}

static void every_kind_of_sweep_can_be_drawn(void **state)
{
    (void)state;
    must_draw("motor.voltage=1:2:9", NULL, SWEEP_GRID, 0, "a.png", 0);
    must_draw("motor.voltage=3,1,2", NULL, SWEEP_GRID, 0, "a.pdf", 0);
    must_draw("arm.k2=1:1e6:200:log", NULL, SWEEP_GRID, 0, "a.svg", 0);
    must_draw("method.name=newmark,event", NULL, SWEEP_GRID, 0, "a.png", 0);
    must_draw("motor.voltage=1", NULL, SWEEP_GRID, 0, "a.png", 0);
    must_draw("motor.voltage=1:2", NULL, SWEEP_RANDOM, 30, "a.svg", -1e9);
    must_draw("motor.voltage=2:1:9", "arm.k2=1:1e-5:5:log", SWEEP_GRID, 0, "a.png", 0);
    must_draw("motor.voltage=1:2:9", "method.name=event,newmark", SWEEP_GRID, 0, "a.pdf", 0);
    must_draw("motor.voltage=1", "arm.k2=3", SWEEP_GRID, 0, "a.png", (double)NAN);
    must_draw("motor.voltage=1:2", "arm.k2=3,4", SWEEP_LATIN, 30, "a.png", 1e-6);
}

// Methods beside a number: a curve for each over the number, whichever was varied first.
static void words_have_a_curve_each(void **state)
{
    (void)state;
    static const char *const varied[2][2] = {{"method.name=event,newmark", "motor.voltage=1,2,4"},
                                             {"motor.voltage=1,2,4", "method.name=event,newmark"}};
    for (int k = 0; k < 2; k++) {
        sweep s;
        double values[6];
        must_sweep(&s, SWEEP_GRID, 0, varied[k][0], varied[k][1]);
        assert_int_equal(s.run_count, 6);
        for (size_t run = 0; run < 6; run++) {
            // 100 for the second method, and the voltage
            double volts = sweep_value(&s, run, 1 - k);
            values[run] = volts + (sweep_value(&s, run, k) == s.axes[k].values[1] ? 100 : 0);
        }
        sweep_picture shown = {.sweep = &s, .key = "peak_force_N", .values = values};
        owned_figure *drawn = sweep_figure_create(&shown);
        const figure *fig = &drawn->figure;
        assert_null(fig->panels[0].map);
        assert_int_equal(fig->panels[0].series_count, 2);
        assert_string_equal(fig->x.name, "motor.voltage");
        assert_string_equal(fig->panels[0].series[1].label, "newmark");
        for (int i = 0; i < 3; i++) {
            assert_true(fig->panels[0].series[0].y[i] == fig->panels[0].series[0].x[i]);
            assert_true(fig->panels[0].series[1].y[i] == 100 + fig->panels[0].series[1].x[i]);
        }
        owned_figure_destroy(drawn);
        sweep_finish(&s);
    }
}

static void a_picture_shows_two_parameters_at_most(void **state)
{
    (void)state;
    char *vary[] = {"arm.k1=1,2", "arm.k2=1,2", "arm.mass=1,2"};
    sweep_request request = {.vary = vary, .vary_count = 3};
    sweep s;
    fault f = {0};
    assert_int_equal(sweep_init(&s, &base, &request, &f), STATUS_OK);
    assert_int_equal(s.run_count, 8);
    assert_int_equal(sweep_plot_check(&s, "a.png", &f), STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(f.text, "3 are varied"));
    sweep_finish(&s);
    must_sweep(&s, SWEEP_GRID, 0, "arm.k1=1,2", NULL);
    assert_int_equal(sweep_plot_check(&s, "a.jpg", &f), STATUS_BAD_ARGUMENT);
    sweep_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_last_parameter_of_a_grid_changes_fastest),
        cmocka_unit_test(ranges_meet_their_ends_and_are_spaced_as_asked),
        cmocka_unit_test(a_number_of_a_list_is_varied_by_its_place),
        cmocka_unit_test(bad_requests_are_refused_with_a_sentence),
        cmocka_unit_test(a_latin_hypercube_meets_every_part_of_every_range_once),
        cmocka_unit_test(whole_numbers_and_words_are_drawn_evenly),
        cmocka_unit_test(the_seed_decides_what_is_drawn),
        cmocka_unit_test(every_run_is_what_the_scenario_gives_alone),
        cmocka_unit_test(the_number_of_jobs_does_not_change_a_byte),
        cmocka_unit_test(the_number_of_lanes_does_not_change_a_byte),
        cmocka_unit_test(a_killed_sweep_goes_on_and_loses_and_doubles_nothing),
        cmocka_unit_test(a_stopped_sweep_keeps_what_it_has_and_goes_on),
        cmocka_unit_test(another_sweep_is_refused_with_the_difference),
        cmocka_unit_test(what_is_no_sweep_is_left_alone),
        cmocka_unit_test(two_sweeps_do_not_write_to_one_file_at_once),
        cmocka_unit_test(a_failed_run_is_a_row_with_its_message),
        cmocka_unit_test(every_kind_of_sweep_can_be_drawn),
        cmocka_unit_test(words_have_a_curve_each),
        cmocka_unit_test(a_picture_shows_two_parameters_at_most),
    };
    return cmocka_run_group_tests(tests, prepare, clean_up) != 0;
}
