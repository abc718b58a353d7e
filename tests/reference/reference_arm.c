#include "tests/reference/reference_arm.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <gsl/gsl_errno.h>

#include "tests/reference/reference_events.h"

#define STEADY_WINDOW  0.1
#define SEPARATION_GAP 1e-6
#define REST_SPEED     1e-4 // slower impacts are plastic [m/s]

// --- bookkeeping

static void note_force(simulation *s, double tau, double force)
{
    reference_answer *a = s->answer;
    double delay = s->time + tau - a->first_contact;
    if (!(force <= a->peak)) {
        a->peak = force;
        a->peak_delay = delay;
    }
    if (s->in_first_pulse && !(force <= a->first_pulse_peak)) {
        a->first_pulse_peak = force;
        a->first_pulse_delay = delay;
    }
}

// Notes the largest force or gap within the accepted step.
static void note_step(simulation *s)
{
    const int n = s->arm.bodies;
    if (s->flow.mode.touching) {
        double v0 = simulation_force(s, s->y), vm = simulation_force(s, s->middle),
               v1 = simulation_force(s, s->end);
        double x = parabola_vertex(v0, vm, v1);
        note_force(s, 0.0, v0);
        note_force(s, s->span, v1);
        if (v0 - 2.0 * vm + v1 < 0.0 && x > -0.1 && x < 1.1) {
            double top = fmax(vm, fmax(v0, v1));
            if (!(top < 0.9 * s->answer->peak) ||
                (s->in_first_pulse && !(top < 0.9 * s->answer->first_pulse_peak))) {
                double at = extreme_at(s, FORCE_PRESSES, -1.0, 0.0, s->span);
                note_force(s, at, event_value_at(s, FORCE_PRESSES, at));
            }
        }
    } else {
        double v0 = body_gap(&s->arm, s->y, s->y + n),
               vm = body_gap(&s->arm, s->middle, s->middle + n),
               v1 = body_gap(&s->arm, s->end, s->end + n), bend = v0 - 2.0 * vm + v1;
        double x = parabola_vertex(v0, vm, v1), top = fmax(v0, fmax(vm, v1));
        if (bend < 0.0 && x > 0.0 && x < 1.0) {
            top = fmax(top, vm - 0.125 * (v1 - v0) * (v1 - v0) / bend);
        }
        s->phase_gap = fmax(s->phase_gap, top);
    }
}

static void note_energy(simulation *s)
{
    const int n = s->arm.bodies;
    double residual = body_energy(&s->arm, s->y, s->y + n) - s->y[2 * n] +
                      s->y[2 * n + 1] + s->y[2 * n + 2] + s->y[2 * n + 4] +
                      s->impact_loss - s->start_energy;
    s->answer->energy_residual = fmax(s->answer->energy_residual, fabs(residual));
}

// A free phase after first contact is over.
static void note_touch(simulation *s)
{
    reference_answer *a = s->answer;
    a->touches++;
    if (s->phase_gap > SEPARATION_GAP) {
        a->separations++;
        a->smallest_separation = fmin(a->smallest_separation, s->phase_gap);
    } else {
        a->largest_touch = fmax(a->largest_touch, s->phase_gap);
    }
}

// --- the machine

static bool mode_change(simulation *s, bool may_touch)
{
    contact_mode before = s->flow.mode;
    if (!mode_resolve(&s->arm, s->y, may_touch, &s->flow.mode)) {
        return simulation_complain(s, "no mode is admissible");
    }
    bool released = before.touching && !s->flow.mode.touching;
    if (released) {
        s->phase_gap = 0.0;
        if (s->in_first_pulse) {
            s->in_first_pulse = false;
            s->answer->first_pulse = s->time - s->answer->first_contact;
        }
    }
    return true;
}

// The gap has closed: M dw = -J'p, J (w + dw) = -e J w, then contact or release.
static bool impact(simulation *s)
{
    const body_chain *arm = &s->arm;
    const int n = arm->bodies;
    reference_answer *a = s->answer;
    double gradient[BODIES_MAX], dw[BODIES_MAX], p, unused;
    bool first = isnan(a->first_contact);
    if (first) {
        a->first_contact = s->time;
        s->in_first_pulse = true;
    } else {
        note_touch(s);
    }
    double approach = -body_gap_rate(arm, s->y, s->y + n);
    double restitution = approach < REST_SPEED ? 0.0 : arm->restitution;
    if (approach > 0.0) {
        body_penetration(arm, s->y, s->y + n, gradient, NULL);
        double before = body_energy(arm, s->y, s->y + n);
        if (!balance_solve(arm, s->y, gradient, true, false, NULL,
                           -(1.0 + restitution) * approach, dw, &p, &unused)) {
            return simulation_complain(s, "the impact is singular");
        }
        for (int i = 0; i < n; i++) {
            s->y[n + i] += dw[i];
        }
        s->impact_loss += before - body_energy(arm, s->y, s->y + n);
        s->impulses += p;
        a->impacts++;
        a->last_impact = s->time;
        a->slowest_approach = fmin(a->slowest_approach, approach);
        if (first) {
            a->first_impulse = p;
            a->first_approach = approach;
        }
    }
    // contact can hold only if nothing was given back
    bool may_touch = restitution == 0.0;
    s->flow.mode.touching = true;
    if (may_touch) {
        contact_mode pressed = {true, s->y[n] > 0.0 ? 1 : (s->y[n] < 0.0 ? -1 : 0)};
        balance b;
        balance_find(arm, s->y, pressed, &b);
        a->weakest_hold = fmin(a->weakest_hold, fabs(b.force));
    }
    if (!mode_change(s, may_touch)) {
        return false;
    }
    return !s->flow.mode.touching || simulation_project(s, s->y);
}

// Takes the step up to the earliest event, and the event.
static bool step(simulation *s, double span)
{
    const int n = s->arm.bodies;
    s->span = span;
    if (!simulation_advance(s, s->y, 0.5 * span, s->middle) ||
        !simulation_advance(s, s->middle, 0.5 * span, s->end)) {
        return false;
    }
    double earliest = NEVER;
    event_function which = EVENT_FUNCTIONS;
    for (event_function e = 0; e < EVENT_FUNCTIONS; e++) {
        double offset = event_active(s->flow.mode, e) ? event_offset(s, e) : NEVER;
        if (offset < earliest) {
            earliest = offset;
            which = e;
        }
    }
    if (which != EVENT_FUNCTIONS) {
        s->span = earliest;
        if (!simulation_advance(s, s->y, 0.5 * earliest, s->middle) ||
            !simulation_advance(s, s->y, earliest, s->end)) {
            return false;
        }
    }
    note_step(s);
    s->idle_events = which != EVENT_FUNCTIONS && s->span < 1e-12 ? s->idle_events + 1 : 0;
    if (s->idle_events > 20) {
        return simulation_complain(s, "events follow one another without time passing");
    }
    s->time += s->span;
    memcpy(s->y, s->end, sizeof s->y);
    if (s->flow.mode.touching) {
        s->answer->largest_gap_error =
            fmax(s->answer->largest_gap_error, fabs(body_gap(&s->arm, s->y, s->y + n)));
        if (!simulation_project(s, s->y)) {
            return false;
        }
    }
    bool done = true;
    if (which == GAP_OPEN) {
        done = impact(s);
    } else if (which != EVENT_FUNCTIONS) {
        if (which == HUB_MOVES) {
            s->y[n] = 0.0;
        }
        done = mode_change(s, s->flow.mode.touching);
        if (done && s->flow.mode.touching) {
            done = simulation_project(s, s->y);
        }
    }
    note_energy(s);
    return done;
}

static bool run(simulation *s)
{
    const reference_case *c = s->c;
    const int n = s->arm.bodies;
    const double window_start = c->duration - STEADY_WINDOW;
    bool window_open = false;
    for (int i = 0; i < n; i++) {
        s->y[i] = c->angle;
        s->y[n + i] = c->velocity;
    }
    s->start_energy = body_energy(&s->arm, s->y, s->y + n);
    if (!mode_resolve(&s->arm, s->y, false, &s->flow.mode)) {
        return simulation_complain(s, "no mode is admissible");
    }
    while (s->time < c->duration) {
        if (!window_open && s->time >= window_start) {
            s->steady_from = s->y[2 * n + 3];
            window_open = true;
        }
        double until = window_open ? c->duration : window_start;
        reference_answer *a = s->answer;
        if (!isnan(a->first_contact) && a->samples < REFERENCE_SAMPLES) {
            double sample = a->first_contact + a->samples * REFERENCE_INTERVAL;
            if (sample - s->time < 1e-12) {
                a->momentum[a->samples++] = s->impulses + s->y[2 * n + 3];
                continue;
            }
            until = fmin(until, sample);
        }
        double left = until - s->time;
        if (left < 1e-12) {
            s->time = until;
            continue;
        }
        if (!step(s, fmin(left, c->longest_step))) {
            return false;
        }
    }
    if (!isnan(s->answer->first_contact) && !s->flow.mode.touching) {
        note_touch(s);
    }
    s->answer->steady_force = (s->y[2 * n + 3] - s->steady_from) / STEADY_WINDOW;
    s->answer->final_hub_angle = s->y[0];
    s->answer->motor_work = s->y[2 * n];
    s->answer->viscous_loss = s->y[2 * n + 1];
    s->answer->friction_loss = s->y[2 * n + 2];
    s->answer->damping_loss = s->y[2 * n + 4];
    s->answer->impact_loss = s->impact_loss;
    return true;
}

bool reference_simulate(const reference_case *c, reference_answer *answer, char *message,
                        int size)
{
    simulation s = {.c = c, .answer = answer, .message = message, .message_size = size};
    *answer = (reference_answer){.first_contact = NOTHING,
                                 .first_impulse = NOTHING,
                                 .first_approach = NOTHING,
                                 .first_pulse_peak = NOTHING,
                                 .first_pulse_delay = NOTHING,
                                 .first_pulse = NOTHING,
                                 .peak = NOTHING,
                                 .peak_delay = NOTHING,
                                 .last_impact = NOTHING,
                                 .smallest_separation = NEVER,
                                 .slowest_approach = NEVER,
                                 .weakest_hold = NEVER};
    gsl_set_error_handler_off();
    body_chain_build(&s.arm, c);
    s.flow.arm = &s.arm;
    s.size = 2 * s.arm.bodies + EXTRA;
    s.system = (gsl_odeiv2_system){simulation_derivative, NULL, (size_t)s.size, &s.flow};
    s.driver = gsl_odeiv2_driver_alloc_y_new(&s.system, gsl_odeiv2_step_rk8pd,
                                             c->longest_step, c->tolerance, c->tolerance);
    if (!s.driver) {
        return simulation_complain(&s, "no memory for the integrator");
    }
    bool done = run(&s);
    gsl_odeiv2_driver_free(s.driver);
    return done;
}
