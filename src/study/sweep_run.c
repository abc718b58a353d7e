#include "src/study/sweep_run.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "src/base/clock.h"
#include "src/study/batch.h"

#define COMMIT_INTERVAL 0.5 // [s]

// The numbers of a share as they come.
typedef struct quantity_column {
    sweep_share share;
    double *values;
} quantity_column;

// A sweep_value_taker.
static bool take_value(void *context, size_t run, double value)
{
    const quantity_column *c = context;
    const size_t step = c->share.parts > 0 ? (size_t)c->share.parts : 1;
    c->values[run / step] = value;
    return true;
}

status sweep_quantity(sweep_store *store, size_t run_count, sweep_share share,
                      const char *key, double *values, size_t *failed, fault *f)
{
    quantity_column column = {share, values};
    for (size_t i = 0; i < sweep_share_count(share, run_count); i++) {
        values[i] = (double)NAN;
    }
    return store->values(store, share, key, take_value, &column, failed, f);
}

// A sweep being computed; all but what is to be computed, and how, is the calling
// thread's.
typedef struct sweep_execution {
    const sweep *sweep;
    sweep_store *store;
    const sweep_options *options;
    sweep_progress *progress;
    struct gap *gaps; // the runs of the share that are missing, in order
    size_t gap_count;
    size_t next; // place in the share behind the last run that is there
    size_t missing;
    double start, committed; // instants by the clock [s]
} sweep_execution;

// Runs that are missing, one behind the other in the share of the sweep.
typedef struct gap {
    size_t first;  // place in the share
    size_t before; // how many are missing before it
} gap;

// Adds the gap up to place `end`, if there is one. False without memory.
static bool add_gap(sweep_execution *e, size_t end)
{
    const size_t first = e->next;
    e->next = end + 1;
    if (first == end) {
        return true;
    }

    // room for twice as many whenever it is full
    if ((e->gap_count & (e->gap_count - 1)) == 0) {
        gap *more = realloc(e->gaps, (2 * e->gap_count + 1) * sizeof *more);
        if (more == NULL) {
            return false;
        }
        e->gaps = more;
    }
    e->gaps[e->gap_count++] = (gap){first, e->missing};
    e->missing += end - first;
    return true;
}

// A sweep_value_taker.
static bool take_present(void *context, size_t run, double value)
{
    const sweep_share share = ((sweep_execution *)context)->options->share;
    (void)value;
    if (share.parts > 0) {
        run /= (size_t)share.parts;
    }
    return add_gap(context, run);
}

// Finds what of a share of `total` runs an earlier call has not computed.
static status find_missing(sweep_execution *e, size_t total, fault *f)
{
    if (e->store->count > 0) {
        TRY(e->store->values(e->store, e->options->share, "run", take_present, e, NULL,
                             f));
    }
    const bool whole = e->next <= total && add_gap(e, total);
    if (whole) {
        return STATUS_OK;
    }
    return fault_no_memory(f);
}

// The number of the i-th missing run.
static size_t missing_run(const sweep_execution *e, size_t i)
{
    size_t low = 0, high = e->gap_count;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        if (e->gaps[middle].before <= i) {
            low = middle;
        } else {
            high = middle;
        }
    }
    const gap *found = &e->gaps[low];
    return sweep_share_run(e->options->share, found->first + i - found->before);
}

static status make_sweep_run(void *context, size_t i, scenario *made, fault *f)
{
    const sweep_execution *e = context;
    return sweep_scenario(e->sweep, missing_run(e, i), made, f);
}

static status store_run(void *context, size_t i, const summary *s, fault *f)
{
    sweep_execution *e = context;
    sweep_progress *p = e->progress;
    const size_t run = missing_run(e, i);
    if (s->status == STATUS_STOPPED) {
        return STATUS_OK; // it was passed over
    }

    // what says nothing about the scenario may be otherwise the next time
    FAULT_IF(s->status == STATUS_NO_MEMORY || s->status == STATUS_NOT_ALLOWED ||
                 s->status == STATUS_CANNOT_READ,
             f, s->status, "run %zu: %s", run + 1, s->message);

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

static void report_progress(const sweep_execution *e)
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
        report_progress(e); // the end is reported in any case, see sweep_run
    }
    return code;
}

// Whether every run of the sweep is of a kind that gains by being computed side by side,
// and short: two links, by the event method, under no law from outside the program.
static bool runs_are_light(const sweep *s)
{
    static const char *const decisive[] = {"arm.model",    "arm.links",
                                           "method.name",  "run.duration",
                                           "control.law",  "control.plugin",
                                           "control.rate", "control.command"};
    const parameters *p = &s->base->parameters;
    for (int i = 0; i < s->axis_count; i++) {
        for (size_t k = 0; k < sizeof decisive / sizeof decisive[0]; k++) {
            if (s->axes[i].parameter == parameter_index(decisive[k])) {
                return false;
            }
        }
    }
    return p->arm.model != ARM_PRINTED && p->arm.links == 2 &&
           p->method.name == METHOD_EVENT && p->control.law != LAW_PLUGIN &&
           p->control.law != LAW_PROCESS;
}

// Computes what of the share an earlier call has not.
static status run_missing(sweep_execution *e, fault *f)
{
    const double duration = e->sweep->base->parameters.run.duration;
    sweep_progress *p = e->progress;
    p->total = sweep_share_count(e->options->share, e->sweep->run_count);
    TRY(find_missing(e, p->total, f));
    p->done = p->total - e->missing;

    // heavy runs go one by one: none of them is to wait for another to be stored, or to
    // hold up the end of a sweep that is stopped
    size_t together = 1;
    if (runs_are_light(e->sweep)) {
        together = (size_t)fmax(1, RUN_TOGETHER / fmax(duration, 1));
    }
    const batch missing = {.context = e,
                           .count = e->missing,
                           .make = make_sweep_run,
                           .take = store_run,
                           .together = together,
                           .tick = commit_and_report,
                           .stop = e->options->stop,
                           .abandon = e->options->abandon};
    return batch_run(&missing, e->options->jobs, f);
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

    const status code = run_missing(&e, f);
    free(e.gaps);
    report_progress(&e);
    return code;
}
