// Between events: a step of the contact machine, which ends at the first of them.
#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/base/sincos.h"
#include "src/contact/contact_machine.h"
#include "src/contact/locate.h"

#define MOST_HALVINGS 8 // of a step that does not converge or makes energy
// share of a step; what is left of one before tstop is longer
#define LEAST_AFTER_TSTOP 1e-9
// What a stuck hub may be held by beyond stiction: a share of the torques, and of what
// rounding makes of a slow soft arm's [N m].
#define HOLD_SHARE    1e-6
#define HOLD_ROUNDING 1e-8
// Angles, velocities and accelerations below this are set to zero [rad, rad/s, rad/s2].
// Squares of larger ones are normal numbers: so a motion that dies away never computes
// with denormal numbers, which are many times slower on some processors.
#define FADED 1e-150

// Records by how much the friction that holds a stuck hub exceeds stiction, if that is
// more than rounding: only a slip that was missed explains it. Of stepping engines it is
// not recorded, as these may see a slip one step late.
static void note_hold(const arm *a, motion *m)
{
    const double *state = m->state;
    const double beyond = fabs(state[SLOT_FRICTION_TORQUE]) - a->motor.stiction;
    if (state[SLOT_FRICTION] != HUB_STICK || !engine_is_dense(m->engine) ||
        !(beyond > 0)) {
        return;
    }
    const double largest = larger(a->motor.stiction, fabs(state[SLOT_MOTOR_TORQUE]));
    if (beyond > HOLD_SHARE * largest + HOLD_ROUNDING * motion_rounding(a, m)) {
        m->record.overheld = larger(beyond, m->record.overheld);
    }
}

// Counts the time that passed [s] as so many time steps of length `step`, rounded up and
// at least one, and records the depth at its end.
static void count_step(motion *m, double passed, double step)
{
    const double steps = passed / step - 1e-6;
    const long whole = (long)steps;
    if (steps > 0) {
        m->record.steps += whole + ((double)whole < steps);
    } else {
        m->record.steps += 1;
    }
    m->record.largest_penetration =
        larger(-state_rest_gap(m->state).value, m->record.largest_penetration);
}

// Makes the trial state, at the end of a step, that of the motion.
static void accept_trial(motion *m, double step)
{
    double *previous = m->state;
    m->state = m->trial;
    m->trial = previous;
    m->step.energy = m->step.trial_energy;
    count_step(m, m->state[SLOT_TIME] - previous[SLOT_TIME], step);

    // just beyond a release a wall that gives would pull
    if (!motion_wall_is_rigid(m)) {
        m->state[SLOT_FORCE] = fmax(m->state[SLOT_FORCE], 0);
    }
}

// Brings a motion that dies away to rest: all of its numbers below FADED become exactly
// zero. A motion dies away if a body has a velocity below FADED other than zero or, at
// velocity zero, such an acceleration.
static void come_to_rest(motion *m)
{
    const double *w = state_velocities(m, m->state);
    const double *acceleration = state_accelerations(m, m->state);
    bool fading = false;
    for (int i = 0; i < m->dof && !fading; i++) {
        const double sign = w[i] != 0 ? w[i] : acceleration[i];
        fading = sign != 0 && fabs(sign) < FADED;
    }
    if (fading) {
        motion_end_internal_step(m);
    }
    for (int i = SLOT_COUNT; fading && i < m->size; i++) {
        if (fabs(m->state[i]) < FADED) {
            m->state[i] = 0;
        }
    }
}

// The event that happens where an event function falls below zero.
static motion_event event_of(const motion *m, event_function w)
{
    static const motion_event events[EVENT_FUNCTION_COUNT] = {
        [EVENT_OF_FORCE] = MOTION_RELEASE,
        [EVENT_OF_HUB] = MOTION_STICK,
        [EVENT_OF_STICTION] = MOTION_SLIP,
        [EVENT_OF_CURRENT] = MOTION_REACHED};
    if (w != EVENT_OF_GAP) {
        return events[w];
    }

    // contact begins with an impact only at a speed, and only if the wall does not give
    if (m->wall_gives) {
        if (m->state[SLOT_CONTACT] != 0) {
            return MOTION_RELEASE;
        }
        return MOTION_TOUCH;
    }
    if (m->state[SLOT_GAP_VELOCITY] < -TOUCH_SPEED) {
        return MOTION_IMPACT;
    }
    return MOTION_TOUCH;
}

// Tries a step of that length, shorter if need be; *end and m->trial end at the first
// event, if there is one.
static status step_to_event(const arm *a, motion *m, step_end *end)
{
    status s = motion_try_step(a, m, end->length, STATE_WHOLE);
    for (int i = 0;
         i < MOST_HALVINGS && (s == STATUS_NEWTON_FAILED || s == STATUS_UNSTABLE); i++) {
        end->length /= 2;
        s = motion_try_step(a, m, end->length, STATE_WHOLE);
    }
    if (s == STATUS_OK) {
        return locate_first_event(a, m, end);
    }
    return s;
}

// A step of a stepping engine, which locates events and peaks by further, shorter steps.
// A step that goes beyond the instant m->record.tstop, or ends within rounding of it, is
// made again to end there.
static status tried_step(const arm *a, motion *m, double until, double step,
                         step_end *end)
{
    // as long as the engine makes it, and to its first event
    const double wanted = m->engine->advance(a, m, until - m->state[SLOT_TIME], step);
    const double left = m->record.tstop - m->state[SLOT_TIME];
    *end = (step_end){.length = wanted};
    status s = step_to_event(a, m, end);

    // again, to tstop; an event may be as near to that as it likes
    double reached = wanted, spare = LEAST_AFTER_TSTOP * step;
    if (s == STATUS_OK) {
        reached = end->length;
        spare = end->any ? 0 : spare;
    }
    if (!(reached <= left - spare)) {
        *end = (step_end){.length = left};
        if (s == STATUS_OK) {
            s = motion_try_step(a, m, left, STATE_WHOLE);
        }
        if (s != STATUS_OK) {
            s = step_to_event(a, m, end);
        }
    }

    // the largest force on the way
    const bool touches = s == STATUS_OK && m->state[SLOT_CONTACT] != 0;
    if (touches) {
        return locate_peak(a, m, end->length);
    }
    return s;
}

// Whether a rigid wall holds the arm where the contact equations are singular: folded
// over the hub's axis.
static bool held_folded(const arm *a, motion *m)
{
    return m->state[SLOT_CONTACT] != 0 && motion_wall_is_rigid(m) &&
           chain_is_folded(a, state_angles(m, m->state));
}

// Whether the step just made led an arm on a rigid flat wall through a fold: every link
// was turned through the direction across the wall, so that the cosine of its angle to
// the wall changed its sign. The internal steps of some engines keep clear of folds.
static bool went_through_fold(const arm *a, const motion *m)
{
    const double *before = state_angles(m, m->trial), *now = state_angles(m, m->state);
    bool through = (!engine_is_dense(m->engine) || m->engine->kept > 0) &&
                   m->trial[SLOT_CONTACT] != 0 && motion_wall_is_rigid(m) &&
                   a->wall.kind == WALL_PLANE && a->links > 1;
    for (int k = a->first; k < a->dof && through; k++) {
        const double cosine_before =
            inline_cos(before[k]) * a->wall.cosine + inline_sin(before[k]) * a->wall.sine;
        const double cosine_now =
            inline_cos(now[k]) * a->wall.cosine + inline_sin(now[k]) * a->wall.sine;
        through = cosine_before * cosine_now < 0;
    }
    return through;
}

// Examines the coming step of a dense engine (motion_examine_step) for an arm that can
// move on: how far its internal step goes, up to `until` or `far` [s], and where its
// first event is. Records peaks of force and depth on the way.
static void examine(const arm *a, motion *m, double until, double far, double step)
{
    // the internal step, all of what is left of it where more is wanted
    const double now = m->state[SLOT_TIME];
    step_end end = {.length = m->engine->advance(a, m, until - now, step)};
    const bool begun = end.length > 0;
    if (begun && far > until) {
        const double *kept = state_kept(m, m->state);
        const double left = kept[KEPT_LENGTH] - kept[KEPT_USED]; // of the internal step
        end.length = larger(smaller(left, far - now), end.length);
    }

    // to the first event, tstop or the internal step's end; an event at the instant of
    // tstop is before it
    if (begun) {
        m->engine->first_event(a, m, &end);
        if (now + end.length > m->record.tstop) {
            end = (step_end){.length = m->record.tstop - now};
        }
        const bool touches = m->state[SLOT_CONTACT] != 0;
        if (touches) {
            dense_peak(a, m, end.length);
        }
        // an arm that has left a swinging face may still be deeper than it stands at rest
        if (!motion_wall_is_rigid(m) && (touches || state_face_swings(m, m->state))) {
            dense_deepest(a, m, end.length);
        }
    }
    m->step.coming.known = true;
    m->step.coming.begun = begun;
    m->step.coming.end = end;
}

void motion_examine_step(const arm *a, motion *m, double until, double far, double step)
{
    assert(step > 0 && engine_is_dense(m->engine));
    if (!m->out_of_memory && !held_folded(a, m)) {
        examine(a, m, until, far, step);
    }
}

// A step of a dense engine, examined here unless it already was. *end and m->trial get
// its end.
static status dense_step(const arm *a, motion *m, double until, double step,
                         step_end *end)
{
    if (!m->step.coming.known) {
        examine(a, m, until, until, step);
    }
    m->step.coming.known = false;
    *end = m->step.coming.end;
    m->step.aim = smaller(until, m->record.tstop);

    // a step that could not be begun: by numbers that are not finite, or for other
    // reasons
    if (!m->step.coming.begun) {
        double sum = 0;
        for (int i = 0; i < m->dof; i++) {
            sum += state_accelerations(m, m->state)[i];
        }
        if (isfinite(sum)) {
            return STATUS_NO_PROGRESS;
        }
        return STATUS_NOT_FINITE;
    }
    return motion_try_step(a, m, end->length, STATE_WHOLE);
}

// Sets the time to the requested instant, `until` or tstop, if it is that but for
// rounding.
static void meet_stop(motion *m, double until)
{
    const double stop = smaller(until, m->record.tstop);
    if (!instant_after(stop, m->state[SLOT_TIME])) {
        m->state[SLOT_TIME] = stop;
    }
}

// The step of an arm that is held still: time passes up to `until` or tstop [s], and its
// force stays the same. m->trial gets its start.
static void rest(motion *m, double until, double step)
{
    double *state = m->state;
    const double now = state[SLOT_TIME], h = smaller(m->record.tstop - now, until - now);
    if (state[SLOT_CONTACT] != 0) {
        motion_note_force(m, now, state[SLOT_FORCE]);
    }
    memcpy(m->trial, state, (size_t)m->size * sizeof *state);
    state[SLOT_TIME] += h;
    state_quadratures(m, state)[QUADRATURE_FORCE] += h * state[SLOT_FORCE];
    m->step.energy = unknown_energy;
    m->step.last = h;
    count_step(m, state[SLOT_TIME] - now, step);
    meet_stop(m, until);
}

status motion_step(const arm *a, motion *m, double until, double step,
                   motion_report *report)
{
    assert(step > 0);
    *report = (motion_report){.event = MOTION_REACHED};

    // a step examined by motion_examine_step needs no search any more
    if (!m->step.coming.known && (m->out_of_memory || held_folded(a, m))) {
        m->failure_time = m->state[SLOT_TIME];
        if (m->out_of_memory) {
            return STATUS_NO_MEMORY;
        }
        return STATUS_FOLDED;
    }
    if (motion_held_still(m)) {
        rest(m, until, step);
        return STATUS_OK;
    }

    // as far as accuracy allows, tstop, or the first event
    step_end end;
    status s;
    if (engine_is_dense(m->engine)) {
        s = dense_step(a, m, until, step, &end);
    } else {
        s = tried_step(a, m, until, step, &end);
    }
    if (s != STATUS_OK) {
        m->failure_time = m->state[SLOT_TIME] + end.length;
        return s;
    }

    // its end becomes the state, unless the arm is folded there
    accept_trial(m, step);
    m->step.last = end.length;
    note_hold(a, m);
    const bool folded =
        end.any && (end.first == EVENT_OF_GAP || end.first == EVENT_OF_FORCE) &&
        motion_wall_is_rigid(m) && chain_is_folded(a, state_angles(m, m->state));
    if (folded || went_through_fold(a, m)) {
        m->failure_time = m->state[SLOT_TIME];
        return STATUS_FOLDED;
    }

    // the event that ends it
    if (end.any) {
        report->event = event_of(m, end.first);
    } else {
        come_to_rest(m);
    }
    meet_stop(m, until);
    return STATUS_OK;
}

double *motion_between(const arm *a, motion *m, double time, state_extent extent)
{
    assert(isfinite(time));
    // step again from the step's start, which is where m->trial was left, into m->between
    double *now = m->state, *start = m->trial;
    m->state = start;
    m->trial = m->between;
    m->step.aim = time;
    status s = motion_try_step(a, m, time - start[SLOT_TIME], extent);
    m->state = now;
    m->trial = start;
    m->between[SLOT_TIME] = time;
    if (s == STATUS_OK) {
        return m->between;
    }
    return NULL;
}
