#include "ui/explorer/panels/plot.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "render/plot/ticks.h"
#include "ui/terminal/pictures.h"

// --- the frame -------------------------------------------------------------------------

enum { LARGE_CELL = 24 }; // height of a cell from which on lines are thicker [pixels]

void plot_frame_open(const explorer_view *view, plot_frame *f)
{
    const canvas *c = &f->canvas;
    const picture_layer *pixels = c->screen->pictures;
    f->picture = picture_begin(c->screen, c->x, c->y, c->width, c->height);
    if (f->picture == NULL) {
        return;
    }
    f->theme = view->looks.theme;
    f->pixels = (pane_frame){.from = f->from,
                             .to = f->to,
                             .low = f->axis.low,
                             .high = f->axis.high,
                             .width = c->width * pixels->cell_width,
                             .height = c->height * pixels->cell_height,
                             .line = pixels->cell_height >= LARGE_CELL ? 2 : 1.5};
}

static double plot_x(const plot_frame *f, double time)
{
    return (time - f->from) / (f->to - f->from) * (2.0 * f->canvas.width - 1);
}

static double plot_y(const plot_frame *f, double value)
{
    return (f->axis.high - value) / (f->axis.high - f->axis.low) *
           (4.0 * f->canvas.height - 1);
}

// Every row joined to the next one by a line.
static void draw_rows(const plot_frame *f, const trace *t, int signal, double until)
{
    double x0 = (double)NAN, y0 = (double)NAN;
    bool visible = true;

    // joined as long as they are visible and seen
    for (size_t r = trace_row_at(t, f->from);
         visible && r < t->row_count && t->rows[r].time <= until; r++) {
        double x = plot_x(f, t->rows[r].time),
               y = plot_y(f, signal_value(&t->rows[r], signal));
        if (line_has_dot(f->pattern, lround(x))) {
            canvas_line(&f->canvas, x0, y0, x, y, f->colour);
        }
        x0 = x;
        y0 = y;
        visible = t->rows[r].time <= f->to;
    }
}

// One column of dots.
static void draw_column(const plot_frame *f, long column, value_range y)
{
    if (y.high >= y.low && (y.high - y.low > 4 || line_has_dot(f->pattern, column))) {
        canvas_line(&f->canvas, (double)column, y.low, (double)column, y.high, f->colour);
    }
}

// The smallest and the largest value of each column of dots, so that no spike is lost.
// Blocks that lie within one column are taken from `pairs`.
static void draw_columns(const plot_frame *f, const trace *t, int signal, double until,
                         const double *pairs)
{
    value_range y = value_range_empty;
    double last = (double)NAN;
    long column = -1;

    // row by row, or block by block where one lies within a column
    for (size_t r = trace_row_at(t, f->from);
         r < t->row_count && t->rows[r].time <= until;) {
        size_t end = r + EXTREMES_BLOCK, take = 1;
        long here = lround(plot_x(f, t->rows[r].time));
        if (here != column) {
            draw_column(f, column, y);
            // from where the last one ended, so that curves hang together
            column = here;
            y = value_range_empty;
            value_range_add(&y, last);
        }
        bool whole = pairs != NULL && r % EXTREMES_BLOCK == 0 && end < t->row_count &&
                     t->rows[end].time <= until &&
                     lround(plot_x(f, t->rows[end].time)) == column;
        if (whole) {
            const double *pair = pairs + 2 * (r / EXTREMES_BLOCK);
            take = EXTREMES_BLOCK;
            value_range_add(&y, plot_y(f, pair[1]));
            value_range_add(&y, plot_y(f, pair[0]));
        }
        last = plot_y(f, signal_value(&t->rows[r + take - 1], signal));
        value_range_add(&y, last);
        r += take;
    }
    draw_column(f, column, y);
}

colour picture_colour(const screen *s, colour_theme theme, ink i)
{
    const rgb c = picture_ink(s, theme, i);
    return (colour){c.red / 255.0, c.green / 255.0, c.blue / 255.0};
}

static colour pixel_colour(const plot_frame *f, ink i)
{
    return picture_colour(f->canvas.screen, f->theme, i);
}

void plot_frame_signal(const plot_frame *f, const trace *t, int signal, double until,
                       const double *pairs)
{
    if (f->picture != NULL) {
        const pane_curve c = {.rows = t,
                              .signal = signal,
                              .until = until,
                              .pairs = pairs,
                              .block = EXTREMES_BLOCK,
                              .pattern = f->pattern,
                              .piece = fmax(1, 1.5 * f->pixels.line),
                              .colour = pixel_colour(f, f->colour)};
        pane_curve_paint(f->picture, &f->pixels, &c);
        return;
    }
    double shown = (double)(trace_row_at(t, f->to) - trace_row_at(t, f->from));
    until = fmin(until, f->to);
    if (shown < 4.0 * f->canvas.width) {
        draw_rows(f, t, signal, until);
    } else {
        draw_columns(f, t, signal, until, pairs);
    }
}

void plot_frame_cursor(const plot_frame *f, screen *s, double time)
{
    if (f->picture != NULL) {
        pane_instant_paint(f->picture, &f->pixels, time, pixel_colour(f, INK_CURSOR));
        return;
    }
    if (!(time >= f->from && time <= f->to)) {
        return;
    }
    const int column = f->canvas.x + (int)(plot_x(f, time) / 2);
    for (int y = f->canvas.y; y < f->canvas.y + f->canvas.height; y++) {
        if (s->cells[(long)y * s->width + column].glyph == ' ') {
            screen_put(s, column, y, 0x2506, INK_CURSOR);
        }
    }
}

void plot_frame_level(const plot_frame *f, screen *s, double value, const char *name)
{
    // a run that just reaches the level shows it
    const double edge = 1e-6 * (f->axis.high - f->axis.low);
    if (!(value >= f->axis.low - edge && value <= f->axis.high + edge)) {
        return;
    }
    const double row = fmax(0, fmin(4.0 * f->canvas.height - 1, plot_y(f, value)));
    const int y = f->canvas.y + (int)(lround(row) / 4);

    // the name is at the end
    const int length = (int)strlen(name), end = f->canvas.x + f->canvas.width;
    if (f->picture != NULL) {
        pane_level_paint(f->picture, &f->pixels, value, pixel_colour(f, INK_FRAME));
        screen_text(s, end - length, y, length, INK_FRAME, name);
        return;
    }

    // only where nothing is drawn yet
    for (int x = f->canvas.x; x < end; x++) {
        cell *at = &s->cells[(long)y * s->width + x];
        if (at->glyph == ' ') {
            const int in_name = x - (end - length);
            screen_put(s, x, y, in_name >= 0 ? (uint32_t)name[in_name] : 0x2508,
                       INK_FRAME);
        }
    }
}

// --- axes ------------------------------------------------------------------------------

// A tick's value with no more digits than the axis needs, its power of ten behind.
static void axis_label(const ticks *t, int index, char *text, size_t size)
{
    snprintf(text, size, "%.*f", t->decimals, t->value[index] / pow(10, t->exponent));
    if (t->exponent != 0 && t->value[index] != 0) {
        text_add(text, size, "e%d", t->exponent);
    }
}

// Whether a tick is rather labelled than another one in the same row: zero, else the
// outer one.
static bool outranks(double value, double other, bool upper_half)
{
    if (value == 0 || other == 0) {
        return other != 0;
    }
    if (upper_half) {
        return value > other;
    }
    return value < other;
}

// The row of an axis at which a value lies.
static long row_of(value_range axis, int height, double value)
{
    return lround((axis.high - value) / (axis.high - axis.low) * (4.0 * height - 1)) / 4;
}

void draw_value_axis(screen *s, area a, value_range axis)
{
    assert(axis.high > axis.low);
    const int h = a.height;
    ticks t;

    // as many as have a row each: one that is left out would make the others look uneven
    bool fit = false;
    int most = 3;
    if (h >= 12) {
        most = 5;
    } else if (h >= 6) {
        most = 4;
    }
    for (int wanted = most; wanted > 1 && !fit; wanted--) {
        ticks_between(&t, axis.low, axis.high, wanted);
        fit = true;
        for (int i = 1; i < t.count; i++) {
            fit = fit && row_of(axis, h, t.value[i]) != row_of(axis, h, t.value[i - 1]);
        }
    }
    for (int y = 0; y < a.height; y++) {
        int best = -1;
        for (int i = 0; i < t.count; i++) {
            bool better =
                best < 0 || outranks(t.value[i], t.value[best], 2 * y < a.height);
            if (row_of(axis, a.height, t.value[i]) == y && better) {
                best = i;
            }
        }
        screen_put(s, a.x + a.width - 1, a.y + y, best < 0 ? 0x2502 : 0x2524, INK_FRAME);
        if (best >= 0) {
            char text[TICK_TEXT + 8];
            axis_label(&t, best, text, sizeof text);
            screen_print(s, a.x, a.y + y, a.width - 1, INK_DIM, "%*s", a.width - 1, text);
        }
    }
}

// Seconds below round instants, the unit behind the last one.
static void draw_instants(screen *s, area a, double from, double to)
{
    ticks t;
    int free = a.x;
    ticks_between(&t, from, to, a.width / 14 < 2 ? 2 : a.width / 14);

    // each tick with its label below, unless that would touch the one before
    for (int i = 0; i < t.count; i++) {
        char text[TICK_TEXT + 16];
        double share = (t.value[i] - from) / (to - from);
        int x = a.x + (int)(share * (2.0 * a.width - 1) / 2);
        axis_label(&t, i, text, sizeof text);
        if (i == t.count - 1) {
            strcat(text, " s");
        }

        // kept within the axis
        int length = (int)strlen(text), start = x - length / 2;
        if (start + length > a.x + a.width) {
            start = a.x + a.width - length;
        }
        if (start < a.x) {
            start = a.x;
        }

        // a tick on the line, where no bar is
        if (s->width > x && x < a.x + a.width) {
            cell *at = &s->cells[(long)a.y * s->width + x];
            if (at->glyph == 0x2500) {
                at->glyph = 0x252c;
            }
        }
        if (start >= free) {
            screen_text(s, start, a.y + 1, a.x + a.width - start, INK_DIM, text);
            free = start + length + 1;
        }
    }
}

area draw_time_axis(const explorer_model *model, const explorer_view *view, screen *s,
                    area a)
{
    const session *e = &model->session;
    const trace *t = &e->run.trace;
    double from, to;
    view_window(model, view, &from, &to);
    area line = {a.x + LABEL_WIDTH + 1, a.y, a.width - LABEL_WIDTH - 1, 1};

    // contact as a bar
    for (int i = 0; i < line.width; i++) {
        double time = from + (to - from) * (i + 0.5) / line.width;
        bool touches = time <= e->seen && t->rows[trace_row_at(t, time)].contact != 0;
        screen_put(s, line.x + i, a.y, touches ? 0x2592 : 0x2500,
                   touches ? INK_FORCE : INK_FRAME);
    }

    // a touch that is shorter than a column
    for (size_t i = 0; i < t->event_count && t->events[i].time <= e->seen; i++) {
        if (t->events[i].kind == EVENT_CONTACT) {
            screen_put(s, time_column(model, view, line, t->events[i].time), a.y, 0x2592,
                       INK_FORCE);
        }
    }
    draw_instants(s, line, from, to);

    // impacts that have been seen and inputs: the coming motion is not known yet, coming
    // changes are
    for (size_t i = 0; i < t->event_count; i++) {
        const event *v = &t->events[i];
        const bool input = v->kind == EVENT_CHANGE || v->kind == EVENT_PUSH;
        const bool seen = v->time <= e->seen, impact = v->kind == EVENT_IMPACT && seen;
        uint32_t mark = 0x25b2;
        if (!impact) {
            if (seen) {
                mark = 0x25cf;
            } else {
                mark = 0x25cb;
            }
        }
        if (impact || input) {
            screen_put(s, time_column(model, view, line, v->time), a.y, mark,
                       seen ? INK_EVENT : INK_DIM);
        }
    }

    // notes
    for (int i = 0; i < model->note_count; i++) {
        screen_put(s, time_column(model, view, line, model->notes[i].time), a.y, '!',
                   INK_TITLE);
    }

    // the meaning of the marks, next to them
    screen_text(s, a.x, a.y, LABEL_WIDTH, INK_FORCE, "\u2592 contact");
    screen_text(s, a.x, a.y + 1, LABEL_WIDTH, INK_EVENT, "\u25b2 impact");
    return (area){line.x, a.y, line.width, 2};
}
