// The panels of the terminal lab, drawn into a grid of cells.
#include "ui/lab_state.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/predict/linearised.h"
#include "src/predict/predict.h"

#define NOTHING 1e-12 // a smaller value is rounding, and shown as 0

enum { LEAST_WIDTH = 40, LEAST_HEIGHT = 12, LABEL_WIDTH = 9 };

typedef struct area {
    int x, y, width, height; // [cells]
} area;

// A number in at most nine cells.
static void short_number(char *text, size_t size, double value)
{
    if (!isfinite(value)) {
        snprintf(text, size, "-");
    } else if (fabs(value) < NOTHING) {
        snprintf(text, size, "0");
    } else if (fabs(value) < 1e-3 || fabs(value) >= 1e5) {
        snprintf(text, size, "%.2e", value);
    } else {
        snprintf(text, size, "%.4g", value);
    }
}

// --- the arm ----------------------------------------------------------------------------------

typedef struct point {
    double x, y; // [m]
} point;

// From metres to the dots of a canvas, the height magnified.
typedef struct view {
    canvas canvas;
    double left, bottom; // [m]
    double scale;        // [dots/m] across
    double magnified;    // times that, up
} view;

static double dot_x(const view *v, double x)
{
    return (x - v->left) * v->scale;
}

static double dot_y(const view *v, double y)
{
    return 4.0 * v->canvas.height - 1 - (y - v->bottom) * v->scale * v->magnified;
}

// The angle of a link in a recorded row.
static double link_angle(const trace *t, int links, size_t row, int link)
{
    return t->angles[row * (size_t)t->angle_count + (size_t)(t->angle_count - links + link)];
}

// What the arm sweeps over in the whole run.
static void find_extent(lab *l)
{
    const session *s = &l->session;
    const trace *t = &s->run.trace;
    const arm_parameters *beam = &s->effective.parameters.arm;
    if (l->extent.version == s->version) {
        return;
    }
    double low = 0, high = 0, most = 0;
    size_t stride = t->row_count / 2000 + 1;
    for (size_t r = 0; r < t->row_count; r += stride) {
        double y = 0;
        for (int i = 0; i < beam->links; i++) {
            double angle = link_angle(t, beam->links, r, i);
            y += beam->length / beam->links * sin(angle);
            most = fmax(most, fabs(angle));
            low = fmin(low, y);
            high = fmax(high, y);
        }
    }
    l->extent.version = s->version;
    l->extent.lowest = low;
    l->extent.highest = high;
    l->extent.most_angle = most;
}

static view make_view(lab *l, canvas c)
{
    const parameters *p = &l->session.effective.parameters;
    double length = p->arm.length;
    view v = {.canvas = c, .magnified = 1};
    find_extent(l);
    if (l->extent.most_angle > 0.8) {
        // far out: the whole circle, undistorted
        v.scale = fmin(2.0 * c.width, 4.0 * c.height) / (2.3 * length);
        v.left = -c.width / v.scale;
        v.bottom = -2.0 * c.height / v.scale;
        return v;
    }
    double low = l->extent.lowest, high = l->extent.highest;
    if (p->wall.kind != WALL_NONE) {
        low = fmin(low, length * sin(p->wall.angle));
        high = fmax(high, length * sin(p->wall.angle));
    }
    v.scale = 2.0 * c.width / (1.25 * length);
    v.left = -0.1 * length;
    double room = 4.0 * c.height * 0.62 / fmax(v.scale * (high - low), 1e-9);
    static const double factors[] = {20, 10, 5, 4, 3, 2, 1.5};
    for (size_t i = 0; i < sizeof factors / sizeof factors[0]; i++) {
        if (factors[i] <= room) {
            v.magnified = factors[i];
            break;
        }
    }
    // the force's arrow comes from above, so leave more room there
    double spare = 4.0 * c.height / (v.scale * v.magnified) - (high - low);
    v.bottom = low - 0.3 * spare;
    return v;
}

static point draw_links(const view *v, const trace *t, const arm_parameters *beam, size_t row,
                        ink colour, bool dotted)
{
    point at = {0, 0};
    double part = beam->length / beam->links;
    for (int i = 0; i < beam->links; i++) {
        double angle = link_angle(t, beam->links, row, i);
        point to = {at.x + part * cos(angle), at.y + part * sin(angle)};
        for (int k = 0; dotted && k < 40; k++) {
            double share = k / 40.0;
            canvas_dot(&v->canvas, lround(dot_x(v, at.x + share * (to.x - at.x))),
                       lround(dot_y(v, at.y + share * (to.y - at.y))), colour);
        }
        for (int thick = 0; !dotted && thick < 2; thick++) {
            canvas_line(&v->canvas, dot_x(v, at.x), dot_y(v, at.y) + thick, dot_x(v, to.x),
                        dot_y(v, to.y) + thick, colour);
        }
        at = to;
    }
    return at;
}

static void draw_hub(const view *v, double angle)
{
    const double radius = 5;
    double x = dot_x(v, 0), y = dot_y(v, 0);
    for (int i = 0; i < 48; i++) {
        double turn = i * 6.283185307 / 48;
        canvas_dot(&v->canvas, lround(x + radius * cos(turn)), lround(y + radius * sin(turn)),
                   INK_HUB);
    }
    canvas_line(&v->canvas, x, y, x + radius * cos(angle), y - radius * sin(angle), INK_HUB);
}

static void draw_wall(const view *v, const parameters *p)
{
    double x = p->arm.length * cos(p->wall.angle), y = p->arm.length * sin(p->wall.angle);
    int column = v->canvas.x + (int)(dot_x(v, x) / 2), row = v->canvas.y + (int)(dot_y(v, y) / 4);
    bool inside = row > v->canvas.y && row < v->canvas.y + v->canvas.height;
    if (p->wall.kind == WALL_PLANE) {
        canvas_line(&v->canvas, dot_x(v, 0.8 * x), dot_y(v, 0.8 * y), dot_x(v, 1.1 * x),
                    dot_y(v, 1.1 * y), INK_WALL);
    }
    if (p->wall.kind != WALL_NONE && inside) {
        // the cell beyond the wall, on the side that the arm cannot reach
        for (int i = 0; i < 3; i++) {
            screen_put(v->canvas.screen, column + i, row - 1, 0x2592, INK_WALL);
        }
        screen_put(v->canvas.screen, column + 1, row, 0x25c6, INK_WALL);
    }
}

// An arrow that pushes on the arm at its tip, as long as the force is a share of the run's peak.
static void draw_force(const view *v, point tip, double force, double peak)
{
    if (!(force > 0) || !(peak > 0)) {
        return;
    }
    double x = dot_x(v, tip.x), y = dot_y(v, tip.y), length = 1.2 * v->canvas.height * force / peak;
    int column = v->canvas.x + (int)(x / 2), row = v->canvas.y + (int)(y / 4);
    canvas_line(&v->canvas, x - 2, y - 8 - length, x - 2, y - 6, INK_FORCE);
    if (row - 1 > v->canvas.y) {
        screen_put(v->canvas.screen, column - 1, row - 1, 0x25bc, INK_FORCE);
        screen_print(v->canvas.screen, column - 11, row - 2, 9, INK_FORCE, "%7.3f N", force);
    }
}

static void draw_arm(lab *l, screen *s, area a)
{
    const session *e = &l->session;
    const parameters *p = &e->effective.parameters;
    const sample *row = session_sample(e);
    char title[LAB_TEXT];
    view v = make_view(l, (canvas){s, a.x + 1, a.y + 1, a.width - 2, a.height - 2});
    if (v.magnified != 1) {
        snprintf(title, sizeof title, "arm, drawn %g times as high", v.magnified);
    } else {
        snprintf(title, sizeof title, "arm");
    }
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);
    draw_wall(&v, p);
    if (e->has_other && e->other.trace.angle_count == e->run.trace.angle_count) {
        draw_links(&v, &e->other.trace, &p->arm, trace_row_at(&e->other.trace, e->now), INK_OTHER,
                   true);
    }
    draw_hub(&v, row->hub_angle);
    point tip = draw_links(&v, &e->run.trace, &p->arm, e->row, INK_ARM, false);
    draw_force(&v, tip, row->contact != 0 ? row->force : 0, e->run.summary.peak_force_N);
    if (row->sticking != 0) {
        screen_text(s, a.x + 2, a.y + a.height - 2, 12, INK_DIM, "hub sticks");
    }
}

// --- curves -----------------------------------------------------------------------------------

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
        short_number(value, sizeof value, signal_value(row, pane->signals[k]));
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
    short_number(text, sizeof text, f.high);
    screen_print(s, a.x, a.y + 1, LABEL_WIDTH, INK_DIM, "%9s", text);
    // rounding beside the other end of the axis is shown as 0
    short_number(text, sizeof text, fabs(f.low) < 1e-9 * f.high ? 0 : f.low);
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

static void draw_curves(lab *l, screen *s, area a)
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

// --- the right side ---------------------------------------------------------------------------

// The first line to show so that the selected one is in the window.
static int first_line(int selected, int count, int height)
{
    int first = selected - height / 2;
    first = first > count - height ? count - height : first;
    return first < 0 ? 0 : first;
}

static void draw_parameters(lab *l, screen *s, area a)
{
    parameters p = session_parameters_at(&l->session, l->session.now);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, "parameters (Tab: values)");
    int count = 0, selected = 0, line = 0, height = a.height - 2;
    for (int i = 0; i < parameter_count; i++) {
        selected = i == l->parameter ? count : selected;
        count += lab_applies(l, i);
    }
    int first = first_line(selected, count, height);
    for (int i = 0; i < parameter_count; i++) {
        if (!lab_applies(l, i)) {
            continue;
        }
        int y = a.y + 1 + line++ - first;
        if (y <= a.y || y >= a.y + a.height - 1) {
            continue;
        }
        const parameter_info *info = &parameter_table[i];
        char value[160], shown[200];
        if (info->type == PARAMETER_REAL) {
            snprintf(value, sizeof value, "%.6g", parameter_get(&p, i));
        } else {
            parameter_format(&p, i, value, sizeof value);
        }
        snprintf(shown, sizeof shown, "%.12s %s", value, info->unit);
        int room = a.width - 4, start = room - (int)strlen(shown);
        bool given = l->session.effective.parameters.set[i] != 0;
        screen_text(s, a.x + 2, y, room, given ? INK_TITLE : INK_TEXT, info->path);
        screen_text(s, a.x + 2 + (start < 18 ? 18 : start), y, start < 18 ? room - 18 : room,
                    info->timed ? INK_ARM : INK_DIM, shown);
        if (i == l->parameter) {
            screen_tint(s, a.x + 1, y, a.width - 2, 1, INK_SELECTED);
        }
    }
}

static void draw_values(lab *l, screen *s, area a)
{
    const session *e = &l->session;
    const sample *row = session_sample(e), *beside = NULL;
    const char *against = "";
    if (l->has_mark) {
        beside = &e->run.trace.rows[trace_row_at(&e->run.trace, l->mark)];
        against = ", minus mark";
    } else if (e->has_other) {
        beside = &e->other.trace.rows[trace_row_at(&e->other.trace, e->now)];
        against = ", minus old run";
    }
    char title[64];
    snprintf(title, sizeof title, "values%s", against);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);
    for (int i = 0; i < signal_count && i < a.height - 2; i++) {
        double value = signal_value(row, i), other = beside ? signal_value(beside, i) : 0;
        double difference = value - other, size = fmax(fabs(value), fabs(other));
        bool differs = beside != NULL && fabs(difference) > 1e-6 * size;
        char text[32];
        int y = a.y + 1 + i;
        screen_text(s, a.x + 2, y, 16, INK_TEXT, signal_table[i].name);
        short_number(text, sizeof text, value);
        screen_print(s, a.x + 18, y, a.width - 20, INK_TITLE, "%9s", text);
        if (beside != NULL) {
            short_number(text, sizeof text, difference);
            screen_print(s, a.x + 28, y, a.width - 30, differs ? INK_WARNING : INK_DIM, "%9s",
                         text);
        } else {
            screen_text(s, a.x + 28, y, a.width - 30, INK_DIM, signal_table[i].unit);
        }
    }
}

// The linearised arm's answer for the state in a row; false where it has none.
static bool ask_linearised(const parameters *p, const trace *t, size_t r, prediction *out)
{
    const sample *row = &t->rows[r];
    if (p->arm.model == ARM_PRINTED || t->angle_count > 3 || p->arm.links > 2) {
        return false;
    }
    arm a;
    arm_init(&a, p);
    motion *work = motion_create(&a, &p->method);
    if (work == NULL) {
        return false;
    }
    double w[3] = {row->hub_velocity, row->first_velocity, row->last_velocity};
    if (t->angle_count < 3) {
        w[0] = row->first_velocity;
        w[1] = row->last_velocity;
    }
    status code = predict_linearised(&a, work, t->angles + r * (size_t)t->angle_count, w, out);
    motion_destroy(work);
    return code == STATUS_OK;
}

// The row whose touch is asked about: the present one in free flight, else the last free one.
static size_t free_row(const session *s)
{
    const trace *t = &s->run.trace;
    size_t r = s->row;
    if (t->rows[r].contact != 0) {
        for (size_t i = 0; i < t->event_count && t->events[i].time <= s->now; i++) {
            bool touches = t->events[i].kind == EVENT_IMPACT || t->events[i].kind == EVENT_CONTACT;
            r = touches ? trace_row_at(t, t->events[i].time) : r;
        }
        while (r > 0 && t->rows[r].contact != 0) {
            r--;
        }
    }
    return r;
}

// The largest force of the contact that begins after a row, as far as it has been seen.
static prediction what_came(const session *s, size_t r)
{
    const trace *t = &s->run.trace;
    prediction came = {.holds = true, .force = 0, .delay = 0};
    double start = t->rows[r].time;
    for (r++; r < t->row_count && t->rows[r].contact != 0 && t->rows[r].time <= s->seen; r++) {
        if (t->rows[r].force > came.force) {
            came.force = t->rows[r].force;
            came.delay = t->rows[r].time - start;
        }
    }
    return came;
}

static void predictor_line(screen *s, area a, int line, const char *label, const prediction *p,
                           bool known)
{
    int y = a.y + 1 + line;
    if (y >= a.y + a.height - 1) {
        return;
    }
    screen_text(s, a.x + 2, y, a.width - 4, INK_TEXT, label);
    if (!known) {
        screen_text(s, a.x + 18, y, a.width - 20, INK_DIM, "-");
    } else if (!p->holds) {
        screen_text(s, a.x + 18, y, a.width - 20, INK_DIM, "would not hold");
    } else if (isfinite(p->delay)) {
        screen_print(s, a.x + 18, y, a.width - 20, INK_FORCE, "%.3f N in %.0f ms", p->force,
                     1e3 * p->delay);
    } else {
        screen_print(s, a.x + 18, y, a.width - 20, INK_FORCE, "%.3f N", p->force);
    }
}

static void draw_predictors(lab *l, screen *s, area a)
{
    const session *e = &l->session;
    size_t r = free_row(e);
    const sample *row = &e->run.trace.rows[r];
    bool touches = session_sample(e)->contact != 0;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME,
                 touches ? "when it touched: peak" : "if it touched now: peak");
    parameters p = session_parameters_at(e, row->time);
    three_body_state state = {{row->hub_angle, row->first_angle, row->last_angle},
                              {row->hub_velocity, row->first_velocity, row->last_velocity}};
    prediction out = {0};
    fault ignored;
    bool known = predict_energy(&p, &state, &out, &ignored) == STATUS_OK;
    predictor_line(s, a, 0, "energy", &out, known);
    known = predict_impact_dynamics(&p, &state, &out, &ignored) == STATUS_OK;
    predictor_line(s, a, 1, "impact dynamics", &out, known);
    known = ask_linearised(&p, &e->run.trace, r, &out);
    predictor_line(s, a, 2, "linearised", &out, known);
    if (touches) {
        out = what_came(e, r);
        predictor_line(s, a, 3, "what came", &out, true);
    } else {
        const summary *m = &e->run.summary;
        out = (prediction){
            .holds = true, .force = m->first_pulse_peak_N, .delay = m->first_pulse_time_to_peak_s};
        bool seen = e->seen >= m->first_contact_s + m->first_pulse_time_to_peak_s;
        predictor_line(s, a, 3, "first pulse", &out, seen);
    }
}

static void draw_log(lab *l, screen *s, area a)
{
    const session *e = &l->session;
    const trace *t = &e->run.trace;
    size_t seen = 0;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, "events (n, N)");
    while (seen < t->event_count && t->events[seen].time <= e->seen) {
        seen++;
    }
    // the present event in the middle, or the last ones
    int current = 0, height = a.height - 2;
    for (size_t i = 0; i < seen; i++) {
        current = t->events[i].time <= e->now ? (int)i : current;
    }
    int first = first_line(current, (int)seen, height);
    for (int i = first; i < (int)seen && i < first + height; i++) {
        const event *v = &t->events[i];
        int y = a.y + 1 + i - first;
        screen_print(s, a.x + 2, y, a.width - 4, INK_TEXT, "%9.5f s  %s", v->time,
                     event_name(v->kind));
        if (v->kind == EVENT_IMPACT || v->kind == EVENT_PUSH) {
            screen_print(s, a.x + 22, y, a.width - 24, INK_EVENT, "%.3g N s", v->impulse);
        } else if (v->kind == EVENT_CHANGE && v->index >= 0) {
            const action *c = &e->effective.actions[v->index];
            screen_print(s, a.x + 22, y, a.width - 24, INK_EVENT, "%s",
                         parameter_table[c->parameter].path);
        }
        if (v->time == e->now) {
            screen_tint(s, a.x + 1, y, a.width - 2, 1, INK_SELECTED);
        }
    }
}

// --- overlays ---------------------------------------------------------------------------------

static area middle_of(const screen *s, int width, int height)
{
    width = width > s->width - 2 ? s->width - 2 : width;
    height = height > s->height - 3 ? s->height - 3 : height;
    return (area){(s->width - width) / 2, 1 + (s->height - 3 - height) / 2, width, height};
}

static void draw_help(lab *l, screen *s)
{
    int count = 0;
    while (lab_help_line(count) != NULL) {
        count++;
    }
    area a = middle_of(s, 110, count + 4);
    int shown = a.height - 4;
    l->scroll = l->scroll > count - shown ? count - shown : l->scroll;
    l->scroll = l->scroll < 0 ? 0 : l->scroll;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR,
                 shown < count ? "keys and commands (arrows scroll, Esc closes)"
                               : "keys and commands (Esc closes)");
    screen_text(
        s, a.x + 2, a.y + 1, a.width - 4, INK_DIM,
        "/ filters the list of scenarios; : takes a command, Tab completes it; Esc goes back");
    for (int i = 0; i < shown; i++) {
        const char *line = lab_help_line(l->scroll + i);
        if (line != NULL) {
            screen_text(s, a.x + 2, a.y + 3 + i, a.width - 4, INK_TEXT, line);
            screen_tint(s, a.x + 2, a.y + 3 + i, a.width - 4 < 27 ? a.width - 4 : 27, 1, INK_TITLE);
        }
    }
}

static void draw_list(lab *l, screen *s)
{
    int count = 0, selected = 0, line = 0;
    for (int i = 0; i < l->name_count; i++) {
        selected = i == l->scroll ? count : selected;
        count += lab_listed(l, l->names[i]);
    }
    area a = middle_of(s, 60, l->name_count + 4);
    int height = a.height - 4, first = first_line(selected, count, height);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR, "scenarios (Enter opens)");
    screen_print(s, a.x + 2, a.y + 1, a.width - 4, INK_DIM, "/ filter: %s%s", l->filter,
                 l->filtering ? "_" : "");
    for (int i = 0; i < l->name_count; i++) {
        if (!lab_listed(l, l->names[i])) {
            continue;
        }
        int y = a.y + 3 + line++ - first;
        if (y < a.y + 3 || y >= a.y + a.height - 1) {
            continue;
        }
        screen_text(s, a.x + 2, y, a.width - 4, INK_TEXT, l->names[i]);
        if (i == l->scroll) {
            screen_tint(s, a.x + 1, y, a.width - 2, 1, INK_SELECTED);
        }
    }
}

static void draw_comparison(lab *l, screen *s)
{
    const session *e = &l->session;
    area a = middle_of(s, 76, summary_count + 4);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_CURSOR,
                 e->has_other ? "this run beside the old one" : "this run (b branches)");
    screen_print(s, a.x + 2, a.y + 1, a.width - 4, INK_DIM, "%-28s %11s %11s %11s", "", "this run",
                 e->has_other ? "old run" : "", e->has_other ? "change" : "");
    int line = 0;
    for (int i = 0; i < summary_count && line < a.height - 3; i++) {
        const char *key = summary_table[i].key;
        double value = (double)NAN, other = (double)NAN;
        char one[32], two[32] = "", change[32] = "";
        if (summary_table[i].timing) {
            continue;
        }
        summary_get(&e->run.summary, key, &value);
        short_number(one, sizeof one, value);
        if (e->has_other) {
            summary_get(&e->other.summary, key, &other);
            short_number(two, sizeof two, other);
            short_number(change, sizeof change, value - other);
        }
        bool same = fabs(value - other) <= 1e-6 * fmax(fabs(value), fabs(other));
        bool none = isnan(value) && isnan(other);
        screen_print(s, a.x + 2, a.y + 2 + line++, a.width - 4,
                     !e->has_other || same || none ? INK_TEXT : INK_WARNING, "%-28s %11s %11s %11s",
                     key, one, two, change);
    }
}

// --- the whole --------------------------------------------------------------------------------

static void draw_title(lab *l, screen *s)
{
    const session *e = &l->session;
    int x = 1 + screen_print(s, 1, 0, s->width - 2, INK_TITLE, "impactlab  %s", e->base.name);
    x += screen_print(s, x + 2, 0, s->width - x - 3, INK_TEXT, "%s",
                      e->base.title ? e->base.title : "");
    if (e->input_count > 0) {
        screen_print(s, x + 3, 0, s->width - x - 4, INK_EVENT, "(%d change%s)", e->input_count,
                     e->input_count == 1 ? "" : "s");
    }
}

static void draw_status(lab *l, screen *s, int y)
{
    const session *e = &l->session;
    const sample *row = session_sample(e);
    const parameters *p = &e->effective.parameters;
    bool failed = e->run.summary.status != STATUS_OK;
    bool old = e->now < e->seen;
    const char *state = l->playing                           ? (old ? "replaying" : "playing")
                        : failed && e->now >= session_end(e) ? "diverged"
                                                             : "paused";
    char model[64], mark[64] = "", law[64] = "", speed[32] = "";
    parameter_format(p, parameter_find("arm.model"), model, sizeof model);
    if (p->control.law != LAW_NONE) {
        char name[40];
        parameter_format(p, parameter_find("control.law"), name, sizeof name);
        snprintf(law, sizeof law, ", %s", name);
    }
    if (l->has_mark) {
        snprintf(mark, sizeof mark, "  from mark %.5g s", e->now - l->mark);
    }
    if (l->playing) {
        snprintf(speed, sizeof speed, " (%.3g)", l->measured);
    }
    screen_text(s, 0, y, s->width, INK_SELECTED, "");
    int x = screen_print(
        s, 0, y, s->width, INK_TEXT, " %s %-9s  t %.5f s  row %zu/%zu  \u00d7%g%s  %s%s  %s%s%s",
        l->playing ? "\u25b6" : "\u2016", state, e->now, e->row + 1, e->run.trace.row_count,
        l->speed, speed, model, law, row->contact != 0 ? "in contact" : "free flight",
        row->sticking != 0 ? ", hub sticks" : "", mark);
    for (; x < s->width; x++) {
        screen_put(s, x, y, ' ', INK_TEXT);
    }
    screen_tint(s, 0, y, s->width, 1, failed && !l->playing ? INK_WARNING : INK_SELECTED);
}

static void draw_bottom(lab *l, screen *s, int y)
{
    if (l->prompting) {
        int x = screen_print(s, 0, y, s->width, INK_TITLE, ":%s", l->prompt);
        screen_put(s, x, y, ' ', INK_SELECTED);
        if (l->message[0] != '\0') {
            screen_print(s, x + 3, y, s->width - x - 3, INK_DIM, "%s", l->message);
        }
    } else if (l->message[0] != '\0') {
        screen_print(s, 1, y, s->width - 2, l->warning ? INK_WARNING : INK_TEXT, "%s", l->message);
    } else {
        screen_text(
            s, 1, y, s->width - 2, INK_DIM,
            "Space run/pause  \u25c0 \u25b6 step  n/N event  +/- speed  Enter change value  "
            "b branch  c compare  o open  s save  ? help  q quit");
    }
}

static void draw_panels(lab *l, screen *s)
{
    int right = s->width >= 100 ? 40 : s->width >= 72 ? 34 : 0;
    int left = s->width - right, body = s->height - 3;
    int arm_height = body >= 20 ? body * 2 / 5 : body / 2;
    draw_arm(l, s, (area){0, 1, left, arm_height});
    draw_curves(l, s, (area){0, 1 + arm_height, left, body - arm_height});
    if (right == 0) {
        return;
    }
    int predictors = body >= 18 ? 6 : 0, log = body >= 26 ? body / 4 : 0;
    int top = body - predictors - log;
    area side = {left, 1, right, top};
    if (l->side == SIDE_VALUES) {
        draw_values(l, s, side);
    } else {
        draw_parameters(l, s, side);
    }
    if (predictors > 0) {
        draw_predictors(l, s, (area){left, 1 + top, right, predictors});
    }
    if (log > 0) {
        draw_log(l, s, (area){left, 1 + top + predictors, right, log});
    }
}

void lab_draw(lab *l, screen *s)
{
    screen_clear(s);
    l->plot_width = l->plot_height = 0;
    l->width = s->width;
    l->height = s->height;
    if (s->width < LEAST_WIDTH || s->height < LEAST_HEIGHT) {
        screen_print(s, 0, 0, s->width, INK_WARNING, "%d x %d: the lab needs %d x %d (q quits)",
                     s->width, s->height, LEAST_WIDTH, LEAST_HEIGHT);
        return;
    }
    draw_title(l, s);
    draw_panels(l, s);
    if (l->overlay == OVERLAY_HELP) {
        draw_help(l, s);
    } else if (l->overlay == OVERLAY_OPEN) {
        draw_list(l, s);
    } else if (l->overlay == OVERLAY_COMPARE) {
        draw_comparison(l, s);
    }
    draw_status(l, s, s->height - 2);
    draw_bottom(l, s, s->height - 1);
}
