#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/run/resume.h"
#include "src/run/corrected.h"
#include "src/run/recording.h"

#define SAME_EVENT_TIME 1e-13 // events nearer than this come at once [s]

enum { MOST_EVENTS_AT_ONCE = 100 }; // events without time passing before the run is given up

const char *corrected_advice(const motion *m)
{
    return engine_is_dense(m->engine) ? "" : ", a shorter method.step may help";
}

// Says when and how the run failed, with the method's name.
static status explain(const corrected_run *c, status s, fault *f)
{
    const motion *m = c->motion;
    if (s == STATUS_UNSTABLE) {
        return fault_set(f, s, "at t = %.9g s: %s (residual %.3g J); the method was %s%s",
                         m->state[SLOT_TIME], status_text(s),
                         motion_energy_residual(&c->arm, m, m->state), m->engine->name,
                         corrected_advice(m));
    }
    return fault_set(f, s, "at t = %.9g s: %s", corrected_now(c), status_text(s));
}

// Says where a flat wall could no longer hold the arm.
static status explain_fold(const corrected_run *c, fault *f)
{
    const motion *m = c->motion;
    const double *q = state_angles(m, m->state);
    return fault_set(f, STATUS_FOLDED,
                     "at t = %.9g s: the arm is folded across the hub's axis, its tip on the flat "
                     "wall there, first and last link at %.4g and %.4g rad, across the wall within "
                     "%g rad: no force of a rigid wall holds it so, and the model ends there",
                     m->state[SLOT_TIME], q[c->arm.first], q[c->arm.dof - 1], CHAIN_FOLDED);
}

// Says that the run no longer passes time after that event, and what makes it so.
static status explain_standstill(const corrected_run *c, motion_event last, fault *f)
{
    const motion *m = c->motion;
    char cause[PACE_CAUSE_SIZE];
    pace_tell_cause(&c->arm, m, last, cause, sizeof cause);
    return fault_set(f, STATUS_NO_PROGRESS, "at t = %.9g s: %s; the method was %s: %s",
                     m->state[SLOT_TIME], status_text(STATUS_NO_PROGRESS), m->engine->name, cause);
}

// Why the motion could not make a step.
static status explain_step(const corrected_run *c, status s, fault *f)
{
    const motion *m = c->motion;
    if (s == STATUS_FOLDED) {
        return explain_fold(c, f);
    }
    if (s == STATUS_NO_PROGRESS) {
        return explain_standstill(c, MOTION_REACHED, f);
    }
    return fault_set(f, s, "at t = %.9g s (last good state at %.9g s): %s; the method was %s",
                     m->failure_time, m->state[SLOT_TIME], status_text(s), m->engine->name);
}

// What comes of a step that ended where `report` says.
static status record_step(corrected_run *c, motion_report *report)
{
    const motion *m = c->motion;
    const bool at_event = report->event != MOTION_REACHED;
    status s = corrected_record_step(c, at_event);
    c->under_way.goes_on = false;
    if (s == STATUS_OK && at_event) {
        s = corrected_pass_event(c, report);
        bool same = m->state[SLOT_TIME] - c->last_event < SAME_EVENT_TIME;
        c->at_once = same ? c->at_once + 1 : 0;
        c->last_event = m->state[SLOT_TIME];
    }
    return s;
}

// --- the step under way -----------------------------------------------------------------------

// Whether the arm flies under a rig, in strides that outlive steps.
static bool flies_beyond_samples(const corrected_run *c)
{
    const motion *m = c->motion;
    return c->recording->rig != NULL && m->state[SLOT_CONTACT] == 0 && engine_is_dense(m->engine) &&
           !m->out_of_memory && !motion_held_still(m);
}

void corrected_begin_step(corrected_run *c)
{
    motion *m = c->motion;
    const double step = c->recording->now.method.step;
    assert(!c->under_way.goes_on);
    if (!flies_beyond_samples(c)) {
        motion_examine_step(&c->arm, m, c->stop, c->stop, step);
        return;
    }

    // as far as its stride lasts
    const double now = m->state[SLOT_TIME];
    motion_examine_step(&c->arm, m, c->stop, c->recording->scenario->parameters.run.duration, step);
    memcpy(m->trial, m->state, (size_t)m->size * sizeof *m->state);
    c->under_way = (open_step){.goes_on = true,
                               .begun_for = c->stop,
                               .now = now,
                               .sensed = corrected_way_at(c, now, m->state)};
}

// Whether the step under way ends after an instant [s].
static bool goes_beyond(const corrected_run *c, double time)
{
    const motion *m = c->motion;
    return m->step.coming.begun && instant_after(m->state[SLOT_TIME] + m->step.coming.length, time);
}

// What the sensors are fixed to at an instant [s] within the step under way: most see nothing but
// the hub, and no force. False if the state there cannot be had.
static bool sensed_within(const corrected_run *c, double time, sensed_motion *at)
{
    motion *m = c->motion;
    const sensor_parameters *fitted = &c->recording->rig->sensors.p;
    *at = (sensed_motion){.force = 0};
    if (fitted->film || fitted->accelerometer) {
        double *state = motion_between(&c->arm, m, time, STATE_WHOLE);
        if (state == NULL) {
            return false;
        }
        *at = corrected_sensed_motion(c, state);
    }

    const value_and_slope hub = motion_output(&c->arm, m, OUTPUT_HUB, time - m->state[SLOT_TIME]);
    at->angle = hub.value;
    at->velocity = hub.slope;
    return true;
}

// Goes on to an instant [s] within the step under way, with rows and, where the rig acts there,
// sensors.
static status go_along(corrected_run *c, double time, fault *f)
{
    way to = {.time = time, .integral = c->under_way.sensed.integral};
    status s = corrected_record_rows_to(c, time);
    if (s == STATUS_OK && time == c->stop) {
        const bool known = sensed_within(c, time, &to.at);
        s = known ? corrected_follow_flight(c, &to) : STATUS_NOT_FINITE;
    }

    // the run is there
    if (s == STATUS_OK) {
        c->under_way.now = time;
        s = recording_asked_to_stop(c->recording) ? STATUS_STOPPED : s;
    }
    return s == STATUS_OK ? s : explain(c, s, f);
}

// --- a step to its end ------------------------------------------------------------------------

// Makes the next step, to `until` [s] or the event at its end, and records what comes of it.
static status make_step(corrected_run *c, double until, fault *f)
{
    recording *r = c->recording;
    motion *m = c->motion;
    const double step = r->now.method.step;
    motion_report report;
    status s = motion_step(&c->arm, m, until, step, &report);
    if (s != STATUS_OK) {
        c->under_way.goes_on = false;
        return explain_step(c, s, f);
    }
    s = record_step(c, &report);

    // reasons to end here
    if (s == STATUS_OK && recording_asked_to_stop(r)) {
        s = STATUS_STOPPED;
    }
    recording_publish(r, m->state[SLOT_TIME]);
    if (s == STATUS_OK && c->at_once > MOST_EVENTS_AT_ONCE) {
        return explain_standstill(c, report.event, f);
    }
    if (s != STATUS_OK) {
        return explain(c, s, f);
    }
    return pace_keep(&c->pace, &c->arm, m, r->scenario->parameters.run.duration, step, f);
}

status corrected_stride(corrected_run *c, double until, fault *f)
{
    assert(c != NULL && f != NULL);
    recording *r = c->recording;
    motion *m = c->motion;
    if (r->options->rows_expected > 0 && !checkpoint_keep(r, m, c->last_event)) {
        return fault_no_memory(f);
    }

    // within the step under way
    if (!c->under_way.goes_on && flies_beyond_samples(c)) {
        corrected_begin_step(c);
    }
    const double next = instant_after(c->stop, until) ? until : c->stop;
    if (c->under_way.goes_on && goes_beyond(c, next)) {
        return go_along(c, next, f);
    }

    // or to the end of one; where it stops by itself it is that of a run that nobody steps, to the
    // last bit
    if (until < c->stop && !c->under_way.goes_on) {
        m->record.tstop = smaller(m->record.tstop, until);
    }
    return make_step(c, c->stop, f);
}

status corrected_end_step(corrected_run *c, fault *f)
{
    assert(c != NULL && f != NULL);
    motion *m = c->motion;
    const open_step *on = &c->under_way;
    if (!on->goes_on) {
        return STATUS_OK;
    }
    m->step.coming.length = on->now - m->state[SLOT_TIME];
    m->step.coming.any = false;
    return make_step(c, on->now, f);
}

// --- at present -------------------------------------------------------------------------------

double *corrected_present(const corrected_run *c)
{
    motion *m = c->motion;
    double *within =
        c->under_way.goes_on ? motion_between(&c->arm, m, c->under_way.now, STATE_WHOLE) : m->state;
    return within != NULL ? within : m->state;
}

sensed_motion corrected_sensed_now(const corrected_run *c)
{
    const open_step *on = &c->under_way;
    sensed_motion at = on->sensed.at;
    if (!on->goes_on) {
        return corrected_sensed_motion(c, c->motion->state);
    }
    return on->sensed.time == on->now || sensed_within(c, on->now, &at) ? at : on->sensed.at;
}

// --- rows -------------------------------------------------------------------------------------

#define TINY_ENERGY    1e-9 // below it nothing is called unstable [J]
#define TINY_TURN      1e-2 // nor below what the motor does in this turn [rad]
#define WRONG_ENERGY   0.1  // share of the energy turned over that may not be unaccounted for
#define GRID_TOLERANCE 1e-9 // of a step: a row of the grid so near a step's end lies at it

// corrected_audit for a state that holds that energy.
static inline status audit(corrected_run *c, state_energy has)
{
    const motion *m = c->motion;
    summary *s = &c->recording->result->summary;
    const double held = motion_held_energy(&c->arm, m, m->state);
    double residual = motion_unaccounted(m, m->state, has.kinetic + has.strain + held);
    s->energy_residual_J = larger(fabs(residual), s->energy_residual_J);

    double turned_over = fabs(motion_motor_work(m, m->state)) + fabs(m->state[SLOT_EXTERNAL_WORK]) +
                         fabs(held) + fabs(state_quadratures(m, m->state)[QUADRATURE_PUSHED]) +
                         m->record.start_energy + fabs(c->arm.motor.torque) * TINY_TURN +
                         TINY_ENERGY;
    // steps that do not resolve the fastest modes damp them: there energy may vanish, not appear
    double wrong = motion_unresolved(&c->arm, m) ? residual : fabs(residual);
    if (!isfinite(residual) || !isfinite(turned_over)) {
        return STATUS_NOT_FINITE;
    }
    return wrong > WRONG_ENERGY * turned_over ? STATUS_UNSTABLE : STATUS_OK;
}

status corrected_audit(corrected_run *c)
{
    return audit(c, motion_energy(&c->arm, c->motion, c->motion->state));
}

// The row of a state that holds that energy.
static sample row_of(const corrected_run *c, double *state, state_energy has, double impulse)
{
    const arm *a = &c->arm;
    const motion *m = c->motion;

    // the state's parts, and the links that the signals name
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    double *al = state_accelerations(m, state), *quadrature = state_quadratures(m, state);
    const bool rigid = motion_wall_is_rigid(m);
    const double held = motion_held_energy(a, m, state);
    int first = a->first, last = a->dof - 1;
    sample row = {
        // every signal of the table that the corrected model has
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
        .gap = state_rest_gap(state),
        .gap_velocity = state_rest_gap_velocity(state),
        .force = state[SLOT_FORCE],
        .impulse = impulse,
        .contact = state[SLOT_CONTACT],
        .sticking = state[SLOT_FRICTION] == HUB_STICK,
        .voltage = a->motor.voltage,
        .motor_torque = a->motor.torque + state[SLOT_MOTOR_TORQUE],
        .friction_torque = state[SLOT_FRICTION_TORQUE],
        .kinetic_energy = has.kinetic,
        .strain_energy = has.strain,
        .motor_work = motion_motor_work(m, state),
        .external_work = state[SLOT_EXTERNAL_WORK],
        .viscous_loss = quadrature[QUADRATURE_VISCOUS],
        .friction_loss = state[SLOT_FRICTION_LOSS],
        .damping_loss = quadrature[QUADRATURE_DAMPING],
        .impact_loss = state[SLOT_IMPACT_LOSS],
        .energy_residual = motion_unaccounted(m, state, has.kinetic + has.strain + held),
        .wall_energy = rigid ? (double)NAN : motion_wall_energy(a, m, state),
        .wall_loss = rigid ? (double)NAN : quadrature[QUADRATURE_WALL],
        .wall_place = wall_moves(&a->wall) ? wall_motion_at(&a->wall.motion, state[SLOT_TIME]).place
                                           : (double)NAN,
        .wall_work = wall_moves(&a->wall) ? quadrature[QUADRATURE_PUSHED] : (double)NAN,
        .weight_energy = a->gravity != 0 ? chain_weight_energy(a, q) : (double)NAN,
        .face_depth = rigid ? (double)NAN : state[SLOT_FACE],
    };

    recording_add_rig_signals(c->recording, &row);
    return row;
}

sample corrected_row(const corrected_run *c, double *state, double impulse)
{
    return row_of(c, state, motion_energy(&c->arm, c->motion, state), impulse);
}

static status record_row_of(corrected_run *c, double *state, state_energy has, double impulse)
{
    const motion *m = c->motion;
    const sample row = row_of(c, state, has, impulse);
    return recording_add_row(c->recording, &row, state_angles(m, state),
                             state_velocities(m, state));
}

status corrected_record_row(corrected_run *c, double *state, double impulse)
{
    if (!c->recording->options->keep_trace) {
        return STATUS_OK;
    }
    const state_energy has = motion_energy(&c->arm, c->motion, state);
    return record_row_of(c, state, has, impulse);
}

// Records rows within the step just made or under way, stepped to again from its start: side by
// side if the engine can do that.
static status record_within(corrected_run *c, const double *times, int count)
{
    recording *r = c->recording;
    motion *m = c->motion;
    state_energy has[MOTION_TOGETHER];
    const bool together = count > 1 && motion_between_all(&c->arm, m, times, count, has);
    status failed = STATUS_OK;
    for (int i = 0; i < count && failed == STATUS_OK; i++) {
        if (together) {
            failed = record_row_of(c, m->between + i * m->size, has[i], 0);
        } else {
            double *state = motion_between(&c->arm, m, times[i], STATE_WHOLE);
            failed = state ? corrected_record_row(c, state, 0) : STATUS_NOT_FINITE;
        }
        failed = failed == STATUS_OK && recording_asked_to_stop(r) ? STATUS_STOPPED : failed;
    }
    return failed;
}

// Records the rows of the grid before an instant [s], which lie within the step just made or under
// way.
static status record_rows_before(corrected_run *c, double instant)
{
    recording *r = c->recording;
    const double interval = r->scenario->parameters.method.step;
    double time = (double)r->state.grid_row * interval;
    status failed = STATUS_OK;

    // some at a time
    while (failed == STATUS_OK && time < instant) {
        double times[MOTION_TOGETHER];
        int count = 0;
        for (; count < MOTION_TOGETHER && time < instant; count++) {
            times[count] = time;
            time = (double)++r->state.grid_row * interval;
        }
        failed = record_within(c, times, count);
    }
    return failed;
}

status corrected_record_rows_to(corrected_run *c, double time)
{
    const double interval = c->recording->scenario->parameters.method.step;
    const bool keeps = c->recording->options->keep_trace;
    return keeps ? record_rows_before(c, time + GRID_TOLERANCE * interval) : STATUS_OK;
}

// Records the rows of the grid that lie within the step just made, and passes over one at its end
// if an event is there.
static status record_grid(corrected_run *c, bool at_event)
{
    recording *r = c->recording;
    motion *m = c->motion;
    const double interval = r->scenario->parameters.method.step, now = m->state[SLOT_TIME];
    const double end = GRID_TOLERANCE * interval;

    // those within it, then one at its end; an event records its own rows
    status failed = record_rows_before(c, now - end);
    if (failed == STATUS_OK && (double)r->state.grid_row * interval <= now + end) {
        r->state.grid_row++;
        failed = at_event ? STATUS_OK : corrected_record_row(c, m->state, 0);
        failed = failed == STATUS_OK && recording_asked_to_stop(r) ? STATUS_STOPPED : failed;
    }
    return failed;
}

status corrected_record_step(corrected_run *c, bool at_event)
{
    recording *r = c->recording;
    motion *m = c->motion;

    // how far the arm has gone from the wall
    if (!isnan(r->result->summary.first_contact_s) && !r->state.separated) {
        r->state.separated = flight_separated(&c->arm, m);
    }
    const arm *a = &c->arm;
    const double pushed[] = {state_quadratures(m, m->trial)[QUADRATURE_PUSHED],
                             state_quadratures(m, m->state)[QUADRATURE_PUSHED]};
    r->state.energy_put_in +=
        fabs(motion_motor_work(m, m->state) - motion_motor_work(m, m->trial)) +
        fabs(pushed[1] - pushed[0]) +
        fabs(chain_weight_energy(a, state_angles(m, m->state)) -
             chain_weight_energy(a, state_angles(m, m->trial)));

    // an arm held still has the energy it had
    const bool known = m->step.reached.kinetic >= 0;
    status s = motion_held_still(m) ? STATUS_OK
               : known              ? audit(c, m->step.reached)
                                    : corrected_audit(c);

    // how fast the tip came towards the wall on its own
    if (r->rig != NULL && m->trial[SLOT_CONTACT] == 0) {
        recording_follow_flight(r, flight_closing_speed(&c->arm, m));
    }

    s = s == STATUS_OK ? corrected_record_forces(c) : s;
    return s == STATUS_OK && r->options->keep_trace ? record_grid(c, at_event) : s;
}
