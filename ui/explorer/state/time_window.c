#include "ui/explorer/state/time_window.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

#define SHORTEST 1e-6 // visible part of a run [s]

static bool shows_all(const time_window *w)
{
    return w->to <= w->from;
}

void time_window_range(const time_window *w, double duration, double *from, double *to)
{
    assert(w != NULL && from != NULL && to != NULL);
    *from = shows_all(w) ? 0 : w->from;
    *to = shows_all(w) ? duration : w->to;
}

void time_window_show(time_window *w, double duration, double from, double to)
{
    assert(w != NULL && isfinite(duration));
    double width = fmax(to - from, SHORTEST);
    if (width >= duration) {
        time_window_show_all(w);
        return;
    }
    w->from = fmax(0, fmin(duration - width, from));
    w->to = w->from + width;
}

void time_window_show_all(time_window *w)
{
    assert(w != NULL);
    *w = (time_window){0};
}

void time_window_follow(time_window *w, double duration, double now)
{
    double from, to;
    time_window_range(w, duration, &from, &to);
    double width = to - from;

    // a shorter run may have ended before a part that was panned to
    if (shows_all(w) || w->adrift) {
        if (w->to > duration) {
            time_window_show(w, duration, from, to);
        }
        return;
    }

    // some of what comes is visible while it plays
    if (now > from + 0.8 * width) {
        from = now - 0.8 * width;
    } else if (now < from + 0.1 * width) {
        from = now - 0.1 * width;
    }
    time_window_show(w, duration, from, from + width);
}
