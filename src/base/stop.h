// What ends long work before its end: a flag that somebody sets, or a question that is
// asked.
#pragma once

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

// Set where the program is to end: every run ends that nobody else can stop.
extern atomic_bool stop_everything;

typedef struct stop_request {
    const atomic_bool
        *flag; // becomes true where the work is to end; NULL: nobody sets one
    int (*ask)(void *context); // other than 0: it is to end; NULL: nobody is asked
    void *context;
    int looks,
        due;      // since it was asked; so many of them are due before the clock is read
    double asked; // when it was asked last [s]
} stop_request;

// Whether the flag is set.
static inline bool stop_is_set(const stop_request *s)
{
    return s->flag != NULL && atomic_load_explicit(s->flag, memory_order_relaxed);
}

// Asks where it is time for it, every 2.5 ms as far as that many looks took as long
// before. s->ask is there.
bool stop_ask(stop_request *s);

// Whether the work is to end, looked at between its steps; on the thread that does it.
static inline bool stop_requested(stop_request *s)
{
    return stop_is_set(s) || (s->ask != NULL && stop_ask(s));
}
