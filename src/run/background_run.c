#include "src/run/background_run.h"

#include <pthread.h>
#include <signal.h>
#include <stdlib.h>
#include <time.h>

struct computation {
    scenario scenario;
    run_options options;
    run_monitor monitor;
    run_result like;   // shared with another run, or empty
    run_likeness same; // the result's and its beginning
    run_result result; // the thread's until it is over; the places of its rows never change
    pthread_t thread;
    bool threaded;
    pthread_mutex_t lock;
    pthread_cond_t ended;
    bool over; // under the lock
};

static void *compute(void *argument)
{
    computation *c = argument;
    run_scenario_with(&c->scenario, &c->options, &c->result);
    c->same = run_compare_rows(&c->result, &c->like);
    pthread_mutex_lock(&c->lock);
    c->over = true;
    pthread_cond_signal(&c->ended);
    pthread_mutex_unlock(&c->lock);
    return NULL;
}

// Starts the thread with all signals blocked but those that a crash raises in it: the others are
// for the thread that waits for input.
static bool start_thread(computation *c)
{
    static const int own[] = {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL};
    sigset_t blocked, before;
    sigfillset(&blocked);
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        sigdelset(&blocked, own[i]);
    }
    pthread_sigmask(SIG_SETMASK, &blocked, &before);
    bool started = pthread_create(&c->thread, NULL, compute, c) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

computation *computation_start(const scenario *s, size_t rows_expected, bool take_up,
                               run_result *begun, const run_result *like, bool at_once)
{
    computation *c = calloc(1, sizeof *c);
    if (c == NULL) {
        return NULL;
    }
    c->scenario = *s;
    c->options = (run_options){.keep_trace = true,
                               .monitor = &c->monitor,
                               .rows_expected = rows_expected,
                               .take_up = take_up};
    if (take_up) {
        c->result = *begun;
    }
    if (like != NULL && run_share(like, rows_expected, &c->like) != STATUS_OK) {
        c->like = (run_result){0}; // then rows are kept twice
    }
    pthread_condattr_t clock;
    pthread_condattr_init(&clock);
    pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
    pthread_mutex_init(&c->lock, NULL);
    pthread_cond_init(&c->ended, &clock);
    pthread_condattr_destroy(&clock);
    c->threaded = !at_once && start_thread(c);
    if (!c->threaded) {
        compute(c);
    }
    return c;
}

bool computation_wait(computation *c, double seconds)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    double whole = floor(seconds);
    until.tv_sec += (time_t)whole;
    until.tv_nsec += (long)(1e9 * (seconds - whole));
    if (until.tv_nsec >= 1000000000) {
        until.tv_sec++;
        until.tv_nsec -= 1000000000;
    }
    pthread_mutex_lock(&c->lock);
    int late = 0;
    while (!c->over && late == 0) {
        late = pthread_cond_timedwait(&c->ended, &c->lock, &until);
    }
    bool over = c->over;
    pthread_mutex_unlock(&c->lock);
    return over;
}

size_t computation_look(computation *c, run_result *view)
{
    size_t rows = atomic_load_explicit(&c->monitor.rows, memory_order_acquire);
    if (rows > 0) {
        const trace *t = &c->result.trace;
        view->trace = (trace){.rows = t->rows,
                              .angles = t->angles,
                              .velocities = t->velocities,
                              .events = t->events,
                              .angle_count = t->angle_count,
                              .row_count = rows};
        view->trace.event_count = atomic_load_explicit(&c->monitor.events, memory_order_acquire);
    }
    return rows;
}

double computation_time(computation *c)
{
    return atomic_load_explicit(&c->monitor.time, memory_order_relaxed);
}

void computation_stop(computation *c)
{
    atomic_store_explicit(&c->monitor.stop, true, memory_order_relaxed);
}

run_result computation_finish(computation *c)
{
    if (c->threaded) {
        pthread_join(c->thread, NULL);
    }
    run_result result = c->result;
    // here, where the caller reads no rows
    run_merge(&result, &c->like, &c->same);
    run_finish(&c->like);
    pthread_mutex_destroy(&c->lock);
    pthread_cond_destroy(&c->ended);
    free(c);
    return result;
}
