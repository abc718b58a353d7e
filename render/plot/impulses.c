// Impulses: arrows with their sizes in a strip above a panel.
#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/plot/drawing.h"

// From the name to the unit below it, so that its power of ten does not touch the name's
// descenders.
#define STRIP_LEADING 1.25

// An arrow upwards.
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

char *impulse_strip_label(const figure_panel *panel)
{
    assert(panel != NULL && panel->impulse_label != NULL);
    char *unit = axis_label(NULL, panel->impulse_unit, impulse_exponent(panel));
    char *label = g_strconcat(panel->impulse_label, "\n", unit, NULL);
    g_free(unit);
    return label;
}

enum { IMPULSES_LABELLED = 24 };

// Writes the size of an impulse next to its arrow unless it would cover another label or arrow.
static void label_impulse(drawing *d, const panel_layout *l, int index, double base,
                          figure_rect *taken, int *count)
{
    double width, height;
    const figure_impulse *all = l->panel->impulses, *p = &all[index];
    char *markup = text_number(p->size / pow(10, impulse_exponent(l->panel)), 3);
    text_block t = figure_text_of(d, markup, d->style.small);
    text_measure(d->context, &t, &width, &height);
    double x = plane_x(&l->plane, p->x);

    // at its right or at its left, on the page, off other labels, arrows and marks
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
            draw_text(d, t, place.x, place.y, (anchor){0, 0}, d->style.colours->text);
            break;
        }
    }
    g_free(markup);
}

static bool impulse_shows(const drawing *d, const figure_impulse *p)
{
    return isfinite(p->size) && p->size != 0 && scale_holds(&d->x.scale, p->x);
}

// The largest impulse that shows and is not among the first `count` of `done`; -1 if none is left.
static int next_impulse(const drawing *d, const figure_panel *panel, const int *done, int count)
{
    int next = -1;
    for (int i = 0; i < panel->impulse_count; i++) {
        const figure_impulse *p = &panel->impulses[i];

        // one that does not show counts as done
        bool is_done = !impulse_shows(d, p);
        for (int k = 0; k < count && !is_done; k++) {
            is_done = done[k] == i;
        }

        // of two alike the first
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

void draw_impulses(drawing *d, const panel_layout *l)
{
    const figure_panel *panel = l->panel;
    double base = l->strip_top + STRIP_HEIGHT - 1, largest = largest_impulse(panel);
    double left = d->column[l->column].left, right = d->column[l->column].right;
    if (panel->impulse_count == 0) {
        return;
    }

    // the base line and an arrow for each
    set_plain_line(d->cr, d->style.colours->axis, GRID_WIDTH);
    draw_line(d->cr, left, base, right, base);
    for (int i = 0; i < panel->impulse_count; i++) {
        const figure_impulse *p = &panel->impulses[i];
        if (impulse_shows(d, p)) {
            double length = 4 + (STRIP_HEIGHT - 7) * fabs(p->size) / largest;
            set_plain_line(d->cr, palette_series(d->style.theme, 4, 0), CURVE_WIDTH);
            draw_arrow(d->cr, plane_x(&l->plane, p->x), base, length);
        }
    }
    label_impulses(d, l, base);

    // what they are, with their unit, at the left
    if (panel->impulse_label != NULL) {
        char *label = impulse_strip_label(panel);
        text_block t = figure_text_of(d, label, d->style.small);
        t.align = TEXT_RIGHT;
        t.leading = impulse_exponent(panel) != 0 ? STRIP_LEADING : 0;
        draw_text(d, t, left - TICK_LENGTH - TICK_SPACE, base + 1.5, (anchor){1, 1},
                  d->style.colours->text);
        g_free(label);
    }
}
