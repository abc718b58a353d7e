// What takes a free place in a panel: legends (also in a row or column above it, or one
// for all panels), and the inset, a short stretch of the panel once more, larger.
#include <math.h>

#include "render/page/picture_file.h"
#include "render/plot/drawing.h"

// The cost of a place's distance from the corners, less than one unit of ink, so that it
// decides among places of equal ink. The left side and the bottom cost a little more.
static double corner_cost(const placement *g, const figure_rect *r, double margin)
{
    double left = r->x - g->box.x - margin, above = r->y - g->box.y - margin;
    double right = g->box.x + g->box.width - margin - r->x - r->width;
    double below = g->box.y + g->box.height - margin - r->y - r->height;
    double across = fmin(right, left + 0.02 * g->box.width) / g->box.width;
    double down = fmin(above, below + 0.1 * g->box.height) / g->box.height;
    return 0.4 * across + 0.4 * down;
}

// The ink of all cells above and left of each cell, itself included (a summed-area
// table).
static placement summed_ink(const placement *g)
{
    placement sums = *g;
    for (int r = 1; r <= PLACEMENT_ROWS; r++) {
        for (int c = 1; c <= PLACEMENT_COLUMNS; c++) {
            sums.ink[r][c] +=
                sums.ink[r - 1][c] + sums.ink[r][c - 1] - sums.ink[r - 1][c - 1];
        }
    }
    return sums;
}

// The place of a width x height rectangle, `margin` from the box's edges, with the least
// ink under it; among equal ones the nearest to a corner, preferring the right to the
// left and the top to the bottom. Returns the ink under it (INFINITY if the box is too
// small).
static double placement_find(const placement *g, double width, double height,
                             double margin, figure_rect *found)
{
    const placement sums = summed_ink(g);

    // its size in whole cells, with the margin on both sides, and by how much the cells
    // are larger
    const double cell_width = g->box.width / PLACEMENT_COLUMNS;
    const double cell_height = g->box.height / PLACEMENT_ROWS;
    const int columns = (int)ceil((width + 2 * margin) / cell_width);
    const int rows = (int)ceil((height + 2 * margin) / cell_height);
    const double slack_x = columns * cell_width - width - 2 * margin;
    const double slack_y = rows * cell_height - height - 2 * margin;

    // every place where it fits; the ink within follows from the sums at its four corners
    double best = (double)INFINITY, best_ink = (double)INFINITY;
    for (int r = 0; r + rows <= PLACEMENT_ROWS; r++) {
        for (int c = 0; c + columns <= PLACEMENT_COLUMNS; c++) {
            const double ink = sums.ink[r + rows][c + columns] -
                               sums.ink[r][c + columns] - sums.ink[r + rows][c] +
                               sums.ink[r][c];

            // in the right half it stands at the right of its cells, in the lower half at
            // their bottom
            figure_rect place = {g->box.x + c * cell_width + margin,
                                 g->box.y + r * cell_height + margin, width, height};
            if (2 * c > PLACEMENT_COLUMNS - columns) {
                place.x += slack_x;
            }
            if (2 * r > PLACEMENT_ROWS - rows) {
                place.y += slack_y;
            }

            // the corner's cost decides between equal inks
            double cost = ink + corner_cost(g, &place, margin);
            if (cost < best) {
                best = cost;
                best_ink = ink;
                *found = place;
            }
        }
    }
    return best_ink;
}

// ==== the inset

#define INSET_ROOM   0.1 // of the data's range, kept free above and below them
#define LEAST_LARGER 2.0 // times that an inset enlarges the horizontal axis

// Lays out the inset's axes within its outer rectangle: ranges, ticks and the box.
static void divide_inset(const drawing *d, panel_layout *l, const figure_interval *zoom)
{
    const figure_panel *panel = l->panel;
    plane *p = &l->inset_plane;
    double line = height_of(d, figure_text_of(d, "0", d->style.small));

    // the enlarged interval of x, and the range of all y in it
    p->x = scale_empty(d->x.scale.kind);
    scale_include(&p->x, zoom->from);
    scale_include(&p->x, zoom->to);
    p->y = scale_empty(l->plane.y.kind);
    for (int i = 0; i < panel->series_count; i++) {
        series_include_y(&panel->series[i], &p->x, &p->y);
    }
    scale_widen(&p->y, INSET_ROOM);

    // ticks, and the box that leaves room for their labels
    l->inset_x.scale = p->x;
    l->inset_y.scale = p->y;
    axis_choose_ticks(&l->inset_x, &d->fig->x, axis_tick_count(l->inset.width, 35, 2, 5));
    axis_choose_ticks(&l->inset_y, &panel->y, axis_tick_count(l->inset.height, 15, 2, 4));
    double left = widest_tick(d, &l->inset_y, d->style.small) + TICK_SPACE + 4;
    double wide = widest_tick(d, &l->inset_x, d->style.small);
    double width = l->inset.width - left - wide / 2;

    // labels of a short interval have many digits: only every n-th that fits is kept
    double space = l->inset_x.even.step / (p->x.high - p->x.low) * width;
    int every = 1;
    if (space > 0) {
        every = (int)ceil((wide + LABEL_GAP) / space);
    }
    for (int i = 0; i < l->inset_x.count; i++) {
        if (i % every != 0) {
            l->inset_x.text[i] = "";
        }
    }
    p->box = (figure_rect){l->inset.x + left, l->inset.y + 3, width,
                           l->inset.height - 3 - line - TICK_SPACE - 2};
}

// How many times the inset enlarges the horizontal axis.
static double times_larger(const panel_layout *l)
{
    const plane *small = &l->inset_plane, *whole = &l->plane;
    return small->box.width / (small->x.high - small->x.low) *
           (whole->x.high - whole->x.low) / whole->box.width;
}

// The stretch of a panel's inset; empty where it has none.
static figure_interval stretch_of_inset(const drawing *d, const panel_layout *l)
{
    const figure *fig = d->fig;
    if (l == d->panels && fig->zoom_from < fig->zoom_to) {
        return (figure_interval){fig->zoom_from, fig->zoom_to};
    }
    return (figure_interval){l->panel->zoom_from, l->panel->zoom_to};
}

// Places the inset where it covers no curve, in the largest of three sizes that fits. It
// is left out if none does, or if it would be too small to read or to enlarge.
void place_inset(const drawing *d, panel_layout *l, placement *grid)
{
    static const double scales[] = {1, 0.85, 0.7};
    const figure_rect *box = &l->plane.box;
    const figure_interval zoom = stretch_of_inset(d, l);
    l->inset = (figure_rect){0};

    // nothing to enlarge
    if (!(zoom.from < zoom.to) || l->panel->map != NULL) {
        return;
    }

    // sizes from the largest on
    for (int i = 0; i < 3; i++) {
        figure_rect found;
        double width = 0.4 * scales[i] * box->width,
               height = 0.66 * scales[i] * box->height;
        if (height < 36 || width < 60) {
            return;
        }
        if (placement_find(grid, width, height, 3, &found) < INK_CURVE) {
            l->inset = found;
            divide_inset(d, l, &zoom);
            if (!(times_larger(l) >= LEAST_LARGER)) {
                l->inset = (figure_rect){0};
                return;
            }
            placement_block(grid, found, INK_CURVE);
            return;
        }
    }
}

// An inset that was asked for is there.
status check_inset(const drawing *d, const panel_layout *l, fault *f)
{
    const bool asked =
        l->panel->zoom_asked || (l == d->panels && d->fig->zoom_from < d->fig->zoom_to);
    const figure_interval zoom = stretch_of_inset(d, l);
    FAULT_IF(asked && zoom.from < zoom.to && l->inset.width <= 0, f, STATUS_BAD_ARGUMENT,
             "an inset from %g to %g finds no place where it enlarges %g times, expected "
             "a shorter stretch or a larger page",
             zoom.from, zoom.to, LEAST_LARGER);
    return STATUS_OK;
}

// Draws the inset as a small panel, and a frame round the part that it enlarges.
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
    double top =
        fmax(plane_y(&l->plane, scale_value(p->y.kind, p->y.high)), l->plane.box.y);
    double bottom = fmin(plane_y(&l->plane, scale_value(p->y.kind, p->y.low)),
                         l->plane.box.y + l->plane.box.height);
    cairo_save(d->cr);
    clip_out_labels(d);
    set_plain_line(d->cr, d->style.colours->mark, MARK_WIDTH);
    cairo_rectangle(d->cr, left, top, right - left, bottom - top);
    cairo_stroke(d->cr);
    cairo_restore(d->cr);
}

// ==== legends

// How the entries of a legend follow each other, from its upper left corner.
typedef struct legend_run {
    double x, y;
    double wrapped; // width at which a long text is wrapped; 0: never
    double right;   // where a row is full
    bool column;    // every row has one
    bool draw;      // or only measured
} legend_run;

// Lays out the entries of a legend, one for each series with a label, in rows or in a
// column, and draws them if the run asks for it. On a narrow page symbols stand for
// labels. Returns the rectangle that they take up.
static figure_rect lay_entries(drawing *d, const panel_layout *l, legend_run run)
{
    double x = run.x, y = run.y, line = 0, widest = 0;
    for (int i = 0; i < l->panel->series_count; i++) {
        const figure_series *s = &l->panel->series[i];
        if (s->label == NULL) {
            continue;
        }
        const char *label = s->label;
        if (d->page.width < NARROW_PAGE && s->symbol != NULL) {
            label = s->symbol;
        }
        text_block text = figure_text_of(d, label, d->style.tick);
        text.width = run.wrapped;
        const text_size size = text_measure(d->context, &text);

        // a new row begins where this one is full
        const double width = size.width + SWATCH + SWATCH_SPACE;
        if (x > run.x && (run.column || x + width > run.right)) {
            x = run.x;
            y += line;
            line = 0;
        }

        // the line's sample, and what it is
        if (run.draw) {
            draw_swatch(d, l, i, x, y + 0.55 * size.height);
            draw_text(d, text, x + SWATCH + SWATCH_SPACE, y, (anchor){0, 0},
                      d->style.colours->text);
        }
        line = fmax(line, size.height);
        widest = fmax(widest, x + width - run.x);
        x += width + 2 * SWATCH_SPACE;
    }
    return (figure_rect){run.x, run.y, widest, y + line - run.y};
}

static int labelled_series(const figure_panel *panel)
{
    int count = 0;
    for (int i = 0; i < panel->series_count; i++) {
        count += panel->series[i].label != NULL;
    }
    return count;
}

// The width of a text in a legend above its panel, which leaves the column beside it
// free; 0: any.
static double key_wrapped(const drawing *d, const panel_layout *l)
{
    const column_layout *c = &d->column[l->column];
    if (!l->panel->key_above) {
        return 0;
    }
    return c->right - c->left - SWATCH - SWATCH_SPACE;
}

// ---- where they go

// Places the legend of a panel: in the panel, or in a row or column above it. False if it
// belongs into the panel and has no room there.
bool place_legend(drawing *d, panel_layout *l, const placement *grid)
{
    l->legend = (figure_rect){0};
    l->legend_inside = false;

    // a panel with a single series, or none, needs no legend
    const bool above = l->panel->key_above;
    const bool alone = labelled_series(l->panel) < 2 && !above;
    if (d->fig->common_legend || l->panel->keyless || alone) {
        l->legend_row = l->legend_column = false;
        return true;
    }

    // a row that is wider than the panel becomes a column
    const column_layout *c = &d->column[l->column];
    legend_run run = {.right = (double)INFINITY, .column = !l->legend_row};
    run.wrapped = key_wrapped(d, l);
    figure_rect size = lay_entries(d, l, run);
    if (l->legend_row && !above && size.width > c->right - c->left) {
        l->legend_column = run.column = true;
        size = lay_entries(d, l, run);
    }

    // above the panel, at its right end or its left
    if (l->legend_row) {
        const double left = above ? c->left : c->right - size.width;
        l->legend = (figure_rect){left, l->plane.box.y - size.height - 1, size.width,
                                  size.height};
        if (l->panel->heading != NULL) {
            l->legend.y -= HEADING_ROW;
        }
        if (l->panel->impulse_count > 0) {
            l->legend.y = l->strip_top - size.height;
        }
        return true;
    }

    l->legend_inside = true;
    return placement_find(grid, size.width, size.height, LEGEND_MARGIN, &l->legend) <
           INK_CURVE;
}

// ---- strokes

// Draws the legend of a panel, above the panel on a background.
void draw_panel_legend(drawing *d, const panel_layout *l)
{
    if (l->legend.width > 0 && !l->legend_inside && !d->fig->transparent) {
        // hairlines of marks do not cross it
        fill_box(d->cr, &l->legend, d->style.colours->page);
    }
    if (l->legend.width > 0) {
        lay_entries(d, l,
                    (legend_run){l->legend.x, l->legend.y, .right = (double)INFINITY,
                                 .wrapped = key_wrapped(d, l),
                                 .column = l->legend_inside || l->legend_column,
                                 .draw = true});
    }
}

// ---- one for all panels

// Lays out, and draws if asked, the legend that all panels share: the entries of the
// figure's key, or of the first panel, in rows. Returns its height.
double common_legend(drawing *d, bool draw)
{
    const panel_layout key = {.panel = d->fig->key};
    const legend_run run = {d->left, d->legend_y,
                            d->right - d->left - SWATCH - SWATCH_SPACE, .right = d->right,
                            .draw = draw};
    if (!d->fig->common_legend) {
        return 0;
    }
    if (key.panel == NULL) {
        return lay_entries(d, &d->panels[0], run).height;
    }
    return lay_entries(d, &key, run).height;
}
