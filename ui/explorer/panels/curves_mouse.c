// The mouse on the panes of curves, their axes and what lies below them.
#include "ui/explorer/panels/plot.h"

#include <math.h>

// The instant at a column of the plot, kept within what is visible [s].
static double time_at(const explorer_model *model, const explorer_view *view, area plot,
                      int x)
{
    double from, to;
    view_window(model, view, &from, &to);
    double share = (x - plot.x + 0.5) / (plot.width > 0 ? plot.width : 1);
    return from + (to - from) * fmax(0, fmin(1, share));
}

// A turn of the wheel zooms the axis of values or of time that is under the mouse, or
// pans.
static bool turn_wheel(const explorer_model *model, explorer_view *view,
                       const panel_gesture *g)
{
    const hit_area *h = &g->hit;
    const int direction = pointer_wheel(g->event),
              rows = h->area.height > 0 ? h->area.height : 1;
    const double factor = direction < 0 ? 0.8 : 1.25;
    double from, to;
    view_window(model, view, &from, &to);
    if (h->part == PART_LABELS) {
        act_scale_axis(model, view, h->index, factor,
                       (g->event.y - h->area.y + 0.5) / rows);
    } else if (h->part == PART_TIME_AXIS ? !g->event.control : g->event.shift) {
        act_pan_by(model, view, 0.1 * direction * (to - from));
    } else {
        act_zoom_at(model, view, factor, time_at(model, view, h->area, g->event.x));
    }
    return true;
}

// With Control held a drag draws a box; letting go shows its instants, and its values
// where it has more than a row.
static bool draw_box(const explorer_model *model, explorer_view *view,
                     explorer_input *input, const panel_gesture *g)
{
    zoom_box *b = &view->box;
    const area a = g->hit.area;
    if (g->event.kind == POINTER_PRESS) {
        *b = (zoom_box){true,       g->hit.index, g->event.x,
                        g->event.y, g->event.x,   g->event.y};
    }
    const int right = a.x + a.width - 1, low = a.y + a.height - 1;
    if (g->event.x < a.x) {
        b->x1 = a.x;
    } else if (g->event.x < right) {
        b->x1 = g->event.x;
    } else {
        b->x1 = right;
    }
    if (g->event.y < a.y) {
        b->y1 = a.y;
    } else if (g->event.y < low) {
        b->y1 = g->event.y;
    } else {
        b->y1 = low;
    }
    b->held = g->event.kind != POINTER_RELEASE;
    if (b->held || b->x1 == b->x0) {
        return true;
    }
    const double t0 = time_at(model, view, a, b->x0), t1 = time_at(model, view, a, b->x1);
    const bool down = b->y0 < b->y1;
    const double top = (double)((down ? b->y0 : b->y1) - a.y) / a.height;
    const double bottom = (double)((down ? b->y1 : b->y0) + 1 - a.y) / a.height;
    value_range axis;
    if (b->y0 != b->y1 && view_pane_axis(model, view, b->pane, &axis)) {
        const double height = axis.high - axis.low;
        pane_fix_axis(&view->panes.pane[b->pane],
                      (value_range){axis.high - bottom * height,
                                    axis.high - top * height});
    }
    return act_zoom_between(model, view, input, fmin(t0, t1), fmax(t0, t1));
}

// The cursor goes where the mouse is.
static bool scrub(explorer_model *model, explorer_view *view, const panel_gesture *g)
{
    if (g->event.kind != POINTER_RELEASE) {
        act_scrub(model, view, time_at(model, view, g->hit.area, g->event.x));
    }
    return g->event.kind != POINTER_RELEASE;
}

static bool point_at_plot(explorer_model *model, explorer_view *view,
                          explorer_input *input, const panel_gesture *g)
{
    const bool in_pane =
        g->hit.part == PART_PANE && pane_is_over_time(&view->panes.pane[g->hit.index]);
    if (g->event.kind == POINTER_PRESS) {
        view->box.held = in_pane && g->event.control;
    }
    if (view->box.held) {
        return draw_box(model, view, input, g);
    }
    return scrub(model, view, g);
}

// The axis is dragged; a click without a drag moves the cursor.
static bool point_at_time_axis(explorer_model *model, explorer_view *view,
                               const panel_gesture *g)
{
    const area a = g->hit.area;
    double from, to;
    view_window(model, view, &from, &to);
    if (g->event.kind == POINTER_DRAG) {
        act_pan_by(model, view, a.width > 0 ? -g->across * (to - from) / a.width : 0);
    } else if (g->event.kind == POINTER_RELEASE && !g->dragged) {
        act_scrub(model, view, time_at(model, view, a, g->event.x));
    }
    return true;
}

// A click puts the pane in focus, a drag moves its axis.
static bool point_at_labels(const explorer_model *model, explorer_view *view,
                            const panel_gesture *g)
{
    const hit_area *h = &g->hit;
    if (g->event.kind == POINTER_PRESS) {
        view->panes.focus = h->index;
    } else if (g->event.kind == POINTER_DRAG && g->up != 0) {
        act_shift_axis(model, view, h->index,
                       -(double)g->up / (h->area.height > 0 ? h->area.height : 1));
    }
    return g->event.kind != POINTER_RELEASE;
}

// On the map of the whole run the visible part moves to the mouse.
static bool point_at_map(const explorer_model *model, explorer_view *view,
                         const panel_gesture *g)
{
    const area line = g->hit.area;
    const double share = (g->event.x - line.x + 0.5) / (line.width > 0 ? line.width : 1);
    double from, to;
    view_window(model, view, &from, &to);
    if (g->event.kind != POINTER_RELEASE) {
        act_pan_by(model, view,
                   share * model->session.effective.parameters.run.duration -
                       (from + to) / 2);
    }
    return g->event.kind != POINTER_RELEASE;
}

bool curves_point(explorer_model *model, explorer_view *view, explorer_input *input,
                  const panel_gesture *g)
{
    const hit_part part = g->hit.part;
    const bool below = part == PART_LANES || part == PART_MAP;
    if (pointer_wheel(g->event) != 0) {
        return !below && (part == PART_VIEW || turn_wheel(model, view, g));
    }

    // each part takes the mouse in its own way
    switch (part) {
    case PART_BODY:
    case PART_PANE:
        return point_at_plot(model, view, input, g);
    case PART_LANES:
        return scrub(model, view, g);
    case PART_TIME_AXIS:
        return point_at_time_axis(model, view, g);
    case PART_VIEW:
        return true;
    case PART_LEGEND:
        return g->event.kind == POINTER_PRESS &&
               act_toggle_signal(view, input, g->hit.index / PANE_SIGNALS,
                                 g->hit.index % PANE_SIGNALS);
    case PART_MAP:
        return point_at_map(model, view, g);
    default:
        return point_at_labels(model, view, g);
    }
}
