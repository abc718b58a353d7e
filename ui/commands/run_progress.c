#include "ui/commands/run_progress.h"

#include <assert.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "src/base/clock.h"

#define FIRST_NOTE 1.0 // after this work is worth a word [s]
#define NEXT_NOTE  0.2 // [s]

static run_monitor watched; // one work at a time; the signal handler needs it

// The thread that shows the progress.
static struct ticker {
    const char *pieces; // of the work; NULL: it is one run
    int total;          // of them
    double duration;    // of the run [s]
    bool ticks;         // the thread is there
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t ended;
    bool over;               // under the lock
    struct sigaction before; // what an interrupt did
} ticker;

static void on_interrupt(int number)
{
    (void)number;
    atomic_store_explicit(&watched.stop, true, memory_order_relaxed);
}

static void tell(const struct ticker *t)
{
    if (t->pieces != NULL) {
        fprintf(stderr, "\rimpactlab: %d of %d %s (^C stops) ",
                atomic_load_explicit(&watched.pieces, memory_order_relaxed), t->total, t->pieces);
    } else {
        fprintf(stderr, "\rimpactlab: %.*f of %g s (^C stops) ", t->duration < 10 ? 3 : 1,
                atomic_load_explicit(&watched.time, memory_order_relaxed), t->duration);
    }
    fflush(stderr);
}

// Tells now and then how far the work is, and takes its words away at the end.
static void *tick(void *argument)
{
    struct ticker *t = argument;
    bool told = false;
    struct timespec next = clock_after(FIRST_NOTE);
    pthread_mutex_lock(&t->lock);

    // a note now and then until the work is over
    while (!t->over) {
        if (pthread_cond_timedwait(&t->ended, &t->lock, &next) != 0) {
            tell(t);
            told = true;
            next = clock_after(NEXT_NOTE);
        }
    }

    pthread_mutex_unlock(&t->lock);
    if (told) {
        fprintf(stderr, "\r%60s\r", "");
        fflush(stderr);
    }
    return NULL;
}

// The thread of the notes, which is not to take the interrupt.
static void start_ticking(void)
{
    sigset_t interrupt, mask;
    sigemptyset(&interrupt);
    sigaddset(&interrupt, SIGINT);
    pthread_sigmask(SIG_BLOCK, &interrupt, &mask);
    ticker.ticks = pthread_create(&ticker.thread, NULL, tick, &ticker) == 0;
    pthread_sigmask(SIG_SETMASK, &mask, NULL);
}

static void begin(const arguments *a)
{
    struct sigaction act = {.sa_handler = on_interrupt, .sa_flags = (int)SA_RESETHAND};
    pthread_condattr_t steady;
    watched = (run_monitor){.stop = false};
    ticker.over = ticker.ticks = false;
    pthread_mutex_init(&ticker.lock, NULL);
    pthread_condattr_init(&steady);
    pthread_condattr_setclock(&steady, CLOCK_MONOTONIC);
    pthread_cond_init(&ticker.ended, &steady);
    pthread_condattr_destroy(&steady);

    // an interrupt ends the work in order; where it is ignored it stays so
    sigaction(SIGINT, &act, &ticker.before);
    if (ticker.before.sa_handler == SIG_IGN) {
        sigaction(SIGINT, &ticker.before, NULL);
    }
    if (isatty(STDERR_FILENO) && !a->quiet) {
        start_ticking();
    }
}

run_monitor *work_begin(const arguments *a, const char *pieces, int total)
{
    assert(a != NULL && pieces != NULL && total > 0);
    ticker.pieces = pieces;
    ticker.total = total;
    begin(a);
    return &watched;
}

void work_end(void)
{
    // the notes end before anything else is printed
    pthread_mutex_lock(&ticker.lock);
    ticker.over = true;
    pthread_cond_signal(&ticker.ended);
    pthread_mutex_unlock(&ticker.lock);
    if (ticker.ticks) {
        pthread_join(ticker.thread, NULL);
    }

    sigaction(SIGINT, &ticker.before, NULL);
    pthread_mutex_destroy(&ticker.lock);
    pthread_cond_destroy(&ticker.ended);
}

status run_with_progress(const arguments *a, const scenario *s, bool keep_trace, run_result *result)
{
    assert(a != NULL && s != NULL && result != NULL);
    const run_options options = {.keep_trace = keep_trace, .monitor = &watched};
    ticker.pieces = NULL;
    ticker.duration = s->parameters.run.duration;
    begin(a);
    const status code = run_scenario_with(s, &options, result);
    work_end();
    return code;
}

void work_leave(int done, int total, const char *pieces, const char *what_became)
{
    assert(pieces != NULL && what_became != NULL);
    complain("stopped: %d of %d %s were done, %s", done, total, pieces, what_became);
    leave_interrupted();
}

void leave_interrupted(void)
{
    fflush(NULL);
    signal(SIGINT, SIG_DFL);
    raise(SIGINT);
    abort(); // not reached: nothing catches it any more
}
