// The stiff engine: Radau IIA of seven stages, order 13, for every arm and wall
// (stiff_step.h).
//
// A step is as long as the error of its velocities and angles allows, whatever is asked
// of it: rows, stops and the end of a run read its polynomials, and the state keeps it
// (stiff_integrator.h). A step within which an event function falls below zero is taken
// again up to that instant, so that an event is where a step ends. After an event a step
// begins anew, short; after a change of torque it is predicted from the step before, as
// every other one is.
//
// Its stages are solved in stiff_stages.c, and stiff_output.c has what it tells.
#include <float.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/plain_math.h"
#include "src/contact/locate.h"
#include "src/engines/pair/taylor_lanes.h"
#include "src/engines/stiff/stiff_integrator.h"

// beyond it, where nothing else is faster, the tolerance is larger [1/s]
#define FAST_DECAY 3e4
#define DECAYING   10  // so many times
#define BOUNCING   0.1 // and of an arm that bounces undamped, which amplifies errors
// of a wall that moves: errors of the work of its many contacts add up
#define DRIVEN       0.1
#define TINY_ENERGY  1e-30 // [J]
#define LONGEST_TURN 0.25  // in a step, of the way to a fold
#define FIRST_PHASE  0.1   // of the fastest change, in the first step of a motion
#define LEAST_FIRST  1e-6  // length of that [s]
#define MOST_FIRST   1e-3
#define SAFETY       0.85  // share that is taken of what the error allows
#define LEAST_LEFT   1e-13 // share of a step that is continued
#define SHORTEST     1e-15 // step that can be made [s]
#define MOST_GROWTH  10
// step; what is read of a part of one rounds as the whole does [s]
#define LONGEST 1
// what the motor does in this turn is the least energy of a scale [rad]
#define LEAST_TURN   1e-2
#define AT_EVENT     1e-6  // share of a step by which it may miss its event
#define SAME_INSTANT 1e-14 // [s]
#define FACE_PHASE   1.5   // of a face that swings, in a step
// of a wall that moves: where it leads all that can move, no error shows
#define WALL_PHASE 0.4

enum { MOST_ATTEMPTS = 100, MOST_ENDS = 10 };

// --- how long a step is ----------------------------------------------------------------

// How the event function of the step's end, which is `at` its event, differs from zero,
// as a time.
static double miss_of(const stiff_integrator *s, const arm *a, const motion *m,
                      event_function w)
{
    const double *end = s->end;
    const value_and_slope g = stiff_watched_at(s, w, 1);
    const double h = s->step.length;
    double value = g.value;
    double slope = g.slope / h;
    if (w == EVENT_OF_FORCE && !s->divided[w] && end[SLOT_CONTACT] != 0 &&
        (!m->wall_gives || a->wall.law == WALL_KELVIN_VOIGT)) {
        value = end[SLOT_FORCE];
    } else if (w == EVENT_OF_GAP && s->kept[STIFF_GAP] == 0) {
        const bool within = m->wall_gives && end[SLOT_CONTACT] != 0;
        if (within) {
            value = -end[SLOT_GAP];
        } else {
            value = end[SLOT_GAP];
        }
        if (within) {
            slope = -end[SLOT_GAP_VELOCITY];
        } else {
            slope = end[SLOT_GAP_VELOCITY];
        }
    } else if (w == EVENT_OF_HUB) {
        value = end[SLOT_FRICTION] * state_velocities(m, s->end)[0];
        slope = end[SLOT_FRICTION] * state_accelerations(m, s->end)[0];
    } else if (w == EVENT_OF_STICTION) {
        value = a->motor.stiction - fabs(end[SLOT_FRICTION_TORQUE]) + s->stiction_excess;
    }
    if (slope < 0) {
        return value / -slope;
    }
    return 0;
}

// Evaluates the state at the end of the step kept, which begins at m->state.
static void evaluate_end(stiff_integrator *s, const arm *a, motion *m)
{
    memcpy(s->end, m->state, stiff_head_size(m));
    stiff_state_within(s, a, m, s->kept[KEPT_LENGTH], s->end);
}

// Works out what the solved stages come to.
static bool take_stages(stiff_integrator *s, const arm *a, motion *m)
{
    if (!s->loops->residual(&s->step, true)) {
        return false;
    }
    s->kept[STIFF_GAP] = state_kept(m, m->state)[STIFF_GAP];
    stiff_keep_stages(s);
    s->kept[KEPT_LENGTH] = s->step.length;
    stiff_event_functions(s, a, m);
    evaluate_end(s, a, m);
    return true;
}

// Where the first event function other than `passed` falls below zero in the step, if one
// does.
static step_end another_event(stiff_integrator *s, const arm *a, motion *m,
                              event_function passed)
{
    step_end end = {.length = s->step.length};
    s->passed = 1 + (int)passed;
    dense_search_event(a, m, &end);
    s->passed = 0;
    return end;
}

// Takes the step again up to an event within it, until it ends there: no longer than its
// error allows, and at another event where the first moves to beyond that one. An event
// that moves out of the step was one of rounding, and does not end it.
static bool end_at_event(stiff_integrator *s, const arm *a, motion *m, step_end at)
{
    const double allowed = s->step.length;
    double ratio = at.length / allowed, rate = 0.5;
    for (int i = 0; i < MOST_ENDS; i++) {
        const double h = s->step.length * ratio;
        if (!(h > SHORTEST)) { // at once
            s->kept[KEPT_LENGTH] = larger(h, DBL_MIN);
            evaluate_end(s, a, m);
            break;
        }
        s->step.length = h;

        // stages that are not found: without the course of the step before, then shorter
        if (!stiff_solve_stages(s, false, 0, ratio, &rate) || !take_stages(s, a, m)) {
            return false;
        }
        double miss = miss_of(s, a, m, at.first);
        step_end other = {0};
        if (h > at.length * (1 + AT_EVENT)) {
            other = another_event(s, a, m, at.first);
        }
        if (other.any) {
            at = other;
            miss = at.length - h;
        }
        if (fabs(miss) <= AT_EVENT * h || fabs(miss) < SAME_INSTANT) {
            s->kept[KEPT_LENGTH] = h + miss;
            evaluate_end(s, a, m);
            break;
        }
        if (miss > 0 && h >= allowed) {
            return true;
        }
        ratio = smaller(larger(1 + miss / h, 0.5), 1.5);
        ratio = smaller(ratio, larger(allowed / h, 1));
    }
    s->kept[STIFF_EVENT] = 1 + (int)at.first;
    return true;
}

// How long the first try of a step is, given what the state keeps of the one before.
static double first_try(const arm *a, motion *m, bool fresh)
{
    const double *kept = state_kept(m, m->state);
    double h = kept[STIFF_NEXT];
    if (fresh) { // as long as the last one after an event could be, or slow arms have it
        const double rate = larger(a->fastest_decay, motion_vibration(a, m, m->state));
        const double slow = smaller(larger(FIRST_PHASE / rate, LEAST_FIRST), MOST_FIRST);
        h = larger(kept[STIFF_LEARNED], slow);
    }

    // not beyond where the next change is due, and no scraps before it
    const double due = kept[KEPT_CHANGED] + kept[KEPT_INTERVAL] - m->state[SLOT_TIME];
    if (kept[KEPT_INTERVAL] > 0 && due > SAME_INSTANT) {
        if (h * 1.0001 > due) {
            h = due;
        } else if (2 * h > due) {
            h = 0.5 * due;
        }
    }
    if (state_face_swings(m, m->state)) {
        const wall_face face = state_face(m->state);
        const wall_model wall = wall_at(&a->wall, m->state[SLOT_TIME]);
        const double rate = wall_face_rate(&wall, face);
        if (rate > 0) {
            h = smaller(h, FACE_PHASE / rate);
        }
        h = smaller(h, wall_face_lasts(&a->wall, face));
    }
    if (m->wall_moves) {
        const double rate = wall_motion_rate(&a->wall.motion, m->state[SLOT_TIME]);
        if (rate > 0) {
            h = smaller(h, WALL_PHASE / rate);
        }
        h = smaller(h, wall_motion_lasts(&a->wall.motion, m->state[SLOT_TIME]));
    }
    return h;
}

// How far the links turn in a step on a rigid flat wall, in shares of what a step may
// take of the way to a fold over the hub's axis. There the force has a pole that does not
// show in the velocities.
static double turn_to_fold(const stiff_integrator *s, const arm *a)
{
    const stiff_step *p = &s->step;
    if (p->contact != STIFF_RIGID || a->wall.kind != WALL_PLANE || p->links < 2) {
        return 0;
    }
    double turn = 0, left = 0;
    for (int k = 0; k < p->links; k++) {
        const stiff_link *l = &p->link[k];
        const double q0 = p->q0[p->first + k];
        left = larger(fabs(l->cosine * a->wall.cosine + l->sine * a->wall.sine), left);
        for (int i = 0; i < RADAU_STAGES; i++) {
            turn = larger(fabs(p->stage[p->first + k].q[i / 4][i % 4] - q0), turn);
        }
    }
    return turn / (LONGEST_TURN * left);
}

// Where the step before ended at the drive's limit, or left it, the other of its
// equations holds, whatever the current's last digits say.
static void change_drive(stiff_integrator *s, const arm *a, motion *m)
{
    const double *before = state_kept(m, m->state);
    stiff_step *p = &s->step;
    s->turned = a->motor.electric && m->state[SLOT_JUMPED] == 0 &&
                before[STIFF_EVENT] == 1 + (int)EVENT_OF_CURRENT &&
                before[KEPT_USED] >= before[KEPT_LENGTH];
    if (!s->turned) {
        return;
    }
    const bool flows = a->motor.inductance > 0;
    const bool was_limited = (int)before[STIFF_DRIVE] == STIFF_LIMITED;
    if (!was_limited) {
        p->drive = STIFF_LIMITED;
    } else if (flows) {
        p->drive = STIFF_FLOWS;
    } else {
        p->drive = STIFF_FOLLOWS;
    }
    if (flows) {
        p->current0 = p->limited;
    }
}

// The error that a step of this arm may have, as a share of the momentum.
static double tolerance_of(const arm *a, const motion *m)
{
    double current = 0;
    if (a->motor.inductance > 0) {
        current = a->motor.resistance / a->motor.inductance;
    }
    const double others = fmax(fmax(FAST_DECAY, a->highest_frequency), current);
    const bool decays = a->fastest_decay > others;
    const bool bounces =
        a->wall.restitution > 0 && a->fastest_decay <= a->highest_frequency;
    double tolerance = m->tolerance;
    if (m->wall_moves) {
        tolerance *= DRIVEN;
    }
    if (decays) {
        return tolerance * DECAYING;
    }
    if (bounces && !m->wall_moves) {
        return tolerance * BOUNCING;
    }
    return tolerance;
}

// What errors of this step are a share of: the largest momentum so far. The least is what
// the motor's torque makes of the arm in a small turn.
static double scale_of(const stiff_integrator *s, const arm *a, motion *m, double before)
{
    const motor_model *motor = &a->motor;
    double torque = motor->torque;
    if (motor->electric) {
        torque =
            motor->torque_constant * motor->gain * motor->voltage / motor->resistance;
    }
    const double driven = fabs(torque) * LEAST_TURN + TINY_ENERGY;
    const double least =
        sqrt(2 * (driven + chain_strain_energy(a, state_angles(m, m->state))));
    return larger(larger(before, least), stiff_momentum(s, s->step.w0));
}

// Puts what holds at the step's start into what is kept.
static void keep_start(stiff_integrator *s, motion *m, double scale)
{
    double *kept = s->kept, *state = m->state;
    kept[STIFF_SCALE] = scale;
    kept[KEPT_USED] = 0;
    kept[KEPT_JUMPED] = state[SLOT_JUMPED] != 0;
    kept[STIFF_EVENT] = 0;
    kept[STIFF_TIME] = state[SLOT_TIME];
    kept[STIFF_WORK] = state[SLOT_MOTOR_WORK];
    kept[STIFF_RUBBED] = state[SLOT_FRICTION_LOSS];
    kept[STIFF_FACE] = state[SLOT_FACE];
    kept[STIFF_FACE + 1] = state[SLOT_FACE_VELOCITY];
    memcpy(kept + STIFF_QUADRATURES, state_quadratures(m, state),
           QUADRATURE_COUNT * sizeof(double));
    kept[STIFF_DRIVE] = s->step.drive;
    kept[STIFF_QUADRATURES + QUADRATURE_CURRENT] = s->step.current0;
}

// Solves a step's stages, as long a step as its error allows. False if there is none.
static bool solve_within_error(stiff_integrator *s, const arm *a, motion *m)
{
    const double *before = state_kept(m, m->state);
    const double was = before[STIFF_LENGTH];
    const double offset = was > 0 ? before[KEPT_USED] / was : 0;
    const bool jumped = m->state[SLOT_JUMPED] != 0;
    const bool begins = !(was > 0) || (jumped && before[STIFF_EVENT] != 0);
    const double scale = s->kept[STIFF_SCALE];
    double h = first_try(a, m, begins);
    double rate = begins ? 0.5 : before[STIFF_RATE];
    bool fresh = begins, again = false;
    for (int i = 0; i < MOST_ATTEMPTS && h > SHORTEST; i++, again = true) {
        s->step.length = h;
        if (!stiff_solve_stages(s, fresh, offset, h / was, &rate)) {
            if (fresh) {
                h = h / 3;
            }
            fresh = true;
            continue;
        }

        // not past a fold
        const double far = turn_to_fold(s, a);
        if (far > 1) {
            h *= larger(0.1, 0.9 / far);
            continue;
        }

        // a decay that is over within the step is no error
        double error = stiff_error(s, false) / (s->tolerance * scale);
        if (error > 1 && (begins || again)) {
            error = stiff_error(s, true) / (s->tolerance * scale);
        }
        const double grow = SAFETY * plain_pow(error + 1e-30, -1.0 / (RADAU_STAGES + 1));

        // small enough: the next step is longer, but not just after one that was too long
        if (error <= 1) {
            double most = MOST_GROWTH;
            if (again) {
                most = 1;
            }
            s->kept[STIFF_RATE] = rate;
            s->kept[STIFF_NEXT] = smaller(h * smaller(most, grow), LONGEST);
            if (begins) {
                s->kept[STIFF_LEARNED] = s->kept[STIFF_NEXT];
            }
            return true;
        }
        h *= larger(0.1, smaller(grow, 0.9));
    }
    return false;
}

// Takes a step from m->state, as long as its error allows or up to its first event. False
// if none can be made.
static bool make_stiff_step(stiff_integrator *s, const arm *a, motion *m)
{
    stiff_set_arm(s, a, m);
    stiff_set_start(s, m);
    s->tolerance = tolerance_of(a, m);
    change_drive(s, a, m);
    memcpy(s->kept, state_kept(m, m->state),
           (KEPT_COUNT + stiff_kept_size(a)) * sizeof *s->kept);
    keep_start(s, m, scale_of(s, a, m, s->kept[STIFF_SCALE]));
    if (!solve_within_error(s, a, m) || !take_stages(s, a, m)) {
        return false;
    }
    s->used = 0;

    // and no longer than to the first event
    step_end end = {.length = s->step.length};
    dense_search_event(a, m, &end);
    if (end.any && !end_at_event(s, a, m, end)) {
        return false;
    }
    s->known = s->ended = true;
    return true;
}

// --- the engine ------------------------------------------------------------------------

static size_t stiff_init(const arm *a, void *memory)
{
    const size_t n = (size_t)a->dof, links = (size_t)a->links,
                 modes = (size_t)a->damped_modes;
    stiff_integrator none, *s = memory != NULL ? memory : &none;
    stiff_step *p = &s->step;
    layout l = {.block = memory};
    memset(s, 0, sizeof *s);
    s->loops = &stiff_loops_1;
#if defined __x86_64__
    if (taylor_width() >= 4) {
        s->loops = &stiff_loops_4;
    }
#endif
    layout_add(&l, sizeof *s);
    p->stage = layout_add(&l, n * sizeof *p->stage);
    p->body = layout_add(&l, links * sizeof *p->body);
    p->pivot = layout_add(&l, links * sizeof *p->pivot);
    p->y = layout_add(&l, n * sizeof *p->y);
    for (size_t i = 0; i <= modes; i++) {
        p->border[i] = layout_add(&l, n * sizeof *p->y);
    }
    p->link = layout_add(&l, links * sizeof *p->link);
    p->mode = layout_add(&l, (modes * n + 1) * sizeof(double));
    p->jacobian = layout_add(&l, n * sizeof(double));
    p->q0 = layout_add(&l, n * sizeof(double));
    p->w0 = layout_add(&l, n * sizeof(double));
    p->a0 = layout_add(&l, n * sizeof(double));
    for (int i = 0; i < 4; i++) {
        s->scratch[i] = layout_add(&l, 2 * n * sizeof(double));
    }
    s->kept = layout_add(&l, (KEPT_COUNT + stiff_kept_size(a)) * sizeof(double));
    s->end = layout_add(&l, (SLOT_COUNT + 4 * n + QUADRATURE_COUNT) * sizeof(double));
    return l.length;
}

// Continues in the step that the state keeps.
static void resume_stiff_step(stiff_integrator *s, const arm *a, motion *m)
{
    const double *kept = state_kept(m, m->state);
    const size_t from = STIFF_LENGTH,
                 size = (KEPT_COUNT + stiff_kept_size(a) - from) * sizeof *kept;
    if (!s->known || m->step.history_invalid ||
        memcmp(s->kept + from, kept + from, size) != 0) {
        memcpy(s->kept, kept, (KEPT_COUNT + stiff_kept_size(a)) * sizeof *kept);
        s->step.dof = a->dof;
        s->step.links = a->links;
        s->step.first = a->first;
        s->step.length = kept[STIFF_LENGTH];
        s->ended = false;
        function_through(&s->force, stiff_force(s));
        s->gap.degree = FUNCTION_MOST - 1;
        memcpy(s->gap.b, s->kept + STIFF_GAPS, sizeof s->gap.b);
        s->known = true;
    }
    s->used = kept[KEPT_USED];
}

static double stiff_advance(const arm *a, motion *m, double remaining, double step)
{
    stiff_integrator *s = m->memory;
    const double *kept = state_kept(m, m->state);
    (void)step;
    const double left = kept[KEPT_LENGTH] - kept[KEPT_USED];
    const double least = kept[STIFF_EVENT] != 0 ? 0 : LEAST_LEFT * kept[KEPT_LENGTH];
    const bool continues =
        m->state[SLOT_JUMPED] == 0 && kept[KEPT_LENGTH] > 0 && left > least;
    if (continues) {
        resume_stiff_step(s, a, m);
    } else if (!make_stiff_step(s, a, m)) {
        s->known = false;
        return 0;
    }
    m->step.history_invalid = false;
    m->most_force = function_greatest(&s->force);
    memcpy(state_kept(m, m->state), s->kept,
           (KEPT_COUNT + stiff_kept_size(a)) * sizeof *kept);
    state_kept(m, m->state)[KEPT_USED] = s->used;
    return smaller(s->kept[KEPT_LENGTH] - s->used, remaining);
}

const engine stiff_engine = {.name = "stiff",
                             .init = stiff_init,
                             .advance = stiff_advance,
                             .state_at = stiff_state_at,
                             .dense_output = stiff_dense_output,
                             .event_function = stiff_event_function,
                             .second_derivative = stiff_second_derivative,
                             .excludes_event = stiff_excludes_event,
                             .first_event = stiff_first_event,
                             .kept = STIFF_HEAD - KEPT_COUNT,
                             .kept_for_body = 2 + RADAU_LANES,
                             .parabolas = 32};
