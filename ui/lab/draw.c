// The whole screen of the terminal lab: its layout, title, status and prompt.
#include "ui/lab/draw.h"

#include <math.h>
#include <stdlib.h>

#define NOTHING 1e-12 // a smaller value is rounding, and shown as 0

enum { LEAST_WIDTH = 40, LEAST_HEIGHT = 12 };

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

static void draw_title(lab *l, screen *s)
{
    const session *e = &l->session;
    int x = 1 + screen_print(s, 1, 0, s->width - 2, INK_TITLE, "impactlab  %s", e->base.name);
    x += screen_print(s, x + 2, 0, s->width - x - 3, INK_TEXT, "%s",
                      e->base.title ? e->base.title : "");
    if (e->input_count > 0) {
        screen_print(s, x + 3, 0, s->width - x - 4, INK_EVENT, "(%d change%s)", e->input_count,
                     e->input_count == 1 ? "" : "s");
    }
}

static void draw_status(lab *l, screen *s, int y)
{
    const session *e = &l->session;
    const sample *row = session_sample(e);
    const parameters *p = &e->effective.parameters;
    bool failed = e->run.summary.status != STATUS_OK;
    bool old = e->now < e->seen;
    const char *state = l->playing                           ? (old ? "replaying" : "playing")
                        : failed && e->now >= session_end(e) ? "diverged"
                                                             : "paused";
    char model[64], mark[64] = "", law[64] = "", speed[32] = "";
    parameter_format(p, parameter_find("arm.model"), model, sizeof model);
    if (p->control.law != LAW_NONE) {
        char name[40];
        parameter_format(p, parameter_find("control.law"), name, sizeof name);
        snprintf(law, sizeof law, ", %s", name);
    }
    if (l->has_mark) {
        snprintf(mark, sizeof mark, "  from mark %.5g s", e->now - l->mark);
    }
    if (l->playing) {
        snprintf(speed, sizeof speed, " (%.3g)", l->measured);
    }
    screen_text(s, 0, y, s->width, INK_SELECTED, "");
    int x = screen_print(
        s, 0, y, s->width, INK_TEXT, " %s %-9s  t %.5f s  row %zu/%zu  \u00d7%g%s  %s%s  %s%s%s",
        l->playing ? "\u25b6" : "\u2016", state, e->now, e->row + 1, e->run.trace.row_count,
        l->speed, speed, model, law, row->contact != 0 ? "in contact" : "free flight",
        row->sticking != 0 ? ", hub sticks" : "", mark);
    for (; x < s->width; x++) {
        screen_put(s, x, y, ' ', INK_TEXT);
    }
    screen_tint(s, 0, y, s->width, 1, failed && !l->playing ? INK_WARNING : INK_SELECTED);
}

static void draw_bottom(lab *l, screen *s, int y)
{
    if (l->prompting) {
        int x = screen_print(s, 0, y, s->width, INK_TITLE, ":%s", l->prompt);
        screen_put(s, x, y, ' ', INK_SELECTED);
        if (l->message[0] != '\0') {
            screen_print(s, x + 3, y, s->width - x - 3, INK_DIM, "%s", l->message);
        }
    } else if (l->message[0] != '\0') {
        screen_print(s, 1, y, s->width - 2, l->warning ? INK_WARNING : INK_TEXT, "%s", l->message);
    } else {
        screen_text(
            s, 1, y, s->width - 2, INK_DIM,
            "Space run/pause  \u25c0 \u25b6 step  n/N event  +/- speed  Enter change value  "
            "b branch  c compare  o open  s save  ? help  q quit");
    }
}

static void draw_panels(lab *l, screen *s)
{
    int right = s->width >= 100 ? 40 : s->width >= 72 ? 34 : 0;
    int left = s->width - right, body = s->height - 3;
    int arm_height = body >= 20 ? body * 2 / 5 : body / 2;
    draw_arm(l, s, (area){0, 1, left, arm_height});
    draw_curves(l, s, (area){0, 1 + arm_height, left, body - arm_height});
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
    l->width = s->width;
    l->height = s->height;
    if (s->width < LEAST_WIDTH || s->height < LEAST_HEIGHT) {
        screen_print(s, 0, 0, s->width, INK_WARNING, "%d x %d: the lab needs %d x %d (q quits)",
                     s->width, s->height, LEAST_WIDTH, LEAST_HEIGHT);
        return;
    }
    draw_title(l, s);
    draw_panels(l, s);
    if (l->overlay == OVERLAY_HELP) {
        draw_help(l, s);
    } else if (l->overlay == OVERLAY_OPEN) {
        draw_list(l, s);
    } else if (l->overlay == OVERLAY_COMPARE) {
        draw_comparison(l, s);
    }
    draw_status(l, s, s->height - 2);
    draw_bottom(l, s, s->height - 1);
}
