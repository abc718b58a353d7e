#include "ui/explorer/state/panes.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/tables/signals.h"

// Panes of an arm under a script, and of one with sensors and a controller.
static const char *const scripted_panes[PANES][PANE_SIGNALS] = {
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
static const char *const controlled_panes[PANES][PANE_SIGNALS] = {
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
    [AXIS_AUTO] = "auto", [AXIS_GROW] = "grow", [AXIS_FIXED] = "fixed"};

const value_range value_range_empty = {(double)INFINITY, (double)-INFINITY};

void value_range_widen(value_range *r, value_range other)
{
    assert(r != NULL);
    r->low = fmin(r->low, other.low);
    r->high = fmax(r->high, other.high);
}

// Shows the first pane that has a signal, or the user's own with it if none has.
static void show_signal(pane_set *set, int signal)
{
    pane *own = &set->pane[PANES - 1];

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

// Shows the requested panes, and the usual ones as far as there is room.
static void show_panes(pane_set *set, const pane_wishes *wishes)
{
    const char *usual = wishes->controlled ? "1352486" : "1342567";
    int shown = 0;

    // none, then the requested ones
    for (int i = 0; i < PANES; i++) {
        set->pane[i].shown = false;
    }
    set->pane[PANES - 1].count = 0;
    set->pane[PANES - 1].view = VIEW_TIME;
    for (int i = 0; i < wishes->signal_count; i++) {
        show_signal(set, wishes->signals[i]);
        set->focus = i == 0 ? 0 : set->focus;
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
    assert(set != NULL && wishes != NULL);
    set->controlled = wishes->controlled;
    set->room = wishes->room;
    for (int i = 0; i < PANES; i++) {
        pane *p = &set->pane[i];
        const char *const *names = set->controlled ? controlled_panes[i] : scripted_panes[i];
        p->grown = value_range_empty;

        // the user's own has no names here
        if (names[0] == NULL) {
            continue;
        }
        p->count = 0;
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
    assert(set != NULL);
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
    assert(p != NULL);
    bool found = false;
    for (int k = 0; k < p->count; k++) {
        found = found || !signal_is_state(p->signals[k]);
    }
    return found;
}

void pane_fix_axis(pane *p, value_range limits)
{
    assert(p != NULL);
    double low = limits.low, high = limits.high;
    double least = 1e-9 * fmax(fabs(low), fabs(high)) + 1e-15;
    if (isfinite(low) && isfinite(high) && high - low >= least && high - low < 1e15) {
        p->scaling = AXIS_FIXED;
        p->fixed = limits;
    }
}

void pane_grow_axis(pane *p)
{
    assert(p != NULL);
    p->grown = value_range_empty;
    p->scaling = AXIS_GROW;
}
