// Panes whose axis is not time: one signal over another, and spectra.
#include "ui/explorer/panels/panel.h"

#include <assert.h>
#include <math.h>

#include "src/base/fourier.h"

enum { SERIES = 1024 };               // values of which a spectrum is computed
enum { SPECTRUM_LINES = SERIES / 2 }; // of a spectrum

// A plane of two ranges on a canvas.
typedef struct plane {
    canvas canvas;
    value_range x, y;
} plane;

// The column of dots at which a value across lies.
static double dot_x(const plane *p, double x)
{
    return (x - p->x.low) / (p->x.high - p->x.low) * (2.0 * p->canvas.width - 1);
}

// The row of dots at which a value up lies.
static double dot_y(const plane *p, double y)
{
    return (p->y.high - y) / (p->y.high - p->y.low) * (4.0 * p->canvas.height - 1);
}

// The ends of the axis across, in the corners of the lowest row, and what it is.
static void draw_ends(screen *s, area a, value_range x, const char *name)
{
    char text[96];
    const int y = a.y + a.height - 1;
    screen_text(s, a.x, y, a.width, INK_DIM, draw_number(x.low).text);
    const int length =
        snprintf(text, sizeof text, "%.48s %s", name, draw_number(x.high).text);
    screen_text(s, a.x + a.width - length, y, length, INK_DIM, text);
}

// --- one signal over another -----------------------------------------------------------

// Widens a range by the values of a signal between two instants [s].
static void widen_by(value_range *r, const trace *t, int signal, double from, double to)
{
    const size_t last = trace_row_at(t, to);
    for (size_t i = trace_row_at(t, from); i <= last; i++) {
        value_range_add(r, signal_value(&t->rows[i], signal));
    }
}

// The path of the second signal of a pane over its first between two instants [s].
static void draw_path(const plane *p, const trace *t, const pane *of, double from,
                      double to, ink colour)
{
    double x0 = (double)NAN, y0 = (double)NAN;
    const size_t last = trace_row_at(t, to);
    for (size_t i = trace_row_at(t, from); i <= last; i++) {
        const double x = dot_x(p, signal_value(&t->rows[i], of->signals[1]));
        const double y = dot_y(p, signal_value(&t->rows[i], of->signals[0]));
        canvas_line(&p->canvas, x0, y0, x, y, colour);
        x0 = x;
        y0 = y;
    }
}

// The path of the visible part, that of the baseline behind it, the cursor on it.
static bool draw_phase(const explorer_model *model, const explorer_view *view, screen *s,
                       const pane *of, area a, value_range *axis)
{
    const session *e = &model->session;
    const trace *t = model_run(model, 0).trace;

    // the ranges of both signals
    value_range x = value_range_empty, y = value_range_empty;
    double from, to;
    view_window(model, view, &from, &to);
    widen_by(&x, t, of->signals[1], from, to);
    widen_by(&y, t, of->signals[0], from, to);
    if (!(x.high >= x.low) || !(y.high >= y.low)) {
        return false;
    }
    const plane p = {{s, a.x, a.y, a.width, a.height},
                     value_range_opened(x),
                     value_range_opened(y)};
    *axis = p.y;

    // the present run over the baseline
    if (e->has_other && !model->difference.on) {
        draw_path(&p, &e->other.trace, of, from, to,
                  run_ink(model_reference_rank(model)));
    }
    draw_path(&p, t, of, from, fmin(to, e->seen), INK_SERIES_0);

    // where the cursor is, and the ends of the axis
    draw_ends(s, a, p.x, signal_table[of->signals[1]].name);
    const sample *row = &t->rows[model_row(model, t)];
    const double at_x = dot_x(&p, signal_value(row, of->signals[1])) / 2;
    const double at_y = dot_y(&p, signal_value(row, of->signals[0])) / 4;
    if (at_x >= 0 && at_x < a.width && at_y >= 0 && at_y < a.height) {
        screen_put(s, a.x + (int)at_x, a.y + (int)at_y, GLYPH_DISC, INK_CURSOR);
    }
    return true;
}

// --- a spectrum ------------------------------------------------------------------------

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

// The amplitudes of the visible part, as far as it has been seen, up to where there is
// anything.
static bool draw_spectrum(const explorer_model *model, const explorer_view *view,
                          screen *s, const pane *of, area a, value_range *axis)
{
    static double series[SERIES], scratch[2 * SERIES], amplitude[SPECTRUM_LINES];
    const trace *t = model_run(model, 0).trace;
    double from, to;
    view_window(model, view, &from, &to);
    to = fmin(to, model->session.seen);
    if (!(to > from)) {
        return false;
    }
    sample_evenly(t, of->signals[0], from, to, series);
    fourier_amplitudes(series, SERIES, scratch, amplitude);

    // the highest line is named, if there is any
    const int lines = lines_that_matter(amplitude), peak = highest_line(amplitude, lines);
    const double highest = peak > 0 ? amplitude[peak] : 0;
    const bool constant = highest <= ROUNDING * largest_size(series, SERIES);
    value_range heights = {0, 0};
    if (!constant) {
        heights.high = highest;
    }
    const plane p = {.canvas = {s, a.x, a.y, a.width, a.height},
                     .x = {0, lines / (to - from)},
                     .y = value_range_opened(heights)};
    *axis = p.y;
    if (constant) {
        draw_ends(s, a, p.x, "constant, to [Hz]");
        return true;
    }

    for (int k = 2; k < lines; k++) {
        canvas_line(&p.canvas, dot_x(&p, (k - 1) / (to - from)),
                    dot_y(&p, amplitude[k - 1]), dot_x(&p, k / (to - from)),
                    dot_y(&p, amplitude[k]), INK_SERIES_0);
    }
    char name[64];
    snprintf(name, sizeof name, "highest at %.3g Hz, to [Hz]", peak / (to - from));
    draw_ends(s, a, p.x, name);
    return true;
}

bool draw_pane_view(const explorer_model *model, const explorer_view *view, screen *s,
                    const pane *p, area a, value_range *axis)
{
    assert(p->view != VIEW_TIME);
    if (p->view == VIEW_PHASE) {
        return draw_phase(model, view, s, p, a, axis);
    }
    return draw_spectrum(model, view, s, p, a, axis);
}
