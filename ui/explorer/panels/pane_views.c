// Panes whose axis is not time: one signal over another, and spectra.
#include "ui/explorer/panels/panel.h"

#include <assert.h>
#include <math.h>

#include "src/run/spectrum.h"

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

// The amplitudes of the visible part, as far as it has been seen, up to where there is
// anything.
static bool draw_spectrum(const explorer_model *model, const explorer_view *view,
                          screen *s, const pane *of, area a, value_range *axis)
{
    static trace_spectrum of_pane;
    double from, to;
    view_window(model, view, &from, &to);
    to = fmin(to, model->session.seen);
    if (!(to > from)) {
        return false;
    }
    trace_spectrum_take(model_run(model, 0).trace, of->signals[0], from, to, &of_pane);

    // the highest line is named, if there is any
    value_range heights = {0, 0};
    if (!of_pane.constant) {
        heights.high = of_pane.amplitude[of_pane.highest];
    }
    const plane p = {.canvas = {s, a.x, a.y, a.width, a.height},
                     .x = {0, of_pane.lines * of_pane.step},
                     .y = value_range_opened(heights)};
    *axis = p.y;
    if (of_pane.constant) {
        draw_ends(s, a, p.x, "constant, to [Hz]");
        return true;
    }

    for (int k = 2; k < of_pane.lines; k++) {
        canvas_line(&p.canvas, dot_x(&p, (k - 1) * of_pane.step),
                    dot_y(&p, of_pane.amplitude[k - 1]), dot_x(&p, k * of_pane.step),
                    dot_y(&p, of_pane.amplitude[k]), INK_SERIES_0);
    }
    char name[64];
    snprintf(name, sizeof name, "highest at %.3g Hz, to [Hz]",
             of_pane.highest * of_pane.step);
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
