#include "ui/explorer/state/panes.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

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

const char *const axis_scaling_words[AXIS_SCALINGS] = {[AXIS_AUTO] = "auto",
                                                       [AXIS_GROW] = "grow",
                                                       [AXIS_FIXED] = "fixed",
                                                       [AXIS_CALM] = "calm"};

const value_range value_range_empty = {(double)INFINITY, (double)-INFINITY};

value_range value_range_opened(value_range r)
{
    // a smaller range than rounding is shown as a flat line
    const double size = fmax(fabs(r.low), fabs(r.high)), half = fmax(0.5, 1e-12 * size);
    const bool flat = r.high - r.low < fmax(1e-12, 1e-15 * size);
    if (flat) {
        return (value_range){r.low - half, r.high + half};
    }
    return r;
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
        if (wanted != 0) {
            p->hidden = ~wanted & ((1u << p->count) - 1);
        } else {
            p->hidden = 0;
        }
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
        if (i == 0) {
            set->focus = 0;
        }
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
        const char *const *names =
            set->controlled ? controlled_panes[i] : scripted_panes[i];
        p->count = 0;
        if (!same) {
            p->hidden = 0;
        }
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
    int i = 0;
    while (i < PANES && !set->pane[(set->focus + i) % PANES].shown) {
        i++;
    }
    if (i < PANES) {
        return (set->focus + i) % PANES;
    }
    return -1;
}

bool pane_has_amounts(const pane *p)
{
    bool states = true;
    for (int k = 0; k < p->count; k++) {
        states = states && signal_is_state(p->signals[k]);
    }
    return !states;
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
        const bool hidden = !set->pane[i].shown && set->pane[index].count > 0;
        if (set->pane[i].count == 0 || hidden) {
            index = i;
        }
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
