// Traces compared to the last bit.
#pragma once

#include "src/run/trace.h"
#include "tests/check.h"

// Fails unless the first `count` events of both traces have the same bits in every field;
// the bytes between fields mean nothing.
static inline void check_same_events(const trace *a, const trace *b, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const event *x = &a->events[i], *y = &b->events[i];
        double of_x[] = {x->time, x->impulse, x->speed, x->loss};
        double of_y[] = {y->time, y->impulse, y->speed, y->loss};
        fail_if(memcmp(of_x, of_y, sizeof of_x) != 0 || x->kind != y->kind ||
                    x->index != y->index || x->delivered_by_step != y->delivered_by_step,
                "event %zu, %s at %.17g s, is %s at %.17g s in the other trace", i,
                event_name(x->kind), x->time, event_name(y->kind), y->time);
    }
}
