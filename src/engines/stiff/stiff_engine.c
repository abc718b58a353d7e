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

// a decay faster than this, and than all else in the arm, gets a larger tolerance [1/s]
#define FAST_DECAY 3e4
// shares of method.tolerance (tolerance_of), and the least that they may make of it, so
// that rounding on a wall that moves stays below
#define DECAYING        10
#define YIELDING        1e-2
#define BOUNCING        1e-3
#define LEAST_TOLERANCE 1e-12
#define TINY_ENERGY     1e-30 // [J]
#define LONGEST_TURN    0.25  // of a link in a step, as a share of its way to a fold
#define FIRST_PHASE     0.1   // of the fastest change, in the first step after an event
#define LEAST_FIRST     1e-6  // least and greatest length of that step [s]
#define MOST_FIRST      1e-3
#define SHORTENED       0.1 // share of a step that met its event where it began
// a step that so many times its length would bring to the next change ends there
#define NEARLY_DUE  1.0001
#define SAFETY      0.85  // share that is taken of what the error allows
#define LEAST_LEFT  1e-13 // share of a step that is continued
#define SHORTEST    1e-15 // step that can be made [s]
#define MOST_GROWTH 10
// longest step: what is read within a step has the rounding errors of all of it [s]
#define LONGEST 1
// the motor's work over this turn is the least energy that errors are measured by [rad]
#define LEAST_TURN   1e-2
#define AT_EVENT     1e-6  // share of a step by which it may miss its event
#define SAME_INSTANT 1e-14 // [s]
#define FACE_PHASE   1.5   // of a face that swings, in a step
// of a wall that moves, in a step: an arm that the wall moves entirely shows no error
#define WALL_PHASE 0.4

enum { MOST_ATTEMPTS = 100, MOST_ENDS = 10 };

// --- how long a step is ----------------------------------------------------------------

// By how much the step's end misses the event that it was cut to [s], by one step of
// Newton's method: the value of the event function at the end, over the rate at which it
// falls there. Where the state at the end has the value itself, without the rounding of
// the polynomials, that is taken. 0 where the function does not fall.
static double miss_of(const stiff_integrator *s, const arm *a, const motion *m,
                      event_function w)
{
    const double *end = s->end;
    const value_and_slope g = stiff_watched_at(s, w, 1);
    const double h = s->step.length;
    double value = g.value;
    double slope = g.slope / h;

    // the force, the gap or in contact the depth, the hub's velocity, friction's reserve
    if (w == EVENT_OF_FORCE && !s->divided[w] && end[SLOT_CONTACT] != 0 &&
        (!m->wall_gives || a->wall.law == WALL_KELVIN_VOIGT)) {
        value = end[SLOT_FORCE];
    } else if (w == EVENT_OF_GAP && s->kept[STIFF_GAP] == 0) {
        const bool within = m->wall_gives && end[SLOT_CONTACT] != 0;
        value = end[SLOT_GAP];
        slope = end[SLOT_GAP_VELOCITY];
        if (within) {
            value = -value;
            slope = -slope;
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

// Turns the solved stages into a step: keeps their polynomials, makes the event functions
// of the step, and evaluates the state at its end. False if a link turns too far in it.
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

// The instant of the step at which the first event function other than `passed` falls
// below zero; the step's end, without an event, if none does.
static step_end another_event(stiff_integrator *s, const arm *a, motion *m,
                              event_function passed)
{
    step_end end = {.length = s->step.length};
    s->passed = 1 + (int)passed;
    dense_search_event(a, m, &end);
    s->passed = 0;
    return end;
}

// Takes the step again, cut to the event `at` within it, until it ends where the event
// is. Every attempt moves the event a little, because the polynomials of a shorter step
// differ; if it moves beyond another event, the step ends at that other one. The step
// never becomes longer than its error allows: an event that moves out of it was due to
// rounding, and is dropped. False if no stages are found.
static bool end_at_event(stiff_integrator *s, const arm *a, motion *m, step_end at)
{
    const double allowed = s->step.length;
    double ratio = at.length / allowed, rate = 0.5;
    for (int i = 0; i < MOST_ENDS; i++) {
        // an event right at the start leaves no step to take
        const double h = s->step.length * ratio;
        if (!(h > SHORTEST)) {
            s->kept[KEPT_LENGTH] = larger(h, DBL_MIN);
            evaluate_end(s, a, m);
            break;
        }
        s->step.length = h;

        // the stages, predicted from those of the attempt before
        if (!stiff_solve_stages(s, false, 0, ratio, &rate) || !take_stages(s, a, m)) {
            return false;
        }

        // how far the end is from the event, or from another one that comes before it
        double miss = miss_of(s, a, m, at.first);
        step_end other = {0};
        if (h > at.length * (1 + AT_EVENT)) {
            other = another_event(s, a, m, at.first);
        }
        if (other.any) {
            at = other;
            miss = at.length - h;
        }

        // near enough; the polynomials give the rest
        if (fabs(miss) <= AT_EVENT * h || fabs(miss) < SAME_INSTANT) {
            s->kept[KEPT_LENGTH] = h + miss;
            evaluate_end(s, a, m);
            break;
        }
        if (miss > 0 && h >= allowed) {
            return true; // the event lies outside the step
        }

        // the next attempt ends where this one expects the event
        ratio = smaller(larger(1 + miss / h, 0.5), 1.5);
        ratio = smaller(ratio, larger(allowed / h, 1));
    }
    s->kept[STIFF_EVENT] = 1 + (int)at.first;
    return true;
}

// The length of a step just after an event [s]: that which the last such step could have
// had, or a small share of the period of the arm's fastest change, if that is longer. If
// the step before met its event where it began, it was too long for what begins there (an
// arm at rest that breaks away, whose force is smaller than the error of such a step): a
// tenth of it.
static double length_after_event(const arm *a, motion *m)
{
    const double *kept = state_kept(m, m->state);
    const bool at_once = kept[STIFF_LENGTH] > 0 && kept[KEPT_LENGTH] < SHORTEST;
    if (at_once) {
        return SHORTENED * kept[STIFF_LENGTH];
    }
    const double learned = kept[STIFF_LEARNED];
    const double rate = larger(a->fastest_decay, motion_vibration(a, m, m->state));
    const double by_rate = smaller(larger(FIRST_PHASE / rate, LEAST_FIRST), MOST_FIRST);
    return larger(learned, by_rate);
}

// Cuts a step of length h to where torque or arm will change next, if they keep changing
// at the interval of the last two changes. If two steps would reach beyond that instant,
// both get half of the time that is left, so that the second is not a very short one.
static double cut_to_next_change(motion *m, double h)
{
    const double *kept = state_kept(m, m->state);
    const double due = kept[KEPT_CHANGED] + kept[KEPT_INTERVAL] - m->state[SLOT_TIME];
    const bool comes = kept[KEPT_INTERVAL] > 0 && due > SAME_INSTANT;
    if (!comes) {
        return h;
    }
    if (h * NEARLY_DUE > due) {
        return due;
    }
    if (2 * h > due) {
        return 0.5 * due;
    }
    return h;
}

// Cuts a step of length h to a small phase of the wall's face that swings by itself, and
// to the instant at which its law of motion ends.
static double cut_by_face(const arm *a, motion *m, double h)
{
    const wall_face face = state_face(m->state);
    const wall_model wall = wall_at(&a->wall, m->state[SLOT_TIME]);
    const double rate = wall_face_rate(&wall, face);
    if (rate > 0) {
        h = smaller(h, FACE_PHASE / rate);
    }
    return smaller(h, wall_face_lasts(&a->wall, face));
}

// Cuts a step of length h to a small phase of the wall's own motion, and to the instant
// at which the formula of that motion changes.
static double cut_by_wall_motion(const arm *a, motion *m, double h)
{
    const double rate = wall_motion_rate(&a->wall.motion, m->state[SLOT_TIME]);
    if (rate > 0) {
        h = smaller(h, WALL_PHASE / rate);
    }
    return smaller(h, wall_motion_lasts(&a->wall.motion, m->state[SLOT_TIME]));
}

// The length that a step is first tried with [s]: what the error of the step before
// allows or, just after an event, length_after_event, cut by all that the error does not
// see.
static double first_length(const arm *a, motion *m, bool after_event)
{
    double h = state_kept(m, m->state)[STIFF_NEXT];
    if (after_event) {
        h = length_after_event(a, m);
    }
    h = cut_to_next_change(m, h);
    if (state_face_swings(m, m->state)) {
        h = cut_by_face(a, m, h);
    }
    if (m->wall_moves) {
        h = cut_by_wall_motion(a, m, h);
    }
    return h;
}

// How far the links of an arm on a rigid flat wall turn in the step, relative to what is
// allowed: LONGEST_TURN of the way that is left to a fold, where all links stand across
// the wall. There the contact force has a pole, which the velocities do not show. The way
// left is estimated by the largest cosine of the angles between links and wall.
static double turn_to_fold(const stiff_integrator *s, const arm *a)
{
    const stiff_step *p = &s->step;
    if (p->contact != STIFF_RIGID || a->wall.kind != WALL_PLANE || p->links < 2) {
        return 0;
    }

    // the largest turn of any link at any stage, and the way left to the fold
    double turn = 0, left = 0;
    for (int k = 0; k < p->links; k++) {
        const stiff_link *l = &p->link[k];
        const double q0 = p->q0[p->first + k];
        left = larger(fabs(l->cosine * a->wall.cosine + l->sine * a->wall.sine), left);
        for (int i = 0; i < RADAU_STAGES; i++) {
            const double q = p->stage[p->first + k].q[i / 4][i % 4];
            turn = larger(fabs(q - q0), turn);
        }
    }
    return turn / (LONGEST_TURN * left);
}

// Changes the equation of an electric drive where the step before ended because the
// current reached its limit or left it: from limited to unlimited or back. The current
// itself cannot tell which holds, as it is at the limit but for rounding.
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

    // through an inductance the current flows on from the limit, else it follows at once
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

// The error that a step of this arm may have, as a share of the largest momentum
// (scale_of): method.tolerance times the share of the arm and its wall. By the default
// tolerance the shares keep a promise up to the first contact again: instants to 1e-9 s,
// momenta to 1e-7 and the peak to 1e-6 (tests/test_tolerance.c, tests/random_arms.c). Of
// 9000 random arms the worst has 0.62 of what the promise allows; with shares of 1 it
// was:
//
//     share   arm and wall                    worst with a share of 1
//     1       every other arm                 0.6
//     0.01    walls that give                 15, in the peak
//     0.001   walls that move                 0.8
//     0.001   undamped arms that bounce       2.7, in the sixth contact
//     10      times the above: fast decays
//
// Walls that give: the force begins like a power of the depth, of which the embedded
// formula sees too little in the first step. Walls that move: their many contacts do
// work, whose errors add up in the ledger. Undamped arms that bounce: every impact
// amplifies the errors before it, while damped ones forget them. Fast decays: the
// embedded formula sees an error in them that the formula itself, which is stiffly
// accurate, does not have.
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

    // by the wall, then by the decays
    double tolerance = m->tolerance;
    if (m->wall_moves || bounces) {
        tolerance *= BOUNCING;
    } else if (m->wall_gives) {
        tolerance *= YIELDING;
    }
    if (decays) {
        tolerance *= DECAYING;
    }
    return larger(tolerance, smaller(m->tolerance, LEAST_TOLERANCE));
}

// The scale that errors of this step are measured by: the largest momentum so far, whose
// value up to the step before is `before`. The momentum is the root of twice the kinetic
// energy; it counts as at least what the motor's work in a small turn, and the energy in
// the springs, would give the arm.
static double scale_of(const stiff_integrator *s, const arm *a, motion *m, double before)
{
    const motor_model *motor = &a->motor;
    double torque = motor->torque;
    if (motor->electric) {
        torque =
            motor->torque_constant * motor->gain * motor->voltage / motor->resistance;
    }

    // the larger of the three
    const double driven = fabs(torque) * LEAST_TURN + TINY_ENERGY;
    const double least =
        sqrt(2 * (driven + chain_strain_energy(a, state_angles(m, m->state))));
    return larger(larger(before, least), stiff_momentum(s, s->step.w0));
}

// Writes the values at the step's start into s->kept, which later goes into the state:
// they are what the step's polynomials are added to.
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

// Finds a step whose error is within the tolerance and solves its stages: tries shorter
// and shorter lengths from first_length on. The error e of a step of length h grows as
// h^(RADAU_STAGES + 1), so that h e^(-1 / (RADAU_STAGES + 1)) is what would just be
// allowed. False if no step is found.
static bool solve_within_error(stiff_integrator *s, const arm *a, motion *m)
{
    // where in the step before this one starts; after an event that step says nothing
    const double *before = state_kept(m, m->state);
    const double length_before = before[STIFF_LENGTH];
    const double offset = length_before > 0 ? before[KEPT_USED] / length_before : 0;
    const bool jumped = m->state[SLOT_JUMPED] != 0;
    const bool after_event = !(length_before > 0) || (jumped && before[STIFF_EVENT] != 0);

    // the first length, and the rate at which the iterations are expected to converge
    const double scale = s->kept[STIFF_SCALE];
    double h = first_length(a, m, after_event);
    double rate = after_event ? 0.5 : before[STIFF_RATE];
    bool fresh = after_event, again = false;
    for (int i = 0; i < MOST_ATTEMPTS && h > SHORTEST; i++, again = true) {
        // stages that are not found: without the prediction from the step before, then
        // shorter
        s->step.length = h;
        if (!stiff_solve_stages(s, fresh, offset, h / length_before, &rate)) {
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

        // a decay that ends within the step is taken out of the error
        double error = stiff_error(s, false) / (s->tolerance * scale);
        if (error > 1 && (after_event || again)) {
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
            if (after_event) {
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
    // the equations, and the values at the step's start
    stiff_set_arm(s, a, m);
    stiff_set_start(s, m);
    s->tolerance = tolerance_of(a, m);
    change_drive(s, a, m);
    memcpy(s->kept, state_kept(m, m->state),
           (KEPT_COUNT + stiff_kept_size(a)) * sizeof *s->kept);
    keep_start(s, m, scale_of(s, a, m, s->kept[STIFF_SCALE]));

    // as long as the error allows
    if (!solve_within_error(s, a, m) || !take_stages(s, a, m)) {
        return false;
    }
    s->used = 0;

    // no longer than to the first event
    step_end end = {.length = s->step.length};
    dense_search_event(a, m, &end);
    if (end.any && !end_at_event(s, a, m, end)) {
        return false;
    }
    s->known = s->ended = true;
    return true;
}

// --- the engine ------------------------------------------------------------------------

// Lays out the integrator and its arrays in `memory` and chooses the loops for this
// processor; returns the bytes they take. Without memory it only counts these.
static size_t stiff_init(const arm *a, void *memory)
{
    const size_t n = (size_t)a->dof, links = (size_t)a->links,
                 modes = (size_t)a->damped_modes;
    stiff_integrator none, *s = memory != NULL ? memory : &none;
    stiff_step *p = &s->step;
    layout l = {.block = memory};
    memset(s, 0, sizeof *s);
    s->loops = &stiff_loops_1;
#if defined __x86_64__ && !defined ONE_WIDTH
    if (taylor_width() >= 4) {
        s->loops = &stiff_loops_4;
    }
#endif

    // the integrator itself, then the arrays of a step
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

    // scratch, and what the step keeps in the state
    for (int i = 0; i < 4; i++) {
        s->scratch[i] = layout_add(&l, 2 * n * sizeof(double));
    }
    s->kept = layout_add(&l, (KEPT_COUNT + stiff_kept_size(a)) * sizeof(double));
    s->end = layout_add(&l, (SLOT_COUNT + 4 * n + QUADRATURE_COUNT) * sizeof(double));
    return l.length;
}

// Continues in the step that the state keeps. If the integrator does not have that step
// in hand (a copy of an earlier state was restored), it is rebuilt from the state.
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

// Continues the step that the state keeps, or makes a new one where that is used up or
// the state has jumped. Returns how far the motion can go in it [s], at most `remaining`;
// 0 if no step can be made.
static double stiff_advance(const arm *a, motion *m, double remaining, double step)
{
    (void)step; // the error alone says how long a step is
    stiff_integrator *s = m->memory;

    // a rest of a step that is only rounding is not continued, unless an event ends it
    const double *kept = state_kept(m, m->state);
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

    // the state keeps the step
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
