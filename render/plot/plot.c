#include "render/plot/plot.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/plot/plot_layout.h"

#define POINTS_PER_MM (72 / 25.4)
#define DEFAULT_WIDTH 170.0 // [mm]
#define PANEL_HEIGHT  34.0  // of a panel of weight 1 on a page without a height [mm]

// Line widths [pt].
#define CURVE_WIDTH     0.95
#define SECONDARY_WIDTH 0.65
#define AXIS_WIDTH      0.55
#define GRID_WIDTH      0.4
#define MARK_WIDTH      0.45
#define MARKER_RADIUS   1.6

void figure_size(const figure *fig, double *width, double *height)
{
    double points = 0;
    for (int i = 0; i < fig->panel_count; i++) {
        const figure_panel *p = &fig->panels[i];
        points += (p->weight > 0 ? p->weight : 1) * PANEL_HEIGHT * POINTS_PER_MM + PANEL_SPACE;
        points += p->impulse_count > 0 ? STRIP_HEIGHT + STRIP_SPACE : 0;
    }
    points += 2 * PAGE_MARGIN + 24 + (fig->title ? 14 : 0) + (fig->caption ? 12 : 0) +
              (fig->mark_count > 0 ? 2 * MARK_ROW : 0);
    *width = (fig->width > 0 ? fig->width : DEFAULT_WIDTH) * POINTS_PER_MM;
    *height = fig->height > 0 ? fig->height * POINTS_PER_MM : points;
}

// ---- text
// -----------------------------------------------------------------------------------------

static void report_text(drawing *d, const char *markup, figure_rect place)
{
    if (d->report == NULL || d->report->text_count == FIGURE_TEXTS) {
        return;
    }
    figure_text *t = &d->report->texts[d->report->text_count++];
    char *plain = text_plain(markup);
    t->place = place;
    g_strlcpy(t->text, plain, sizeof t->text);
    // a character that was cut in two goes altogether
    const char *end;
    if (!g_utf8_validate(t->text, -1, &end)) {
        t->text[end - t->text] = '\0';
    }
    g_free(plain);
}

// Where a text's anchor is, as parts of its width and height.
typedef struct anchor {
    double x, y;
} anchor;

static void draw_text(drawing *d, text_block t, double x, double y, anchor at, colour c)
{
    double width, height;
    text_measure(d->context, &t, &width, &height);
    set_colour(d->cr, c);
    x -= at.x * width;
    y -= at.y * height;
    cairo_move_to(d->cr, x, y);
    text_draw(d->cr, d->context, &t);
    report_text(d, t.markup, (figure_rect){x, y, width, height});
}

// Draws t upwards; (x, y) is the middle of its upper edge, which is on the left.
static void draw_rotated(drawing *d, text_block t, double x, double y, colour c)
{
    double width, height;
    text_measure(d->context, &t, &width, &height);
    cairo_save(d->cr);
    set_colour(d->cr, c);
    cairo_translate(d->cr, x, y + width / 2);
    cairo_rotate(d->cr, -G_PI / 2);
    cairo_move_to(d->cr, 0, 0);
    text_draw(d->cr, d->context, &t);
    cairo_restore(d->cr);
    report_text(d, t.markup, (figure_rect){x, y - width / 2, height, width});
}

// ---- lines
// ----------------------------------------------------------------------------------------

static void draw_line(cairo_t *cr, double x0, double y0, double x1, double y1)
{
    cairo_move_to(cr, x0, y0);
    cairo_line_to(cr, x1, y1);
    cairo_stroke(cr);
}

static void set_plain_line(cairo_t *cr, colour c, double width)
{
    set_colour(cr, c);
    set_line_style(cr, LINE_SOLID, width);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_BUTT);
}

static void clip_to(cairo_t *cr, const figure_rect *box, double space)
{
    cairo_rectangle(cr, box->x - space, box->y - space, box->width + 2 * space,
                    box->height + 2 * space);
    cairo_clip(cr);
}

static void fill_box(cairo_t *cr, const figure_rect *box, colour c)
{
    set_colour(cr, c);
    cairo_rectangle(cr, box->x, box->y, box->width, box->height);
    cairo_fill(cr);
}

static void draw_marker(cairo_t *cr, marker_kind kind, double x, double y)
{
    double r = MARKER_RADIUS;
    cairo_new_path(cr);
    switch (kind) {
    case MARKER_NONE:
        return;
    case MARKER_CIRCLE:
        cairo_arc(cr, x, y, r, 0, 2 * G_PI);
        break;
    case MARKER_SQUARE:
        cairo_rectangle(cr, x - 0.9 * r, y - 0.9 * r, 1.8 * r, 1.8 * r);
        break;
    case MARKER_TRIANGLE:
        cairo_move_to(cr, x, y - 1.2 * r);
        cairo_line_to(cr, x + 1.1 * r, y + 0.8 * r);
        cairo_line_to(cr, x - 1.1 * r, y + 0.8 * r);
        break;
    }
    cairo_close_path(cr);
    cairo_fill(cr);
}

// ---- curves
// ---------------------------------------------------------------------------------------

typedef struct stroke_context {
    cairo_t *cr;
    double radius; // of a lone point
} stroke_context;

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

static void draw_markers(cairo_t *cr, const plane *p, const figure_series *s)
{
    const figure_rect *box = &p->box;
    for (size_t i = 0; i < s->count; i++) {
        double x = plane_x(p, series_x(s, i)), y = plane_y(p, series_y(s, i));
        if (x >= box->x && x <= box->x + box->width && y >= box->y && y <= box->y + box->height) {
            draw_marker(cr, s->marker, x, y);
        }
    }
}

// Sets colour and pattern of a series; returns the line's width.
static double set_series(const drawing *d, const figure_panel *panel, int index)
{
    const figure_series *s = &panel->series[index];
    double width = s->secondary ? SECONDARY_WIDTH : CURVE_WIDTH;
    set_colour(d->cr, palette_series(d->fig->theme, s->colour, index));
    set_line_style(d->cr, palette_style(panel->series, index), width);
    return width;
}

static void draw_curves(const drawing *d, const figure_panel *panel, const plane *p)
{
    cairo_save(d->cr);
    clip_to(d->cr, &p->box, 1);
    for (int i = 0; i < panel->series_count; i++) {
        const figure_series *s = &panel->series[i];
        stroke_context context = {.cr = d->cr, .radius = 0.75 * set_series(d, panel, i)};
        if (!s->no_line) {
            curve_trace(p, s, stroke, &context);
            cairo_stroke(d->cr);
        }
        draw_markers(d->cr, p, s);
    }
    cairo_restore(d->cr);
}

// ---- behind the curves
// ----------------------------------------------------------------------------

static void draw_intervals(const drawing *d, const plane *p)
{
    const figure_rect *box = &p->box;
    cairo_save(d->cr);
    clip_to(d->cr, box, 0);
    set_colour(d->cr, d->colours->shade);
    for (int i = 0; i < d->fig->interval_count; i++) {
        const figure_interval *v = &d->fig->intervals[i];
        double from = plane_x(p, fmax(v->from, p->x_low)), to = plane_x(p, fmin(v->to, p->x_high));
        if (to >= from) {
            cairo_rectangle(d->cr, from, box->y, fmax(to - from, GRID_WIDTH), box->height);
        }
    }
    cairo_fill(d->cr);
    cairo_restore(d->cr);
}

static void draw_grid(const drawing *d, const plane *p, const ticks *y_ticks)
{
    const figure_rect *box = &p->box;
    set_plain_line(d->cr, d->colours->grid, GRID_WIDTH);
    for (int i = 0; i < y_ticks->count; i++) {
        double y = plane_y(p, y_ticks->value[i]);
        draw_line(d->cr, box->x, y, box->x + box->width, y);
    }
}

static void set_mark_line(const drawing *d)
{
    static const double pattern[] = {2.4, 1.8};
    set_plain_line(d->cr, d->colours->mark, MARK_WIDTH);
    cairo_set_dash(d->cr, pattern, 2, 0);
}

// The hairlines of all marks, from their labels down through all panels.
static void draw_marks(drawing *d)
{
    const plane *first = &d->panels[0].plane, *last = &d->panels[d->fig->panel_count - 1].plane;
    for (int i = 0; i < d->fig->mark_count; i++) {
        const figure_mark *m = &d->fig->marks[i];
        if (!(m->x >= d->x_low && m->x <= d->x_high)) {
            continue;
        }
        double x = plane_x(first, m->x), top = first->box.y;
        if (i < MARKS_LABELLED && d->mark_row[i] >= 0) {
            text_block t = figure_text_of(m->label, SMALL_SIZE);
            top = d->marks_bottom - MARK_ROW * (d->mark_row[i] + 1);
            draw_text(d, t, d->mark_text_x[i], top, (anchor){0, 0}, d->colours->text);
        }
        set_mark_line(d);
        draw_line(d->cr, x, top + 1, x, last->box.y + last->box.height);
    }
}

static void draw_levels(drawing *d, const panel_layout *l)
{
    const figure_rect *box = &l->plane.box;
    for (int i = 0; i < l->panel->level_count; i++) {
        const figure_level *level = &l->panel->levels[i];
        double y = plane_y(&l->plane, level->y);
        if (!(y >= box->y && y <= box->y + box->height)) {
            continue;
        }
        set_mark_line(d);
        draw_line(d->cr, box->x, y, box->x + box->width, y);
        if (level->label != NULL) {
            draw_text(d, figure_text_of(level->label, SMALL_SIZE), box->x + box->width - 2, y,
                      (anchor){1, level_label_above(l, i) ? 1 : 0}, d->colours->text);
        }
    }
}

// ---- axes
// -----------------------------------------------------------------------------------------

// Minor ticks beside and between major ones; draw is called with their values.
static void draw_minor(const drawing *d, const plane *p, const ticks *t, bool horizontal)
{
    if (t->count < 2 || t->minor < 2) {
        return;
    }
    const figure_rect *box = &p->box;
    double low = horizontal ? p->x_low : p->y_low, high = horizontal ? p->x_high : p->y_high;
    double part = t->step / t->minor, spacing = part / (high - low);
    spacing *= horizontal ? box->width : box->height;
    for (int k = -t->minor; k <= t->minor * t->count && spacing > 2.5; k++) {
        double value = t->value[0] + k * part;
        if (k % t->minor == 0 || value < low || value > high) {
            continue;
        }
        double x = plane_x(p, value), y = plane_y(p, value), bottom = box->y + box->height;
        if (horizontal) {
            draw_line(d->cr, x, bottom, x, bottom + MINOR_LENGTH);
        } else {
            draw_line(d->cr, box->x, y, box->x - MINOR_LENGTH, y);
        }
    }
}

// Spines, ticks and their labels, at the left and below.
static void draw_axes(drawing *d, const plane *p, const ticks *x_ticks, const ticks *y_ticks,
                      bool x_labels, double size)
{
    char label[TICK_TEXT];
    const figure_rect *box = &p->box;
    double bottom = box->y + box->height;
    set_plain_line(d->cr, d->colours->axis, AXIS_WIDTH);
    draw_minor(d, p, x_ticks, true);
    draw_minor(d, p, y_ticks, false);
    for (int i = 0; i < x_ticks->count; i++) {
        double x = plane_x(p, x_ticks->value[i]);
        draw_line(d->cr, x, bottom, x, bottom + TICK_LENGTH);
    }
    for (int i = 0; i < y_ticks->count; i++) {
        double y = plane_y(p, y_ticks->value[i]);
        draw_line(d->cr, box->x, y, box->x - TICK_LENGTH, y);
    }
    cairo_set_line_cap(d->cr, CAIRO_LINE_CAP_SQUARE);
    draw_line(d->cr, box->x, box->y, box->x, bottom);
    draw_line(d->cr, box->x, bottom, box->x + box->width, bottom);
    for (int i = 0; x_labels && i < x_ticks->count; i++) {
        tick_label(x_ticks, i, label);
        draw_text(d, figure_text_of(label, size), plane_x(p, x_ticks->value[i]),
                  bottom + TICK_LENGTH + TICK_SPACE - 1, (anchor){0.5, 0}, d->colours->text);
    }
    for (int i = 0; i < y_ticks->count; i++) {
        tick_label(y_ticks, i, label);
        draw_text(d, figure_text_of(label, size), box->x - TICK_LENGTH - TICK_SPACE,
                  plane_y(p, y_ticks->value[i]), (anchor){1, 0.5}, d->colours->text);
    }
}

static void draw_y_label(drawing *d, const panel_layout *l)
{
    const figure_rect *box = &l->plane.box;
    char *label = axis_label(l->panel->label, l->panel->unit, l->y_ticks.exponent);
    text_block t = {.markup = label,
                    .size = LABEL_SIZE,
                    .align = TEXT_CENTRE,
                    .width = box->height + PANEL_SPACE};
    if (label[0] != '\0') {
        draw_rotated(d, t, PAGE_MARGIN, box->y + box->height / 2, d->colours->text);
    }
    g_free(label);
}

// ---- legends
// --------------------------------------------------------------------------------------

static void draw_swatch(drawing *d, const figure_panel *panel, int index, double x, double y)
{
    const figure_series *s = &panel->series[index];
    set_series(d, panel, index);
    cairo_set_line_cap(d->cr, CAIRO_LINE_CAP_BUTT);
    if (!s->no_line) {
        draw_line(d->cr, x, y, x + SWATCH, y);
    }
    draw_marker(d->cr, s->marker, x + SWATCH / 2, y);
}

static void draw_legend(drawing *d, const panel_layout *l)
{
    double x = l->legend.x, y = l->legend.y;
    if (l->legend.width > 0 && !l->legend_inside) {
        // hairlines of marks do not cross it
        fill_box(d->cr, &l->legend, d->colours->page);
    }
    for (int i = 0; i < l->panel->series_count && l->legend.width > 0; i++) {
        double width, height;
        const char *label = l->panel->series[i].label;
        if (label == NULL) {
            continue;
        }
        text_block t = figure_text_of(label, TICK_SIZE);
        text_measure(d->context, &t, &width, &height);
        draw_swatch(d, l->panel, i, x, y + 0.55 * height);
        draw_text(d, t, x + SWATCH + SWATCH_SPACE, y, (anchor){0, 0}, d->colours->text);
        if (l->legend_inside || l->legend_column) {
            y += height;
        } else {
            x += width + SWATCH + 3 * SWATCH_SPACE;
        }
    }
}

static void draw_end_labels(drawing *d, const panel_layout *l)
{
    const figure_rect *box = &l->plane.box;
    for (int i = 0; i < l->panel->series_count; i++) {
        double y, width, height;
        if (isnan(l->end_label_y[i]) || !series_end(d, &l->panel->series[i], &y)) {
            continue;
        }
        text_block t = figure_text_of(l->panel->series[i].label, TICK_SIZE);
        text_measure(d->context, &t, &width, &height);
        double end = box->x + box->width, middle = l->end_label_y[i] + 0.55 * height;
        set_series(d, l->panel, i);
        cairo_set_line_width(d->cr, SECONDARY_WIDTH);
        cairo_set_dash(d->cr, NULL, 0, 0);
        draw_line(d->cr, end + 2, fmax(box->y, fmin(box->y + box->height, plane_y(&l->plane, y))),
                  end + 10, middle);
        draw_text(d, t, end + 12, l->end_label_y[i], (anchor){0, 0}, d->colours->text);
    }
}

// ---- impulses
// -------------------------------------------------------------------------------------

// Three digits, with a power of ten where a reader would count zeros.
static void number_markup(double value, char *out, size_t size)
{
    char digits[32];
    snprintf(digits, sizeof digits, "%.3g", fabs(value));
    char *e = strchr(digits, 'e');
    const char *sign = value < 0 ? "\u2212" : "";
    if (e == NULL) {
        snprintf(out, size, "%s%s", sign, digits);
        return;
    }
    *e = '\0';
    int power = atoi(e + 1);
    snprintf(out, size, "%s%s\u00d710<sup>%s%d</sup>", sign, digits, power < 0 ? "\u2212" : "",
             abs(power));
}

static void draw_arrow(cairo_t *cr, double x, double base, double length)
{
    double head = fmin(4, length);
    draw_line(cr, x, base, x, base - length + 0.7 * head);
    cairo_move_to(cr, x, base - length);
    cairo_line_to(cr, x - 0.36 * head, base - length + head);
    cairo_line_to(cr, x + 0.36 * head, base - length + head);
    cairo_close_path(cr);
    cairo_fill(cr);
}

static bool overlaps(const figure_rect *a, const figure_rect *b)
{
    return a->x < b->x + b->width && b->x < a->x + a->width && a->y < b->y + b->height &&
           b->y < a->y + a->height;
}

static double largest_impulse(const figure_panel *panel)
{
    double largest = 0;
    for (int i = 0; i < panel->impulse_count; i++) {
        if (isfinite(panel->impulses[i].size)) {
            largest = fmax(largest, fabs(panel->impulses[i].size));
        }
    }
    return largest;
}

// Small impulses are given in units of a power of ten.
static int impulse_exponent(const figure_panel *panel)
{
    double largest = largest_impulse(panel);
    return largest > 0 && largest < 1e-2 ? 3 * (int)floor(log10(largest) / 3) : 0;
}

enum { IMPULSES_LABELLED = 24 };

// Writes the size of an impulse beside its arrow unless it would cover another label or arrow.
static void label_impulse(drawing *d, const panel_layout *l, int index, double base,
                          figure_rect *taken, int *count)
{
    char markup[64];
    double width, height;
    const figure_impulse *all = l->panel->impulses, *p = &all[index];
    number_markup(p->size / pow(10, impulse_exponent(l->panel)), markup, sizeof markup);
    text_block t = figure_text_of(markup, SMALL_SIZE);
    text_measure(d->context, &t, &width, &height);
    double x = plane_x(&l->plane, p->x);
    for (int side = 0; side < 2 && *count < IMPULSES_LABELLED; side++) {
        figure_rect place = {side == 0 ? x + 4 : x - 4 - width, base - STRIP_HEIGHT + 3, width,
                             height};
        bool free_place = place.x >= d->left && place.x + width <= d->page.width - PAGE_MARGIN;
        for (int i = 0; i < *count && free_place; i++) {
            free_place = !overlaps(&place, &taken[i]);
        }
        for (int i = 0; i < l->panel->impulse_count && free_place; i++) {
            double other = plane_x(&l->plane, all[i].x);
            free_place = i == index || other < place.x - 1 || other > place.x + width + 1;
        }
        for (int i = 0; i < d->fig->mark_count && free_place; i++) {
            double line = plane_x(&l->plane, d->fig->marks[i].x);
            free_place = line < place.x - 1 || line > place.x + width + 1;
        }
        if (free_place) {
            taken[(*count)++] = place;
            draw_text(d, t, place.x, place.y, (anchor){0, 0}, d->colours->text);
            return;
        }
    }
}

static bool impulse_shows(const drawing *d, const figure_impulse *p)
{
    return isfinite(p->size) && p->size != 0 && p->x >= d->x_low && p->x <= d->x_high;
}

// The largest impulse that shows and is not among the first `count` of `done`; -1 if none is left.
static int next_impulse(const drawing *d, const figure_panel *panel, const int *done, int count)
{
    int next = -1;
    for (int i = 0; i < panel->impulse_count; i++) {
        const figure_impulse *p = &panel->impulses[i];
        bool is_done = !impulse_shows(d, p);
        for (int k = 0; k < count && !is_done; k++) {
            is_done = done[k] == i;
        }
        if (!is_done && (next < 0 || fabs(p->size) > fabs(panel->impulses[next].size))) {
            next = i;
        }
    }
    return next;
}

// Labels go to the largest impulses first.
static void label_impulses(drawing *d, const panel_layout *l, double base)
{
    figure_rect taken[IMPULSES_LABELLED];
    int done[IMPULSES_LABELLED], count = 0;
    for (int rank = 0; rank < IMPULSES_LABELLED; rank++) {
        done[rank] = next_impulse(d, l->panel, done, rank);
        if (done[rank] < 0) {
            return;
        }
        label_impulse(d, l, done[rank], base, taken, &count);
    }
}

static void draw_impulses(drawing *d, const panel_layout *l)
{
    const figure_panel *panel = l->panel;
    double base = l->strip_top + STRIP_HEIGHT - 1, largest = largest_impulse(panel);
    if (panel->impulse_count == 0) {
        return;
    }
    set_plain_line(d->cr, d->colours->axis, GRID_WIDTH);
    draw_line(d->cr, d->left, base, d->right, base);
    for (int i = 0; i < panel->impulse_count; i++) {
        const figure_impulse *p = &panel->impulses[i];
        if (impulse_shows(d, p)) {
            double length = 4 + (STRIP_HEIGHT - 7) * fabs(p->size) / largest;
            set_plain_line(d->cr, palette_series(d->fig->theme, 4, 0), CURVE_WIDTH);
            draw_arrow(d->cr, plane_x(&l->plane, p->x), base, length);
        }
    }
    label_impulses(d, l, base);
    if (panel->impulse_label != NULL) {
        char *unit = axis_label(NULL, panel->impulse_unit, impulse_exponent(panel));
        char *label = g_strconcat(panel->impulse_label, "\n", unit, NULL);
        text_block t = {.markup = label, .size = SMALL_SIZE, .align = TEXT_RIGHT};
        draw_text(d, t, d->left - TICK_LENGTH - TICK_SPACE, base + 1.5, (anchor){1, 1},
                  d->colours->text);
        g_free(label);
        g_free(unit);
    }
}

// ---- the inset
// ------------------------------------------------------------------------------------

static void draw_inset(drawing *d, const panel_layout *l)
{
    const plane *p = &l->inset_plane;
    if (l->inset.width <= 0) {
        return;
    }
    fill_box(d->cr, &l->inset, d->colours->page);
    draw_intervals(d, p);
    draw_grid(d, p, &l->inset_y_ticks);
    draw_curves(d, l->panel, p);
    draw_axes(d, p, &l->inset_x_ticks, &l->inset_y_ticks, true, SMALL_SIZE);

    // the part of the panel that the inset shows
    double left = plane_x(&l->plane, p->x_low), right = plane_x(&l->plane, p->x_high);
    double top = fmax(plane_y(&l->plane, p->y_high), l->plane.box.y);
    double bottom = fmin(plane_y(&l->plane, p->y_low), l->plane.box.y + l->plane.box.height);
    set_plain_line(d->cr, d->colours->mark, MARK_WIDTH);
    cairo_rectangle(d->cr, left, top, right - left, bottom - top);
    cairo_stroke(d->cr);
}

// ---- the whole
// ------------------------------------------------------------------------------------

static void draw_panel(drawing *d, int index)
{
    const panel_layout *l = &d->panels[index];
    bool bottom = index == d->fig->panel_count - 1;
    draw_impulses(d, l);
    draw_levels(d, l);
    draw_curves(d, l->panel, &l->plane);
    draw_axes(d, &l->plane, &d->x_ticks, &l->y_ticks, bottom, TICK_SIZE);
    draw_y_label(d, l);
    draw_inset(d, l);
    draw_legend(d, l);
    if (has_end_labels(l->panel)) {
        draw_end_labels(d, l);
    }
    if (d->report != NULL) {
        d->report->panels[index] = l->plane.box;
        d->report->legends[index] = l->legend;
        d->report->insets[index] = l->inset;
    }
}

static void draw_frame_texts(drawing *d)
{
    const figure *fig = d->fig;
    double width = d->right - d->left;
    if (fig->title != NULL) {
        char *title = text_escape(fig->title);
        text_block t = {.markup = title, .size = TITLE_SIZE, .bold = true, .width = width};
        draw_text(d, t, d->left, d->title_y, (anchor){0, 0}, d->colours->text);
        g_free(title);
    }
    if (fig->caption != NULL) {
        text_block t = {.markup = fig->caption, .size = SMALL_SIZE, .width = width};
        draw_text(d, t, d->left, d->caption_y, (anchor){0, 0}, d->colours->faint_text);
    }
    if (fig->x_label != NULL) {
        char *label = axis_label(fig->x_label, fig->x_unit, d->x_ticks.exponent);
        draw_text(d, figure_text_of(label, LABEL_SIZE), (d->left + d->right) / 2, d->x_label_y,
                  (anchor){0.5, 0}, d->colours->text);
        g_free(label);
    }
}

static void draw_all(drawing *d)
{
    fill_box(d->cr, &d->page, d->colours->page);
    for (int i = 0; i < d->fig->panel_count; i++) {
        draw_intervals(d, &d->panels[i].plane);
        draw_grid(d, &d->panels[i].plane, &d->panels[i].y_ticks);
    }
    draw_marks(d);
    draw_frame_texts(d);
    for (int i = 0; i < d->fig->panel_count; i++) {
        draw_panel(d, i);
    }
}

static status check_description(const figure *fig, fault *f)
{
    if (fig->panel_count < 1 || fig->panel_count > FIGURE_PANELS) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "a figure has %d panels, expected 1 to %d",
                         fig->panel_count, FIGURE_PANELS);
    }
    for (int i = 0; i < fig->panel_count; i++) {
        if (fig->panels[i].series_count < 0 || fig->panels[i].series_count > PANEL_SERIES) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "panel %d of a figure has %d series, expected at most %d", i + 1,
                             fig->panels[i].series_count, PANEL_SERIES);
        }
    }
    return STATUS_OK;
}

status figure_paint(cairo_t *cr, const figure *fig, figure_report *report, fault *f)
{
    status code = check_description(fig, f);
    if (code == STATUS_OK) {
        code = text_check_font(f);
    }
    if (code != STATUS_OK) {
        return code;
    }
    drawing d = {.cr = cr, .fig = fig, .colours = palette_of(fig->theme), .report = report};
    figure_size(fig, &d.page.width, &d.page.height);
    if (report != NULL) {
        memset(report, 0, sizeof *report);
        report->page = d.page;
        report->panel_count = fig->panel_count;
    }
    cairo_save(cr);
    d.context = text_context_create();
    code = layout_figure(&d, f);
    if (code == STATUS_OK) {
        draw_all(&d);
    }
    g_object_unref(d.context);
    cairo_restore(cr);
    cairo_status_t state = cairo_status(cr);
    // a stream that cannot be written is reported by whoever closes it
    if (code == STATUS_OK && state != CAIRO_STATUS_SUCCESS && state != CAIRO_STATUS_WRITE_ERROR) {
        code = fault_set(f, STATUS_NO_MEMORY, "a figure could not be drawn: %s",
                         cairo_status_to_string(state));
    }
    return code;
}
