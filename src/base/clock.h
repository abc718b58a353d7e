// The clocks of the machine; no result depends on them.
#pragma once

#include <time.h>

// What a clock shows [s], counted from an instant of its own: CLOCK_MONOTONIC passes as
// time does, CLOCK_THREAD_CPUTIME_ID and CLOCK_PROCESS_CPUTIME_ID while the thread or the
// program computes.
double clock_seconds(clockid_t clock);

// CLOCK_MONOTONIC `seconds` (not negative) from now, as pthread_cond_timedwait wants it
// where the condition waits by that clock.
struct timespec clock_after(double seconds);
