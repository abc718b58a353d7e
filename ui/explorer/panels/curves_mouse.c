// The mouse on the panes of curves, their axes and what lies below them.
#include "ui/explorer/panels/plot.h"

#include <math.h>

// The share of a line at which a column is, 0 to 1 within it.
static double share_across(area line, int x)
{
    const int columns = line.width > 0 ? line.width : 1;
    return (x - line.x + 0.5) / columns;
}

// The instant at a column of the plot, kept within what is visible [s].
static double time_at(const explorer_model *model, const explorer_view *view, area plot,
                      int x)
{
    double from, to;
    view_window(model, view, &from, &to);
    return from + (to - from) * fmax(0, fmin(1, share_across(plot, x)));
}

// A turn of the wheel zooms the axis of values or of time that is under the mouse, or
// pans: over the curves with Shift, on the time axis without Control.
static void turn_wheel_on_curves(const explorer_model *model, explorer_view *view,
                                 const panel_gesture *g)
{
    const hit_area *h = &g->hit;
    const int direction = pointer_wheel(g->event);
    const double factor = direction < 0 ? 0.8 : 1.25;
    bool pans = g->event.shift;
    if (h->part == PART_TIME_AXIS) {
        pans = !g->event.control;
    }
    if (h->part == PART_LABELS) {
        const int rows = h->area.height > 0 ? h->area.height : 1;
        const double share_down = (g->event.y - h->area.y + 0.5) / rows;
        act_scale_axis(model, view, h->index, factor, share_down);
    } else if (pans) {
        double from, to;
        view_window(model, view, &from, &to);
        act_pan_by(model, view, 0.1 * direction * (to - from));
    } else {
        act_zoom_at(model, view, factor, time_at(model, view, h->area, g->event.x));
    }
}

// The cursor goes where the mouse is.
static bool scrub(explorer_model *model, explorer_view *view, const panel_gesture *g)
{
    if (g->event.kind == POINTER_RELEASE) {
        return false;
    }
    act_scrub(model, view, time_at(model, view, g->hit.area, g->event.x));
    return true;
}

// The axis is dragged; a click without a drag moves the cursor.
static void point_at_time_axis(explorer_model *model, explorer_view *view,
                               const panel_gesture *g)
{
    const area a = g->hit.area;
    if (g->event.kind == POINTER_DRAG && a.width > 0) {
        double from, to;
        view_window(model, view, &from, &to);
        act_pan_by(model, view, -g->across * (to - from) / a.width);
    } else if (g->event.kind == POINTER_RELEASE && !g->dragged) {
        act_scrub(model, view, time_at(model, view, a, g->event.x));
    }
}

// A click puts the pane in focus, a drag moves its axis.
static bool point_at_labels(const explorer_model *model, explorer_view *view,
                            const panel_gesture *g)
{
    const hit_area *h = &g->hit;
    const int rows = h->area.height > 0 ? h->area.height : 1;
    if (g->event.kind == POINTER_PRESS) {
        view->panes.focus = h->index;
    } else if (g->event.kind == POINTER_DRAG && g->up != 0) {
        act_shift_axis(model, view, h->index, -(double)g->up / rows);
    }
    return g->event.kind != POINTER_RELEASE;
}

bool curves_point(explorer_model *model, explorer_view *view, explorer_input *input,
                  const panel_gesture *g)
{
    const hit_part part = g->hit.part;
    if (pointer_wheel(g->event) != 0) {
        if (part == PART_LANES) {
            return false;
        }
        if (part != PART_VIEW) {
            turn_wheel_on_curves(model, view, g);
        }
        return true;
    }

    // each part takes the mouse in its own way
    switch (part) {
    case PART_BODY:
    case PART_PANE:
    case PART_LANES:
        return scrub(model, view, g);
    case PART_TIME_AXIS:
        point_at_time_axis(model, view, g);
        return true;
    case PART_VIEW:
        return true;
    case PART_LEGEND:
        return g->event.kind == POINTER_PRESS &&
               act_toggle_signal(view, input, g->hit.index / PANE_SIGNALS,
                                 g->hit.index % PANE_SIGNALS);
    default:
        return point_at_labels(model, view, g);
    }
}
