#include "src/study/batch.h"

#include <string.h>

#include "src/study/pool.h"

// What a thread keeps.
typedef struct batch_scratch {
    scenario made[RUN_TOGETHER];
    run_result runs[RUN_TOGETHER];
    side_by_side *storage;
} batch_scratch;

typedef struct batch {
    batch_maker make;
    void *context;
    summary *summaries;
    size_t count;
} batch;

// A piece of work: RUN_TOGETHER runs, or what is left of them.
static size_t piece_length(const batch *b, size_t piece)
{
    size_t left = b->count - piece * RUN_TOGETHER;
    return left < RUN_TOGETHER ? left : RUN_TOGETHER;
}

static void compute(void *context, size_t piece, void *scratch, void *result)
{
    const batch *b = context;
    batch_scratch *own = scratch;
    scenario *made = own->made;
    run_result *runs = own->runs;
    summary *summaries = result;
    const size_t length = piece_length(b, piece);

    // each made from the one before
    for (size_t i = 0; i < length; i++) {
        // filled with that of the call before: the last one of a piece is, as pieces are full
        made[i] = made[i > 0 ? i - 1 : RUN_TOGETHER - 1];
        b->make(b->context, piece * RUN_TOGETHER + i, &made[i]);
    }

    run_together(made, (int)length, NULL, runs, &own->storage);
    for (size_t i = 0; i < length; i++) {
        summaries[i] = runs[i].summary;
        run_finish(&runs[i]);
    }
}

static void release(void *scratch)
{
    batch_scratch *own = scratch;
    side_by_side_destroy(own->storage);
}

static status collect(void *context, size_t piece, const void *result, fault *f)
{
    const batch *b = context;
    (void)f;
    memcpy(b->summaries + piece * RUN_TOGETHER, result, piece_length(b, piece) * sizeof(summary));
    return STATUS_OK;
}

status batch_run(batch_maker make, void *context, size_t count, int jobs, summary *summaries)
{
    batch b = {.make = make, .context = context, .summaries = summaries, .count = count};
    const pool_work work = {.context = &b,
                            .count = (count + RUN_TOGETHER - 1) / RUN_TOGETHER,
                            .scratch_size = sizeof(batch_scratch),
                            .result_size = RUN_TOGETHER * sizeof(summary),
                            .compute = compute,
                            .collect = collect,
                            .release = release};
    jobs = jobs < 1 ? 1 : jobs > POOL_MOST_THREADS ? POOL_MOST_THREADS : jobs;
    return pool_run(&work, jobs, NULL);
}
