#include "ui/explorer/state/difference.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/instant.h"

void difference_finish(run_difference *d)
{
    assert(d != NULL);
    trace_finish(&d->trace);
    *d = (run_difference){.built = d->built};
}

// The other run at an instant, between its rows. Of two rows at one instant, on both sides of an
// event, the first one is meant if `before`.
static sample sample_at(const trace *t, double time, bool before)
{
    size_t r = trace_row_at(t, time);
    if (before && r > 0 && same_instant(t->rows[r].time, time) &&
        same_instant(t->rows[r - 1].time, time)) {
        r--;
    }
    const sample *a = &t->rows[r];
    if (same_instant(a->time, time) || r + 1 >= t->row_count) {
        return *a;
    }

    // straight from row to row
    sample value = *a;
    const sample *b = &t->rows[r + 1];
    const double share = b->time > a->time ? (time - a->time) / (b->time - a->time) : 0;
    for (int i = 0; i < SIGNALS_AT_MOST; i++) {
        double from, to;
        memcpy(&from, (const char *)a + (size_t)i * sizeof from, sizeof from);
        memcpy(&to, (const char *)b + (size_t)i * sizeof to, sizeof to);
        from += share * (to - from);
        memcpy((char *)&value + (size_t)i * sizeof from, &from, sizeof from);
    }
    return value;
}

// Appends the difference of one row.
static status add_row(run_difference *d, const trace *run, const trace *other, size_t row)
{
    const double none[1] = {0};

    // of two rows at one instant the first belongs to what was before
    const sample *now = &run->rows[row];
    const bool before =
        row + 1 < run->row_count && same_instant(run->rows[row + 1].time, now->time);
    const sample beside = sample_at(other, now->time, before);

    // signal by signal: a sample is a row of numbers; states stay this run's own
    sample difference = *now;
    for (int i = 0; i < SIGNALS_AT_MOST; i++) {
        if (signal_is_state(i)) {
            continue;
        }
        const size_t at = (size_t)i * sizeof(double);
        double a, b;
        memcpy(&a, (const char *)now + at, sizeof a);
        memcpy(&b, (const char *)&beside + at, sizeof b);
        a -= b;
        memcpy((char *)&difference + at, &a, sizeof a);
    }

    // the time is no difference
    difference.time = now->time;
    return trace_add_row(&d->trace, &difference, none, none);
}

void difference_update(run_difference *d, unsigned long run, const session *s)
{
    assert(d != NULL && s != NULL);
    if (!d->on || !s->has_other) {
        return;
    }

    // of another run everything is computed anew, of one that grew the rest
    const trace *t = &s->run.trace;
    if (d->run != run || d->rows > t->row_count || d->trace.row_array.size == 0) {
        trace_finish(&d->trace);
        trace_init(&d->trace, 1);
        d->built++;
        d->run = run;
        d->rows = 0;
    }
    const double end = s->other.trace.rows[s->other.trace.row_count - 1].time;
    for (; d->rows < t->row_count; d->rows++) {
        // beyond the other run's end there is nothing to compare
        if (t->rows[d->rows].time > end || add_row(d, t, &s->other.trace, d->rows) != STATUS_OK) {
            break;
        }
    }
}

double difference_first_beyond(const run_difference *d, int signal, double tolerance)
{
    assert(d != NULL && signal >= 0 && signal < signal_count);
    for (size_t r = 0; r < d->trace.row_count; r++) {
        if (fabs(signal_value(&d->trace.rows[r], signal)) > tolerance) {
            return d->trace.rows[r].time;
        }
    }
    return -1;
}
