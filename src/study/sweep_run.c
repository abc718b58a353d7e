#include "src/study/sweep_run.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "src/base/clock.h"
#include "src/run/run.h"
#include "src/study/pool.h"

#define COMMIT_INTERVAL 0.5 // [s]

// A sweep being computed; all but what is to be computed, and how, is the calling thread's.
typedef struct sweep_execution {
    const sweep *sweep;
    sweep_store *store;
    const sweep_options *options;
    sweep_progress *progress;
    size_t *wanted;          // the runs that are missing, in order
    size_t count, together;  // of them; so many make a piece of work
    double start, committed; // instants by the clock [s]
} sweep_execution;

// What a thread needs for a piece.
typedef struct piece_scratch {
    scenario derived[RUN_TOGETHER];
    run_result results[RUN_TOGETHER];
    side_by_side *storage;
} piece_scratch;

// How many runs a piece of work has: the last one what is left.
static size_t piece_length(const sweep_execution *e, size_t piece)
{
    const size_t left = e->count - piece * e->together;
    return left < e->together ? left : e->together;
}

// Computes the runs of a piece side by side.
static void compute_piece(void *context, size_t piece, void *scratch, void *result)
{
    const sweep_execution *e = context;
    const size_t length = piece_length(e, piece), *runs = e->wanted + piece * e->together;
    piece_scratch *own = scratch;
    summary *summaries = result;
    size_t place[RUN_TOGETHER]; // of each scenario that goes together
    int begun = 0;

    // the times of this thread, deriving the scenarios included
    const double start = clock_seconds(CLOCK_MONOTONIC),
                 start_cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    for (size_t i = 0; i < length; i++) {
        fault f = {.path = ""};
        place[begun] = i;
        if (sweep_scenario(e->sweep, runs[i], &own->derived[begun], &f) == STATUS_OK) {
            begun++;
        } else {
            summary_init(&summaries[i]);
            summaries[i].status = f.code;
            snprintf(summaries[i].message, sizeof summaries[i].message, "%s", f.text);
        }
    }

    run_together(own->derived, begun, e->options->abandon, own->results, &own->storage);
    for (int i = 0; i < begun; i++) {
        summaries[place[i]] = own->results[i].summary;
        run_finish(&own->results[i]);
    }

    // the time cannot be attributed to single runs
    const double cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start_cpu;
    const double wall = clock_seconds(CLOCK_MONOTONIC) - start;
    for (size_t i = 0; i < length; i++) {
        summaries[i].cpu_time_s = cpu / (double)length;
        summaries[i].wall_time_s = wall / (double)length;
        summaries[i].path = NULL; // nobody reads it, and it means nothing to another process
    }
}

static void release_piece(void *scratch)
{
    piece_scratch *own = scratch;
    side_by_side_destroy(own->storage);
}

static status store_run(sweep_execution *e, size_t run, const summary *s, fault *f)
{
    // what says nothing about the scenario may be otherwise the next time
    sweep_progress *p = e->progress;
    FAIL_IF(s->status == STATUS_NO_MEMORY || s->status == STATUS_NOT_ALLOWED ||
                s->status == STATUS_CANNOT_READ,
            fault_set(f, s->status, "run %zu: %s", run + 1, s->message));

    // stored, and counted once it is
    TRY(e->store->put(e->store, run, s, f));
    p->done++;
    p->done_now++;
    if (s->status == STATUS_OK) {
        return STATUS_OK;
    }

    // what the first of the failed runs says, whichever was computed first
    if (p->failed++ == 0 || run < p->first_failed) {
        p->first_failed = run;
        snprintf(p->first_failure, sizeof p->first_failure, "%s", s->message);
    }
    return STATUS_OK;
}

static status store_piece(void *context, size_t piece, const void *result, fault *f)
{
    sweep_execution *e = context;
    const summary *summaries = result;
    for (size_t i = 0; i < piece_length(e, piece); i++) {
        const bool passed_over = summaries[i].status == STATUS_STOPPED;
        TRY(passed_over ? STATUS_OK
                        : store_run(e, e->wanted[piece * e->together + i], &summaries[i], f));
    }
    return STATUS_OK;
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
        code = e->store->commit(e->store, f);
        e->committed = clock_seconds(CLOCK_MONOTONIC);
    }
    if (!over) {
        report(e); // the end is reported in any case, see sweep_run
    }
    return code;
}

// Whether every run of the sweep is of a kind that gains by being computed side by side, and short:
// two links, by the event method, under no law from outside the program.
static bool runs_are_light(const sweep *s)
{
    static const char *const decisive[] = {"arm.model",    "arm.links",      "method.name",
                                           "run.duration", "control.law",    "control.plugin",
                                           "control.rate", "control.command"};
    const parameters *p = &s->base->parameters;
    for (int i = 0; i < s->axis_count; i++) {
        for (size_t k = 0; k < sizeof decisive / sizeof decisive[0]; k++) {
            if (s->axes[i].parameter == parameter_index(decisive[k])) {
                return false;
            }
        }
    }
    return p->arm.model != ARM_PRINTED && p->arm.links == 2 && p->method.name == METHOD_EVENT &&
           p->control.law != LAW_PLUGIN && p->control.law != LAW_PROCESS;
}

// How many runs make a piece of work. Heavy ones go one by one: none of them is to wait for another
// to be stored, or to hold up the end of a sweep that is stopped.
static size_t choose_together(const sweep_execution *e, int jobs)
{
    const double duration = e->sweep->base->parameters.run.duration;
    if (!runs_are_light(e->sweep)) {
        return 1;
    }
    const size_t share = (e->count + (size_t)jobs - 1) / (size_t)jobs;
    const size_t most = duration > 1 ? (size_t)fmax(1, RUN_TOGETHER / duration) : RUN_TOGETHER;
    return share < 1 ? 1 : share < most ? share : most;
}

// Computes what of the share is not present.
static status run_missing(sweep_execution *e, const unsigned char *present, fault *f)
{
    sweep_progress *p = e->progress;
    p->total = sweep_share_count(e->options->share, e->sweep->run_count);
    e->wanted = malloc((p->total + 1) * sizeof *e->wanted);
    TRY_MEMORY(e->wanted != NULL, f);
    for (size_t i = 0; i < p->total; i++) {
        const size_t run = sweep_share_run(e->options->share, i);
        p->done += present[run];
        if (!present[run]) {
            e->wanted[e->count++] = run;
        }
    }

    // enough pieces for everybody
    e->together = choose_together(e, e->options->jobs);
    const size_t pieces = (e->count + e->together - 1) / e->together;
    const pool_work work = {.context = e,
                            .count = pieces,
                            .scratch_size = sizeof(piece_scratch),
                            .result_size = e->together * sizeof(summary),
                            .compute = compute_piece,
                            .collect = store_piece,
                            .tick = commit_and_report,
                            .release = release_piece,
                            .stop = e->options->stop};

    // no more threads than pieces
    const int jobs = pieces < (size_t)e->options->jobs ? (int)pieces : e->options->jobs;
    const status code = pool_run(&work, jobs > 0 ? jobs : 1, f);
    free(e->wanted);
    return code;
}

status sweep_run(const sweep *s, sweep_store *store, const sweep_options *options,
                 sweep_progress *progress, fault *f)
{
    assert(options->jobs >= 1 && options->jobs <= SWEEP_MOST_JOBS);
    assert(options->share.part >= (options->share.parts > 0) &&
           options->share.part <= options->share.parts);
    double now = clock_seconds(CLOCK_MONOTONIC);
    sweep_execution e = {.sweep = s,
                         .store = store,
                         .options = options,
                         .progress = progress,
                         .start = now,
                         .committed = now};
    *progress = (sweep_progress){.total = s->run_count};

    // what an earlier call has computed is not computed again
    unsigned char *present = malloc(s->run_count);
    TRY_MEMORY(present != NULL, f);

    // the rest is computed
    size_t stored;
    status code = store->present(store, present, &stored, f);
    if (code == STATUS_OK) {
        code = run_missing(&e, present, f);
        report(&e);
    }
    free(present);
    return code;
}
