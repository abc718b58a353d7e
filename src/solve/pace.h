// The pace of a motion: whether its strides are so short that it has no end.
#pragma once

#include "src/base/fault.h"
#include "src/solve/motion.h"

enum { PACE_STRIDES = 1 << 16 }; // from look to look; more than anything brief takes

typedef struct pace {
    long strides;       // since the last look
    double looked_from; // instant of the last look, -1 before the first stride [s]
} pace;

// That of a motion that is yet to make its first stride.
pace pace_begin(void);

// Whether the pace is kept: STATUS_NO_PROGRESS, with a sentence that names the cause, if a run of
// that duration [s], or a second of it, would take tens of millions of strides; but not where a
// time step of the length asked for [s] is cut into fewer than a thousand.
status pace_look(pace *p, const arm *a, const motion *m, double duration, double asked, fault *f);

// Counts a stride that was just made, and looks every so many of them.
static inline status pace_keep(pace *p, const arm *a, const motion *m, double duration,
                               double asked, fault *f)
{
    p->strides++;
    const bool looks = p->looked_from < 0 || p->strides >= PACE_STRIDES;
    return looks ? pace_look(p, a, m, duration, asked, f) : STATUS_OK;
}
