#include "src/run/spectrum.h"

#include <assert.h>
#include <math.h>

#include "src/base/fourier.h"

enum { SERIES = 2 * SPECTRUM_LINES }; // values of which a spectrum is computed

// The value of a signal at an instant from row r on, a share of the way to the next row
// if there is one.
static double value_between(const trace *t, int signal, size_t r, double time)
{
    const double value = signal_value(&t->rows[r], signal);
    if (r + 1 >= t->row_count || t->rows[r + 1].time <= t->rows[r].time) {
        return value;
    }
    const double share =
        (time - t->rows[r].time) / (t->rows[r + 1].time - t->rows[r].time);
    return value + share * (signal_value(&t->rows[r + 1], signal) - value);
}

// A signal at even instants, straight between rows; what has no value counts as 0.
static void sample_evenly(const trace *t, int signal, double from, double to,
                          double *series)
{
    // instants and rows go forward together, so the row is found in one walk
    size_t r = trace_row_at(t, from);
    for (int i = 0; i < SERIES; i++) {
        const double time = from + (to - from) * i / SERIES;
        while (r + 1 < t->row_count && t->rows[r + 1].time <= time) {
            r++;
        }
        const double value = value_between(t, signal, r, time);
        series[i] = isfinite(value) ? value : 0;
    }
}

// The number of lines that hold nearly all of what there is, and a few more. Line 0 is
// what the window makes of a mean that was taken off, and not of the signal.
static int lines_that_matter(const double *amplitude)
{
    double all = 0, sum = 0;
    for (int k = 1; k < SPECTRUM_LINES; k++) {
        all += amplitude[k] * amplitude[k];
    }
    int lines = 1;
    while (lines < SPECTRUM_LINES && sum < 0.99 * all) {
        sum += amplitude[lines] * amplitude[lines];
        lines++;
    }
    lines += lines / 4 + 8;
    return lines < SPECTRUM_LINES ? lines : SPECTRUM_LINES;
}

// Below this share of a signal's largest value, the amplitudes of its spectrum are
// rounding.
#define ROUNDING 1e-12

// The largest absolute value.
static double largest_size(const double *series, int count)
{
    double largest = 0;
    for (int i = 0; i < count; i++) {
        largest = fmax(largest, fabs(series[i]));
    }
    return largest;
}

// The line with the highest amplitude, 0 if all are 0.
static int highest_line(const double *amplitude, int lines)
{
    int highest = 0;
    double height = 0;
    for (int k = 1; k < lines; k++) {
        if (amplitude[k] > height) {
            height = amplitude[k];
            highest = k;
        }
    }
    return highest;
}

void trace_spectrum_take(const trace *t, int signal, double from, double to,
                         trace_spectrum *out)
{
    assert(from < to && t->row_count > 0);
    double series[SERIES], scratch[2 * SERIES];
    sample_evenly(t, signal, from, to, series);
    fourier_amplitudes(series, SERIES, scratch, out->amplitude);
    out->step = 1 / (to - from);
    out->lines = lines_that_matter(out->amplitude);
    out->highest = highest_line(out->amplitude, out->lines);

    // what the transform of a constant leaves is rounding
    const double height = out->highest > 0 ? out->amplitude[out->highest] : 0;
    out->constant = height <= ROUNDING * largest_size(series, SERIES);
}
