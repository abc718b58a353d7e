// Several processes that do one piece of work together, on one machine or many (MPI): what the pool
// needs of them. Rank 0 leads, hands out pieces and keeps results; the others compute.
#pragma once

#include <stdbool.h>
#include <stddef.h>

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

// Ends the group's work, on every rank before it ends: the leader dismisses those that still wait
// for work, and no message is left behind.
void ranks_part(const rank_group *group);
