// A quantity over two parameters: coloured cells with contour lines, or coloured dots.
#include "render/plot/sweep_canvas.h"

#include <math.h>
#include <string.h>

#define BAR_WIDTH    11.0 // [pt]
#define BAR_DISTANCE 12.0

void sweep_plot_colour(double share, double rgb[3])
{
    static const unsigned char points[][3] = {
        {0x44, 0x01, 0x54}, {0x47, 0x2d, 0x7b}, {0x3b, 0x52, 0x8b},
        {0x2c, 0x72, 0x8e}, {0x21, 0x91, 0x8c}, {0x28, 0xae, 0x80},
        {0x5e, 0xc9, 0x62}, {0xad, 0xdc, 0x30}, {0xfd, 0xe7, 0x25},
    };
    enum { LAST = sizeof points / sizeof points[0] - 1 };
    double at = fmin(fmax(share, 0), 1) * LAST;
    int i = at >= LAST ? LAST - 1 : (int)at;
    for (int k = 0; k < 3; k++) {
        rgb[k] = (points[i][k] + (at - i) * (points[i + 1][k] - points[i][k])) / 255;
    }
}

int contour_square(const double z[4], double level, contour_piece pieces[2])
{
    // corners in the order of going round, and the crossing of the side that begins at each
    static const int corner[4] = {0, 1, 3, 2};
    static const double corner_x[4] = {0, 1, 1, 0}, corner_y[4] = {0, 0, 1, 1};
    double cross_x[4] = {0}, cross_y[4] = {0};
    int side[4], count = 0;
    for (int i = 0; i < 4; i++) {
        if (!isfinite(z[i])) {
            return 0;
        }
    }
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
    // four crossings: the pieces cut off the corners that differ from the middle
    bool middle = (z[0] + z[1] + z[2] + z[3]) / 4 >= level;
    int first = count == 4 && (z[0] >= level) != middle ? 3 : 0;
    for (int i = 0; i < count / 2; i++) {
        int from = side[(first + 2 * i) % count], to = side[(first + 2 * i + 1) % count];
        pieces[i] = (contour_piece){cross_x[from], cross_y[from], cross_x[to], cross_y[to]};
    }
    return count / 2;
}

// The picture's share of the colour scale for a value.
static void use_value_colour(sweep_canvas *c, const sweep_scale *bar, double value)
{
    double rgb[3];
    sweep_plot_colour((value - bar->low) / (bar->high - bar->low), rgb);
    cairo_set_source_rgb(c->cr, rgb[0], rgb[1], rgb[2]);
}

// The border between points i - 1 and i of an axis; i = 0 and i = count are its outer ends.
static double cell_edge(const sweep_scale *s, size_t i)
{
    if (s->count == 1) {
        return i == 0 ? s->points[0] - 0.5 : s->points[0] + 0.5;
    }
    if (i == 0) {
        return s->points[0] - 0.5 * (s->points[1] - s->points[0]);
    }
    if (i == s->count) {
        return s->points[i - 1] + 0.5 * (s->points[i - 1] - s->points[i - 2]);
    }
    return 0.5 * (s->points[i - 1] + s->points[i]);
}

// The quantity at point (i, j) of the picture.
static double value_at(const sweep_canvas *c, const sweep_picture *p, size_t i, size_t j)
{
    return p->values[c->x.order[i] * p->sweep->axes[1].count + c->y.order[j]];
}

// Grey with hatching: a run without a value.
static void fill_missing(sweep_canvas *c, const figure_rect *r)
{
    cairo_save(c->cr);
    cairo_rectangle(c->cr, r->x, r->y, r->width, r->height);
    cairo_clip_preserve(c->cr);
    set_colour(c->cr, c->colours->grid);
    cairo_fill(c->cr);
    cairo_set_antialias(c->cr, CAIRO_ANTIALIAS_DEFAULT);
    set_colour(c->cr, c->colours->mark);
    cairo_set_line_width(c->cr, 0.4);
    // lines at fixed places of the page, so that they run on from cell to cell
    double from = floor((r->x + r->y) / 4) * 4, to = r->x + r->width + r->y + r->height;
    for (double sum = from; sum <= to; sum += 4) {
        sweep_draw_line(c, sum - r->y, r->y, sum - r->y - r->height, r->y + r->height);
    }
    cairo_restore(c->cr);
}

static void draw_cells(sweep_canvas *c, const sweep_picture *p, const sweep_scale *bar)
{
    // neighbours would show a hairline between them if edges were smoothed, or if a viewer smooths
    // them: every cell reaches a little under its later neighbours
    const double overlap = 0.4;
    cairo_set_antialias(c->cr, CAIRO_ANTIALIAS_NONE);
    for (size_t i = 0; i < c->x.count; i++) {
        double left = sweep_page_x(c, cell_edge(&c->x, i)),
               right = sweep_page_x(c, cell_edge(&c->x, i + 1));
        for (size_t j = 0; j < c->y.count; j++) {
            double top = sweep_page_y(c, cell_edge(&c->y, j + 1)) - overlap;
            double bottom = sweep_page_y(c, cell_edge(&c->y, j));
            figure_rect r = {left, top, right - left + overlap, bottom - top};
            double value = value_at(c, p, i, j);
            if (isfinite(value)) {
                use_value_colour(c, bar, value);
                cairo_rectangle(c->cr, r.x, r.y, r.width, r.height);
                cairo_fill(c->cr);
            } else {
                fill_missing(c, &r);
            }
        }
    }
    cairo_set_antialias(c->cr, CAIRO_ANTIALIAS_DEFAULT);
}

// White on the dark half of the colour scale, black on the bright one.
static void use_contour_colour(sweep_canvas *c, const sweep_scale *bar, double level)
{
    bool dark = level < bar->low + 0.55 * (bar->high - bar->low);
    cairo_set_source_rgba(c->cr, dark, dark, dark, 0.85);
    set_line_style(c->cr, LINE_SOLID, 0.7);
}

static void draw_contour(sweep_canvas *c, const sweep_picture *p, double level)
{
    for (size_t i = 0; i + 1 < c->x.count; i++) {
        for (size_t j = 0; j + 1 < c->y.count; j++) {
            contour_piece pieces[2];
            const double z[4] = {value_at(c, p, i, j), value_at(c, p, i + 1, j),
                                 value_at(c, p, i, j + 1), value_at(c, p, i + 1, j + 1)};
            double x0 = sweep_page_x(c, c->x.points[i]), x1 = sweep_page_x(c, c->x.points[i + 1]);
            double y0 = sweep_page_y(c, c->y.points[j]), y1 = sweep_page_y(c, c->y.points[j + 1]);
            int count = contour_square(z, level, pieces);
            for (int k = 0; k < count; k++) {
                const contour_piece *q = &pieces[k];
                cairo_move_to(c->cr, x0 + q->x0 * (x1 - x0), y0 + q->y0 * (y1 - y0));
                cairo_line_to(c->cr, x0 + q->x1 * (x1 - x0), y0 + q->y1 * (y1 - y0));
            }
        }
    }
    cairo_stroke(c->cr);
}

// Coloured dots for values that were drawn at random.
static void draw_dots(sweep_canvas *c, const sweep_picture *p, const sweep_scale *bar)
{
    double radius = p->sweep->run_count > 1000 ? 1.5 : p->sweep->run_count > 200 ? 2.2 : 3.2;
    for (size_t run = 0; run < p->sweep->run_count; run++) {
        double x = sweep_coordinate(&c->x, sweep_value(p->sweep, run, 0));
        double y = sweep_coordinate(&c->y, sweep_value(p->sweep, run, 1));
        sweep_dot(c, sweep_page_x(c, x), sweep_page_y(c, y), radius);
        if (isfinite(p->values[run])) {
            use_value_colour(c, bar, p->values[run]);
            cairo_fill_preserve(c->cr);
        }
        set_colour(c->cr, c->colours->axis);
        cairo_set_line_width(c->cr, 0.3);
        cairo_stroke(c->cr);
    }
}

// The colour bar at the right of the box, with the levels of the contour lines.
static void draw_bar(sweep_canvas *c, const sweep_scale *bar, bool contours)
{
    enum { STRIPES = 256 };
    double x = c->box.x + c->box.width + BAR_DISTANCE, height = c->box.height;
    cairo_set_antialias(c->cr, CAIRO_ANTIALIAS_NONE);
    for (int i = 0; i < STRIPES; i++) {
        // each stripe reaches to the top, so that no gap is left between them
        double share = (i + 0.5) / STRIPES, bottom = c->box.y + height * (1 - (double)i / STRIPES);
        use_value_colour(c, bar, bar->low + share * (bar->high - bar->low));
        cairo_rectangle(c->cr, x, c->box.y, BAR_WIDTH, bottom - c->box.y);
        cairo_fill(c->cr);
    }
    cairo_set_antialias(c->cr, CAIRO_ANTIALIAS_DEFAULT);
    for (int i = 0; i < bar->tick_count; i++) {
        double level = bar->ticks[i].at;
        double y = c->box.y + height * (bar->high - level) / (bar->high - bar->low);
        if (contours) {
            use_contour_colour(c, bar, level);
            sweep_draw_line(c, x, y, x + BAR_WIDTH, y);
        }
        set_colour(c->cr, c->colours->axis);
        cairo_set_line_width(c->cr, 0.7);
        sweep_draw_line(c, x + BAR_WIDTH, y, x + BAR_WIDTH + TICK_LENGTH, y);
        set_colour(c->cr, c->colours->text);
        sweep_text(c, x + BAR_WIDTH + TICK_LENGTH + 2, y, bar->ticks[i].text, TICK_SIZE, 0, 0.5);
    }
    set_colour(c->cr, c->colours->axis);
    cairo_rectangle(c->cr, x, c->box.y, BAR_WIDTH, height);
    cairo_stroke(c->cr);
    set_colour(c->cr, c->colours->text);
    sweep_upright_text(c, PAGE_WIDTH - MARGIN - LABEL_SIZE * 1.3, c->box.y + height / 2, bar->label,
                       LABEL_SIZE);
}

static void draw_map(sweep_canvas *c, const sweep_picture *p, const sweep_scale *bar, bool grid,
                     bool contours)
{
    cairo_save(c->cr);
    cairo_rectangle(c->cr, c->box.x, c->box.y, c->box.width, c->box.height);
    cairo_clip(c->cr);
    if (grid) {
        draw_cells(c, p, bar);
    } else {
        sweep_draw_grid(c);
        draw_dots(c, p, bar);
    }
    for (int i = 0; contours && i < bar->tick_count; i++) {
        use_contour_colour(c, bar, bar->ticks[i].at);
        draw_contour(c, p, bar->ticks[i].at);
    }
    cairo_restore(c->cr);
}

status sweep_paint_map(sweep_canvas *c, const sweep_picture *p, fault *f)
{
    const sweep *s = p->sweep;
    double low, high;
    char note[128];
    sweep_scale bar;
    if (!sweep_scale_of_axis(&c->x, &s->axes[0], 8) ||
        !sweep_scale_of_axis(&c->y, &s->axes[1], 7)) {
        return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
    }
    bool any = sweep_value_range(p->values, s->run_count, &low, &high);
    low = any ? low : 0;
    high = any ? high : 1;
    if (!(high > low)) {
        double room = fmax(0.1 * fabs(high), 1e-12);
        low -= room;
        high += room;
    }
    sweep_scale_of_quantity(&bar, p->key, low, high, 7);
    bool grid = s->sampling == SWEEP_GRID;
    bool contours = grid && any && c->x.kind != SCALE_WORDS && c->y.kind != SCALE_WORDS;
    if (grid) {
        c->x.low = cell_edge(&c->x, 0);
        c->x.high = cell_edge(&c->x, c->x.count);
        c->y.low = cell_edge(&c->y, 0);
        c->y.high = cell_edge(&c->y, c->y.count);
    } else {
        sweep_scale_widen(&c->x, 0.03);
        sweep_scale_widen(&c->y, 0.03);
    }
    sweep_missing_note(p, note, sizeof note, grid ? " (hatched)" : " (empty)");
    sweep_place_box(c,
                    BAR_DISTANCE + BAR_WIDTH + TICK_LENGTH + 4 + sweep_widest_tick(c, &bar) +
                        LABEL_SIZE * 1.5,
                    note[0] != '\0');
    draw_map(c, p, &bar, grid, contours);
    sweep_draw_axes(c);
    draw_bar(c, &bar, contours);
    sweep_draw_title(c, p, note);
    if (!any) {
        sweep_no_value_text(c);
    }
    return STATUS_OK;
}
