// The two-link arm by power series (taylor_kernel.h): a dense engine.
//
// The stride goes as far as the fastest mode and the rotation let a series of the highest order
// reach, and is shortened until its last terms are small; where they are small before, as in one
// that something else ends sooner, the series end with them. Everything within it (events, rows,
// peaks, quadratures) is a polynomial.
//
// Steps that cut a stride without an event (a sample whose command stays, an instant that a program
// stops at) go on in it: the state says where it began, the engine's memory holds its series. While
// commands stay, a stride is made for twice as long as the one before.
#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/sincos.h"
#include "src/solve/dense_location.h"
#include "src/solve/motion.h"
#include "src/solve/taylor_engine.h"
#include "src/solve/taylor_polynomial.h"

// Strides stay below this over the fastest rate and the angular velocities.
#define LONGEST_REACH 2.0
// A decay over a stride: the series of the highest order is stable on the negative axis beyond 7.
#define LONGEST_DECAY 4.0
// On a flat wall the first link turns by no more than this share of what is left to a fold.
#define LONGEST_TURN 0.1

// What is nothing but rounding in the first coefficients of a watched function at its edge: of the
// value and of its derivatives, over which nothing is known but that they are small.
#define EDGE_VALUE 1e-9
#define EDGE_RATE  1e-9
#define EDGE_MORE  1e-7
#define EDGE_GAP   1e-12 // [m]
// As deep in the wall an arm that leaves it may be by the truncation of the series that led there.
#define EDGE_DEPTH 1e-6 // [m]
// Less of a stride left than this share of it is rounding.
#define LEAST_LEFT 1e-9

typedef struct taylor_stride {
    taylor_lane lane;                       // the series
    polynomial watched[WATCH_STICTION + 1]; // as far as they were asked for; stiction: nearer limit
    polynomial far_limit;                   // of stiction
    unsigned known;                         // which of them are, a bit each
    bool ready;                             // the series of the next stride were computed apart
    double kept[KEPT_COUNT];                // the stride that the series are of
    double used;                            // of it before the step in hand [s]
    bool own;                               // the lane's block has all of them
} taylor_stride;

bool taylor_engine_suits(const arm *a)
{
    const bool wall =
        a->wall.kind == WALL_NONE || a->wall.kind == WALL_POINT || a->wall.kind == WALL_PLANE;
    const bool gives = wall_stands(&a->wall) && wall_gives(&a->wall);
    return a->links == 2 && wall && !gives && arm_is_plain(a);
}

// --- a stride -----------------------------------------------------------------------------------

// From angles q and velocities w on.
static void put_inputs(const arm *a, const motion *m, const double *q, const double *w,
                       double wanted, double *block)
{
    const bool point = a->wall.kind == WALL_POINT;

    // the arm, its wall and its motor
    block[AT_MASS] = a->link_mass;
    block[AT_INERTIA] = a->link_inertia;
    block[AT_LENGTH] = a->link_length;
    block[AT_STIFFNESS] = a->joint_stiffness;
    block[AT_DAMPING] = a->joint_damping;
    block[AT_WALL_X] = point ? a->wall.x : a->wall.cosine;
    block[AT_WALL_Y] = point ? a->wall.y : a->wall.sine;
    block[AT_TORQUE] = a->motor.torque;
    block[AT_STICTION] = a->motor.stiction;
    block[AT_VISCOUS] = a->motor.damping;
    block[AT_HUB_INERTIA] = a->hub_inertia;
    block[AT_HUB_STIFFNESS] = a->hub_stiffness;
    block[AT_HUB_DAMPING] = a->hub_joint_damping;

    // the state
    block[AT_FRICTION] = m->state[SLOT_FRICTION];
    block[AT_START_ANGLE] = q[0];
    block[AT_START_ANGLE + 1] = q[a->first];
    block[AT_START_ANGLE + 2] = q[a->first + 1];
    block[AT_START_VELOCITY] = w[0];
    block[AT_START_VELOCITY + 1] = w[a->first];
    block[AT_START_VELOCITY + 2] = w[a->first + 1];
    block[AT_WANTED] = wanted;
}

// The length that is tried from velocities w on, up to `most`.
static double wanted_stride(const arm *a, const motion *m, const double *w, double most)
{
    // as far as the fastest mode, the rotation and the fastest decay let the highest order reach
    double rate = a->highest_frequency > 1e-3 ? a->highest_frequency : 1e-3;
    for (int i = 0; i < m->dof; i++) {
        rate = rate < 1.2 * fabs(w[i]) ? 1.2 * fabs(w[i]) : rate;
    }
    const double turning = 1.2 * fabs(w[a->first + 1] - w[a->first]); // the bend turns, too
    rate = rate < turning ? turning : rate;
    double wanted = LONGEST_REACH / rate;
    wanted = most < wanted ? most : wanted;
    return a->fastest_decay * wanted > LONGEST_DECAY ? LONGEST_DECAY / a->fastest_decay : wanted;
}

static double rounding_of(const arm *a, const motion *m, const taylor_stride *s)
{
    return motion_rounding_at(a, m->dof, s->kept + KEPT_ANGLES, s->kept + KEPT_VELOCITIES);
}

// A function that is to be watched, from the series: only where it comes near zero is it asked for.
// Just after an event it may begin at zero, as the gap does after a bounce cut short.
static void prepare_watched(const arm *a, const motion *m, taylor_stride *s, watch w)
{
    const int order = s->lane.form.order;
    const bool jumped = s->kept[KEPT_JUMPED] != 0;
    const double friction = m->state[SLOT_FRICTION], stiction = a->motor.stiction;
    polynomial *p = &s->watched[w];
    const taylor_lane *lane = &s->lane;
    const int spacing = taylor_spacing(lane);
    s->known |= 1u << w;

    // the wall
    if (w == WATCH_FORCE) {
        const double edge[] = {EDGE_VALUE, EDGE_RATE, EDGE_MORE};
        set_polynomial(p, taylor_term(lane, AT_FORCE), spacing, order, 1);
        if (jumped) {
            leave_edge(p, edge);
        }
    } else if (w == WATCH_GAP) {
        set_polynomial(p, taylor_term(lane, AT_GAP), spacing, order + 2, 1);
        const bool inside = p->terms[0] < 0 && p->terms[0] > -EDGE_DEPTH && p->terms[1] > 0;
        p->terms[0] = inside ? 0 : p->terms[0];
        if (jumped || inside) {
            const double rounding = EDGE_RATE * rounding_of(a, m, s);
            leave_edge(p, (double[]){EDGE_GAP, EDGE_RATE, fmax(EDGE_MORE, rounding)});
        }
    }

    // the hub; what holds a stuck one may hold a little more just after an event
    if (w == WATCH_HUB) {
        const int place = a->hub_spring ? AT_RATE_0 : AT_RATE_1;
        set_polynomial(p, taylor_term(lane, place), spacing, order + 1, friction);
        if (jumped) {
            leave_edge(p, (double[]){0, EDGE_RATE * rounding_of(a, m, s), EDGE_MORE});
        }
    } else if (w == WATCH_STICTION) {
        const double *hold = taylor_term(lane, AT_HOLD);
        const double sign = hold[0] < 0 ? -1 : 1;
        set_polynomial(p, hold, spacing, order, -sign);
        set_polynomial(&s->far_limit, hold, spacing, order, sign);
        p->terms[0] += stiction;
        s->far_limit.terms[0] += stiction;
        p->terms[0] = jumped && fabs(p->terms[0]) <= EDGE_VALUE ? EDGE_VALUE : p->terms[0];
    }
}

static const polynomial *watched(const arm *a, const motion *m, watch w)
{
    taylor_stride *s = m->memory;
    if (!(s->known & 1u << w)) {
        prepare_watched(a, m, s, w);
    }
    return &s->watched[w];
}

// Notes down in the state the stride that begins there, to be as long as `most` [s] if it may.
static void keep(motion *m, double most)
{
    double *kept = state_kept(m, m->state);
    const double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    const double *quadratures = state_quadratures(m, m->state);
    kept[KEPT_LENGTH] = kept[KEPT_USED] = 0;
    kept[KEPT_WANTED] = most;
    kept[KEPT_JUMPED] = m->state[SLOT_JUMPED];
    for (int i = 0; i < 3; i++) {
        kept[KEPT_QUADRATURES + i] = quadratures[i];
    }
    for (int i = 0; i < m->dof; i++) {
        kept[KEPT_ANGLES + i] = q[i];
        kept[KEPT_VELOCITIES + i] = w[i];
    }
}

// What the series of the stride that the state keeps start from.
static void prepare(const arm *a, motion *m)
{
    taylor_stride *s = m->memory;
    const double *kept = state_kept(m, m->state);
    const double *q = kept + KEPT_ANGLES, *w = kept + KEPT_VELOCITIES;
    put_inputs(a, m, q, w, wanted_stride(a, m, w, kept[KEPT_WANTED]), s->lane.block);
    s->lane.form = (taylor_form){.contact = m->state[SLOT_CONTACT] != 0,
                                 .point = a->wall.kind == WALL_POINT,
                                 .hub_spring = a->hub_spring,
                                 .damped = a->joint_damping > 0 || a->hub_joint_damping > 0};
}

// Whether the state's stride goes on: to the end of what remains, or, where it was not made for
// less than that, to its own.
static bool goes_on(motion *m, double remaining)
{
    const double *kept = state_kept(m, m->state);
    const double length = kept[KEPT_LENGTH], left = length - kept[KEPT_USED];
    return m->state[SLOT_JUMPED] == 0 && left > LEAST_LEFT * length &&
           (left >= remaining || length <= remaining);
}

// How long a new stride is to be at most: what remains, or twice the stride that has been used up
// since where nothing has changed but the instant to go to.
static double most_of_stride(motion *m, double remaining)
{
    const double *kept = state_kept(m, m->state);
    const double before = kept[KEPT_LENGTH], ahead = kept[KEPT_WANTED] - kept[KEPT_USED];
    const bool same = m->state[SLOT_JUMPED] == 0 && before > 0;
    return same && fabs(ahead - remaining) > LEAST_LEFT * remaining ? larger(2 * before, remaining)
                                                                    : remaining;
}

// Goes on in the state's stride, whose series may be to be computed again.
static void take_up(const arm *a, motion *m)
{
    taylor_stride *s = m->memory;
    double *kept = state_kept(m, m->state);
    const size_t start = KEPT_WANTED * sizeof *kept, size = sizeof s->kept - start;
    if (m->forgets || !s->own || memcmp(s->kept + KEPT_WANTED, kept + KEPT_WANTED, size) != 0) {
        prepare(a, m);
        taylor_compute_one(&s->lane);
        s->known = 0;
    }
    s->lane.group = NULL;
    s->lane.end = -1;
    s->lane.pieces = 0;
    s->own = true;
}

// The length of the stride whose series are computed: what they allow, but on a flat wall clear of
// the fold over the hub's axis. There the force has a pole that the velocities know nothing of:
// series of theirs go through it with small terms, while those of the force do not converge.
static double length_of_stride(const arm *a, const taylor_lane *lane)
{
    const double allowed = lane->block[AT_ALLOWED];
    if (!lane->form.contact || lane->form.point) {
        return allowed;
    }

    // how far the first link turns at most: in contact both stand as far from across the wall
    const double *q = taylor_term(lane, AT_ANGLE_1);
    const int spacing = taylor_spacing(lane);
    double turn = 0;
    for (int n = lane->form.order + 1; n > 0; n--) {
        turn = (turn + fabs(q[n * spacing])) * allowed;
    }

    // a share of the length takes no more than that share of the turn
    double sine, cosine;
    inline_sincos(*q, &sine, &cosine);
    const double left = fabs(cosine * a->wall.cosine + sine * a->wall.sine);
    return turn > LONGEST_TURN * left ? allowed * (LONGEST_TURN * left / turn) : allowed;
}

static double begin(const arm *a, motion *m, double remaining, double step)
{
    taylor_stride *s = m->memory;
    double *kept = state_kept(m, m->state);
    (void)step;
    if (!s->ready && goes_on(m, remaining)) {
        take_up(a, m);
    } else {
        if (!s->ready) {
            keep(m, most_of_stride(m, remaining));
            prepare(a, m);
            taylor_compute_one(&s->lane);
        }
        kept[KEPT_LENGTH] = length_of_stride(a, &s->lane);
        s->known = 0;

        // series of a group that are to be gone on with
        const double way = smaller(m->cut - m->state[SLOT_TIME], remaining);
        s->own = s->lane.group == NULL || kept[KEPT_LENGTH] > way;
        if (s->own && s->lane.group != NULL) {
            taylor_fetch(&s->lane);
        }
    }

    s->ready = false;
    m->forgets = false;
    memcpy(s->kept, kept, sizeof s->kept);
    s->used = kept[KEPT_USED];
    return smaller(kept[KEPT_LENGTH] - s->used, remaining);
}

// No stride is known yet.
static void open(const arm *a, motion *m)
{
    taylor_stride *s = m->memory;
    (void)a;
    s->ready = s->own = false;
}

taylor_lane *taylor_prepare(const arm *a, motion *m, double remaining)
{
    assert(a != NULL && m != NULL);
    taylor_stride *s = m->memory;
    if (m->engine != &taylor_engine || m->starved || motion_held_still(m) ||
        goes_on(m, remaining)) {
        return NULL;
    }
    keep(m, most_of_stride(m, remaining));
    prepare(a, m);
    s->ready = true;
    return &s->lane;
}

// What one of the instants comes to, into `state`; in contact the gap and its derivatives ought to
// be zero, and the second one is taken so.
static void take_instant(const arm *a, const motion *m, const taylor_instants *at, int i,
                         double *state)
{
    const taylor_stride *s = m->memory;
    const double *before = s->kept + KEPT_QUADRATURES;
    double *quadrature = state_quadratures(m, state);

    // where in the stride it is
    memcpy(state_kept(m, state), s->kept, sizeof s->kept);
    state_kept(m, state)[KEPT_USED] = at->time[i];

    // the motion
    for (int k = 0; k < m->dof; k++) {
        const int body = k + 1 - a->first;
        state_angles(m, state)[k] = at->angle[body][i];
        state_velocities(m, state)[k] = at->velocity[body][i];
        state_accelerations(m, state)[k] = at->acceleration[body][i];
        state_algorithmic(m, state)[k] = at->acceleration[body][i];
    }

    // what it has lost and pressed
    const double turn = state_velocities(m, state)[0];
    quadrature[QUADRATURE_VISCOUS] =
        before[QUADRATURE_VISCOUS] + a->motor.damping * at->hub_square[i];
    quadrature[QUADRATURE_DAMPING] = before[QUADRATURE_DAMPING];
    if (s->lane.form.damped) {
        quadrature[QUADRATURE_DAMPING] += at->dissipated[i];
        state[SLOT_DAMPING_POWER] = at->dissipation[i];
    }
    quadrature[QUADRATURE_FORCE] = before[QUADRATURE_FORCE];
    state[SLOT_VISCOUS_POWER] = a->motor.damping * turn * turn;

    // friction and wall
    const bool stuck = state[SLOT_FRICTION] == HUB_STICK;
    state[SLOT_FRICTION_TORQUE] = stuck ? at->hold[i] : -state[SLOT_FRICTION] * a->motor.stiction;
    if (s->lane.form.contact) {
        state[SLOT_FORCE] = at->force[i];
        quadrature[QUADRATURE_FORCE] += at->pressed[i];
    }
    if (wall_stands(&a->wall)) {
        state[SLOT_GAP] = at->gap[i];
        state[SLOT_GAP_VELOCITY] = at->gap_velocity[i];
        state[SLOT_GAP_ACCELERATION] = s->lane.form.contact ? 0 : at->gap_acceleration[i];
    }
}

static status state_at(const arm *a, motion *m, double h)
{
    taylor_stride *s = m->memory;
    taylor_instants one;
    const taylor_instants *at = &one;
    int place = 0;

    // evaluated with others', or here
    if (s->lane.end == h) {
        at = &s->lane.group->ends;
        place = s->lane.number;
    } else {
        one.time[0] = s->used + h;
        taylor_evaluate(&s->lane, 1, &one);
    }
    take_instant(a, m, at, place, m->trial);
    m->holds = (state_energy){at->kinetic[place], at->strain[place]};
    if (s->lane.form.contact && motion_project(a, m, m->trial)) {
        m->holds = unknown_energy;
    }
    return STATUS_OK;
}

static bool states_at(const arm *a, motion *m, double *start, const double *h, int count,
                      double *const *states, state_energy *energies)
{
    taylor_stride *s = m->memory;
    const int width = taylor_width();
    (void)start;
    for (int done = 0; done < count; done += width) {
        taylor_instants at;
        const int more = count - done < width ? count - done : width;
        for (int i = 0; i < more; i++) {
            at.time[i] = s->used + h[done + i];
        }
        taylor_evaluate(&s->lane, more, &at);
        for (int i = 0; i < more; i++) {
            double *state = states[done + i];
            take_instant(a, m, &at, i, state);
            energies[done + i] = (state_energy){at.kinetic[i], at.strain[i]};
            if (s->lane.form.contact && motion_project(a, m, state)) {
                energies[done + i] = motion_energy(a, m, state);
            }
        }
    }
    return true;
}

// --- what the contact machine asks --------------------------------------------------------------

static glance look(const arm *a, const motion *m, watch w, double h)
{
    const taylor_stride *s = m->memory;
    const polynomial *p = watched(a, m, w);
    const double t = s->used + h;
    glance near = t > 0 ? glance_at(p->terms, p->count, t) : (glance){p->terms[0], p->terms[1]};
    if (w != WATCH_STICTION) {
        return near;
    }
    glance far = glance_at(s->far_limit.terms, s->far_limit.count, t);
    return near.value < far.value ? near : far;
}

static double bend(const arm *a, const motion *m, watch w, double from, double to)
{
    taylor_stride *s = m->memory;
    const polynomial *p = watched(a, m, w);
    const double t = s->used + to;
    double near = bend_of(p, t);
    (void)from;
    if (w == WATCH_FORCE && p->divided) {
        // divided by the time: the force itself may bend more
        polynomial force;
        set_polynomial(&force, taylor_term(&s->lane, AT_FORCE), taylor_spacing(&s->lane),
                       s->lane.form.order, 1);
        return fmax(near, bend_of(&force, t));
    }
    return near; // that of both limits of stiction
}

static glance force_at(const arm *a, const motion *m, double h)
{
    taylor_stride *s = m->memory;
    (void)a;
    const int order = s->lane.form.order;
    const double *force = taylor_terms(&s->lane, AT_FORCE, order), t = s->used + h;
    return t > 0 ? glance_at(force, order, t) : (glance){force[0], force[1]};
}

static void forces_at(const arm *a, const motion *m, double h, int count, glance *at)
{
    const taylor_stride *s = m->memory;
    const double width = h / count;
    const taylor_lane *lane = &s->lane;

    // evaluated with others', which began their strides with the steps, or here
    if (lane->pieces == count && lane->end == h) {
        const taylor_pieces *pieces = &lane->group->pieces;
        at[0] = (glance){*taylor_term(lane, AT_FORCE), *taylor_term(lane, AT_FORCE + 1)};
        for (int i = 0; i < count; i++) {
            at[i + 1] = (glance){pieces->force[i][lane->number], pieces->slope[i][lane->number]};
        }
    } else {
        for (int i = 0; i <= count; i++) {
            at[i] = force_at(a, m, i * width);
        }
    }
}

static glance gap_at(const arm *a, const motion *m, double h)
{
    taylor_stride *s = m->memory;
    (void)a;
    const int count = s->lane.form.order + 2;
    return glance_at(taylor_terms(&s->lane, AT_GAP, count), count, s->used + h);
}

// Whether the watched function is off its edge from the start, and above zero all over the stride.
static bool clear_throughout(const motion *m, watch w)
{
    const taylor_stride *s = m->memory;
    const bool jumped = s->kept[KEPT_JUMPED] != 0, wall = w == WATCH_GAP || w == WATCH_FORCE;
    const double edge = w == WATCH_GAP ? EDGE_GAP : w == WATCH_HUB ? 0 : EDGE_VALUE;
    return s->lane.block[wall ? AT_WALL_LEAST : AT_HUB_LEAST] > (jumped ? edge : 0);
}

static void first_event(const arm *a, motion *m, double *h, watch *first, bool *any)
{
    // of most strides the bounds rule all events out
    const contact_state now = contact_state_of(m->state);
    const bool stuck = now.friction == HUB_STICK;
    const watch wall = now.contact ? WATCH_FORCE : WATCH_GAP;
    const watch hub = stuck ? WATCH_STICTION : WATCH_HUB;
    const bool wall_clear = clear_throughout(m, wall) || (!now.contact && !wall_stands(&a->wall));
    const bool hub_clear = clear_throughout(m, hub) || (!stuck && a->motor.stiction == 0);

    *first = WATCH_GAP;
    *any = false;
    if (!wall_clear || !hub_clear) {
        dense_search_event(a, m, h, first, any);
    }
}

static bool clear(const arm *a, motion *m, watch w, double h)
{
    const taylor_stride *s = m->memory;
    const double t = s->used + h;
    if (clear_throughout(m, w)) {
        return true;
    }
    if (s->kept[KEPT_JUMPED] == 0 && t >= s->kept[KEPT_LENGTH]) {
        return false; // the bounds of the whole stride leave it to be looked for
    }

    // what begins on the edge, or is not asked for as far as the stride goes
    const polynomial *p = watched(a, m, w);
    double low = low_of(p, t);
    return w == WATCH_STICTION ? fmin(low, low_of(&s->far_limit, t)) > 0 : low > 0;
}

static bool bounded(const arm *a, motion *m, double h, double most)
{
    const taylor_stride *s = m->memory;
    (void)a, (void)h;
    return s->lane.block[AT_FORCE_MOST] <= most;
}

const engine taylor_engine = {.name = "Taylor series",
                              .begin = begin,
                              .state_at = state_at,
                              .states_at = states_at,
                              .look = look,
                              .bend = bend,
                              .bends_from_start = true,
                              .clear = clear,
                              .bounded = bounded,
                              .force_at = force_at,
                              .forces_at = forces_at,
                              .gap_at = gap_at,
                              .first_event = first_event,
                              .peak = dense_search_peak,
                              .open = open,
                              .retorque = taylor_retorque,
                              .memory_size = sizeof(taylor_stride)};
