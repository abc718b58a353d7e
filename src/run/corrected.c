// A run of the corrected arm: steps, events, script, samples of the rig, rows.
#include "src/run/recording.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SHORTEST_MEAN       1e-9 // a step shorter than this has the mean of its ends [s]
#define TINY_ENERGY         1e-9 // below it nothing is called unstable [J]
#define TINY_TURN           1e-2 // nor below what the motor does in this turn [rad]
#define WRONG_ENERGY        0.1  // share of the energy turned over that may not be unaccounted for
#define MOST_EVENTS_AT_ONCE 100  // events without time passing before the run is given up
#define ONE_INSTANT         1e-12 // samples, actions and windows that differ by rounding coincide [s]

// Takes note of the ledger; a run that makes energy is stopped.
static status audit(recording *r, const arm *a, motion *m)
{
    const double *state = m->state;
    double residual = motion_energy_residual(a, m, m->state);
    double turned_over = fabs(state[SLOT_MOTOR_WORK]) + fabs(state[SLOT_EXTERNAL_WORK]) +
                         m->start_energy + fabs(a->motor.torque) * TINY_TURN + TINY_ENERGY;
    summary *s = &r->result->summary;
    s->energy_residual_J = fmax(s->energy_residual_J, fabs(residual));
    // steps that do not resolve the fastest modes damp them: there energy may vanish, not appear
    double wrong = motion_unresolved(a, m) ? residual : fabs(residual);
    return wrong > WRONG_ENERGY * turned_over ? STATUS_UNSTABLE : STATUS_OK;
}

static status record_row(recording *r, const arm *a, motion *m, double *state, double impulse)
{
    if (!r->keep_trace) {
        return STATUS_OK;
    }
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    double *al = state_accelerations(m, state), *quadrature = state_quadratures(m, state);
    int first = a->first, last = a->dof - 1;
    sample row = {
        .time = state[SLOT_TIME],
        .hub_angle = q[0],
        .first_angle = q[first],
        .last_angle = q[last],
        .hub_velocity = w[0],
        .first_velocity = w[first],
        .last_velocity = w[last],
        .hub_acceleration = al[0],
        .first_acceleration = al[first],
        .last_acceleration = al[last],
        .gap = state[SLOT_GAP],
        .gap_velocity = state[SLOT_GAP_VELOCITY],
        .force = state[SLOT_FORCE],
        .impulse = impulse,
        .contact = state[SLOT_CONTACT],
        .sticking = state[SLOT_FRICTION] == HUB_STICK,
        .voltage = a->motor.voltage,
        .motor_torque = a->motor.torque,
        .friction_torque = state[SLOT_FRICTION_TORQUE],
        .kinetic_energy = chain_kinetic_energy(a, q, w),
        .strain_energy = chain_strain_energy(a, q),
        .motor_work = state[SLOT_MOTOR_WORK],
        .external_work = state[SLOT_EXTERNAL_WORK],
        .viscous_loss = quadrature[QUADRATURE_VISCOUS],
        .friction_loss = state[SLOT_FRICTION_LOSS],
        .damping_loss = quadrature[QUADRATURE_DAMPING],
        .impact_loss = state[SLOT_IMPACT_LOSS],
        .energy_residual = motion_energy_residual(a, m, state),
    };
    recording_add_rig_signals(r, &row);
    return recording_add_row(r, &row, q, w);
}

static status record_event(recording *r, double time, event_kind kind, const motion_report *report)
{
    event e = {.time = time, .kind = kind, .index = -1};
    if (kind == EVENT_IMPACT) {
        e.impulse = report->impulse;
        e.speed = report->speed;
        e.loss = report->loss;
    }
    return trace_add_event(&r->result->trace, e);
}

// The first pulse is over: what was the largest force until now?
static void close_first_pulse(recording *r, const motion *m)
{
    summary *s = &r->result->summary;
    r->pulse_open = false;
    s->first_pulse_s = m->state[SLOT_TIME] - s->first_contact_s;
    if (m->pulse_peak >= 0) {
        s->first_pulse_peak_N = m->pulse_peak;
        s->first_pulse_time_to_peak_s = m->pulse_peak_time - s->first_contact_s;
    }
}

// Books an event that has just been applied.
static status book_event(recording *r, motion *m, const motion_report *report)
{
    static const event_kind kinds[] = {[MOTION_IMPACT] = EVENT_IMPACT,
                                       [MOTION_TOUCH] = EVENT_CONTACT,
                                       [MOTION_RELEASE] = EVENT_RELEASE,
                                       [MOTION_STICK] = EVENT_STICK,
                                       [MOTION_SLIP] = EVENT_SLIP};
    summary *s = &r->result->summary;
    double now = m->state[SLOT_TIME];
    bool touches = report->event == MOTION_IMPACT || report->event == MOTION_TOUCH;
    event_kind kind = kinds[report->event];
    if (kind == EVENT_STICK && m->state[SLOT_FRICTION] != HUB_STICK) {
        kind = EVENT_REVERSAL; // the hub came to rest and friction does not hold it
    }
    status failed = record_event(r, now, kind, report);
    if (report->event == MOTION_IMPACT) {
        s->impacts++;
    }
    if (touches) {
        s->separations += r->separated;
        r->separated = false;
        if (isnan(s->first_contact_s)) {
            s->first_contact_s = now;
            s->contact_impulse_Ns = report->impulse;
            r->pulse_open = true;
            motion_watch(m);
        }
        if (report->holds && failed == STATUS_OK && report->event == MOTION_IMPACT) {
            failed = record_event(r, now, EVENT_CONTACT, report);
        }
    }
    bool apart = m->state[SLOT_CONTACT] == 0 && (touches || report->event == MOTION_RELEASE);
    if (apart && r->pulse_open) {
        close_first_pulse(r, m);
    }
    return failed;
}

// Lets the force sensors feel an impact that has just been applied.
static void strike(recording *r, const motion *m, const motion_report *report)
{
    // an impulse that the next step is to deliver is part of that step's force
    if (r->rig != NULL && report->event == MOTION_IMPACT && m->state[SLOT_IMPULSE] == 0) {
        sensors_strike(&r->rig->sensors, report->impulse);
    }
}

// Applies an event that the machine stopped at and records the rows on its both sides.
static status pass_event(recording *r, const arm *a, motion *m, motion_report *report)
{
    status failed = record_row(r, a, m, m->state, 0);
    if (report->event == MOTION_IMPACT && r->result->before_impact == NULL) {
        size_t size = 2 * (size_t)m->dof * sizeof(double); // velocities stand behind the angles
        r->result->before_impact = malloc(size);
        if (r->result->before_impact == NULL) {
            return STATUS_NO_MEMORY;
        }
        memcpy(r->result->before_impact, state_angles(m, m->state), size);
        r->result->before_impact_size = size;
    }
    motion_apply(a, m, report);
    strike(r, m, report);
    if (failed == STATUS_OK) {
        failed = book_event(r, m, report);
    }
    if (failed == STATUS_OK) {
        failed = audit(r, a, m);
    }
    return failed == STATUS_OK ? record_row(r, a, m, m->state, report->impulse) : failed;
}

// Carries out the script's actions that are due.
static status act(recording *r, arm *a, motion *m, fault *f)
{
    const scenario *s = r->scenario;
    double now = m->state[SLOT_TIME];
    for (; r->next_action < s->action_count && s->actions[r->next_action].time <= now + ONE_INSTANT;
         r->next_action++) {
        const action *todo = &s->actions[r->next_action];
        motion_report report = {.event = MOTION_REACHED};
        event e = {.time = now, .kind = EVENT_CHANGE, .index = r->next_action};
        status failed = record_row(r, a, m, m->state, 0);
        if (todo->kind == ACTION_SET) {
            failed = action_apply(todo, &r->now, f);
            if (r->rig != NULL) {
                r->now.motor.voltage = r->rig->voltage; // the command is the controller's
                failed = failed == STATUS_OK ? rig_lock(r->rig, r->now.control.lock, f) : failed;
            }
            arm before = *a;
            arm_init(a, &r->now);
            motion_rebind(&before, a, m);
        } else {
            e.kind = EVENT_PUSH;
            e.impulse = todo->value;
            motion_push(a, m, todo->value, &report);
            strike(r, m, &report);
        }
        if (failed == STATUS_OK) {
            failed = trace_add_event(&r->result->trace, e);
        }
        if (failed == STATUS_OK && report.event == MOTION_IMPACT) {
            failed = book_event(r, m, &report);
        } else if (failed == STATUS_OK && m->state[SLOT_CONTACT] == 0 && r->pulse_open) {
            close_first_pulse(r, m);
        }
        if (failed == STATUS_OK) {
            failed = record_row(r, a, m, m->state, report.impulse);
        }
        if (failed != STATUS_OK) {
            return failed;
        }
    }
    return STATUS_OK;
}

// Lets another command take effect: the torque jumps, and with it accelerations and force.
static status apply_command(recording *r, arm *a, motion *m)
{
    bool contact = m->state[SLOT_CONTACT] != 0;
    double now = m->state[SLOT_TIME];
    recording_book_electrical_energy(r, now, state_angles(m, m->state)[0]);
    r->now.motor.voltage = r->rig->voltage;
    double before = a->motor.torque;
    arm_set_voltage(a, r->rig->voltage);
    motion_retorque(a, m, before);
    status failed = STATUS_OK;
    if (contact && m->state[SLOT_CONTACT] == 0) {
        motion_report lost = {.event = MOTION_RELEASE};
        failed = book_event(r, m, &lost);
    }
    return failed == STATUS_OK && now > 0 ? record_row(r, a, m, m->state, 0) : failed;
}

// What the sensors are fixed to, in a state of the motion.
static sensed_motion sense(const arm *a, const motion *m, double *state)
{
    const double *q = state_angles(m, state), *w = state_velocities(m, state);
    int first = a->first, last = a->dof - 1;
    return (sensed_motion){.angle = q[0],
                           .velocity = w[0],
                           .acceleration = state_accelerations(m, state)[0],
                           .bending = q[last] - q[first],
                           .bending_rate = w[last] - w[first],
                           .force = state[SLOT_FORCE]};
}

// Samples the sensors and changes the command where the time for it has come.
static status control(recording *r, arm *a, motion *m, fault *f)
{
    bool changed;
    double now = m->state[SLOT_TIME];
    if (r->rig == NULL || rig_next_time(r->rig) > now + ONE_INSTANT) {
        return STATUS_OK;
    }
    sensed_motion sensed = sense(a, m, m->state);
    status s = rig_act(r->rig, now, &sensed, &changed, f);
    return s == STATUS_OK && changed ? apply_command(r, a, m) : s;
}

// Records the rows of the grid that lie within the step just made, and steps over one at its end.
static status record_grid(recording *r, const arm *a, motion *m, bool at_event)
{
    const double step = r->scenario->parameters.method.step, now = m->state[SLOT_TIME];
    if (!r->keep_trace) {
        return STATUS_OK;
    }
    for (;; r->grid_row++) {
        double time = (double)r->grid_row * step;
        bool at_end = fabs(time - now) <= 1e-9 * step;
        if (time > now && !at_end) {
            return STATUS_OK;
        }
        if (at_end && at_event) {
            continue; // an event records its own rows
        }
        double *state = at_end ? m->state : motion_between(a, m, time);
        status failed = state ? record_row(r, a, m, state, 0) : STATUS_NOT_FINITE;
        failed = failed == STATUS_OK && recording_asked_to_stop(r) ? STATUS_STOPPED : failed;
        if (failed != STATUS_OK) {
            return failed;
        }
    }
}

// Whether the gap was a separation at any instant of the step just made. A whole flight may lie
// within one step, so the end says little: look where the gap stops growing.
static bool step_separated(const arm *a, motion *m)
{
    double from = m->trial[SLOT_TIME], to = m->state[SLOT_TIME];
    if (m->state[SLOT_GAP] > SEPARATION_GAP) {
        return true;
    }
    if (m->state[SLOT_CONTACT] != 0 || m->state[SLOT_GAP_VELOCITY] >= 0) {
        return false;
    }
    for (int i = 0; i < 30; i++) {
        double middle = 0.5 * (from + to);
        const double *state = motion_between(a, m, middle);
        if (state == NULL || state[SLOT_GAP] > SEPARATION_GAP) {
            return state != NULL;
        }
        if (state[SLOT_GAP_VELOCITY] > 0) {
            from = middle;
        } else {
            to = middle;
        }
    }
    return false;
}

// Books the step just made: force, separation, ledger, rows.
static status book_step(recording *r, const arm *a, motion *m, bool at_event)
{
    const double *start = m->trial; // where the step left its beginning
    double length = m->state[SLOT_TIME] - start[SLOT_TIME];
    double integral = state_quadratures(m, m->state)[QUADRATURE_FORCE] -
                      state_quadratures(m, m->trial)[QUADRATURE_FORCE];
    if (!isnan(r->result->summary.first_contact_s) && !r->separated) {
        r->separated = step_separated(a, m);
    }
    // an arm held still has the energy it had
    status s = motion_held_still(m) ? STATUS_OK : audit(r, a, m);
    // between stops that differ by rounding only, the integral's difference is all rounding
    double ends = (start[SLOT_FORCE] + m->state[SLOT_FORCE]) / 2;
    double mean = length > SHORTEST_MEAN ? integral / length : ends;
    if (r->rig != NULL) {
        sensed_motion first = sense(a, m, m->trial), last = sense(a, m, m->state);
        sensors_follow(&r->rig->sensors, length, &first, &last, mean);
    }
    if (s == STATUS_OK && length > 0) {
        s = recording_add_step(r, (force_step){start[SLOT_TIME], m->state[SLOT_TIME],
                                               start[SLOT_FORCE], m->state[SLOT_FORCE], mean});
    }
    return s == STATUS_OK ? record_grid(r, a, m, at_event) : s;
}

// Advances to `until` or the cut, passing all events on the way and recording rows on the grid.
static status travel(recording *r, const arm *a, motion *m, double until, fault *f)
{
    double last_event = -1;
    int at_once = 0;
    while (m->state[SLOT_TIME] < fmin(until, m->cut)) {
        motion_report report;
        if (!recording_checkpoint(r, m, last_event)) {
            return fault_set(f, STATUS_NO_MEMORY, "%s", status_text(STATUS_NO_MEMORY));
        }
        status s = motion_step(a, m, until, r->now.method.step, &report);
        if (s != STATUS_OK) {
            return fault_set(
                f, s, "at t = %.9g s (last good state at %.9g s): %s; the method was %s",
                m->failure_time, m->state[SLOT_TIME], status_text(s), m->stepper->name);
        }
        bool at_event = report.event != MOTION_REACHED;
        s = book_step(r, a, m, at_event);
        if (s == STATUS_OK && at_event) {
            s = pass_event(r, a, m, &report);
            at_once = m->state[SLOT_TIME] - last_event < 1e-13 ? at_once + 1 : 0;
            last_event = m->state[SLOT_TIME];
        }
        if (s == STATUS_OK && at_once > MOST_EVENTS_AT_ONCE) {
            s = STATUS_NO_PROGRESS;
        }
        if (s == STATUS_OK && recording_asked_to_stop(r)) {
            s = STATUS_STOPPED;
        }
        recording_publish(r, m->state[SLOT_TIME]);
        if (s == STATUS_UNSTABLE) {
            return fault_set(f, s,
                             "at t = %.9g s: %s (residual %.3g J); the method was %s, a "
                             "shorter method.step may help",
                             m->state[SLOT_TIME], status_text(s),
                             motion_energy_residual(a, m, m->state), m->stepper->name);
        }
        if (s != STATUS_OK) {
            return fault_set(f, s, "at t = %.9g s: %s", m->state[SLOT_TIME], status_text(s));
        }
    }
    return STATUS_OK;
}

// The next instant that steps are made for: the rig's, or the end.
static double next_stop(const recording *r)
{
    double stop = r->scenario->parameters.run.duration;
    return r->rig != NULL ? fmin(stop, rig_next_time(r->rig)) : stop;
}

// The next instant at which steps are cut without being made for it: an action, the start of the
// window over which the steady force is taken. What comes before does not depend on it.
static double next_cut(const recording *r, double window, double now)
{
    const scenario *s = r->scenario;
    double cut = r->next_action < s->action_count ? s->actions[r->next_action].time : HUGE_VAL;
    return window > now + ONE_INSTANT ? fmin(window, cut) : cut;
}

// Puts the arm where it starts, and records the row of that instant.
static status begin_corrected(recording *r, arm *a, motion *m, fault *f)
{
    const parameters *p = &r->scenario->parameters;
    summary *s = &r->result->summary;
    snprintf(s->method, sizeof s->method, "%s", m->stepper->name);
    if (motion_unresolved(a, m)) {
        snprintf(s->message, sizeof s->message,
                 "steps of %g s do not resolve the fastest modes of %d links (%.3g rad/s): the "
                 "method was %s, what happens within a few steps of an impact is rough; a shorter "
                 "method.step resolves it",
                 p->method.step, a->links, a->highest_frequency, m->stepper->name);
    }
    status failed = recording_open_trace(r, a->dof, f);
    if (failed != STATUS_OK) {
        return failed;
    }
    motion_start(a, m, p->initial.angle, p->initial.velocity);
    failed = control(r, a, m, f);
    r->grid_row = 1;
    return failed == STATUS_OK ? record_row(r, a, m, m->state, 0) : failed;
}

status run_corrected(recording *r, fault *f)
{
    const parameters *p = &r->scenario->parameters;
    arm a;
    arm_init(&a, &r->now);
    motion *m = motion_create(&a, &p->method);
    if (m == NULL) {
        return fault_set(f, STATUS_NO_MEMORY, "no memory for an arm of %d links", p->arm.links);
    }
    summary *s = &r->result->summary;
    double duration = p->run.duration, window = fmax(0, duration - STEADY_WINDOW);
    status failed = recording_open_history(r, m, f);
    if (failed == STATUS_OK && r->options.resume) {
        recording_resume(r, &a, m);
    } else if (failed == STATUS_OK) {
        failed = begin_corrected(r, &a, m, f);
    }
    while (failed == STATUS_OK && m->state[SLOT_TIME] < duration) {
        if (fabs(m->state[SLOT_TIME] - window) <= ONE_INSTANT) {
            r->integral_at_window = state_quadratures(m, m->state)[QUADRATURE_FORCE];
        }
        failed = act(r, &a, m, f);
        if (failed == STATUS_OK) {
            failed = control(r, &a, m, f);
        }
        if (failed == STATUS_OK) {
            m->cut = next_cut(r, window, m->state[SLOT_TIME]);
            failed = travel(r, &a, m, next_stop(r), f);
        }
    }
    if (failed == STATUS_OK &&
        (double)(r->grid_row - 1) * p->method.step < duration - 1e-9 * p->method.step) {
        failed = record_row(r, &a, m, m->state, 0); // the end lies between rows of the grid
    }
    s->steps = (double)m->steps;
    s->max_penetration_m = fmax(0, m->largest_penetration);
    s->motor_work_J = m->state[SLOT_MOTOR_WORK];
    s->separations += r->separated;
    if (!isnan(s->first_contact_s)) {
        if (r->pulse_open) {
            close_first_pulse(r, m);
            s->first_pulse_s = (double)NAN; // it never ended
        }
        if (m->pulse_peak >= 0) {
            s->peak_force_N = m->pulse_peak;
            s->time_to_peak_s = m->pulse_peak_time - s->first_contact_s;
        }
    }
    if (failed == STATUS_OK) {
        recording_finish_summary(r, state_quadratures(m, m->state)[QUADRATURE_FORCE] -
                                        r->integral_at_window);
        recording_finish_rig_summary(r, state_angles(m, m->state)[0]);
    }
    motion_destroy(m);
    return failed;
}
