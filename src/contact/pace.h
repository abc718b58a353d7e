// The pace of a motion: detects strides so short that the run would practically never end.
#pragma once

#include "src/base/fault.h"
#include "src/contact/contact_machine.h"

enum {
    PACE_STRIDES = 1 << 16, // between two checks at most; more than any short phase takes
    PACE_CAUSE_SIZE = 240   // characters that pace_tell_cause writes at most
};

typedef struct pace {
    long strides;      // since the last check
    long due;          // of them at which to check again
    long touching;     // of them, those that ended in contact
    double checked_at; // instant of the last check, -1 before the first stride [s]
} pace;

// The pace of a motion before its first stride.
pace pace_begin(void);

// Checks the progress since the last check: STATUS_NO_PROGRESS, with a sentence that names the
// cause, if at this pace a run of that duration [s], or one second of it, would take tens of
// millions of strides. A time step of the requested length `asked` [s] that takes fewer than a
// thousand strides is always accepted.
status pace_check(pace *p, const arm *a, const motion *m, double duration, double asked, fault *f);

// Writes into `text` what of the arm or the wall makes strides short, or lets events follow one
// another without time passing, and which parameter to change. `last` is the event that the motion
// has just had, MOTION_REACHED if none.
void pace_tell_cause(const arm *a, const motion *m, motion_event last, char *text, size_t size);

// Counts a stride that was just made, and checks the pace every so many of them: fewer of arms
// whose strides are expensive, so that a run without progress ends after some seconds.
static inline status pace_keep(pace *p, const arm *a, const motion *m, double duration,
                               double asked, fault *f)
{
    p->strides++;
    p->touching += m->state[SLOT_CONTACT] != 0;
    const bool is_due = p->checked_at < 0 || p->strides >= p->due;
    return is_due ? pace_check(p, a, m, duration, asked, f) : STATUS_OK;
}
