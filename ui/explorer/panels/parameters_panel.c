// The panel of parameters: their values at the cursor, and sliders of those that are
// numbers.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

enum {
    LEAST_VALUE = 12, // cells for a value before its name is cut
    PATH_ROOM = 37,   // cells for path and value of a line that has a slider
    KNOB_ROOM = 23,   // the same of a knob
    LEAST_SLIDER = 5, // cells of it
    MOST_SLIDER = 24
};

// A slider that is drawn.
typedef struct track {
    int parameter;
    slider_scale scale;
    double value; // at the cursor, or the one that the mouse is about to give
    ink knob;
} track;

// Fills in scale and value of the slider of track's parameter; false if it has none.
static bool find_track(const explorer_view *view, const parameters *p, track *k)
{
    const slider_grip *grip = &view->slider;
    const bool held = grip->held && grip->parameter == k->parameter;
    if (held) {
        k->value = grip->value;
    } else {
        k->value = parameter_get(p, k->parameter);
    }
    const bool found = slider_scale_of(k->parameter, k->value, &k->scale);
    if (held) {
        k->scale = grip->scale;
    }
    return found;
}

// A slider: its line, and the knob where the value is.
static void draw_track(layout *lay, screen *s, area a, const track *k)
{
    for (int i = 0; i < a.width; i++) {
        screen_put(s, a.x + i, a.y, GLYPH_LINE, INK_FRAME);
    }
    const long at = lround(slider_share(&k->scale, k->value) * (a.width - 1));
    if (at >= 0 && at < a.width) {
        screen_put(s, a.x + (int)at, a.y, GLYPH_DISC, k->knob);
    }
    layout_add_hit(lay, (hit_area){PANEL_PARAMETERS, PART_SLIDER, k->parameter, a});
}

// Value and unit as far as `most` cells have room for them: where they have not, the unit
// goes, then the value's end, which two points stand for. Returns the cells it takes.
static int fit_value(char *shown, size_t size, int most, const char *value,
                     const char *unit)
{
    if (most < LEAST_VALUE) {
        most = LEAST_VALUE;
    }
    snprintf(shown, size, "%s", value);
    if (unit[0] != '\0') {
        text_add(shown, size, " %s", unit);
    }
    if (text_cells(shown) > most) {
        snprintf(shown, size, "%s", value);
    }

    // cut between characters, not within one
    if (text_cells(shown) > most) {
        const char *end = value;
        for (int cells = 0; cells < most - 2; cells++) {
            glyph_decode(&end);
        }
        snprintf(shown, size, "%.*s..", (int)(end - value), value);
    }
    return text_cells(shown);
}

// The slider's place at the end of a line, of no width where there is no room for it.
static area slider_area(area line, bool is_knob)
{
    int width = line.width - (is_knob ? KNOB_ROOM : PATH_ROOM);
    if (width < LEAST_SLIDER) {
        width = 0;
    }
    if (width > MOST_SLIDER) {
        width = MOST_SLIDER;
    }
    return (area){line.x + line.width - width, line.y, width, 1};
}

// How the value of a parameter looks: one that has no effect dim, one that can be changed
// while the arm moves bright.
static ink value_ink(const explorer_view *view, int parameter, bool inert)
{
    if (inert) {
        return INK_FRAME;
    }
    if (view->slider.held && view->slider.parameter == parameter) {
        return INK_EVENT;
    }
    if (parameter_table[parameter].timed) {
        return INK_ARM;
    }
    return INK_DIM;
}

// How its name looks: one that the scenario gives stands out.
static ink name_ink(const explorer_model *model, int parameter, bool inert)
{
    if (inert) {
        return INK_FRAME;
    }
    if (model->session.effective.parameters.set[parameter] != 0) {
        return INK_TITLE;
    }
    return INK_TEXT;
}

// Whether the knobs are shown, and not all parameters.
static bool shows_knobs(const explorer_view *view)
{
    return parameter_list_is_brief(&view->parameters,
                                   view->filters.text[PANEL_PARAMETERS]);
}

// The name of a parameter in so many cells: without its group, which the heading has; of
// a knob with it where that has room.
static const char *name_in_list(int parameter, bool is_knob, int room)
{
    const char *path = parameter_table[parameter].path;
    if (is_knob && (int)strlen(path) <= room) {
        return path;
    }
    return strchr(path, '.') + 1;
}

// Name, value and unit in a line, with a slider behind them where there is room.
static void draw_parameter(const explorer_model *model, const explorer_view *view,
                           layout *lay, screen *s, area a, const parameters *p,
                           int parameter)
{
    const parameter_info *info = &parameter_table[parameter];
    const bool inert = model_inert_reason(model, parameter) != NULL;
    const bool held = view->slider.held && view->slider.parameter == parameter;
    track k = {.parameter = parameter, .knob = value_ink(view, parameter, inert)};
    const bool has_slider = find_track(view, p, &k);
    layout_add_hit(lay, (hit_area){PANEL_PARAMETERS, PART_LINES, parameter, a});

    // a slider, and what it leaves
    const bool is_knob = shows_knobs(view);
    const area slider = slider_area(a, is_knob);
    if (has_slider && slider.width > 0 && !inert) {
        draw_track(lay, s, slider, &k);
    }

    // a number as it would be typed
    char value[PARAMETER_VALUE_SIZE], shown[PARAMETER_VALUE_SIZE + 32];
    if (info->type == PARAMETER_REAL || held) {
        snprintf(value, sizeof value, "%.6g", k.value);
    } else {
        parameter_format(p, parameter, value, sizeof value);
    }

    // it ends where sliders begin, but a long one without a slider where the line ends
    const char *leaf = strchr(info->path, '.') + 1;
    int room = a.width;
    if (slider.width > 0) {
        room -= slider.width + 1;
    }
    if (!has_slider && (int)strlen(leaf) + 3 + text_cells(value) > room) {
        room = a.width;
    }

    // the value at the end, and before it the name
    const int length =
        fit_value(shown, sizeof shown, room - (int)strlen(leaf) - 3, value, info->unit);
    const int value_at = room - length;
    const char *name = name_in_list(parameter, is_knob, value_at - 2);
    screen_text(s, a.x + 1, a.y, value_at - 2, name_ink(model, parameter, inert), name);
    screen_text(s, a.x + value_at, a.y, length, k.knob, shown);
}

// The heading of a group: its name.
static void draw_heading(screen *s, area a, int first)
{
    char name[PARAMETER_NAME];
    parameter_group_name(first, name, sizeof name);
    area_text(s, a, INK_EVENT, name);
}

// The line below the selected parameter: its slider between the ends of its range, or the
// reason why it has no effect.
static void draw_wide_slider(const explorer_model *model, layout *lay, screen *s, area a,
                             const track *k)
{
    const char *inert = model_inert_reason(model, k->parameter);
    if (inert != NULL) {
        area_text(s, area_right(a, 1), INK_WARNING, inert);
        return;
    }
    const number_text low = draw_number(k->scale.low), high = draw_number(k->scale.high);
    const int before = (int)strlen(low.text), after = (int)strlen(high.text);
    const area between = {a.x + before + 1, a.y, a.width - before - after - 2, 1};
    area_text(s, a, INK_DIM, low.text);
    area_text(s, area_right(a, a.width - after), INK_DIM, high.text);
    draw_track(lay, s, between, k);
}

// The frame, whose title says by what the list is filtered, or the keys.
static void draw_parameters_frame(const explorer_view *view, screen *s, area a)
{
    enum { WIDE = 46 };
    const char *filter = view->filters.text[PANEL_PARAMETERS];
    char title[LINE_TEXT + 32] = "parameters (Tab: values, Esc: knobs)";
    if (filter[0] != '\0') {
        snprintf(title, sizeof title, "parameters /%s", filter);
    } else if (shows_knobs(view)) {
        snprintf(title, sizeof title, "knobs (/ all %d)", parameter_count);
    } else if (a.width < WIDE) {
        snprintf(title, sizeof title, "parameters (Tab: values)");
    }
    area_frame(s, a, INK_FRAME, title);
}

// Whether the selected line is that of the chosen parameter, and has something to say in
// a second one: a number its slider, what has no effect why.
static bool selected_line_expands(const explorer_model *model, const explorer_view *view,
                                  parameter_line line, bool has_slider)
{
    const int chosen = view->parameters.parameter;
    if (line.heading) {
        return false;
    }
    return has_slider || model_inert_reason(model, chosen) != NULL;
}

// The lines of the list from the one on that lets the selected one be seen.
static void draw_parameter_list(const explorer_model *model, const explorer_view *view,
                                layout *lay, screen *s, area a)
{
    const parameters p = model_parameters(model);
    const area inside = area_inside(a);
    parameter_line lines[PARAMETER_LINES];
    int selected;
    const int count = view_parameter_lines(view, lines, &selected);
    draw_parameters_frame(view, s, a);
    if (count == 0) {
        area_text(s, inside, INK_DIM, "none has these words");
        return;
    }

    // the selected parameter takes a second row for its slider
    track wide = {.parameter = view->parameters.parameter,
                  .knob = view->slider.held ? INK_EVENT : INK_CURSOR};
    const bool has_slider = find_track(view, &p, &wide);
    const bool expands = inside.height >= 2 &&
                         selected_line_expands(model, view, lines[selected], has_slider);
    const int rows = expands ? count + 1 : count;
    const int first = draw_first_line(selected, rows, inside.height);

    // those behind it are a row further down
    for (int i = 0; i < count; i++) {
        int row = i - first;
        if (expands && i > selected) {
            row++;
        }
        if (row < 0 || row >= inside.height) {
            continue;
        }
        const area line = area_row(inside, row);
        if (lines[i].heading) {
            draw_heading(s, line, lines[i].parameter);
        } else {
            draw_parameter(model, view, lay, s, line, &p, lines[i].parameter);
        }
        if (i == selected) {
            area_tint(s, (area){a.x + 1, line.y, a.width - 2, 1}, INK_SELECTED);
        }
    }

    // what the selected parameter has to say
    const int slider_row = selected + 1 - first;
    if (expands && slider_row < inside.height) {
        draw_wide_slider(model, lay, s, area_row(inside, slider_row), &wide);
    }
}

// The mouse on a slider: takes hold, drags, nudges with the wheel.
static void point_at_slider(explorer_model *model, explorer_view *view,
                            explorer_input *input, const panel_gesture *g)
{
    const hit_area *h = &g->hit;
    const int cells = h->area.width, wheel = pointer_wheel(g->event);
    double share = 0;
    if (cells > 1) {
        share = (double)(g->event.x - h->area.x) / (cells - 1);
    }
    if (wheel != 0) {
        view->parameters.parameter = h->index;
        const char *direction = wheel < 0 ? "" : "-1"; // as the command takes it
        act_nudge(model, view, input, direction);
    } else if (g->event.kind == POINTER_RELEASE) {
        act_release_slider(model, view, input);
    } else {
        act_drag_slider(model, view, h->index, share, cells);
    }
}

// A press selects a line; a slider takes the mouse in its own way.
static bool point_at_parameters(explorer_model *model, explorer_view *view,
                                explorer_input *input, const panel_gesture *g)
{
    if (g->hit.part == PART_SLIDER) {
        point_at_slider(model, view, input, g);
        return true;
    }
    if (g->event.kind != POINTER_PRESS) {
        return false;
    }
    view->parameters.parameter = g->hit.index;
    return true;
}

// The frame, the knobs and the slider of the selected one; all parameters want all rows
// that there are.
static int parameters_rows(const explorer_model *model, const explorer_view *view,
                           screen_size body)
{
    (void)model;
    enum { AROUND = 3 };
    parameter_line lines[PARAMETER_LINES];
    int selected;
    if (!shows_knobs(view)) {
        return body.height;
    }
    return view_parameter_lines(view, lines, &selected) + AROUND;
}

const panel parameters_panel = {.name = "parameters",
                                .rows = parameters_rows,
                                .draw = draw_parameter_list,
                                .point = point_at_parameters};
