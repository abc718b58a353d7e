#include "src/study/pool.h"

#include <assert.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/clock.h"
#include "src/run/background_run.h"

#define TICK_INTERVAL 0.1 // [s]

enum { LONGEST_QUEUE = 256 };

// What the threads share. The mutex guards everything that changes; the first finished
// piece is the calling thread's until it is collected.
typedef struct pool {
    const pool_work *work;
    pthread_mutex_t mutex;
    pthread_cond_t
        changed; // a piece was finished, or room was made, or a thread has ended
    size_t next; // the first piece that no thread has taken
    int working; // threads that have not ended
    bool stop;
    size_t *pieces; // finished ones, in a ring
    char *results;  // of each
    int room;       // places of the ring
    int first;      // place of the first finished piece
    int finished;   // finished pieces in the ring
} pool;

typedef struct pool_thread {
    pool *pool;
    pthread_t thread;
    void *scratch, *result;
} pool_thread;

// The next piece that is wanted; false if there is none. The mutex is held.
static bool next_piece(pool *p, size_t *piece)
{
    const pool_work *w = p->work;
    if (p->stop || p->next >= w->count) {
        return false;
    }
    *piece = p->next++;
    return true;
}

// A thread: takes pieces until there are no more, and hands over their results.
static void *work_on_pieces(void *argument)
{
    pool_thread *self = argument;
    pool *p = self->pool;
    const pool_work *w = p->work;
    size_t piece;

    // the mutex is released while a piece is computed
    pthread_mutex_lock(&p->mutex);
    while (next_piece(p, &piece)) {
        pthread_mutex_unlock(&p->mutex);
        w->compute(w->context, piece, self->scratch, self->result);
        pthread_mutex_lock(&p->mutex);

        // hand the result over as soon as the ring has room
        while (p->finished == p->room) {
            pthread_cond_wait(&p->changed, &p->mutex);
        }
        const int at = (p->first + p->finished++) % p->room;
        p->pieces[at] = piece;
        memcpy(p->results + (size_t)at * w->result_size, self->result, w->result_size);
        pthread_cond_broadcast(&p->changed);
    }
    p->working--;
    pthread_cond_broadcast(&p->changed);
    pthread_mutex_unlock(&p->mutex);
    return NULL;
}

static double tick_interval(const pool_work *w)
{
    if (w->tick_interval > 0) {
        return w->tick_interval;
    }
    return TICK_INTERVAL;
}

// Waits for a finished piece, for one tick at most. Returns its place in the ring, or -1
// if there is none. *more is false if all threads have ended and no piece is left.
static int wait_for_piece(pool *p, bool stop, bool *more)
{
    const struct timespec until = clock_after(tick_interval(p->work));
    pthread_mutex_lock(&p->mutex);
    p->stop = p->stop || stop;
    int waited = 0;
    while (p->finished == 0 && p->working > 0 && waited == 0) {
        waited = pthread_cond_timedwait(&p->changed, &p->mutex, &until);
    }
    const int at = p->finished > 0 ? p->first : -1;
    *more = at >= 0 || p->working > 0;
    pthread_mutex_unlock(&p->mutex);
    return at;
}

static bool asked_to_stop(const pool_work *w)
{
    return w->stop != NULL && *w->stop;
}

// Collects what the threads finish until they have ended. After a failure they are only
// waited for.
static status collect_results(pool *p, fault *f)
{
    const pool_work *w = p->work;
    status code = STATUS_OK;
    double ticked = clock_seconds(CLOCK_MONOTONIC);
    for (bool more = true; more;) {
        const int at = wait_for_piece(p, code != STATUS_OK || asked_to_stop(w), &more);
        if (at >= 0 && code == STATUS_OK) {
            code = w->collect(w->context, p->pieces[at],
                              p->results + (size_t)at * w->result_size, f);
        }
        if (at >= 0) {
            pthread_mutex_lock(&p->mutex);
            p->first = (at + 1) % p->room;
            if (p->finished-- == p->room) {
                pthread_cond_broadcast(&p->changed);
            }
            pthread_mutex_unlock(&p->mutex);
        }

        // a tick now and then, and one at the end
        double now = clock_seconds(CLOCK_MONOTONIC);
        if (code == STATUS_OK && w->tick != NULL &&
            (!more || now - ticked >= tick_interval(w))) {
            code = w->tick(w->context, !more, f);
            ticked = now;
        }
    }
    return code;
}

// Does all the work on the calling thread.
static status work_alone(pool *p, pool_thread *self, fault *f)
{
    const pool_work *w = p->work;
    status code = STATUS_OK;
    size_t piece;
    while (code == STATUS_OK && !asked_to_stop(w) && next_piece(p, &piece)) {
        w->compute(w->context, piece, self->scratch, self->result);
        code = w->collect(w->context, piece, self->result, f);
        if (code == STATUS_OK && w->tick != NULL) {
            code = w->tick(w->context, false, f);
        }
    }
    if (code == STATUS_OK && w->tick != NULL) {
        return w->tick(w->context, true, f);
    }
    return code;
}

// Starts up to `wanted` threads, in which signals are blocked: the calling thread gets
// them. Returns how many were started.
static int start_threads(pool *p, pool_thread *threads, int wanted)
{
    sigset_t before;
    int started = 0;
    worker_signals_block(&before);

    // none ends before their number is known
    pthread_mutex_lock(&p->mutex);
    while (started < wanted && pthread_create(&threads[started].thread, NULL,
                                              work_on_pieces, &threads[started]) == 0) {
        started++;
    }
    p->working = started;
    pthread_mutex_unlock(&p->mutex);

    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

// Allocates the ring of finished pieces and each thread's storage; false without memory.
static bool allocate(pool *p, pool_thread *threads, int count)
{
    const pool_work *w = p->work;
    if (w->count < LONGEST_QUEUE) {
        p->room = (int)w->count + 1;
    } else {
        p->room = LONGEST_QUEUE;
    }
    p->pieces = malloc((size_t)p->room * sizeof *p->pieces);
    p->results = malloc((size_t)p->room * w->result_size); // may be many megabytes
    bool allocated = p->pieces != NULL && p->results != NULL;
    for (int i = 0; i < count && allocated; i++) {
        threads[i].pool = p;
        threads[i].scratch = calloc(1, w->scratch_size + 1);
        threads[i].result = calloc(1, w->result_size);
        allocated = threads[i].scratch != NULL && threads[i].result != NULL;
    }
    return allocated;
}

// Frees what `allocate` gave.
static void free_threads(pool *p, pool_thread *threads, int count)
{
    for (int i = 0; i < count; i++) {
        if (p->work->release != NULL && threads[i].scratch != NULL) {
            p->work->release(threads[i].scratch);
        }
        free(threads[i].scratch);
        free(threads[i].result);
    }
    free(p->pieces);
    free(p->results);
}

status pool_run(const pool_work *work, int threads, fault *f)
{
    assert(work->result_size > 0 && threads >= 1 && threads <= POOL_MOST_THREADS);
    pool p = {.work = work};
    pool_thread each[POOL_MOST_THREADS] = {0};
    status code;

    // waiting is by a clock that nobody sets
    pthread_condattr_t monotonic;
    pthread_mutex_init(&p.mutex, NULL);
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&p.changed, &monotonic);
    pthread_condattr_destroy(&monotonic);

    // on threads, or on this one if there are none to be had
    if (allocate(&p, each, threads)) {
        // a single thread that nobody waits for while it computes is this one
        const bool alone = threads == 1 && work->tick == NULL;
        int started = 0;
        if (!alone) {
            started = start_threads(&p, each, threads);
        }
        if (started > 0) {
            code = collect_results(&p, f);
        } else {
            code = work_alone(&p, &each[0], f);
        }
        for (int i = 0; i < started; i++) {
            pthread_join(each[i].thread, NULL);
        }
    } else {
        code = fault_no_memory(f);
    }

    free_threads(&p, each, threads);
    pthread_cond_destroy(&p.changed);
    pthread_mutex_destroy(&p.mutex);
    return code;
}
