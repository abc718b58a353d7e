#include "ui/explorer/panels/curves_mouse.h"

#include <math.h>

// The instant at a column of the plot, kept within what is visible [s].
static double time_at(const explorer_state *st, area plot, int x)
{
    double from, to;
    state_window(st, &from, &to);
    double share = (x - plot.x + 0.5) / (plot.width > 0 ? plot.width : 1);
    return from + (to - from) * fmax(0, fmin(1, share));
}

// A turn of the wheel over the plot or the time axis zooms there or pans.
static void turn_wheel(explorer_state *st, const panel_gesture *g, bool pans)
{
    double from, to;
    int direction = pointer_wheel(g->event);
    state_window(st, &from, &to);
    if (pans) {
        act_pan_by(st, 0.1 * direction * (to - from));
    } else {
        act_zoom_at(st, direction < 0 ? 0.8 : 1.25, time_at(st, g->hit.area, g->event.x));
    }
}

// The cursor goes where the mouse is.
bool curves_point_at_plot(explorer_state *st, const panel_gesture *g)
{
    switch (g->event.kind) {
    case POINTER_PRESS:
    case POINTER_DRAG:
        act_scrub(st, time_at(st, g->hit.area, g->event.x));
        return true;
    case POINTER_RELEASE:
        return false;
    default:
        turn_wheel(st, g, g->event.shift);
        return true;
    }
}

// The axis is dragged; a click without a drag moves the cursor.
bool curves_point_at_time_axis(explorer_state *st, const panel_gesture *g)
{
    const area a = g->hit.area;

    double from, to;
    switch (g->event.kind) {
    case POINTER_PRESS:
        return true;
    case POINTER_DRAG:
        state_window(st, &from, &to);
        act_pan_by(st, a.width > 0 ? -g->across * (to - from) / a.width : 0);
        return true;
    case POINTER_RELEASE:
        if (!g->dragged) {
            act_scrub(st, time_at(st, a, g->event.x));
        }
        return true;
    default:
        turn_wheel(st, g, !g->event.control);
        return true;
    }
}

// A click puts the pane in focus, a drag moves its axis, the wheel zooms it.
bool curves_point_at_labels(explorer_state *st, const panel_gesture *g)
{
    const hit_area *h = &g->hit;
    const int rows = h->area.height > 0 ? h->area.height : 1;

    switch (g->event.kind) {
    case POINTER_PRESS:
        st->panes.focus = h->index;
        return true;
    case POINTER_DRAG:
        if (g->up != 0) {
            act_shift_axis(st, h->index, -(double)g->up / rows);
        }
        return true;
    case POINTER_RELEASE:
        return false;
    default:
        act_scale_axis(st, h->index, pointer_wheel(g->event) < 0 ? 0.8 : 1.25,
                       (g->event.y - h->area.y + 0.5) / rows);
        return true;
    }
}
