// What the mouse does: each part of the screen takes clicks, drags and the wheel in its own way.
#include <limits.h>
#include <math.h>

#include "ui/explorer/actions.h"

enum { WHEEL_LINES = 3 };

// The uppermost part at a cell; PART_NONE with no extent if there is none.
static lab_spot part_at(const lab *l, int x, int y)
{
    for (int i = l->spot_count; i-- > 0;) {
        const lab_spot *s = &l->spots[i];
        if (x >= s->x && x < s->x + s->width && y >= s->y && y < s->y + s->height) {
            return *s;
        }
    }
    return (lab_spot){.part = PART_NONE};
}

static double time_at(const lab *l, int x)
{
    double from, to;
    lab_window(l, &from, &to);
    double share = (x - l->plot_x + 0.5) / (l->plot_width > 0 ? l->plot_width : 1);
    return from + (to - from) * fmax(0, fmin(1, share));
}

// --- the parts --------------------------------------------------------------------------------

static void scrub(lab *l, int x)
{
    l->playing = false;
    session_seek(&l->session, time_at(l, x));
}

// The first click selects a line of the list, another one on it opens it.
static void press_in_list(lab *l, const lab_spot *s, int y)
{
    int line = s->index + y - s->y;
    for (int i = 0; i < l->name_count; i++) {
        if (!lab_listed(l, i) || line-- != 0) {
            continue;
        }
        if (i == l->scroll) {
            l->filtering = false;
            lab_key(l, KEY_CODE_ENTER);
        }
        l->scroll = i;
        return;
    }
}

static void press_in_log(lab *l, const lab_spot *s, int y)
{
    const lab_log *log = lab_run_log(l);
    size_t index = (size_t)(s->index + y - s->y);
    if (index < log->count && log->entries[index].time <= l->session.seen) {
        l->playing = false;
        session_seek(&l->session, log->entries[index].time);
        l->log_scroll = 0;
    }
}

static void press(lab *l, pointer_event p)
{
    lab_spot s = part_at(l, p.x, p.y);
    l->grabbed = s;
    l->grabbed_x = p.x;
    l->grabbed_y = p.y;
    l->dragged = false;
    l->holding = true;
    if (l->overlay != OVERLAY_NONE && s.part < PART_HELP) {
        l->overlay = OVERLAY_NONE;
        l->filtering = false;
        l->grabbed.part = PART_HELP; // what is dragged now belongs to the page that closed
    } else if (s.part == PART_LIST) {
        press_in_list(l, &s, p.y);
    } else if (s.part == PART_LOG) {
        press_in_log(l, &s, p.y);
    } else if (s.part == PART_SLIDER) {
        lab_hold_slider(l, &s, p.x);
    } else if (s.part == PART_PARAMETER) {
        l->parameter = s.index;
    } else if (s.part == PART_LABELS) {
        l->focus = s.index;
    } else if (s.part == PART_CURVES) {
        scrub(l, p.x);
    } else if (s.part == PART_NONE) {
        lab_click(l, p.x, p.y);
    }
}

static void drag(lab *l, pointer_event p)
{
    if (!l->holding) {
        press(l, p);
    }
    const lab_spot *s = &l->grabbed;
    int across = p.x - l->grabbed_x, up = l->grabbed_y - p.y;
    double from, to;
    l->dragged |= across != 0 || up != 0;
    l->grabbed_x = p.x;
    l->grabbed_y = p.y;
    if (s->part == PART_CURVES) {
        scrub(l, p.x);
    } else if (s->part == PART_SLIDER) {
        lab_hold_slider(l, s, p.x);
    } else if (s->part == PART_TIME_AXIS && s->width > 0) {
        lab_window(l, &from, &to);
        lab_pan_by(l, -across * (to - from) / s->width);
    } else if (s->part == PART_LABELS && s->height > 0 && up != 0) {
        lab_shift_axis(l, s->index, -(double)up / s->height);
    } else if (s->part == PART_NONE) {
        lab_click(l, p.x, p.y);
    }
}

static void turn_wheel(lab *l, pointer_event p)
{
    int direction = p.kind == POINTER_WHEEL_UP ? -1 : 1;
    double from, to;
    lab_spot s = part_at(l, p.x, p.y);
    if (l->prompting || (l->overlay != OVERLAY_NONE && s.part < PART_HELP)) {
        return;
    }
    lab_window(l, &from, &to);
    switch (s.part) {
    case PART_CURVES:
        if (p.shift) {
            lab_pan_by(l, 0.1 * direction * (to - from));
        } else {
            lab_zoom_at(l, direction < 0 ? 0.8 : 1.25, time_at(l, p.x));
        }
        break;
    case PART_TIME_AXIS:
        if (p.control) {
            lab_zoom_at(l, direction < 0 ? 0.8 : 1.25, time_at(l, p.x));
        } else {
            lab_pan_by(l, 0.1 * direction * (to - from));
        }
        break;
    case PART_LABELS:
        lab_scale_axis(l, s.index, direction < 0 ? 0.8 : 1.25,
                       (p.y - s.y + 0.5) / (s.height > 0 ? s.height : 1));
        break;
    case PART_SLIDER:
        lab_turn_slider(l, s.index, direction);
        break;
    case PART_LOG:
        l->log_scroll += direction * WHEEL_LINES;
        break;
    case PART_VALUES:
        l->value_scroll += direction * WHEEL_LINES;
        break;
    case PART_HELP:
    case PART_LIST:
    case PART_COMPARISON:
        for (int i = 0; i < WHEEL_LINES; i++) {
            lab_wheel(l, direction);
        }
        break;
    default:
        lab_wheel(l, direction);
    }
}

void lab_point(lab *l, pointer_event p)
{
    switch (p.kind) {
    case POINTER_PRESS:
        press(l, p);
        break;
    case POINTER_DRAG:
        drag(l, p);
        break;
    case POINTER_RELEASE:
        // a quick click may come without its press
        if (!l->holding) {
            press(l, p);
        }
        // a click on the time axis that was no drag
        if (l->grabbed.part == PART_TIME_AXIS && !l->dragged) {
            scrub(l, p.x);
        }
        l->grabbed.part = PART_NONE;
        l->holding = false;
        lab_drop_slider(l);
        break;
    default:
        turn_wheel(l, p);
    }
}
