// The run of the printed arm: what a row records, script and rig between rows, the
// summary.
#include "src/run/printed_run.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/sincos.h"
#include "src/run/recording.h"

// --- what a step is recorded as --------------------------------------------------------

// Adds an event to the trace; `index` is that of an action of the script, -1 for others.
static status record_event(recording *r, double time, event_kind kind, int index)
{
    return trace_add_event(&r->result->trace,
                           (event){.time = time, .kind = kind, .index = index});
}

// Notes the largest force of the run and of its first pulse. As in the thesis's program,
// the peaks are values of rows, not maxima of parabolas between rows.
static void note_peaks(printed_run *p, const printed_row *row)
{
    summary *s = &p->recording->result->summary;
    const double time_in_contact = row->time - s->first_contact_s;
    const bool largest = row->force > s->peak_force_N;
    const bool largest_of_first =
        isnan(s->first_pulse_s) && row->force > s->first_pulse_peak_N;

    if (largest) {
        s->peak_force_N = row->force;
        s->time_to_peak_s = time_in_contact;
    }
    if (largest_of_first) {
        s->first_pulse_peak_N = row->force;
        s->first_pulse_time_to_peak_s = time_in_contact;
    }
}

// Updates what the summary says of contact with a new row, and records the event if
// contact begins or ends there. Penetration is the gap below zero.
static status note_contact(printed_run *p, const printed_row *row)
{
    recording *r = p->recording;
    summary *s = &r->result->summary;
    const bool was_in_contact = p->in_contact;

    // the first row in contact: pulse and peaks count from here
    s->max_penetration_m = fmax(s->max_penetration_m, -row->gap);
    if (row->contact && isnan(s->first_contact_s)) {
        s->first_contact_s = row->time;
        s->peak_force_N = s->first_pulse_peak_N = -1;
        s->first_pulse_s = (double)NAN;
    }
    if (isnan(s->first_contact_s)) {
        return STATUS_OK; // the wall is still to be met
    }

    // contact begins or ends
    note_peaks(p, row);
    if (row->contact && !was_in_contact) {
        s->impacts++;
        if (p->separated) {
            s->separations++;
        }
        p->separated = false;
        TRY(record_event(r, row->time, EVENT_CONTACT, -1));
    } else if (was_in_contact && !row->contact) {
        if (isnan(s->first_pulse_s)) {
            s->first_pulse_s = row->time - s->first_contact_s;
        }
        TRY(record_event(r, row->time, EVENT_RELEASE, -1));
    }

    // for the next row
    p->in_contact = row->contact;
    p->separated = p->separated || row->gap > SEPARATION_GAP;
    return STATUS_OK;
}

// A row in which every signal is NaN. So remain those that the printed equations do not
// have: energies, and the rate of the gap.
#define NONE(name, ...) .name = (double)NAN,
static const sample row_without_values = {SIGNALS(NONE)};
#undef NONE

static sample present_row(const void *run)
{
    const printed_run *p = run;
    const printed_row *row = &p->motion.row;
    const motor_model *motor = &p->motion.arm.motor;

    sample sampled = row_without_values;
    sampled.time = row->time;
    sampled.hub_angle = row->angle[0];
    sampled.first_angle = row->angle[1];
    sampled.last_angle = row->angle[2];
    sampled.hub_velocity = row->velocity[0];
    sampled.first_velocity = row->velocity[1];
    sampled.last_velocity = row->velocity[2];
    sampled.hub_acceleration = row->acceleration[0];
    sampled.first_acceleration = row->acceleration[1];
    sampled.last_acceleration = row->acceleration[2];
    sampled.gap = row->gap;
    sampled.force = row->force;
    sampled.impulse = sampled.sticking = 0;
    sampled.contact = row->contact;
    sampled.voltage = motor->voltage;
    sampled.motor_torque = motor->torque;
    recording_add_rig_signals(p->recording, &sampled);
    return sampled;
}

// The motion that the sensors measure at a row.
static sensed_motion sensed_at(const printed_arm *a, const printed_row *row)
{
    const double first = row->angle[1] - row->angle[0], last = row->angle[2];
    const double l = a->link_length, bend = last - row->angle[1];
    return (sensed_motion){.time = row->time,
                           .tip_deflection =
                               l * (inline_sin(first) + inline_sin(last - row->angle[0])),
                           .root_curvature = bend / l,
                           .angle = row->angle[0],
                           .velocity = row->velocity[0],
                           .acceleration = row->acceleration[0],
                           .bending = row->angle[2] - row->angle[1],
                           .bending_rate = row->velocity[2] - row->velocity[1],
                           .force = row->force};
}

// Records the motion's present row, if the run has rows.
static status keep_row(const printed_run *p)
{
    if (!recording_has_rows(p->recording)) {
        return STATUS_OK;
    }
    const sample sampled = present_row(p);
    const printed_row *row = &p->motion.row;
    return recording_add_row(p->recording, &sampled, row->angle, row->velocity);
}

// Records the motion's present row: contact, the sensors' reading of the step to it, the
// force over that step, and its signals.
static status record_row(printed_run *p, fault *f)
{
    recording *r = p->recording;
    const printed_row *row = &p->motion.row;
    status failed = note_contact(p, row);

    // the step to this row; to the row at time 0 it has no length
    const sensed_motion now = sensed_at(&p->motion.arm, row);
    force_step step = {.start = row->time, .end = row->time, .last = row->force};
    sensed_motion before = now;
    if (p->begun) {
        step.start = p->last.end;
        step.first = p->last.last;
        before = p->sensed;
    }
    step.mean = (step.first + step.last) / 2;

    // the sensors follow that step
    if (r->rig != NULL) {
        sensors_follow(&r->rig->sensors, row->time - step.start, &before, &now,
                       step.mean);
    }

    // the mean force over the window at the end of the run
    if (p->begun && row->time > r->scenario->parameters.run.duration - STEADY_WINDOW) {
        p->steady_sum += row->force;
        p->steady_rows++;
    }

    // this row is the last one of the run so far
    p->sensed = now;
    p->last = step;
    p->begun = true;
    p->ready = false;

    // into force history and trace
    TRY(failed);
    TRY(force_history_add(&r->result->history.forces, step));
    TRY(keep_row(p));
    FAULT_IF(recording_asked_to_stop(r), f, STATUS_STOPPED, "at t = %.9g s: %s",
             row->time, status_text(STATUS_STOPPED));
    return STATUS_OK;
}

// --- between steps ---------------------------------------------------------------------

// Sets a parameter at the present row and records that as action `index` of the script,
// -1 for an action from outside. The value takes effect with the next step.
static status set_parameter(printed_run *p, const action *todo, int index, fault *f)
{
    assert(todo->kind == ACTION_SET);
    recording *r = p->recording;
    const double time = p->motion.row.time;

    recording_before_change(r, todo, time, p->sensed.angle);
    status failed = recording_set(r, todo, time, f);
    if (failed == STATUS_OK) {
        failed = record_event(r, time, EVENT_CHANGE, index);
    }

    // the arm takes it, and the command in force stays
    printed_motion_rebind(&p->motion, &r->now);
    if (r->rig != NULL) {
        motor_set_voltage(&p->motion.arm.motor, r->rig->voltage);
    }
    return failed;
}

// Lets the rig sample its sensors and change its command, if it is due at the present
// row.
static status run_rig(printed_run *p, fault *f)
{
    recording *r = p->recording;
    if (r->rig == NULL) {
        return STATUS_OK;
    }

    // what it does now; a new command takes effect at once
    bool changed;
    const double time = p->motion.row.time;
    status failed = rig_act(r->rig, time, &p->sensed, &changed, f);
    if (failed == STATUS_OK && changed) {
        recording_change_command(r, time, p->sensed.angle);
    }

    // the motor has the controller's command, not motor.voltage
    motor_set_voltage(&p->motion.arm.motor, r->rig->voltage);
    TRY(failed);

    // a new sample or command is a jump, which has a second row at this instant
    const bool sampled = recording_has_new_sample(r);
    if (sampled) {
        recording_show_sample(r);
    }
    if (sampled || changed) {
        return keep_row(p);
    }
    return STATUS_OK;
}

// Carries out the actions of the script and of the rig that are due at the present row,
// once for each row.
static status prepare_step(void *run, bool *ended, fault *f)
{
    printed_run *p = run;
    *ended = printed_motion_ended(&p->motion);
    if (*ended || p->ready) {
        return STATUS_OK;
    }

    // the script, then the rig
    const scenario *s = p->recording->scenario;
    int *next = &p->recording->state.next_action;
    for (; *next < s->action_count && s->actions[*next].time <= p->motion.row.time;
         ++*next) {
        TRY(set_parameter(p, &s->actions[*next], *next, f));
    }
    TRY(run_rig(p, f));
    p->ready = true;
    return STATUS_OK;
}

// Makes the next step, to its row: a step of the printed algorithm cannot be cut.
static status step(void *run, double until, fault *f)
{
    printed_run *p = run;
    (void)until; // not heeded
    TRY(printed_motion_step(&p->motion, f));
    return record_row(p, f);
}

// --- the summary -----------------------------------------------------------------------

// Fills in the summary of the run so far; only a complete one has a steady force.
static void sum_up(void *run, status failed)
{
    printed_run *p = run;
    assert(p->begun);

    // method and steps; equation (2.16) as printed conserves no energy
    recording *r = p->recording;
    summary *s = &r->result->summary;
    snprintf(s->method, sizeof s->method, "Newmark, as printed");
    s->steps = (double)p->motion.steps;
    s->motor_work_J = s->energy_residual_J = (double)NAN;

    // contact: a flight that the run ends in, and the landing
    if (p->separated) {
        s->separations++;
    }
    if (!isnan(s->first_contact_s)) {
        s->sensor_1ms_peak_N = force_largest_sensed(r->result, 1e-3, HUGE_VAL);
        r->result->landing = (landing){s->first_contact_s,
                                       s->contact_impulse_Ns,
                                       s->first_pulse_peak_N,
                                       s->first_pulse_time_to_peak_s,
                                       {.angle = {(double)NAN}}};
    }

    // what only a complete run has
    if (failed == STATUS_OK) {
        const double duration = r->scenario->parameters.run.duration;
        double mean = 0;
        if (p->steady_rows > 0) {
            mean = p->steady_sum / p->steady_rows;
        }
        recording_finish_summary(r, mean * fmin(STEADY_WINDOW, duration));
        recording_finish_rig_summary(r, p->sensed.angle);
    }
}

static void finish(void *run, status failed)
{
    const printed_run *p = run;
    if (p->begun) {
        sum_up(run, failed);
    }
}

// --- the beginning ---------------------------------------------------------------------

static status open_run(void *run, recording *r, fault *f)
{
    printed_run *p = run;
    assert(r->scenario->parameters.arm.model == ARM_PRINTED);
    *p = (printed_run){.recording = r};
    TRY(recording_open_trace(r, 3, f));

    // a script with pushes is refused
    for (int i = 0; i < r->scenario->action_count; i++) {
        const action *a = &r->scenario->actions[i];
        FAULT_IF(
            a->kind == ACTION_PUSH, f, STATUS_BAD_SCENARIO,
            "the script pushes the arm at %g s, but the printed model knows no pushes",
            a->time);
    }

    // the row of time 0, with the command that the rig starts with
    shared_array_init(&r->result->history.forces, sizeof(force_step));
    printed_motion_start(&p->motion, &r->now);
    if (r->rig != NULL) {
        motor_set_voltage(&p->motion.arm.motor, r->rig->voltage);
    }
    return record_row(p, f);
}

// --- at present ------------------------------------------------------------------------

static status act(void *run, const action *todo, fault *f)
{
    return set_parameter(run, todo, -1, f);
}

static double present_time(const void *run)
{
    const printed_run *p = run;
    return p->motion.row.time;
}

static bool has_ended(const void *run)
{
    const printed_run *p = run;
    return printed_motion_ended(&p->motion);
}

static sensed_motion present_sensed(const void *run)
{
    const printed_run *p = run;
    return p->sensed;
}

static const double *present_state(const void *run, int *angle_count)
{
    const printed_run *p = run;
    *angle_count = 3;
    return p->motion.row.angle; // velocities stand behind them
}

// --- the state as bytes ----------------------------------------------------------------

static size_t saved_size(const void *run)
{
    (void)run;
    return sizeof(printed_run);
}

static void save(const void *run, void *bytes)
{
    printed_run saved = *(const printed_run *)run;
    saved.recording = NULL; // an address is no part of a state
    memcpy(bytes, &saved, sizeof saved);
}

static void restore(void *run, const void *bytes)
{
    printed_run *p = run;
    recording *own = p->recording;
    memcpy(p, bytes, sizeof *p);
    p->recording = own;
}

const run_model printed_model = {.stops_at_rows = true,
                                 .open = open_run,
                                 .prepare_step = prepare_step,
                                 .step = step,
                                 .act = act,
                                 .sum_up = sum_up,
                                 .finish = finish,
                                 .time = present_time,
                                 .has_ended = has_ended,
                                 .sensed = present_sensed,
                                 .row = present_row,
                                 .state = present_state,
                                 .saved_size = saved_size,
                                 .save = save,
                                 .restore = restore};
