// The panel of parameters: their values at the cursor, and sliders of those that are numbers.
#include "ui/explorer/panels/panel.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    PATH_ROOM = 37,   // cells for path and value of a line that has a slider
    LEAST_SLIDER = 5, // cells of it
    MOST_SLIDER = 24
};

// The value at the cursor, or the one that the mouse is about to give.
static double shown_value(const explorer_state *st, const parameters *p, int parameter,
                          slider_scale *scale, bool *has_slider)
{
    bool held = st->slider.held && st->slider.parameter == parameter;
    double value = held ? st->slider.value : parameter_get(p, parameter);
    *has_slider = slider_scale_of(parameter, value, scale);
    if (held) {
        *scale = st->slider.scale;
    }
    return value;
}

// A slider that is drawn.
typedef struct track {
    int parameter;
    slider_scale scale;
    double value;
    ink knob;
} track;

static void draw_track(layout *lay, screen *s, area a, const track *k)
{
    int at = (int)lround(slider_share(&k->scale, k->value) * (a.width - 1));
    for (int i = 0; i < a.width; i++) {
        screen_put(s, a.x + i, a.y, i == at ? 0x25cf : 0x2500, i == at ? k->knob : INK_FRAME);
    }
    layout_add_hit(lay, (hit_area){PANEL_PARAMETERS, PART_SLIDER, k->parameter, a});
}

// The slider of the selected number in a line of its own, between the ends of its range.
static void draw_wide_slider(layout *lay, screen *s, area a, const track *k)
{
    char low[32], high[32];
    draw_number(low, sizeof low, k->scale.low);
    draw_number(high, sizeof high, k->scale.high);
    int before = (int)strlen(low), after = (int)strlen(high);
    screen_text(s, a.x, a.y, a.width, INK_DIM, low);
    screen_text(s, a.x + a.width - after, a.y, after, INK_DIM, high);
    draw_track(lay, s, (area){a.x + before + 1, a.y, a.width - before - after - 2, 1}, k);
}

// Path, value and unit in a line, with a slider behind them where there is room.
static void draw_line(const explorer_state *st, layout *lay, screen *s, area a, const parameters *p,
                      int parameter)
{
    const parameter_info *info = &parameter_table[parameter];
    char value[160], shown[200];
    slider_scale scale;
    bool has_slider, held = st->slider.held && st->slider.parameter == parameter;
    double number = shown_value(st, p, parameter, &scale, &has_slider);
    if (info->type == PARAMETER_REAL || held) {
        snprintf(value, sizeof value, "%.6g", number);
    } else {
        parameter_format(p, parameter, value, sizeof value);
    }
    snprintf(shown, sizeof shown, "%.12s %s", value, info->unit);
    ink colour = held ? INK_EVENT : info->timed ? INK_ARM : INK_DIM;
    int slider = a.width - PATH_ROOM, room = a.width;
    if (slider >= LEAST_SLIDER) {
        slider = slider > MOST_SLIDER ? MOST_SLIDER : slider;
        room -= slider + 1;
    }
    int start = room - (int)strlen(shown);
    bool given = st->session.effective.parameters.set[parameter] != 0;
    layout_add_hit(lay, (hit_area){PANEL_PARAMETERS, PART_LINES, parameter, a});
    // where not all fits the group goes first, then the unit
    const char *name = info->path;
    if ((int)strlen(name) >= start) {
        name = strchr(name, '.') + 1;
    }
    if ((int)strlen(name) >= start) {
        start = room - snprintf(shown, sizeof shown, "%.12s", value);
    }
    screen_text(s, a.x, a.y, start - 1, given ? INK_TITLE : INK_TEXT, name);
    screen_text(s, a.x + start, a.y, room - start, colour, shown);
    if (has_slider && slider >= LEAST_SLIDER) {
        const track beside = {parameter, scale, number, colour};
        draw_track(lay, s, (area){a.x + room + 1, a.y, slider, 1}, &beside);
    }
}

static void draw(const explorer_state *st, layout *lay, screen *s, area a)
{
    parameters p = state_parameters(st);
    int count = 0, selected = 0, line = 0, height = a.height - 2;
    track wide = {.parameter = st->side.parameter,
                  .knob = st->slider.held ? INK_EVENT : INK_CURSOR};
    bool expands;
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, "parameters (Tab: values)");

    // a number that is selected takes a second line for its wide slider
    wide.value = shown_value(st, &p, st->side.parameter, &wide.scale, &expands);
    expands = expands && height >= 2;
    for (int i = 0; i < parameter_count; i++) {
        selected = i == st->side.parameter ? count : selected;
        count += state_parameter_applies(st, i);
    }
    count += expands;

    int first = draw_first_line(selected, count, height);
    for (int i = 0; i < parameter_count && line - first < height; i++) {
        if (!state_parameter_applies(st, i)) {
            continue;
        }
        area at = {a.x + 2, a.y + 1 + line++ - first, a.width - 4, 1};
        if (at.y > a.y) {
            draw_line(st, lay, s, at, &p, i);
        }
        if (i != st->side.parameter) {
            continue;
        }
        screen_tint(s, a.x + 1, at.y, a.width - 2, 1, INK_SELECTED);
        if (expands && line - first < height) {
            at.y = a.y + 1 + line++ - first;
            draw_wide_slider(lay, s, at, &wide);
        }
    }
}

// The mouse on a slider: takes hold, drags, nudges with the wheel.
static bool point_at_slider(explorer_state *st, const panel_gesture *g, action_result *result)
{
    const hit_area *h = &g->hit;
    int cells = h->area.width;
    double share = cells > 1 ? (double)(g->event.x - h->area.x) / (cells - 1) : 0;
    switch (g->event.kind) {
    case POINTER_PRESS:
    case POINTER_DRAG:
        act_hold_slider(st, (slider_drag){h->index, share, cells});
        return true;
    case POINTER_RELEASE:
        *result = act_drop_slider(st);
        return true;
    default:
        st->side.parameter = h->index;
        *result = act_nudge(st, g->event.kind == POINTER_WHEEL_UP ? "" : "-1");
        return true;
    }
}

// A click selects a line; a slider takes the mouse in its own way.
static bool point(explorer_state *st, const panel_gesture *g, action_result *result)
{
    *result = result_done();
    if (g->hit.part == PART_SLIDER) {
        return point_at_slider(st, g, result);
    }
    if (g->event.kind == POINTER_PRESS) {
        st->side.parameter = g->hit.index;
        return true;
    }
    return false;
}

const panel parameters_panel = {.name = "parameters", .draw = draw, .point = point};
