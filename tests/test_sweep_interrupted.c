// Sweeps that are killed or stopped, and continue.
#include <signal.h>
#include <sqlite3.h>

#include "tests/sweep_fixture.h"

// What the child of the next test does at each report of progress: at the first one it
// commits, at the second, with rows that are not committed, it asks to be killed.
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

// Enough for progress to be reported, every tenth of a second, long before the last of
// them.
enum { MANY = 24000 };
#define MANY_RUNS "motor.voltage=0.5:5:24000"

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
        sweep_options options = {.jobs = 1,
                                 .report = commit_then_wait_for_death,
                                 .context = &d};
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

TEST(a_killed_sweep_goes_on_and_loses_and_doubles_nothing)
{
    SWEPT(s, SWEEP_GRID, 0, MANY_RUNS, NULL);
    sweep_in_a_child_that_is_killed(&s, "killed.sqlite");
    long long kept = number_from("killed.sqlite", "SELECT count(*) FROM run");
    assert_in_range(kept, 1, MANY - 1);
    sweep_store *store = must_open("killed.sqlite", &s);
    sweep_progress progress = must_run(&s, store, 2);
    assert_int_equal(progress.done, MANY);
    assert_int_equal(progress.done_now, MANY - kept);
    KEPT_TEXT(resumed) = csv_of(store), *whole = uninterrupted(&s, 2);
    sweep_store_close(store);
    assert_string_equal(resumed, whole);
    assert_int_equal(number_from("killed.sqlite", "SELECT count(*) FROM run"), MANY);
    assert_int_equal(number_from("killed.sqlite", "SELECT sum(run) FROM run"),
                     (long long)MANY * (MANY + 1) / 2);
    unlink("killed.sqlite");
}

static volatile sig_atomic_t stop;

static void stop_soon(void *context, const sweep_progress *p)
{
    (void)context;
    stop = p->done_now > 0;
}

TEST(a_stopped_sweep_keeps_what_it_has_and_goes_on)
{
    KEPT_SWEEP(s);
    sweep_progress progress;
    sweep_options options = {.jobs = 2, .stop = &stop, .report = stop_soon};
    must_sweep(&s, SWEEP_GRID, 0, MANY_RUNS, NULL);
    sweep_store *store = must_open("stopped.sqlite", &s);
    stop = 0;
    DONE(sweep_run(&s, store, &options, &progress, &f));
    sweep_store_close(store);
    assert_in_range(progress.done, 1, MANY - 1);
    assert_int_equal(number_from("stopped.sqlite", "SELECT count(*) FROM run"),
                     progress.done);
    store = must_open("stopped.sqlite", &s);
    sweep_progress rest = must_run(&s, store, 2);
    assert_int_equal(rest.done_now, MANY - progress.done);
    // nothing is left to do
    assert_int_equal(must_run(&s, store, 2).done_now, 0);
    sweep_store_close(store);
    unlink("stopped.sqlite");
}

ALL_BETWEEN(sweep_fixture_open, sweep_fixture_close)
