// The panes of curves over time.
#include "ui/lab/draw.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LABEL_WIDTH = 9 };

// A pane's place, time window and range.
typedef struct plot_frame {
    canvas canvas;
    double from, to;  // [s]
    double low, high; // of the axis
} plot_frame;

static void forget_extremes(lab_extremes *e)
{
    for (size_t i = 0; i < sizeof e->pairs / sizeof e->pairs[0]; i++) {
        free(e->pairs[i]);
    }
    *e = (lab_extremes){0};
}

void lab_draw_finish(lab *l)
{
    forget_extremes(&l->run_extremes);
    forget_extremes(&l->other_extremes);
}

// Low and high of each block of a signal, computed once for each run; NULL without memory. A block
// without a finite value has low above high.
static const double *extremes_of(lab_extremes *e, unsigned version, const trace *t, int signal)
{
    assert(signal < LAB_SIGNALS);
    if (e->version != version) {
        forget_extremes(e);
        e->version = version;
        e->blocks = (t->row_count + EXTREMES_BLOCK - 1) / EXTREMES_BLOCK;
    }
    if (e->pairs[signal] == NULL) {
        double *pairs = malloc(2 * e->blocks * sizeof *pairs);
        for (size_t b = 0; pairs != NULL && b < e->blocks; b++) {
            double low = (double)INFINITY, high = (double)-INFINITY;
            for (size_t r = b * EXTREMES_BLOCK; r < t->row_count && r < (b + 1) * EXTREMES_BLOCK;
                 r++) {
                double value = signal_value(&t->rows[r], signal);
                if (isfinite(value)) {
                    low = fmin(low, value);
                    high = fmax(high, value);
                }
            }
            pairs[2 * b] = low;
            pairs[2 * b + 1] = high;
        }
        e->pairs[signal] = pairs;
    }
    return e->pairs[signal];
}

static void find_range(lab_extremes *e, unsigned version, const trace *t, const lab_pane *pane,
                       double *low, double *high)
{
    for (int k = 0; k < pane->count; k++) {
        const double *pairs = extremes_of(e, version, t, pane->signals[k]);
        for (size_t b = 0; pairs != NULL && b < e->blocks; b++) {
            *low = fmin(*low, pairs[2 * b]);
            *high = fmax(*high, pairs[2 * b + 1]);
        }
    }
}

static double plot_x(const plot_frame *f, double time)
{
    return (time - f->from) / (f->to - f->from) * (2.0 * f->canvas.width - 1);
}

static double plot_y(const plot_frame *f, double value)
{
    return (f->high - value) / (f->high - f->low) * (4.0 * f->canvas.height - 1);
}

static bool gap_in_line(line_style style, long across)
{
    return (style == LINE_DASHED && across % 8 >= 5) || (style == LINE_DOTTED && across % 4 >= 2) ||
           (style == LINE_DASH_DOT && across % 8 == 4);
}

// Every row joined to the next one by a line.
static void draw_rows(const plot_frame *f, const trace *t, int signal, double until, ink colour)
{
    double x0 = (double)NAN, y0 = (double)NAN;
    for (size_t r = trace_row_at(t, f->from); r < t->row_count; r++) {
        double x = plot_x(f, t->rows[r].time), y = plot_y(f, signal_value(&t->rows[r], signal));
        if (t->rows[r].time > until) {
            break;
        }
        if (!gap_in_line(signal_table[signal].style, lround(x))) {
            canvas_line(&f->canvas, x0, y0, x, y, colour);
        }
        x0 = x;
        y0 = y;
        if (t->rows[r].time > f->to) {
            break;
        }
    }
}

// One column of dots.
static void draw_column(const plot_frame *f, int signal, long column, double low, double high,
                        ink colour)
{
    bool drawn =
        high >= low && (high - low > 4 || !gap_in_line(signal_table[signal].style, column));
    if (drawn) {
        canvas_line(&f->canvas, (double)column, low, (double)column, high, colour);
    }
}

// The smallest and the largest value of each column of dots, so that no spike is lost. Blocks that
// lie within one column are taken from `pairs`.
static void draw_columns(const plot_frame *f, const trace *t, int signal, double until, ink colour,
                         const double *pairs)
{
    double low = (double)INFINITY, high = (double)-INFINITY, last = (double)NAN;
    long column = -1;
    for (size_t r = trace_row_at(t, f->from); r < t->row_count && t->rows[r].time <= until;) {
        size_t end = r + EXTREMES_BLOCK, take = 1;
        long here = lround(plot_x(f, t->rows[r].time));
        if (here != column) {
            draw_column(f, signal, column, low, high, colour);
            // from where the last one ended, so that curves hang together
            column = here;
            low = isfinite(last) ? last : (double)INFINITY;
            high = isfinite(last) ? last : (double)-INFINITY;
        }
        bool whole = pairs != NULL && r % EXTREMES_BLOCK == 0 && end < t->row_count &&
                     t->rows[end].time <= until && lround(plot_x(f, t->rows[end].time)) == column;
        if (whole) {
            const double *pair = pairs + 2 * (r / EXTREMES_BLOCK);
            take = EXTREMES_BLOCK;
            if (pair[1] >= pair[0]) {
                low = fmin(low, plot_y(f, pair[1]));
                high = fmax(high, plot_y(f, pair[0]));
            }
        }
        last = plot_y(f, signal_value(&t->rows[r + take - 1], signal));
        if (isfinite(last)) {
            low = fmin(low, last);
            high = fmax(high, last);
        }
        r += take;
    }
    draw_column(f, signal, column, low, high, colour);
}

// Draws one signal up to `until`: every row if they are few, else by columns.
static void draw_signal(const plot_frame *f, const trace *t, int signal, double until, ink colour,
                        const double *pairs)
{
    double shown = (double)(trace_row_at(t, f->to) - trace_row_at(t, f->from));
    until = fmin(until, f->to);
    if (shown < 4.0 * f->canvas.width) {
        draw_rows(f, t, signal, until, colour);
    } else {
        draw_columns(f, t, signal, until, colour, pairs);
    }
}

static void draw_cursor(const plot_frame *f, screen *s, double time)
{
    int column = f->canvas.x + (int)(plot_x(f, time) / 2);
    for (int y = f->canvas.y;
         time >= f->from && time <= f->to && y < f->canvas.y + f->canvas.height; y++) {
        if (s->cells[(long)y * s->width + column].glyph == ' ') {
            screen_put(s, column, y, 0x2506, INK_CURSOR);
        }
    }
}

// The pane's signals with their values: by name if there is room, else by symbol.
static void draw_pane_title(const lab *l, screen *s, const lab_pane *pane, area a)
{
    const sample *row = session_sample(&l->session);
    int x = a.x + LABEL_WIDTH + 1, end = a.x + a.width, needed = 0;
    for (int k = 0; k < pane->count; k++) {
        const signal_info *info = &signal_table[pane->signals[k]];
        needed += (int)(strlen(info->name) + strlen(info->unit)) + 13;
    }
    for (int k = 0; k < pane->count; k++) {
        const signal_info *info = &signal_table[pane->signals[k]];
        char value[32];
        draw_number(value, sizeof value, signal_value(row, pane->signals[k]));
        x += screen_print(s, x, a.y, end - x, (ink)(INK_SERIES_0 + info->colour), "%s %s %s  ",
                          needed > a.width - LABEL_WIDTH ? info->ascii : info->name, value,
                          info->unit);
    }
}

static void draw_pane(lab *l, screen *s, const lab_pane *pane, area a)
{
    const session *e = &l->session;
    plot_frame f = {
        .canvas = {s, a.x + LABEL_WIDTH + 1, a.y + 1, a.width - LABEL_WIDTH - 1, a.height - 1},
        .low = (double)INFINITY,
        .high = (double)-INFINITY};
    char text[32];
    draw_pane_title(l, s, pane, a);
    lab_window(l, &f.from, &f.to);
    find_range(&l->run_extremes, e->version, &e->run.trace, pane, &f.low, &f.high);
    if (e->has_other) {
        find_range(&l->other_extremes, e->version, &e->other.trace, pane, &f.low, &f.high);
    }
    if (!(f.high >= f.low)) {
        screen_text(s, f.canvas.x, a.y + 1, f.canvas.width, INK_DIM, "not known in this model");
        return;
    }
    if (f.high - f.low < 1e-12) {
        f.low -= 0.5;
        f.high += 0.5;
    }
    draw_number(text, sizeof text, f.high);
    screen_print(s, a.x, a.y + 1, LABEL_WIDTH, INK_DIM, "%9s", text);
    // rounding beside the other end of the axis is shown as 0
    draw_number(text, sizeof text, fabs(f.low) < 1e-9 * f.high ? 0 : f.low);
    screen_print(s, a.x, a.y + a.height - 1, LABEL_WIDTH, INK_DIM, "%9s", text);
    for (int y = a.y + 1; y < a.y + a.height; y++) {
        screen_put(s, a.x + LABEL_WIDTH, y, 0x2502, INK_FRAME);
    }
    for (int k = 0; e->has_other && k < pane->count; k++) {
        draw_signal(&f, &e->other.trace, pane->signals[k], f.to, INK_OTHER,
                    extremes_of(&l->other_extremes, e->version, &e->other.trace, pane->signals[k]));
    }
    for (int k = 0; k < pane->count; k++) {
        draw_signal(&f, &e->run.trace, pane->signals[k], e->seen,
                    (ink)(INK_SERIES_0 + signal_table[pane->signals[k]].colour),
                    extremes_of(&l->run_extremes, e->version, &e->run.trace, pane->signals[k]));
    }
    if (l->has_mark) {
        draw_cursor(&f, s, l->mark);
    }
    draw_cursor(&f, s, e->now);
}

// The time axis: contact as a bar, impacts and changes as marks, the window's ends in seconds.
static void draw_axis(const lab *l, screen *s, area a)
{
    const session *e = &l->session;
    const trace *t = &e->run.trace;
    int x0 = a.x + LABEL_WIDTH + 1, width = a.width - LABEL_WIDTH - 1;
    double from, to;
    lab_window(l, &from, &to);
    for (int i = 0; i < width; i++) {
        double time = from + (to - from) * (i + 0.5) / width;
        bool touches = time <= e->seen && t->rows[trace_row_at(t, time)].contact != 0;
        screen_put(s, x0 + i, a.y, touches ? 0x2592 : 0x2500, touches ? INK_FORCE : INK_FRAME);
    }
    for (size_t i = 0; i < t->event_count; i++) {
        const event *v = &t->events[i];
        double at = (v->time - from) / (to - from) * width;
        if (v->time <= e->seen && at >= 0 && at < width) {
            bool impact = v->kind == EVENT_IMPACT;
            bool input = v->kind == EVENT_CHANGE || v->kind == EVENT_PUSH;
            if (impact || input) {
                screen_put(s, x0 + (int)at, a.y, impact ? 0x25b2 : 0x25cf, INK_EVENT);
            }
        }
    }
    screen_print(s, x0, a.y + 1, width, INK_DIM, "%.4g s", from);
    char text[32];
    int length = snprintf(text, sizeof text, "%.4g s", to);
    screen_text(s, x0 + width - length, a.y + 1, length, INK_DIM, text);
    screen_text(s, x0 + width / 2 - 20, a.y + 1, 44, INK_DIM,
                "\u2592 contact   \u25b2 impact   \u25cf change, push");
}

void draw_curves(lab *l, screen *s, area a)
{
    int shown = 0;
    for (int i = 0; i < LAB_PANES; i++) {
        shown += l->panes[i].shown;
    }
    int most = (a.height - 2) / 4;
    shown = shown > most ? most : shown;
    if (shown < 1 || a.width < LABEL_WIDTH + 10) {
        screen_text(s, a.x, a.y, a.width, INK_DIM, "1 to 9 show curves");
        return;
    }
    int top = a.y, left = shown;
    l->plot_x = a.x + LABEL_WIDTH + 1;
    l->plot_width = a.width - LABEL_WIDTH - 1;
    l->plot_y = a.y;
    l->plot_height = a.height;
    for (int i = 0; i < LAB_PANES && left > 0; i++) {
        if (l->panes[i].shown) {
            int height = (a.y + a.height - 2 - top) / left;
            draw_pane(l, s, &l->panes[i], (area){a.x, top, a.width, height});
            top += height;
            left--;
        }
    }
    draw_axis(l, s, (area){a.x, a.y + a.height - 2, a.width, 2});
}
