// Maps: coloured cells over a grid of points, contour lines, and the bar that says what
// the colours mean.
#include <assert.h>
#include <math.h>

#include "render/page/picture_file.h"
#include "render/plot/drawing.h"

// The pieces of a contour line within a square whose corners have the values z: finds
// where the level crosses the sides, by linear interpolation, and joins the crossings in
// pairs. Returns the number of pieces.
int contour_square(const double z[4], double level, contour_piece pieces[2])
{
    assert(isfinite(level));

    // the corners counterclockwise; side i begins at corner i and is crossed at
    // cross_x[i], cross_y[i]
    static const int corner[4] = {0, 1, 3, 2};
    static const double corner_x[4] = {0, 1, 1, 0}, corner_y[4] = {0, 0, 1, 1};
    double cross_x[4] = {0}, cross_y[4] = {0};
    int side[4], count = 0;
    for (int i = 0; i < 4; i++) {
        if (!isfinite(z[i])) {
            return 0;
        }
    }

    // where the level crosses the sides
    for (int i = 0; i < 4; i++) {
        int j = (i + 1) % 4;
        double a = z[corner[i]], b = z[corner[j]];
        if ((a >= level) != (b >= level)) {
            double share = (level - a) / (b - a);
            cross_x[i] = corner_x[i] + share * (corner_x[j] - corner_x[i]);
            cross_y[i] = corner_y[i] + share * (corner_y[j] - corner_y[i]);
            side[count++] = i;
        }
    }

    // With four crossings each piece cuts off a corner on the other side of the level
    // than the middle
    bool middle = (z[0] + z[1] + z[2] + z[3]) / 4 >= level;
    int first = 0;
    if (count == 4 && (z[0] >= level) != middle) {
        first = 3;
    }
    for (int i = 0; i < count / 2; i++) {
        int from = side[(first + 2 * i) % count], to = side[(first + 2 * i + 1) % count];
        pieces[i] =
            (contour_piece){cross_x[from], cross_y[from], cross_x[to], cross_y[to]};
    }
    return count / 2;
}

#define BAR_DISTANCE 9.0 // from the panel [pt]
#define BAR_WIDTH    9.0
#define HATCH        4.0  // distance of hatching lines
#define OVERLAP      0.4  // of a cell under its later neighbours
#define BRIGHT       0.55 // share of the colour scale above which lines over it are dark

// ---- scales

// The border between the cells of points i - 1 and i, in coordinates of the scale; i = 0
// and i = count are the outer borders.
static double cell_edge(scale_kind kind, const double *points, size_t count, size_t i)
{
    // a single point has a cell of width 1
    if (count == 1 && i == 0) {
        return scale_coordinate(kind, points[0]) - 0.5;
    }
    if (count == 1) {
        return scale_coordinate(kind, points[0]) + 0.5;
    }

    // the middle between two neighbours; an outer border is as far from the last point as
    // the border on its other side
    const size_t k = CLAMP(i, 1, count - 1);
    double before = scale_coordinate(kind, points[k - 1]);
    double after = scale_coordinate(kind, points[k]);
    if (i == 0) {
        return before - 0.5 * (after - before);
    }
    if (i == count) {
        return after + 0.5 * (after - before);
    }
    return 0.5 * (before + after);
}

// Includes the outer borders of cells along one axis.
static void include_edges(axis_scale *s, const double *points, size_t count)
{
    scale_include(s, scale_value(s->kind, cell_edge(s->kind, points, count, 0)));
    scale_include(s, scale_value(s->kind, cell_edge(s->kind, points, count, count)));
}

void map_include(const figure_map *map, axis_scale *x, axis_scale *y)
{
    include_edges(x, map->x, map->columns);
    include_edges(y, map->y, map->rows);
}

// Chooses the range of the colour scale: the given one, or that of all cells and markers.
void map_choose_scale(panel_layout *l)
{
    const figure_panel *panel = l->panel;
    axis_scale *s = &l->colours.scale;
    if (scale_take_ends(s, &panel->colours->axis)) {
        return;
    }

    // the values of cells and markers
    for (size_t i = 0; panel->map != NULL && i < panel->map->columns * panel->map->rows;
         i++) {
        scale_include(s, panel->map->z[i]);
    }
    for (int k = 0; k < panel->series_count; k++) {
        for (size_t i = 0; panel->series[k].shade != NULL && i < panel->series[k].count;
             i++) {
            scale_include(s, series_shade(&panel->series[k], i));
        }
    }

    scale_widen(s, 0);
}

// ---- cells

// The share of the colour scale at which a value lies, limited to 0 to 1.
static double shade_share(const panel_layout *l, double value)
{
    double share = fmin(1, fmax(0, scale_share(&l->colours.scale, value)));
    if (l->panel->colours->reversed) {
        return 1 - share;
    }
    return share;
}

void set_shade(const drawing *d, const panel_layout *l, double value)
{
    set_colour(d->cr, palette_shade(d->style.theme, shade_share(l, value)));
}

// Fills a cell without a value: grey with hatching.
static void fill_missing(const drawing *d, const figure_rect *r)
{
    cairo_save(d->cr);
    clip_to(d->cr, r);

    set_colour(d->cr, d->style.colours->grid);
    cairo_paint(d->cr);
    cairo_set_antialias(d->cr, CAIRO_ANTIALIAS_DEFAULT);

    // the hatching's lines, x + y = constant, are at fixed places of the page, so that
    // they continue from cell to cell
    set_plain_line(d->cr, d->style.colours->mark, GRID_WIDTH);
    double from = floor((r->x + r->y) / HATCH) * HATCH,
           to = r->x + r->width + r->y + r->height;
    for (double sum = from; sum <= to; sum += HATCH) {
        picture_line(d->cr, sum - r->y, r->y, sum - r->y - r->height, r->y + r->height);
    }
    cairo_restore(d->cr);
}

// Where a coordinate of a scale lies on the page [pt].
static double page_x(const plane *p, double at)
{
    return p->box.x + p->box.width * (at - p->x.low) / (p->x.high - p->x.low);
}

static double page_y(const plane *p, double at)
{
    return p->box.y + p->box.height * (p->y.high - at) / (p->y.high - p->y.low);
}

// Draws each cell of a map as a rectangle in its colour.
static void draw_cells(const drawing *d, const panel_layout *l)
{
    const figure_map *map = l->panel->map;
    const plane *p = &l->plane;

    // Smoothed edges would leave a hairline between neighbours. They are not smoothed
    // here, and in case a viewer smooths them every cell extends a little under later
    // neighbours
    cairo_set_antialias(d->cr, CAIRO_ANTIALIAS_NONE);

    // column by column
    for (size_t i = 0; i < map->columns; i++) {
        double left = page_x(p, cell_edge(p->x.kind, map->x, map->columns, i));
        double right = page_x(p, cell_edge(p->x.kind, map->x, map->columns, i + 1));
        for (size_t j = 0; j < map->rows; j++) {
            double top =
                page_y(p, cell_edge(p->y.kind, map->y, map->rows, j + 1)) - OVERLAP;
            double bottom = page_y(p, cell_edge(p->y.kind, map->y, map->rows, j));
            figure_rect r = {left, top, right - left + OVERLAP, bottom - top};
            double value = map->z[i * map->rows + j];
            if (isfinite(value)) {
                fill_box(d->cr, &r, palette_shade(d->style.theme, shade_share(l, value)));
            } else {
                fill_missing(d, &r);
            }
        }
    }
    cairo_set_antialias(d->cr, CAIRO_ANTIALIAS_DEFAULT);
}

// ---- contour lines

// Sets the pen of a level's contour line: white over dark colours, black over bright
// ones.
static void set_contour_line(const drawing *d, const panel_layout *l, double level)
{
    bool dark = shade_share(l, level) < BRIGHT;
    set_plain_line(d->cr, (colour){dark, dark, dark}, SECONDARY_WIDTH);
    cairo_set_source_rgba(d->cr, dark, dark, dark, 0.85);
}

// Draws the contour line of a level, square by square.
static void draw_contour(const drawing *d, const panel_layout *l, double level)
{
    const figure_map *map = l->panel->map;
    const plane *p = &l->plane;

    // the pieces of every square of four points
    for (size_t i = 0; i + 1 < map->columns; i++) {
        for (size_t j = 0; j + 1 < map->rows; j++) {
            contour_piece pieces[2];
            const double *a = &map->z[i * map->rows + j], *b = a + map->rows;
            int count =
                contour_square((const double[]){a[0], b[0], a[1], b[1]}, level, pieces);
            double x0 = plane_x(p, map->x[i]), x1 = plane_x(p, map->x[i + 1]);
            double y0 = plane_y(p, map->y[j]), y1 = plane_y(p, map->y[j + 1]);
            for (int k = 0; k < count; k++) {
                const contour_piece *q = &pieces[k];
                cairo_move_to(d->cr, x0 + q->x0 * (x1 - x0), y0 + q->y0 * (y1 - y0));
                cairo_line_to(d->cr, x0 + q->x1 * (x1 - x0), y0 + q->y1 * (y1 - y0));
            }
        }
    }

    cairo_stroke(d->cr);
}

// Draws the map of a panel: its cells, and contour lines over them.
void draw_panel_map(drawing *d, const panel_layout *l)
{
    const figure_map *map = l->panel->map;
    if (map == NULL) {
        return;
    }
    cairo_save(d->cr);
    clip_to(d->cr, &l->plane.box);

    // cells, and contour lines at the ticks of the colours
    draw_cells(d, l);
    for (int i = 0; map->contours && i < l->colours.count; i++) {
        set_contour_line(d, l, l->colours.at[i]);
        draw_contour(d, l, l->colours.at[i]);
    }

    cairo_restore(d->cr);
}

// ---- the bar

static bool has_bar(const panel_layout *l)
{
    return l->panel->colours != NULL && l->panel->colours->bar;
}

double colour_bar_width(const drawing *d, const panel_layout *l)
{
    if (!has_bar(l)) {
        return 0;
    }
    return BAR_DISTANCE + BAR_WIDTH + TICK_LENGTH + TICK_SPACE +
           widest_tick(d, &l->colours, d->style.tick) + LABEL_SPACE +
           axis_title_height(d, &l->colours, l->plane.box.height);
}

// Fills the bar with the colours from bottom to top. Each stripe reaches to the top,
// under the later ones, so that no gap is left between them.
static void fill_bar(const drawing *d, const panel_layout *l, const figure_rect *bar)
{
    enum { STRIPES = 256 };
    cairo_set_antialias(d->cr, CAIRO_ANTIALIAS_NONE);
    for (int i = 0; i < STRIPES; i++) {
        double share = (i + 0.5) / STRIPES,
               height = bar->height * (1 - (double)i / STRIPES);
        if (l->panel->colours->reversed) {
            share = 1 - share;
        }
        fill_box(d->cr, &(figure_rect){bar->x, bar->y, bar->width, height},
                 palette_shade(d->style.theme, share));
    }
    cairo_set_antialias(d->cr, CAIRO_ANTIALIAS_DEFAULT);
}

// Draws the colour bar at the right of the panel, with ticks and a title.
void draw_colour_bar(drawing *d, const panel_layout *l)
{
    const figure_rect *box = &l->plane.box;
    if (!has_bar(l)) {
        return;
    }

    const figure_rect bar = {box->x + box->width + BAR_DISTANCE, box->y, BAR_WIDTH,
                             box->height};
    double right = bar.x + bar.width;
    fill_bar(d, l, &bar);

    // ticks with labels; with contour lines those of the lines
    for (int i = 0; i < l->colours.count; i++) {
        double y =
            bar.y + bar.height * (1 - scale_share(&l->colours.scale, l->colours.at[i]));
        if (l->panel->map != NULL && l->panel->map->contours) {
            set_contour_line(d, l, l->colours.at[i]);
            picture_line(d->cr, bar.x, y, right, y);
        }

        set_plain_line(d->cr, d->style.colours->axis, AXIS_WIDTH);
        picture_line(d->cr, right, y, right + TICK_LENGTH, y);
        draw_markup(d, l->colours.text[i], d->style.tick,
                    right + TICK_LENGTH + TICK_SPACE, y, (anchor){0, 0.5});
    }
    set_plain_line(d->cr, d->style.colours->axis, AXIS_WIDTH);
    cairo_rectangle(d->cr, bar.x, bar.y, bar.width, bar.height);
    cairo_stroke(d->cr);

    // what it is, upwards at the right
    g_autofree char *title = axis_title(&l->colours);
    text_block t = figure_text_of(d, title, d->style.label);
    t.align = TEXT_CENTRE;
    t.width = box->height;
    draw_rotated(d, t,
                 right + TICK_LENGTH + TICK_SPACE +
                     widest_tick(d, &l->colours, d->style.tick) + LABEL_SPACE,
                 box->y + box->height / 2, d->style.colours->text);
}
