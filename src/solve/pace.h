// The pace of a motion: detects strides so short that the run would practically never end.
#pragma once

#include "src/base/fault.h"
#include "src/solve/motion.h"

enum { PACE_STRIDES = 1 << 16 }; // between two checks; more than any short phase takes

typedef struct pace {
    long strides;       // since the last look
    double looked_from; // instant of the last look, -1 before the first stride [s]
} pace;

// The pace of a motion before its first stride.
pace pace_begin(void);

// Checks the progress since the last check: STATUS_NO_PROGRESS, with a sentence that names the
// cause, if at this pace a run of that duration [s], or one second of it, would take tens of
// millions of strides. A time step of the requested length `asked` [s] that takes fewer than a
// thousand strides is always accepted.
status pace_look(pace *p, const arm *a, const motion *m, double duration, double asked, fault *f);

// Counts a stride that was just made, and checks the pace every PACE_STRIDES of them.
static inline status pace_keep(pace *p, const arm *a, const motion *m, double duration,
                               double asked, fault *f)
{
    p->strides++;
    const bool looks = p->looked_from < 0 || p->strides >= PACE_STRIDES;
    return looks ? pace_look(p, a, m, duration, asked, f) : STATUS_OK;
}
