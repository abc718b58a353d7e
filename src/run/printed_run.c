// The run of the printed arm: what a row records, script and rig between rows, the
// summary.
#include "src/run/printed_run.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/run/recording.h"

// --- what a step is recorded as --------------------------------------------------------

static status record_event(recording *r, double time, event_kind kind, int index)
{
    return trace_add_event(&r->result->trace,
                           (event){.time = time, .kind = kind, .index = index});
}

// The largest forces so far, of the run and of its first pulse: as the thesis's program
// has it they are samples, and no parabola runs through their neighbours.
static void note_peaks(printed_run *p, const printed_row *row)
{
    summary *s = &p->recording->result->summary;
    const double since = row->time - s->first_contact_s;
    const bool largest = row->force > s->peak_force_N;
    const bool largest_of_first =
        isnan(s->first_pulse_s) && row->force > s->first_pulse_peak_N;

    if (largest) {
        s->peak_force_N = row->force;
        s->time_to_peak_s = since;
    }
    if (largest_of_first) {
        s->first_pulse_peak_N = row->force;
        s->first_pulse_time_to_peak_s = since;
    }
}

// Takes note of contact that begins or ends with the row.
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

    // contact begins again, or ends
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

    p->in_contact = row->contact;
    p->separated = p->separated || row->gap > SEPARATION_GAP;
    return STATUS_OK;
}

// What the printed equations do not keep: energies, and their listing no rate of the gap.
#define NONE(name, ...) .name = (double)NAN,
static const sample nothing = {SIGNALS(NONE)};
#undef NONE

static sample present_row(const void *run)
{
    const printed_run *p = run;
    const printed_row *row = &p->motion.row;
    const motor_model *motor = &p->motion.arm.motor;

    sample sampled = nothing;
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

static sensed_motion sensed_at(const printed_row *row)
{
    return (sensed_motion){.angle = row->angle[0],
                           .velocity = row->velocity[0],
                           .acceleration = row->acceleration[0],
                           .bending = row->angle[2] - row->angle[1],
                           .bending_rate = row->velocity[2] - row->velocity[1],
                           .force = row->force};
}

// Keeps the row that the motion stands at, if the run keeps rows.
static status keep_row(const printed_run *p)
{
    if (!p->recording->options->keep_trace) {
        return STATUS_OK;
    }
    const sample sampled = present_row(p);
    const printed_row *row = &p->motion.row;
    return recording_add_row(p->recording, &sampled, row->angle, row->velocity);
}

// Records the row that the motion stands at: contact, what the sensors feel, force,
// signals.
static status record_row(printed_run *p, fault *f)
{
    recording *r = p->recording;
    const printed_row *row = &p->motion.row;
    status failed = note_contact(p, row);

    // the step to it, which the row of time 0 has none of
    const sensed_motion now = sensed_at(row);
    force_step step = {.start = row->time, .end = row->time, .last = row->force};
    sensed_motion before = now;
    if (p->begun) {
        step.start = p->last.end;
        step.first = p->last.last;
        before = p->sensed;
    }
    step.mean = (step.first + step.last) / 2;

    // what the sensors felt of it
    if (r->rig != NULL) {
        sensors_follow(&r->rig->sensors, row->time - step.start, &before, &now,
                       step.mean);
    }

    // the mean force of the end
    if (p->begun && row->time > r->scenario->parameters.run.duration - STEADY_WINDOW) {
        p->steady_sum += row->force;
        p->steady_rows++;
    }

    // the row is the last one now
    p->sensed = now;
    p->last = step;
    p->begun = true;
    p->ready = false;

    // and is kept
    TRY(failed);
    TRY(force_history_add(&r->result->history.forces, step));
    TRY(keep_row(p));
    FAULT_IF(recording_asked_to_stop(r), f, STATUS_STOPPED, "at t = %.9g s: %s",
             row->time, status_text(STATUS_STOPPED));
    return STATUS_OK;
}

// --- between steps ---------------------------------------------------------------------

// Sets a parameter now and records that as action `index` of the script (-1: of no
// script); it takes effect with the coming step.
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

// Samples the sensors and changes the command where the time for it has come.
static status run_rig(printed_run *p, fault *f)
{
    recording *r = p->recording;
    if (r->rig == NULL) {
        return STATUS_OK;
    }

    // a new command begins at once
    bool changed;
    const double time = p->motion.row.time;
    status failed = rig_act(r->rig, time, &p->sensed, &changed, f);
    if (failed == STATUS_OK && changed) {
        recording_change_command(r, time, p->sensed.angle);
    }

    // the controller's command, not motor.voltage
    motor_set_voltage(&p->motion.arm.motor, r->rig->voltage);
    TRY(failed);

    // what jumps has a second row here
    const bool sampled = recording_has_new_sample(r);
    if (sampled) {
        recording_show_sample(r);
    }
    if (sampled || changed) {
        return keep_row(p);
    }
    return STATUS_OK;
}

// Carries out what is due of script and rig, once for each row.
static status prepare_step(void *run, bool *ended, fault *f)
{
    printed_run *p = run;
    *ended = printed_motion_ended(&p->motion);
    if (*ended || p->ready) {
        return STATUS_OK;
    }

    // what jumps at the last row
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

// A step cannot be cut: it ends at its row.
static status step(void *run, double until, fault *f)
{
    printed_run *p = run;
    (void)until;
    TRY(printed_motion_step(&p->motion, f));
    return record_row(p, f);
}

// --- the summary -----------------------------------------------------------------------

static void sum_up(void *run, status failed)
{
    printed_run *p = run;
    assert(p->begun);
    recording *r = p->recording;
    summary *s = &r->result->summary;
    snprintf(s->method, sizeof s->method, "Newmark, as printed");
    s->steps = (double)p->motion.steps;
    s->motor_work_J = s->energy_residual_J =
        (double)NAN; // (2.16) as printed conserves no energy
    if (p->separated) {
        s->separations++;
    }

    // what contact there was
    if (!isnan(s->first_contact_s)) {
        s->sensor_1ms_peak_N = force_largest_sensed(r->result, 1e-3, HUGE_VAL);
        r->result->landing = (landing){s->first_contact_s,
                                       s->contact_impulse_Ns,
                                       s->first_pulse_peak_N,
                                       s->first_pulse_time_to_peak_s,
                                       {.angle = {(double)NAN}}};
    }

    // what only a whole run has
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
    saved.recording = NULL; // where that lies is no part of a state
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
