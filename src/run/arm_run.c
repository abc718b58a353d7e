// Steps of a run of the corrected arm: from one instant at which script or rig are due to
// the next, with steps that continue beyond samples which change nothing.
#include "src/run/arm_run.h"

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
#define SAME_EVENT_TIME 1e-13 // events nearer than this come at once [s]

// Events without time passing before the run is given up.
enum { MOST_EVENTS_AT_ONCE = 100 };

// --- at present ------------------------------------------------------------------------

// Computes the motion that the sensors measure at an instant [s] within the step under
// way, which is in flight: there is no force, and most sensors measure the hub alone.
// False if the state there cannot be computed.
static bool sensed_within(const arm_run *run, double time, sensed_motion *at)
{
    motion *m = run->motion;
    const sensor_parameters *fitted = &run->recording->rig->sensors.p;

    // some measure the whole arm
    *at = (sensed_motion){.time = time, .force = 0};
    if (fitted->film || fitted->accelerometer || fitted->tip_deflection ||
        fitted->root_strain) {
        double *state = motion_between(&run->arm, m, time, STATE_WHOLE);
        if (state == NULL) {
            return false;
        }
        *at = arm_run_sensed_motion(run, state);
    }

    // the hub
    const value_and_slope hub =
        motion_output(&run->arm, m, OUTPUT_HUB, time - m->state[SLOT_TIME]);
    at->angle = hub.value;
    at->velocity = hub.slope;
    return true;
}

// The motion that the sensors measure at present.
static sensed_motion present_sensed(const void *model_run)
{
    const arm_run *run = model_run;
    if (!run->under_way.exists) {
        return arm_run_sensed_motion(run, run->motion->state);
    }

    // within the step under way: the point that the sensors have been followed to, or the
    // present instant beyond it
    const double now = run->under_way.time;
    sensed_motion at;
    if (run->under_way.followed.time != now && sensed_within(run, now, &at)) {
        return at;
    }
    return run->under_way.followed.at;
}

// --- between segments: script and rig --------------------------------------------------

// Whether the motion has come to the end of its segment.
static bool segment_is_over(const arm_run *run)
{
    const double end = smaller(run->segment.stop, run->motion->record.tstop);
    return !(arm_run_time(run) < end);
}

// Lets the rig sample its sensors and change its command, if it is due at this instant. A
// step under way ends here only if the command changes.
static status run_rig(arm_run *run, fault *f)
{
    rig *on = run->recording->rig;
    const double now = arm_run_time(run);
    if (on == NULL || instant_after(rig_next_time(on), now)) {
        return STATUS_OK;
    }

    bool changed;
    const sensed_motion sensed = present_sensed(run);
    TRY(rig_act(on, now, &sensed, &changed, f));
    if (changed) {
        TRY(arm_run_end_step(run, f));
    }
    return arm_run_apply_sample(run, changed);
}

// Lets the rig act at the start and records the first row, also where the rig's first
// sample fails.
static status begin_rows(arm_run *run, fault *f)
{
    const status failed = run_rig(run, f);
    const status recorded = arm_run_record_first_row(run);
    if (failed != STATUS_OK) {
        return failed;
    }
    return recorded;
}

// Sets how far the motion may go by itself from here. The next sample of the rig and the
// end of the run end the segment, and the choice of steps takes them into account. The
// next action of the script and the beginning of the window of the steady force only cut
// the step that reaches them.
static void begin_segment(arm_run *run, double window)
{
    const recording *r = run->recording;
    const scenario *s = r->scenario;
    motion *m = run->motion;

    // where steps are cut
    const int next = r->state.next_action;
    m->record.tstop = HUGE_VAL;
    if (next < s->action_count) {
        m->record.tstop = s->actions[next].time;
    }
    if (instant_after(window, m->state[SLOT_TIME])) {
        m->record.tstop = smaller(window, m->record.tstop);
    }

    // what steps are planned for
    run->segment = (run_segment){.stop = s->parameters.run.duration, .last_event = -1};
    if (r->rig != NULL) {
        run->segment.stop = smaller(rig_next_time(r->rig), run->segment.stop);
    }
}

// arm_run_prepare_step at the start of the run and at the end of a segment. A function of
// its own, so that the few instructions which most steps need stay inline.
static __attribute__((noinline)) status prepare_segment(arm_run *run, bool *ended,
                                                        fault *f)
{
    const double duration = run->recording->scenario->parameters.run.duration;
    const double window = larger(duration - STEADY_WINDOW, 0);

    // the start
    if (!arm_run_has_first_row(run)) {
        TRY(begin_rows(run, f));
    }

    // script and rig act between segments of motion, each ending where one of them is due
    while (segment_is_over(run)) {
        *ended = !(arm_run_time(run) < duration);
        if (*ended) {
            return arm_run_record_last_row(run, duration);
        }

        // the mean force of the end begins to count here
        if (!run->under_way.exists &&
            same_instant(run->motion->state[SLOT_TIME], window)) {
            arm_run_begin_window(run);
        }

        // what is due now
        TRY(arm_run_script(run, f));
        TRY(run_rig(run, f));
        begin_segment(run, window);
    }
    return STATUS_OK;
}

status arm_run_prepare_step(arm_run *run, bool *ended, fault *f)
{
    *ended = false;
    if (arm_run_has_first_row(run) && !segment_is_over(run)) {
        return STATUS_OK;
    }
    return prepare_segment(run, ended, f);
}

// --- the step under way ----------------------------------------------------------------

// Whether the next step may continue beyond samples of the rig: in flight, with an engine
// that computes states within its steps.
static bool flies_beyond_samples(const arm_run *run)
{
    const motion *m = run->motion;
    return run->recording->rig != NULL && m->state[SLOT_CONTACT] == 0 &&
           engine_is_dense(m->engine) && !m->out_of_memory && !motion_held_still(m);
}

void arm_run_begin_step(arm_run *run)
{
    motion *m = run->motion;
    const double step = run->recording->now.method.step;
    assert(!run->under_way.exists);
    if (!flies_beyond_samples(run)) {
        motion_examine_step(&run->arm, m, run->segment.stop, run->segment.stop, step);
        return;
    }

    // as far as the step lasts, at most to the end of the run; it is under way then
    motion_examine_step(&run->arm, m, run->segment.stop,
                        run->recording->scenario->parameters.run.duration, step);
    memcpy(m->trial, m->state, (size_t)m->size * sizeof *m->state);
    run->under_way = (step_under_way){.exists = true,
                                      .begun_for = run->segment.stop,
                                      .time = m->state[SLOT_TIME],
                                      .followed = arm_run_sample_point(run, m->state)};
}

// Lets the sensors follow the arm to an instant [s] within the step under way.
static status follow_to_sample(arm_run *run, double time)
{
    sample_point to = {.time = time, .integral = run->under_way.followed.integral};
    if (!sensed_within(run, time, &to.at)) {
        return STATUS_NOT_FINITE;
    }
    const status s = arm_run_follow_flight(run, &to);
    run->under_way.followed = to;
    return s;
}

// Takes the run to an instant [s] within the step under way: records the rows up to there
// and, if the rig samples there, lets the sensors follow.
static status continue_within_step(arm_run *run, double time, fault *f)
{
    status s = arm_run_record_rows_to(run, time);
    if (s == STATUS_OK && time == run->segment.stop) {
        s = follow_to_sample(run, time);
    }

    // the run has come there
    if (s == STATUS_OK) {
        run->under_way.time = time;
        if (recording_asked_to_stop(run->recording)) {
            s = STATUS_STOPPED;
        }
    }
    if (s == STATUS_OK) {
        return s;
    }
    return arm_run_explain(run, s, f);
}

// --- a step to its end -----------------------------------------------------------------

// Records the step just made, and applies the event that ended it, if one did.
static status finish_step(arm_run *run, motion_report *report)
{
    run_segment *segment = &run->segment;
    const bool at_event = report->event != MOTION_REACHED;
    const status recorded = arm_run_record_step(run, at_event);
    run->under_way.exists = false;
    TRY(recorded);
    if (!at_event) {
        return STATUS_OK;
    }

    // apply the event, and count how many come without time passing between them
    const status applied = arm_run_apply_event(run, report);
    const double now = run->motion->state[SLOT_TIME];
    if (now - segment->last_event < SAME_EVENT_TIME) {
        segment->events_in_a_row++;
    } else {
        segment->events_in_a_row = 0;
    }
    segment->last_event = now;
    return applied;
}

// Makes the next step, to `until` [s] or the event at its end, and records it.
static status make_step(arm_run *run, double until, fault *f)
{
    recording *r = run->recording;
    motion *m = run->motion;
    const double step = r->now.method.step;
    motion_report report;
    status s = motion_step(&run->arm, m, until, step, &report);
    if (s != STATUS_OK) {
        run->under_way.exists = false;
        return arm_run_explain_step(run, s, f);
    }
    s = finish_step(run, &report);

    // the run may have to end here: on request, or because time no longer passes
    if (s == STATUS_OK && recording_asked_to_stop(r)) {
        s = STATUS_STOPPED;
    }
    recording_publish(r, m->state[SLOT_TIME]);
    if (s == STATUS_OK && run->segment.events_in_a_row > MOST_EVENTS_AT_ONCE) {
        return arm_run_explain_standstill(run, report.event, f);
    }
    if (s != STATUS_OK) {
        return arm_run_explain(run, s, f);
    }
    return zeno_monitor_count(&run->zeno, &run->arm, m,
                              r->scenario->parameters.run.duration, step, f);
}

status arm_run_step(arm_run *run, double until, fault *f)
{
    motion *m = run->motion;
    if (run->recording->options->rows_expected > 0 &&
        !checkpoint_keep(run->recording, m, run->segment.last_event)) {
        return fault_no_memory(f);
    }

    // a step that continues beyond `next`, the end of the segment or `until`, is only
    // observed there
    if (!run->under_way.exists && flies_beyond_samples(run)) {
        arm_run_begin_step(run);
    }
    double next = run->segment.stop;
    if (instant_after(next, until)) {
        next = until;
    }
    const double end = m->state[SLOT_TIME] + m->step.coming.end.length;
    if (run->under_way.exists && m->step.coming.begun && instant_after(end, next)) {
        return continue_within_step(run, next, f);
    }

    // any other step is made to its end. It is cut at `until`, but not planned for that,
    // so that a step which ends earlier by itself equals that of an uninterrupted run to
    // the last bit
    if (until < run->segment.stop && !run->under_way.exists) {
        m->record.tstop = smaller(m->record.tstop, until);
    }
    const status s = make_step(run, run->segment.stop, f);

    // the monitor of ever shorter steps counts those that the motion chose; a step that a
    // program has cut begins the count again
    if (!(m->state[SLOT_TIME] < until)) {
        run->zeno = zeno_monitor_begin();
    }
    return s;
}

status arm_run_end_step(arm_run *run, fault *f)
{
    motion *m = run->motion;
    if (!run->under_way.exists) {
        return STATUS_OK;
    }
    const double now = run->under_way.time;
    m->step.coming.end = (step_end){.length = now - m->state[SLOT_TIME]};
    return make_step(run, now, f);
}

// --- the beginning ---------------------------------------------------------------------

// Says in the summary that method.step is too long for the fastest modes of the arm.
static void remark_on_long_steps(const arm_run *run)
{
    summary *s = &run->recording->result->summary;
    decimal_print(s->message, sizeof s->message,
                  "steps of %g s do not resolve the fastest modes of %d links (%.3g "
                  "rad/s): the method was %s, what happens within a few steps of an "
                  "impact is rough; a shorter method.step resolves it",
                  run->recording->scenario->parameters.method.step, run->arm.links,
                  run->arm.highest_frequency, run->motion->engine->name);
}

// Begins the run at its initial state: names the method, opens the trace and puts the arm
// where it starts, possibly in contact.
static status begin(arm_run *run, fault *f)
{
    recording *r = run->recording;
    motion *m = run->motion;
    const initial_parameters *initial = &r->scenario->parameters.initial;

    // the method, and whether it suits the arm
    summary *s = &r->result->summary;
    memccpy(s->method, m->engine->name, 0, sizeof s->method - 1);
    if (motion_unresolved(&run->arm, m)) {
        remark_on_long_steps(run);
    }

    // the arm at its start, which must be in front of the wall
    TRY(recording_open_trace(r, run->arm.dof, f));
    motion_start(&run->arm, m, initial->angle, initial->velocity);
    if (m->wall_moves && m->state[SLOT_GAP] < -DEEPEST) {
        return fault_set_at(
            f, STATUS_BAD_SCENARIO, "wall.motion",
            "at t = 0 the wall has moved %.4g m past the arm, which must start "
            "in front of it (initial.angle)",
            -m->state[SLOT_GAP]);
    }
    if (arm_run_begin_in_contact(run) != STATUS_OK) {
        return fault_no_memory(f);
    }
    return STATUS_OK;
}

status arm_run_open(arm_run *run, recording *r, motion *spare, fault *f)
{
    assert(r->scenario->parameters.arm.model != ARM_PRINTED);
    const parameters *p = &r->scenario->parameters;

    // nothing is there yet
    memset(run, 0, offsetof(arm_run, arm));
    run->recording = r;
    run->segment.last_event = -1;
    run->zeno = zeno_monitor_begin();
    arm_run_lay_out_rows(run);

    // the arm, its motion, and how the wall moves
    arm_run_bind_arm(run);
    run->motion = motion_renew(spare, &run->arm, &p->method);
    FAULT_IF(run->motion == NULL, f, STATUS_NO_MEMORY, "no memory for an arm of %d links",
             p->arm.links);
    TRY(arm_run_read_path(run, f));

    // from the start, or from where another run was
    TRY(checkpoint_open_history(r, run->motion, f));
    if (!r->options->resume) {
        return begin(run, f);
    }
    checkpoint_restore(r, &run->arm, run->motion);
    run->arm.wall.motion.path = run->path;
    return STATUS_OK;
}

// --- the end ---------------------------------------------------------------------------

// Sums the run up where it stands, as if it ended here. If the step under way fails in
// being ended, the summary is that of what came before; only missing memory is reported.
static void end_and_summarise(arm_run *run, status failed)
{
    fault none;
    loss_unless(arm_run_end_step(run, &none) != STATUS_NO_MEMORY);
    arm_run_summarise(run, failed);
}

// Sums up a run that will continue. Ending the step under way changes the run, so that
// everything it changes is saved before and put back after, apart from the summary.
static void sum_up(void *model_run, status failed)
{
    arm_run *run = model_run;
    if (!run->under_way.exists) {
        end_and_summarise(run, failed);
        return;
    }

    // the run's parts, its sensors and its history of forces as they are
    sensors *rig_sensors = &run->recording->rig->sensors;
    size_t *force_count = &run->recording->result->history.forces.count;
    const run_segment segment_before = run->segment;
    const step_under_way under_way_before = run->under_way;
    const zeno_monitor zeno_before = run->zeno;
    const motion motion_before = *run->motion;
    const sensors sensors_before = *rig_sensors;
    const size_t force_count_before = *force_count;
    end_and_summarise(run, failed);

    // the motion goes back to the start of the step under way, which the end of the step
    // has left in `trial`
    const double *start = run->motion->trial;
    const size_t state_bytes = (size_t)motion_before.size * sizeof *start;
    *run->motion = motion_before;
    memmove(motion_before.state, start, state_bytes);
    memmove(motion_before.trial, start, state_bytes);

    // and so do the others; the present state is computed again
    run->segment = segment_before;
    run->under_way = under_way_before;
    run->zeno = zeno_before;
    *rig_sensors = sensors_before;
    *force_count = force_count_before;
    arm_run_present_state(run);
}

motion *arm_run_finish(arm_run *run, status failed)
{
    motion *m = run->motion;
    if (m != NULL) {
        end_and_summarise(run, failed);
    }
    wall_path_destroy(run->path);
    run->path = NULL;
    return m;
}

// --- the state as bytes ----------------------------------------------------------------

// The part of a saved state that says where the run stands within its segment; the bytes
// of the motion follow.
typedef struct saved_place {
    run_segment segment;
    step_under_way under_way;
} saved_place;

static size_t saved_size(const void *model_run)
{
    const arm_run *run = model_run;
    return sizeof(saved_place) + motion_saved_size(run->motion);
}

static void save(const void *model_run, void *bytes)
{
    const arm_run *run = model_run;
    saved_place place;
    memset(&place, 0, sizeof place); // bytes between its fields are zero, too
    place.segment = run->segment;
    place.under_way = run->under_way;
    memcpy(bytes, &place, sizeof place);
    motion_save(run->motion, (char *)bytes + sizeof place);
}

static void restore(void *model_run, const void *bytes)
{
    arm_run *run = model_run;
    saved_place place;
    memcpy(&place, bytes, sizeof place);
    arm_run_bind_arm(run); // to the saved parameters and voltage, which are in force
    motion_restore(&run->arm, run->motion, (const char *)bytes + sizeof place);
    run->zeno = zeno_monitor_begin();

    // the step under way is begun again as it was then
    if (place.under_way.exists) {
        run->under_way.exists = false;
        run->segment.stop = place.under_way.begun_for;
        arm_run_begin_step(run);
    }
    run->segment = place.segment;
    run->under_way = place.under_way;
}

// --- the corrected model as the driver knows it ----------------------------------------

static status open_run(void *run, recording *r, fault *f)
{
    return arm_run_open(run, r, NULL, f);
}

static status prepare_step(void *run, bool *ended, fault *f)
{
    return arm_run_prepare_step(run, ended, f);
}

static status step(void *run, double until, fault *f)
{
    return arm_run_step(run, until, f);
}

static status act(void *run, const action *todo, fault *f)
{
    TRY(arm_run_end_step(run, f));
    return arm_run_apply_action(run, todo, -1, f);
}

static void finish(void *run, status failed)
{
    motion_destroy(arm_run_finish(run, failed));
}

static double present_time(const void *run)
{
    return arm_run_time(run);
}

static bool has_ended(const void *model_run)
{
    const arm_run *run = model_run;
    return !(arm_run_time(run) < run->recording->scenario->parameters.run.duration);
}

static sample present_row(const void *run)
{
    return arm_run_row(run, arm_run_present_state(run));
}

static const double *present_angles(const void *model_run, int *angle_count)
{
    const arm_run *run = model_run;
    *angle_count = run->motion->dof;
    return state_angles(run->motion, arm_run_present_state(run));
}

const run_model corrected_model = {.takes_pushes = true,
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
                                   .state = present_angles,
                                   .saved_size = saved_size,
                                   .save = save,
                                   .restore = restore};
