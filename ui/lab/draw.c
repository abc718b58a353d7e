// The whole screen of the terminal lab: its layout, title, status and prompt.
#include "ui/lab/draw.h"

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

static void draw_panels(lab *l, screen *s)
{
    int right = s->width >= 100 ? 40 : s->width >= SIDE_WIDTH ? 34 : 0;
    int left = s->width - right, body = s->height - 3;
    int arm_height = body >= 20 ? body * 2 / 5 : body / 2;
    draw_arm(l, s, (area){0, 1, left, arm_height});
    area below = {0, 1 + arm_height, left, body - arm_height};
    if (right == 0 && l->side_in_front && l->side == SIDE_VALUES) {
        draw_values(l, s, below);
    } else if (right == 0 && l->side_in_front) {
        draw_parameters(l, s, below);
    } else {
        draw_curves(l, s, below);
    }
    if (right == 0) {
        return;
    }
    int predictors = body >= 18 ? 6 : 0, log = body >= 26 ? body / 4 : 0;
    int top = body - predictors - log;
    area side = {left, 1, right, top};
    if (l->side == SIDE_VALUES) {
        draw_values(l, s, side);
    } else {
        draw_parameters(l, s, side);
    }
    if (predictors > 0) {
        draw_predictors(l, s, (area){left, 1 + top, right, predictors});
    }
    if (log > 0) {
        draw_log(l, s, (area){left, 1 + top + predictors, right, log});
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
