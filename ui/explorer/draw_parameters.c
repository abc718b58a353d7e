// The panel of parameters: their values at the cursor, and sliders of those that are numbers.
#include "ui/explorer/draw.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    PATH_ROOM = 37,   // cells for path and value of a line that has a slider
    LEAST_SLIDER = 5, // cells of it
    MOST_SLIDER = 24
};

// The value at the cursor, or the one that the mouse is about to give.
static double shown_value(const lab *l, const parameters *p, int parameter, slider_scale *scale,
                          bool *has_slider)
{
    bool held = l->slider.held && l->slider.parameter == parameter;
    double value = held ? l->slider.value : parameter_get(p, parameter);
    *has_slider = lab_slider_scale(parameter, value, scale);
    if (held) {
        *scale = l->slider.scale;
    }
    return value;
}

static void draw_track(lab *l, screen *s, area a, int parameter, const slider_scale *scale,
                       double value, ink knob)
{
    int at = (int)lround(slider_share(scale, value) * (a.width - 1));
    for (int i = 0; i < a.width; i++) {
        screen_put(s, a.x + i, a.y, i == at ? 0x25cf : 0x2500, i == at ? knob : INK_FRAME);
    }
    draw_spot(l, PART_SLIDER, a, parameter);
}

// The slider of the selected number in a line of its own, between the ends of its range.
static void draw_wide_slider(lab *l, screen *s, area a, int parameter, const slider_scale *scale,
                             double value, ink knob)
{
    char low[32], high[32];
    draw_number(low, sizeof low, scale->low);
    draw_number(high, sizeof high, scale->high);
    int before = (int)strlen(low), after = (int)strlen(high);
    screen_text(s, a.x, a.y, a.width, INK_DIM, low);
    screen_text(s, a.x + a.width - after, a.y, after, INK_DIM, high);
    draw_track(l, s, (area){a.x + before + 1, a.y, a.width - before - after - 2, 1}, parameter,
               scale, value, knob);
}

// Path, value and unit in a line, with a slider behind them where there is room.
static void draw_line(lab *l, screen *s, area a, const parameters *p, int parameter)
{
    const parameter_info *info = &parameter_table[parameter];
    char value[160], shown[200];
    slider_scale scale;
    bool has_slider, held = l->slider.held && l->slider.parameter == parameter;
    double number = shown_value(l, p, parameter, &scale, &has_slider);
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
    bool given = l->session.effective.parameters.set[parameter] != 0;
    draw_spot(l, PART_PARAMETER, a, parameter);
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
        draw_track(l, s, (area){a.x + room + 1, a.y, slider, 1}, parameter, &scale, number, colour);
    }
}

void draw_parameters(lab *l, screen *s, area a)
{
    parameters p = session_parameters_at(&l->session, l->session.now);
    screen_frame(s, a.x, a.y, a.width, a.height, INK_FRAME, "parameters (Tab: values)");
    int count = 0, selected = 0, line = 0, height = a.height - 2;
    slider_scale scale;
    bool expands;
    double value = shown_value(l, &p, l->parameter, &scale, &expands);
    expands = expands && height >= 2;
    for (int i = 0; i < parameter_count; i++) {
        selected = i == l->parameter ? count : selected;
        count += lab_applies(l, i);
    }
    count += expands;
    int first = draw_first_line(selected, count, height);
    for (int i = 0; i < parameter_count && line - first < height; i++) {
        if (!lab_applies(l, i)) {
            continue;
        }
        area at = {a.x + 2, a.y + 1 + line++ - first, a.width - 4, 1};
        if (at.y > a.y) {
            draw_line(l, s, at, &p, i);
        }
        if (i != l->parameter) {
            continue;
        }
        screen_tint(s, a.x + 1, at.y, a.width - 2, 1, INK_SELECTED);
        if (expands && line - first < height) {
            at.y = a.y + 1 + line++ - first;
            draw_wide_slider(l, s, at, i, &scale, value, l->slider.held ? INK_EVENT : INK_CURSOR);
        }
    }
}
