// Curves: the values of a series, and its line cut to a panel and drawn.
#include "render/plot/axis.h"

#include <math.h>
#include <string.h>

#define COLUMN     0.12 // width of a column [pt]
#define CLIP_SPACE 4.0  // kept round the plane, so that line ends stay out of sight [pt]
#define FARTHEST   1e9  // coordinates are limited to this [pt]

double plane_x(const plane *p, double x)
{
    return p->box.x + p->box.width * scale_share(&p->x, x);
}

double plane_y(const plane *p, double y)
{
    double at = scale_coordinate(p->y.kind, y);
    return p->box.y + p->box.height * ((p->y.high - at) / (p->y.high - p->y.low));
}

// Value `index` of an array whose values lie the series' stride in bytes apart (0: the
// size of a double).
static double value_at(const figure_series *s, const double *values, size_t index)
{
    double value;
    size_t stride = s->stride;
    if (stride == 0) {
        stride = sizeof value;
    }
    memcpy(&value, (const char *)values + index * stride, sizeof value);
    return value;
}

double series_x(const figure_series *s, size_t index)
{
    return value_at(s, s->x, index);
}

double series_y(const figure_series *s, size_t index)
{
    return value_at(s, s->y, index);
}

double series_shade(const figure_series *s, size_t index)
{
    if (s->shade == NULL) {
        return (double)NAN;
    }
    return value_at(s, s->shade, index);
}

void series_include_y(const figure_series *s, const axis_scale *within, axis_scale *y)
{
    for (size_t i = 0; i < s->count; i++) {
        if (scale_holds(within, series_x(s, i))) {
            scale_include(y, series_y(s, i));
        }
    }
}

// ---- clipping

typedef struct point {
    double x, y;
} point;

// A pen that follows a line point by point and hands the parts inside a rectangle to a
// sink.
typedef struct pen {
    double left, top, right, bottom;
    stroke_sink sink;
    void *context;
    point last;        // last point given, inside or not
    bool has_point;    // a line is in progress
    bool sink_at_last; // the sink's line ends at `last`
    bool alone;        // `last` is the only point of its line
} pen;

static bool inside(const pen *p, point q)
{
    return q.x >= p->left && q.x <= p->right && q.y >= p->top && q.y <= p->bottom;
}

// Narrows [*from, *to] to the shares t of a line at which start + t delta lies between
// low and high (Liang and Barsky's clipping). False if none is left.
static bool clip_share(double start, double delta, double low, double high, double *from,
                       double *to)
{
    if (delta == 0) {
        return start >= low && start <= high;
    }

    // the shares at which it crosses the two borders
    const double at_low = (low - start) / delta, at_high = (high - start) / delta;
    *from = fmax(*from, fmin(at_low, at_high));
    *to = fmin(*to, fmax(at_low, at_high));
    return *from <= *to;
}

// Ends a line. A point that stayed alone becomes a dot.
static void pen_lift(pen *p)
{
    if (p->has_point && p->alone && inside(p, p->last)) {
        p->sink(p->context, STROKE_DOT, p->last.x, p->last.y);
    }
    p->has_point = p->sink_at_last = false;
}

// Continues the line to q, or begins one there. The sink gets the part that lies inside,
// with a move before it where the sink's line does not end at its beginning.
static void pen_to(pen *p, point q)
{
    q.x = fmax(-FARTHEST, fmin(FARTHEST, q.x));
    q.y = fmax(-FARTHEST, fmin(FARTHEST, q.y));
    if (p->has_point) {
        point a = p->last;
        double from = 0, to = 1;
        if (clip_share(a.x, q.x - a.x, p->left, p->right, &from, &to) &&
            clip_share(a.y, q.y - a.y, p->top, p->bottom, &from, &to)) {
            if (!p->sink_at_last) {
                p->sink(p->context, STROKE_MOVE, a.x + from * (q.x - a.x),
                        a.y + from * (q.y - a.y));
            }

            // q itself if nothing is cut off, without rounding
            point end = q;
            if (to != 1) {
                end = (point){a.x + to * (q.x - a.x), a.y + to * (q.y - a.y)};
            }
            p->sink(p->context, STROKE_LINE, end.x, end.y);
            p->sink_at_last = to == 1;
        } else {
            p->sink_at_last = false;
        }
    }
    p->alone = !p->has_point;
    p->has_point = true;
    p->last = q;
}

// ---- decimation

// A point with its number.
typedef struct numbered {
    point at;
    size_t number;
} numbered;

// The points of one narrow column that show: the first, the last, and those of the
// greatest and the least y. Their numbers keep their order.
typedef struct column {
    double index; // of the column
    size_t count;
    numbered first, low, high, last;
} column;

// Takes a further point into a column; y points down.
static void column_add(column *c, numbered q)
{
    c->count++;
    c->last = q;
    if (q.at.y > c->low.at.y) {
        c->low = q;
    }
    if (q.at.y < c->high.at.y) {
        c->high = q;
    }
}

// Hands the points of a column that show to the pen, in their order and each once, and
// empties the column.
static void column_flush(column *c, pen *p)
{
    if (c->count == 0) {
        return;
    }

    // a point that is two of these at once has the same number twice in a row
    numbered all[] = {c->first, c->low, c->high, c->last};
    if (c->low.number >= c->high.number) {
        all[1] = c->high;
        all[2] = c->low;
    }
    for (int i = 0; i < 4; i++) {
        if (i == 0 || all[i].number > all[i - 1].number) {
            pen_to(p, all[i].at);
        }
    }
    c->count = 0;
}

// Whether x never decreases along a series, which reduction by columns needs.
static bool x_ascends(const figure_series *s)
{
    double last = -(double)INFINITY;
    for (size_t i = 0; i < s->count; i++) {
        double x = series_x(s, i);
        if (x < last) {
            return false;
        }
        if (!isnan(x)) {
            last = x;
        }
    }
    return true;
}

// Hands the strokes of a series to a sink: clipped at the plane's edge and with a gap at
// every missing point. Where points are many, only those that show in their column of the
// page are used.
void curve_trace(const plane *p, const figure_series *s, stroke_sink sink, void *context)
{
    pen tip = {.left = p->box.x - CLIP_SPACE,
               .top = p->box.y - CLIP_SPACE,
               .right = p->box.x + p->box.width + CLIP_SPACE,
               .bottom = p->box.y + p->box.height + CLIP_SPACE,
               .sink = sink,
               .context = context};

    // columns only if there are many more points than columns
    bool columns = (double)s->count > 4 * p->box.width / COLUMN && x_ascends(s);
    column c = {.count = 0};

    for (size_t i = 0; i < s->count; i++) {
        double x = series_x(s, i), y = series_y(s, i);
        if (!isfinite(scale_coordinate(p->x.kind, x)) ||
            !isfinite(scale_coordinate(p->y.kind, y))) {
            column_flush(&c, &tip);
            pen_lift(&tip);
            continue;
        }

        // a point joins the present column, or begins a new one
        point q = {plane_x(p, x), plane_y(p, y)};
        double index = floor((q.x - p->box.x) / COLUMN);
        if (columns && c.count > 0 && index == c.index) {
            column_add(&c, (numbered){q, i});
            continue;
        }
        column_flush(&c, &tip);
        if (columns) {
            const numbered only = {q, i};
            c = (column){index, 1, only, only, only, only};
        } else {
            pen_to(&tip, q);
        }
    }
    column_flush(&c, &tip);
    pen_lift(&tip);
}
