// The panel of a sweep: its metric over its parameter, and its runs.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

enum { VALUE_COLUMN = 16 };  // its width [cells]
enum { LEAST_CHART = 4 };    // rows
enum { FRAME_OF_TITLE = 6 }; // corners, lines and blanks next to it [cells]

// The least and the largest number among the runs; false without any.
static bool range_of_metric(const lab_sweep *sweep, value_range *range)
{
    value_range found = value_range_empty;
    for (int i = 0; i < sweep->count; i++) {
        value_range_add(&found, lab_sweep_metric(sweep, i, sweep->metric));
    }
    *range = value_range_opened(found);
    return found.high >= found.low;
}

// Where the value of a run lies on the axis, 0 to 1: values of a list stand side by side.
static double share_along(const sweep_axis *axis, size_t index)
{
    const double value = sweep_axis_value(axis, (size_t)index);
    if (axis->is_range && axis->high != axis->low) {
        if (axis->logarithmic) {
            return log(value / axis->low) / log(axis->high / axis->low);
        }
        return (value - axis->low) / (axis->high - axis->low);
    }
    if (axis->count > 1) {
        return (double)index / (double)(axis->count - 1);
    }
    return 0.5;
}

// A value of the axis in few cells: a real one as the metric is written.
static void format_axis_value(const sweep_axis *axis, double value,
                              char text[SWEEP_VALUE_TEXT])
{
    if (sweep_axis_parameter(axis)->type == PARAMETER_REAL) {
        snprintf(text, SWEEP_VALUE_TEXT, "%s", draw_number(value).text);
    } else {
        sweep_axis_format(axis, value, text, SWEEP_VALUE_TEXT);
    }
}

// The first and the last value below the chart.
static void draw_axis_ends(screen *s, area a, const sweep_axis *axis)
{
    char first[SWEEP_VALUE_TEXT], last[SWEEP_VALUE_TEXT];
    const int half = a.width / 2;
    format_axis_value(axis, sweep_axis_value(axis, 0), first);
    format_axis_value(axis, sweep_axis_value(axis, axis->count - 1), last);
    screen_words(s, a.x, a.y, half, INK_DIM, first);
    int length = text_cells(last);
    if (length > half) {
        length = half;
    }
    area_words(s, area_right(a, a.width - length), INK_DIM, last);
}

// The place of a run on the chart [dots].
typedef struct chart_point {
    double x, y;
} chart_point;

// Where the metric of a run lies.
static chart_point point_on_chart(const lab_sweep *sweep, const canvas *c,
                                  value_range range, int run)
{
    const double value = lab_sweep_metric(sweep, run, sweep->metric);
    const double share_down = (range.high - value) / (range.high - range.low);
    return (chart_point){.x = share_along(&sweep->axis, (size_t)run) *
                              (2.0 * c->width - 1),
                         .y = share_down * (4.0 * c->height - 1)};
}

// A sign in the cell of a point, none for a run that has no such number.
static void mark_on_chart(screen *s, const canvas *c, chart_point at, uint32_t glyph,
                          ink shade)
{
    if (isfinite(at.y)) {
        screen_put(s, c->x + (int)(at.x / 2), c->y + (int)(at.y / 4), glyph, shade);
    }
}

// The metric over the parameter, points joined, the selected one marked.
static void draw_chart(const explorer_model *model, screen *s, area a)
{
    const lab_sweep *sweep = &model->sweep;
    value_range range;
    if (!range_of_metric(sweep, &range)) {
        area_text(s, a, INK_DIM, "no run has this number");
        return;
    }

    // the axes
    const int lowest = a.height - 2;
    const canvas c = {s, a.x + LABEL_WIDTH, a.y, a.width - LABEL_WIDTH, a.height - 1};
    screen_print(s, a.x, a.y, LABEL_WIDTH, INK_DIM, "%8s", draw_number(range.high).text);
    screen_print(s, a.x, a.y + lowest, LABEL_WIDTH, INK_DIM, "%8s",
                 draw_number(range.low).text);
    draw_axis_ends(s, area_right(area_row(a, c.height), LABEL_WIDTH), &sweep->axis);
    if (sweep->selected >= sweep->count) {
        return;
    }

    // from point to point, but words are no numbers; the selected one over all others
    const parameter_type type = sweep_axis_parameter(&sweep->axis)->type;
    const bool joined = type == PARAMETER_REAL || type == PARAMETER_INTEGER;
    chart_point before = {(double)NAN, (double)NAN};
    for (int i = 0; i < sweep->count; i++) {
        const chart_point at = point_on_chart(sweep, &c, range, i);
        if (joined) {
            canvas_line(&c, before.x, before.y, at.x, at.y, INK_SERIES_0);
        } else {
            mark_on_chart(s, &c, at, GLYPH_CIRCLE, INK_SERIES_0);
        }
        before = at;
    }
    const chart_point selected = point_on_chart(sweep, &c, range, sweep->selected);
    mark_on_chart(s, &c, selected, GLYPH_DISC, INK_EVENT);
}

// The runs: value and metric, from the one on that lets the selected one be seen.
static void draw_swept_runs(const explorer_model *model, layout *lay, screen *s, area a)
{
    const lab_sweep *sweep = &model->sweep;
    const int first = draw_first_line(sweep->selected, sweep->count, a.height);
    layout_add_hit(lay, (hit_area){PANEL_SWEEP, PART_LINES, first, a});

    for (int i = first; i < sweep->count && i - first < a.height; i++) {
        const swept_run *r = &sweep->runs[i];
        const area line = area_row(a, i - first);
        char value[SWEEP_VALUE_TEXT];

        // a run that stopped says so in the unit's place
        const char *unit = summary_table[sweep->metric].unit;
        if (r->run.summary.status != STATUS_OK) {
            unit = "stopped";
        }
        format_axis_value(&sweep->axis, r->value, value);
        screen_words(s, line.x, line.y, VALUE_COLUMN - 1, INK_TITLE, value);
        area_print(s, area_right(line, VALUE_COLUMN), INK_TEXT, "%10s %s",
                   draw_number(lab_sweep_metric(sweep, i, sweep->metric)).text, unit);
        if (i == sweep->selected) {
            area_tint(s, (area){a.x - 1, line.y, a.width + 2, 1}, INK_SELECTED);
        }
    }
}

// --- a map -----------------------------------------------------------------------------

// A cell of a map: the darker, the larger its metric, of which a share of the range is
// given.
static void draw_map_cell(screen *s, area a, double share, bool selected)
{
    static const uint32_t shades[] = {' ', GLYPH_LIGHT_SHADE, GLYPH_SHADE,
                                      GLYPH_DARK_SHADE, GLYPH_BLOCK};
    enum { SHADES = sizeof shades / sizeof shades[0] };
    uint32_t glyph = '-'; // no number
    if (isfinite(share)) {
        const int shade = (int)(share * SHADES);
        glyph = shades[shade < SHADES ? shade : SHADES - 1];
    }
    for (int y = a.y; y < a.y + a.height; y++) {
        for (int x = a.x; x < a.x + a.width; x++) {
            screen_put(s, x, y, glyph, INK_SERIES_0);
        }
    }
    if (selected) {
        area_tint(s, a, INK_SELECTED);
    }
}

// From where to where both parameters go.
static void draw_map_axes(screen *s, area line, const lab_sweep *sweep)
{
    const sweep_axis *axes[] = {&sweep->axis, &sweep->second};
    for (int i = 0; i < 2; i++) {
        char from[SWEEP_VALUE_TEXT], to[SWEEP_VALUE_TEXT];
        format_axis_value(axes[i], sweep_axis_value(axes[i], 0), from);
        format_axis_value(axes[i], sweep_axis_value(axes[i], axes[i]->count - 1), to);
        const char *name = strrchr(sweep_axis_parameter(axes[i])->path, '.') + 1;
        const int used = area_print(s, line, INK_DIM, "%s%s %s to %s",
                                    i == 0 ? "" : ", up ", name, from, to);
        line = area_right(line, used);
    }
}

// The values of both parameters in the selected run.
static void draw_map_selection(screen *s, area line, const lab_sweep *sweep)
{
    const sweep_axis *axes[] = {&sweep->axis, &sweep->second};
    double values[2];
    lab_sweep_values(sweep, sweep->selected, values);
    for (int i = 0; i < 2; i++) {
        char value[SWEEP_VALUE_TEXT];
        const char *name = strrchr(sweep_axis_parameter(axes[i])->path, '.') + 1;
        format_axis_value(axes[i], values[i], value);
        const int used =
            area_print(s, line, INK_TITLE, "%s%s %s", i == 0 ? "" : ", ", name, value);
        line = area_right(line, used);
    }
}

// The first line of a map's cells, counted from above, that is shown where there is room
// for so many: the one that lets the selected run be seen.
static int first_map_line(const lab_sweep *sweep, int shown)
{
    const int across = (int)sweep->axis.count, up = (int)sweep->second.count;
    return draw_first_line(up - 1 - sweep->selected / across, up, shown);
}

// As many lines of a map's cells as there are or as an area has room for, `width` x
// `height` characters each, the first parameter across and the second up.
static void draw_map_cells(const lab_sweep *sweep, layout *lay, screen *s, area a,
                           int width, int height, value_range range)
{
    const int across = (int)sweep->axis.count, up = (int)sweep->second.count;
    const int shown = a.height / height < up ? a.height / height : up;
    const int first = first_map_line(sweep, shown);
    const area map = {a.x, a.y, across * width, shown * height};
    layout_add_hit(lay, (hit_area){PANEL_SWEEP, PART_CELLS, height, map});
    for (int i = 0; i < sweep->count; i++) {
        const int column = i % across, row = up - 1 - i / across - first;
        if (row < 0 || row >= shown) {
            continue;
        }
        const area place = {a.x + column * width, a.y + row * height, width, height};
        const double value = lab_sweep_metric(sweep, i, sweep->metric);
        const double share = (value - range.low) / (range.high - range.low);
        draw_map_cell(s, place, share, i == sweep->selected);
    }
}

// The map, and in the last rows the axes, the shades and the selected cell.
static void draw_sweep_map(const explorer_model *model, layout *lay, screen *s, area a)
{
    enum { WORDS = 4, MOST_CELL_HEIGHT = 3 }; // rows
    const lab_sweep *sweep = &model->sweep;
    const int across = (int)sweep->axis.count, up = (int)sweep->second.count;
    const area words = area_below(a, a.height - WORDS);
    const area map = {a.x, a.y, a.width, a.height - WORDS};
    const int width = a.width / across;
    int height = map.height / up;
    if (height > MOST_CELL_HEIGHT) {
        height = MOST_CELL_HEIGHT;
    } else if (height < 1) {
        height = 1;
    }

    value_range range;
    if (width < 1 || map.height < 1) {
        area_print(s, a, INK_DIM, "%d columns have no room", across);
    } else if (range_of_metric(sweep, &range)) {
        draw_map_cells(sweep, lay, s, map, width, height, range);
        area_print(s, area_row(words, 1), INK_DIM, "blank %s, dark %s",
                   draw_number(range.low).text, draw_number(range.high).text);
    } else {
        area_text(s, a, INK_DIM, "no run has this number");
    }
    draw_map_axes(s, area_row(words, 0), sweep);
    draw_map_selection(s, area_row(words, 2), sweep);
    if (sweep->selected < sweep->count) {
        const double value = lab_sweep_metric(sweep, sweep->selected, sweep->metric);
        area_print(s, area_row(words, 3), INK_TEXT, "%s %s", draw_number(value).text,
                   summary_table[sweep->metric].unit);
    }
}

// What is varied and how many runs there are: the last part of the path where the whole
// has no room, and of that what `most` cells have room for.
static void write_sweep_title(char *title, size_t size, const lab_sweep *sweep, int most)
{
    char count[64];
    const char *path = parameter_table[sweep->axis.parameter].path;
    const char *last = strrchr(path, '.') + 1;
    snprintf(count, sizeof count, ", %d of %d", sweep->count, lab_sweep_total(sweep));
    const int room = most - (int)strlen(count);
    if ((int)(strlen("sweep ") + strlen(path)) <= room) {
        snprintf(title, size, "sweep %s%s", path, count);
    } else if ((int)strlen(last) <= room) {
        snprintf(title, size, "%s%s", last, count);
    } else {
        const int bytes = room > 2 ? room - 2 : 0;
        snprintf(title, size, "%.*s..%s", bytes, last, count);
    }
}

// The metric of the sweep: as a map of two parameters, or as a chart over one with the
// runs below it.
static void draw_sweep(const explorer_model *model, const explorer_view *view,
                       layout *lay, screen *s, area a)
{
    (void)view;
    const lab_sweep *sweep = &model->sweep;
    char title[LINE_TEXT];
    if (!lab_sweep_is_on(sweep)) {
        area_frame(s, a, INK_FRAME, "no sweep (:sweep begins one)");
        return;
    }
    write_sweep_title(title, sizeof title, sweep, a.width - FRAME_OF_TITLE);
    area_frame(s, a, INK_FRAME, title);

    // the metric, then what it comes to
    const area inside = area_inside(a), below = area_below(inside, 1);
    area_print(s, inside, INK_DIM, "%s (:metric)", summary_table[sweep->metric].label);
    if (lab_sweep_is_map(sweep)) {
        draw_sweep_map(model, lay, s, below);
        return;
    }

    // the chart in the upper half, if there is room for it and a few runs
    int chart_height = below.height / 2;
    if (chart_height < LEAST_CHART) {
        chart_height = 0;
    }
    if (chart_height > 0 && sweep->count > 0) {
        draw_chart(model, s, (area){below.x, below.y, below.width, chart_height});
    }
    if (below.height > chart_height) {
        draw_swept_runs(model, lay, s, area_below(below, chart_height));
    }
}

// The run whose cell in the map was pressed; `index` of the part is a cell's height. -1
// where another sweep, or none, has taken its place since it was drawn.
static int run_in_map(const lab_sweep *sweep, const panel_gesture *g)
{
    const area a = g->hit.area;
    const int across = (int)sweep->axis.count, lowest = a.y + a.height - 1;
    if (!lab_sweep_is_map(sweep) || a.width < across) {
        return -1;
    }
    const int shown = a.height / g->hit.index, up = (int)sweep->second.count;
    const int below = up - first_map_line(sweep, shown) - shown;
    const int column = (g->event.x - a.x) / (a.width / across);
    const int row = (lowest - g->event.y) / g->hit.index;
    return (row + below) * across + column;
}

// A click selects a run, the wheel goes through them.
static bool point_at_sweep(explorer_model *model, explorer_view *view,
                           explorer_input *input, const panel_gesture *g)
{
    (void)input;
    (void)view;
    const int selected = model->sweep.selected, wheel = pointer_wheel(g->event);
    if (wheel != 0) {
        act_select_swept(model, wheel);
        return true;
    }
    if (g->event.kind != POINTER_PRESS) {
        return false;
    }
    int to = gesture_line(g);
    if (g->hit.part == PART_CELLS) {
        to = run_in_map(&model->sweep, g);
    }
    act_select_swept(model, to - selected);
    return true;
}

const panel sweep_panel = {.name = "sweep", .draw = draw_sweep, .point = point_at_sweep};
