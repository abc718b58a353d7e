// The stiff engine: Radau IIA of seven stages, order 13, for every arm and wall (stiff_step.h).
//
// A step is as long as the error of its velocities and angles allows, whatever is asked of it:
// rows, stops and the end of a run read its polynomials, and the state keeps it (stiff_stride.h). A
// step within which a watched function falls below zero is taken again up to that instant, so that
// an event is where a step ends. After an event a step begins anew, short; after a change of torque
// it is predicted from the step before, as every other one is.
#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/plain_math.h"
#include "src/solve/dense_location.h"
#include "src/solve/stiff_stride.h"
#include "src/solve/taylor_lanes.h"

#define NEWTON_SHARE 3e-3  // of the tolerance, what the iteration leaves
#define FAST_DECAY   3e4   // beyond it, where nothing else is faster, the tolerance is larger [1/s]
#define DECAYING     10    // so many times
#define BOUNCING     0.1   // and of an arm that bounces undamped, which amplifies errors
#define TINY_ENERGY  1e-30 // [J]
#define LONGEST_TURN 0.25  // in a step, of the way to a fold
#define FIRST_PHASE  0.1   // of the fastest change, in the first step of a motion
#define LEAST_FIRST  1e-6  // length of that [s]
#define MOST_FIRST   1e-3
#define SAFETY       0.85  // share that is taken of what the error allows
#define SHORTEST     1e-15 // step that can be made [s]
#define MOST_GROWTH  10
#define LEAST_TURN   1e-2  // what the motor does in this turn is the least energy of a scale [rad]
#define LEAST_LEFT   1e-13 // share of a step that is gone on with
#define AT_EVENT     1e-6  // share of a step by which it may miss its event
#define SAME_INSTANT 1e-14 // [s]
#define FACE_PHASE   1.5   // of a face that swings, in a step

enum { MOST_ATTEMPTS = 100, MOST_ENDS = 10 };

// --- storage -------------------------------------------------------------------------------------

static size_t kept_size(const arm *a)
{
    return (size_t)(STIFF_HEAD - KEPT_COUNT) + (size_t)a->dof * (2 + RADAU_LANES);
}

// Hands out room after room; without a place to begin it only adds up what they need.
static void *room(char **at, size_t *used, size_t size)
{
    void *here = *at != NULL ? *at + *used : NULL;
    *used += (size + 63) / 64 * 64;
    return here;
}

// Lays out the memory that begins at `base`; returns its size.
static size_t lay_out(stiff_stride *s, const arm *a, char *base)
{
    const size_t n = (size_t)a->dof, links = (size_t)a->links, modes = (size_t)a->damped_modes;
    stiff_step *p = &s->step;
    size_t used = (sizeof *s + 63) / 64 * 64;
    p->stage = room(&base, &used, n * sizeof *p->stage);
    p->body = room(&base, &used, links * sizeof *p->body);
    p->pivot = room(&base, &used, links * sizeof *p->pivot);
    p->rhs = room(&base, &used, n * sizeof *p->rhs);
    p->y = room(&base, &used, n * sizeof *p->y);
    for (size_t i = 0; i <= modes; i++) {
        p->border[i] = room(&base, &used, n * sizeof *p->y);
    }
    p->link = room(&base, &used, links * sizeof *p->link);
    p->mode = room(&base, &used, (modes * n + 1) * sizeof(double));
    p->jacobian = room(&base, &used, n * sizeof(double));
    p->q0 = room(&base, &used, n * sizeof(double));
    p->w0 = room(&base, &used, n * sizeof(double));
    p->a0 = room(&base, &used, n * sizeof(double));
    for (int i = 0; i < 4; i++) {
        s->scratch[i] = room(&base, &used, 2 * n * sizeof(double));
    }
    s->kept = room(&base, &used, (KEPT_COUNT + kept_size(a)) * sizeof(double));
    s->end = room(&base, &used, (SLOT_COUNT + 4 * n + QUADRATURE_COUNT) * sizeof(double));
    return used;
}

static size_t memory_for(const arm *a)
{
    stiff_stride none = {.known = false};
    return lay_out(&none, a, NULL);
}

static void open(const arm *a, motion *m)
{
    stiff_stride *s = m->memory;
    memset(s, 0, sizeof *s);
    lay_out(s, a, m->memory);
    s->loops = &stiff_loops_1;
#if defined __x86_64__
    s->loops = taylor_width() >= 4 ? &stiff_loops_4 : s->loops;
#endif
    s->known = false;
}

// Bytes of a state but for what it keeps.
static size_t head_size(const motion *m)
{
    return (SLOT_COUNT + 4 * (size_t)m->dof + QUADRATURE_COUNT) * sizeof(double);
}

// --- states --------------------------------------------------------------------------------------

// The quadratures' integrals from the step's start, with these weights.
static void add_quadratures(const stiff_stride *s, const motion *m, const double *weight,
                            double *state)
{
    static const int of[][2] = {
        {QUADRATURE_VISCOUS, STIFF_VISCOUS},      {QUADRATURE_DAMPING, STIFF_LOST},
        {QUADRATURE_FORCE, STIFF_FORCE},          {QUADRATURE_WALL, STIFF_WALL_LOST},
        {QUADRATURE_CURRENT, STIFF_CURRENT_RATE}, {QUADRATURE_MOTOR, STIFF_ELECTRIC}};
    double *after = state_quadratures(m, state);
    for (int i = 0; i < (int)(sizeof of / sizeof *of); i++) {
        double sum = 0;
        for (int j = 0; j < RADAU_STAGES; j++) {
            sum += weight[j] * s->kept[of[i][1] + j];
        }
        after[of[i][0]] = s->kept[STIFF_QUADRATURES + of[i][0]] + s->kept[STIFF_LENGTH] * sum;
    }
}

// Angles, velocities and what has added up at `time` after the step's start, evaluated.
static void state_within(const stiff_stride *s, const arm *a, motion *m, double time, double *state)
{
    const double h = s->kept[STIFF_LENGTH], x = time / h;
    const double *q0 = stiff_angles(s), *w0 = stiff_velocities(s);
    const double *acceleration = stiff_accelerations(s);
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    radau_weights weight;
    radau_weights_at(x, &weight);
    for (int k = 0; k < s->step.dof; k++) {
        double once = 0, twice = 0;
        for (int j = 0; j < RADAU_STAGES; j++) {
            once += weight.integral[j] * acceleration[RADAU_LANES * k + j];
            twice += weight.twice[j] * acceleration[RADAU_LANES * k + j];
        }
        q[k] = q0[k] + h * (x * w0[k] + h * twice);
        w[k] = w0[k] + h * once;
    }
    add_quadratures(s, m, weight.integral, state);
    if (a->motor.electric) {
        double *current = state_quadratures(m, state) + QUADRATURE_CURRENT;
        const double most = a->motor.current_limit;
        *current = a->motor.inductance > 0 ? fmax(-most, fmin(*current, most))
                                           : s->kept[STIFF_QUADRATURES + QUADRATURE_CURRENT];
    }

    // what follows from them
    const wall_face start = {s->kept[STIFF_FACE], s->kept[STIFF_FACE + 1]};
    const bool swings = state[SLOT_CONTACT] == 0 && (start.position != 0 || start.velocity != 0);
    if (swings) {
        const wall_face face = wall_face_after(&a->wall, start, time);
        state[SLOT_FACE] = face.position;
        state[SLOT_FACE_VELOCITY] = face.velocity;
    }
    motion_evaluate(a, m, state);
    if (state[SLOT_CONTACT] != 0 && motion_wall_is_rigid(m)) {
        motion_project(a, m, state);
    }
    if (swings) { // what a face left alone loses
        state_quadratures(m, state)[QUADRATURE_WALL] +=
            wall_face_energy(&a->wall, start) - wall_face_energy(&a->wall, state_face(state));
    }
    state[SLOT_MOTOR_WORK] = s->kept[STIFF_WORK] + a->motor.torque * (q[0] - q0[0]);
    state[SLOT_FRICTION_LOSS] =
        s->kept[STIFF_RUBBED] + state[SLOT_FRICTION] * a->motor.stiction * (q[0] - q0[0]);
    state[SLOT_TIME] = s->kept[STIFF_TIME] + (time > DBL_MIN ? time : 0);
    memcpy(state_algorithmic(m, state), state_accelerations(m, state),
           (size_t)m->dof * sizeof(double));
}

static status state_at(const arm *a, motion *m, double h)
{
    const stiff_stride *s = m->memory;
    double *kept = state_kept(m, m->trial);

    // by the instant itself, which is the same whatever stops were made on the way
    double time = m->state[SLOT_TIME] + h;
    time = fabs(time - m->aim) <= 4 * DBL_EPSILON * time ? m->aim : time;
    const bool whole = s->used + h >= s->kept[KEPT_LENGTH];
    const double used = whole ? s->kept[KEPT_LENGTH] : time - s->kept[STIFF_TIME];
    if (whole && s->ended) {
        memcpy(m->trial, s->end, head_size(m));
        m->trial[SLOT_JUMPED] = m->trial[SLOT_IMPULSE] = 0;
    } else {
        state_within(s, a, m, used, m->trial);
    }
    memcpy(kept, s->kept, (KEPT_COUNT + kept_size(a)) * sizeof *kept);
    kept[KEPT_CHANGED] = state_kept(m, m->state)[KEPT_CHANGED];
    kept[KEPT_INTERVAL] = state_kept(m, m->state)[KEPT_INTERVAL];
    kept[KEPT_USED] = used;
    return STATUS_OK;
}

// --- a step --------------------------------------------------------------------------------------

// How the event function of the step's end, which is `at` its event, differs from zero, as a time.
static double miss_of(const stiff_stride *s, const arm *a, const motion *m, watch w)
{
    const double *end = s->end;
    const glance g = function_at(&s->watched[w], 1);
    const double h = s->step.length;
    double value = g.value;
    double slope = g.slope / h;
    if (w == WATCH_FORCE && !s->divided[w] && end[SLOT_CONTACT] != 0 &&
        (!m->wall_gives || a->wall.law == WALL_KELVIN_VOIGT)) {
        value = end[SLOT_FORCE];
    } else if (w == WATCH_GAP && s->kept[STIFF_GAP] == 0) {
        const bool within = m->wall_gives && end[SLOT_CONTACT] != 0;
        value = within ? -end[SLOT_GAP] : end[SLOT_GAP];
        slope = within ? -end[SLOT_GAP_VELOCITY] : end[SLOT_GAP_VELOCITY];
    } else if (w == WATCH_HUB) {
        value = end[SLOT_FRICTION] * state_velocities(m, s->end)[0];
        slope = end[SLOT_FRICTION] * state_accelerations(m, s->end)[0];
    } else if (w == WATCH_STICTION) {
        value = a->motor.stiction - fabs(end[SLOT_FRICTION_TORQUE]) + s->holds_more;
        const glance far = function_at(&s->far_limit, 1);
        slope = (far.value < g.value ? far.slope : g.slope) / h;
    }
    return slope < 0 ? value / -slope : 0;
}

// Evaluates the state at the end of the step kept, which begins at m->state.
static void evaluate_end(stiff_stride *s, const arm *a, motion *m)
{
    memcpy(s->end, m->state, head_size(m));
    state_within(s, a, m, s->kept[KEPT_LENGTH], s->end);
}

// Works out what the solved stages come to.
static bool take_stages(stiff_stride *s, const arm *a, motion *m)
{
    if (!s->loops->residual(&s->step, true)) {
        return false;
    }
    const double grown = state_kept(m, m->state)[STIFF_GAP];
    s->kept[STIFF_GAP] = grown;
    stiff_keep_stages(s);
    s->kept[KEPT_LENGTH] = s->step.length;
    stiff_watch(s, a, m);
    evaluate_end(s, a, m);
    return true;
}

// Takes the step again up to an event at `time` within it, until it ends there.
static bool end_at_event(stiff_stride *s, const arm *a, motion *m, watch w, double time)
{
    double ratio = time / s->step.length, rate = 0.5;
    for (int i = 0; i < MOST_ENDS; i++) {
        const double h = s->step.length * ratio;
        if (!(h > SHORTEST)) { // at once
            s->kept[KEPT_LENGTH] = larger(h, DBL_MIN);
            evaluate_end(s, a, m);
            break;
        }
        s->step.length = h;
        if (!stiff_solve_stages(s, false, 0, ratio, &rate, NEWTON_SHARE * s->tolerance,
                                s->kept[STIFF_SCALE]) ||
            !take_stages(s, a, m)) {
            return false;
        }
        const double miss = miss_of(s, a, m, w);
        if (fabs(miss) <= AT_EVENT * h || fabs(miss) < SAME_INSTANT) {
            s->kept[KEPT_LENGTH] = h + miss;
            evaluate_end(s, a, m);
            break;
        }
        ratio = smaller(larger(1 + miss / h, 0.5), 1.5);
    }
    s->kept[STIFF_EVENT] = 1 + (int)w;
    return true;
}

// How long the first try of a step is, given what the state keeps of the one before.
static double first_try(const stiff_stride *s, const arm *a, motion *m, bool fresh)
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
        h = h * 1.0001 > due ? due : 2 * h > due ? 0.5 * due : h;
    }
    if (state_face_swings(m->state)) {
        const wall_face face = state_face(m->state);
        const double rate = wall_face_rate(&a->wall, face);
        h = rate > 0 ? smaller(h, FACE_PHASE / rate) : h;
        h = smaller(h, wall_face_lasts(&a->wall, face));
    }
    (void)s;
    return h;
}

// How far the links turn in a step on a rigid flat wall, in shares of what a step may take of the
// way to a fold over the hub's axis. There the force has a pole that does not show in the
// velocities.
static double turn_to_fold(const stiff_stride *s, const arm *a)
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

// Where the step before ended at the drive's limit, or left it, the other of its equations holds,
// whatever the current's last digits say.
static void change_drive(stiff_stride *s, const arm *a, motion *m)
{
    const double *before = state_kept(m, m->state);
    stiff_step *p = &s->step;
    s->turned = a->motor.electric && m->state[SLOT_JUMPED] == 0 &&
                before[STIFF_EVENT] == 1 + (int)WATCH_CURRENT &&
                before[KEPT_USED] >= before[KEPT_LENGTH];
    if (!s->turned) {
        return;
    }
    const bool flows = a->motor.inductance > 0;
    const bool was_limited = (int)before[STIFF_DRIVE] == STIFF_LIMITED;
    p->drive = !was_limited ? STIFF_LIMITED : flows ? STIFF_FLOWS : STIFF_FOLLOWS;
    p->current0 = flows ? p->limited : p->current0;
}

// The error that a step of this arm may have, as a share of the momentum.
static double tolerance_of(const arm *a, const motion *m)
{
    const double current = a->motor.inductance > 0 ? a->motor.resistance / a->motor.inductance : 0;
    const double others = fmax(fmax(FAST_DECAY, a->highest_frequency), current);
    const bool decays = a->fastest_decay > others;
    const bool bounces = a->wall.restitution > 0 && a->fastest_decay <= a->highest_frequency;
    return m->tolerance * (decays ? DECAYING : bounces ? BOUNCING : 1);
}

// Takes a step from m->state, as long as its error allows or up to its first event. False if none
// can be made.
static bool make_step(stiff_stride *s, const arm *a, motion *m)
{
    const double *before = state_kept(m, m->state);
    stiff_step *p = &s->step;
    stiff_set_arm(s, a, m);
    stiff_set_start(s, m);
    s->tolerance = tolerance_of(a, m);
    change_drive(s, a, m);
    memcpy(s->kept, before, (KEPT_COUNT + kept_size(a)) * sizeof *before);
    const bool jumped = m->state[SLOT_JUMPED] != 0;
    bool fresh = !(before[STIFF_LENGTH] > 0) || (jumped && before[STIFF_EVENT] != 0);
    const bool began = fresh;
    const double was = before[STIFF_LENGTH], offset = was > 0 ? before[KEPT_USED] / was : 0;
    double h = first_try(s, a, m, fresh), rate = fresh ? 0.5 : before[STIFF_RATE];

    // the least scale is what the motor's torque makes of the arm in a small turn
    const motor_model *motor = &a->motor;
    const double torque =
        motor->electric ? motor->torque_constant * motor->gain * motor->voltage / motor->resistance
                        : motor->torque;
    const double driven = fabs(torque) * LEAST_TURN + TINY_ENERGY;
    const double least = sqrt(2 * (driven + chain_strain_energy(a, state_angles(m, m->state))));
    double scale = larger(larger(before[STIFF_SCALE], least), stiff_momentum(s, p->w0));
    s->kept[STIFF_SCALE] = scale;
    s->kept[KEPT_USED] = 0;
    s->kept[KEPT_JUMPED] = jumped;
    s->kept[STIFF_EVENT] = 0;
    s->kept[STIFF_TIME] = m->state[SLOT_TIME];
    s->kept[STIFF_WORK] = m->state[SLOT_MOTOR_WORK];
    s->kept[STIFF_RUBBED] = m->state[SLOT_FRICTION_LOSS];
    s->kept[STIFF_FACE] = m->state[SLOT_FACE];
    s->kept[STIFF_FACE + 1] = m->state[SLOT_FACE_VELOCITY];
    memcpy(s->kept + STIFF_QUADRATURES, state_quadratures(m, m->state),
           QUADRATURE_COUNT * sizeof(double));
    s->kept[STIFF_DRIVE] = p->drive;
    s->kept[STIFF_QUADRATURES + QUADRATURE_CURRENT] = p->current0;

    // as long as its error is small
    bool again = false, solved = false;
    for (int i = 0; i < MOST_ATTEMPTS && h > SHORTEST; i++) {
        p->length = h;
        solved = stiff_solve_stages(s, fresh, offset, h / was, &rate, NEWTON_SHARE * s->tolerance,
                                    scale);
        if (!solved) {
            h = fresh ? h / 3 : h;
            fresh = true;
            again = true;
            continue;
        }
        const double far = turn_to_fold(s, a);
        if (far > 1) {
            solved = false;
            again = true;
            h *= larger(0.1, 0.9 / far);
            continue;
        }
        double error = stiff_error(s, false) / (s->tolerance * scale);
        if (error > 1 && (began || again)) { // a decay that is over within the step is no error
            error = stiff_error(s, true) / (s->tolerance * scale);
        }
        const double grow = SAFETY * plain_pow(error + 1e-30, -1.0 / (RADAU_STAGES + 1));
        if (error <= 1) {
            s->kept[STIFF_NEXT] = h * smaller(again ? 1 : MOST_GROWTH, grow);
            if (began) {
                s->kept[STIFF_LEARNED] = s->kept[STIFF_NEXT];
            }
            break;
        }
        solved = false;
        again = true;
        h *= larger(0.1, smaller(grow, 0.9));
    }
    if (!solved) {
        return false;
    }
    s->kept[STIFF_RATE] = rate;
    s->used = 0;
    if (!take_stages(s, a, m)) {
        return false;
    }

    // and no longer than to the first event
    double end = p->length;
    watch first;
    bool any;
    dense_search_event(a, m, &end, &first, &any);
    if (any && !end_at_event(s, a, m, first, end)) {
        return false;
    }
    s->known = s->ended = true;
    return true;
}

// Goes on in the step that the state keeps.
static void take_up(stiff_stride *s, const arm *a, motion *m)
{
    const double *kept = state_kept(m, m->state);
    const size_t from = STIFF_LENGTH, size = (KEPT_COUNT + kept_size(a) - from) * sizeof *kept;
    if (!s->known || m->forgets || memcmp(s->kept + from, kept + from, size) != 0) {
        memcpy(s->kept, kept, (KEPT_COUNT + kept_size(a)) * sizeof *kept);
        s->step.dof = a->dof;
        s->step.links = a->links;
        s->step.first = a->first;
        s->step.length = kept[STIFF_LENGTH];
        s->ended = false;
        function_through(&s->force, s->kept + STIFF_FORCE);
        s->gap.degree = FUNCTION_MOST - 1;
        memcpy(s->gap.b, s->kept + STIFF_GAPS, sizeof s->gap.b);
        s->known = true;
    }
    s->used = kept[KEPT_USED];
}

static double begin(const arm *a, motion *m, double remaining, double step)
{
    stiff_stride *s = m->memory;
    const double *kept = state_kept(m, m->state);
    (void)step;
    const double left = kept[KEPT_LENGTH] - kept[KEPT_USED];
    const bool goes_on = m->state[SLOT_JUMPED] == 0 && kept[KEPT_LENGTH] > 0 &&
                         left > (kept[STIFF_EVENT] != 0 ? 0 : LEAST_LEFT * kept[KEPT_LENGTH]);
    if (goes_on) {
        take_up(s, a, m);
    } else if (!make_step(s, a, m)) {
        s->known = false;
        return 0;
    }
    m->forgets = false;
    memcpy(state_kept(m, m->state), s->kept, (KEPT_COUNT + kept_size(a)) * sizeof *kept);
    state_kept(m, m->state)[KEPT_USED] = s->used;
    return smaller(s->kept[KEPT_LENGTH] - s->used, remaining);
}

// --- what the contact machine asks ---------------------------------------------------------------

static glance by_time(const stiff_stride *s, glance g)
{
    return (glance){g.value, g.slope / s->step.length};
}

static glance look(const arm *a, const motion *m, watch w, double h)
{
    const stiff_stride *s = m->memory;
    const double x = (s->used + h) / s->step.length;
    glance near = function_at(&s->watched[w], x);
    if (w >= WATCH_STICTION) {
        const glance far = function_at(w == WATCH_CURRENT ? &s->far_current : &s->far_limit, x);
        near = near.value < far.value ? near : far;
    }
    (void)a;
    return by_time(s, near);
}

static double bend(const arm *a, const motion *m, watch w, double from, double to)
{
    const stiff_stride *s = m->memory;
    const double length = s->step.length;
    const double x0 = (s->used + from) / length, x1 = (s->used + to) / length;
    const stiff_function *f = s->used > 0 && w == WATCH_FORCE ? &s->force : &s->watched[w];
    double most = function_bend(f, x0, x1);
    if (w >= WATCH_STICTION) {
        const stiff_function *far = w == WATCH_CURRENT ? &s->far_current : &s->far_limit;
        most = larger(most, function_bend(far, x0, x1));
    } else if (w == WATCH_FORCE) {
        most = larger(most, function_bend(&s->force, x0, x1));
    }
    (void)a;
    return most / (length * length);
}

static bool clear(const arm *a, motion *m, watch w, double h)
{
    const stiff_stride *s = m->memory;
    const stiff_function *far = w == WATCH_CURRENT ? &s->far_current : &s->far_limit;
    (void)a, (void)h;
    return function_least(&s->watched[w]) > 0 && (w < WATCH_STICTION || function_least(far) > 0);
}

static bool bounded(const arm *a, motion *m, double h, double most)
{
    const stiff_stride *s = m->memory;
    (void)a, (void)h;
    return function_greatest(&s->force) <= most;
}

static glance force_at(const arm *a, const motion *m, double h)
{
    const stiff_stride *s = m->memory;
    (void)a;
    return by_time(s, function_at(&s->force, (s->used + h) / s->step.length));
}

static glance gap_at(const arm *a, const motion *m, double h)
{
    const stiff_stride *s = m->memory;
    if (!wall_stands(&a->wall)) {
        return (glance){HUGE_VAL, 0};
    }
    return by_time(s, function_at(&s->gap, (s->used + h) / s->step.length));
}

static glance hub_at(const arm *a, const motion *m, double h)
{
    const stiff_stride *s = m->memory;
    const double length = s->step.length, x = (s->used + h) / length;
    const double *of_hub = stiff_accelerations(s);
    radau_weights w;
    radau_weights_at(x, &w);
    double once = 0, twice = 0;
    for (int j = 0; j < RADAU_STAGES; j++) {
        once += w.integral[j] * of_hub[j];
        twice += w.twice[j] * of_hub[j];
    }
    const double velocity = stiff_velocities(s)[0];
    (void)a;
    return (glance){stiff_angles(s)[0] + length * (x * velocity + length * twice),
                    velocity + length * once};
}

static void sense_at(const arm *a, const motion *m, double time, double *state)
{
    const stiff_stride *s = m->memory;
    const double h = s->kept[STIFF_LENGTH], x = (time - s->kept[STIFF_TIME]) / h;
    const int seen[] = {0, a->first, a->dof - 1};
    radau_weights weight;
    radau_weights_at(x, &weight);
    for (int i = 0; i < (int)(sizeof seen / sizeof *seen); i++) {
        const int k = seen[i];
        const double *of_body = stiff_accelerations(s) + RADAU_LANES * k;
        const double w0 = stiff_velocities(s)[k];
        double value = 0, once = 0, twice = 0;
        for (int j = 0; j < RADAU_STAGES; j++) {
            value += weight.value[j] * of_body[j];
            once += weight.integral[j] * of_body[j];
            twice += weight.twice[j] * of_body[j];
        }
        state_angles(m, state)[k] = stiff_angles(s)[k] + h * (x * w0 + h * twice);
        state_velocities(m, state)[k] = w0 + h * once;
        state_accelerations(m, state)[k] = value;
    }
    const double *force = s->kept + STIFF_FORCE;
    double pressed = 0;
    for (int j = 0; j < RADAU_STAGES; j++) {
        pressed += weight.integral[j] * force[j];
    }
    state[SLOT_FORCE] = function_at(&s->force, x).value;
    state_quadratures(m, state)[QUADRATURE_FORCE] =
        s->kept[STIFF_QUADRATURES + QUADRATURE_FORCE] + h * pressed;
}

static void first_event(const arm *a, motion *m, double *h, watch *first, bool *any)
{
    const stiff_stride *s = m->memory;
    const int event = (int)s->kept[STIFF_EVENT];
    (void)a;
    *any = event > 0 && *h >= s->kept[KEPT_LENGTH] - s->used;
    *first = *any ? (watch)(event - 1) : WATCH_GAP;
}

const engine stiff_engine = {.name = "stiff",
                             .begin = begin,
                             .state_at = state_at,
                             .look = look,
                             .bend = bend,
                             .bends_from_start = true,
                             .clear = clear,
                             .bounded = bounded,
                             .force_at = force_at,
                             .gap_at = gap_at,
                             .hub_at = hub_at,
                             .sense_at = sense_at,
                             .parabolas = 32,
                             .first_event = first_event,
                             .peak = dense_search_peak,
                             .kept_for = kept_size,
                             .memory_for = memory_for,
                             .open = open};
