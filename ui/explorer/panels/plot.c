// Drawing in a pane of curves over time, as dots or as pixels, and its axes.
#include "ui/explorer/panels/plot.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "render/drawing.h"
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

// The column of dots at which an instant [s] lies.
static double plot_x(const plot_frame *f, double time)
{
    return (time - f->from) / (f->to - f->from) * (2.0 * f->canvas.width - 1);
}

// The row of dots at which a value lies.
static double plot_y(const plot_frame *f, double value)
{
    return (f->axis.high - value) / (f->axis.high - f->axis.low) *
           (4.0 * f->canvas.height - 1);
}

// Every row joined to the next one by a line, as long as they are visible and seen; the
// line's pattern is that of where it ends.
static void draw_rows(const plot_frame *f, const trace *t, int signal, double until)
{
    double x0 = (double)NAN, y0 = (double)NAN;
    for (size_t r = trace_row_at(t, f->from); r < t->row_count; r++) {
        const sample *row = &t->rows[r];
        if (row->time > until) {
            break;
        }
        const double x = plot_x(f, row->time), y = plot_y(f, signal_value(row, signal));
        if (line_has_dot(f->pattern, lround(x))) {
            canvas_line(&f->canvas, x0, y0, x, y, f->colour);
        }
        x0 = x;
        y0 = y;

        // the first one beyond the window is the last
        if (row->time > f->to) {
            break;
        }
    }
}

// One column of dots; a high one is drawn in any case, so that no spike falls into a gap
// of the pattern.
static void draw_column(const plot_frame *f, long column, value_range y)
{
    enum { HIGH = 4 }; // dots
    if (y.high < y.low) {
        return;
    }
    if (y.high - y.low > HIGH || line_has_dot(f->pattern, column)) {
        canvas_line(&f->canvas, (double)column, y.low, (double)column, y.high, f->colour);
    }
}

// Whether the block of rows from r on, whose least and greatest values are known, lies
// within a column and before an instant.
static bool block_is_in_column(const plot_frame *f, const trace *t, size_t r,
                               double until, long column)
{
    const size_t end = r + EXTREMES_BLOCK;
    return r % EXTREMES_BLOCK == 0 && end < t->row_count && t->rows[end].time <= until &&
           lround(plot_x(f, t->rows[end].time)) == column;
}

// The smallest and the largest value of each column of dots, so that no spike is lost.
// Blocks that lie within one column are taken from `pairs`.
static void draw_columns(const plot_frame *f, const trace *t, int signal, double until,
                         const double *pairs)
{
    value_range y = value_range_empty;
    double last = (double)NAN;
    long column = -1;
    size_t r = trace_row_at(t, f->from);
    while (r < t->row_count && t->rows[r].time <= until) {
        // the next column goes on where the last one ended, so that curves hang together
        const long here = lround(plot_x(f, t->rows[r].time));
        if (here != column) {
            draw_column(f, column, y);
            column = here;
            y = value_range_empty;
            value_range_add(&y, last);
        }

        // a block at once, or a row
        size_t taken = 1;
        if (pairs != NULL && block_is_in_column(f, t, r, until, column)) {
            const double *pair = pairs + 2 * (r / EXTREMES_BLOCK);
            value_range_add(&y, plot_y(f, pair[1]));
            value_range_add(&y, plot_y(f, pair[0]));
            taken = EXTREMES_BLOCK;
        }
        last = plot_y(f, signal_value(&t->rows[r + taken - 1], signal));
        value_range_add(&y, last);
        r += taken;
    }
    draw_column(f, column, y);
}

colour picture_colour(const screen *s, colour_theme theme, ink i)
{
    const rgb c = picture_ink(s, theme, i);
    return (colour){c.red / 255.0, c.green / 255.0, c.blue / 255.0};
}

// The colour of an ink in the picture of a pane.
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
        drawing()->pane_curve_paint(f->picture, &f->pixels, &c);
        return;
    }

    // few rows one by one, many by the columns that they are in
    const double rows = (double)(trace_row_at(t, f->to) - trace_row_at(t, f->from));
    until = fmin(until, f->to);
    if (rows < 4.0 * f->canvas.width) {
        draw_rows(f, t, signal, until);
    } else {
        draw_columns(f, t, signal, until, pairs);
    }
}

void plot_frame_cursor(const plot_frame *f, screen *s, double time)
{
    if (f->picture != NULL) {
        drawing()->pane_instant_paint(f->picture, &f->pixels, time,
                                      pixel_colour(f, INK_CURSOR));
        return;
    }
    if (!(time >= f->from && time <= f->to)) {
        return;
    }

    // only where nothing is drawn yet
    const int column = f->canvas.x + (int)(plot_x(f, time) / 2);
    for (int y = f->canvas.y; y < f->canvas.y + f->canvas.height; y++) {
        if (s->cells[(long)y * s->width + column].glyph == ' ') {
            screen_put(s, column, y, GLYPH_CURSOR, INK_CURSOR);
        }
    }
}

// A dotted line across the canvas, its name at its end; only where nothing is drawn yet.
static void draw_level_behind(const canvas *c, screen *s, int y, const char *name)
{
    const int end = c->x + c->width, name_at = end - (int)strlen(name);
    for (int x = c->x; x < end; x++) {
        uint32_t glyph = GLYPH_DOTS;
        if (x >= name_at) {
            glyph = (uint32_t)name[x - name_at];
        }
        if (s->cells[(long)y * s->width + x].glyph == ' ') {
            screen_put(s, x, y, glyph, INK_FRAME);
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
    const canvas *c = &f->canvas;
    const double dot = fmax(0, fmin(4.0 * c->height - 1, plot_y(f, value)));
    const int y = c->y + (int)(lround(dot) / 4);
    if (f->picture == NULL) {
        draw_level_behind(c, s, y, name);
        return;
    }
    const int length = (int)strlen(name);
    drawing()->pane_level_paint(f->picture, &f->pixels, value,
                                pixel_colour(f, INK_FRAME));
    screen_text(s, c->x + c->width - length, y, length, INK_FRAME, name);
}

// Whether some cells are blank, or a picture's.
static bool cells_are_free(const screen *s, int x, int y, int count)
{
    for (int i = 0; i < count; i++) {
        const uint32_t glyph = s->cells[(long)y * s->width + x + i].glyph;
        if (glyph != ' ' && glyph < GLYPH_PICTURE) {
            return false;
        }
    }
    return true;
}

bool plot_frame_arrow(const plot_frame *f, screen *s, double time, const char *text)
{
    const canvas *c = &f->canvas;
    if (!(time >= f->from && time <= f->to)) {
        return false;
    }

    // the arrow over the curve, its text behind it, else before it, on blank cells
    const int length = text_cells(text);
    const int x = c->x + (int)(plot_x(f, time) / 2), end = c->x + c->width;
    for (int y = c->y; y < c->y + c->height; y++) {
        const bool behind =
            x + length + 1 < end && cells_are_free(s, x + 1, y, length + 1);
        const bool before =
            x - length - 1 >= c->x && cells_are_free(s, x - length - 1, y, length + 1);
        if (behind || before) {
            screen_put(s, x, y, GLYPH_ARROW_UP, INK_EVENT);
            screen_text(s, behind ? x + 1 : x - length, y, length, INK_EVENT, text);
            return true;
        }
    }
    return false;
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
static long axis_row(value_range axis, int height, double value)
{
    return lround((axis.high - value) / (axis.high - axis.low) * (4.0 * height - 1)) / 4;
}

// Whether no two ticks lie in one row of an axis.
static bool ticks_have_rows(const ticks *t, value_range axis, int height)
{
    for (int i = 1; i < t->count; i++) {
        const long row = axis_row(axis, height, t->value[i]);
        if (row == axis_row(axis, height, t->value[i - 1])) {
            return false;
        }
    }
    return true;
}

// As many ticks as have a row each: one that is left out would make the others look
// uneven.
static void choose_ticks(ticks *t, value_range axis, int height)
{
    int wanted = 3;
    if (height >= 12) {
        wanted = 5;
    } else if (height >= 6) {
        wanted = 4;
    }
    ticks_between(t, axis.low, axis.high, wanted);
    while (wanted > 2 && !ticks_have_rows(t, axis, height)) {
        wanted--;
        ticks_between(t, axis.low, axis.high, wanted);
    }
}

// The tick that labels a row of an axis, -1 if there is none.
static int tick_of_row(const ticks *t, value_range axis, int height, int row)
{
    const bool upper_half = 2 * row < height;
    int best = -1;
    for (int i = 0; i < t->count; i++) {
        if (axis_row(axis, height, t->value[i]) == row &&
            (best < 0 || outranks(t->value[i], t->value[best], upper_half))) {
            best = i;
        }
    }
    return best;
}

void draw_value_axis(screen *s, area a, value_range axis)
{
    assert(axis.high > axis.low);
    ticks t;
    choose_ticks(&t, axis, a.height);
    const int line = a.x + a.width - 1, label_width = a.width - 1;
    for (int row = 0; row < a.height; row++) {
        const int y = a.y + row, tick = tick_of_row(&t, axis, a.height, row);
        if (tick < 0) {
            screen_put(s, line, y, GLYPH_UPRIGHT, INK_FRAME);
            continue;
        }
        char text[TICK_TEXT + 8];
        axis_label(&t, tick, text, sizeof text);
        screen_put(s, line, y, GLYPH_TICK_LEFT, INK_FRAME);
        screen_print(s, a.x, y, label_width, INK_DIM, "%*s", label_width, text);
    }
}

// A tick on the line of a time axis, where no bar is.
static void draw_time_tick(screen *s, int x, int y)
{
    cell *at = &s->cells[(long)y * s->width + x];
    if (at->glyph == GLYPH_LINE) {
        at->glyph = GLYPH_TICK_DOWN;
    }
}

// Seconds below round instants, the unit behind the last one.
static void draw_instants(screen *s, area a, double from, double to)
{
    enum { LABEL = 14 }; // cells that a label may take
    const int end = a.x + a.width;
    const int wanted = a.width / LABEL > 2 ? a.width / LABEL : 2;
    ticks t;
    ticks_between(&t, from, to, wanted);

    // each tick with its label below, unless that would touch the one before
    int free = a.x;
    for (int i = 0; i < t.count; i++) {
        char text[TICK_TEXT + 16];
        const double share = (t.value[i] - from) / (to - from);
        const int x = a.x + (int)(share * (2.0 * a.width - 1) / 2);
        axis_label(&t, i, text, sizeof text);
        if (i == t.count - 1) {
            strcat(text, " s");
        }
        if (x < s->width && x < end) {
            draw_time_tick(s, x, a.y);
        }

        // in the middle below its tick, but within the axis
        const int length = (int)strlen(text);
        int start = x - length / 2;
        if (start + length > end) {
            start = end - length;
        }
        if (start < a.x) {
            start = a.x;
        }
        if (start >= free) {
            screen_text(s, start, a.y + 1, end - start, INK_DIM, text);
            free = start + length + 1;
        }
    }
}

// Whether the arm touches in any of the rows between two instants [s]; of many a few are
// looked at.
static bool touches_between(const trace *t, double from, double to)
{
    enum { LOOKED_AT = 32 };
    const size_t first = trace_row_at(t, from), last = trace_row_at(t, to);
    const size_t stride = (last - first) / LOOKED_AT + 1;
    for (size_t r = first; r <= last; r += stride) {
        if (t->rows[r].contact != 0) {
            return true;
        }
    }
    return false;
}

// Contact of the present run as a bar on the line of the time axis, as far as it was
// seen.
static void draw_contact(const explorer_model *model, const explorer_view *view,
                         screen *s, area line)
{
    const trace *t = &model->session.run.trace;
    const double until = model->session.seen;
    double from, to;
    view_window(model, view, &from, &to);
    for (int i = 0; i < line.width; i++) {
        const double begin = from + (to - from) * i / line.width;
        const double end = fmin(begin + (to - from) / line.width, until);
        if (begin <= until && touches_between(t, begin, end)) {
            screen_put(s, line.x + i, line.y, GLYPH_SHADE, INK_FORCE);
        }
    }

    // a touch that is shorter than a row is long
    for (size_t i = 0; i < t->event_count && t->events[i].time <= until; i++) {
        if (t->events[i].kind == EVENT_CONTACT) {
            const int x = time_column(model, view, line, t->events[i].time);
            screen_put(s, x, line.y, GLYPH_SHADE, INK_FORCE);
        }
    }
}

// A mark for an impact that has been seen and for an input: the coming motion is not
// known yet, coming changes are.
static void draw_event(screen *s, int x, int y, event_kind kind, bool seen)
{
    if (kind == EVENT_IMPACT && seen) {
        screen_put(s, x, y, GLYPH_TRIANGLE, INK_EVENT);
    } else if (event_is_input(kind) && seen) {
        screen_put(s, x, y, GLYPH_DISC, INK_EVENT);
    } else if (event_is_input(kind)) {
        screen_put(s, x, y, GLYPH_CIRCLE, INK_DIM);
    }
}

// Words on the line of the axis, before or behind a mark at column x, where nothing else
// is; false where that has no room.
static bool draw_label(screen *s, area line, int x, bool before, const char *text)
{
    const int length = text_cells(text), start = before ? x - length : x + 1;
    if (x < line.x - 1 || start < line.x || start + length > line.x + line.width) {
        return false;
    }

    // over the line and its ticks only
    for (int i = 0; i < length; i++) {
        const uint32_t glyph = s->cells[(long)line.y * s->width + start + i].glyph;
        if (glyph != GLYPH_LINE && glyph != GLYPH_TICK_DOWN) {
            return false;
        }
    }
    screen_text(s, start, line.y, length, INK_EVENT, text);
    return true;
}

// Where a time axis of one row begins and ends, on its line.
static void draw_ends_of_line(screen *s, area line, double from, double to)
{
    char text[32];
    snprintf(text, sizeof text, "%.4g", from);
    draw_label(s, line, line.x - 1, false, text);
    snprintf(text, sizeof text, "%.4g s", to);
    draw_label(s, line, line.x + line.width, true, text);
}

// When the arm touches, before its mark, and lets go, behind it, as far as that was seen.
static void label_touches(const explorer_model *model, const explorer_view *view,
                          screen *s, area line)
{
    const session *e = &model->session;
    const trace *t = &e->run.trace;
    for (size_t i = 0; i < t->event_count && t->events[i].time <= e->seen; i++) {
        const event *v = &t->events[i];
        const bool touches = v->kind == EVENT_IMPACT || v->kind == EVENT_CONTACT;
        if (touches || v->kind == EVENT_RELEASE) {
            char text[32];
            snprintf(text, sizeof text, "%s %.4g", touches ? "hit" : "off", v->time);
            draw_label(s, line, time_column(model, view, line, v->time), touches, text);
        }
    }
}

// What was changed, behind its mark or before it: a parameter goes without its group.
static void label_changes(const explorer_model *model, const explorer_view *view,
                          screen *s, area line)
{
    const scenario *scripted = &model->session.effective;
    for (int i = 0; i < scripted->action_count; i++) {
        const action *c = &scripted->actions[i];
        char value[PARAMETER_TEXT_SIZE], path[ACTION_PATH], text[LINE_TEXT];
        if (c->kind == ACTION_PUSH) {
            snprintf(text, sizeof text, "push %g", c->value);
        } else {
            const char *name = strchr(action_path(c, path), '.') + 1;
            action_format_value(c, value, sizeof value);
            snprintf(text, sizeof text, "%s %s", name, value);
        }

        const int x = time_column(model, view, line, c->time);
        if (!draw_label(s, line, x, false, text)) {
            draw_label(s, line, x, true, text);
        }
    }
}

area draw_time_axis(const explorer_model *model, const explorer_view *view, screen *s,
                    area a)
{
    const session *e = &model->session;
    const trace *t = &e->run.trace;
    const area below = area_right(a, LABEL_WIDTH + 1), line = area_row(below, 0);
    double from, to;
    view_window(model, view, &from, &to);

    // contact on the line, seconds in the row below it
    for (int x = line.x; x < line.x + line.width; x++) {
        screen_put(s, x, line.y, GLYPH_LINE, INK_FRAME);
    }
    draw_contact(model, view, s, line);
    if (a.height > 1) {
        draw_instants(s, line, from, to);
    }

    // events and notes
    for (size_t i = 0; i < t->event_count; i++) {
        const event *v = &t->events[i];
        const int x = time_column(model, view, line, v->time);
        draw_event(s, x, a.y, v->kind, v->time <= e->seen);
    }
    for (int i = 0; i < model->note_count; i++) {
        const int x = time_column(model, view, line, model->notes[i].time);
        screen_put(s, x, a.y, '!', INK_TITLE);
    }
    label_touches(model, view, s, line);
    label_changes(model, view, s, line);

    // seconds on the line itself, where there is but one row
    if (a.height == 1) {
        draw_ends_of_line(s, line, from, to);
    }

    // the meaning of the marks, next to them
    screen_text(s, a.x, a.y, LABEL_WIDTH, INK_FORCE, "\u2592 contact");
    if (a.height > 1) {
        screen_text(s, a.x, a.y + 1, LABEL_WIDTH, INK_EVENT, "\u25b2 impact");
    }
    return (area){line.x, a.y, line.width, a.height};
}
