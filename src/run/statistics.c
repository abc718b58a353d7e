#include "src/run/statistics.h"

#include <assert.h>
#include <math.h>

// Takes a straight piece from one value to another into the sums.
static void add_piece(signal_statistics *s, double *squares, double width, double a, double b)
{
    if (!isfinite(a) || !isfinite(b)) {
        return;
    }
    s->minimum = fmin(s->minimum, fmin(a, b));
    s->maximum = fmax(s->maximum, fmax(a, b));
    s->duration += width;
    s->integral += width * (a + b) / 2;
    *squares += width * (a * a + a * b + b * b) / 3;
}

signal_statistics trace_statistics(const trace *t, int signal, double from, double to)
{
    assert(t != NULL && t->row_count > 0 && signal >= 0 && signal < signal_count && from <= to);
    signal_statistics s = {.minimum = HUGE_VAL, .maximum = -HUGE_VAL};
    double squares = 0;
    const double end = t->rows[t->row_count - 1].time;
    from = fmax(t->rows[0].time, fmin(from, end));
    to = fmax(from, fmin(to, end));

    // from row to row, the first and the last piece cut
    size_t r = trace_row_at(t, from);
    for (; r + 1 < t->row_count && t->rows[r].time <= to; r++) {
        const double t0 = t->rows[r].time, t1 = t->rows[r + 1].time;
        if (t0 == t1) {
            continue; // both sides of an event
        }
        const double v0 = signal_value(&t->rows[r], signal);
        const double v1 = signal_value(&t->rows[r + 1], signal);
        const double begin = fmax(t0, from), stop = fmin(t1, to);
        const double slope = (v1 - v0) / (t1 - t0);
        const double a = v0 + slope * (begin - t0);
        const double b = stop < t1 ? v0 + slope * (stop - t0) : v1;
        add_piece(&s, &squares, stop - begin, a, b);
    }

    // at the end, or where pieces have no value, the row itself
    if (isinf(s.minimum)) {
        const double value = signal_value(&t->rows[trace_row_at(t, from)], signal);
        add_piece(&s, &squares, 0, value, value);
    }
    if (isinf(s.minimum)) {
        const double none = (double)NAN;
        return (signal_statistics){none, none, none, none, none, 0};
    }

    // of an instant the value itself
    s.mean = s.duration > 0 ? s.integral / s.duration : s.minimum;
    s.rms = s.duration > 0 ? sqrt(squares / s.duration) : fabs(s.minimum);
    return s;
}
