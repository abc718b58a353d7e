#include "src/base/stop.h"

#include <math.h>

#include "src/base/clock.h"

#define INTERVAL 2.5e-3 // between questions [s]
#define MOST_DUE 1e6    // looks without the clock

atomic_bool stop_everything;

// Asks whether to stop, but only every few milliseconds: so many looks go without.
bool stop_ask(stop_request *s)
{
    if (++s->looks < s->due) {
        return false;
    }

    // the first look is where time begins to count; one too early says how many looks it
    // takes
    const double now = clock_seconds(CLOCK_MONOTONIC);
    if (s->asked == 0) {
        s->asked = now;
    }

    const double looks = s->looks, took = now - s->asked;
    if (took < INTERVAL / 2) {
        s->due = (int)fmin(2 * looks, MOST_DUE);
        return false;
    }

    s->due = (int)fmin(fmax(looks * INTERVAL / took, 1), MOST_DUE);
    s->looks = 0;
    s->asked = now;
    return s->ask(s->context) != 0;
}
