// Many independent pieces of work on several threads, their results collected on the
// calling one.
//
// Piece i depends on i alone, so results depend neither on the number of threads nor on
// the order in which they finish.
#pragma once

#include <signal.h>
#include <stdbool.h>
#include <stddef.h>

#include "src/base/fault.h"

enum { POOL_MOST_THREADS = 256 };

typedef struct pool_work {
    void *context;
    size_t count; // pieces 0 ... count - 1
    size_t
        scratch_size; // storage that each thread keeps for itself, at first zeros [bytes]
    size_t result_size; // of a piece's result [bytes]

    // Computes piece i; called from several threads at once.
    void (*compute)(void *context, size_t i, void *scratch, void *result);

    // Takes a result, in the order in which pieces finish; on the calling thread. After a
    // failure pieces in hand are finished, and nothing more is collected.
    status (*collect)(void *context, size_t i, const void *result, fault *f);

    // Called on the calling thread about every tick_interval [s] (0: ten times a second),
    // and once at the end; may be NULL. Fails as collect does.
    status (*tick)(void *context, bool over, fault *f);
    double tick_interval;

    // Frees what compute keeps in a thread's scratch; NULL if that is nothing.
    void (*release)(void *scratch);

    const volatile sig_atomic_t *stop; // becomes true to end early; NULL if nothing does
} pool_work;

// Does the work on up to `threads` threads (1 ... POOL_MOST_THREADS), which leave signals
// to the calling one; on the calling one if none can be started, or if one is enough and
// there is no tick. Returns when all threads have ended: what collect or tick returned,
// STATUS_OK also when stopped, or STATUS_NO_MEMORY.
status pool_run(const pool_work *work, int threads, fault *f);
