// Actions on the axes of the curves: which part of the run is visible, and which values.
#include "ui/explorer/actions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- time -------------------------------------------------------------------------------------

void lab_zoom_at(lab *l, double factor, double time)
{
    double from, to;
    lab_window(l, &from, &to);
    lab_show_part(l, time + (from - time) * factor, time + (to - time) * factor);
}

void lab_pan_by(lab *l, double seconds)
{
    double from, to;
    lab_window(l, &from, &to);
    if (l->to > l->from) {
        l->adrift = true;
        lab_show_part(l, from + seconds, to + seconds);
    }
}

bool act_zoom(lab *l, const char *argument)
{
    double from, to;
    char rest;
    lab_window(l, &from, &to);
    if (strcmp(argument, "all") == 0) {
        l->from = l->to = 0;
        l->adrift = false;
    } else if (strcmp(argument, "in") == 0 || strcmp(argument, "out") == 0) {
        double now = l->session.now;
        bool visible = now >= from && now <= to;
        lab_zoom_at(l, argument[0] == 'i' ? 0.5 : 2, visible ? now : (from + to) / 2);
    } else if (sscanf(argument, "%lf %lf %c", &from, &to, &rest) == 2 && from < to &&
               isfinite(to - from)) {
        l->adrift = true;
        lab_show_part(l, from, to);
    } else {
        lab_say(l, true, "zoom takes in, out, all or two instants in seconds, such as 0.2 0.4");
        return false;
    }
    return true;
}

bool act_pan(lab *l, const char *argument)
{
    double from, to, seconds;
    lab_window(l, &from, &to);
    if (strcmp(argument, "left") == 0 || strcmp(argument, "right") == 0) {
        seconds = (argument[0] == 'l' ? -0.25 : 0.25) * (to - from);
    } else if (!lab_take_number(l, argument, &seconds)) {
        return false;
    }
    if (l->to <= l->from) {
        lab_say(l, true, "the whole run is visible, z zooms in");
        return false;
    }
    lab_pan_by(l, seconds);
    lab_window(l, &from, &to);
    lab_say(l, false, "%.4g to %.4g s, f follows the cursor again", from, to);
    return true;
}

bool act_follow(lab *l, const char *argument)
{
    (void)argument;
    l->adrift = false;
    lab_say(l, false, "the curves follow the cursor");
    return true;
}

// --- values -----------------------------------------------------------------------------------

// Fixes a pane's axis to limits; they are widened where they would be one.
static void fix_axis(lab_pane *pane, double low, double high)
{
    double least = 1e-9 * fmax(fabs(low), fabs(high)) + 1e-15;
    if (isfinite(low) && isfinite(high) && high - low >= least && high - low < 1e15) {
        pane->axis = AXIS_FIXED;
        pane->low = low;
        pane->high = high;
    }
}

void lab_scale_axis(lab *l, int index, double factor, double share)
{
    lab_pane *pane = &l->panes[index];
    double low, high;
    if (lab_pane_axis(l, index, &low, &high)) {
        double at = high + share * (low - high);
        fix_axis(pane, at + (low - at) * factor, at + (high - at) * factor);
    }
}

void lab_shift_axis(lab *l, int index, double share)
{
    double low, high;
    if (lab_pane_axis(l, index, &low, &high)) {
        double way = share * (high - low);
        fix_axis(&l->panes[index], low + way, high + way);
    }
}

static void set_mode(lab *l, int index, axis_mode mode)
{
    lab_pane *pane = &l->panes[index];
    double low, high;
    if (mode == AXIS_FIXED && lab_pane_axis(l, index, &low, &high)) {
        fix_axis(pane, low, high);
    } else if (mode == AXIS_GROW) {
        pane->grown_low = (double)INFINITY;
        pane->grown_high = (double)-INFINITY;
        pane->axis = mode;
    } else if (mode == AXIS_AUTO) {
        pane->axis = mode;
    }
}

static void tell_axis(lab *l, int index)
{
    const lab_pane *pane = &l->panes[index];
    if (pane->axis == AXIS_FIXED) {
        lab_say(l, false, "pane %d: from %.4g to %.4g", (index + 1) % 10, pane->low, pane->high);
    } else {
        lab_say(l, false, "pane %d: %s", (index + 1) % 10,
                pane->axis == AXIS_AUTO ? "the range of what is visible"
                                        : "the range of all that was seen, it only grows");
    }
}

// The words of an argument; returns how many there are.
static int split(char *text, char *words[4])
{
    int count = 0;
    for (char *word, *rest = text; (word = strtok_r(rest, " \t", &rest)) != NULL; count++) {
        if (count < 4) {
            words[count] = word;
        }
    }
    return count;
}

// Gives a pane's axis what the first `count` words say; false with a message if that is nothing.
static bool apply(lab *l, int index, char *const words[4], int count)
{
    static const char *const modes[] = {"auto", "grow", "fixed"};
    double low, high;
    const char *word = words[0];
    if (count == 2) {
        if (!lab_take_number(l, words[0], &low) || !lab_take_number(l, words[1], &high)) {
            return false;
        }
        if (!(low < high)) {
            lab_say(l, true, "an axis goes from a lower to a higher value, not from %g to %g", low,
                    high);
            return false;
        }
        fix_axis(&l->panes[index], low, high);
        return true;
    }
    for (int i = 0; i < 3; i++) {
        if (strcmp(word, modes[i]) == 0) {
            set_mode(l, index, (axis_mode)i);
            return true;
        }
    }
    if (strcmp(word, "next") == 0) {
        set_mode(l, index, (axis_mode)((l->panes[index].axis + 1) % 3));
    } else if (strcmp(word, "in") == 0 || strcmp(word, "out") == 0) {
        lab_scale_axis(l, index, word[0] == 'i' ? 0.5 : 2, 0.5);
    } else if (strcmp(word, "up") == 0 || strcmp(word, "down") == 0) {
        lab_shift_axis(l, index, word[0] == 'u' ? 0.25 : -0.25);
    } else {
        lab_say(l, true,
                "axis takes auto, grow, fixed, in, out, up, down or two limits, then a pane "
                "(1 to 9, all)");
        return false;
    }
    return true;
}

// The pane of a word, -1 for all of them; false with a message if it is none.
static bool take_pane(lab *l, const char *word, int *index)
{
    char *end;
    long number = strtol(word, &end, 10);
    *index = -1;
    if (strcmp(word, "all") == 0) {
        return true;
    }
    if (*end != '\0' || end == word || number < 0 || number > LAB_PANES) {
        lab_say(l, true, "'%s' is no pane: 1 to 9, 0 for your own, or all", word);
        return false;
    }
    *index = (int)(number + LAB_PANES - 1) % LAB_PANES;
    if (l->panes[*index].count == 0) {
        lab_say(l, true, "pane %s is empty, :trace SIGNAL... fills it", word);
        return false;
    }
    return true;
}

bool act_axis(lab *l, const char *argument)
{
    char text[LAB_TEXT], *words[4], *end;
    snprintf(text, sizeof text, "%s", argument);
    int count = split(text, words), index = lab_focused_pane(l);
    if (count == 0 || count > 3) {
        char none[] = "";
        return apply(l, 0, (char *[4]){none}, 1);
    }
    // limits are two words, everything else is one; a pane may follow
    bool limits = (strtod(words[0], &end), end != words[0]);
    int used = limits ? 2 : 1;
    if (count < used) {
        lab_say(l, true, "an axis has two limits, such as 0 2, and then a pane");
        return false;
    }
    if (count > used + 1) {
        lab_say(l, true, "what is '%s' for?", words[2]);
        return false;
    }
    if (count > used && !take_pane(l, words[used], &index)) {
        return false;
    }
    if (count == used && index < 0) {
        lab_say(l, true, "no pane of curves is shown");
        return false;
    }
    for (int i = 0; i < LAB_PANES; i++) {
        if ((i == index || index < 0) && l->panes[i].count > 0 && !apply(l, i, words, used)) {
            return false;
        }
    }
    tell_axis(l, index < 0 ? 0 : index);
    return true;
}

// --- panes ------------------------------------------------------------------------------------

bool act_focus(lab *l, const char *argument)
{
    (void)argument;
    int pane = lab_focused_pane(l);
    if (pane < 0) {
        lab_say(l, true, "no pane of curves is shown, 1 to 9 show them");
        return false;
    }
    l->focus = (pane + 1) % LAB_PANES;
    l->focus = lab_focused_pane(l);
    return true;
}

bool act_alone(lab *l, const char *argument)
{
    (void)argument;
    l->alone = !l->alone;
    return true;
}
