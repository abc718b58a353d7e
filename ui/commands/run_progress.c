#include "ui/commands/run_progress.h"

#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

#include "src/base/clock.h"

#define FIRST_NOTE 1.0 // after this a run is worth a word [s]
#define NEXT_NOTE  0.2 // [s]

static run_monitor watched; // one run at a time; the signal handler needs it

typedef struct ticker {
    double duration; // of the run [s]
    pthread_mutex_t lock;
    pthread_cond_t ended;
    bool over; // under the lock
} ticker;

static void on_interrupt(int number)
{
    (void)number;
    atomic_store_explicit(&watched.stop, true, memory_order_relaxed);
}

// Tells now and then how far the run is, and takes its words away at the end.
static void *tick(void *argument)
{
    ticker *t = argument;
    bool told = false;
    struct timespec next = clock_after(FIRST_NOTE);
    pthread_mutex_lock(&t->lock);

    // a note now and then until the run is over
    while (!t->over) {
        if (pthread_cond_timedwait(&t->ended, &t->lock, &next) == 0) {
            continue;
        }

        double time = atomic_load_explicit(&watched.time, memory_order_relaxed);
        fprintf(stderr, "\rimpactlab: %.*f of %g s (^C stops) ", t->duration < 10 ? 3 : 1, time,
                t->duration);
        fflush(stderr);
        told = true;
        next = clock_after(NEXT_NOTE);
    }

    pthread_mutex_unlock(&t->lock);

    if (told) {
        fprintf(stderr, "\r%60s\r", "");
        fflush(stderr);
    }
    return NULL;
}

status run_with_progress(const scenario *s, bool keep_trace, run_result *result)
{
    if (!isatty(STDERR_FILENO)) {
        return run_scenario(s, keep_trace, result);
    }

    const run_options options = {.keep_trace = keep_trace, .monitor = &watched};
    ticker t = {.duration = s->parameters.run.duration};
    struct sigaction act = {.sa_handler = on_interrupt, .sa_flags = (int)SA_RESETHAND}, before;
    sigset_t interrupt, mask;
    pthread_condattr_t steady;
    pthread_t thread;

    // an interrupt ends the run in order; where it is ignored it stays so
    atomic_store(&watched.stop, false);
    pthread_mutex_init(&t.lock, NULL);
    pthread_condattr_init(&steady);
    pthread_condattr_setclock(&steady, CLOCK_MONOTONIC);
    pthread_cond_init(&t.ended, &steady);
    pthread_condattr_destroy(&steady);
    sigaction(SIGINT, &act, &before);
    if (before.sa_handler == SIG_IGN) {
        sigaction(SIGINT, &before, NULL);
    }

    // the thread of the notes is not to take the interrupt
    sigemptyset(&interrupt);
    sigaddset(&interrupt, SIGINT);
    pthread_sigmask(SIG_BLOCK, &interrupt, &mask);
    bool ticks = pthread_create(&thread, NULL, tick, &t) == 0;
    pthread_sigmask(SIG_SETMASK, &mask, NULL);

    status code = run_scenario_with(s, &options, result);

    // the notes end before anything else is printed
    pthread_mutex_lock(&t.lock);
    t.over = true;
    pthread_cond_signal(&t.ended);
    pthread_mutex_unlock(&t.lock);
    if (ticks) {
        pthread_join(thread, NULL);
    }

    sigaction(SIGINT, &before, NULL);
    pthread_mutex_destroy(&t.lock);
    pthread_cond_destroy(&t.ended);
    return code;
}

void run_progress_leave(void)
{
    fflush(NULL);
    signal(SIGINT, SIG_DFL);
    raise(SIGINT);
}
