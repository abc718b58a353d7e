// What takes a free place in a panel: legends (also in a row or column above it, or one for all
// panels), and the inset, a short stretch of the panel once more, larger.
#include <math.h>

#include "render/page/picture_file.h"
#include "render/plot/drawing.h"

// ==== the inset

#define INSET_ROOM 0.1 // of the data's range, kept free above and below them

// The inset's axes within its outer rectangle.
static void divide_inset(const drawing *d, panel_layout *l)
{
    const figure_panel *panel = l->panel;
    plane *p = &l->inset_plane;
    double line = height_of(d, figure_text_of(d, "0", d->style.small));

    // the stretch of x, and all y that lie in it
    p->x = scale_empty(d->x.scale.kind);
    scale_include(&p->x, panel->zoom_from);
    scale_include(&p->x, panel->zoom_to);
    p->y = scale_empty(l->plane.y.kind);
    for (int i = 0; i < panel->series_count; i++) {
        series_include_y(&panel->series[i], &p->x, &p->y);
    }
    scale_widen(&p->y, INSET_ROOM);

    // ticks, and the box that leaves room for their labels
    l->inset_x.scale = p->x;
    l->inset_y.scale = p->y;
    axis_choose_ticks(&l->inset_x, &d->fig->x, axis_wish(l->inset.width, 35, 2, 5));
    axis_choose_ticks(&l->inset_y, &panel->y, axis_wish(l->inset.height, 15, 2, 4));
    double left = widest_tick(d, &l->inset_y, d->style.small) + TICK_SPACE + 4;
    double wide = widest_tick(d, &l->inset_x, d->style.small);
    double width = l->inset.width - left - wide / 2;

    // the digits of a short stretch of time are many: labels that would meet are left out
    double space = l->inset_x.even.step / (p->x.high - p->x.low) * width;
    int every = space > 0 ? (int)ceil((wide + LABEL_GAP) / space) : 1;
    for (int i = 0; i < l->inset_x.count; i++) {
        l->inset_x.text[i] = i % every == 0 ? l->inset_x.text[i] : "";
    }
    p->box = (figure_rect){l->inset.x + left, l->inset.y + 3, width,
                           l->inset.height - 3 - line - TICK_SPACE - 2};
}

void place_inset(const drawing *d, panel_layout *l, placement *grid)
{
    // the largest that covers no curve
    static const double scales[] = {1, 0.85, 0.7};
    const figure_panel *panel = l->panel;
    const figure_rect *box = &l->plane.box;
    l->inset = (figure_rect){0};

    // nothing to enlarge
    if (!(panel->zoom_from < panel->zoom_to)) {
        return;
    }

    // one too small to read is rather left out
    for (int i = 0; i < 3; i++) {
        figure_rect found;
        double width = 0.4 * scales[i] * box->width, height = 0.66 * scales[i] * box->height;
        if (height < 36 || width < 60) {
            return;
        }
        if (placement_find(grid, width, height, 3, &found) < INK_CURVE) {
            l->inset = found;
            divide_inset(d, l);
            placement_block(grid, found, INK_CURVE);
            return;
        }
    }
}

void draw_inset(drawing *d, const panel_layout *l)
{
    const plane *p = &l->inset_plane;
    if (l->inset.width <= 0) {
        return;
    }
    if (!d->fig->transparent) {
        fill_box(d->cr, &l->inset, d->style.colours->page);
    }
    draw_intervals(d, p);
    draw_grid(d, p, &l->inset_x, &l->inset_y);
    draw_series(d, l, p);
    draw_axes(d, p, &l->inset_x, &l->inset_y,
              (axes_look){.x_labels = true, .y_labels = true, .size = d->style.small});

    // the part of the panel that the inset shows
    double left = plane_x(&l->plane, scale_value(p->x.kind, p->x.low));
    double right = plane_x(&l->plane, scale_value(p->x.kind, p->x.high));
    double top = fmax(plane_y(&l->plane, scale_value(p->y.kind, p->y.high)), l->plane.box.y);
    double bottom = fmin(plane_y(&l->plane, scale_value(p->y.kind, p->y.low)),
                         l->plane.box.y + l->plane.box.height);
    cairo_save(d->cr);
    clip_out_labels(d);
    set_plain_line(d->cr, d->style.colours->mark, MARK_WIDTH);
    cairo_rectangle(d->cr, left, top, right - left, bottom - top);
    picture_stroke(d->cr);
    cairo_restore(d->cr);
}

// ==== legends

// What the legend says of a series.
typedef struct legend_entry {
    text_block text;
    double width, height;
} legend_entry;

// An entry, on a narrow page its symbol, wrapped at a width (0: never); false of a series without a
// label.
static bool entry_of(const drawing *d, const figure_series *s, double wrapped, legend_entry *e)
{
    const bool narrow = d->page.width < NARROW_PAGE && s->symbol != NULL;
    if (s->label == NULL) {
        return false;
    }
    e->text = figure_text_of(d, narrow ? s->symbol : s->label, d->style.tick);
    e->text.width = wrapped;
    text_measure(d->context, &e->text, &e->width, &e->height);
    return true;
}

// An entry with its swatch.
static void draw_entry(drawing *d, const panel_layout *l, int index, const legend_entry *e,
                       double x, double y)
{
    draw_swatch(d, l, index, x, y + 0.55 * e->height);
    draw_text(d, e->text, x + SWATCH + SWATCH_SPACE, y, (anchor){0, 0}, d->style.colours->text);
}

static int labelled_series(const figure_panel *panel)
{
    int count = 0;
    for (int i = 0; i < panel->series_count; i++) {
        count += panel->series[i].label != NULL;
    }
    return count;
}

// ---- where they go

// Size of a legend with entries in a row or one above the other.
static void legend_size(const drawing *d, const figure_panel *panel, bool row, double *width,
                        double *height)
{
    legend_entry e;
    *width = *height = 0;
    for (int i = 0; i < panel->series_count; i++) {
        if (!entry_of(d, &panel->series[i], 0, &e)) {
            continue;
        }

        // entries add up along the row, or one above the other
        double w = e.width + SWATCH + SWATCH_SPACE;
        if (row) {
            *width += w + (*width > 0 ? 2 * SWATCH_SPACE : 0);
            *height = fmax(*height, e.height);
        } else {
            *width = fmax(*width, w);
            *height += e.height;
        }
    }
}

// Returns false if there is no room inside the panel.
bool place_legend(const drawing *d, panel_layout *l, const placement *grid)
{
    double width, height;
    l->legend = (figure_rect){0};
    l->legend_inside = false;

    // nothing to tell apart
    if (d->fig->common_legend || l->panel->keyless || labelled_series(l->panel) < 2) {
        l->legend_row = l->legend_column = false;
        return true;
    }

    legend_size(d, l->panel, l->legend_row, &width, &height);

    // a row that is wider than the panel becomes a column
    if (l->legend_row && width > d->column[l->column].right - d->column[l->column].left) {
        l->legend_column = true;
        legend_size(d, l->panel, false, &width, &height);
    }

    // above the panel, at its right end
    if (l->legend_row) {
        l->legend = (figure_rect){d->column[l->column].right - width, l->plane.box.y - height - 1,
                                  width, height};
        if (l->panel->heading != NULL) {
            l->legend.y -= HEADING_ROW;
        }
        if (l->panel->impulse_count > 0) {
            l->legend.y = l->strip_top - height;
        }
        return true;
    }

    l->legend_inside = true;
    return placement_find(grid, width, height, LEGEND_MARGIN, &l->legend) < INK_CURVE;
}

// ---- strokes

void draw_legend(drawing *d, const panel_layout *l)
{
    double x = l->legend.x, y = l->legend.y;
    if (l->legend.width > 0 && !l->legend_inside && !d->fig->transparent) {
        // hairlines of marks do not cross it
        fill_box(d->cr, &l->legend, d->style.colours->page);
    }

    // entry by entry, downwards or to the right
    legend_entry e;
    for (int i = 0; i < l->panel->series_count && l->legend.width > 0; i++) {
        if (!entry_of(d, &l->panel->series[i], 0, &e)) {
            continue;
        }
        draw_entry(d, l, i, &e, x, y);
        if (l->legend_inside || l->legend_column) {
            y += e.height;
        } else {
            x += e.width + SWATCH + 3 * SWATCH_SPACE;
        }
    }
}

// ---- one for all panels

double common_legend(drawing *d, bool draw)
{
    panel_layout key = {.panel = d->fig->key}, *l = key.panel != NULL ? &key : &d->panels[0];
    double x = d->left, y = d->legend_y, line = 0;
    legend_entry e;
    for (int i = 0; d->fig->common_legend && i < l->panel->series_count; i++) {
        if (!entry_of(d, &l->panel->series[i], d->right - d->left - SWATCH - SWATCH_SPACE, &e)) {
            continue;
        }

        // a new row where this one is full
        double width = e.width + SWATCH + SWATCH_SPACE;
        if (x > d->left && x + width > d->right) {
            x = d->left;
            y += line;
            line = 0;
        }

        line = fmax(line, e.height);
        if (draw) {
            draw_entry(d, l, i, &e, x, y);
        }
        x += width + 2 * SWATCH_SPACE;
    }
    return y + line - d->legend_y;
}
