#include "src/base/clock.h"

#include <assert.h>
#include <math.h>

double clock_seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// The instant some seconds from now, for waits of the monotonic clock.
struct timespec clock_after(double seconds)
{
    assert(seconds >= 0);
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);

    // whole seconds apart from the rest, which may carry
    double whole = floor(seconds);
    t.tv_sec += (time_t)whole;
    t.tv_nsec += (long)(1e9 * (seconds - whole));
    t.tv_sec += t.tv_nsec / 1000000000;
    t.tv_nsec %= 1000000000;
    return t;
}
