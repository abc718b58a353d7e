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
#define ZERO_WIDTH   3.0  // of the line of zero, with its rim
#define ZERO_CORE    1.6  // of that line without its rim

enum { FINEST_PARTS = 8, FINE_COLUMNS = 400 };

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
    cairo_set_line_cap(d->cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_source_rgba(d->cr, dark, dark, dark, 0.85);
}

// The slope at a point of a curve through it and its two neighbours: the harmonic mean of
// the slopes on both sides, weighted by their lengths, or 0 between slopes of different
// signs. A missing side leaves the other one's slope.
static double monotone_slope(double left, double right, double left_slope,
                             double right_slope)
{
    if (!isfinite(left_slope)) {
        return right_slope;
    }
    if (!isfinite(right_slope)) {
        return left_slope;
    }
    if (left_slope * right_slope <= 0) {
        return 0;
    }
    const double near = 2 * right + left, far = 2 * left + right;
    return (near + far) / (near / left_slope + far / right_slope);
}

// The monotone cubic (Fritsch and Butland 1984) between points 1 and 2 of four, at a
// share of the way. Missing values are NaN; the outer ones may be.
static double monotone_cubic(const double at[4], const double z[4], double share)
{
    double length[3], slope[3];
    for (int i = 0; i < 3; i++) {
        length[i] = at[i + 1] - at[i];
        slope[i] = (z[i + 1] - z[i]) / length[i];
    }
    const double begins = monotone_slope(length[0], length[1], slope[0], slope[1]);
    const double ends = monotone_slope(length[1], length[2], slope[1], slope[2]);

    // by Hermite's polynomials
    const double t = share, u = 1 - share;
    return z[1] * u * u * (1 + 2 * t) + z[2] * t * t * (1 + 2 * u) +
           length[1] * t * u * (begins * u - ends * t);
}

// Refines values along one axis: `count` of them at at[], a step of `from_step` apart in
// `from`, become (count - 1) parts + 1 in `to`.
static void refine_along(const double *at, size_t count, const double *from,
                         size_t from_step, double *to, size_t to_step, size_t parts)
{
    for (size_t i = 0; i + 1 < count; i++) {
        double place[4], z[4];
        for (size_t k = 0; k < 4; k++) {
            const bool there = i + k >= 1 && i + k - 1 < count;
            place[k] = (double)NAN;
            z[k] = (double)NAN;
            if (there) {
                place[k] = at[i + k - 1];
                z[k] = from[(i + k - 1) * from_step];
            }
        }
        to[i * parts * to_step] = z[1];
        for (size_t k = 1; k < parts; k++) {
            to[(i * parts + k) * to_step] =
                monotone_cubic(place, z, (double)k / (double)parts);
        }
    }
    to[(count - 1) * parts * to_step] = from[(count - 1) * from_step];
}

void fine_grid_finish(fine_grid *g)
{
    g_free(g->x);
    g_free(g->y);
    g_free(g->z);
}

// First between columns, row by row, then between rows.
fine_grid map_refine(const figure_map *map, const plane *p, scale_kind kind, size_t parts)
{
    assert(map->columns > 1 && map->rows > 1 && parts > 0);
    fine_grid g = {.columns = (map->columns - 1) * parts + 1,
                   .rows = (map->rows - 1) * parts + 1};
    g.x = g_new(double, g.columns);
    g.y = g_new(double, g.rows);
    g.z = g_new(double, g.columns *g.rows);
    g_autofree double *x = g_new(double, map->columns);
    g_autofree double *y = g_new(double, map->rows);
    g_autofree double *z = g_new(double, map->columns * map->rows);
    g_autofree double *between = g_new(double, g.columns * map->rows);

    // places on the page, and values on their scale
    for (size_t i = 0; i < map->columns; i++) {
        x[i] = plane_x(p, map->x[i]);
    }
    for (size_t j = 0; j < map->rows; j++) {
        y[j] = plane_y(p, map->y[j]);
    }
    for (size_t i = 0; i < map->columns * map->rows; i++) {
        z[i] = scale_coordinate(kind, map->z[i]);
    }

    // even places between the points
    for (size_t i = 0; i < g.columns; i++) {
        const size_t k = MIN(i / parts, map->columns - 2);
        g.x[i] = x[k] + (x[k + 1] - x[k]) * (double)(i - k * parts) / (double)parts;
    }
    for (size_t j = 0; j < g.rows; j++) {
        const size_t k = MIN(j / parts, map->rows - 2);
        g.y[j] = y[k] + (y[k + 1] - y[k]) * (double)(j - k * parts) / (double)parts;
    }

    // values between them
    for (size_t j = 0; j < map->rows; j++) {
        refine_along(x, map->columns, z + j, map->rows, between + j, map->rows, parts);
    }
    for (size_t i = 0; i < g.columns; i++) {
        refine_along(y, map->rows, between + i * map->rows, 1, g.z + i * g.rows, 1,
                     parts);
    }
    return g;
}

// Adds the contour line of a level, a coordinate of the colour scale, to the path, square
// by square.
static void trace_contour(const drawing *d, const fine_grid *g, double level)
{
    for (size_t i = 0; i + 1 < g->columns; i++) {
        for (size_t j = 0; j + 1 < g->rows; j++) {
            contour_piece pieces[2];
            const double *a = &g->z[i * g->rows + j], *b = a + g->rows;
            int count =
                contour_square((const double[]){a[0], b[0], a[1], b[1]}, level, pieces);
            const double width = g->x[i + 1] - g->x[i], height = g->y[j + 1] - g->y[j];
            for (int k = 0; k < count; k++) {
                const contour_piece *q = &pieces[k];
                cairo_move_to(d->cr, g->x[i] + q->x0 * width, g->y[j] + q->y0 * height);
                cairo_line_to(d->cr, g->x[i] + q->x1 * width, g->y[j] + q->y1 * height);
            }
        }
    }
}

// Strokes the path as the line of zero: black with a white rim, over any colour.
static void stroke_zero(const drawing *d)
{
    cairo_set_line_cap(d->cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_source_rgb(d->cr, 1, 1, 1);
    cairo_set_line_width(d->cr, ZERO_WIDTH);
    cairo_stroke_preserve(d->cr);
    cairo_set_source_rgb(d->cr, 0, 0, 0);
    cairo_set_line_width(d->cr, ZERO_CORE);
    cairo_stroke(d->cr);
    cairo_set_line_cap(d->cr, CAIRO_LINE_CAP_BUTT);
}

// Draws contour lines at the ticks of the colours, and that of zero.
static void draw_contours(const drawing *d, const panel_layout *l)
{
    const figure_map *map = l->panel->map;
    const scale_kind kind = l->colours.scale.kind;
    if (map->columns < 2 || map->rows < 2) {
        return;
    }

    // as many parts of a cell as many columns leave room for
    size_t parts = FINEST_PARTS;
    while (parts > 1 && parts * MAX(map->columns, map->rows) > FINE_COLUMNS) {
        parts--;
    }

    SCOPED(fine_grid_finish) fine_grid g = map_refine(map, &l->plane, kind, parts);
    for (int i = 0; i < l->colours.count && map->contours; i++) {
        set_contour_line(d, l, l->colours.at[i]);
        trace_contour(d, &g, scale_coordinate(kind, l->colours.at[i]));
        cairo_stroke(d->cr);
    }
    if (map->zero) {
        trace_contour(d, &g, 0);
        stroke_zero(d);
    }
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

    // cells, and contour lines over them
    draw_cells(d, l);
    if (map->contours || map->zero) {
        draw_contours(d, l);
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
    if (l->panel->map != NULL && l->panel->map->zero &&
        scale_holds(&l->colours.scale, 0)) {
        const double y = bar.y + bar.height * (1 - scale_share(&l->colours.scale, 0));
        cairo_move_to(d->cr, bar.x, y);
        cairo_line_to(d->cr, right, y);
        stroke_zero(d);
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
