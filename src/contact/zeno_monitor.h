// The Zeno monitor: detects internal steps so short that the run would practically never
// end.
#pragma once

#include "src/base/fault.h"
#include "src/contact/contact_machine.h"

enum {
    ZENO_STEPS = 1 << 16, // between two checks at most; more than any short phase takes
    ZENO_CAUSE_SIZE = 240 // characters that zeno_monitor_cause writes at most
};

typedef struct zeno_monitor {
    long steps;        // since the last check
    long due;          // of them at which to check again
    long touching;     // of them, those that ended in contact
    double checked_at; // instant of the last check, -1 before the first internal step [s]
} zeno_monitor;

// The monitor of a motion before its first internal step.
zeno_monitor zeno_monitor_begin(void);

// Checks the progress since the last check: STATUS_NO_PROGRESS, with a sentence that
// names the cause, if at this rate a run of that duration [s], or one second of it, would
// take tens of millions of internal steps. A time step of the requested length `asked`
// [s] that takes fewer than a thousand internal steps is always accepted.
status zeno_monitor_check(zeno_monitor *p, const arm *a, const motion *m, double duration,
                          double asked, fault *f);

// Writes into `text` what of the arm or the wall makes internal steps short, or lets
// events follow one another without time passing, and which parameter to change. `last`
// is the event that the motion has just had, MOTION_REACHED if none.
void zeno_monitor_cause(const arm *a, const motion *m, motion_event last, char *text,
                        size_t size);

// Counts an internal step that was just made, and checks every so many of them: fewer of
// arms whose internal steps are expensive, so that a run without progress ends after some
// seconds.
static inline status zeno_monitor_count(zeno_monitor *p, const arm *a, const motion *m,
                                        double duration, double asked, fault *f)
{
    p->steps++;
    p->touching += m->state[SLOT_CONTACT] != 0;
    const bool is_due = p->checked_at < 0 || p->steps >= p->due;
    return is_due ? zeno_monitor_check(p, a, m, duration, asked, f) : STATUS_OK;
}
