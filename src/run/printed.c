#include "src/run/printed.h"

#include <assert.h>
#include <math.h>

#include "src/run/rig_recording.h"
#include "src/solve/printed_algorithm.h"

// A run of the printed arm in progress.
typedef struct printed_run_state {
    recording *recording;
    printed_motion motion; // with the command in force
    sensed_motion sensed;  // what the sensors were fixed to at the last row
} printed_run_state;

// --- what a step is recorded as ---------------------------------------------------------------

static status record_event(recording *r, double time, event_kind kind, int index)
{
    return trace_add_event(&r->result->trace, (event){.time = time, .kind = kind, .index = index});
}

// The first row in contact: pulse and peaks count from here.
static void begin_first_pulse(recording *r, const printed_row *row)
{
    summary *s = &r->result->summary;
    s->first_contact_s = row->time;
    s->peak_force_N = s->first_pulse_peak_N = -1;
    s->first_pulse_s = (double)NAN;
}

// The largest forces so far, of the run and of its first pulse.
static void note_peaks(recording *r, const printed_row *row)
{
    summary *s = &r->result->summary;
    double since = row->time - s->first_contact_s;
    if (row->force > s->peak_force_N) {
        s->peak_force_N = row->force;
        s->time_to_peak_s = since;
    }
    if (isnan(s->first_pulse_s) && row->force > s->first_pulse_peak_N) {
        s->first_pulse_peak_N = row->force;
        s->first_pulse_time_to_peak_s = since;
    }
}

// Takes note of contact that begins or ends with the row.
static status note_contact(recording *r, const printed_row *row)
{
    summary *s = &r->result->summary;
    recording_state *state = &r->state;
    const bool was_in_contact = state->pulse_open;
    status failed = STATUS_OK;

    // the first row in contact
    s->max_penetration_m = fmax(s->max_penetration_m, -row->gap);
    if (row->contact && isnan(s->first_contact_s)) {
        begin_first_pulse(r, row);
    }
    if (isnan(s->first_contact_s)) {
        return STATUS_OK; // the wall is still to be met
    }

    // contact begins anew, or ends
    note_peaks(r, row);
    if (row->contact && !was_in_contact) {
        s->impacts++;
        s->separations += state->separated;
        state->separated = false;
        failed = record_event(r, row->time, EVENT_CONTACT, -1);
    } else if (was_in_contact && !row->contact) {
        if (isnan(s->first_pulse_s)) {
            s->first_pulse_s = row->time - s->first_contact_s;
        }
        failed = record_event(r, row->time, EVENT_RELEASE, -1);
    }

    state->pulse_open = row->contact;
    state->separated |= row->gap > SEPARATION_GAP;
    return failed;
}

static status add_row(const printed_run_state *run, const printed_row *row)
{
    recording *r = run->recording;
    const motor_model *motor = &run->motion.arm.motor;
    if (!r->options->keep_trace) {
        return STATUS_OK;
    }

    // the printed equations keep no energies, and their listing no rate of the gap
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
        .voltage = motor->voltage,
        .motor_torque = motor->torque,
        .friction_torque = (double)NAN,
        .kinetic_energy = (double)NAN,
        .strain_energy = (double)NAN,
        .motor_work = (double)NAN,
        .external_work = (double)NAN,
        .viscous_loss = (double)NAN,
        .friction_loss = (double)NAN,
        .damping_loss = (double)NAN,
        .impact_loss = (double)NAN,
        .wall_energy = (double)NAN,
        .wall_loss = (double)NAN,
        .energy_residual = (double)NAN,
    };

    recording_add_rig_signals(r, &sampled);
    return recording_add_row(r, &sampled, row->angle, row->velocity);
}

static sensed_motion sensed_at(const printed_row *row)
{
    return (sensed_motion){.angle = row->angle[0],
                           .velocity = row->velocity[0],
                           .acceleration = row->acceleration[0],
                           .bending = row->angle[2] - row->angle[1],
                           .bending_rate = row->velocity[2] - row->velocity[1],
                           .force = row->force};
}

// Records a row: contact, what the sensors feel, force, signals.
static status record_row(printed_run_state *run, fault *f)
{
    recording *r = run->recording;
    const printed_row *row = &run->motion.row;
    const force_history *forces = &r->result->history.forces;
    status failed = note_contact(r, row);

    // the force over the step, which the row of time 0 has none of
    bool first = forces->count == 0;
    const force_step *last = first ? NULL : &force_steps(forces)[forces->count - 1];
    double before = first ? 0 : last->last, start = first ? row->time : last->end;
    force_step step = {start, row->time, before, row->force, (before + row->force) / 2};

    // what the sensors felt of it
    if (r->rig != NULL) {
        sensed_motion now = sensed_at(row);
        sensors_follow(&r->rig->sensors, row->time - start, first ? &now : &run->sensed, &now,
                       step.mean);
        run->sensed = now;
    }

    if (failed == STATUS_OK) {
        failed = recording_add_step(r, step);
    }
    if (failed == STATUS_OK) {
        failed = add_row(run, row);
    }
    if (failed == STATUS_OK && recording_asked_to_stop(r)) {
        failed = fault_set(f, STATUS_STOPPED, "at t = %.9g s: %s", row->time,
                           status_text(STATUS_STOPPED));
    }
    return failed;
}

// --- between steps ----------------------------------------------------------------------------

// Carries out the script's actions that are due; they take effect at the coming step.
static status run_script(printed_run_state *run, fault *f)
{
    recording *r = run->recording;
    const scenario *s = r->scenario;
    const double time = run->motion.row.time;
    bool changed = false;

    // all that is due by now
    for (; r->state.next_action < s->action_count; r->state.next_action++) {
        const action *todo = &s->actions[r->state.next_action];
        if (todo->time > time) {
            break;
        }

        status failed = action_apply(todo, &r->now, f);
        if (failed == STATUS_OK && r->rig != NULL) {
            failed = rig_lock(r->rig, r->now.control.lock, f);
        }
        if (failed == STATUS_OK && r->rig != NULL) {
            failed = rig_retune(r->rig, &r->now, time, f);
        }
        if (failed == STATUS_OK) {
            failed = record_event(r, time, EVENT_CHANGE, r->state.next_action);
        }
        if (failed != STATUS_OK) {
            return failed;
        }
        changed = true;
    }

    // the arm takes new parameters once
    if (changed) {
        printed_motion_rebind(&run->motion, &r->now);
    }
    return STATUS_OK;
}

// Samples the sensors and changes the command where the time for it has come.
static status run_rig(printed_run_state *run, fault *f)
{
    recording *r = run->recording;
    if (r->rig == NULL) {
        return STATUS_OK;
    }

    // a new command begins at once
    bool changed;
    const double time = run->motion.row.time;
    status failed = rig_act(r->rig, time, &run->sensed, &changed, f);
    if (failed == STATUS_OK && changed) {
        recording_change_command(r, time, run->sensed.angle);
    }

    // the controller's command, not motor.voltage
    printed_motion_set_voltage(&run->motion, r->rig->voltage);
    return failed;
}

// --- the summary ------------------------------------------------------------------------------

// The printed algorithm knows its force at its rows only: moves a peak that lies at one of them,
// `*since` after first contact, to the top of the parabola through it and its neighbours.
static void refine_sampled_peak(const recording *r, double *force, double *since)
{
    const force_history *forces = &r->result->history.forces;
    const force_step *steps = force_steps(forces);
    double at = r->result->summary.first_contact_s + *since;
    for (size_t i = 1; i + 1 < forces->count; i++) {
        if (steps[i].end != at) {
            continue;
        }

        // the top lies between the neighbours where the parabola opens downwards
        double before = steps[i - 1].last, after = steps[i + 1].last;
        double h = steps[i].end - steps[i - 1].end;
        double second = before - 2 * *force + after, slope = (after - before) / 2;
        bool inside = before > 0 && after > 0 && second < 0; // not at the edge of a pulse
        if (inside && fabs(slope) <= -second) {
            *since += -slope / second * h;
            *force -= slope * slope / (2 * second);
        }
        return;
    }
}

// The integral of the force over the window of the steady force [N s], from the mean of its rows.
static double steady_integral(const recording *r)
{
    const force_history *forces = &r->result->history.forces;
    const force_step *steps = force_steps(forces);
    double duration = r->scenario->parameters.run.duration, window = duration - STEADY_WINDOW;
    double total = 0, weight = 0;
    for (size_t i = 1; i < forces->count; i++) {
        if (steps[i].end > window) {
            total += steps[i].last;
            weight++;
        }
    }
    return weight > 0 ? total / weight * fmin(STEADY_WINDOW, duration) : 0;
}

// Sums up what is known of a run, also of one that failed.
static void sum_up(const printed_run_state *run, status failed)
{
    recording *r = run->recording;
    summary *s = &r->result->summary;
    snprintf(s->method, sizeof s->method, "Newmark, as printed");
    s->steps = (double)run->motion.steps;
    s->motor_work_J = s->energy_residual_J = (double)NAN; // (2.16) as printed conserves no energy
    s->separations += r->state.separated;

    // peaks between rows
    if (!isnan(s->first_contact_s)) {
        refine_sampled_peak(r, &s->first_pulse_peak_N, &s->first_pulse_time_to_peak_s);
        refine_sampled_peak(r, &s->peak_force_N, &s->time_to_peak_s);
    }

    // what only a whole run has
    if (failed == STATUS_OK) {
        recording_finish_summary(r, steady_integral(r));
        recording_finish_rig_summary(r, run->sensed.angle);
    }
}

// The printed model knows no pushes.
static status refuse_pushes(const scenario *s, fault *f)
{
    for (int i = 0; i < s->action_count; i++) {
        if (s->actions[i].kind == ACTION_PUSH) {
            return fault_set(
                f, STATUS_BAD_SCENARIO,
                "the script pushes the arm at %g s, but the printed model knows no pushes",
                s->actions[i].time);
        }
    }
    return STATUS_OK;
}

status run_printed(recording *r, fault *f)
{
    assert(r != NULL && r->scenario->parameters.arm.model == ARM_PRINTED);

    // what the printed model does not know is refused
    printed_run_state run = {.recording = r};
    status failed = recording_open_trace(r, 3, f);
    if (failed == STATUS_OK) {
        failed = refuse_pushes(r->scenario, f);
    }
    if (failed != STATUS_OK) {
        return failed;
    }

    // the row of time 0, with the command that the rig starts with
    force_history_init(&r->result->history.forces);
    printed_motion_start(&run.motion, &r->now);
    if (r->rig != NULL) {
        printed_motion_set_voltage(&run.motion, r->rig->voltage);
    }
    failed = record_row(&run, f);

    // between two rows: script, rig, a step
    while (failed == STATUS_OK && !printed_motion_ended(&run.motion)) {
        failed = run_script(&run, f);
        if (failed == STATUS_OK) {
            failed = run_rig(&run, f);
        }
        if (failed == STATUS_OK) {
            failed = printed_motion_step(&run.motion, f);
        }
        if (failed == STATUS_OK) {
            failed = record_row(&run, f);
        }
    }

    sum_up(&run, failed);
    return failed;
}
