#include "src/study/sweep_run.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/clock.h"
#include "src/run/run.h"
#include "src/study/sweep_rows.h"

#define COMMIT_INTERVAL 0.5 // [s]

// A sweep being computed; all but the first is the calling thread's.
typedef struct sweep_execution {
    const sweep *sweep;
    sweep_store *store;
    const sweep_options *options;
    sweep_progress *progress;
    double start, committed; // instants by the clock [s]
} sweep_execution;

// The summary of a run that could not begin.
static void summarise_refusal(summary *s, const fault *why)
{
    summary_init(s);
    s->status = why->code;
    s->path = why->path;
    snprintf(s->message, sizeof s->message, "%s", why->text);
}

static void compute_run(void *context, size_t run, void *scratch, void *result)
{
    const sweep_execution *e = context;
    summary *s = result;
    scenario derived;
    fault f = {.path = ""};
    (void)scratch;

    // the times of this thread, deriving the scenario included
    const double start = clock_seconds(CLOCK_MONOTONIC),
                 start_cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    if (sweep_scenario(e->sweep, run, &derived, &f) == STATUS_OK) {
        run_result computed;
        run_scenario(&derived, false, &computed);
        *s = computed.summary;
        run_finish(&computed);
    } else {
        summarise_refusal(s, &f);
    }
    s->cpu_time_s = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start_cpu;
    s->wall_time_s = clock_seconds(CLOCK_MONOTONIC) - start;
}

static status store_run(void *context, size_t run, const void *result, fault *f)
{
    sweep_execution *e = context;
    const summary *s = result;
    if (s->status == STATUS_NO_MEMORY) {
        // says nothing about the scenario: the run has to be done again
        return fault_set(f, STATUS_NO_MEMORY, "run %zu: %s", run + 1, s->message);
    }

    // stored, and counted once it is
    status code = sweep_store_put(e->store, run, s, f);
    if (code == STATUS_OK) {
        e->progress->done++;
        e->progress->done_now++;
        e->progress->failed += s->status != STATUS_OK;
    }
    return code;
}

static void report(const sweep_execution *e)
{
    e->progress->elapsed_s = clock_seconds(CLOCK_MONOTONIC) - e->start;
    if (e->options->report != NULL) {
        e->options->report(e->options->context, e->progress);
    }
}

// Commits what was stored every now and then, and at the end; tells how far the sweep is.
static status commit_and_report(void *context, bool over, fault *f)
{
    sweep_execution *e = context;
    status code = STATUS_OK;
    if (over || clock_seconds(CLOCK_MONOTONIC) - e->committed >= COMMIT_INTERVAL) {
        code = sweep_store_commit(e->store, f);
        e->committed = clock_seconds(CLOCK_MONOTONIC);
    }
    if (!over) {
        report(e); // the end is reported in any case, see sweep_run
    }
    return code;
}

// Counts the runs of the share, in all and those present, and marks those of other shares so that
// they are not computed here.
static void keep_to_share(const sweep_execution *e, unsigned char *present)
{
    const sweep_share share = e->options->share;
    *e->progress = (sweep_progress){0};
    for (size_t run = 0; run < e->sweep->run_count; run++) {
        bool own = share.parts == 0 || run % (size_t)share.parts == (size_t)(share.part - 1);
        e->progress->total += own;
        e->progress->done += own && present[run];
        present[run] |= !own;
    }
}

// Computes what is not present.
static status run_missing(sweep_execution *e, const unsigned char *present, fault *f)
{
    const pool_work work = {.context = e,
                            .count = e->sweep->run_count,
                            .done = present,
                            .result_size = sizeof(summary),
                            .compute = compute_run,
                            .collect = store_run,
                            .tick = commit_and_report,
                            .stop = e->options->stop};

    // no more threads than runs
    size_t missing = e->progress->total - e->progress->done;
    int jobs = missing < (size_t)e->options->jobs ? (int)missing : e->options->jobs;
    return pool_run(&work, jobs > 0 ? jobs : 1, f);
}

status sweep_run(const sweep *s, sweep_store *store, const sweep_options *options,
                 sweep_progress *progress, fault *f)
{
    assert(s != NULL && store != NULL && progress != NULL);
    assert(options != NULL && options->jobs >= 1 && options->jobs <= SWEEP_MOST_JOBS);
    assert(options->share.part >= (options->share.parts > 0) &&
           options->share.part <= options->share.parts);
    double now = clock_seconds(CLOCK_MONOTONIC);
    sweep_execution e = {s, store, options, progress, .start = now, .committed = now};
    *progress = (sweep_progress){.total = s->run_count};

    // what an earlier call has computed is not computed again
    unsigned char *present = malloc(s->run_count);
    if (present == NULL) {
        return fault_no_memory(f);
    }

    // the rest is computed
    size_t stored;
    status code = sweep_store_present(store, present, &stored, f);
    if (code == STATUS_OK) {
        keep_to_share(&e, present);
        code = run_missing(&e, present, f);
        report(&e);
    }
    free(present);
    return code;
}
