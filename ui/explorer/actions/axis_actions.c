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

bool act_zoom_between(const explorer_model *model, explorer_view *view,
                      explorer_input *input, double from, double to)
{
    view->window.adrift = true;
    view_show_part(model, view, from, to);
    return act_tell(input, "%.4g to %.4g s; 0 shows all of it, a all values", from, to);
}

bool act_zoom(const explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    double from, to;
    char rest;
    view_window(model, view, &from, &to);

    // all of it, nearer or further, or two instants
    if (strcmp(argument, "all") == 0) {
        view->window = (time_window){0};
    } else if (strcmp(argument, "in") == 0 || strcmp(argument, "out") == 0) {
        double about = model->session.now, factor = 2;
        if (!(about >= from && about <= to)) {
            about = (from + to) / 2;
        }
        if (argument[0] == 'i') {
            factor = 0.5;
        }
        act_zoom_at(model, view, factor, about);
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

static void set_scaling(const explorer_model *model, explorer_view *view, int index,
                        axis_scaling scaling)
{
    pane *p = &view->panes.pane[index];
    value_range now;
    if (scaling == AXIS_FIXED && view_pane_axis(model, view, index, &now)) {
        pane_fix_axis(p, now);
    } else if (scaling != AXIS_FIXED) {
        p->grown = value_range_empty;
        p->scaling = scaling;
    }
}

static bool tell_axis(const explorer_view *view, explorer_input *input, int index)
{
    static const char *const says[AXIS_SCALINGS] = {
        [AXIS_AUTO] = "the range of what is visible",
        [AXIS_GROW] = "the range of all that was seen, it only grows",
        [AXIS_CALM] = "the range of what is visible, but for spikes"};
    const pane *p = &view->panes.pane[index];
    if (p->scaling == AXIS_FIXED) {
        return act_tell(input, "pane %d: from %.4g to %.4g", index + 1, p->fixed.low,
                        p->fixed.high);
    }
    return act_tell(input, "pane %d: %s", index + 1, says[p->scaling]);
}

// Gives a pane's axis what the first `count` words say, one or two.
static bool apply(const explorer_model *model, explorer_view *view, explorer_input *input,
                  int index, char *const words[4], int count)
{
    const char *word = words[0];
    value_range limits;
    if (count == 2) {
        if (!(act_read_number(input, word, &limits.low) &&
              act_read_number(input, words[1], &limits.high))) {
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

    // a kind of scaling by name, or the next one
    const int present = (int)view->panes.pane[index].scaling;
    int scaling = -1;
    if (strcmp(word, "next") == 0) {
        scaling = (present + 1) % AXIS_SCALINGS;
    }
    for (int i = 0; i < AXIS_SCALINGS; i++) {
        if (strcmp(word, axis_scaling_words[i]) == 0) {
            scaling = i;
        }
    }

    // or the axis as it is now, changed
    if (scaling >= 0) {
        set_scaling(model, view, index, (axis_scaling)scaling);
    } else if (strcmp(word, "in") == 0) {
        act_scale_axis(model, view, index, 0.5, 0.5);
    } else if (strcmp(word, "out") == 0) {
        act_scale_axis(model, view, index, 2, 0.5);
    } else if (strcmp(word, "up") == 0) {
        act_shift_axis(model, view, index, 0.25);
    } else if (strcmp(word, "down") == 0) {
        act_shift_axis(model, view, index, -0.25);
    } else {
        return act_refuse(input,
                          "axis takes auto, grow, calm, fixed, in, out, up, down or two "
                          "limits, then a pane (its number, or all)");
    }
    return true;
}

bool act_axis(const explorer_model *model, explorer_view *view, explorer_input *input,
              const char *argument)
{
    char text[LINE_TEXT], *words[4], *end;
    int count = act_split(argument, text, words), index = panes_focused(&view->panes);
    if (count == 0 || count > 3) {
        return apply(model, view, input, 0, (char *[4]){(char[]){""}}, 1);
    }

    // limits are two words, everything else is one; a pane may follow
    int used = 1;
    strtod(words[0], &end);
    if (end != words[0]) {
        used = 2;
    }
    if (count < used) {
        return act_refuse(input, "an axis has two limits, such as 0 2, and then a pane");
    }
    if (count > used + 1) {
        return act_refuse(input, "what is '%s' for?", words[2]);
    }
    if (count == used && index < 0) {
        return act_refuse(input, "no pane of curves is shown");
    }
    if (count > used && !act_read_pane(view, input, words[used], &index)) {
        return false;
    }

    // that pane, or all of them
    for (int i = 0; i < PANES; i++) {
        const bool meant = (i == index || index < 0) && view->panes.pane[i].count > 0;
        if (meant && !apply(model, view, input, i, words, used)) {
            return false;
        }
    }
    return tell_axis(view, input, index < 0 ? 0 : index);
}
