#include "src/study/pool_ranks.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/clock.h"

#define TICK_INTERVAL 0.1 // [s]
#define PORTION_TIME  0.1 // that a portion of pieces is to take [s]
#define PATIENCE      1.0 // for a message, before it is waited for again [s]

enum {
    MOST_PIECES = 64, // of a portion
    IN_HAND = 2       // portions of a rank: one in work, one waiting
};

// What a message is about; every message begins with a head.
typedef enum message_kind {
    MESSAGE_BEGINS,  // to 0: a rank has come to the work; its identity follows
    MESSAGE_PORTION, // from 0: `count` pieces follow
    MESSAGE_RESULTS, // to 0: `count` pieces and their results follow
    MESSAGE_OVER,    // from 0: nothing is left of this work
    MESSAGE_ENDS,    // to 0: a rank ends
    MESSAGE_DISMISS  // from 0: nothing is left at all
} message_kind;

typedef struct message_head {
    message_kind kind;
    int count;
    double seconds; // RESULTS: that they took
} message_head;

typedef struct message {
    message_head head;
    size_t pieces[MOST_PIECES];
} message;

static void send_head(const rank_group *g, int to, message_kind kind)
{
    const message_head head = {.kind = kind};
    g->send(g->context, to, &head, sizeof head);
}

// --- a rank that computes ---------------------------------------------------------------------

// Computes a portion and sends its results: head, pieces, then `count` results.
static void compute_portion(const pool_work *w, const rank_group *g, const message *portion,
                            void *scratch, char *answer)
{
    const double start = clock_seconds(CLOCK_MONOTONIC);
    const int count = portion->head.count;
    char *results = answer + sizeof(message);
    for (int i = 0; i < count; i++) {
        w->compute(w->context, portion->pieces[i], scratch, results + (size_t)i * w->result_size);
    }

    message *m = (message *)answer;
    *m = *portion;
    m->head.kind = MESSAGE_RESULTS;
    m->head.seconds = clock_seconds(CLOCK_MONOTONIC) - start;
    g->send(g->context, 0, answer, sizeof *m + (size_t)count * w->result_size);
}

// Computes what comes until the work is over.
static status follow(const pool_work *w, const rank_group *g, const char *identity, fault *f)
{
    char begins[sizeof(message_head) + RANK_IDENTITY] = "";
    const message_head head = {.kind = MESSAGE_BEGINS};
    void *scratch = calloc(1, w->scratch_size + 1);
    char *answer = malloc(sizeof(message) + MOST_PIECES * w->result_size);
    status code = scratch != NULL && answer != NULL ? STATUS_OK : fault_no_memory(f);
    bool over = code != STATUS_OK || *g->dismissed;

    // a rank that cannot work ends before it begins, which the leader notices
    if (!over) {
        memcpy(begins, &head, sizeof head);
        memcpy(begins + sizeof head, identity, RANK_IDENTITY);
        g->send(g->context, 0, begins, sizeof begins);
    }
    while (!over) {
        int from;
        size_t size;
        message m = {.head = {.kind = MESSAGE_OVER}};
        if (!g->wait(g->context, PATIENCE, &from, &size)) {
            continue;
        }
        assert(size <= sizeof m);
        g->receive(g->context, from, &m, size);
        if (m.head.kind == MESSAGE_PORTION) {
            compute_portion(w, g, &m, scratch, answer);
        } else {
            over = true;
            *g->dismissed = m.head.kind == MESSAGE_DISMISS;
        }
    }

    pool_release_scratch(w, scratch);
    free(answer);
    return code == STATUS_OK && *g->dismissed ? STATUS_STOPPED : code;
}

// --- the one that leads -----------------------------------------------------------------------

// What rank 0 knows of the others.
typedef struct led_rank {
    bool begun, gone; // gone: it has said that it ends
    int in_hand;      // portions
} led_rank;

typedef struct leader {
    const pool_work *work;
    const unsigned char *done; // pieces that are not wanted, NULL: all are
    const rank_group *group;
    const char *identity;
    led_rank *ranks; // by number; 0 is unused
    size_t next;     // the first piece that may be wanted
    double each;     // a piece took on the average of late, 0: not known [s]
    char *buffer;    // for a message with results
    status code;
    fault *fault;
} leader;

// The next piece that is wanted; false if there is none.
static bool next_piece(leader *l, size_t *piece)
{
    const pool_work *w = l->work;
    const bool closed = l->code != STATUS_OK || (w->stop != NULL && *w->stop);
    while (l->next < w->count && l->done != NULL && l->done[l->next]) {
        l->next++;
    }
    if (closed || l->next >= w->count) {
        return false;
    }
    *piece = l->next++;
    return true;
}

// Gives a rank work, as long as there is any.
static void feed(leader *l, int rank)
{
    led_rank *r = &l->ranks[rank];
    const int wanted = l->each > 0 ? (int)fmax(1, fmin(MOST_PIECES, PORTION_TIME / l->each)) : 1;
    while (r->in_hand < IN_HAND) {
        message m = {.head = {.kind = MESSAGE_PORTION}};
        while (m.head.count < wanted && next_piece(l, &m.pieces[m.head.count])) {
            m.head.count++;
        }
        if (m.head.count == 0) {
            break;
        }
        l->group->send(l->group->context, rank, &m, sizeof m);
        r->in_hand++;
    }
}

static void note_time(leader *l, double each)
{
    l->each = l->each > 0 ? 0.8 * l->each + 0.2 * each : each;
}

static void collect(leader *l, size_t piece, const void *result)
{
    if (l->code == STATUS_OK) {
        l->code = l->work->collect(l->work->context, piece, result, l->fault);
    }
}

// Records what is wrong with a rank, unless a fault is recorded already.
static void note_fault(leader *l, int rank, const char *what)
{
    if (l->code == STATUS_OK) {
        l->code = fault_set(l->fault, STATUS_BAD_ARGUMENT, "rank %d %s", rank, what);
    }
}

// Takes a message that waits.
static void take_message(leader *l, int from, size_t size)
{
    const pool_work *w = l->work;
    led_rank *r = &l->ranks[from];
    message m = {.head = {.count = 0}};
    assert(size <= sizeof m + MOST_PIECES * w->result_size);
    l->group->receive(l->group->context, from, l->buffer, size);
    memcpy(&m, l->buffer, size < sizeof m ? size : sizeof m);

    if (m.head.kind == MESSAGE_BEGINS) {
        r->begun = true;
        if (memcmp(l->buffer + sizeof m.head, l->identity, RANK_IDENTITY) != 0) {
            note_fault(l, from,
                       "has other work than rank 0: another version of the program, or another "
                       "scenario on its machine");
        }
        feed(l, from);
    } else if (m.head.kind == MESSAGE_RESULTS) {
        r->in_hand--;
        note_time(l, m.head.seconds / m.head.count);
        for (int i = 0; i < m.head.count; i++) {
            collect(l, m.pieces[i], l->buffer + sizeof m + (size_t)i * w->result_size);
        }
        feed(l, from);
    } else {
        assert(m.head.kind == MESSAGE_ENDS); // the others go the other way
        r->gone = true;
        (*l->group->gone)++;
        note_fault(l, from, "ended before the work was over");
    }
}

// Whether every rank has come and has nothing in hand, or is gone.
static bool all_idle(const leader *l)
{
    for (int i = 1; i < l->group->count; i++) {
        const led_rank *r = &l->ranks[i];
        if (!r->gone && (!r->begun || r->in_hand > 0)) {
            return false;
        }
    }
    return true;
}

// Hands out, computes and collects until all are through.
static void lead(leader *l, void *scratch, void *result)
{
    const pool_work *w = l->work;
    double ticked = clock_seconds(CLOCK_MONOTONIC);
    bool more = true;
    while (more || !all_idle(l)) {
        // what has come first: somebody may be waiting for work
        int from;
        size_t size, piece;
        while (l->group->wait(l->group->context, more ? 0 : TICK_INTERVAL, &from, &size)) {
            take_message(l, from, size);
            if (!more && all_idle(l)) {
                break;
            }
        }

        // then a piece of one's own
        more = next_piece(l, &piece);
        if (more) {
            const double start = clock_seconds(CLOCK_MONOTONIC);
            w->compute(w->context, piece, scratch, result);
            note_time(l, clock_seconds(CLOCK_MONOTONIC) - start);
            collect(l, piece, result);
        }

        const double now = clock_seconds(CLOCK_MONOTONIC);
        if (l->code == STATUS_OK && w->tick != NULL && now - ticked >= TICK_INTERVAL) {
            l->code = w->tick(w->context, false, l->fault);
            ticked = now;
        }
    }

    // only now, as a rank that hears of it may begin with the next work at once
    for (int i = 1; i < l->group->count; i++) {
        if (!l->ranks[i].gone) {
            send_head(l->group, i, MESSAGE_OVER);
        }
    }
    if (l->code == STATUS_OK && w->tick != NULL) {
        l->code = w->tick(w->context, true, l->fault);
    }
}

status pool_run_on_ranks(const pool_work *work, const unsigned char *done, const rank_group *group,
                         const char identity[RANK_IDENTITY], fault *f)
{
    assert(work != NULL && work->compute != NULL && work->collect != NULL && work->result_size > 0);
    assert(group != NULL && identity != NULL);
    if (group->rank > 0) {
        return follow(work, group, identity, f);
    }

    leader l = {.work = work, .done = done, .group = group, .identity = identity, .fault = f};
    void *scratch = calloc(1, work->scratch_size + 1), *result = calloc(1, work->result_size);
    l.ranks = calloc((size_t)group->count, sizeof *l.ranks);
    l.buffer = malloc(sizeof(message) + MOST_PIECES * work->result_size);
    if (scratch != NULL && result != NULL && l.ranks != NULL && l.buffer != NULL) {
        lead(&l, scratch, result);
    } else {
        l.code = fault_no_memory(f);
    }

    pool_release_scratch(work, scratch);
    free(result);
    free(l.ranks);
    free(l.buffer);
    return l.code;
}

// --- the end ----------------------------------------------------------------------------------

void ranks_part(const rank_group *group)
{
    assert(group != NULL);
    char message_bytes[sizeof(message)];
    int from;
    size_t size;

    // a rank says that it ends, and waits until the leader lets it go
    if (group->rank > 0) {
        send_head(group, 0, MESSAGE_ENDS);
        while (!*group->dismissed) {
            if (group->wait(group->context, PATIENCE, &from, &size)) {
                message_head head;
                assert(size <= sizeof message_bytes);
                group->receive(group->context, from, message_bytes, size);
                memcpy(&head, message_bytes, sizeof head);
                *group->dismissed = head.kind == MESSAGE_DISMISS;
            }
        }
        return;
    }

    // the leader lets all go, and hears what they still had to say
    for (int i = 1; i < group->count; i++) {
        send_head(group, i, MESSAGE_DISMISS);
    }
    while (*group->gone < group->count - 1) {
        if (group->wait(group->context, PATIENCE, &from, &size)) {
            message_head head;
            char *bytes = malloc(size);
            if (bytes == NULL) {
                return; // then they are ended with this process
            }
            group->receive(group->context, from, bytes, size);
            memcpy(&head, bytes, sizeof head);
            *group->gone += head.kind == MESSAGE_ENDS;
            free(bytes);
        }
    }
}
