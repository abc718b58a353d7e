// Series and impulses on the page: lines, markers, and arrows in a strip above a panel.
#include <math.h>

#include "render/page/picture_file.h"
#include "render/plot/drawing.h"
#include "render/plot/run_style.h"

#define MARKER_RADIUS 1.6
#define BUSY_WIDER    1.7 // factor of a busy line's width
#define RIM           0.8 // width of a rim in the page's colour, at either side

// A line that turns up and down more often than this is busy: no pattern of dashes would
// show [pt].
#define LEAST_TURN    0.5  // height of a turn that counts
#define MOST_TURNS    12   // of a line that is never busy
#define BUSY_DISTANCE 16.0 // from turn to turn, some three dashes

// The greys of a panel's busy lines in their order, as palette_series counts them.
enum { BUSY_GREYS = 3 };
static const int busy_greys[BUSY_GREYS] = {4, 2, 0};

enum { STYLES = 4 };

static double series_width(const figure_series *s)
{
    if (s->secondary) {
        return SECONDARY_WIDTH;
    }
    return CURVE_WIDTH;
}

line_style untaken_style(const figure_series *series, int index)
{
    // styles from the plainest on
    static const line_style others[] = {LINE_SOLID, LINE_DASHED, LINE_DASH_DOT,
                                        LINE_DOTTED};

    bool taken[STYLES] = {false};
    line_style style = LINE_SOLID;
    if (series[index].secondary) {
        return LINE_DASHED;
    }

    // the styles that the series up to this one get, in turn
    for (int i = 0; i <= index; i++) {
        if (series[i].secondary) {
            continue;
        }
        style = series[i].style;
        for (int k = 0; k < STYLES && taken[style]; k++) {
            if (!taken[others[k]]) {
                style = others[k];
            }
        }
        taken[style] = true;
    }
    return style;
}

// How a series is drawn.
typedef struct series_pen {
    colour ink;
    line_style style;
    double width; // [pt]
} series_pen;

// The pen of a series of one of several runs: the run's look, or that of a run which
// stands behind another.
static series_pen run_pen(const drawing *d, const figure_series *s)
{
    if (s->run == RUN_BEHIND) {
        return (series_pen){d->style.colours->mark, LINE_SOLID, SECONDARY_WIDTH};
    }
    return (series_pen){run_colour(d->style.theme, s->run), run_style_of(s->run).dash,
                        CURVE_WIDTH};
}

// The pen of a busy line, in which no pattern would show. Without colours the first busy
// line of a panel is light and wide, of the others each has another grey.
static series_pen busy_pen(const drawing *d, const panel_layout *l, int index)
{
    const figure_series *s = &l->panel->series[index];
    series_pen pen = {palette_series(d->style.theme, s->colour, index), LINE_SOLID,
                      series_width(s)};
    if (d->style.theme != THEME_MONO || s->secondary) {
        return pen;
    }

    // by its place among the busy lines of the panel
    int before = 0;
    for (int i = 0; i < index; i++) {
        before += l->busy[i];
    }
    pen.ink = palette_series(THEME_MONO, SLOT_BLUE, busy_greys[before % BUSY_GREYS]);
    if (before == 0) {
        pen.width *= BUSY_WIDER;
    }
    return pen;
}

// The pen of a series: of one of several runs, of a busy line, or of any other.
static series_pen pen_of(const drawing *d, const panel_layout *l, int index)
{
    const figure_series *s = &l->panel->series[index];
    if (s->run != 0) {
        return run_pen(d, s);
    }
    if (l->busy[index]) {
        return busy_pen(d, l, index);
    }

    // a line over a map keeps the pattern it asks for
    series_pen pen = {palette_series(d->style.theme, s->colour, index), s->style,
                      series_width(s)};
    if (!s->rim && !s->own_style) {
        pen.style = untaken_style(l->panel->series, index);
    }
    return pen;
}

double set_series(const drawing *d, const panel_layout *l, int index)
{
    const series_pen pen = pen_of(d, l, index);
    set_colour(d->cr, pen.ink);
    set_line_style(d->cr, pen.style, pen.width);
    return pen.width;
}

// ---- busy lines

// The length of a line and its turns up and down, followed along the pen.
typedef struct pen_path {
    double x, y, length; // [pt]
    double corner_y;     // where it last turned
    int turns;           // up or down
    bool up;
} pen_path;

// Adds a stroke to length and turns of a line (a stroke_sink). The line has turned where
// it has left its last corner by LEAST_TURN in the other direction.
static void follow_pen(void *context, stroke_kind kind, double x, double y)
{
    pen_path *p = context;
    if (kind == STROKE_LINE) {
        p->length += hypot(x - p->x, y - p->y);
        bool up = y < p->corner_y;
        if (fabs(y - p->corner_y) > LEAST_TURN) {
            if (up != p->up) {
                p->turns++;
            }
            p->up = up;
            p->corner_y = y;
        }
    } else {
        p->corner_y = y;
    }

    p->x = x;
    p->y = y;
}

bool series_is_busy(const plane *p, const figure_series *s)
{
    pen_path path = {0};
    if (s->no_line) {
        return false;
    }
    curve_trace(p, s, follow_pen, &path);
    return path.turns > MOST_TURNS && path.length < BUSY_DISTANCE * path.turns;
}

// ---- markers

// Adds the outline of a marker at (x, y) to the path, or two crossing lines. For one
// radius r markers of all kinds look about equally large.
static void add_marker(cairo_t *cr, marker_kind kind, double x, double y, double r)
{
    cairo_new_path(cr);
    switch (kind) {
    case MARKER_NONE:
        break;

    case MARKER_CIRCLE:
        cairo_arc(cr, x, y, r, 0, 2 * G_PI);
        cairo_close_path(cr);
        break;

    case MARKER_SQUARE:
        cairo_rectangle(cr, x - 0.9 * r, y - 0.9 * r, 1.8 * r, 1.8 * r);
        cairo_close_path(cr);
        break;

    case MARKER_TRIANGLE:
        cairo_move_to(cr, x, y - 1.2 * r);
        cairo_line_to(cr, x + 1.1 * r, y + 0.8 * r);
        cairo_line_to(cr, x - 1.1 * r, y + 0.8 * r);
        cairo_close_path(cr);
        break;

    case MARKER_DIAMOND:
        cairo_move_to(cr, x, y - 1.25 * r);
        cairo_line_to(cr, x + 1.25 * r, y);
        cairo_line_to(cr, x, y + 1.25 * r);
        cairo_line_to(cr, x - 1.25 * r, y);
        cairo_close_path(cr);
        break;

    case MARKER_CROSS:
        cairo_move_to(cr, x - r, y - r);
        cairo_line_to(cr, x + r, y + r);
        cairo_move_to(cr, x - r, y + r);
        cairo_line_to(cr, x + r, y - r);
        break;
    }
}

// Draws a marker: filled in the series' colour, or where the series has shades, filled
// with the point's shade and outlined.
static void draw_marker(const drawing *d, const panel_layout *l, const figure_series *s,
                        double x, double y, double shade)
{
    bool open = s->shade != NULL || s->marker == MARKER_CROSS;
    double radius = MARKER_RADIUS;
    if (s->radius > 0) {
        radius = s->radius;
    }
    add_marker(d->cr, s->marker, x, y, radius);
    if (!open) {
        cairo_fill(d->cr);
        return;
    }

    // the shade inside
    cairo_save(d->cr);
    cairo_set_dash(d->cr, NULL, 0, 0);
    if (isfinite(shade) && l != NULL) {
        set_shade(d, l, shade);
        cairo_fill_preserve(d->cr);
    }

    // the outline, over a map with a rim round it
    if (s->rim) {
        set_colour(d->cr, palette_of(THEME_COLOUR)->page);
        cairo_set_line_width(d->cr, CURVE_WIDTH + 2 * RIM);
        cairo_stroke_preserve(d->cr);
        set_colour(d->cr, palette_of(THEME_COLOUR)->text);
        cairo_set_line_width(d->cr, CURVE_WIDTH);
    } else {
        set_colour(d->cr, d->style.colours->axis);
        cairo_set_line_width(d->cr, GRID_WIDTH);
    }
    cairo_stroke(d->cr);
    cairo_restore(d->cr);
}

// ---- lines

typedef struct stroke_context {
    cairo_t *cr;
    double radius; // of a lone point
} stroke_context;

// Adds a piece of a curve to the path; a lone point is a dot.
static void stroke(void *context, stroke_kind kind, double x, double y)
{
    stroke_context *s = context;
    if (kind == STROKE_DOT) {
        cairo_stroke(s->cr);
        cairo_arc(s->cr, x, y, s->radius, 0, 2 * G_PI);
        cairo_fill(s->cr);
    } else if (kind == STROKE_MOVE) {
        cairo_move_to(s->cr, x, y);
    } else {
        cairo_line_to(s->cr, x, y);
    }
}

// Draws the line of a series, clipped at the panel's edge.
static void draw_series_line(const drawing *d, const panel_layout *l, const plane *p,
                             int index)
{
    const figure_series *s = &l->panel->series[index];
    const double width = set_series(d, l, index);
    stroke_context context = {.cr = d->cr, .radius = 0.75 * width};

    // clipped a little beyond the upper and lower edges, where a line keeps its width
    const figure_rect page = {p->box.x, p->box.y - 1, p->box.width, p->box.height + 2};
    cairo_save(d->cr);
    clip_to(d->cr, &page);

    // a wider line below makes the rim
    if (s->rim) {
        set_plain_line(d->cr, palette_of(THEME_COLOUR)->page, width + 2 * RIM);
        curve_trace(p, s, stroke, &context);
        cairo_stroke(d->cr);
        set_series(d, l, index);
        set_colour(d->cr, palette_of(THEME_COLOUR)->text);
    }

    curve_trace(p, s, stroke, &context);
    cairo_stroke(d->cr);
    cairo_restore(d->cr);
}

// Draws the markers of a series whose points lie in the panel; they are not clipped.
static void draw_markers(const drawing *d, const panel_layout *l, const plane *p,
                         int index)
{
    const figure_series *s = &l->panel->series[index];
    const figure_rect *box = &p->box;
    set_series(d, l, index);
    for (size_t k = 0; k < s->count; k++) {
        double x = plane_x(p, series_x(s, k)), y = plane_y(p, series_y(s, k));
        if (x >= box->x && x <= box->x + box->width && y >= box->y &&
            y <= box->y + box->height) {
            draw_marker(d, l, s, x, y, series_shade(s, k));
        }
    }
}

// Draws the series of a panel, later ones over earlier ones.
void draw_series(const drawing *d, const panel_layout *l, const plane *p)
{
    cairo_save(d->cr);
    for (int i = 0; i < l->panel->series_count; i++) {
        const figure_series *s = &l->panel->series[i];
        if (!s->no_line) {
            draw_series_line(d, l, p, i);
        }
        if (s->marker != MARKER_NONE) {
            draw_markers(d, l, p, i);
        }
    }
    cairo_restore(d->cr);
}

// Draws the sample of a series for a legend: a piece of its line with a marker in the
// middle.
void draw_swatch(drawing *d, const panel_layout *l, int index, double x, double y)
{
    const figure_series *s = &l->panel->series[index];
    set_series(d, l, index);
    cairo_set_line_cap(d->cr, CAIRO_LINE_CAP_BUTT);
    if (!s->no_line) {
        picture_line(d->cr, x, y, x + SWATCH, y);
    }
    draw_marker(d, NULL, s, x + SWATCH / 2, y, (double)NAN);
}

// ==== impulses: arrows with their sizes

// From the name to the unit below it, so that its power of ten does not touch the name's
// descenders.
#define STRIP_LEADING 1.25

// Lengths of arrows, of the smallest impulse and of the largest [pt].
#define LEAST_ARROW   4.0
#define LONGEST_ARROW (STRIP_HEIGHT - 3)

// Draws an arrow upwards from a base line; its line ends within its head.
static void draw_upward_arrow(cairo_t *cr, double x, double base, double length)
{
    const double head = fmin(LEAST_ARROW, length), half_width = 0.36 * head;
    const double tip = base - length;
    picture_line(cr, x, base, x, tip + 0.7 * head);
    cairo_move_to(cr, x, tip);
    cairo_line_to(cr, x - half_width, tip + head);
    cairo_line_to(cr, x + half_width, tip + head);
    cairo_close_path(cr);
    cairo_fill(cr);
}

// The size of the largest impulse of a panel, or of all panels where these have common
// scales; 0 without one.
static double largest_impulse(const figure *fig, const figure_panel *panel)
{
    double largest = 0;
    for (int p = 0; p < fig->panel_count; p++) {
        const figure_panel *of = &fig->panels[p];
        if (of != panel && !fig->common_scales) {
            continue;
        }
        for (int i = 0; i < of->impulse_count; i++) {
            if (isfinite(of->impulses[i].size)) {
                largest = fmax(largest, fabs(of->impulses[i].size));
            }
        }
    }
    return largest;
}

// The power of ten in whose units the impulses of a panel are given; 0 unless they are
// small.
static int impulse_exponent(const figure *fig, const figure_panel *panel)
{
    double largest = largest_impulse(fig, panel);
    if (largest > 0 && largest < 1e-2) {
        return 3 * (int)floor(log10(largest) / 3);
    }
    return 0;
}

char *impulse_strip_label(const figure *fig, const figure_panel *panel)
{
    g_autofree char *unit =
        axis_label_text(NULL, panel->impulse_unit, impulse_exponent(fig, panel));
    return text_printf("%s\n%s", panel->impulse_label, unit);
}

#define ARROW_SPACE 4.0 // from an arrow to its label [pt]

enum { IMPULSES_LABELLED = 24 };

// Whether a place for the label of an impulse is above its column of panels or at the
// right of the last, off the arrows of other impulses and off the lines of marks.
static bool strip_is_free(const drawing *d, const panel_layout *l,
                          const figure_rect *place, int index)
{
    const double left = place->x - 1, right = place->x + place->width + 1;
    const column_layout *c = &d->column[l->column];
    const bool last = l->column == d->columns - 1;
    const double end = last ? d->page.width - PAGE_MARGIN : c->right;
    if (place->x < c->left || place->x + place->width > end) {
        return false;
    }

    // arrows of other impulses and lines of marks that would cross it
    for (int i = 0; i < l->panel->impulse_count; i++) {
        const double arrow = plane_x(&l->plane, l->panel->impulses[i].x);
        if (i != index && arrow >= left && arrow <= right) {
            return false;
        }
    }
    for (int i = 0; i < d->fig->mark_count; i++) {
        const double line = plane_x(&l->plane, d->fig->marks[i].x);
        if (line >= left && line <= right) {
            return false;
        }
    }
    return true;
}

// Writes the size of an impulse next to its arrow unless it would cover another label or
// arrow.
static void label_impulse(drawing *d, const panel_layout *l, int index, double base,
                          figure_rect *taken, int *count)
{
    const figure_impulse *p = &l->panel->impulses[index];
    g_autofree char *markup =
        text_number(p->size / pow(10, impulse_exponent(d->fig, l->panel)), 3);
    text_block t = figure_text_of(d, markup, d->style.small);
    const double width = text_measure(d->context, &t).width, height = height_of(d, t);
    double x = plane_x(&l->plane, p->x);

    // at its right or at its left
    const double lefts[] = {x + ARROW_SPACE, x - ARROW_SPACE - width};
    for (int side = 0; side < 2 && *count < IMPULSES_LABELLED; side++) {
        figure_rect place = {lefts[side], base - STRIP_HEIGHT + 3, width, height};
        bool meets = false;
        for (int i = 0; i < *count; i++) {
            meets = meets || rects_meet(&place, &taken[i], 0);
        }
        if (!meets && strip_is_free(d, l, &place, index)) {
            taken[(*count)++] = place;
            draw_text(d, t, place.x, place.y, (anchor){0, 0}, d->style.colours->text);
            break;
        }
    }
}

static bool impulse_shows(const drawing *d, const figure_impulse *p)
{
    return isfinite(p->size) && p->size != 0 && scale_holds(&d->x.scale, p->x);
}

// The largest impulse that shows after the one at `last` (-1: of all), of two alike the
// first; -1 if none is left.
static int next_impulse(const drawing *d, const figure_panel *panel, int last)
{
    const figure_impulse *all = panel->impulses;
    double most = (double)INFINITY;
    int next = -1;
    if (last >= 0) {
        most = fabs(all[last].size);
    }

    // the largest of those that come after it in this order
    for (int i = 0; i < panel->impulse_count; i++) {
        const double size = fabs(all[i].size);
        const bool left = size < most || (size == most && i > last);
        if (left && impulse_shows(d, &all[i]) &&
            (next < 0 || size > fabs(all[next].size))) {
            next = i;
        }
    }
    return next;
}

// Labels the impulses, the largest first, as long as there is room.
static void label_impulses(drawing *d, const panel_layout *l, double base)
{
    figure_rect taken[IMPULSES_LABELLED];
    int count = 0, next = next_impulse(d, l->panel, -1);
    for (int rank = 0; rank < IMPULSES_LABELLED && next >= 0; rank++) {
        label_impulse(d, l, next, base, taken, &count);
        next = next_impulse(d, l->panel, next);
    }
}

// The look of an impulse: its run's, or that of all. With the dash of one the equal arrow
// of another run shows below it.
static void set_impulse(const drawing *d, const figure_impulse *p)
{
    line_style dash = LINE_SOLID;
    if (p->run > 0) {
        dash = run_style_of(p->run).dash;
    }
    set_colour(d->cr, impulse_colour(d->style.theme, p->run));
    set_line_style(d->cr, dash, CURVE_WIDTH);
    cairo_set_line_cap(d->cr, CAIRO_LINE_CAP_BUTT);
}

// Draws the strip of impulses above a panel: a base line, an arrow with its size for each
// impulse, and the strip's label.
void draw_impulses(drawing *d, const panel_layout *l)
{
    const figure_panel *panel = l->panel;
    const double base = l->strip_top + STRIP_HEIGHT - 1;
    const double largest = largest_impulse(d->fig, panel);
    const double left = d->column[l->column].left, right = d->column[l->column].right;
    if (panel->impulse_count == 0) {
        return;
    }

    // the base line and an arrow for each
    set_plain_line(d->cr, d->style.colours->axis, GRID_WIDTH);
    picture_line(d->cr, left, base, right, base);
    for (int i = 0; i < panel->impulse_count; i++) {
        const figure_impulse *p = &panel->impulses[i];
        if (impulse_shows(d, p)) {
            const double length =
                LEAST_ARROW + (LONGEST_ARROW - LEAST_ARROW) * fabs(p->size) / largest;
            set_impulse(d, p);
            draw_upward_arrow(d->cr, plane_x(&l->plane, p->x), base, length);
        }
    }
    label_impulses(d, l, base);

    // what they are, with their unit, at the left
    if (panel->impulse_label != NULL) {
        g_autofree char *label = impulse_strip_label(d->fig, panel);
        text_block t = figure_text_of(d, label, d->style.small);
        t.align = TEXT_RIGHT;
        if (impulse_exponent(d->fig, panel) != 0) {
            t.leading = STRIP_LEADING;
        }
        draw_text(d, t, left - TICK_LENGTH - TICK_SPACE, base + 1.5, (anchor){1, 1},
                  d->style.colours->text);
    }
}
