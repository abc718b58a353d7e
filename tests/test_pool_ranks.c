// A pool's work on several ranks, here threads that send each other messages: each piece once,
// and what goes wrong on one rank is said by the leader.
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "src/study/pool_ranks.h"
#include "tests/check.h"

enum { RANKS = 3, PIECES = 500, MOST_MESSAGES = 64 };

// --- messages between threads -------------------------------------------------------------------

typedef struct letter {
    int from;
    size_t size;
    void *bytes;
} letter;

// The messages for a rank, in order.
typedef struct mailbox {
    pthread_mutex_t lock;
    pthread_cond_t news;
    letter letters[MOST_MESSAGES];
    int first, count;
} mailbox;

static mailbox boxes[RANKS];

// Of the thread's requests for memory the one that is refused, 0 for none; the linker puts these in
// the place of the allocator's functions.
static _Thread_local int refused;

static bool refuses(void)
{
    return refused > 0 && --refused == 0;
}

void *__real_malloc(size_t size);
void *__wrap_malloc(size_t size);
void *__wrap_malloc(size_t size)
{
    return refuses() ? NULL : __real_malloc(size);
}

void *__real_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_calloc(size_t count, size_t size)
{
    return refuses() ? NULL : __real_calloc(count, size);
}

static void send_letter(void *context, int to, const void *bytes, size_t size)
{
    const int from = *(const int *)context;
    letter l = {.from = from, .size = size, .bytes = __real_malloc(size)};
    if (l.bytes == NULL) {
        abort();
    }
    memcpy(l.bytes, bytes, size);

    mailbox *b = &boxes[to];
    pthread_mutex_lock(&b->lock);
    if (b->count == MOST_MESSAGES) {
        abort();
    }
    b->letters[(b->first + b->count++) % MOST_MESSAGES] = l;
    pthread_cond_signal(&b->news);
    pthread_mutex_unlock(&b->lock);
}

// How many times the thread is still told that nothing has come, even if something has.
static _Thread_local int deaf;

static bool wait_for_letter(void *context, double seconds, int *from, size_t *size)
{
    if (deaf > 0) {
        deaf--;
        return false;
    }
    mailbox *b = &boxes[*(const int *)context];
    struct timespec until;
    clock_gettime(CLOCK_REALTIME, &until);
    const double end = (double)until.tv_sec + 1e-9 * (double)until.tv_nsec + seconds;
    until.tv_sec = (time_t)end;
    until.tv_nsec = (long)(1e9 * (end - (double)until.tv_sec));

    pthread_mutex_lock(&b->lock);
    bool late = seconds == 0;
    while (b->count == 0 && !late) {
        late = pthread_cond_timedwait(&b->news, &b->lock, &until) != 0;
    }
    const bool there = b->count > 0;
    if (there) {
        *from = b->letters[b->first].from;
        *size = b->letters[b->first].size;
    }
    pthread_mutex_unlock(&b->lock);
    return there;
}

static void take_letter(void *context, int from, void *bytes, size_t size)
{
    mailbox *b = &boxes[*(const int *)context];
    pthread_mutex_lock(&b->lock);
    letter l = b->letters[b->first];
    b->first = (b->first + 1) % MOST_MESSAGES;
    b->count--;
    pthread_mutex_unlock(&b->lock);

    if (l.from != from || l.size != size) {
        abort();
    }
    memcpy(bytes, l.bytes, size);
    free(l.bytes);
}

// --- the work -----------------------------------------------------------------------------------

// What all ranks do, and what became of it.
typedef struct tally {
    atomic_int computed[PIECES];
    double results[PIECES];
    int collected, fail_at, ticks, ticks_between;
    bool slow, tick_fails;
    volatile sig_atomic_t stop;
} tally;

static void compute(void *context, size_t i, void *scratch, void *result)
{
    tally *t = context;
    (void)scratch;
    t->computed[i]++;
    if (t->slow) {
        nanosleep(&(struct timespec){.tv_nsec = 2000000}, NULL);
    }
    *(double *)result = sqrt((double)i);
}

static status collect(void *context, size_t i, const void *result, fault *f)
{
    tally *t = context;
    t->results[i] = *(const double *)result;
    t->collected++;
    return t->collected == t->fail_at ? fault_set(f, STATUS_CANNOT_WRITE, "piece %zu", i)
                                      : STATUS_OK;
}

static status tick(void *context, bool over, fault *f)
{
    tally *t = context;
    t->ticks += over;
    t->ticks_between += !over;
    return t->tick_fails ? fault_set(f, STATUS_CANNOT_WRITE, "no news") : STATUS_OK;
}

// What a rank does with the work of one test.
typedef struct rank {
    int number, gone;
    int refused, deaf, refused_at_end; // set for its thread
    bool dismissed, absent;            // absent: it ends without having come to the work
    char identity[RANK_IDENTITY];
    pool_work work;
    rank_group group;
    status code;
    fault fault;
    unsigned char *done;
} rank;

static void *run_rank(void *context)
{
    rank *r = context;
    refused = r->refused;
    deaf = r->deaf;
    if (!r->absent) {
        r->code = pool_run_on_ranks(&r->work, r->done, &r->group, r->identity, &r->fault);
    }
    refused = r->refused_at_end;
    deaf = r->deaf;
    ranks_part(&r->group);
    refused = 0;
    return NULL;
}

static void prepare(rank *ranks, tally *t)
{
    memset(ranks, 0, RANKS * sizeof *ranks);
    for (int i = 0; i < RANKS; i++) {
        rank *r = &ranks[i];
        boxes[i] = (mailbox){.count = 0};
        pthread_mutex_init(&boxes[i].lock, NULL);
        pthread_cond_init(&boxes[i].news, NULL);
        r->number = i;
        strcpy(r->identity, "the same work");
        r->work = (pool_work){.context = t,
                              .count = PIECES,
                              .result_size = sizeof(double),
                              .compute = compute,
                              .collect = collect,
                              .tick = tick,
                              .stop = &t->stop};
        r->group = (rank_group){.rank = i,
                                .count = RANKS,
                                .context = &r->number,
                                .send = send_letter,
                                .wait = wait_for_letter,
                                .receive = take_letter,
                                .dismissed = &r->dismissed,
                                .gone = &r->gone};
    }
}

static void run_threads(rank *ranks)
{
    pthread_t threads[RANKS];
    for (int i = 1; i < RANKS; i++) {
        assert_int_equal(pthread_create(&threads[i], NULL, run_rank, &ranks[i]), 0);
    }
    run_rank(&ranks[0]);
    for (int i = 1; i < RANKS; i++) {
        pthread_join(threads[i], NULL);
    }
}

// Runs all ranks to their ends, with nothing left behind.
static void run_all(rank *ranks)
{
    run_threads(ranks);
    for (int i = 0; i < RANKS; i++) {
        assert_int_equal(boxes[i].count, 0);
        assert_true(i == 0 || ranks[i].dismissed);
        pthread_mutex_destroy(&boxes[i].lock);
        pthread_cond_destroy(&boxes[i].news);
    }
    assert_int_equal(ranks[0].gone, RANKS - 1);
}

static void every_piece_that_is_wanted_is_computed_once(void **state)
{
    (void)state;
    static tally t;
    unsigned char done[PIECES] = {0};
    rank ranks[RANKS];
    memset(&t, 0, sizeof t);
    for (int i = 0; i < PIECES; i += 7) {
        done[i] = 1;
    }
    prepare(ranks, &t);
    ranks[0].done = done;
    run_all(ranks);

    for (int i = 0; i < RANKS; i++) {
        assert_int_equal(ranks[i].code, STATUS_OK);
    }
    for (int i = 0; i < PIECES; i++) {
        assert_int_equal(t.computed[i], done[i] ? 0 : 1);
        check_close(t.results[i], done[i] ? 0 : sqrt(i), 0);
    }
    assert_int_equal(t.ticks, 1);
}

static void a_rank_with_other_work_is_told(void **state)
{
    (void)state;
    static tally t;
    rank ranks[RANKS];
    memset(&t, 0, sizeof t);
    prepare(ranks, &t);
    strcpy(ranks[2].identity, "other work");
    run_all(ranks);
    assert_int_equal(ranks[0].code, STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(ranks[0].fault.text, "rank 2 has other work than rank 0"));
}

static void a_rank_that_does_not_come_is_told(void **state)
{
    (void)state;
    static tally t;
    rank ranks[RANKS];
    memset(&t, 0, sizeof t);
    prepare(ranks, &t);
    ranks[1].absent = true;
    run_all(ranks);
    assert_int_equal(ranks[0].code, STATUS_BAD_ARGUMENT);
    assert_non_null(strstr(ranks[0].fault.text, "rank 1 ended before the work was over"));
}

// What one rank cannot collect ends the work of all, and is what the leader returns.
static void a_failure_ends_the_work(void **state)
{
    (void)state;
    static tally t;
    rank ranks[RANKS];
    memset(&t, 0, sizeof t);
    t.fail_at = 5;
    prepare(ranks, &t);
    run_all(ranks);
    assert_int_equal(ranks[0].code, STATUS_CANNOT_WRITE);
    assert_int_equal(t.collected, 5);
    assert_int_equal(t.ticks, 0);
}

static void a_stop_before_the_first_piece_leaves_all_of_them(void **state)
{
    (void)state;
    static tally t;
    rank ranks[RANKS];
    memset(&t, 0, sizeof t);
    t.stop = 1;
    prepare(ranks, &t);
    run_all(ranks);
    assert_int_equal(ranks[0].code, STATUS_OK);
    assert_int_equal(t.collected, 0);
    assert_int_equal(t.ticks, 1);
}

// Of several that went wrong the first is what is said.
static void the_first_failure_is_told(void **state)
{
    (void)state;
    static tally t;
    rank ranks[RANKS];
    for (int absent = 0; absent < 2; absent++) {
        memset(&t, 0, sizeof t);
        prepare(ranks, &t);
        for (int i = 1; i < RANKS; i++) {
            ranks[i].absent = absent;
            strcpy(ranks[i].identity, "other work");
        }
        run_all(ranks);
        assert_int_equal(ranks[0].code, STATUS_BAD_ARGUMENT);
        assert_non_null(strstr(ranks[0].fault.text, absent ? "ended before" : "other work"));
    }
}

// A rank without memory ends, and the leader says so; without the leader there is no work.
static void memory_that_is_refused_is_told(void **state)
{
    (void)state;
    static tally t;
    rank ranks[RANKS];
    for (int request = 1; request <= 2; request++) {
        memset(&t, 0, sizeof t);
        prepare(ranks, &t);
        ranks[1].refused = request;
        run_all(ranks);
        assert_int_equal(ranks[1].code, STATUS_NO_MEMORY);
        assert_int_equal(ranks[0].code, STATUS_BAD_ARGUMENT);
        assert_non_null(strstr(ranks[0].fault.text, "rank 1 ended before the work was over"));
    }
    for (int request = 1; request <= 4; request++) {
        memset(&t, 0, sizeof t);
        prepare(ranks, &t);
        ranks[0].refused = request;
        run_all(ranks);
        assert_int_equal(ranks[0].code, STATUS_NO_MEMORY);
        assert_int_equal(ranks[1].code, STATUS_STOPPED);
        assert_int_equal(t.collected, 0);
    }
}

// A leader that has no memory for the last words leaves; the others have been let go.
static void a_leader_without_memory_still_lets_all_go(void **state)
{
    (void)state;
    static tally t;
    rank ranks[RANKS];
    memset(&t, 0, sizeof t);
    prepare(ranks, &t);
    ranks[0].refused_at_end = 1;
    run_threads(ranks);
    assert_int_equal(ranks[0].code, STATUS_OK);
    assert_int_equal(t.collected, PIECES);
    assert_true(ranks[0].gone < RANKS - 1);
    for (int i = 0; i < RANKS; i++) {
        mailbox *b = &boxes[i];
        assert_true(i == 0 || ranks[i].dismissed);
        for (int k = 0; k < b->count; k++) {
            free(b->letters[(b->first + k) % MOST_MESSAGES].bytes);
        }
        pthread_mutex_destroy(&b->lock);
        pthread_cond_destroy(&b->news);
    }
}

// Waiting may end without news, and there may be nobody who ticks or stops.
static void waiting_in_vain_loses_nothing(void **state)
{
    (void)state;
    static tally t;
    rank ranks[RANKS];
    memset(&t, 0, sizeof t);
    prepare(ranks, &t);
    for (int i = 0; i < RANKS; i++) {
        ranks[i].deaf = 3;
        ranks[i].work.tick = NULL;
        ranks[i].work.stop = NULL;
    }
    run_all(ranks);
    assert_int_equal(ranks[0].code, STATUS_OK);
    assert_int_equal(t.collected, PIECES);
}

// Somebody hears of a long work every tenth of a second, and may end it.
static void progress_is_told_on_the_way(void **state)
{
    (void)state;
    static tally t;
    rank ranks[RANKS];
    for (int fails = 0; fails < 2; fails++) {
        memset(&t, 0, sizeof t);
        t.slow = true;
        t.tick_fails = fails;
        prepare(ranks, &t);
        run_all(ranks);
        assert_true(fails ? t.ticks_between == 1 : t.ticks_between >= 1);
        assert_int_equal(ranks[0].code, fails ? STATUS_CANNOT_WRITE : STATUS_OK);
        assert_int_equal(t.ticks, fails ? 0 : 1);
        assert_true(fails ? t.collected < PIECES : t.collected == PIECES);
    }
}

// The next work after the leader has let go is none.
static void who_was_let_go_does_not_begin(void **state)
{
    (void)state;
    static tally t;
    rank ranks[RANKS];
    prepare(ranks, &t);
    ranks[1].dismissed = true;
    assert_int_equal(pool_run_on_ranks(&ranks[1].work, NULL, &ranks[1].group, ranks[1].identity,
                                       &ranks[1].fault),
                     STATUS_STOPPED);
    assert_int_equal(boxes[0].count, 0);
}

int main(void)
{
    alarm(120); // where somebody waits for what never comes, this fails
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_piece_that_is_wanted_is_computed_once),
        cmocka_unit_test(a_rank_with_other_work_is_told),
        cmocka_unit_test(a_rank_that_does_not_come_is_told),
        cmocka_unit_test(a_failure_ends_the_work),
        cmocka_unit_test(a_stop_before_the_first_piece_leaves_all_of_them),
        cmocka_unit_test(the_first_failure_is_told),
        cmocka_unit_test(memory_that_is_refused_is_told),
        cmocka_unit_test(a_leader_without_memory_still_lets_all_go),
        cmocka_unit_test(waiting_in_vain_loses_nothing),
        cmocka_unit_test(progress_is_told_on_the_way),
        cmocka_unit_test(who_was_let_go_does_not_begin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
