// Pieces of work on several threads: each once, in any order of finishing.
#include "tests/check.h"

#include <pthread.h>
#include <stdatomic.h>

#include "src/study/pool.h"

enum {
    PIECES = 1000,
    QUEUE = 256 // results that wait for the calling thread at most
};

typedef struct tally {
    double results[PIECES];
    int collected[PIECES], total;
    atomic_int computed;
    int fail_at; // pieces after which collecting fails, 0: never
    int ticks, last_ticks;
    volatile sig_atomic_t stop;
} tally;

static void compute(void *context, size_t i, void *scratch, void *result)
{
    tally *t = context;
    int *calls = scratch;
    t->computed++;
    (*calls)++;
    *(double *)result = sqrt((double)i);
}

static status collect(void *context, size_t i, const void *result, fault *f)
{
    tally *t = context;
    t->results[i] = *(const double *)result;
    t->collected[i]++;
    t->total++;
    return t->fail_at > 0 && t->total == t->fail_at
               ? fault_set(f, STATUS_CANNOT_WRITE, "piece %zu", i)
               : STATUS_OK;
}

static status tick(void *context, bool over, fault *f)
{
    tally *t = context;
    (void)f;
    t->ticks++;
    t->last_ticks += over;
    return STATUS_OK;
}

static pool_work work_on(tally *t)
{
    return (pool_work){.context = t,
                       .count = PIECES,
                       .scratch_size = sizeof(int),
                       .result_size = sizeof(double),
                       .compute = compute,
                       .collect = collect,
                       .tick = tick,
                       .stop = &t->stop};
}

// What is left of a tally when the work was done on so many threads.
static tally ran_on(int threads, tally t)
{
    pool_work w = work_on(&t);
    assert_int_equal(pool_run(&w, threads, NULL), STATUS_OK);
    return t;
}

// Each piece was computed and collected once.
static void check_complete(const tally *t)
{
    assert_int_equal(t->computed, PIECES);
    assert_int_equal(t->total, PIECES);
    assert_int_equal(t->last_ticks, 1);
    for (int i = 0; i < PIECES; i++) {
        assert_int_equal(t->collected[i], 1);
        check_close(t->results[i], sqrt(i), 0);
    }
}

// The linker puts this in the place of the C library's (-Wl,--wrap=pthread_create, see
// meson.build): of the threads asked for only so many are to be had.
static int threads_left = 1000;
static int started, joined; // threads, since the test set them to 0
int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*function)(void *), void *argument);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*function)(void *), void *argument);
int __wrap_pthread_create(pthread_t *thread, const pthread_attr_t *attributes,
                          void *(*function)(void *), void *argument)
{
    if (threads_left-- <= 0) {
        return EAGAIN;
    }
    started++;
    return __real_pthread_create(thread, attributes, function, argument);
}

// Joining is watched only.
int __real_pthread_join(pthread_t thread, void **result);
int __wrap_pthread_join(pthread_t thread, void **result);
int __wrap_pthread_join(pthread_t thread, void **result)
{
    joined++;
    return joined <= started ? __real_pthread_join(thread, result) : ESRCH;
}

// Each thread that there was is waited for, once, however many were to be had.
TEST(every_thread_is_joined_once)
{
    for (int asked = 1; asked <= 8; asked++) {
        for (int left = 0; left <= asked + 1; left++) {
            tally t = {.fail_at = asked == 3 ? 5 : 0, .stop = asked == 5};
            pool_work w = work_on(&t);
            threads_left = left;
            started = joined = 0;
            assert_int_equal(pool_run(&w, asked, NULL),
                             t.fail_at > 0 ? STATUS_CANNOT_WRITE : STATUS_OK);
            assert_int_equal(started, left < asked ? left : asked);
            assert_int_equal(joined, started);
        }
    }
    threads_left = 1000;
    started = joined = 0;
}

TEST(every_piece_is_computed_and_collected_once)
{
    for (int threads = 1; threads <= POOL_MOST_THREADS; threads *= threads < 8 ? 2 : 32) {
        const tally t = ran_on(threads, (tally){0});
        check_complete(&t);
    }
}

TEST(a_failure_ends_the_work_and_is_returned)
{
    tally t = {.fail_at = 10};
    pool_work w = work_on(&t);
    REFUSED(STATUS_CANNOT_WRITE, "piece", pool_run(&w, 4, &f));
    assert_int_equal(t.total, 10);
    assert_true(t.computed <=
                2 * QUEUE + 4); // what was there when it failed and what came then
}

TEST(a_stop_ends_it_early_without_a_fault)
{
    const tally t = ran_on(2, (tally){.stop = 1});
    // what was under way is collected, all the rest is left
    assert_int_equal(t.total, t.computed);
    assert_true(t.computed <= QUEUE + 2);
}

static void compute_slowly(void *context, size_t i, void *scratch, void *result)
{
    usleep(250000);
    compute(context, i, scratch, result);
}

// A piece may take longer than the calling thread waits before it looks again.
TEST(a_slow_piece_is_waited_for)
{
    tally t = {.fail_at = 0};
    pool_work w = work_on(&t);
    w.count = 1;
    w.compute = compute_slowly;
    assert_int_equal(pool_run(&w, 1, NULL), STATUS_OK);
    assert_int_equal(t.total, 1);
    assert_int_equal(t.last_ticks, 1);
}

// One thread is the calling one, unless that has ticks to give meanwhile.
TEST(one_thread_without_ticks_is_the_calling_one)
{
    for (int ticks = 0; ticks < 2; ticks++) {
        tally t = {.fail_at = 0};
        pool_work w = work_on(&t);
        w.tick = ticks > 0 ? tick : NULL;
        started = 0;
        assert_int_equal(pool_run(&w, 1, NULL), STATUS_OK);
        assert_int_equal(started, ticks);
        assert_int_equal(t.total, PIECES);
    }
}

TEST(no_pieces_are_no_work)
{
    tally t = {.fail_at = 0};
    pool_work w = work_on(&t);
    w.count = 0;
    assert_int_equal(pool_run(&w, 2, NULL), STATUS_OK);
    assert_int_equal(t.total, 0);
    assert_int_equal(t.last_ticks, 1);
}

// Without a single thread to be had the calling one does everything, in order.
TEST(the_work_is_done_without_threads)
{
    for (int left = 0; left < 3; left++) {
        threads_left = left;
        const tally t = ran_on(left == 0 ? 1 : 4, (tally){0});
        check_complete(&t);
        assert_true(left > 0 || t.ticks == PIECES + 1); // after each, and at the end
    }

    // failures and stops end it at once
    tally failing = {.fail_at = 10};
    pool_work w = work_on(&failing);
    threads_left = 0;
    REFUSED(STATUS_CANNOT_WRITE, "", pool_run(&w, 4, &f));
    assert_int_equal(failing.total, 10);
    assert_int_equal(failing.computed, 10);
    threads_left = 0;
    const tally stopped = ran_on(4, (tally){.stop = 1});
    assert_int_equal(stopped.computed, 0);
    assert_int_equal(stopped.last_ticks, 1);
    threads_left = 1000;
}

ALL_IN_TWO_MINUTES
