// A run of the printed arm: what its rows make of the summary, and how the rig samples it.
#include "src/run/recording.h"

#include <math.h>

#include "src/solve/printed_algorithm.h"

static bool observe_printed(void *context, const printed_row *row)
{
    recording *r = context;
    summary *s = &r->result->summary;
    bool was_in_contact = r->pulse_open;
    s->steps += row->time > 0;
    s->max_penetration_m = fmax(s->max_penetration_m, -row->gap);
    if (row->contact && isnan(s->first_contact_s)) {
        s->first_contact_s = row->time;
        s->peak_force_N = s->first_pulse_peak_N = -1;
        r->pulse_open = was_in_contact = true;
        s->first_pulse_s = (double)NAN;
        trace_add_event(&r->result->trace,
                        (event){.time = row->time, .kind = EVENT_CONTACT, .index = -1});
    }
    if (!isnan(s->first_contact_s)) {
        double since = row->time - s->first_contact_s;
        if (row->force > s->peak_force_N) {
            s->peak_force_N = row->force;
            s->time_to_peak_s = since;
        }
        bool first_pulse = isnan(s->first_pulse_s);
        if (first_pulse && row->force > s->first_pulse_peak_N) {
            s->first_pulse_peak_N = row->force;
            s->first_pulse_time_to_peak_s = since;
        }
        if (was_in_contact && !row->contact) {
            r->pulse_open = false;
            if (first_pulse) {
                s->first_pulse_s = since;
            }
            trace_add_event(&r->result->trace,
                            (event){.time = row->time, .kind = EVENT_RELEASE, .index = -1});
        } else if (!was_in_contact && row->contact) {
            r->pulse_open = true;
            s->separations += r->separated;
            r->separated = false;
            trace_add_event(&r->result->trace,
                            (event){.time = row->time, .kind = EVENT_CONTACT, .index = -1});
        }
        s->impacts += row->contact && (!was_in_contact || since == 0);
        r->separated |= row->gap > SEPARATION_GAP;
    }
    const motor_parameters *motor = &r->now.motor;
    sample sampled = {
        .time = row->time,
        .hub_angle = row->angle[0],
        .first_angle = row->angle[1],
        .last_angle = row->angle[2],
        .hub_velocity = row->velocity[0],
        .first_velocity = row->velocity[1],
        .last_velocity = row->velocity[2],
        .hub_acceleration = row->acceleration[0],
        .first_acceleration = row->acceleration[1],
        .last_acceleration = row->acceleration[2],
        .gap = row->gap,
        .gap_velocity = (double)NAN,
        .force = row->force,
        .contact = row->contact,
        .voltage = motor_limited_voltage(motor, motor->voltage),
        .motor_torque = motor_torque_per_volt(motor) * motor_limited_voltage(motor, motor->voltage),
        .friction_torque = (double)NAN,
        .kinetic_energy = (double)NAN,
        .strain_energy = (double)NAN,
        .motor_work = (double)NAN,
        .external_work = (double)NAN,
        .viscous_loss = (double)NAN,
        .friction_loss = (double)NAN,
        .damping_loss = (double)NAN,
        .impact_loss = (double)NAN,
        .energy_residual = (double)NAN,
    };
    recording_add_rig_signals(r, &sampled);
    double before = r->count > 0 ? r->steps[r->count - 1].last : 0;
    double start = r->count > 0 ? r->steps[r->count - 1].end : row->time;
    force_step step = {start, row->time, before, row->force, (before + row->force) / 2};
    if (r->rig != NULL) {
        sensed_motion last = {.angle = row->angle[0],
                              .velocity = row->velocity[0],
                              .acceleration = row->acceleration[0],
                              .bending = row->angle[2] - row->angle[1],
                              .bending_rate = row->velocity[2] - row->velocity[1],
                              .force = row->force};
        sensed_motion first = r->count > 0 ? r->after_step : last;
        sensors_follow(&r->rig->sensors, row->time - start, &first, &last, step.mean);
        r->after_step = last;
    }
    if (r->rig_status == STATUS_OK && recording_asked_to_stop(r)) {
        r->rig_status = fault_set(r->rig_fault, STATUS_STOPPED, "at t = %.9g s: %s", row->time,
                                  status_text(STATUS_STOPPED));
    }
    return r->rig_status == STATUS_OK && recording_add_step(r, step) == STATUS_OK &&
           (!r->keep_trace ||
            recording_add_row(r, &sampled, row->angle, row->velocity) == STATUS_OK);
}

// Scripted changes take effect at the next step; the printed model knows no pushes.
static void script_printed(void *context, double time, parameters *p)
{
    recording *r = context;
    const scenario *s = r->scenario;
    for (; r->next_action < s->action_count && s->actions[r->next_action].time <= time;
         r->next_action++) {
        const action *todo = &s->actions[r->next_action];
        if (todo->kind == ACTION_SET) {
            action_apply(todo, p, NULL); // the reader has checked the value
            if (r->rig != NULL && r->rig_status == STATUS_OK) {
                r->rig_status = rig_lock(r->rig, p->control.lock, r->rig_fault);
            }
            trace_add_event(&r->result->trace,
                            (event){.time = time, .kind = EVENT_CHANGE, .index = r->next_action});
        }
    }
    if (r->rig != NULL && r->rig_status == STATUS_OK) {
        bool changed;
        r->rig_status = rig_act(r->rig, time, &r->after_step, &changed, r->rig_fault);
        if (changed) {
            recording_book_electrical_energy(r, time, r->after_step.angle);
        }
        p->motor.voltage = r->rig->voltage;
    }
    r->now = *p;
}

// The printed algorithm knows its force at its rows only: moves a peak that lies at one of them,
// `*since` after first contact, to the top of the parabola through it and its neighbours.
static void refine_sampled_peak(const recording *r, double *force, double *since)
{
    double at = r->result->summary.first_contact_s + *since;
    for (size_t i = 1; i + 1 < r->count; i++) {
        if (r->steps[i].end != at) {
            continue;
        }
        double before = r->steps[i - 1].last, after = r->steps[i + 1].last;
        double h = r->steps[i].end - r->steps[i - 1].end;
        double second = before - 2 * *force + after, slope = (after - before) / 2;
        bool inside = before > 0 && after > 0 && second < 0; // not at the edge of a pulse
        if (inside && fabs(slope) <= -second) {
            *since += -slope / second * h;
            *force -= slope * slope / (2 * second);
        }
        return;
    }
}

status run_printed(recording *r, fault *f)
{
    const parameters *p = &r->scenario->parameters;
    status opened = recording_open_trace(r, 3, f);
    if (opened != STATUS_OK) {
        return opened;
    }
    for (int i = 0; i < r->scenario->action_count; i++) {
        if (r->scenario->actions[i].kind == ACTION_PUSH) {
            return fault_set(
                f, STATUS_BAD_SCENARIO,
                "the script pushes the arm at %g s, but the printed model knows no pushes",
                r->scenario->actions[i].time);
        }
    }
    r->rig_fault = f;
    status s = printed_run(&r->now, observe_printed, script_printed, r, f);
    s = s == STATUS_OK ? r->rig_status : s;
    summary *sum = &r->result->summary;
    sum->motor_work_J = sum->energy_residual_J =
        (double)NAN; // (2.16) as printed conserves no energy
    sum->separations += r->separated;
    if (!isnan(sum->first_contact_s)) {
        refine_sampled_peak(r, &sum->first_pulse_peak_N, &sum->first_pulse_time_to_peak_s);
        refine_sampled_peak(r, &sum->peak_force_N, &sum->time_to_peak_s);
    }
    snprintf(sum->method, sizeof sum->method, "Newmark, as printed");
    if (s == STATUS_OK && r->count > 0) {
        double window = p->run.duration - STEADY_WINDOW, total = 0, weight = 0;
        for (size_t i = 1; i < r->count; i++) {
            if (r->steps[i].end > window) {
                total += r->steps[i].last;
                weight++;
            }
        }
        recording_finish_summary(
            r, weight > 0 ? total / weight * fmin(STEADY_WINDOW, p->run.duration) : 0);
        recording_finish_rig_summary(r, r->after_step.angle);
    }
    return s;
}
