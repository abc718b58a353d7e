#include "src/run/corrected_step.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/run/checkpoint.h"
#include "src/run/corrected_events.h"
#include "src/run/corrected_pieces.h"
#include "src/run/corrected_rows.h"

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
static bool flies_far(const corrected_run *c)
{
    const motion *m = c->motion;
    return c->recording->rig != NULL && m->state[SLOT_CONTACT] == 0 && m->engine->hub_at != NULL &&
           !m->starved && !motion_held_still(m);
}

void corrected_begin_step(corrected_run *c)
{
    motion *m = c->motion;
    const double step = c->recording->now.method.step;
    assert(!c->under_way.goes_on);
    if (!flies_far(c)) {
        motion_look_ahead(&c->arm, m, c->stop, step);
        return;
    }

    // as far as its stride lasts
    const double now = m->state[SLOT_TIME];
    motion_look_far(&c->arm, m, c->stop, c->recording->scenario->parameters.run.duration, step);
    memcpy(m->trial, m->state, (size_t)m->size * sizeof *m->state);
    c->under_way = (step_under_way){.goes_on = true,
                                    .begun_for = c->stop,
                                    .now = now,
                                    .sensed = corrected_way_at(c, now, m->state)};
}

// Whether the step under way ends after an instant [s].
static bool goes_beyond(const corrected_run *c, double time)
{
    const motion *m = c->motion;
    return m->ahead.begun && instant_after(m->state[SLOT_TIME] + m->ahead.length, time);
}

// What the sensors are fixed to at an instant [s] within the step under way: most see nothing but
// the hub, and no force. False if the state there cannot be had.
static bool sensed_within(const corrected_run *c, double time, sensed_motion *at)
{
    motion *m = c->motion;
    const sensor_parameters *fitted = &c->recording->rig->sensors.p;
    *at = (sensed_motion){.force = 0};
    if (fitted->film || fitted->accelerometer) {
        double *state = motion_between(&c->arm, m, time);
        if (state == NULL) {
            return false;
        }
        *at = corrected_sensed_motion(c, state);
    }

    const glance hub = m->engine->hub_at(&c->arm, m, time - m->state[SLOT_TIME]);
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
    if (!c->under_way.goes_on && flies_far(c)) {
        corrected_begin_step(c);
    }
    const double next = instant_after(c->stop, until) ? until : c->stop;
    if (c->under_way.goes_on && goes_beyond(c, next)) {
        return go_along(c, next, f);
    }

    // or to the end of one; where it stops by itself it is that of a run that nobody steps, to the
    // last bit
    if (until < c->stop && !c->under_way.goes_on) {
        m->cut = smaller(m->cut, until);
    }
    return make_step(c, c->stop, f);
}

status corrected_end_step(corrected_run *c, fault *f)
{
    assert(c != NULL && f != NULL);
    motion *m = c->motion;
    const step_under_way *on = &c->under_way;
    if (!on->goes_on) {
        return STATUS_OK;
    }
    m->ahead.length = on->now - m->state[SLOT_TIME];
    m->ahead.any = false;
    return make_step(c, on->now, f);
}

// --- at present -------------------------------------------------------------------------------

double *corrected_present(const corrected_run *c)
{
    motion *m = c->motion;
    double *within = c->under_way.goes_on ? motion_between(&c->arm, m, c->under_way.now) : m->state;
    return within != NULL ? within : m->state;
}

sensed_motion corrected_sensed_now(const corrected_run *c)
{
    const step_under_way *on = &c->under_way;
    sensed_motion at = on->sensed.at;
    if (!on->goes_on) {
        return corrected_sensed_motion(c, c->motion->state);
    }
    return on->sensed.time == on->now || sensed_within(c, on->now, &at) ? at : on->sensed.at;
}
