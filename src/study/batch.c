#include "src/study/batch.h"

#include <stdio.h>

#include "src/base/clock.h"

// What each thread keeps from piece to piece.
typedef struct batch_scratch {
    scenario made[RUN_TOGETHER];
    run_result results[RUN_TOGETHER];
    side_by_side *storage;
} batch_scratch;

// The number of runs in a piece of work: the last piece has what is left of them.
static size_t piece_length(const batch *b, size_t piece)
{
    const size_t left = b->count - piece * b->together;
    if (left < b->together) {
        return left;
    }
    return b->together;
}

// Computes the runs of a piece side by side, and their summaries. A scenario that cannot
// be made has a summary that says why.
static void compute_runs(void *context, size_t piece, void *scratch, void *result)
{
    const batch *b = context;
    const size_t length = piece_length(b, piece);
    batch_scratch *own = scratch;
    summary *summaries = result;
    size_t place[RUN_TOGETHER]; // in the piece, of each scenario that was made
    int made = 0;

    // make the scenarios, which counts in the time of the runs
    const double start = clock_seconds(CLOCK_MONOTONIC);
    const double start_cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    for (size_t i = 0; i < length; i++) {
        fault f = {.path = ""};
        const size_t number = piece * b->together + i;
        place[made] = i;
        if (b->make(b->context, number, &own->made[made], &f) == STATUS_OK) {
            made++;
        } else {
            summary_init(&summaries[i]);
            summaries[i].status = f.code;
            snprintf(summaries[i].message, sizeof summaries[i].message, "%s", f.text);
        }
    }

    run_together(own->made, made, b->abandon, own->results, &own->storage);
    for (int i = 0; i < made; i++) {
        summaries[place[i]] = own->results[i].summary;
        run_finish(&own->results[i]);
    }

    // share the time equally: it cannot be attributed to single runs
    const double cpu = clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start_cpu;
    const double wall = clock_seconds(CLOCK_MONOTONIC) - start;
    for (size_t i = 0; i < length; i++) {
        summaries[i].cpu_time_s = cpu / (double)length;
        summaries[i].wall_time_s = wall / (double)length;
    }
}

static void release_scratch(void *scratch)
{
    batch_scratch *own = scratch;
    side_by_side_destroy(own->storage);
}

// Hands the summaries of a piece to the batch's `take`, or keeps them in its list.
static status collect_runs(void *context, size_t piece, const void *result, fault *f)
{
    const batch *b = context;
    const summary *summaries = result;
    const size_t first = piece * b->together, length = piece_length(b, piece);
    for (size_t i = 0; i < length; i++) {
        if (b->take != NULL) {
            TRY(b->take(b->context, first + i, &summaries[i], f));
        } else {
            b->summaries[first + i] = summaries[i];
        }
    }
    return STATUS_OK;
}

static status count_tick(void *context, bool over, fault *f)
{
    const batch *b = context;
    return b->tick(b->context, over, f);
}

status batch_run(const batch *asked, int jobs, fault *f)
{
    batch b = *asked;
    size_t most = b.together, threads = 1;
    if (most == 0) {
        most = RUN_TOGETHER;
    }
    if (jobs > POOL_MOST_THREADS) {
        threads = POOL_MOST_THREADS;
    } else if (jobs > 1) {
        threads = (size_t)jobs;
    }

    // pieces so small that every thread has one, and no more threads than pieces
    const size_t share = (b.count + threads - 1) / threads;
    if (share < 1) {
        b.together = 1;
    } else if (share < most) {
        b.together = share;
    } else {
        b.together = most;
    }
    const size_t pieces = (b.count + b.together - 1) / b.together;
    size_t wanted = threads;
    if (pieces < 1) {
        wanted = 1;
    } else if (pieces < threads) {
        wanted = pieces;
    }
    const pool_work work = {.context = &b,
                            .count = pieces,
                            .scratch_size = sizeof(batch_scratch),
                            .result_size = b.together * sizeof(summary),
                            .compute = compute_runs,
                            .collect = collect_runs,
                            .tick = b.tick != NULL ? count_tick : NULL,
                            .tick_interval = b.tick_interval,
                            .release = release_scratch,
                            .stop = b.stop};
    return pool_run(&work, (int)wanted, f);
}
