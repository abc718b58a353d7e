// Actions on the axes of the curves: which part of the run is visible, and which values.
#include "ui/explorer/actions/actions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- time ------------------------------------------------------------------------------

void act_zoom_at(const explorer_model *model, explorer_view *view, double factor,
                 double time)
{
    double from, to;
    view_window(model, view, &from, &to);
    view_show_part(model, view, time + (from - time) * factor,
                   time + (to - time) * factor);
}

void act_pan_by(const explorer_model *model, explorer_view *view, double seconds)
{
    double from, to;
    view_window(model, view, &from, &to);
    if (view->window.to > view->window.from) {
        view->window.adrift = true;
        view_show_part(model, view, from + seconds, to + seconds);
    }
}

// Zooms in or out about the cursor, or the middle of what is visible if the cursor is
// outside.
static void zoom_by(const explorer_model *model, explorer_view *view, double factor)
{
    double from, to, about = model->session.now;
    view_window(model, view, &from, &to);
    if (about < from || about > to) {
        about = (from + to) / 2;
    }
    act_zoom_at(model, view, factor, about);
}

bool act_zoom(const explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    double from, to;
    char rest;

    // all of it, nearer or further, or two instants
    if (strcmp(argument, "all") == 0) {
        view->window = (time_window){0};
    } else if (strcmp(argument, "in") == 0) {
        zoom_by(model, view, 0.5);
    } else if (strcmp(argument, "out") == 0) {
        zoom_by(model, view, 2);
    } else if (sscanf(argument, "%lf %lf %c", &from, &to, &rest) == 2 && from < to &&
               isfinite(to - from)) {
        view->window.adrift = true;
        view_show_part(model, view, from, to);
    } else {
        return act_refuse(
            input, "zoom takes in, out, all or two instants in seconds, such as 0.2 0.4");
    }
    return true;
}

bool act_pan(const explorer_model *model, explorer_view *view, explorer_input *input,
             const char *argument)
{
    double from, to, seconds;
    view_window(model, view, &from, &to);

    // directions are a quarter of what is visible
    if (strcmp(argument, "left") == 0) {
        seconds = -(to - from) / 4;
    } else if (strcmp(argument, "right") == 0) {
        seconds = (to - from) / 4;
    } else if (!act_read_number(input, argument, &seconds)) {
        return false;
    }
    if (view->window.to <= view->window.from) {
        return act_refuse(input, "the whole run is visible, z zooms in");
    }
    act_pan_by(model, view, seconds);
    view_window(model, view, &from, &to);
    return act_tell(input, "%.4g to %.4g s, f follows the cursor again", from, to);
}

bool act_follow(explorer_view *view, explorer_input *input)
{
    view->window.adrift = false;
    return act_tell(input, "the curves follow the cursor");
}

// --- values ----------------------------------------------------------------------------

void act_scale_axis(const explorer_model *model, explorer_view *view, int index,
                    double factor, double share)
{
    value_range now;
    if (view_pane_axis(model, view, index, &now)) {
        double at = now.high + share * (now.low - now.high);
        value_range scaled = {at + (now.low - at) * factor,
                              at + (now.high - at) * factor};
        pane_fix_axis(&view->panes.pane[index], scaled);
    }
}

void act_shift_axis(const explorer_model *model, explorer_view *view, int index,
                    double share)
{
    value_range now;
    if (view_pane_axis(model, view, index, &now)) {
        double shift = share * (now.high - now.low);
        pane_fix_axis(&view->panes.pane[index],
                      (value_range){now.low + shift, now.high + shift});
    }
}

// Keeps the present range of a pane's axis, or lets it follow what is visible.
static void fix_axis(const explorer_model *model, explorer_view *view, int index,
                     bool fixed)
{
    pane *p = &view->panes.pane[index];
    value_range now;
    if (!fixed) {
        p->is_fixed = false;
    } else if (view_pane_axis(model, view, index, &now)) {
        pane_fix_axis(p, now);
    }
}

// Says what a pane's axis of values goes by.
static bool tell_axis(const explorer_view *view, explorer_input *input, int index)
{
    const pane *p = &view->panes.pane[index];
    if (p->is_fixed) {
        return act_tell(input, "pane %d: from %.4g to %.4g", index + 1, p->fixed.low,
                        p->fixed.high);
    }
    return act_tell(input, "pane %d: the range of what is visible", index + 1);
}

static bool refuse_axis(explorer_input *input)
{
    return act_refuse(input, "axis takes auto, fixed, next, in, out, up, down or two "
                             "limits, then a pane (its number, or all)");
}

// Gives a pane's axis two limits.
static bool set_limits(explorer_view *view, explorer_input *input, int index,
                       const char *low, const char *high)
{
    value_range limits;
    if (!act_read_number(input, low, &limits.low) ||
        !act_read_number(input, high, &limits.high)) {
        return false;
    }
    if (!(limits.low < limits.high)) {
        return act_refuse(
            input, "an axis goes from a lower to a higher value, not from %g to %g",
            limits.low, limits.high);
    }
    pane_fix_axis(&view->panes.pane[index], limits);
    return true;
}

// Scales or shifts a pane's axis as a word says.
static bool change_axis(const explorer_model *model, explorer_view *view,
                        explorer_input *input, int index, const char *word)
{
    if (strcmp(word, "auto") == 0) {
        fix_axis(model, view, index, false);
    } else if (strcmp(word, "fixed") == 0) {
        fix_axis(model, view, index, true);
    } else if (strcmp(word, "next") == 0) {
        fix_axis(model, view, index, !view->panes.pane[index].is_fixed);
    } else if (strcmp(word, "in") == 0) {
        act_scale_axis(model, view, index, 0.5, 0.5);
    } else if (strcmp(word, "out") == 0) {
        act_scale_axis(model, view, index, 2, 0.5);
    } else if (strcmp(word, "up") == 0) {
        act_shift_axis(model, view, index, 0.25);
    } else if (strcmp(word, "down") == 0) {
        act_shift_axis(model, view, index, -0.25);
    } else {
        return refuse_axis(input);
    }
    return true;
}

bool act_axis(const explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    char text[LINE_TEXT], *words[4];
    const int count = act_split(argument, text, words);
    if (count == 0 || count > 3) {
        return refuse_axis(input);
    }

    // limits are two words, everything else is one; a pane may follow
    char *end;
    strtod(words[0], &end);
    const bool has_limits = end != words[0];
    const int used = has_limits ? 2 : 1;
    if (count < used) {
        return act_refuse(input, "an axis has two limits, such as 0 2, and then a pane");
    }
    if (count > used + 1) {
        return act_refuse(input, "what is '%s' for?", words[2]);
    }

    // the pane that is named, or the one in focus
    int index = panes_focused(&view->panes);
    if (count == used && index < 0) {
        return act_refuse(input, "no pane of curves is shown");
    }
    if (count > used && !act_read_pane(view, input, words[used], &index)) {
        return false;
    }

    // that one, or all of them
    for (int i = 0; i < PANES; i++) {
        if ((i != index && index >= 0) || view->panes.pane[i].count == 0) {
            continue;
        }
        bool done;
        if (has_limits) {
            done = set_limits(view, input, i, words[0], words[1]);
        } else {
            done = change_axis(model, view, input, i, words[0]);
        }
        if (!done) {
            return false;
        }
    }
    if (index < 0) {
        return tell_axis(view, input, 0);
    }
    return tell_axis(view, input, index);
}
