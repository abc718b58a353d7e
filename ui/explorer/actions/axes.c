// Actions on the axes of the curves: which part of the run is visible, and which values.
#include "ui/explorer/actions/actions.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- time -------------------------------------------------------------------------------------

void act_zoom_at(explorer_state *st, double factor, double time)
{
    double from, to;
    state_window(st, &from, &to);
    state_show_part(st, time + (from - time) * factor, time + (to - time) * factor);
}

void act_pan_by(explorer_state *st, double seconds)
{
    double from, to;
    state_window(st, &from, &to);
    if (st->window.to > st->window.from) {
        st->window.adrift = true;
        state_show_part(st, from + seconds, to + seconds);
    }
}

bool act_zoom_between(explorer_state *st, double from, double to)
{
    st->window.adrift = true;
    state_show_part(st, from, to);
    return act_tell(st, "%.4g to %.4g s; 0 shows all of it, a all values", from, to);
}

bool act_zoom(explorer_state *st, const char *argument)
{
    double from, to;
    char rest;
    state_window(st, &from, &to);

    // all of it, nearer or further, or two instants
    if (strcmp(argument, "all") == 0) {
        time_window_show_all(&st->window);
    } else if (strcmp(argument, "in") == 0 || strcmp(argument, "out") == 0) {
        double now = st->session.now;
        bool visible = now >= from && now <= to;
        act_zoom_at(st, argument[0] == 'i' ? 0.5 : 2, visible ? now : (from + to) / 2);
    } else if (sscanf(argument, "%lf %lf %c", &from, &to, &rest) == 2 && from < to &&
               isfinite(to - from)) {
        st->window.adrift = true;
        state_show_part(st, from, to);
    } else {
        return act_refuse(st,
                          "zoom takes in, out, all or two instants in seconds, such as 0.2 0.4");
    }
    return true;
}

bool act_pan(explorer_state *st, const char *argument)
{
    double from, to, seconds;
    state_window(st, &from, &to);

    // directions are a quarter of what is visible
    if (strcmp(argument, "left") == 0 || strcmp(argument, "right") == 0) {
        seconds = (argument[0] == 'l' ? -0.25 : 0.25) * (to - from);
    } else {
        if (!act_read_number(st, argument, &seconds)) {
            return false;
        }
    }
    if (st->window.to <= st->window.from) {
        return act_refuse(st, "the whole run is visible, z zooms in");
    }
    act_pan_by(st, seconds);
    state_window(st, &from, &to);
    return act_tell(st, "%.4g to %.4g s, f follows the cursor again", from, to);
}

bool act_follow(explorer_state *st, const char *argument)
{
    (void)argument;
    st->window.adrift = false;
    return act_tell(st, "the curves follow the cursor");
}

// --- values -----------------------------------------------------------------------------------

void act_scale_axis(explorer_state *st, int index, double factor, double share)
{
    value_range now;
    if (state_pane_axis(st, index, &now)) {
        double at = now.high + share * (now.low - now.high);
        value_range scaled = {at + (now.low - at) * factor, at + (now.high - at) * factor};
        pane_fix_axis(&st->panes.pane[index], scaled);
    }
}

void act_shift_axis(explorer_state *st, int index, double share)
{
    value_range now;
    if (state_pane_axis(st, index, &now)) {
        double shift = share * (now.high - now.low);
        pane_fix_axis(&st->panes.pane[index], (value_range){now.low + shift, now.high + shift});
    }
}

static void set_scaling(explorer_state *st, int index, axis_scaling scaling)
{
    pane *p = &st->panes.pane[index];
    value_range now;
    if (scaling == AXIS_FIXED && state_pane_axis(st, index, &now)) {
        pane_fix_axis(p, now);
    } else if (scaling == AXIS_GROW) {
        pane_grow_axis(p);
    } else if (scaling == AXIS_AUTO || scaling == AXIS_CALM) {
        p->scaling = scaling;
    }
}

static bool tell_axis(explorer_state *st, int index)
{
    const pane *p = &st->panes.pane[index];
    const int number = index + 1;
    if (p->scaling == AXIS_FIXED) {
        return act_tell(st, "pane %d: from %.4g to %.4g", number, p->fixed.low, p->fixed.high);
    }
    static const char *const says[AXIS_SCALINGS] = {
        [AXIS_AUTO] = "the range of what is visible",
        [AXIS_GROW] = "the range of all that was seen, it only grows",
        [AXIS_CALM] = "the range of what is visible, but for spikes"};
    return act_tell(st, "pane %d: %s", number, says[p->scaling]);
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

// Fixes a pane's axis to two limits given as text.
static bool set_limits(explorer_state *st, int index, const char *from, const char *to)
{
    value_range limits;
    if (!act_read_number(st, from, &limits.low) || !act_read_number(st, to, &limits.high)) {
        return false;
    }

    // limits the wrong way round, or none at all: NAN is not below anything
    if (!(limits.low < limits.high)) {
        return act_refuse(st, "an axis goes from a lower to a higher value, not from %g to %g",
                          limits.low, limits.high);
    }
    pane_fix_axis(&st->panes.pane[index], limits);
    return true;
}

// Gives a pane's axis what the first `count` words say, one or two.
static bool apply(explorer_state *st, int index, char *const words[4], int count)
{
    const char *word = words[0];
    if (count == 2) {
        return set_limits(st, index, words[0], words[1]);
    }

    // a kind of scaling by name, or the next one
    for (int i = 0; i < AXIS_SCALINGS; i++) {
        if (strcmp(word, axis_scaling_words[i]) == 0) {
            set_scaling(st, index, (axis_scaling)i);
            return true;
        }
    }
    if (strcmp(word, "next") == 0) {
        int next = (int)(st->panes.pane[index].scaling + 1) % AXIS_SCALINGS;
        set_scaling(st, index, (axis_scaling)next);
        return true;
    }

    // the axis as it is now, changed
    if (strcmp(word, "in") == 0 || strcmp(word, "out") == 0) {
        act_scale_axis(st, index, word[0] == 'i' ? 0.5 : 2, 0.5);
    } else if (strcmp(word, "up") == 0 || strcmp(word, "down") == 0) {
        act_shift_axis(st, index, word[0] == 'u' ? 0.25 : -0.25);
    } else {
        return act_refuse(st,
                          "axis takes auto, grow, calm, fixed, in, out, up, down or two limits, "
                          "then a pane (its number, or all)");
    }
    return true;
}

// Reads the pane of a word, -1 for all of them.
static bool read_pane(explorer_state *st, const char *word, int *index)
{
    char *end;
    long number = strtol(word, &end, 10);
    *index = -1;

    // all panes need no number
    if (strcmp(word, "all") == 0) {
        return true;
    }

    // numbered as the keys are, and on
    if (*end != '\0' || end == word || number < 1 || number > PANES) {
        return act_refuse(st, "'%s' is no pane: 1 to %d, or all", word, PANES);
    }
    *index = (int)number - 1;

    // an empty pane has no axis
    if (st->panes.pane[*index].count == 0) {
        return act_refuse(st, "pane %s is empty, :trace SIGNAL... fills it", word);
    }
    return true;
}

bool act_axis(explorer_state *st, const char *argument)
{
    char text[LINE_TEXT], *words[4], *end;
    snprintf(text, sizeof text, "%s", argument);
    int count = split(text, words), index = panes_focused(&st->panes);
    if (count == 0 || count > 3) {
        char none[] = "";
        return apply(st, 0, (char *[4]){none}, 1);
    }

    // limits are two words, everything else is one; a pane may follow
    bool limits = (strtod(words[0], &end), end != words[0]);
    int used = limits ? 2 : 1;
    if (count < used) {
        return act_refuse(st, "an axis has two limits, such as 0 2, and then a pane");
    }
    if (count > used + 1) {
        return act_refuse(st, "what is '%s' for?", words[2]);
    }
    if (count == used && index < 0) {
        return act_refuse(st, "no pane of curves is shown");
    }
    if (count > used) {
        if (!read_pane(st, words[used], &index)) {
            return false;
        }
    }

    // that pane, or all of them
    for (int i = 0; i < PANES; i++) {
        if ((i == index || index < 0) && st->panes.pane[i].count > 0) {
            if (!apply(st, i, words, used)) {
                return false;
            }
        }
    }
    return tell_axis(st, index < 0 ? 0 : index);
}

// --- panes ------------------------------------------------------------------------------------

bool act_focus(explorer_state *st, const char *argument)
{
    (void)argument;
    int focused = panes_focused(&st->panes);
    if (focused < 0) {
        return act_refuse(st, "no pane of curves is shown, 1 to 9 show them");
    }
    st->panes.focus = (focused + 1) % PANES;
    st->panes.focus = panes_focused(&st->panes);
    return true;
}

bool act_toggle_signal(explorer_state *st, int index, int k)
{
    assert(st != NULL && index >= 0 && index < PANES && k >= 0 && k < PANE_SIGNALS);
    pane *p = &st->panes.pane[index];
    p->hidden ^= 1u << k;
    p->grown = value_range_empty;
    return act_tell(st, "%s is %s", signal_table[p->signals[k]].name,
                    p->hidden >> k & 1 ? "hidden (K or a click on its legend shows it)" : "shown");
}

// One signal after the other is hidden, from the last to the first, then all are shown.
bool act_hide_signal(explorer_state *st, const char *argument)
{
    char text[LINE_TEXT], *words[4] = {argument[0] == '\0' ? text : NULL};
    int index = panes_focused(&st->panes);
    snprintf(text, sizeof text, "%s", argument);
    if (split(text, words) == 2 && !read_pane(st, words[1], &index)) {
        return false;
    }
    const int signal = signal_find_any(words[0]);
    if (index < 0) {
        return act_refuse(st, "no pane of curves is shown, 1 to 9 show them");
    }
    pane *p = &st->panes.pane[index];
    if (strcmp(words[0], "all") == 0) {
        p->hidden = 0;
        return true;
    }

    // by name
    for (int k = 0; k < p->count && argument[0] != '\0'; k++) {
        if (p->signals[k] == signal) {
            return act_toggle_signal(st, index, k);
        }
    }
    if (argument[0] != '\0') {
        return act_refuse(st, "the pane in focus has no signal '%.60s' (w: next pane)", argument);
    }

    // the one before that which is hidden; one that is alone stays
    int next = p->count - 1;
    for (int k = 0; k < p->count; k++) {
        next = p->hidden >> k & 1 ? k - 1 : next;
    }
    p->hidden = 0;
    return next >= 0 && p->count > 1 ? act_toggle_signal(st, index, next)
                                     : act_tell(st, "all signals of the pane are shown");
}

// Reads a signal and a value, or off.
static bool read_bound(explorer_state *st, const char *argument, const char *command,
                       solved_limit *bound)
{
    char text[LINE_TEXT], *words[4];
    *bound = (solved_limit){.signal = -1};
    snprintf(text, sizeof text, "%s", argument);
    if (split(text, words) == 2 && (bound->signal = signal_find_any(words[0])) >= 0) {
        return act_read_number(st, words[1], &bound->bound);
    }
    return strcmp(argument, "off") == 0 ||
           act_refuse(st, "%s takes a signal and a value, such as force 2, or off", command);
}

bool act_set_limit(explorer_state *st, const char *argument)
{
    solved_limit limit;
    if (!read_bound(st, argument, "limit", &limit)) {
        return false;
    }
    st->limit = limit;
    return true;
}

bool act_set_band(explorer_state *st, const char *argument)
{
    solved_limit band;
    if (!read_bound(st, argument, "band", &band)) {
        return false;
    }
    if (band.signal >= 0 && !(band.bound > 0)) {
        return act_refuse(st, "a band has a tolerance above 0");
    }
    st->band = band;
    if (band.signal < 0 || !st->session.has_other) {
        return act_tell(st, "%s", band.signal < 0 ? "no band" : "b pins the run that it is round");
    }

    // where the present run leaves it
    const session *s = &st->session;
    run_difference d = {.on = true};
    difference_update(&d, 1, &s->run.trace, &s->other.trace);
    const bool told = signal_is_derived(band.signal) || signal_is_state(band.signal);
    const double first = told ? -1 : difference_first_beyond(&d, band.signal, band.bound);
    difference_finish(&d);
    const char *name = st->pinned.runs[st->pinned.baseline].name;
    return told        ? act_tell(st, "the band is round '%s'", name)
           : first < 0 ? act_tell(st, "this run stays within the band round '%s'", name)
                       : act_tell(st, "this run leaves the band round '%s' at %.5f s", name, first);
}

bool act_alone(explorer_state *st, const char *argument)
{
    (void)argument;
    st->panes.alone = !st->panes.alone;
    return true;
}
