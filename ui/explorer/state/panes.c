#include "ui/explorer/state/panes.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>

// Panes of an arm under a script, and of one with sensors and a controller.
static const char *const scripted_panes[PANES_OF_TABLE][PANE_SIGNALS] = {
    {"force"},
    {"hub_angle", "first_angle", "last_angle"},
    {"hub_velocity", "first_velocity", "last_velocity"},
    {"gap"},
    {"voltage"},
    {"kinetic_energy", "strain_energy", "motor_work"},
    {"viscous_loss", "friction_loss", "impact_loss"},
    {"energy_residual"},
    {"motor_torque", "friction_torque"},
};
static const char *const controlled_panes[PANES_OF_TABLE][PANE_SIGNALS] = {
    {"force", "force_reading", "calculated_force"},
    {"hub_angle", "encoder", "desired_angle", "last_angle"},
    {"hub_velocity", "tachometer", "desired_velocity", "last_velocity"},
    {"gap"},
    {"command", "voltage"},
    {"kinetic_energy", "strain_energy", "motor_work"},
    {"viscous_loss", "friction_loss", "impact_loss"},
    {"controller_mode", "contact", "sticking"},
    {"motor_torque", "friction_torque"},
};

const char *const axis_scaling_words[AXIS_SCALINGS] = {
    [AXIS_AUTO] = "auto", [AXIS_GROW] = "grow", [AXIS_FIXED] = "fixed", [AXIS_CALM] = "calm"};

const value_range value_range_empty = {(double)INFINITY, (double)-INFINITY};

void value_range_widen(value_range *r, value_range other)
{
    r->low = fmin(r->low, other.low);
    r->high = fmax(r->high, other.high);
}

void value_range_add(value_range *r, double value)
{
    if (isfinite(value)) {
        value_range_widen(r, (value_range){value, value});
    }
}

value_range value_range_opened(value_range r)
{
    const double rounding = 1e-12; // a smaller range is shown as a flat line
    return r.high - r.low < rounding ? (value_range){r.low - 0.5, r.high + 0.5} : r;
}

// Shows the first pane that has a signal, or the user's own with it if none has.
static void show_signal(pane_set *set, int signal)
{
    pane *own = &set->pane[PANES_OF_TABLE];

    // the first pane with it
    for (int i = 0; i < PANES; i++) {
        for (int k = 0; k < set->pane[i].count; k++) {
            if (set->pane[i].signals[k] == signal) {
                set->pane[i].shown = true;
                return;
            }
        }
    }

    // no pane has it
    if (own->count < PANE_SIGNALS) {
        own->signals[own->count++] = signal;
        own->grown = value_range_empty;
        own->shown = true;
    }
}

// Hides what was not requested in the panes that hold something that was.
static void hide_others(pane_set *set, const pane_wishes *wishes)
{
    for (int i = 0; i < PANES; i++) {
        pane *p = &set->pane[i];
        unsigned wanted = 0;
        for (int k = 0; k < p->count; k++) {
            for (int j = 0; j < wishes->signal_count; j++) {
                wanted |= (unsigned)(p->signals[k] == wishes->signals[j]) << k;
            }
        }
        p->hidden = wanted != 0 ? ~wanted & ((1u << p->count) - 1) : 0;
    }
}

// Shows the requested panes, and the usual ones as far as there is room.
static void show_panes(pane_set *set, const pane_wishes *wishes)
{
    const char *usual = wishes->controlled ? "1352486" : "1342567";
    int shown = 0;

    // none, then the requested ones
    for (int i = 0; i < PANES; i++) {
        set->pane[i].shown = false;
    }
    set->pane[PANES_OF_TABLE] = (pane){.view = VIEW_TIME};
    for (int i = 0; i < wishes->signal_count; i++) {
        show_signal(set, wishes->signals[i]);
        set->focus = i == 0 ? 0 : set->focus;
    }

    if (wishes->only) {
        hide_others(set, wishes);
    }

    // then the usual ones
    for (int i = 0; i < PANES; i++) {
        shown += set->pane[i].shown;
    }
    for (; *usual != '\0' && shown < wishes->room; usual++) {
        pane *p = &set->pane[*usual - '1'];
        shown += !p->shown;
        p->shown = true;
    }
}

void panes_define(pane_set *set, const pane_wishes *wishes)
{
    const bool same = set->controlled == wishes->controlled;
    set->controlled = wishes->controlled;
    set->room = wishes->room;
    for (int i = 0; i < PANES; i++) {
        pane *p = &set->pane[i];
        p->grown = value_range_empty;

        // the user's own have no names here
        if (i >= PANES_OF_TABLE) {
            continue;
        }
        const char *const *names = set->controlled ? controlled_panes[i] : scripted_panes[i];
        p->count = 0;
        p->hidden = same ? p->hidden : 0;
        for (int j = 0; j < PANE_SIGNALS && names[j] != NULL; j++) {
            int signal = signal_find(names[j]);
            assert(signal >= 0);
            p->signals[p->count++] = signal;
        }
    }
    if (!set->chosen) {
        show_panes(set, wishes);
    }
}

int panes_focused(const pane_set *set)
{
    for (int i = 0; i < PANES; i++) {
        int index = (set->focus + i) % PANES;
        if (set->pane[index].shown) {
            return index;
        }
    }
    return -1;
}

bool pane_has_amounts(const pane *p)
{
    bool found = false;
    for (int k = 0; k < p->count; k++) {
        found = found || !signal_is_state(p->signals[k]);
    }
    return found;
}

bool pane_is_over_time(const pane *p)
{
    return p->view == VIEW_TIME || p->view == VIEW_RESIDUAL;
}

bool pane_is_derived(const pane *p)
{
    bool found = false;
    for (int k = 0; k < p->count; k++) {
        found = found || signal_is_derived(p->signals[k]);
    }
    return found;
}

int panes_add(pane_set *set, const pane *own)
{
    assert(own->count > 0);
    int index = PANES - 1;
    for (int i = PANES - 1; i >= PANES_OF_TABLE; i--) {
        index = set->pane[i].count == 0 || (!set->pane[i].shown && set->pane[index].count > 0)
                    ? i
                    : index;
    }
    set->pane[index] = *own;
    set->pane[index].shown = true;
    set->pane[index].grown = value_range_empty;
    set->chosen = true;
    set->focus = index;
    return index;
}

void pane_fix_axis(pane *p, value_range limits)
{
    double low = limits.low, high = limits.high;
    double least = 1e-9 * fmax(fabs(low), fabs(high)) + 1e-15;
    if (isfinite(low) && isfinite(high) && high - low >= least && high - low < 1e15) {
        p->scaling = AXIS_FIXED;
        p->fixed = limits;
    }
}

// --- the visible part -------------------------------------------------------------------------

#define SHORTEST 1e-6 // visible part of a run [s]

static bool shows_all(const time_window *w)
{
    return w->to <= w->from;
}

void time_window_range(const time_window *w, double duration, double *from, double *to)
{
    *from = shows_all(w) ? 0 : w->from;
    *to = shows_all(w) ? duration : w->to;
}

void time_window_show(time_window *w, double duration, double from, double to)
{
    assert(isfinite(duration));
    double width = fmax(to - from, SHORTEST);
    if (width >= duration) {
        time_window_show_all(w);
        return;
    }
    w->from = fmax(0, fmin(duration - width, from));
    w->to = w->from + width;
}

void time_window_show_all(time_window *w)
{
    *w = (time_window){0};
}

void time_window_follow(time_window *w, double duration, double now)
{
    double from, to;
    time_window_range(w, duration, &from, &to);
    double width = to - from;

    // a shorter run may have ended before a part that was panned to
    if (shows_all(w) || w->adrift) {
        if (w->to > duration) {
            time_window_show(w, duration, from, to);
        }
        return;
    }

    // some of what comes is visible while it plays
    if (now > from + 0.8 * width) {
        from = now - 0.8 * width;
    } else if (now < from + 0.1 * width) {
        from = now - 0.1 * width;
    }
    time_window_show(w, duration, from, from + width);
}

// --- extremes ---------------------------------------------------------------------------------

void extremes_forget(extremes *e)
{
    for (size_t i = 0; i < sizeof e->pairs / sizeof e->pairs[0]; i++) {
        free(e->pairs[i]);
    }
    *e = (extremes){0};
}

// The blocks from `first` on, from the rows of a trace.
static void fill_blocks(double *pairs, size_t first, size_t blocks, const trace *t, int signal)
{
    for (size_t b = first; b < blocks; b++) {
        value_range found = value_range_empty;
        const size_t end = (b + 1) * EXTREMES_BLOCK;
        for (size_t r = b * EXTREMES_BLOCK; r < t->row_count && r < end; r++) {
            value_range_add(&found, signal_value(&t->rows[r], signal));
        }

        // without any value low stays above high
        pairs[2 * b] = found.low;
        pairs[2 * b + 1] = found.high;
    }
}

void extremes_update(extremes *e, unsigned long run, const trace *t, int signal)
{
    assert(run != 0);
    assert(signal >= 0 && signal < EXTREMES_SIGNALS);

    // another run: the blocks of the old one are not valid
    if (e->run != run) {
        extremes_forget(e);
        e->run = run;
    }
    if (extremes_pairs(e, run, t, signal) != NULL) {
        return;
    }

    // the last block may have been begun only: it is done again, and then what is new
    e->blocks = (t->row_count + EXTREMES_BLOCK - 1) / EXTREMES_BLOCK;
    double *pairs = realloc(e->pairs[signal], 2 * e->blocks * sizeof *pairs);
    if (pairs == NULL) {
        free(e->pairs[signal]);
    } else {
        fill_blocks(pairs, e->rows[signal] / EXTREMES_BLOCK, e->blocks, t, signal);
    }
    e->pairs[signal] = pairs;
    e->rows[signal] = pairs != NULL ? t->row_count : 0;
}

const double *extremes_pairs(const extremes *e, unsigned long run, const trace *t, int signal)
{
    assert(signal >= 0 && signal < EXTREMES_SIGNALS);
    bool covers = e->run == run && e->rows[signal] == t->row_count;
    return covers ? e->pairs[signal] : NULL;
}
