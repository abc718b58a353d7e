#include "tests/reference/reference_events.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#define EVENT_RESOLUTION 1e-14
#define EDGE_ROUNDING    4e-15 // of a gap, at most [m]

// --- integration

int simulation_derivative(double t, const double y[], double dydt[], void *context)
{
    (void)t;
    const flow *fl = context;
    const body_chain *arm = fl->arm;
    const int n = arm->bodies;
    balance b;
    if (!balance_find(arm, y, fl->mode, &b)) {
        return GSL_ESING;
    }
    for (int i = 0; i < n; i++) {
        dydt[i] = y[n + i];
        dydt[n + i] = b.acceleration[i];
    }
    if (fl->mode.sliding == 0) {
        dydt[0] = dydt[n] = 0.0;
    }
    dydt[2 * n] = arm->motor_torque * y[n];
    dydt[2 * n + 1] = arm->motor_drag * y[n] * y[n];
    dydt[2 * n + 2] = arm->coulomb * fabs(y[n]);
    dydt[2 * n + 3] = b.force;
    dydt[2 * n + 4] = 0.0;
    for (int i = 0; i + 1 < n; i++) {
        double rate = y[n + i + 1] - y[n + i];
        dydt[2 * n + 4] += arm->damping[i] * rate * rate;
    }
    return GSL_SUCCESS;
}

bool simulation_complain(simulation *s, const char *what)
{
    snprintf(s->message, (size_t)s->message_size, "%s: %s at t = %.15g s", s->c->name,
             what, s->time);
    return false;
}

bool simulation_advance(simulation *s, const double *from, double tau, double *to)
{
    memcpy(to, from, (size_t)s->size * sizeof(double));
    if (tau <= 0.0) {
        return true;
    }
    double t = 0.0;
    gsl_odeiv2_driver_reset_hstart(s->driver, tau);
    if (gsl_odeiv2_driver_apply(s->driver, &t, tau, to) != GSL_SUCCESS) {
        return simulation_complain(s, "the integrator gave up");
    }
    return true;
}

bool simulation_project(simulation *s, double *y)
{
    const body_chain *arm = &s->arm;
    const int n = arm->bodies;
    bool held = s->flow.mode.sliding == 0;
    double gradient[BODIES_MAX], dx[BODIES_MAX], f, torque;
    for (int pass = 0; pass < 2; pass++) {
        double g = body_penetration(arm, y, y + n, gradient, NULL);
        if (!balance_solve(arm, y, gradient, true, held, NULL, -g, dx, &f, &torque)) {
            return simulation_complain(s, "the projection is singular");
        }
        for (int i = 0; i < n; i++) {
            y[i] += held && i == 0 ? 0.0 : dx[i];
        }
    }
    double rate = -body_gap_rate(arm, y, y + n);
    body_penetration(arm, y, y + n, gradient, NULL);
    if (!balance_solve(arm, y, gradient, true, held, NULL, -rate, dx, &f, &torque)) {
        return simulation_complain(s, "the projection is singular");
    }
    for (int i = 0; i < n; i++) {
        y[n + i] += held && i == 0 ? 0.0 : dx[i];
    }
    return true;
}

double simulation_force(simulation *s, const double *y)
{
    balance b;
    balance_find(&s->arm, y, s->flow.mode, &b);
    return b.force;
}

// --- events: functions that are positive while the mode lasts

bool event_active(contact_mode mode, event_function e)
{
    switch (e) {
    case GAP_OPEN:
        return !mode.touching;
    case FORCE_PRESSES:
        return mode.touching;
    case HUB_MOVES:
        return mode.sliding != 0;
    default:
        return mode.sliding == 0;
    }
}

static double event_value(const simulation *s, event_function e, const double *y)
{
    const int n = s->arm.bodies;
    contact_mode mode = s->flow.mode;
    if (e == GAP_OPEN) {
        return body_gap(&s->arm, y, y + n);
    }
    if (e == HUB_MOVES) {
        return mode.sliding * y[n];
    }
    balance b;
    balance_find(&s->arm, y, mode, &b);
    return e == FORCE_PRESSES ? b.force : s->arm.coulomb - fabs(b.friction);
}

double event_value_at(simulation *s, event_function e, double tau)
{
    double y[STATE_MAX];
    return simulation_advance(s, s->y, tau, y) ? event_value(s, e, y) : NOTHING;
}

double extreme_at(simulation *s, event_function e, double sign, double lo, double hi)
{
    const double ratio = 0.5 * (sqrt(5.0) - 1.0);
    double x1 = hi - ratio * (hi - lo), x2 = lo + ratio * (hi - lo);
    double v1 = sign * event_value_at(s, e, x1), v2 = sign * event_value_at(s, e, x2);
    while (hi - lo > 1e-11) {
        if (v1 < v2) {
            hi = x2;
            x2 = x1;
            v2 = v1;
            x1 = hi - ratio * (hi - lo);
            v1 = sign * event_value_at(s, e, x1);
        } else {
            lo = x1;
            x1 = x2;
            v1 = v2;
            x2 = lo + ratio * (hi - lo);
            v2 = sign * event_value_at(s, e, x2);
        }
    }
    return 0.5 * (lo + hi);
}

double parabola_vertex(double v0, double vm, double v1)
{
    double bend = v0 - 2.0 * vm + v1;
    return bend != 0.0 ? 0.5 + 0.25 * (v0 - v1) / bend : NOTHING;
}

double event_offset(simulation *s, event_function e)
{
    double v0 = event_value(s, e, s->y), vm = event_value(s, e, s->middle),
           v1 = event_value(s, e, s->end);
    double lo = 0.0, hi = NEVER;
    if (vm < 0.0) {
        hi = 0.5 * s->span;
    } else if (v1 < 0.0) {
        lo = 0.5 * s->span;
        hi = s->span;
    } else {
        // a dip between the looks
        double x = parabola_vertex(v0, vm, v1);
        double bottom = vm - 0.125 * (v1 - v0) * (v1 - v0) / (v0 - 2.0 * vm + v1);
        bool dips = v0 - 2.0 * vm + v1 > 0.0 && x > 0.0 && x < 1.0 && v0 > 0.0 &&
                    bottom < 0.1 * fmin(v0, v1);
        if (dips) {
            // just after release the gap grows with the third power of time, so it is
            // rounding only
            double at = extreme_at(s, e, 1.0, 0.0, s->span);
            if (event_value_at(s, e, at) < (e == GAP_OPEN ? -GAP_ROUNDING : 0.0)) {
                hi = at;
            }
        }
    }
    if (isinf(hi)) {
        return NEVER;
    }
    // just after a change of mode the function starts at zero, up to rounding: find where
    // it rose
    double edge = 0.0;
    if (lo == 0.0 && v0 <= 0.0) {
        double probe = hi, value;
        do {
            probe *= 0.5;
            value = event_value_at(s, e, probe);
        } while (probe > EVENT_RESOLUTION && !(value > 0.0));
        // nowhere within rounding: a flight too low for that ends beyond it
        edge = e == GAP_OPEN && !(value > 0.0) ? -EDGE_ROUNDING : 0.0;
        lo = edge < 0.0 ? 0.0 : probe;
    }
    while (hi - lo > EVENT_RESOLUTION) {
        double x = 0.5 * (lo + hi);
        if (event_value_at(s, e, x) < edge) {
            hi = x;
        } else {
            lo = x;
        }
    }
    return hi;
}
