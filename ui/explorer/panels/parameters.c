// The panel of parameters: their values at the cursor, and sliders of those that are
// numbers.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <string.h>

enum {
    LEAST_VALUE = 12, // cells for a value before its name is cut
    PATH_ROOM = 37,   // cells for path and value of a line that has a slider
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

static void draw_track(layout *lay, screen *s, area a, const track *k)
{
    int at = (int)lround(slider_share(&k->scale, k->value) * (a.width - 1));
    for (int i = 0; i < a.width; i++) {
        screen_put(s, a.x + i, a.y, i == at ? 0x25cf : 0x2500,
                   i == at ? k->knob : INK_FRAME);
    }
    layout_add_hit(lay, (hit_area){PANEL_PARAMETERS, PART_SLIDER, k->parameter, a});
}

// Value and unit as far as `most` cells have room for them: where they have not, the unit
// goes, then the value's end, which two points stand for. Returns the cells it takes.
static int fit_value(char *shown, size_t size, int most, const char *value,
                     const parameter_info *info)
{
    snprintf(shown, size, "%s%s%s", value, info->unit[0] ? " " : "", info->unit);
    if (!(most > LEAST_VALUE)) {
        most = LEAST_VALUE;
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

// Name, value and unit in a line, with a slider behind them where there is room.
static void draw_line(const explorer_model *model, const explorer_view *view, layout *lay,
                      screen *s, area a, const parameters *p, int parameter)
{
    const parameter_info *info = &parameter_table[parameter];
    char value[PARAMETER_TEXT_SIZE], shown[PARAMETER_TEXT_SIZE + 32];
    const bool inert = model_inert_reason(model, parameter) != NULL;
    const bool held = view->slider.held && view->slider.parameter == parameter;
    track k = {.parameter = parameter};
    if (inert) {
        k.knob = INK_FRAME;
    } else if (held) {
        k.knob = INK_EVENT;
    } else if (info->timed) {
        k.knob = INK_ARM;
    } else {
        k.knob = INK_DIM;
    }
    const bool has_slider = find_track(view, p, &k);
    parameter_format(p, parameter, value, sizeof value);
    if (info->type == PARAMETER_REAL || held) {
        snprintf(value, sizeof value, "%.6g", k.value);
    }
    int slider = a.width - PATH_ROOM, room = a.width;
    if (slider >= LEAST_SLIDER) {
        if (slider > MOST_SLIDER) {
            slider = MOST_SLIDER;
        }
        room -= slider + 1;
    }
    bool given = model->session.effective.parameters.set[parameter] != 0;
    layout_add_hit(lay, (hit_area){PANEL_PARAMETERS, PART_LINES, parameter, a});

    // the heading has the group
    const char *name = strchr(info->path, '.') + 1;
    const int length =
        fit_value(shown, sizeof shown, room - (int)strlen(name) - 3, value, info);
    const int start = room - length;
    ink colour = INK_TEXT;
    if (inert) {
        colour = INK_FRAME;
    } else if (given) {
        colour = INK_TITLE;
    }
    screen_text(s, a.x + 1, a.y, start - 2, colour, name);
    screen_text(s, a.x + start, a.y, room - start, k.knob, shown);
    if (has_slider && slider >= LEAST_SLIDER && !inert) {
        draw_track(lay, s, (area){a.x + room + 1, a.y, slider, 1}, &k);
    }
}

// The heading of a group: its name, and how many parameters it hides.
static void draw_heading(const explorer_view *view, layout *lay, screen *s, area a,
                         int parameter)
{
    char name[PARAMETER_NAME];
    const bool filtered = view->filters.text[PANEL_PARAMETERS][0] != '\0';
    const bool folded = view->parameters.folded[parameter] && !filtered;
    parameter_group_name(parameter, name, sizeof name);

    // its name, and how many parameters are folded away
    int x = a.x + screen_print(s, a.x, a.y, a.width, INK_EVENT, "%s %s",
                               folded ? "\u25b8" : "\u25be", name);
    if (folded) {
        int end = parameter;
        while (end < parameter_count && parameter_group(end) == parameter) {
            end++;
        }
        screen_print(s, x + 1, a.y, a.x + a.width - x - 1, INK_FRAME, "%d",
                     end - parameter);
    }
    layout_add_hit(lay, (hit_area){PANEL_PARAMETERS, PART_HEADING, parameter, a});
}

// The line below the selected parameter: its slider between the ends of its range, or the
// reason why it has no effect.
static void draw_below(const explorer_model *model, layout *lay, screen *s, area a,
                       const track *k)
{
    const char *inert = model_inert_reason(model, k->parameter);
    if (inert != NULL) {
        screen_text(s, a.x + 1, a.y, a.width - 1, INK_WARNING, inert);
        return;
    }
    const number_text low = draw_number(k->scale.low), high = draw_number(k->scale.high);
    const int before = (int)strlen(low.text), after = (int)strlen(high.text);
    screen_text(s, a.x, a.y, a.width, INK_DIM, low.text);
    screen_text(s, a.x + a.width - after, a.y, after, INK_DIM, high.text);
    draw_track(lay, s, (area){a.x + before + 1, a.y, a.width - before - after - 2, 1}, k);
}

static void draw(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area a)
{
    parameters p = model_parameters(model);
    parameter_line lines[PARAMETER_LINES];
    const parameter_list *list = &view->parameters;
    const char *filter = view->filters.text[PANEL_PARAMETERS];
    char title[LINE_TEXT + 32] = "parameters (Tab: values, / filters)";
    int line = 0, height = a.height - 2;
    track wide = {.parameter = list->parameter,
                  .knob = view->slider.held ? INK_EVENT : INK_CURSOR};
    const bool number = find_track(view, &p, &wide);
    if (filter[0] != '\0') {
        snprintf(title, sizeof title, "parameters /%s", filter);
    } else if (a.width < 46) {
        snprintf(title, sizeof title, "parameters (Tab: values)");
    }
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, title);

    // a number that is selected takes a second line, and so does what has no effect
    int selected;
    const int count = view_parameter_lines(view, lines, &selected);
    const bool shows_parameter = count > 0 && !lines[selected].heading &&
                                 lines[selected].parameter == list->parameter;
    const bool expands = shows_parameter && height >= 2 &&
                         (number || model_inert_reason(model, list->parameter) != NULL);
    if (count == 0) {
        screen_text(s, a.x + 2, a.y + 1, a.width - 4, INK_DIM, "none has these words");
    }

    int first = draw_first_line(selected, count + expands, height);
    for (int i = 0; i < count && line - first < height; i++) {
        area at = {a.x + 2, a.y + 1 + line++ - first, a.width - 4, 1};
        if (at.y > a.y && lines[i].heading) {
            draw_heading(view, lay, s, at, lines[i].parameter);
        } else if (at.y > a.y) {
            draw_line(model, view, lay, s, at, &p, lines[i].parameter);
        }
        if (i != selected) {
            continue;
        }
        screen_tint(s, a.x + 1, at.y, a.width - 2, 1, INK_SELECTED);
        if (expands && line - first < height) {
            at.y = a.y + 1 + line++ - first;
            draw_below(model, lay, s, at, &wide);
        }
    }
}

// The mouse on a slider: takes hold, drags, nudges with the wheel.
static bool point_at_slider(explorer_model *model, explorer_view *view,
                            explorer_input *input, const panel_gesture *g)
{
    const hit_area *h = &g->hit;
    const int cells = h->area.width, wheel = pointer_wheel(g->event);
    const double share = cells > 1 ? (double)(g->event.x - h->area.x) / (cells - 1) : 0;
    if (wheel != 0) {
        parameter_list_select(&view->parameters, (parameter_line){h->index, false});
        act_nudge(model, view, input, wheel < 0 ? "" : "-1");
    } else if (g->event.kind == POINTER_RELEASE) {
        act_release_slider(model, view, input);
    } else {
        act_drag_slider(model, view, h->index, share, cells);
    }
    return true;
}

// A click selects a line; a slider takes the mouse in its own way.
static bool point(explorer_model *model, explorer_view *view, explorer_input *input,
                  const panel_gesture *g)
{
    const bool pressed = g->event.kind == POINTER_PRESS;
    if (g->hit.part == PART_SLIDER) {
        return point_at_slider(model, view, input, g);
    }

    // a press folds the group of a heading and selects any other line
    if (pressed && g->hit.part == PART_HEADING) {
        parameter_list_fold(&view->parameters, g->hit.index);
    } else if (pressed) {
        parameter_list_select(&view->parameters, (parameter_line){g->hit.index, false});
    }
    return pressed;
}

const panel parameters_panel = {.name = "parameters", .draw = draw, .point = point};
