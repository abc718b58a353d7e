#include "src/study/batch.h"

#include <assert.h>

#include "src/study/pool.h"

typedef struct batch {
    batch_maker make;
    void *context;
    summary *summaries;
} batch;

static void compute(void *context, size_t i, void *scratch, void *result)
{
    const batch *b = context;
    scenario *made = scratch;
    run_result run;
    b->make(b->context, i, made);
    run_scenario(made, false, &run);
    *(summary *)result = run.summary;
    run_finish(&run);
}

static status collect(void *context, size_t i, const void *result, fault *f)
{
    const batch *b = context;
    (void)f;
    b->summaries[i] = *(const summary *)result;
    return STATUS_OK;
}

status batch_run(batch_maker make, void *context, size_t count, int jobs, summary *summaries)
{
    assert(make != NULL && (summaries != NULL || count == 0));
    batch b = {.make = make, .context = context, .summaries = summaries};
    const pool_work work = {.context = &b,
                            .count = count,
                            .scratch_size = sizeof(scenario),
                            .result_size = sizeof(summary),
                            .compute = compute,
                            .collect = collect};
    jobs = jobs < 1 ? 1 : jobs > POOL_MOST_THREADS ? POOL_MOST_THREADS : jobs;
    return pool_run(&work, jobs, NULL);
}
