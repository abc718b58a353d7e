#include "src/study/batch.h"

#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

enum { MOST_JOBS = 256, RUNS_AT_ONCE = 16 };

typedef struct batch {
    batch_maker make;
    void *context;
    size_t count;
    summary *summaries;
    atomic_size_t next; // first run that nobody has taken
} batch;

// Takes runs, a few at a time, until there are none.
static void *work(void *argument)
{
    batch *b = argument;
    scenario made;
    memset(&made, 0, sizeof made);
    for (;;) {
        size_t first = atomic_fetch_add(&b->next, RUNS_AT_ONCE);
        if (first >= b->count) {
            return NULL;
        }
        size_t end = first + RUNS_AT_ONCE < b->count ? first + RUNS_AT_ONCE : b->count;
        for (size_t i = first; i < end; i++) {
            run_result result;
            b->make(b->context, i, &made);
            run_scenario(&made, false, &result);
            b->summaries[i] = result.summary;
            run_finish(&result);
        }
    }
}

void batch_run(batch_maker make, void *context, size_t count, int jobs, summary *summaries)
{
    batch b = {.make = make, .context = context, .count = count, .summaries = summaries};
    pthread_t threads[MOST_JOBS];
    int started = 0;
    jobs = jobs < 1 ? 1 : jobs > MOST_JOBS ? MOST_JOBS : jobs;
    while (started < jobs - 1 && pthread_create(&threads[started], NULL, work, &b) == 0) {
        started++;
    }
    work(&b); // the caller's own thread is one of them
    for (int i = 0; i < started; i++) {
        pthread_join(threads[i], NULL);
    }
}
