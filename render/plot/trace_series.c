// Recorded signals as series, the force with its located peaks among the rows.
#include "render/plot/trace_parts.h"

#include <assert.h>
#include <glib.h>
#include <math.h>

#include "render/plot/curve.h"

void *trace_keep(GPtrArray *owned, void *block)
{
    g_ptr_array_add(owned, block);
    return block;
}

static figure_series series_of(const trace_run *run, int index)
{
    assert(index >= 0 && index < signal_count);

    const trace *rows = &run->result->trace;
    const signal_info *signal = &signal_table[index];
    const char *base = (const char *)rows->rows;
    figure_series s = {.name = signal->name,
                       .count = rows->row_count,
                       .stride = sizeof(sample),
                       .colour = signal->colour,
                       .style = signal->style};

    // a run without rows gives no addresses
    if (base != NULL) {
        s.x = (const double *)(base + offsetof(sample, time));
        s.y = (const double *)(base + signal->offset);
    }
    return s;
}

// A point that lies between two rows.
typedef struct located_point {
    double x, y;
} located_point;

// Where the force is largest in the first pulse and in the whole run, in the order of time. Returns
// their number.
static int located_peaks(const summary *m, located_point peaks[2])
{
    int count = 0;

    const located_point first = {m->first_contact_s + m->first_pulse_time_to_peak_s,
                                 m->first_pulse_peak_N};
    const located_point whole = {m->first_contact_s + m->time_to_peak_s, m->peak_force_N};

    // the whole run's comes later, or it is the first pulse's
    if (isfinite(first.x) && isfinite(first.y)) {
        peaks[count++] = first;
    }
    if (isfinite(whole.x) && isfinite(whole.y) && (count == 0 || whole.x > first.x)) {
        peaks[count++] = whole;
    }
    return count;
}

// The force with its peaks among the rows, so that no mark stands above the curve.
static void add_peaks(figure_series *s, const summary *m, GPtrArray *owned)
{
    located_point peaks[2];
    int count = located_peaks(m, peaks), next = 0;
    double *x = trace_keep(owned, g_new(double, s->count + 2));
    double *y = trace_keep(owned, g_new(double, s->count + 2));

    // a peak goes between the rows that it lies between
    size_t out = 0;
    for (size_t i = 0; i < s->count; i++) {
        while (next < count && i > 0 && peaks[next].x < series_x(s, i)) {
            if (peaks[next].x > series_x(s, i - 1)) {
                x[out] = peaks[next].x;
                y[out++] = peaks[next].y;
            }
            next++;
        }
        x[out] = series_x(s, i);
        y[out++] = series_y(s, i);
    }

    // the series is a copy now
    s->x = x;
    s->y = y;
    s->count = out;
    s->stride = 0;
}

figure_series trace_series(const trace_run *run, int index, GPtrArray *owned)
{
    figure_series s = series_of(run, index);
    if (index == SIGNAL_INDEX(force) && !run->points && s.count > 0) {
        add_peaks(&s, &run->result->summary, owned);
    }
    return s;
}

figure_interval *trace_contact(const trace *rows, int *count, GPtrArray *owned)
{
    *count = trace_intervals(rows, trace_in_contact, NULL);
    figure_interval *intervals = trace_keep(owned, g_new0(figure_interval, *count + 1));
    trace_intervals(rows, trace_in_contact, intervals);
    return intervals;
}

double trace_value_at(const trace *t, int index, double time)
{
    size_t low = 0, high = t->row_count;
    if (high == 0 || time < t->rows[0].time || time > t->rows[high - 1].time) {
        return (double)NAN;
    }
    // the last row that is not later
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (t->rows[middle].time <= time) {
            low = middle;
        } else {
            high = middle;
        }
    }

    double here = signal_value(&t->rows[low], index);
    if (high == t->row_count) {
        return here;
    }

    // a straight line to the next row
    double span = t->rows[high].time - t->rows[low].time;
    double share = span > 0 ? (time - t->rows[low].time) / span : 0;
    return here + share * (signal_value(&t->rows[high], index) - here);
}
