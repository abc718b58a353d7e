// Rows, steps and the summary of a run in progress, whichever model it is of.
#include "src/run/recording.h"

#include <math.h>

status recording_add_step(recording *r, force_step step)
{
    if (r->count == r->capacity) {
        shared_array *c = r->keeps_history ? &r->result->history.steps : &r->own_steps;
        if (!shared_array_grow(c, r->count + 1)) {
            return STATUS_NO_MEMORY;
        }
        r->steps = c->base;
        r->capacity = c->capacity;
    }
    r->steps[r->count++] = step;
    r->result->history.step_count = r->keeps_history ? r->count : 0;
    return STATUS_OK;
}

bool recording_asked_to_stop(const recording *r)
{
    const run_monitor *m = r->options.monitor;
    return m != NULL && atomic_load_explicit(&m->stop, memory_order_relaxed);
}

void recording_publish(const recording *r, double time)
{
    run_monitor *m = r->options.monitor;
    if (m != NULL) {
        const trace *t = &r->result->trace;
        atomic_store_explicit(&m->time, time, memory_order_relaxed);
        atomic_store_explicit(&m->events, t->event_count, memory_order_release);
        atomic_store_explicit(&m->rows, t->row_count, memory_order_release);
    }
}

status recording_add_row(recording *r, const sample *row, const double *angles,
                         const double *velocities)
{
    status s = trace_add_row(&r->result->trace, row, angles, velocities);
    recording_publish(r, row->time);
    return s;
}

status recording_open_trace(recording *r, int angle_count, fault *f)
{
    size_t expected = r->options.rows_expected;
    if (expected == 0) {
        trace_init(&r->result->trace, angle_count);
        return STATUS_OK;
    }
    size_t most = rows_at_most(expected);
    status s = trace_reserve(&r->result->trace, angle_count, expected, most);
    return s == STATUS_OK ? s : fault_set(f, s, "no address space for %zu rows", expected);
}

// The last instant within a step at which the force is `edge`, as a share of it; -1 if none.
static double last_crossing(const force_step *step, double edge)
{
    double curve = 3 * (step->first + step->last) - 6 * step->mean;
    double slope = step->last - step->first - curve, offset = step->first - edge;
    double latest = -1;
    if (fabs(curve) < 1e-12 * (fabs(slope) + fabs(offset))) {
        double s = slope != 0 ? -offset / slope : -1;
        return s >= 0 && s <= 1 ? s : -1;
    }
    double square = slope * slope - 4 * curve * offset;
    for (int sign = -1; sign <= 1 && square >= 0; sign += 2) {
        double s = (-slope + sign * sqrt(square)) / (2 * curve);
        latest = s >= 0 && s <= 1 && s > latest ? s : latest;
    }
    return latest;
}

// Time after which the force stays within the band round `final` for good, each step taken as the
// parabola through its ends with its mean; NaN if the run ends outside.
static double settled_since(const recording *r, double final)
{
    double band = SETTLED_BAND * fabs(final);
    for (size_t i = r->count; i-- > 0;) {
        const force_step *step = &r->steps[i];
        double upper = last_crossing(step, final + band), lower = last_crossing(step, final - band);
        double left = fmax(upper, lower);
        if (fabs(step->last - final) > band) {
            // outside at its end: inside only from the next step's start on
            return i + 1 == r->count ? (double)NAN : step->end;
        }
        if (left >= 0) {
            return step->start + left * (step->end - step->start);
        }
    }
    return r->count > 0 ? r->steps[0].start : (double)NAN;
}

void recording_add_rig_signals(const recording *r, sample *row)
{
    const rig *on = r->rig;
    bool sampled = on != NULL && on->samples > 0;
    row->encoder = sampled ? on->reading.encoder : (double)NAN;
    row->tachometer = sampled ? on->reading.tachometer : (double)NAN;
    row->force_reading = sampled ? on->reading.force_reading : (double)NAN;
    row->piezo_force = sampled ? on->reading.piezo_force : (double)NAN;
    row->film = sampled ? on->reading.film : (double)NAN;
    row->accelerometer = sampled ? on->reading.accelerometer : (double)NAN;
    row->command = sampled ? on->output.command : (double)NAN;
    row->controller_mode = sampled ? on->output.mode : (double)NAN;
    row->desired_angle = sampled ? on->output.desired_angle : (double)NAN;
    row->desired_velocity = sampled ? on->output.desired_velocity : (double)NAN;
    row->calculated_force = sampled ? on->output.calculated_force : (double)NAN;
}

void recording_book_electrical_energy(recording *r, double time, double hub_angle)
{
    const motor_parameters *motor = &r->now.motor;
    r->result->summary.electrical_energy_J += motor_electrical_energy(
        motor, motor->voltage, time - r->command_time, hub_angle - r->command_angle);
    r->command_time = time;
    r->command_angle = hub_angle;
}

status recording_start_rig(recording *r, fault *f)
{
    const parameters *p = &r->scenario->parameters;
    if (p->control.law == LAW_NONE) {
        return STATUS_OK;
    }
    r->now.motor.voltage = 0;
    r->command_angle = p->initial.angle;
    r->result->summary.electrical_energy_J = 0;
    status s = rig_create(&r->rig, p, f);
    return s == STATUS_OK ? scenario_check_locks(r->scenario, r->rig->law, f) : s;
}

void recording_finish_rig_summary(recording *r, double hub_angle)
{
    summary *s = &r->result->summary;
    const parameters *p = &r->scenario->parameters;
    if (r->rig != NULL) {
        recording_book_electrical_energy(r, p->run.duration, hub_angle);
        s->largest_command_V = r->rig->largest_command;
        s->force_command_N = p->control.force;
        s->force_over_command_N = s->peak_force_N - p->control.force;
        s->steady_error_N = s->steady_force_N - p->control.force;
    }
}

void recording_finish_summary(recording *r, double force_integral)
{
    summary *s = &r->result->summary;
    double duration = r->scenario->parameters.run.duration;
    s->steady_force_N =
        isnan(s->first_contact_s) ? (double)NAN : force_integral / fmin(STEADY_WINDOW, duration);
    if (isnan(s->first_contact_s)) {
        return;
    }
    if (s->steady_force_N > 0) {
        s->force_overshoot_percent = 100 * (s->peak_force_N / s->steady_force_N - 1);
        double settled = settled_since(r, s->steady_force_N);
        s->settling_time_s = fmax(0, settled - s->first_contact_s);
        if (isnan(settled)) {
            s->settling_time_s = (double)NAN;
        }
    }
}
