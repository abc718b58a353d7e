#include "src/run/corrected.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/base/numbers.h"
#include "src/base/text_stream.h"
#include "src/engines/motion_create.h"
#include "src/run/recording.h"
#include "src/run/resume.h"

#define DEEPEST         1e-9  // that an arm may be in a rigid wall by rounding [m]
#define GRID_TOLERANCE  1e-9  // of a step: the end so near a row of the grid has that row
#define SAME_EVENT_TIME 1e-13 // events nearer than this come at once [s]

enum {
    MOST_EVENTS_AT_ONCE = 100
}; // events without time passing before the run is given up

// --- between stretches: script and rig -------------------------------------------------

// Whether the stretch between two stops is through.
static bool stretch_is_over(const corrected_run *c)
{
    return !(corrected_now(c) < smaller(c->stretch.stop, c->motion->record.tstop));
}

// Puts the arm where it starts.
static status begin(corrected_run *c, fault *f)
{
    recording *r = c->recording;
    motion *m = c->motion;
    const parameters *p = &r->scenario->parameters;
    summary *s = &r->result->summary;
    memccpy(s->method, m->engine->name, 0, sizeof s->method - 1);

    if (motion_unresolved(&c->arm, m)) {
        decimal_print(s->message, sizeof s->message,
                      "steps of %g s do not resolve the fastest modes of %d links (%.3g "
                      "rad/s): the method was %s, what happens within a few steps of an "
                      "impact is rough; a shorter method.step resolves it",
                      p->method.step, c->arm.links, c->arm.highest_frequency,
                      m->engine->name);
    }

    TRY(recording_open_trace(r, c->arm.dof, f));

    r->state.earlier_peak = -1;
    r->state.landing.before.angle[0] = (double)NAN;
    motion_start(&c->arm, m, p->initial.angle, p->initial.velocity);
    if (m->wall_moves && m->state[SLOT_GAP] < -DEEPEST) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, "wall.motion",
            "at t = 0 the wall has moved %.4g m past the arm, which must start "
            "in front of it (initial.angle)",
            -m->state[SLOT_GAP]);
    }
    if (corrected_begin_in_contact(c) != STATUS_OK) {
        return fault_no_memory(f);
    }
    return STATUS_OK;
}

// Samples the sensors and changes the command where the time for it has come. A step
// under way goes on unless something changes.
static status run_rig(corrected_run *c, fault *f)
{
    rig *on = c->recording->rig;
    const double now = corrected_now(c);
    if (on == NULL || instant_after(rig_next_time(on), now)) {
        return STATUS_OK;
    }
    bool changed;
    const sensed_motion sensed = corrected_sensed_now(c);
    TRY(rig_act(on, now, &sensed, &changed, f));
    if (changed) {
        TRY(corrected_end_step(c, f));
    }
    return corrected_pass_sample(c, changed);
}

// corrected_approach_step where a stretch is over, or the run is to begin; apart from it,
// which then has little to do for most steps.
static __attribute__((noinline)) status begin_stretch(corrected_run *c, bool *ended,
                                                      fault *f)
{
    recording *r = c->recording;
    motion *m = c->motion;
    const parameters *p = &r->scenario->parameters;
    const double duration = p->run.duration, window = larger(duration - STEADY_WINDOW, 0);
    if (r->state.grid_row == 0) {
        // the row of the start is there even where the rig's first sample fails
        const status failed = run_rig(c, f);
        r->state.grid_row = 1;
        const status recorded = corrected_record_row(c, m->state, 0);
        if (failed == STATUS_OK) {
            TRY(recorded);
        } else {
            TRY(failed);
        }
    }

    // script and rig act between stretches of motion, each ending where one of them is
    // due
    while (stretch_is_over(c)) {
        *ended = !(corrected_now(c) < duration);
        if (*ended) {
            // the end may lie between rows of the grid
            const double last_row = (double)(r->state.grid_row - 1) * p->method.step;
            if (last_row < duration - GRID_TOLERANCE * p->method.step) {
                return corrected_record_row(c, m->state, 0);
            }
            return STATUS_OK;
        }

        // the mean force of the end begins to count here
        if (!c->stretch.open.goes_on && same_instant(m->state[SLOT_TIME], window)) {
            r->state.integral_at_window =
                state_quadratures(m, m->state)[QUADRATURE_FORCE];
            r->state.in_window = (force_bounds){0};
        }

        // what is due now, then how far the motion may go by itself; steps are cut, and
        // not planned for it, at an action and where the window begins
        TRY(corrected_run_script(c, f));
        TRY(run_rig(c, f));
        const scenario *s = r->scenario;
        const int next = r->state.next_action;
        const double act = next < s->action_count ? s->actions[next].time : HUGE_VAL;
        const bool before = instant_after(window, m->state[SLOT_TIME]);
        if (before) {
            m->record.tstop = smaller(window, act);
        } else {
            m->record.tstop = act;
        }
        if (r->rig != NULL) {
            c->stretch.stop = smaller(rig_next_time(r->rig), duration);
        } else {
            c->stretch.stop = duration;
        }
        c->stretch.last_event = -1;
        c->stretch.at_once = 0;
    }
    return STATUS_OK;
}

status corrected_approach_step(corrected_run *c, bool *ended, fault *f)
{
    *ended = false;
    const bool within = c->recording->state.grid_row > 0 && !stretch_is_over(c);
    if (within) {
        return STATUS_OK;
    }
    return begin_stretch(c, ended, f);
}

// --- a step ----------------------------------------------------------------------------

// What comes of a step that ended where `report` says.
static status record_step(corrected_run *c, motion_report *report)
{
    const motion *m = c->motion;
    const bool at_event = report->event != MOTION_REACHED;
    status s = corrected_record_step(c, at_event);
    c->stretch.open.goes_on = false;
    if (s == STATUS_OK && at_event) {
        s = corrected_pass_event(c, report);
        bool same = m->state[SLOT_TIME] - c->stretch.last_event < SAME_EVENT_TIME;
        if (same) {
            c->stretch.at_once = c->stretch.at_once + 1;
        } else {
            c->stretch.at_once = 0;
        }
        c->stretch.last_event = m->state[SLOT_TIME];
    }
    return s;
}

// --- the step under way ----------------------------------------------------------------

// Whether the arm flies under a rig, in internal steps that outlast the run's.
static bool flies_beyond_samples(const corrected_run *c)
{
    const motion *m = c->motion;
    return c->recording->rig != NULL && m->state[SLOT_CONTACT] == 0 &&
           engine_is_dense(m->engine) && !m->out_of_memory && !motion_held_still(m);
}

void corrected_begin_step(corrected_run *c)
{
    motion *m = c->motion;
    const double step = c->recording->now.method.step;
    assert(!c->stretch.open.goes_on);
    if (!flies_beyond_samples(c)) {
        motion_examine_step(&c->arm, m, c->stretch.stop, c->stretch.stop, step);
        return;
    }

    // as far as its step lasts
    motion_examine_step(&c->arm, m, c->stretch.stop,
                        c->recording->scenario->parameters.run.duration, step);
    memcpy(m->trial, m->state, (size_t)m->size * sizeof *m->state);
    c->stretch.open = (open_step){.goes_on = true,
                                  .begun_for = c->stretch.stop,
                                  .now = m->state[SLOT_TIME],
                                  .sensed = corrected_sample_point_at(c, m->state)};
}

// What the sensors are fixed to at an instant [s] within the step under way: most see
// nothing but the hub, and no force. False if the state there cannot be had.
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

    const value_and_slope hub =
        motion_output(&c->arm, m, OUTPUT_HUB, time - m->state[SLOT_TIME]);
    at->angle = hub.value;
    at->velocity = hub.slope;
    return true;
}

// Continues to an instant [s] within the step under way, with rows and, where the rig
// acts there, sensors.
static status go_along(corrected_run *c, double time, fault *f)
{
    sample_point to = {.time = time, .integral = c->stretch.open.sensed.integral};
    status s = corrected_record_rows_to(c, time);
    if (s == STATUS_OK && time == c->stretch.stop) {
        const bool known = sensed_within(c, time, &to.at);
        if (known) {
            s = corrected_follow_flight(c, &to);
        } else {
            s = STATUS_NOT_FINITE;
        }
    }

    // the run is there
    if (s == STATUS_OK) {
        c->stretch.open.now = time;
        if (recording_asked_to_stop(c->recording)) {
            s = STATUS_STOPPED;
        }
    }
    if (s == STATUS_OK) {
        return s;
    }
    return corrected_explain(c, s, f);
}

// --- a step to its end -----------------------------------------------------------------

// Makes the next step, to `until` [s] or the event at its end, and records what comes of
// it.
static status make_step(corrected_run *c, double until, fault *f)
{
    recording *r = c->recording;
    motion *m = c->motion;
    const double step = r->now.method.step;
    motion_report report;
    status s = motion_step(&c->arm, m, until, step, &report);
    if (s != STATUS_OK) {
        c->stretch.open.goes_on = false;
        return corrected_explain_step(c, s, f);
    }
    s = record_step(c, &report);

    // reasons to end here
    if (s == STATUS_OK && recording_asked_to_stop(r)) {
        s = STATUS_STOPPED;
    }
    recording_publish(r, m->state[SLOT_TIME]);
    if (s == STATUS_OK && c->stretch.at_once > MOST_EVENTS_AT_ONCE) {
        return corrected_explain_standstill(c, report.event, f);
    }
    if (s != STATUS_OK) {
        return corrected_explain(c, s, f);
    }
    return zeno_monitor_count(&c->zeno, &c->arm, m, r->scenario->parameters.run.duration,
                              step, f);
}

status corrected_step(corrected_run *c, double until, fault *f)
{
    recording *r = c->recording;
    motion *m = c->motion;
    if (!(r->options->rows_expected == 0 ||
          checkpoint_keep(r, m, c->stretch.last_event))) {
        return fault_no_memory(f);
    }

    // within the step under way
    if (!c->stretch.open.goes_on && flies_beyond_samples(c)) {
        corrected_begin_step(c);
    }
    const double next = instant_after(c->stretch.stop, until) ? until : c->stretch.stop;
    const double end = m->state[SLOT_TIME] + m->step.coming.end.length;
    if (c->stretch.open.goes_on && m->step.coming.begun && instant_after(end, next)) {
        return go_along(c, next, f);
    }

    // or to the end of one; where it stops by itself it is that of a run that nobody
    // steps, to the last bit
    if (until < c->stretch.stop && !c->stretch.open.goes_on) {
        m->record.tstop = smaller(m->record.tstop, until);
    }
    const status s = make_step(c, c->stretch.stop, f);

    // it counts steps that the motion chose, not instants a program asks for
    if (!(c->motion->state[SLOT_TIME] < until)) {
        c->zeno = zeno_monitor_begin();
    }
    return s;
}

status corrected_end_step(corrected_run *c, fault *f)
{
    motion *m = c->motion;
    const open_step *on = &c->stretch.open;
    if (!on->goes_on) {
        return STATUS_OK;
    }
    m->step.coming.end = (step_end){.length = on->now - m->state[SLOT_TIME]};
    return make_step(c, on->now, f);
}

status corrected_act_now(corrected_run *c, const action *todo, fault *f)
{
    TRY(corrected_end_step(c, f));
    return corrected_act(c, todo, -1, f);
}

// --- at present ------------------------------------------------------------------------

sensed_motion corrected_sensed_now(const corrected_run *c)
{
    const open_step *on = &c->stretch.open;
    sensed_motion at = on->sensed.at;
    if (!on->goes_on) {
        return corrected_sensed_motion(c, c->motion->state);
    }
    if (on->sensed.time == on->now || sensed_within(c, on->now, &at)) {
        return at;
    }
    return on->sensed.at;
}

// --- beginning and end -----------------------------------------------------------------

// Sums the run up where it stands, as if it ended here: a step that fails in this does
// not end the run, but may be lost.
static void end_and_summarise(corrected_run *c, status failed)
{
    fault none;
    loss_unless(corrected_end_step(c, &none) != STATUS_NO_MEMORY);
    corrected_summarise(c, failed);
}

void corrected_sum_up(corrected_run *c, status failed)
{
    rig *on = c->recording->rig;
    if (!c->stretch.open.goes_on) {
        end_and_summarise(c, failed);
        return;
    }

    // all that the end of the step under way changes, but for what is summed up
    const motion moving = *c->motion;
    const open_step open = c->stretch.open;
    const zeno_monitor monitor = c->zeno;
    const sensors felt = on->sensors;
    size_t *forces = &c->recording->result->history.forces.count;
    const size_t kept = *forces;
    end_and_summarise(c, failed);

    // and back to where the step started, which is where it left that
    const double *start = c->motion->trial;
    *c->motion = moving;
    memmove(moving.state, start, (size_t)moving.size * sizeof *start);
    memmove(moving.trial, start, (size_t)moving.size * sizeof *start);
    c->stretch.open = open;
    c->zeno = monitor;
    on->sensors = felt;
    *forces = kept;
    corrected_present(c);
}

status corrected_open(corrected_run *c, recording *r, motion *spare, fault *f)
{
    assert(r->scenario->parameters.arm.model != ARM_PRINTED);
    const parameters *p = &r->scenario->parameters;
    memset(c, 0, offsetof(corrected_run, arm));
    c->recording = r;
    c->stretch.last_event = -1;
    c->zeno = zeno_monitor_begin();
    corrected_bind_arm(c);
    c->motion = motion_renew(spare, &c->arm, &p->method);
    FAULT_IF(c->motion == NULL, f, STATUS_NO_MEMORY, "no memory for an arm of %d links",
             p->arm.links);

    // where a file says how the wall moves
    if (p->wall.motion == MOTION_FILE && p->wall.kind != WALL_NONE) {
        TRY(wall_path_create(&c->path, p->wall.motion_file, f));
        c->arm.wall.motion.path = c->path;
    }

    TRY(checkpoint_open_history(r, c->motion, f));
    if (!r->options->resume) {
        return begin(c, f);
    }
    checkpoint_restore(r, &c->arm, c->motion);
    c->arm.wall.motion.path = c->path;
    return STATUS_OK;
}

motion *corrected_finish(corrected_run *c, status failed)
{
    motion *m = c->motion;
    if (m != NULL) {
        end_and_summarise(c, failed);
    }
    wall_path_destroy(c->path);
    c->path = NULL;
    return m;
}

// --- the state as bytes ----------------------------------------------------------------

// The stretch, then what the motion remembers.

size_t corrected_saved_size(const corrected_run *c)
{
    return sizeof c->stretch + motion_saved_size(c->motion);
}

void corrected_save(const corrected_run *c, void *bytes)
{
    memcpy(bytes, &c->stretch, sizeof c->stretch);
    motion_save(c->motion, (char *)bytes + sizeof c->stretch);
}

void corrected_restore(corrected_run *c, const void *bytes)
{
    stretch saved;
    memcpy(&saved, bytes, sizeof saved);
    corrected_bind_arm(c); // to parameters and voltage of then
    motion_restore(&c->arm, c->motion, (const char *)bytes + sizeof saved);
    c->zeno = zeno_monitor_begin();

    // the step under way, looked at again as it was when it was begun
    c->stretch = saved;
    if (saved.open.goes_on) {
        c->stretch.open.goes_on = false;
        c->stretch.stop = saved.open.begun_for;
        corrected_begin_step(c);
        c->stretch = saved;
    }
}
