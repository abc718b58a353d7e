// The panes of curves: what they show, and the range of their axes.
#include <math.h>
#include <string.h>

#include "ui/explorer/lab.h"

#define ROUNDING 1e-12 // a smaller range is rounding, and shown as a flat line
#define SHORTEST 1e-6  // visible part of the run [s]

// Panes of an arm under a script, and of one with sensors and a controller.
static const char *const scripted_panes[LAB_PANES][PANE_SIGNALS] = {
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
static const char *const controlled_panes[LAB_PANES][PANE_SIGNALS] = {
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

void lab_define_panes(lab *l)
{
    bool controlled = l->session.effective.parameters.control.law != LAW_NONE;
    l->panes_controlled = controlled;
    for (int i = 0; i < LAB_PANES; i++) {
        lab_pane *pane = &l->panes[i];
        const char *const *names = controlled ? controlled_panes[i] : scripted_panes[i];
        pane->grown_low = (double)INFINITY;
        pane->grown_high = (double)-INFINITY;
        if (names[0] == NULL) {
            continue; // the user's own
        }
        pane->count = 0;
        for (int j = 0; j < PANE_SIGNALS && names[j] != NULL; j++) {
            int signal = signal_find(names[j]);
            if (signal >= 0) {
                pane->signals[pane->count++] = signal;
            }
        }
        if (!l->panes_chosen) {
            pane->shown = strchr(controlled ? "135" : "134", '1' + i) != NULL;
        }
    }
}

void lab_notice_law(lab *l)
{
    bool controlled = l->session.effective.parameters.control.law != LAW_NONE;
    if (controlled != l->panes_controlled) {
        lab_define_panes(l);
    }
}

int lab_focused_pane(const lab *l)
{
    for (int i = 0; i < LAB_PANES; i++) {
        int pane = (l->focus + i) % LAB_PANES;
        if (l->panes[pane].shown) {
            return pane;
        }
    }
    return -1;
}

// --- the visible part -------------------------------------------------------------------------

void lab_window(const lab *l, double *from, double *to)
{
    double end = l->session.effective.parameters.run.duration;
    *from = l->to > l->from ? l->from : 0;
    *to = l->to > l->from ? l->to : end;
}

void lab_show_part(lab *l, double from, double to)
{
    double end = l->session.effective.parameters.run.duration;
    double width = fmax(to - from, SHORTEST);
    if (width >= end) {
        l->from = l->to = 0;
        l->adrift = false;
        return;
    }
    l->from = fmax(0, fmin(end - width, from));
    l->to = l->from + width;
}

void lab_keep_cursor_visible(lab *l)
{
    double from, to, now = l->session.now;
    lab_window(l, &from, &to);
    double width = to - from, end = l->session.effective.parameters.run.duration;
    if (l->to <= l->from || l->adrift) {
        // a shorter run may have ended before a part that was panned to
        if (l->to > end) {
            lab_show_part(l, from, to);
        }
        return;
    }
    // some of what comes is visible while it plays
    if (now > from + 0.8 * width) {
        from = now - 0.8 * width;
    } else if (now < from + 0.1 * width) {
        from = now - 0.1 * width;
    }
    lab_show_part(l, from, from + width);
}

// --- axes of values ---------------------------------------------------------------------------

typedef struct range {
    double low, high; // nothing if low is above high
} range;

static void take(range *r, double low, double high)
{
    r->low = fmin(r->low, low);
    r->high = fmax(r->high, high);
}

// Takes the rows from `first` to `last` into the range, whole blocks at once.
static void take_rows(range *found, lab_extremes *e, unsigned version, const trace *t, int signal,
                      size_t first, size_t last)
{
    const double *pairs = lab_extremes_of(e, version, t, signal);
    for (size_t r = first; r <= last && r < t->row_count;) {
        if (pairs != NULL && r % EXTREMES_BLOCK == 0 && r + EXTREMES_BLOCK <= last + 1) {
            take(found, pairs[2 * (r / EXTREMES_BLOCK)], pairs[2 * (r / EXTREMES_BLOCK) + 1]);
            r += EXTREMES_BLOCK;
        } else {
            double value = signal_value(&t->rows[r++], signal);
            if (isfinite(value)) {
                take(found, value, value);
            }
        }
    }
}

// What a pane's signals do between two instants.
static range range_between(lab *l, const lab_pane *pane, double from, double to, bool with_other)
{
    const session *e = &l->session;
    const trace *t = &e->run.trace, *other = &e->other.trace;
    range found = {(double)INFINITY, (double)-INFINITY};
    for (int k = 0; k < pane->count; k++) {
        // one row more at the end: the line goes on to it
        take_rows(&found, &l->run_extremes, e->version, t, pane->signals[k], trace_row_at(t, from),
                  trace_row_at(t, to) + 1);
        if (with_other && e->has_other) {
            take_rows(&found, &l->other_extremes, e->version, other, pane->signals[k],
                      trace_row_at(other, from), trace_row_at(other, to) + 1);
        }
    }
    return found;
}

void lab_grow_axes(lab *l)
{
    for (int i = 0; i < LAB_PANES; i++) {
        lab_pane *pane = &l->panes[i];
        if (pane->axis == AXIS_GROW && pane->shown) {
            range seen = {pane->grown_low, pane->grown_high};
            range more = range_between(l, pane, 0, l->session.seen, false);
            take(&seen, more.low, more.high);
            pane->grown_low = seen.low;
            pane->grown_high = seen.high;
        }
    }
}

bool lab_pane_axis(lab *l, int index, double *low, double *high)
{
    lab_pane *pane = &l->panes[index];
    double from, to;
    lab_window(l, &from, &to);
    range found = range_between(l, pane, from, to, true);
    if (!(found.high >= found.low)) {
        return false;
    }
    if (pane->axis == AXIS_GROW && pane->grown_high >= pane->grown_low) {
        found = (range){pane->grown_low, pane->grown_high};
    } else if (pane->axis == AXIS_FIXED) {
        found = (range){pane->low, pane->high};
    }
    if (found.high - found.low < ROUNDING && pane->axis != AXIS_FIXED) {
        take(&found, found.low - 0.5, found.high + 0.5);
    }
    *low = pane->drawn_low = found.low;
    *high = pane->drawn_high = found.high;
    return true;
}
