#include "src/run/background_run.h"

#include <assert.h>
#include <pthread.h>
#include <stdlib.h>

#include "src/base/clock.h"

struct background_run {
    scenario scenario;
    run_options options;
    run_monitor monitor;
    run_result result; // written by the thread until it ends; its rows never move
    pthread_t thread;
    bool runs; // the thread has yet to be joined
};

// What the thread does: it computes the whole run.
static void *compute(void *argument)
{
    background_run *c = argument;
    run_scenario_with(&c->scenario, &c->options, &c->result);
    return NULL;
}

background_run *background_run_start(const scenario *s, const background_options *how,
                                     run_result *begun)
{
    assert(how->rows_expected > 0);
    background_run *c = calloc(1, sizeof *c);
    if (c == NULL) {
        return NULL;
    }

    // the scenario and its options; a run that is resumed has the rows begun earlier
    c->scenario = *s;
    c->options = (run_options){.keep_trace = true,
                               .monitor = &c->monitor,
                               .rows_expected = how->rows_expected,
                               .resume = begun != NULL};
    if (begun != NULL) {
        c->result = *begun;
    }

    // signals are for the calling thread, which waits for input: they are blocked while
    // the new thread is created, as that inherits the mask
    sigset_t before;
    worker_signals_block(&before);
    c->runs = !how->at_once && pthread_create(&c->thread, NULL, compute, c) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);

    // without a thread of its own the run is computed here
    if (!c->runs) {
        compute(c);
    }
    return c;
}

bool background_run_wait(background_run *c, double seconds)
{
    const struct timespec until = clock_after(seconds);
    c->runs =
        c->runs && pthread_clockjoin_np(c->thread, NULL, CLOCK_MONOTONIC, &until) != 0;
    return !c->runs;
}

size_t background_run_look(background_run *c, run_result *view)
{
    size_t rows = atomic_load_explicit(&c->monitor.rows, memory_order_acquire);

    // the rows that are counted are complete and never move, so that the view needs no
    // lock
    if (rows > 0) {
        const trace *t = &c->result.trace;
        view->trace = (trace){.rows = t->rows,
                              .angles = t->angles,
                              .velocities = t->velocities,
                              .events = t->events,
                              .angle_count = t->angle_count,
                              .row_count = rows};
        view->trace.event_count =
            atomic_load_explicit(&c->monitor.events, memory_order_acquire);
    }
    return rows;
}

void background_run_stop(background_run *c)
{
    atomic_store_explicit(&c->monitor.stop, true, memory_order_relaxed);
}

run_result background_run_finish(background_run *c)
{
    if (c->runs) {
        pthread_join(c->thread, NULL);
    }
    const run_result result = c->result;
    free(c);
    return result;
}

void worker_signals_block(sigset_t *before)
{
    static const int crashes[] = {SIGSEGV, SIGABRT, SIGFPE, SIGBUS,
                                  SIGILL,  SIGTRAP, SIGSYS};
    sigset_t blocked;
    sigfillset(&blocked);
    for (size_t i = 0; i < sizeof crashes / sizeof crashes[0]; i++) {
        sigdelset(&blocked, crashes[i]);
    }
    pthread_sigmask(SIG_SETMASK, &blocked, before);
}
