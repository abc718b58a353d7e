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

const value_range value_range_empty = {(double)INFINITY, (double)-INFINITY};

value_range value_range_opened(value_range r)
{
    // a smaller range than rounding is shown as a flat line
    const double size = fmax(fabs(r.low), fabs(r.high));
    if (r.high - r.low >= fmax(1e-12, 1e-15 * size)) {
        return r;
    }
    const double half = fmax(0.5, 1e-12 * size);
    return (value_range){r.low - half, r.high + half};
}

// Shows the first pane that has a signal, or the user's own with it if none has.
static void show_signal(pane_set *set, int signal)
{
    for (int i = 0; i < PANES; i++) {
        for (int k = 0; k < set->pane[i].count; k++) {
            if (set->pane[i].signals[k] == signal) {
                set->pane[i].shown = true;
                return;
            }
        }
    }

    // no pane has it
    pane *own = &set->pane[PANES_OF_TABLE];
    if (own->count < PANE_SIGNALS) {
        own->signals[own->count++] = signal;
        own->shown = true;
    }
}

static bool is_wanted(const pane_wishes *wishes, int signal)
{
    for (int i = 0; i < wishes->signal_count; i++) {
        if (wishes->signals[i] == signal) {
            return true;
        }
    }
    return false;
}

// Hides what was not requested in the panes that hold something that was.
static void hide_others(pane_set *set, const pane_wishes *wishes)
{
    for (int i = 0; i < PANES; i++) {
        pane *p = &set->pane[i];
        unsigned others = 0;
        bool any_wanted = false;
        for (int k = 0; k < p->count; k++) {
            if (is_wanted(wishes, p->signals[k])) {
                any_wanted = true;
            } else {
                others |= 1u << k;
            }
        }
        p->hidden = any_wanted ? others : 0;
    }
}

// Shows the requested panes, and the usual ones as far as there is room.
static void show_panes(pane_set *set, const pane_wishes *wishes)
{
    // none, then the requested ones
    for (int i = 0; i < PANES; i++) {
        set->pane[i].shown = false;
    }
    set->pane[PANES_OF_TABLE] = (pane){.view = VIEW_TIME};
    for (int i = 0; i < wishes->signal_count; i++) {
        show_signal(set, wishes->signals[i]);
    }
    if (wishes->signal_count > 0) {
        set->focus = 0;
    }
    if (wishes->only) {
        hide_others(set, wishes);
    }

    // then the usual ones, by their numbers
    int shown = 0;
    for (int i = 0; i < PANES; i++) {
        if (set->pane[i].shown) {
            shown++;
        }
    }
    const char *usual = wishes->controlled ? "1532486" : "1432567";
    for (; *usual != '\0' && shown < wishes->room; usual++) {
        pane *p = &set->pane[*usual - '1'];
        if (!p->shown) {
            p->shown = true;
            shown++;
        }
    }
}

// Gives a pane the signals of some names, of which the last may be NULL.
static void set_signals(pane *p, const char *const names[PANE_SIGNALS])
{
    p->count = 0;
    for (int k = 0; k < PANE_SIGNALS && names[k] != NULL; k++) {
        const int signal = signal_find(names[k]);
        assert(signal >= 0);
        p->signals[p->count++] = signal;
    }
}

void panes_define(pane_set *set, const pane_wishes *wishes)
{
    const bool same = set->controlled == wishes->controlled;
    set->controlled = wishes->controlled;
    set->room = wishes->room;

    // those of the table; the user's own keep their signals
    for (int i = 0; i < PANES_OF_TABLE; i++) {
        if (set->controlled) {
            set_signals(&set->pane[i], controlled_panes[i]);
        } else {
            set_signals(&set->pane[i], scripted_panes[i]);
        }
        if (!same) {
            set->pane[i].hidden = 0;
        }
    }
    if (!set->chosen) {
        show_panes(set, wishes);
    }
}

int panes_focused(const pane_set *set)
{
    for (int i = 0; i < PANES; i++) {
        const int index = (set->focus + i) % PANES;
        if (set->pane[index].shown) {
            return index;
        }
    }
    return -1;
}

bool pane_has_amounts(const pane *p)
{
    for (int k = 0; k < p->count; k++) {
        if (!signal_is_state(p->signals[k])) {
            return true;
        }
    }
    return false;
}

bool pane_is_over_time(const pane *p)
{
    return p->view == VIEW_TIME || p->view == VIEW_RESIDUAL;
}

bool pane_is_derived(const pane *p)
{
    for (int k = 0; k < p->count; k++) {
        if (signal_is_derived(p->signals[k])) {
            return true;
        }
    }
    return false;
}

// The place for another pane of the user's: the first that is empty, else the first that
// is hidden, else the last.
static int place_of_own(const pane_set *set)
{
    for (int i = PANES_OF_TABLE; i < PANES; i++) {
        if (set->pane[i].count == 0) {
            return i;
        }
    }
    for (int i = PANES_OF_TABLE; i < PANES; i++) {
        if (!set->pane[i].shown) {
            return i;
        }
    }
    return PANES - 1;
}

int panes_add(pane_set *set, const pane *own)
{
    assert(own->count > 0);
    const int index = place_of_own(set);
    set->pane[index] = *own;
    set->pane[index].shown = true;
    set->chosen = true;
    set->focus = index;
    return index;
}

void pane_fix_axis(pane *p, value_range limits)
{
    const double size = fmax(fabs(limits.low), fabs(limits.high));
    const double height = limits.high - limits.low;
    if (isfinite(size) && height >= 1e-9 * size + 1e-15 && height < 1e15) {
        p->is_fixed = true;
        p->fixed = limits;
    }
}
