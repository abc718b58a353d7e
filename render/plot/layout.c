// Where everything on a page goes: ranges of the axes, columns, rows, and what stands in
// the panels.
#include <math.h>
#include <string.h>

#include "render/plot/drawing.h"

#define LEAST_WIDTH  50.0 // of a panel [pt]
#define LEAST_HEIGHT 16.0
#define POINT_ROOM   0.14 // of the data's range, above the point of a mark
#define RANGE_SPACE  0.06 // of the data's range, kept free above and below them
#define RIGHT_SPACE  10.0 // of a panel without labels next to it
// of a panel whose vertical axis is labelled in the first column
#define SHARED_SPACE 6.0
#define BAR_TICK     16.0 // of a colour bar to a tick
#define X_TICK       42.0 // of a horizontal axis to a tick
#define Y_TICK       20.0 // of a vertical axis
#define DECADE_TICK  14.0 // of a logarithmic vertical axis
#define COLUMN_WIDTH 42.0 // least width of a column of panels [mm]
// first guess of where the panels begin, before labels are measured [pt]
#define FIRST_LEFT 40.0

// ---- ranges

// Widens the range of the data by a share of it at both ends. Fails for a logarithmic
// axis without data above zero.
static status widen_range(axis_scale *s, double share, const figure_axis *from, fault *f)
{
    FAULT_IF(s->kind == SCALE_LOGARITHMIC && scale_is_empty(s), f, STATUS_BAD_ARGUMENT,
             "the logarithmic axis '%s' has no point above zero to show",
             text_or(from->name, ""));
    scale_widen(s, share);
    return STATUS_OK;
}

// Chooses the range of the horizontal axis: the given one, or that of all panels' data.
static status choose_x_range(drawing *d, fault *f)
{
    const figure *fig = d->fig;
    axis_scale *x = &d->x.scale;
    if (scale_take_ends(x, &fig->x)) {
        return STATUS_OK;
    }

    // all that any panel shows
    for (int p = 0; p < fig->panel_count; p++) {
        const figure_panel *panel = &fig->panels[p];
        axis_scale unused = scale_empty(panel->y.scale);
        for (int s = 0; s < panel->series_count; s++) {
            for (size_t i = 0; i < panel->series[s].count; i++) {
                scale_include(x, series_x(&panel->series[s], i));
            }
        }
        if (panel->map != NULL) {
            map_include(panel->map, x, &unused);
        }
    }

    return widen_range(x, fig->x.room, &fig->x, f);
}

// Extends a vertical axis so that labels of marks have room above their points.
static void include_peak_labels(const figure *fig, axis_scale *y)
{
    for (int i = 0; i < fig->mark_count; i++) {
        if (fig->marks[i].pointed) {
            scale_include(y, fig->marks[i].y + POINT_ROOM * (y->high - y->low));
        }
    }
}

// Chooses the range of a panel's vertical axis: the given one, or that of the data within
// the range of the horizontal axis.
static status choose_y_range(const drawing *d, panel_layout *l, fault *f)
{
    const figure_panel *panel = l->panel;
    axis_scale *y = &l->plane.y, unused = scale_empty(d->x.scale.kind);
    if (scale_take_ends(y, &panel->y)) {
        return STATUS_OK;
    }

    // the data of all layers
    for (int s = 0; s < panel->series_count; s++) {
        series_include_y(&panel->series[s], &d->x.scale, y);
    }
    for (int i = 0; i < panel->level_count; i++) {
        scale_include(y, panel->levels[i].y);
    }
    if (panel->map != NULL) {
        map_include(panel->map, &unused, y);
    }

    // what is said about the axis
    if (panel->y.with_zero && !scale_is_empty(y)) {
        scale_include(y, 0);
    }
    if (l == d->panels && y->kind == SCALE_LINEAR && !scale_is_empty(y)) {
        include_peak_labels(d->fig, y);
    }

    // a map reaches to the edges
    double room = RANGE_SPACE;
    if (panel->y.room > 0) {
        room = panel->y.room;
    } else if (panel->map != NULL) {
        room = 0;
    }
    return widen_range(y, room, &panel->y, f);
}

// Whether two panels have one vertical range: all of the figure, or those of a quantity.
static bool share_range(const drawing *d, int one, int other)
{
    const figure_panel *panels = d->fig->panels;
    return d->fig->shared_y || g_strcmp0(panels[one].y.name, panels[other].y.name) == 0;
}

// One vertical range for panels that share it: from the lowest to the highest end.
static void share_y_ranges(drawing *d)
{
    const int count = d->fig->panel_count;
    axis_scale own[FIGURE_PANELS];
    for (int i = 0; i < count; i++) {
        own[i] = d->panels[i].plane.y;
    }
    for (int i = 0; i < count; i++) {
        axis_scale *all = &d->panels[i].plane.y;
        for (int k = 0; k < count; k++) {
            if (share_range(d, i, k)) {
                all->low = fmin(all->low, own[k].low);
                all->high = fmax(all->high, own[k].high);
            }
        }
    }
}

// ---- columns

double figure_width(const figure *fig)
{
    if (fig->width > 0) {
        return fig->width;
    }
    return DEFAULT_WIDTH;
}

// As many columns as are asked for, as long as each is wide enough.
int figure_columns(const figure *fig)
{
    const int most = (int)(figure_width(fig) / COLUMN_WIDTH);
    int columns = 1;
    if (fig->columns > 0) {
        columns = fig->columns;
    }
    if (columns <= most || most < 1) {
        return columns;
    }

    // two and one would leave a gap
    if (most == 2 && columns == 3) {
        return 1;
    }
    return most;
}

// Space that a panel needs at its left for ticks, labels and the axis's title.
static double left_space(const drawing *d, const panel_layout *l)
{
    if (!has_y_labels(d, l)) {
        // as far from the column before as the ends of both axes' labels need
        return fmax(SHARED_SPACE, widest_tick(d, &d->x, d->style.tick) / 2 + LABEL_GAP);
    }

    // title, tick labels and ticks
    double left = axis_title_height(d, &l->y, y_title_room(l)) + LABEL_SPACE +
                  widest_tick(d, &l->y, d->style.tick) + TICK_SPACE + TICK_LENGTH;
    if (l->panel->impulse_count > 0 && l->panel->impulse_label != NULL) {
        g_autofree char *label = impulse_strip_label(d->fig, l->panel);
        left = fmax(left, width_of(d, label, d->style.small) + TICK_SPACE + TICK_LENGTH);
    }

    return left;
}

// Left and right ends of the panels, from the labels next to them: all panels have the
// same width.
static void place_columns(drawing *d)
{
    double left[FIGURE_PANELS] = {0}, right[FIGURE_PANELS], between = 0;

    // labels next to the panels of each column
    double last_label = widest_tick(d, &d->x, d->style.tick) / 2;
    for (int c = 0; c < d->columns; c++) {
        right[c] = fmax(RIGHT_SPACE, last_label);
    }

    for (int i = 0; i < d->fig->panel_count; i++) {
        const panel_layout *l = &d->panels[i];
        left[l->column] = fmax(left[l->column], left_space(d, l));
        right[l->column] = fmax(right[l->column], colour_bar_width(d, l));
    }

    for (int c = 0; c + 1 < d->columns; c++) {
        between += right[c] + left[c + 1];
    }

    // the ends of all, then of each; the outer ones are exact
    d->left = PAGE_MARGIN + left[0];
    d->right = d->page.width - PAGE_MARGIN - right[d->columns - 1];
    double width = (d->right - d->left - between) / d->columns, x = d->left;
    for (int c = 0; c < d->columns; c++) {
        d->column[c] = (column_layout){x - left[c], x, x + width};
        x += width + right[c];
        if (c + 1 < d->columns) {
            x += left[c + 1];
        }
    }
    d->column[0].edge = PAGE_MARGIN;
    d->column[d->columns - 1].right = d->right;

    // panels take those of their column
    for (int i = 0; i < d->fig->panel_count; i++) {
        panel_layout *l = &d->panels[i];
        const column_layout *c = &d->column[l->column];
        l->plane.box.x = c->left;
        l->plane.box.width = c->right - c->left;
        l->plane.x = d->x.scale;
    }
}

// ---- rows

double panel_weight(const figure_panel *panel)
{
    if (panel->weight > 0) {
        return panel->weight;
    }
    return 1;
}

// Space above a panel for what stands there [pt].
static double space_above(const panel_layout *l)
{
    double space = 0;
    if (l->legend_column) {
        space += l->legend.height + 2;
    } else if (l->panel->key_above) {
        space += fmax(LEGEND_ROW, l->legend.height + 2);
    } else if (l->legend_row) {
        space += LEGEND_ROW;
    }
    if (l->panel->heading != NULL) {
        space += HEADING_ROW;
    }
    if (l->panel->impulse_count > 0) {
        space += STRIP_HEIGHT + STRIP_SPACE;
    }
    return space;
}

// Space above a row of panels and its share of the height: the largest of its panels.
static void row_needs(const drawing *d, int row, double *above, double *weight)
{
    *above = *weight = 0;
    for (int i = row * d->columns; i < d->fig->panel_count && i < (row + 1) * d->columns;
         i++) {
        *above = fmax(*above, space_above(&d->panels[i]));
        *weight = fmax(*weight, panel_weight(&d->fig->panels[i]));
    }
}

// A text above or below the panels, as wide as they are or on a narrow page as the
// page.
static text_block frame_text(const drawing *d, const char *markup, double size,
                             double *left)
{
    double right = d->right;
    *left = d->left;
    if (d->page.width < NARROW_PAGE) {
        *left = PAGE_MARGIN;
        right = d->page.width - PAGE_MARGIN;
    }
    text_block t = figure_text_of(d, markup, size);
    t.width = right - *left;
    return t;
}

text_block frame_title(const drawing *d, double *left)
{
    char *title = NULL;
    if (d->fig->title != NULL && !d->fig->bare) {
        title = text_escape(d->fig->title);
    }
    text_block t = frame_text(d, title, d->style.title, left);
    t.bold = t.balanced = true;
    return t;
}

text_block frame_caption(const drawing *d, double *left)
{
    const char *caption = d->fig->caption;
    if (d->fig->bare) {
        caption = NULL;
    }
    return frame_text(d, caption, d->style.small, left);
}

// Places what stands above and below the panels; gives the ends of what is left.
static void place_texts(drawing *d, int mark_rows, double *top, double *bottom)
{
    double left, y = PAGE_MARGIN, end = d->page.height - PAGE_MARGIN;
    text_block title = frame_title(d, &left), caption = frame_caption(d, &left);

    // from the top: title, legend, labels of marks
    d->title_y = y;
    if (title.markup != NULL) {
        y += height_of(d, title) + 3;
    }
    g_free((char *)title.markup);
    d->scene_y = y;
    if (d->fig->scene != NULL) {
        y += d->fig->scene->height;
    }
    d->legend_y = y;
    double legend = common_legend(d, false);
    if (legend > 0) {
        y += legend + 2;
    }
    d->marks_bottom = y += MARK_ROW * mark_rows + 2;

    // from the bottom: caption, title of the axis, labels of its ticks
    if (caption.markup != NULL) {
        d->caption_y = end -= height_of(d, caption);
        end -= 3;
    }
    double line = height_of(d, figure_text_of(d, "0", d->style.tick));
    end -= height_of(d, figure_text_of(d, "X", d->style.label));
    d->x_label_y = end;
    end -= 1 + line + TICK_SPACE + TICK_LENGTH;
    *top = y;
    *bottom = end;
}

// Shares what height is left among the rows of panels, by weight.
static void place_rows(drawing *d, int mark_rows)
{
    double y, bottom, weights = 0, above, weight;
    place_texts(d, mark_rows, &y, &bottom);
    double free_height = bottom - y - PANEL_SPACE * (d->rows - 1);

    // what the rows need above them
    for (int row = 0; row < d->rows; row++) {
        row_needs(d, row, &above, &weight);
        free_height -= above;
        weights += weight;
    }

    // what is left, by weight
    for (int row = 0; row < d->rows; row++) {
        row_needs(d, row, &above, &weight);
        y += above;

        double height = free_height * weight / weights;
        for (int i = row * d->columns;
             i < d->fig->panel_count && i < (row + 1) * d->columns; i++) {
            panel_layout *l = &d->panels[i];
            l->strip_top = y - STRIP_HEIGHT - STRIP_SPACE;
            l->plane.box.y = y;
            l->plane.box.height = height;
        }
        y += height + PANEL_SPACE;
    }
}

// ---- equal axes

// Widens a scale about its middle to a length.
static void widen_to(axis_scale *s, double length)
{
    const double middle = (s->low + s->high) / 2;
    s->low = middle - length / 2;
    s->high = middle + length / 2;
}

// Widens one axis of each panel until a unit is as long on both. All panels have boxes of
// one width and one horizontal axis.
static void equal_units(drawing *d)
{
    double unit = HUGE_VAL; // [pt]
    for (int i = 0; i < d->fig->panel_count; i++) {
        const plane *p = &d->panels[i].plane;
        unit = fmin(unit, p->box.width / (d->x.scale.high - d->x.scale.low));
        unit = fmin(unit, p->box.height / (p->y.high - p->y.low));
    }
    widen_to(&d->x.scale, d->panels[0].plane.box.width / unit);
    for (int i = 0; i < d->fig->panel_count; i++) {
        plane *p = &d->panels[i].plane;
        widen_to(&p->y, p->box.height / unit);
        p->x = d->x.scale;
    }
}

// ---- inside the panels

typedef struct ink_sink {
    placement *grid;
    double x, y;
} ink_sink;

// Adds the strokes of a curve to the ink of a panel.
static void mark_ink(void *context, stroke_kind kind, double x, double y)
{
    ink_sink *s = context;
    if (kind == STROKE_LINE) {
        placement_line(s->grid, s->x, s->y, x, y, INK_CURVE);
    } else if (kind == STROKE_DOT) {
        placement_line(s->grid, x, y, x, y, INK_CURVE);
    }
    s->x = x;
    s->y = y;
}

// Fills every panel; returns whether a legend had to go out of its panel.
static bool fill_panels(drawing *d, placement *grid)
{
    bool moved = false;
    for (int i = 0; i < d->fig->panel_count; i++) {
        panel_layout *l = &d->panels[i];

        // where curves run
        ink_sink sink = {.grid = grid};
        memset(grid, 0, sizeof *grid);
        grid->box = l->plane.box;
        for (int k = 0; k < l->panel->series_count; k++) {
            curve_trace(&l->plane, &l->panel->series[k], mark_ink, &sink);
        }
        ink_of_marks(d, l, grid);

        for (int s = 0; s < l->panel->series_count; s++) {
            l->busy[s] = series_is_busy(&l->plane, &l->panel->series[s]);
        }

        // marks, inset and legend take the places that are left
        if (i == 0 && !place_pointed_marks(d, grid)) {
            moved = true;
        }
        if (i == 0 && d->marks_inside && !place_marks_inside(d, grid)) {
            d->marks_inside = false;
            moved = true;
        }
        place_inset(d, l, grid);
        const bool column = l->legend_column;
        const double height = l->legend.height;
        if (!place_legend(d, l, grid)) {
            l->legend_row = moved = true;
        }
        moved = moved || l->legend_column != column ||
                (l->panel->key_above && l->legend.height > height);
    }
    return moved;
}

// Whether two series, of any panels, ask for one pen.
static bool same_pen(const figure_series *a, const figure_series *b)
{
    return a->colour == b->colour && a->style == b->style && a->run == b->run &&
           a->secondary == b->secondary;
}

// A line that is busy in one panel is drawn so in all, so that it has one look.
static void share_busy_lines(drawing *d)
{
    for (int p = 0; p < d->fig->panel_count; p++) {
        const panel_layout *from = &d->panels[p];
        for (int q = 0; q < d->fig->panel_count; q++) {
            panel_layout *to = &d->panels[q];
            for (int i = 0; i < from->panel->series_count; i++) {
                for (int k = 0; k < to->panel->series_count; k++) {
                    to->busy[k] |= from->busy[i] && same_pen(&from->panel->series[i],
                                                             &to->panel->series[k]);
                }
            }
        }
    }
}

// ---- the whole

// Chooses the ticks of the vertical axes and of the colour scales.
static void choose_vertical_ticks(drawing *d)
{
    for (int i = 0; i < d->fig->panel_count; i++) {
        panel_layout *l = &d->panels[i];
        double height = l->plane.box.height, spacing = Y_TICK;
        if (l->plane.y.kind == SCALE_LOGARITHMIC) {
            spacing = DECADE_TICK;
        }
        l->y.scale = l->plane.y;
        axis_choose_ticks(&l->y, &l->panel->y, axis_tick_count(height, spacing, 2, 8));
        if (l->panel->colours != NULL) {
            axis_choose_ticks(&l->colours, &l->panel->colours->axis,
                              axis_tick_count(height, BAR_TICK, 2, 8));
        }
    }
}

// Places rows and columns and chooses ticks, each of which depends on the others.
static void place_all(drawing *d, int *mark_rows)
{
    // sides depend on heights through the ticks, and heights on sides through wrapped
    // texts
    for (int pass = 0; pass < 3; pass++) {
        place_rows(d, *mark_rows);
        choose_vertical_ticks(d);
        place_columns(d);
        if (d->fig->equal_axes) {
            equal_units(d);
            choose_vertical_ticks(d);
        }
        double width = d->column[0].right - d->column[0].left;
        axis_choose_ticks(&d->x, &d->fig->x, axis_tick_count(width, X_TICK, 2, 12));

        // labels of marks above the panels
        if (d->marks_inside) {
            *mark_rows = 0;
        } else {
            *mark_rows = place_marks(d);
        }
    }
}

// Fails if a panel is too small to be read.
static status check_room(const drawing *d, fault *f)
{
    const int panels = d->fig->panel_count;
    const char *plural = panels == 1 ? "" : "s";

    // one panel without room spoils the figure; the page's size is given in millimetres
    for (int i = 0; i < panels; i++) {
        const figure_rect *box = &d->panels[i].plane.box;
        FAULT_IF(!(box->width >= LEAST_WIDTH && box->height >= LEAST_HEIGHT), f,
                 STATUS_BAD_ARGUMENT,
                 "a figure of %.0f x %.0f mm has no room for its %d panel%s, expected a "
                 "larger page",
                 d->page.width / 72 * 25.4, d->page.height / 72 * 25.4, panels, plural);
    }
    return STATUS_OK;
}

// Ranges first, then places, until every legend has one.
status layout_figure(drawing *d, fault *f)
{
    const figure *fig = d->fig;
    int mark_rows = 0;
    g_autofree placement *grid = g_new(placement, 1);

    // rows and columns
    d->columns = figure_columns(fig);
    d->rows = (fig->panel_count + d->columns - 1) / d->columns;
    d->left = FIRST_LEFT;
    d->right = d->page.width - PAGE_MARGIN;
    d->marks_inside = d->columns == 1 && fig->mark_count > 0 && !fig->marks_above;

    // what the axes show
    d->x.from = &fig->x;
    TRY(choose_x_range(d, f));
    for (int i = 0; i < fig->panel_count; i++) {
        panel_layout *l = &d->panels[i];
        l->panel = &fig->panels[i];
        l->legend_row = l->panel->key_above;
        l->row = i / d->columns;
        l->column = i % d->columns;
        TRY(choose_y_range(d, l, f));
        if (l->panel->colours != NULL) {
            map_choose_scale(l);
        }
    }
    if (fig->shared_y || fig->common_scales) {
        share_y_ranges(d);
    }

    // legends that find no room inside move out and shrink the panels: again
    bool again = true;
    for (int pass = 0; pass < 5 && again; pass++) {
        place_all(d, &mark_rows);
        TRY(check_room(d, f));
        again = fill_panels(d, grid);
    }
    share_busy_lines(d);
    for (int i = 0; i < fig->panel_count; i++) {
        TRY(check_inset(d, &d->panels[i], f));
    }
    return STATUS_OK;
}
