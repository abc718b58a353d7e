#include "tests/sweep_fixture.h"

#include <sqlite3.h>

#include "tests/check.h"

scenario base;

void print_sentence(void *context, const char *sentence)
{
    (void)context;
    print_error("%s\n", sentence);
}

int sweep_fixture_open(void **state)
{
    static const char text[] =
        "title: Hit\nmotor: {voltage: 1 V}\nrun: {duration: 0.6 s}\n";
    return enter_folder(state) ||
           scenario_parse(&base, text, strlen(text), "hit.yaml", "hit", print_sentence,
                          NULL) != STATUS_OK;
}

int sweep_fixture_close(void **state)
{
    scenario_finish(&base);
    return leave_folder(state);
}

status sweep_of(sweep *s, sweep_sampling sampling, size_t runs, uint64_t seed, fault *f,
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

void must_sweep(sweep *s, sweep_sampling sampling, size_t runs, const char *a,
                const char *b)
{
    DONE(sweep_of(s, sampling, runs, 1, &f, a, b));
}

sweep_store *must_open(const char *path, const sweep *s)
{
    sweep_store *store;
    DONE(sweep_store_open(&store, path, s, &f));
    return store;
}

void tamper(const char *path, const char *sql)
{
    sqlite3 *database;
    assert_int_equal(sqlite3_open(path, &database), SQLITE_OK);
    fail_if(sqlite3_exec(database, sql, NULL, NULL, NULL) != SQLITE_OK, "%s",
            sqlite3_errmsg(database));
    sqlite3_close(database);
}

char *csv_of(sweep_store *store)
{
    WRITTEN(text, DONE(sweep_store_write(store, stream, false, &f)));
    return text;
}

sweep_progress must_run(const sweep *s, sweep_store *store, int jobs)
{
    sweep_progress progress;
    sweep_options options = {.jobs = jobs};
    DONE(sweep_run(s, store, &options, &progress, &f));
    return progress;
}

char *uninterrupted(const sweep *s, int jobs)
{
    KEPT_STORE(store) = must_open(NULL, s);
    sweep_progress progress = must_run(s, store, jobs);
    assert_int_equal(progress.done, s->run_count);
    assert_int_equal(progress.done_now, s->run_count);
    return csv_of(store);
}
