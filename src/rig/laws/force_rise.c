#include "src/rig/laws/force_rise.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

#include "src/base/plain_math.h"

#define NEAR    0.05 // share of the wanted force within which the rise is over
#define SLOWEST 0.98 // share of the wanted force that a motion may lack at most

// The force that it has to begin with, NaN where it may begin as it costs least.
static double first_bound(const force_rise_task *task, double off)
{
    const double end = task->end, least = off > task->least - end ? task->least : 0;
    if (2 * off < least - end) {
        return least;
    }
    return 2 * off > task->most - end && off < task->most - end ? task->most : (double)NAN;
}

force_rise force_rise_begin(const force_rise_task *task)
{
    assert(task != NULL && task->divergence > 0 && task->end > 0 && task->least >= 0);
    const double s = task->divergence, end = task->end;
    double off = fmax(task->coordinate + task->rate / s - end, -SLOWEST * end);
    force_rise r = {.begun = task->time,
                    .divergence = s,
                    .from = task->coordinate,
                    .end = end,
                    .off = off,
                    .bound = first_bound(task, off)};

    // at a bound y' = s (y - bound + w), until twice y is what the bound leaves
    if (!isnan(r.bound)) {
        double left = r.bound - end;
        off = left / 2;
        r.bounded = plain_log((off - left) / (r.off - left)) / s;
    }
    r.time = r.bounded + plain_log(fmax(1, 2 * fabs(off) / (NEAR * end))) / s;
    return r;
}

void force_rise_at(const force_rise *r, double time, double way[3])
{
    assert(r != NULL && way != NULL);
    const double s = r->divergence, end = r->end;
    double t = time - r->begun, from = r->from, off = r->off;

    // at the bound, a'' = s^2 (a - bound)
    if (r->bounded > 0) {
        double grown = plain_exp(s * fmin(t, r->bounded));
        double growing = (off + end - r->bound) / 2, dying = from - r->bound - growing;
        from = r->bound + growing * grown + dying / grown;
        off = (off + end - r->bound) * grown + r->bound - end;
        if (t < r->bounded) {
            way[0] = from;
            way[1] = s * (off + end - from);
            way[2] = s * s * (from - r->bound);
            return;
        }
        t -= r->bounded;
    }

    // and then as it costs least
    double kept = plain_exp(-s * t);
    way[0] = end + (from - end + s * t * off) * kept;
    way[1] = s * (end + off * kept - way[0]);
    way[2] = s * s * (way[0] - end - 2 * off * kept);
}

bool force_rise_moves(const force_rise *r, double time)
{
    assert(r != NULL);
    return time - r->begun < r->time;
}
