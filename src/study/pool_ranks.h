// The pool's work done by several processes, on one machine or many (MPI). Rank 0 leads, hands out
// pieces and keeps results; the others compute.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/study/pool.h"

// What the pool needs of the processes.
typedef struct rank_group {
    int rank, count; // this process's number, from 0, and how many there are
    void *context;   // of the functions

    // Sends a message; returns when its bytes may change.
    void (*send)(void *context, int to, const void *bytes, size_t size);

    // Waits for a message, from whomever, but not longer than `seconds`. False if there is none.
    bool (*wait)(void *context, double seconds, int *from, size_t *size);

    // Takes the message that `wait` told of.
    void (*receive)(void *context, int from, void *bytes, size_t size);

    bool *dismissed; // of a rank other than 0: the leader needs it no more
    int *gone;       // of rank 0: how many others have said that they end
} rank_group;

enum { RANK_IDENTITY = 65 }; // of the text that says what the work is, with the zero behind it

// Does the work on all ranks of the group, each of which calls this with the same work: pieces go
// out in small portions as they are asked for, and results are collected, in the order in which
// they arrive, on rank 0, which computes as well. Other ranks collect nothing and need no
// work->done. A result is sent as its bytes: what points into a process means nothing to another.
//
// Returns on rank 0 as pool_run does; STATUS_BAD_ARGUMENT, with a sentence, if a rank's work has
// another identity (an other version, or another scenario on its machine) or it ended before it
// began. On the others STATUS_OK when there is nothing left, STATUS_STOPPED if they were dismissed.
status pool_run_on_ranks(const pool_work *work, const unsigned char *done, const rank_group *group,
                         const char identity[RANK_IDENTITY], fault *f);

// Ends the group's work, on every rank before it ends: the leader dismisses those that still wait
// for work, and no message is left behind.
void ranks_part(const rank_group *group);
