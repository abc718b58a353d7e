#include "ui/explorer/panels/plot_frame.h"

#include <math.h>
#include <string.h>

#include "ui/explorer/panels/run_lines.h"
#include "ui/terminal/pictures.h"

enum { LARGE_CELL = 24 }; // height of a cell from which on lines are thicker [pixels]

void plot_frame_open(const explorer_state *st, plot_frame *f)
{
    const canvas *c = &f->canvas;
    const picture_layer *pixels = c->screen->pictures;
    f->picture = picture_begin(c->screen, c->x, c->y, c->width, c->height);
    if (f->picture == NULL) {
        return;
    }
    f->theme = st->looks.theme;
    f->pixels = (pane_frame){.from = f->from,
                             .to = f->to,
                             .low = f->axis.low,
                             .high = f->axis.high,
                             .width = c->width * pixels->cell_width,
                             .height = c->height * pixels->cell_height,
                             .line = pixels->cell_height >= LARGE_CELL ? 2 : 1.5};
}

void plot_frame_close(plot_frame *f)
{
    if (f->picture != NULL) {
        picture_end(f->canvas.screen, f->picture);
        f->picture = NULL;
    }
}

static double plot_x(const plot_frame *f, double time)
{
    return (time - f->from) / (f->to - f->from) * (2.0 * f->canvas.width - 1);
}

static double plot_y(const plot_frame *f, double value)
{
    return (f->axis.high - value) / (f->axis.high - f->axis.low) * (4.0 * f->canvas.height - 1);
}

// Every row joined to the next one by a line.
static void draw_rows(const plot_frame *f, const trace *t, int signal, double until)
{
    double x0 = (double)NAN, y0 = (double)NAN;

    // joined as long as they are visible and seen
    for (size_t r = trace_row_at(t, f->from); r < t->row_count; r++) {
        double x = plot_x(f, t->rows[r].time), y = plot_y(f, signal_value(&t->rows[r], signal));
        if (t->rows[r].time > until) {
            break;
        }
        if (line_has_dot(f->pattern, lround(x))) {
            canvas_line(&f->canvas, x0, y0, x, y, f->colour);
        }
        x0 = x;
        y0 = y;
        if (t->rows[r].time > f->to) {
            break;
        }
    }
}

// One column of dots.
static void draw_column(const plot_frame *f, long column, double low, double high)
{
    bool drawn = high >= low && (high - low > 4 || line_has_dot(f->pattern, column));
    if (drawn) {
        canvas_line(&f->canvas, (double)column, low, (double)column, high, f->colour);
    }
}

// The smallest and the largest value of each column of dots, so that no spike is lost. Blocks that
// lie within one column are taken from `pairs`.
static void draw_columns(const plot_frame *f, const trace *t, int signal, double until,
                         const double *pairs)
{
    double low = (double)INFINITY, high = (double)-INFINITY, last = (double)NAN;
    long column = -1;

    // row by row, or block by block where one lies within a column
    for (size_t r = trace_row_at(t, f->from); r < t->row_count && t->rows[r].time <= until;) {
        size_t end = r + EXTREMES_BLOCK, take = 1;
        long here = lround(plot_x(f, t->rows[r].time));
        if (here != column) {
            draw_column(f, column, low, high);
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
    draw_column(f, column, low, high);
}

static colour pixel_colour(const plot_frame *f, ink i)
{
    const rgb c = picture_ink(f->canvas.screen, f->theme, i);
    return (colour){c.red / 255.0, c.green / 255.0, c.blue / 255.0};
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
    int column = f->canvas.x + (int)(plot_x(f, time) / 2);
    if (f->picture != NULL) {
        pane_instant_paint(f->picture, &f->pixels, time, pixel_colour(f, INK_CURSOR));
        return;
    }
    for (int y = f->canvas.y;
         time >= f->from && time <= f->to && y < f->canvas.y + f->canvas.height; y++) {
        if (s->cells[(long)y * s->width + column].glyph == ' ') {
            screen_put(s, column, y, 0x2506, INK_CURSOR);
        }
    }
}

void plot_frame_level(const plot_frame *f, screen *s, double value, const char *name)
{
    const int y = f->canvas.y + (int)(lround(plot_y(f, value)) / 4);
    if (!(value >= f->axis.low && value <= f->axis.high)) {
        return;
    }

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
            screen_put(s, x, y, in_name >= 0 ? (uint32_t)name[in_name] : 0x2508, INK_FRAME);
        }
    }
}
