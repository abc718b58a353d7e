// The whole screen of the terminal lab: its layout, title, status and prompt.
#include "ui/explorer/draw.h"

#include <math.h>
#include <stdlib.h>

#define NOTHING 1e-12 // a smaller value is rounding, and shown as 0

void draw_number(char *text, size_t size, double value)
{
    if (!isfinite(value)) {
        snprintf(text, size, "-");
    } else if (fabs(value) < NOTHING) {
        snprintf(text, size, "0");
    } else if (fabs(value) < 1e-3 || fabs(value) >= 1e5) {
        snprintf(text, size, "%.2e", value);
    } else {
        snprintf(text, size, "%.4g", value);
    }
}

int draw_first_line(int selected, int count, int height)
{
    int first = selected - height / 2;
    first = first > count - height ? count - height : first;
    return first < 0 ? 0 : first;
}

void draw_spot(lab *l, lab_part part, area a, int index)
{
    if (l->spot_count < LAB_SPOTS) {
        l->spots[l->spot_count++] = (lab_spot){part, a.x, a.y, a.width, a.height, index};
    }
}

static void draw_side(lab *l, screen *s, area a)
{
    if (l->side == SIDE_VALUES) {
        draw_values(l, s, a);
    } else {
        draw_parameters(l, s, a);
    }
}

// What stands on the right, from top to bottom; `log` and `predictors` are heights.
static void draw_stack(lab *l, screen *s, area a, int predictors, int log)
{
    int law = draw_controller_height(l, a.height - predictors);
    a.height -= law + predictors + log;
    draw_side(l, s, a);
    a.y += a.height;
    if (law > 0) {
        draw_controller(l, s, (area){a.x, a.y, a.width, law});
    }
    a.y += law;
    if (predictors > 0) {
        draw_predictors(l, s, (area){a.x, a.y, a.width, predictors});
    }
    a.y += predictors;
    if (log > 0) {
        draw_log(l, s, (area){a.x, a.y, a.width, log});
    }
}

// Of the stack on the right; from 120 on there is room for sliders beside the values.
static int side_width(const screen *s)
{
    static const struct {
        int screen, side;
    } widths[] = {{200, 60}, {120, 46}, {100, 40}, {SIDE_WIDTH, 34}};
    for (size_t i = 0; i < sizeof widths / sizeof widths[0]; i++) {
        if (s->width >= widths[i].screen) {
            return widths[i].side;
        }
    }
    return 0;
}

static void draw_panels(lab *l, screen *s)
{
    int right = side_width(s), left = s->width - right, body = s->height - 3;
    int arm_height = body >= 20 ? body * 2 / 5 : body / 2;
    draw_arm(l, s, (area){0, 1, left, arm_height});
    area below = {0, 1 + arm_height, left, body - arm_height};
    if (right == 0 && l->side_in_front) {
        draw_stack(l, s, below, 0, 0);
    } else {
        draw_curves(l, s, below);
    }
    if (right > 0) {
        int predictors = body >= 18 ? 6 : 0, log = body >= 26 ? body / 4 : 0;
        draw_stack(l, s, (area){left, 1, right, body}, predictors, log);
    }
}

void lab_draw(lab *l, screen *s)
{
    screen_clear(s);
    l->plot_width = l->plot_height = 0;
    l->spot_count = 0;
    l->width = s->width;
    l->height = s->height;
    if (s->width < LEAST_WIDTH || s->height < LEAST_HEIGHT) {
        draw_too_small(s);
        return;
    }
    lab_notice_law(l);
    lab_grow_axes(l);
    lab_keep_cursor_visible(l);
    draw_title(l, s);
    draw_panels(l, s);
    if (l->overlay == OVERLAY_HELP) {
        draw_help(l, s);
    } else if (l->overlay == OVERLAY_OPEN) {
        draw_list(l, s);
    } else if (l->overlay == OVERLAY_COMPARE) {
        draw_comparison(l, s);
    }
    int rows = draw_bottom(l, s);
    draw_status(l, s, s->height - 1 - rows);
}
