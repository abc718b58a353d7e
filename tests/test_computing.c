// What computes is whole without SQLite: this program holds all of it and nothing that
// stores. A sweep is kept in an array here.

#include "src/study/robust/robust.h"
#include "src/study/sweep_run.h"
#include "tests/check.h"

enum { RUNS = 3 };

// Rows in memory; counted are those of them that are committed.
typedef struct rows {
    sweep_store store;
    summary results[RUNS];
    unsigned char present[RUNS];
    size_t committed;
} rows;

static status put_row(sweep_store *store, size_t run, const summary *result, fault *f)
{
    rows *r = (rows *)store;
    (void)f;
    assert_int_equal(r->present[run], 0);
    r->results[run] = *result;
    r->present[run] = 1;
    store->count++;
    return STATUS_OK;
}

static status commit_rows(sweep_store *store, fault *f)
{
    rows *r = (rows *)store;
    (void)f;
    r->committed = store->count;
    return STATUS_OK;
}

static status tell_values(sweep_store *store, sweep_share share, const char *key,
                          sweep_value_taker *take, void *context, size_t *failed,
                          fault *f)
{
    const rows *r = (rows *)store;
    (void)f;
    (void)share;
    for (size_t i = 0; i < RUNS; i++) {
        double value = (double)i + 1; // "run"
        for (int q = 0; q < summary_count; q++) {
            if (strcmp(summary_table[q].key, key) == 0) {
                value = summary_value(&r->results[i], q);
            }
        }
        if (r->present[i]) {
            take(context, i, value);
        }
    }
    if (failed != NULL) {
        *failed = 0;
    }
    return STATUS_OK;
}

TEST(a_sweep_is_computed_into_rows_of_any_kind)
{
    static char name[] = "test", vary[] = "motor.voltage=0.5,1,2";
    char *varied[] = {vary};
    const sweep_request request = {.vary = varied, .vary_count = 1};
    const sweep_options options = {.jobs = 2};
    scenario base = {.name = name};
    parameters_defaults(&base.parameters, ARM_CORRECTED);
    base.parameters.control.law = LAW_HYBRID;
    base.parameters.set[PARAMETER_INDEX(control.law)] = 1;
    assert_int_equal(parameters_resolve(&base.parameters, NULL), STATUS_OK);
    rows r = {.store = {0, put_row, commit_rows, tell_values}};

    // all runs, and then none
    KEPT_SWEEP(s);
    sweep_progress progress;
    DONE(sweep_init(&s, &base, &request, &f));
    for (int i = 0; i < 2; i++) {
        DONE(sweep_run(&s, &r.store, &options, &progress, &f));
        assert_int_equal(progress.done, RUNS);
        assert_int_equal(progress.done_now, i == 0 ? RUNS : 0);
        assert_int_equal(r.committed, RUNS);
    }

    // which can be judged
    SCOPED(robust_law_finish) robust_law law;
    DONE(robust_law_of(&law, "hybrid", &s, (sweep_share){0}, &r.store, &f));
    assert_int_equal(law.runs, RUNS);
    assert_true(isfinite(law.raw[ROBUST_MEDIAN]));
}
