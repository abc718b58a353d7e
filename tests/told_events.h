// What the events of a run say is in contact and what sticks is what its rows say: no
// contact ends or begins without one, whatever ends it, and so it is with friction.
#pragma once

#include "src/run/run_result.h"

// The first event that contradicts those before it; the last one where the last row does;
// NULL if none does. The run has rows.
static inline const event *contradicting_event(const run_result *r)
{
    const trace *t = &r->trace;
    const sample *last = &t->rows[t->row_count - 1];
    bool contact = false, sticks = t->rows[0].sticking != 0;
    for (size_t i = 0; i < t->event_count; i++) {
        const event_kind kind = t->events[i].kind;
        const bool goes_on = i > 0 && t->events[i - 1].kind == EVENT_IMPACT;
        if ((kind == EVENT_CONTACT && contact && !goes_on) ||
            (kind == EVENT_RELEASE && !contact) || (kind == EVENT_STICK && sticks) ||
            (kind == EVENT_SLIP && !sticks)) {
            return &t->events[i];
        }
        contact = kind == EVENT_CONTACT || (contact && kind != EVENT_RELEASE);
        sticks = kind == EVENT_STICK || (sticks && kind != EVENT_SLIP);
    }
    const bool same = contact == (last->contact != 0) && sticks == (last->sticking != 0);
    return same || t->event_count == 0 ? NULL : &t->events[t->event_count - 1];
}
