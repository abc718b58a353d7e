#include "render/plot/plot_layout.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/plot/placement.h"

#define LEAST_WIDTH    50.0 // of a panel [pt]
#define LEAST_HEIGHT   16.0
#define RANGE_SPACE    0.06 // of the data's range, kept free above and below them
#define END_LABEL_LEAD 12.0 // from the axis' end to the labels at the curves' ends

text_block figure_text_of(const char *markup, double size)
{
    return (text_block){.markup = markup, .size = size};
}

// A unit with its factor, as markup that is never broken into lines.
static char *unit_markup(const char *unit, int exponent)
{
    char shown[64], factor[64] = "";
    bool has_unit = unit != NULL && unit[0] != '\0';
    const ticks scale = {.exponent = exponent};
    text_unit(has_unit ? unit : "", shown, sizeof shown);
    tick_factor(&scale, factor, sizeof factor);
    // before a unit the factor goes without its multiplication sign
    const char *power = has_unit && factor[0] ? factor + strlen("\u00d7") : factor;
    // Pango would break the line after a slash
    char **parts = g_strsplit(shown, "/", -1), *unbroken = g_strjoinv("\u2060/\u2060", parts);
    char *whole =
        g_strdup_printf("(%s%s%s)", power, has_unit && factor[0] ? "\u2009" : "", unbroken);
    g_strfreev(parts);
    g_free(unbroken);
    return whole;
}

char *axis_label(const char *label, const char *unit, int exponent)
{
    bool bare = (unit == NULL || unit[0] == '\0') && exponent == 0;
    if (bare) {
        return g_strdup(label ? label : "");
    }
    char *whole = unit_markup(unit, exponent);
    bool named = label != NULL && label[0] != '\0';
    char *both = g_strconcat(named ? label : "", named ? " " : "", whole, NULL);
    g_free(whole);
    return both;
}

int labelled_series(const figure_panel *panel)
{
    int count = 0;
    for (int i = 0; i < panel->series_count; i++) {
        count += panel->series[i].label != NULL;
    }
    return count;
}

bool has_end_labels(const figure_panel *panel)
{
    return panel->legend == LEGEND_ENDS && labelled_series(panel) > 0;
}

bool series_end(const drawing *d, const figure_series *s, double *y)
{
    for (size_t i = s->count; i > 0; i--) {
        double x = series_x(s, i - 1);
        *y = series_y(s, i - 1);
        if (x >= d->x_low && x <= d->x_high && isfinite(*y)) {
            return true;
        }
    }
    return false;
}

// ---- ranges
// ---------------------------------------------------------------------------------------

// Sets the edges, apart from one another and from the data.
static void widen(double *low, double *high, double space)
{
    if (!isfinite(*low) || !isfinite(*high)) {
        *low = 0;
        *high = 1;
    }
    double size = fmax(fabs(*low), fabs(*high));
    if (*high - *low <= 1e-9 * size || *high == *low) {
        double half = size > 0 ? 0.1 * size : 1;
        *low -= half;
        *high += half;
    }
    double range = *high - *low;
    *low -= space * range;
    *high += space * range;
}

static void choose_x_range(drawing *d)
{
    const figure *fig = d->fig;
    d->x_low = fig->x_low;
    d->x_high = fig->x_high;
    if (!(fig->x_low < fig->x_high)) {
        d->x_low = (double)INFINITY;
        d->x_high = -(double)INFINITY;
        for (int p = 0; p < fig->panel_count; p++) {
            for (int s = 0; s < fig->panels[p].series_count; s++) {
                series_x_range(&fig->panels[p].series[s], &d->x_low, &d->x_high);
            }
        }
        widen(&d->x_low, &d->x_high, 0);
    }
}

static void data_range(const figure_panel *panel, double x_low, double x_high, double *low,
                       double *high)
{
    *low = (double)INFINITY;
    *high = -(double)INFINITY;
    for (int s = 0; s < panel->series_count; s++) {
        series_y_range(&panel->series[s], x_low, x_high, low, high);
    }
}

static void choose_y_range(const drawing *d, panel_layout *l)
{
    const figure_panel *panel = l->panel;
    double low = panel->y_low, high = panel->y_high;
    if (!(low < high)) {
        data_range(panel, d->x_low, d->x_high, &low, &high);
        for (int i = 0; i < panel->level_count; i++) {
            if (isfinite(panel->levels[i].y)) {
                low = fmin(low, panel->levels[i].y);
                high = fmax(high, panel->levels[i].y);
            }
        }
        if (panel->with_zero && low <= high) {
            low = fmin(low, 0);
            high = fmax(high, 0);
        }
        widen(&low, &high, RANGE_SPACE);
    }
    l->plane.y_low = low;
    l->plane.y_high = high;
}

static int clamp(double value, int least, int most)
{
    return value < least ? least : value > most ? most : (int)value;
}

// ---- horizontally
// ---------------------------------------------------------------------------------

static double width_of(const drawing *d, const char *markup, double size)
{
    double width, height;
    text_block t = figure_text_of(markup, size);
    text_measure(d->context, &t, &width, &height);
    return width;
}

static double widest_tick(const drawing *d, const ticks *t, double size)
{
    double widest = 0;
    char label[TICK_TEXT];
    for (int i = 0; i < t->count; i++) {
        tick_label(t, i, label);
        widest = fmax(widest, width_of(d, label, size));
    }
    return widest;
}

static double y_label_height(const drawing *d, const panel_layout *l)
{
    double width, height;
    char *label = axis_label(l->panel->label, l->panel->unit, l->y_ticks.exponent);
    text_block t = {
        .markup = label, .size = LABEL_SIZE, .width = l->plane.box.height + PANEL_SPACE};
    text_measure(d->context, &t, &width, &height);
    bool none = label[0] == '\0';
    g_free(label);
    return none ? 0 : height;
}

static double widest_end_label(const drawing *d, const figure_panel *panel)
{
    double widest = 0;
    for (int i = 0; i < panel->series_count; i++) {
        if (panel->series[i].label != NULL) {
            widest = fmax(widest, width_of(d, panel->series[i].label, TICK_SIZE));
        }
    }
    return widest;
}

// Left and right end of the panels, from the labels beside them.
static void place_sides(drawing *d)
{
    double left = 0, right = 10;
    for (int i = 0; i < d->fig->panel_count; i++) {
        const panel_layout *l = &d->panels[i];
        left = fmax(left, y_label_height(d, l) + LABEL_SPACE +
                              widest_tick(d, &l->y_ticks, TICK_SIZE) + TICK_SPACE + TICK_LENGTH);
        if (l->panel->impulse_count > 0 && l->panel->impulse_label != NULL) {
            left = fmax(left, width_of(d, l->panel->impulse_label, SMALL_SIZE) + LABEL_SPACE);
        }
        if (has_end_labels(l->panel)) {
            right = fmax(right, widest_end_label(d, l->panel) + END_LABEL_LEAD + SWATCH_SPACE);
        }
    }
    right = fmax(right, widest_tick(d, &d->x_ticks, TICK_SIZE) / 2);
    d->left = PAGE_MARGIN + left;
    d->right = d->page.width - PAGE_MARGIN - right;
    for (int i = 0; i < d->fig->panel_count; i++) {
        plane *p = &d->panels[i].plane;
        p->box.x = d->left;
        p->box.width = d->right - d->left;
        p->x_low = d->x_low;
        p->x_high = d->x_high;
    }
}

// Labels of marks stand like flags at the right of their lines. Where one would meet the next flag
// or its line it goes a row higher, so that no line crosses a label. Returns the number of rows.
static int place_marks(drawing *d)
{
    int rows = 0, count = d->fig->mark_count < MARKS_LABELLED ? d->fig->mark_count : MARKS_LABELLED;
    double begins[MARKS_LABELLED], ends[MARKS_LABELLED];
    bool done[MARKS_LABELLED] = {false};
    for (int n = 0; n < count; n++) {
        // the rightmost that is left
        int next = -1;
        for (int i = 0; i < count; i++) {
            if (!done[i] && (next < 0 || d->fig->marks[i].x >= d->fig->marks[next].x)) {
                next = i;
            }
        }
        done[next] = true;
        const figure_mark *m = &d->fig->marks[next];
        d->mark_row[next] = -1;
        begins[next] = ends[next] = -1;
        if (m->label == NULL || !(m->x >= d->x_low && m->x <= d->x_high)) {
            continue;
        }
        double x = plane_x(&d->panels[0].plane, m->x), width = width_of(d, m->label, SMALL_SIZE);
        bool fits = x + 2 + width <= d->page.width - PAGE_MARGIN;
        begins[next] = fits ? x + 2 : x - 2 - width;
        ends[next] = begins[next] + width;
        int row = 0;
        for (int i = 0; i < count; i++) {
            if (i != next && done[i] && d->mark_row[i] >= row && ends[next] + 3 > begins[i] - 2 &&
                begins[next] < ends[i] + 3) {
                row = d->mark_row[i] + 1;
            }
        }
        d->mark_row[next] = row < MARK_ROWS ? row : -1;
        d->mark_text_x[next] = begins[next];
        rows = row < MARK_ROWS && row + 1 > rows ? row + 1 : rows;
    }
    return rows;
}

// ---- vertically
// -----------------------------------------------------------------------------------

static double height_of(const drawing *d, const char *markup, double size, bool bold, double width)
{
    double w, h;
    text_block t = {.markup = markup, .size = size, .bold = bold, .width = width};
    text_measure(d->context, &t, &w, &h);
    return h;
}

static double space_above(const panel_layout *l)
{
    return (l->legend_column ? l->legend.height + 2
            : l->legend_row  ? 11
                             : 0) +
           (l->panel->impulse_count > 0 ? STRIP_HEIGHT + STRIP_SPACE : 0);
}

// Returns what height is left for a panel of weight 1; negative if the page is too small.
static double place_rows(drawing *d, int mark_rows)
{
    const figure *fig = d->fig;
    double y = PAGE_MARGIN, bottom = d->page.height - PAGE_MARGIN, weights = 0;
    d->title_y = y;
    if (fig->title != NULL) {
        char *title = text_escape(fig->title);
        y += height_of(d, title, TITLE_SIZE, true, d->right - d->left) + 3;
        g_free(title);
    }
    d->marks_bottom = y += MARK_ROW * mark_rows + 2;
    if (fig->caption != NULL) {
        bottom -= height_of(d, fig->caption, SMALL_SIZE, false, d->right - d->left);
        d->caption_y = bottom;
        bottom -= 3;
    }
    double line = height_of(d, "0", TICK_SIZE, false, 0);
    bottom -= height_of(d, "X", LABEL_SIZE, false, 0);
    d->x_label_y = bottom;
    bottom -= 1 + line + TICK_SPACE + TICK_LENGTH;

    double free_height = bottom - y - PANEL_SPACE * (fig->panel_count - 1);
    for (int i = 0; i < fig->panel_count; i++) {
        free_height -= space_above(&d->panels[i]);
        weights += fig->panels[i].weight > 0 ? fig->panels[i].weight : 1;
    }
    for (int i = 0; i < fig->panel_count; i++) {
        panel_layout *l = &d->panels[i];
        y += space_above(l);
        l->strip_top = y - STRIP_HEIGHT - STRIP_SPACE;
        l->plane.box.y = y;
        l->plane.box.height = free_height * (l->panel->weight > 0 ? l->panel->weight : 1) / weights;
        y += l->plane.box.height + PANEL_SPACE;
    }
    return free_height / weights;
}

// ---- inside the panels
// ----------------------------------------------------------------------------

typedef struct ink_sink {
    placement *grid;
    double x, y;
} ink_sink;

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

bool level_label_above(const panel_layout *l, int index)
{
    return plane_y(&l->plane, l->panel->levels[index].y) - l->plane.box.y > 10;
}

static void collect_ink(const drawing *d, const panel_layout *l, placement *grid)
{
    ink_sink sink = {.grid = grid};
    const figure_rect *box = &l->plane.box;
    placement_init(grid, *box);
    for (int i = 0; i < l->panel->series_count; i++) {
        curve_trace(&l->plane, &l->panel->series[i], mark_ink, &sink);
    }
    for (int i = 0; i < l->panel->level_count; i++) {
        double y = plane_y(&l->plane, l->panel->levels[i].y);
        placement_line(grid, box->x, y, box->x + box->width, y, INK_CURVE);
        if (l->panel->levels[i].label != NULL) {
            double width = width_of(d, l->panel->levels[i].label, SMALL_SIZE) + 4;
            double above = level_label_above(l, i) ? 10 : 0;
            placement_block(grid, (figure_rect){box->x + box->width - width, y - above, width, 10},
                            INK_CURVE);
        }
    }
    for (int i = 0; i < d->fig->mark_count; i++) {
        double x = plane_x(&l->plane, d->fig->marks[i].x);
        if (x >= box->x && x <= box->x + box->width) {
            placement_line(grid, x, box->y, x, box->y + box->height, INK_FAINT);
        }
    }
}

// The inset's axes within its outer rectangle.
static void divide_inset(const drawing *d, panel_layout *l)
{
    const figure_panel *panel = l->panel;
    plane *p = &l->inset_plane;
    double line = height_of(d, "0", SMALL_SIZE, false, 0);
    p->x_low = panel->zoom_from;
    p->x_high = panel->zoom_to;
    data_range(panel, p->x_low, p->x_high, &p->y_low, &p->y_high);
    widen(&p->y_low, &p->y_high, 0.1);
    ticks_between(&l->inset_x_ticks, p->x_low, p->x_high, clamp(l->inset.width / 35, 2, 5));
    ticks_between(&l->inset_y_ticks, p->y_low, p->y_high, clamp(l->inset.height / 15, 2, 4));
    double left = widest_tick(d, &l->inset_y_ticks, SMALL_SIZE) + TICK_SPACE + 4;
    double right = widest_tick(d, &l->inset_x_ticks, SMALL_SIZE) / 2;
    p->box = (figure_rect){l->inset.x + left, l->inset.y + 3, l->inset.width - left - right,
                           l->inset.height - 3 - line - TICK_SPACE - 2};
}

static void place_inset(const drawing *d, panel_layout *l, placement *grid)
{
    static const double scales[] = {1, 0.85, 0.7};
    const figure_panel *panel = l->panel;
    const figure_rect *box = &l->plane.box;
    l->inset = (figure_rect){0};
    if (!(panel->zoom_from < panel->zoom_to)) {
        return;
    }
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

static void legend_size(const drawing *d, const figure_panel *panel, bool row, double *width,
                        double *height)
{
    *width = *height = 0;
    for (int i = 0; i < panel->series_count; i++) {
        if (panel->series[i].label == NULL) {
            continue;
        }
        double w, h;
        text_block t = figure_text_of(panel->series[i].label, TICK_SIZE);
        text_measure(d->context, &t, &w, &h);
        w += SWATCH + SWATCH_SPACE;
        if (row) {
            *width += w + (*width > 0 ? 2 * SWATCH_SPACE : 0);
            *height = fmax(*height, h);
        } else {
            *width = fmax(*width, w);
            *height += h;
        }
    }
}

// Returns false if there is no room inside the panel.
static bool place_legend(const drawing *d, panel_layout *l, const placement *grid)
{
    double width, height;
    l->legend = (figure_rect){0};
    l->legend_inside = false;
    if (l->panel->legend != LEGEND_AUTO || labelled_series(l->panel) < 2) {
        l->legend_row = l->legend_column = false;
        return true;
    }
    legend_size(d, l->panel, l->legend_row, &width, &height);
    // a row that is wider than the panel becomes a column
    if (l->legend_row && width > d->right - d->left) {
        l->legend_column = true;
        legend_size(d, l->panel, false, &width, &height);
    }
    if (l->legend_row) {
        l->legend = (figure_rect){d->right - width, l->plane.box.y - height - 1, width, height};
        if (l->panel->impulse_count > 0) {
            l->legend.y = l->strip_top - height;
        }
        return true;
    }
    l->legend_inside = true;
    return placement_find(grid, width, height, LEGEND_MARGIN, &l->legend) < INK_CURVE;
}

// Moves `count` ascending tops of labels apart by `height` each, as little as possible in the mean
// square: what is left of each after its rank's share must not descend, so descending neighbours
// are pooled at their mean.
static void spread(double *top, int count, double height, double highest, double lowest)
{
    double mean[PANEL_SERIES];
    int size[PANEL_SERIES], blocks = 0;
    for (int k = 0; k < count; k++) {
        mean[blocks] = top[k] - k * height;
        size[blocks++] = 1;
        for (; blocks > 1 && mean[blocks - 1] < mean[blocks - 2]; blocks--) {
            int both = size[blocks - 2] + size[blocks - 1];
            mean[blocks - 2] =
                (mean[blocks - 2] * size[blocks - 2] + mean[blocks - 1] * size[blocks - 1]) / both;
            size[blocks - 2] = both;
        }
    }
    for (int b = 0, k = 0; b < blocks; b++) {
        for (int i = 0; i < size[b]; i++, k++) {
            double limited = fmin(mean[b], lowest - (count - 1) * height);
            top[k] = fmax(limited, highest) + k * height;
        }
    }
}

// Spreads labels at the curves' ends so that none covers another.
static void place_end_labels(const drawing *d, panel_layout *l)
{
    int order[PANEL_SERIES], count = 0;
    double height = height_of(d, "X<sub>1</sub>", TICK_SIZE, false, 0), y, top[PANEL_SERIES];
    const figure_rect *box = &l->plane.box;
    for (int i = 0; i < l->panel->series_count; i++) {
        l->end_label_y[i] = (double)NAN;
        if (l->panel->series[i].label == NULL || !series_end(d, &l->panel->series[i], &y)) {
            continue;
        }
        l->end_label_y[i] = plane_y(&l->plane, y) - height / 2;
        // sorted from top to bottom, equal ones in their own order
        int k = count++;
        for (; k > 0 && l->end_label_y[order[k - 1]] > l->end_label_y[i]; k--) {
            order[k] = order[k - 1];
        }
        order[k] = i;
    }
    for (int k = 0; k < count; k++) {
        top[k] = l->end_label_y[order[k]];
    }
    spread(top, count, height, box->y - 3, box->y + box->height - height + 3);
    for (int k = 0; k < count; k++) {
        l->end_label_y[order[k]] = top[k];
    }
}

// Fills every panel; returns whether a legend had to go out of its panel.
static bool fill_panels(drawing *d, placement *grid)
{
    bool moved = false;
    for (int i = 0; i < d->fig->panel_count; i++) {
        panel_layout *l = &d->panels[i];
        collect_ink(d, l, grid);
        place_inset(d, l, grid);
        bool column = l->legend_column;
        if (!place_legend(d, l, grid)) {
            l->legend_row = moved = true;
        }
        moved = moved || l->legend_column != column;
        if (has_end_labels(l->panel)) {
            place_end_labels(d, l);
        }
    }
    return moved;
}

static void place_all(drawing *d, int *mark_rows)
{
    // sides depend on heights through the ticks, and heights on sides through wrapped texts
    for (int pass = 0; pass < 3; pass++) {
        place_rows(d, *mark_rows);
        for (int i = 0; i < d->fig->panel_count; i++) {
            panel_layout *l = &d->panels[i];
            ticks_between(&l->y_ticks, l->plane.y_low, l->plane.y_high,
                          clamp(l->plane.box.height / 20, 2, 8));
        }
        place_sides(d);
        ticks_between(&d->x_ticks, d->x_low, d->x_high, clamp((d->right - d->left) / 42, 2, 12));
        *mark_rows = place_marks(d);
    }
}

static status check_room(const drawing *d, fault *f)
{
    int panels = d->fig->panel_count;
    for (int i = 0; i < panels; i++) {
        const figure_rect *box = &d->panels[i].plane.box;
        if (!(box->width >= LEAST_WIDTH && box->height >= LEAST_HEIGHT)) {
            return fault_set(f, STATUS_BAD_ARGUMENT,
                             "a figure of %.0f x %.0f mm has no room for its %d panel%s, expected "
                             "a larger page",
                             d->page.width / 72 * 25.4, d->page.height / 72 * 25.4, panels,
                             panels == 1 ? "" : "s");
        }
    }
    return STATUS_OK;
}

status layout_figure(drawing *d, fault *f)
{
    const figure *fig = d->fig;
    int mark_rows = 0;
    placement *grid = malloc(sizeof *grid);
    if (grid == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "no memory for the layout of a figure");
    }
    choose_x_range(d);
    d->left = 40;
    d->right = d->page.width - PAGE_MARGIN;
    for (int i = 0; i < fig->panel_count; i++) {
        d->panels[i].panel = &fig->panels[i];
        choose_y_range(d, &d->panels[i]);
    }
    status code = STATUS_OK;
    bool again = true;
    for (int pass = 0; pass < 4 && again && code == STATUS_OK; pass++) {
        place_all(d, &mark_rows);
        code = check_room(d, f);
        again = code == STATUS_OK && fill_panels(d, grid);
    }
    free(grid);
    return code;
}
