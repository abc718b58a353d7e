// The panel of a sweep: its metric over its parameter, and its runs.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

enum { VALUE = 16, LEAST_CHART = 4 };
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
static double share_of(const lab_sweep *sweep, int index)
{
    const sweep_axis *axis = &sweep->axis;
    const double last = (double)axis->count - 1, value = axis->values[index];
    if (!axis->is_range || axis->high == axis->low) {
        if (last > 0) {
            return index / last;
        }
        return 0.5;
    }
    if (axis->logarithmic) {
        return log(value / axis->low) / log(axis->high / axis->low);
    }
    return (value - axis->low) / (axis->high - axis->low);
}

// A value of the axis in few cells: a real one as the metric is written.
static void format_value(const sweep_axis *axis, double value,
                         char text[SWEEP_VALUE_TEXT])
{
    sweep_axis_format(axis, value, text, SWEEP_VALUE_TEXT);
    if (sweep_axis_parameter(axis)->type == PARAMETER_REAL) {
        snprintf(text, SWEEP_VALUE_TEXT, "%s", draw_number(value).text);
    }
}

// The first and the last value below the chart.
static void draw_ends(screen *s, area a, const lab_sweep *sweep)
{
    char first[SWEEP_VALUE_TEXT], last[SWEEP_VALUE_TEXT];
    format_value(&sweep->axis, sweep->axis.values[0], first);
    format_value(&sweep->axis, sweep->axis.values[sweep->axis.count - 1], last);
    screen_words(s, a.x, a.y, a.width / 2, INK_DIM, first);
    const int length = text_cells(last) < a.width / 2 ? text_cells(last) : a.width / 2;
    screen_words(s, a.x + a.width - length, a.y, length, INK_DIM, last);
}

// The metric over the parameter, points joined, the selected one marked.
static void draw_chart(const explorer_model *model, screen *s, area a)
{
    const lab_sweep *sweep = &model->sweep;
    value_range range;
    if (!range_of_metric(sweep, &range)) {
        screen_text(s, a.x, a.y, a.width, INK_DIM, "no run has this number");
        return;
    }
    screen_print(s, a.x, a.y, LABEL_WIDTH, INK_DIM, "%8s", draw_number(range.high).text);
    screen_print(s, a.x, a.y + a.height - 2, LABEL_WIDTH, INK_DIM, "%8s",
                 draw_number(range.low).text);

    // from point to point, but words are no numbers; the selected one over all others
    const parameter_info *varied = sweep_axis_parameter(&sweep->axis);
    const bool joined =
        varied->type == PARAMETER_REAL || varied->type == PARAMETER_INTEGER;
    const canvas c = {s, a.x + LABEL_WIDTH, a.y, a.width - LABEL_WIDTH, a.height - 1};
    draw_ends(s, (area){c.x, a.y + c.height, c.width, 1}, sweep);
    double x0 = (double)NAN, y0 = (double)NAN;
    for (int i = 0; i <= sweep->count && sweep->selected < sweep->count; i++) {
        const bool last = i == sweep->count;
        const int run = last ? sweep->selected : i;
        const double value = lab_sweep_metric(sweep, run, sweep->metric);
        const double x = share_of(sweep, run) * (2.0 * c.width - 1);
        const double y =
            (range.high - value) / (range.high - range.low) * (4.0 * c.height - 1);
        if (joined && !last) {
            canvas_line(&c, x0, y0, x, y, INK_SERIES_0);
        } else if (isfinite(y)) {
            screen_put(s, c.x + (int)(x / 2), c.y + (int)(y / 4), last ? 0x25cf : 0x25cb,
                       last ? INK_EVENT : INK_SERIES_0);
        }
        x0 = x;
        y0 = y;
    }
}

// The runs: value and metric, from the one on that lets the selected one be seen.
static void draw_runs(const explorer_model *model, layout *lay, screen *s, area a)
{
    const lab_sweep *sweep = &model->sweep;
    const int first = draw_first_line(sweep->selected, sweep->count, a.height);
    layout_add_hit(lay, (hit_area){PANEL_SWEEP, PART_LINES, first, a});

    // a line for each run
    for (int i = first; i < sweep->count && i - first < a.height; i++) {
        const swept_run *r = &sweep->runs[i];
        const int y = a.y + i - first;
        char value[SWEEP_VALUE_TEXT];
        format_value(&sweep->axis, r->value, value);

        // a run that stopped says so in the unit's place
        screen_words(s, a.x, y, VALUE - 1, INK_TITLE, value);
        screen_print(s, a.x + VALUE, y, a.width - VALUE, INK_TEXT, "%10s %s",
                     draw_number(lab_sweep_metric(sweep, i, sweep->metric)).text,
                     r->run.summary.status == STATUS_OK
                         ? summary_table[sweep->metric].unit
                         : "stopped");
        if (i == sweep->selected) {
            screen_tint(s, a.x - 1, y, a.width + 2, 1, INK_SELECTED);
        }
    }
}

// --- a map -----------------------------------------------------------------------------

// A cell of a map: the darker, the larger its metric.
static void draw_cell(screen *s, area a, double share, bool selected)
{
    static const uint32_t shades[] = {' ', 0x2591, 0x2592, 0x2593, 0x2588};
    enum { SHADES = sizeof shades / sizeof shades[0] };
    const int shade = (int)(share * SHADES);
    for (int i = 0; i < a.width * a.height; i++) {
        screen_put(s, a.x + i % a.width, a.y + i / a.width,
                   isfinite(share) ? shades[shade < SHADES ? shade : SHADES - 1] : '-',
                   INK_SERIES_0);
    }
    if (selected) {
        screen_tint(s, a.x, a.y, a.width, a.height, INK_SELECTED);
    }
}

// A line of both parameters: the selected values or, of an axis, from where to where it
// goes.
static void draw_values(screen *s, area a, const lab_sweep *sweep, bool ends)
{
    const sweep_axis *axes[] = {&sweep->axis, &sweep->second};
    double values[2];
    lab_sweep_values(sweep, sweep->selected, values);
    for (int i = 0, x = a.x; i < 2; i++) {
        char from[SWEEP_VALUE_TEXT], to[SWEEP_VALUE_TEXT] = "";
        format_value(axes[i], ends ? axes[i]->values[0] : values[i], from);
        if (ends) {
            format_value(axes[i], axes[i]->values[axes[i]->count - 1], to);
        }
        const char *name =
            ends ? "" : strrchr(sweep_axis_parameter(axes[i])->path, '.') + 1;
        const char *between = "";
        if (i != 0) {
            if (ends) {
                between = ", up ";
            } else {
                between = ", ";
            }
        }
        x += screen_print(s, x, a.y, a.x + a.width - x, ends ? INK_DIM : INK_TITLE,
                          "%s%s%s%s%s%s", between, name, ends ? "" : " ", from,
                          ends ? " to " : "", to);
    }
}

// The first parameter across, the second up; below it the axes and the selected cell.
static void draw_map(const explorer_model *model, layout *lay, screen *s, area a)
{
    enum { BELOW = 4, TALL = 3 };
    const lab_sweep *sweep = &model->sweep;
    const int across = (int)sweep->axis.count, up = (int)sweep->second.count;
    const int wide = a.width / across, most = (a.height - BELOW) / up,
              tall = most < TALL ? most : TALL;
    value_range range;
    if (wide < 1 || tall < 1) {
        screen_print(s, a.x, a.y, a.width, INK_DIM, "a map of %d x %d has no room here",
                     across, up);
    } else if (range_of_metric(sweep, &range)) {
        layout_add_hit(lay, (hit_area){PANEL_SWEEP,
                                       PART_CELLS,
                                       tall,
                                       {a.x, a.y, across * wide, up * tall}});
        for (int i = 0; i < sweep->count; i++) {
            const double value = lab_sweep_metric(sweep, i, sweep->metric);
            const area place = {a.x + i % across * wide,
                                a.y + (up - 1 - i / across) * tall, wide, tall};
            draw_cell(s, place, (value - range.low) / (range.high - range.low),
                      i == sweep->selected);
        }
        screen_print(s, a.x, a.y + a.height - 3, a.width, INK_DIM, "blank %s, dark %s",
                     draw_number(range.low).text, draw_number(range.high).text);
    } else {
        screen_text(s, a.x, a.y, a.width, INK_DIM, "no run has this number");
    }
    draw_values(s, (area){a.x, a.y + a.height - 4, a.width, 1}, sweep, true);
    draw_values(s, (area){a.x, a.y + a.height - 2, a.width, 1}, sweep, false);
    if (sweep->selected < sweep->count) {
        screen_print(
            s, a.x, a.y + a.height - 1, a.width, INK_TEXT, "%s %s",
            draw_number(lab_sweep_metric(sweep, sweep->selected, sweep->metric)).text,
            summary_table[sweep->metric].unit);
    }
}

// What is varied and how many runs there are: the last part of the path where the whole
// has no room, and of that what `most` cells have room for.
static void write_title(char *title, size_t size, const lab_sweep *sweep, int most)
{
    char count[64];
    const char *path = parameter_table[sweep->axis.parameter].path;
    const char *last = strrchr(path, '.') + 1;
    const int room = most - snprintf(count, sizeof count, ", %d of %d", sweep->count,
                                     lab_sweep_total(sweep));

    if ((int)(strlen("sweep ") + strlen(path)) <= room) {
        snprintf(title, size, "sweep %s%s", path, count);
    } else if ((int)strlen(last) <= room) {
        snprintf(title, size, "%s%s", last, count);
    } else {
        snprintf(title, size, "%.*s..%s", room > 2 ? room - 2 : 0, last, count);
    }
}

static void draw(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area a)
{
    (void)view;
    const lab_sweep *sweep = &model->sweep;
    char title[LINE_TEXT];
    if (!lab_sweep_is_on(sweep)) {
        screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME,
                     "no sweep (:sweep begins one)");
        return;
    }
    write_title(title, sizeof title, sweep, a.width - FRAME_OF_TITLE);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);
    screen_print(s, a.x + 2, a.y + 1, a.width - 4, INK_DIM, "%s (M: next)",
                 summary_table[sweep->metric].label);

    if (lab_sweep_is_map(sweep)) {
        draw_map(model, lay, s, (area){a.x + 2, a.y + 2, a.width - 4, a.height - 3});
        return;
    }

    // the chart, if there is room for it and a few runs
    const int inner = a.height - 3, chart = inner / 2 >= LEAST_CHART ? inner / 2 : 0;
    if (chart > 0 && sweep->count > 0) {
        draw_chart(model, s, (area){a.x + 2, a.y + 2, a.width - 4, chart});
    }
    if (inner - chart > 0) {
        draw_runs(model, lay, s,
                  (area){a.x + 2, a.y + 2 + chart, a.width - 4, inner - chart});
    }
}

// A click selects a run, the wheel goes through them.
static bool point(explorer_model *model, explorer_view *view, explorer_input *input,
                  const panel_gesture *g)
{
    (void)input;
    (void)view;
    const area a = g->hit.area;
    const int wheel = pointer_wheel(g->event), across = (int)model->sweep.axis.count;
    const bool pressed = g->event.kind == POINTER_PRESS;
    int to = model->sweep.selected + wheel;
    if (pressed && g->hit.part == PART_CELLS) {
        to = (a.y + a.height - 1 - g->event.y) / g->hit.index * across +
             (g->event.x - a.x) / (a.width / across);
    } else if (pressed) {
        to = g->hit.index + g->event.y - a.y;
    }
    if (pressed || wheel != 0) {
        act_select_swept(model, to - model->sweep.selected);
    }
    return pressed || wheel != 0;
}

const panel sweep_panel = {.name = "sweep", .draw = draw, .point = point};
