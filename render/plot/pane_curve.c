// Curves over time on a screen with pixels.
#include "render/plot/pane_curve.h"

#include <assert.h>
#include <math.h>

#include "render/page/picture_file.h"

enum { PIECES = 16 };
static const unsigned whole_line = 0xffff;

static double pixel_x(const pane_frame *f, double time)
{
    return (time - f->from) / (f->to - f->from) * f->width;
}

// The y of a value, limited to a pane's height above and below the pane: cairo's numbers
// do not reach far.
static double pixel_y(const pane_frame *f, double value)
{
    const double y = (f->high - value) / (f->high - f->low) * f->height;
    return fmax(-f->height, fmin(2 * f->height, y));
}

// Sets the pen of a curve. Its pattern, a bit for each piece, becomes the lengths that
// cairo draws and leaves out in turn.
static void set_curve_pen(cairo_t *cr, const pane_frame *f, const pane_curve *c)
{
    double lengths[PIECES];
    int count = 0;
    for (int i = 0; i < PIECES; i++) {
        const bool drawn = c->pattern >> i & 1;
        if (i == 0 || drawn != (c->pattern >> (i - 1) & 1)) {
            lengths[count++] = 0;
        }
        lengths[count - 1] += c->piece;
    }

    // without dashes cairo draws a whole line
    if (c->pattern == whole_line) {
        count = 0;
    }
    cairo_set_dash(cr, lengths, count, 0);
    cairo_set_line_width(cr, f->line);
    cairo_set_line_join(cr, CAIRO_LINE_JOIN_BEVEL);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
    set_colour(cr, c->colour);
}

// What lies in one column of pixels.
typedef struct pixel_column {
    long x;                        // of the column [pixels]
    double first, low, high, last; // y of the first and last row, least and greatest y
    bool any;                      // a row lies in it
} pixel_column;

// Takes a row's y into a column.
static void add_to_column(pixel_column *c, double y)
{
    if (c->any) {
        c->low = fmin(c->low, y);
        c->high = fmax(c->high, y);
    } else {
        c->first = c->low = c->high = y;
    }
    c->last = y;
    c->any = true;
}

// Continues the line through a column: from its first row over the least and greatest y
// to its last row. Rows within half a pixel are one point.
static void end_column(cairo_t *cr, const pixel_column *c)
{
    const double x = (double)c->x + 0.5;
    if (!c->any) {
        return;
    }
    cairo_line_to(cr, x, c->first);
    if (c->high - c->low > 0.5) {
        cairo_line_to(cr, x, c->low);
        cairo_line_to(cr, x, c->high);
        cairo_line_to(cr, x, c->last);
    }
}

// Traces a curve of many rows, column by column of pixels. c->pairs holds the least and
// greatest value of each block of rows, so that a block within one column is taken at
// once.
static void trace_columns(cairo_t *cr, const pane_frame *f, const pane_curve *c,
                          double until)
{
    const trace *t = c->rows;
    pixel_column column = {.x = -1};
    for (size_t r = trace_row_at(t, f->from);
         r < t->row_count && t->rows[r].time <= until;) {
        const long x = lround(floor(pixel_x(f, t->rows[r].time)));
        const size_t end = r + c->block;
        if (x != column.x) {
            end_column(cr, &column);
            column = (pixel_column){.x = x};
        }

        // a whole block whose rows all lie in this column
        const bool whole = c->pairs != NULL && r % c->block == 0 && end < t->row_count &&
                           t->rows[end].time <= until &&
                           lround(floor(pixel_x(f, t->rows[end].time))) == x;
        if (whole) {
            const double *pair = &c->pairs[2 * (r / c->block)];
            if (pair[0] <= pair[1]) {
                add_to_column(&column, pixel_y(f, pair[1]));
                add_to_column(&column, pixel_y(f, pair[0]));
            }
            r = end - 1;
        }

        // the row itself, or the last of its block
        const double value = signal_value(&t->rows[r], c->signal);
        if (isfinite(value)) {
            add_to_column(&column, pixel_y(f, value));
        } else {
            end_column(cr, &column);
            column.any = false;
            cairo_new_sub_path(cr);
        }
        r++;
    }
    end_column(cr, &column);
}

// Traces a curve of few rows, with a point for each.
static void trace_rows(cairo_t *cr, const pane_frame *f, const pane_curve *c,
                       double until)
{
    const trace *t = c->rows;
    for (size_t r = trace_row_at(t, f->from); r < t->row_count; r++) {
        const double value = signal_value(&t->rows[r], c->signal), time = t->rows[r].time;
        if (time > until && (c->until < f->to || time > f->to)) {
            // the line leaves the pane on its right
            if (c->until >= f->to && isfinite(value)) {
                cairo_line_to(cr, pixel_x(f, time), pixel_y(f, value));
            }
            break;
        }
        if (isfinite(value)) {
            cairo_line_to(cr, pixel_x(f, time), pixel_y(f, value));
        } else {
            cairo_new_sub_path(cr);
        }
    }
}

// Draws a curve, by columns of pixels where it has more than two rows for each column,
// else row by row.
void pane_curve_paint(cairo_t *cr, const pane_frame *f, const pane_curve *c)
{
    assert(f->to > f->from && f->high > f->low && f->width > 0 && f->height > 0);
    const trace *t = c->rows;
    const double until = fmin(c->until, f->to);
    const double shown = (double)(trace_row_at(t, f->to) - trace_row_at(t, f->from));

    cairo_new_path(cr);
    if (shown > 2 * f->width) {
        trace_columns(cr, f, c, until);
    } else {
        trace_rows(cr, f, c, until);
    }
    set_curve_pen(cr, f, c);
    cairo_stroke(cr);
}

// Draws a straight line a pixel wide, dotted or whole.
static void hairline(cairo_t *cr, double x0, double y0, double x1, double y1, bool dotted,
                     colour in)
{
    static const double dots[] = {1, 3};
    const int lengths = dotted ? 2 : 0;
    cairo_new_path(cr);
    cairo_set_dash(cr, dots, lengths, 0);
    cairo_set_line_width(cr, 1);
    set_colour(cr, in);
    picture_line(cr, x0, y0, x1, y1);
}

void pane_level_paint(cairo_t *cr, const pane_frame *f, double value, colour in)
{
    const double y = floor(pixel_y(f, value)) + 0.5;
    if (value >= f->low && value <= f->high) {
        hairline(cr, 0, y, f->width, y, true, in);
    }
}

void pane_instant_paint(cairo_t *cr, const pane_frame *f, double time, colour in)
{
    const double x = floor(fmin(pixel_x(f, time), f->width - 1)) + 0.5;
    if (time >= f->from && time <= f->to) {
        hairline(cr, x, 0, x, f->height, false, in);
    }
}
