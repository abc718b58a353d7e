// When two instants are the same. Times are sums of steps, so that equal ones differ by
// rounding; whoever compares times allows for that here and nowhere else.
#pragma once

#include <math.h>
#include <stdbool.h>

#include "src/base/extremes.h"

// How far apart two instants near `time` may lie that differ by rounding only [s].
static inline double instant_tolerance(double time)
{
    return 1e-12 * larger(fabs(time), 1);
}

// Whether two instants [s] are one.
static inline bool same_instant(double a, double b)
{
    return fabs(a - b) <= instant_tolerance(b);
}

// Whether an instant lies after another one and is not the same [s]; HUGE_VAL is after
// all others.
static inline bool instant_after(double later, double earlier)
{
    return later > earlier + instant_tolerance(earlier);
}
