// The two-link arm by power series (taylor_kernel.h): a dense engine.
//
// The stride goes as far as the fastest mode and the rotation let a series of the highest order
// reach, and is shortened until its last terms are small; where something else ends it sooner a
// lower order does. Everything within it (events, rows, peaks, quadratures) is a polynomial.
#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "src/base/sincos.h"
#include "src/solve/motion.h"
#include "src/solve/taylor_engine.h"

// Strides stay below this over the fastest rate and the angular velocities.
#define LONGEST_REACH 1.2
// A decay over a stride: the series of the highest order is stable on the negative axis beyond 7.
#define LONGEST_DECAY 4.0

// What is nothing but rounding in the first coefficients of a watched function at its edge: of the
// value and of its derivatives, over which nothing is known but that they are small.
#define EDGE_VALUE 1e-9
#define EDGE_RATE  1e-9
#define EDGE_MORE  1e-7
#define EDGE_GAP   1e-12 // [m]
// As deep in the wall an arm that leaves it may be by the truncation of the series that led there.
#define EDGE_DEPTH 1e-6 // [m]
// Angles beyond it are reduced as one number only [rad].
#define MOST_TURNED 9e4

enum { MOST_TERMS = TAYLOR_MOST + 2, ANGLES = 3 };

typedef struct polynomial {
    double terms[MOST_TERMS]; // zeros behind the last one
    int count;                // of terms, even
    bool divided;             // by a power of the time
} polynomial;

typedef struct taylor_stride {
    double block[TAYLOR_PLACES];
    taylor_form form;
    polynomial watched[WATCH_STICTION + 1]; // those of the contact state; stiction: nearer limit
    polynomial far_limit;                   // of stiction
    double force_most, force_until;         // the force's bound, for times up to the second [N, s]
    bool ready;                             // the series of the next stride were computed apart
} taylor_stride;

bool taylor_engine_suits(const arm *a)
{
    const bool wall =
        a->wall.kind == WALL_NONE || a->wall.kind == WALL_POINT || a->wall.kind == WALL_PLANE;
    const bool gives = wall_stands(&a->wall) && wall_gives(&a->wall);
    return a->links == 2 && wall && !gives && arm_is_plain(a);
}

// --- polynomials --------------------------------------------------------------------------------
//
// With u = t^2 a polynomial is E(u) + t O(u), its even and its odd terms, which Horner's rule takes
// side by side. So the number of terms is even, the last one zero if need be.

typedef double pair __attribute__((vector_size(16)));

typedef int64_t pair_bits __attribute__((vector_size(16)));

static inline pair magnitudes(pair x)
{
    pair_bits bits;
    memcpy(&bits, &x, sizeof bits);
    bits &= INT64_MAX;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline pair terms_at(const double *terms, int n)
{
    pair p;
    memcpy(&p, terms + n, sizeof p);
    return p;
}

static inline double value_at(const double *terms, int count, double t)
{
    const double u = t * t;
    pair value = terms_at(terms, count - 2);
    for (int n = count - 4; n >= 0; n -= 2) {
        value = value * u + terms_at(terms, n);
    }
    return value[0] + t * value[1];
}

// p' = O + 2 t (E' + t O'), the dashes on the right by u.
static inline glance glance_at(const double *terms, int count, double t)
{
    const double u = t * t;
    pair value = terms_at(terms, count - 2), slope = {0, 0};
    for (int n = count - 4; n >= 0; n -= 2) {
        slope = slope * u + value;
        value = value * u + terms_at(terms, n);
    }
    return (glance){value[0] + t * value[1], value[1] + 2 * t * (slope[0] + t * slope[1])};
}

// Value, first and second derivative, p'' = 2 E' + 6 t O' + 4 u (E'' + t O'').
static inline void derivatives_at(const double *terms, int count, double t, double result[3])
{
    const double u = t * t;
    pair value = terms_at(terms, count - 2), slope = {0, 0}, half = {0, 0};
    for (int n = count - 4; n >= 0; n -= 2) {
        half = half * u + slope;
        slope = slope * u + value;
        value = value * u + terms_at(terms, n);
    }
    result[0] = value[0] + t * value[1];
    result[1] = value[1] + 2 * t * (slope[0] + t * slope[1]);
    result[2] = 2 * slope[0] + 6 * t * slope[1] + 8 * u * (half[0] + t * half[1]);
}

// 1/1, 1/2, ...
static const double share[TAYLOR_MOST] = {1,       1. / 2,  1. / 3,  1. / 4,  1. / 5,  1. / 6,
                                          1. / 7,  1. / 8,  1. / 9,  1. / 10, 1. / 11, 1. / 12,
                                          1. / 13, 1. / 14, 1. / 15, 1. / 16, 1. / 17, 1. / 18,
                                          1. / 19, 1. / 20, 1. / 21, 1. / 22, 1. / 23, 1. / 24};

// Integral from 0 to t.
static inline double integral_to(const double *terms, int count, double t)
{
    const double u = t * t;
    pair value = terms_at(terms, count - 2) * terms_at(share, count - 2);
    for (int n = count - 4; n >= 0; n -= 2) {
        value = value * u + terms_at(terms, n) * terms_at(share, n);
    }
    return t * (value[0] + t * value[1]);
}

// n (n - 1)
static const double falling[MOST_TERMS] = {0,   0,   2,   6,   12,  20,  30,  42,  56,
                                           72,  90,  110, 132, 156, 182, 210, 240, 272,
                                           306, 342, 380, 420, 462, 506, 552, 600};

// The largest second derivative for times from 0 to t, from the magnitudes of the terms.
static double bend_of(const polynomial *p, double t)
{
    const double u = t * t;
    pair bound = {0, 0};
    for (int n = p->count - 2; n >= 2; n -= 2) {
        bound = bound * u + magnitudes(terms_at(p->terms, n)) * terms_at(falling, n);
    }
    return bound[0] + t * bound[1];
}

typedef struct range {
    double low, high;
} range;

// Between what the function stays for times from 0 to t: its straight part takes its extremes at
// the ends, what bends it adds a little more than the sum of its terms' magnitudes at most.
static range range_of(const double *terms, int count, double t)
{
    const double u = t * t;
    pair sum = {0, 0};
    for (int n = count - 2; n >= 2; n -= 2) {
        sum = sum * u + magnitudes(terms_at(terms, n));
    }
    sum *= u;
    const double bends =
        (sum[0] + t * sum[1] + fabs(terms[0]) + fabs(terms[1]) * t) * 1e-12 + (sum[0] + t * sum[1]);
    const double straight = terms[0] + t * terms[1];
    return straight < terms[0] ? (range){straight - bends, terms[0] + bends}
                               : (range){terms[0] - bends, straight + bends};
}

// Divides the function by the time as often as its first coefficients are nothing but rounding,
// below the limits.
static void leave_edge(polynomial *p, const double limits[3])
{
    int edge = 0;
    while (edge < 3 && fabs(p->terms[edge]) <= limits[edge]) {
        edge++;
    }

    // falling to its edge rather than from it, it is left as it is: its root is what matters; nor
    // is a rate or an acceleration rounding that speaks against falling at once
    if (edge > 0 && p->terms[edge] < 0) {
        edge = p->terms[0] > 0 ? 0 : p->terms[edge - 1] > 0 ? edge - 1 : edge;
    }

    if (edge > 0) {
        memmove(p->terms, p->terms + edge, (size_t)(p->count - edge) * sizeof(double));
        memset(p->terms + p->count - edge, 0, (size_t)edge * sizeof(double));
        p->divided = true;
    }
}

// --- a stride -----------------------------------------------------------------------------------

static void put_inputs(const arm *a, motion *m, double wanted, double *block)
{
    const double l = a->link_length, mass = a->link_mass;
    const double own = a->link_inertia + mass * l * l / 4;
    const contact_state now = contact_state_of(m->state);
    const double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    const bool point = a->wall.kind == WALL_POINT;

    // the arm, its motor and its wall
    block[AT_M11] = own + mass * l * l + (a->hub_spring ? 0 : a->hub_inertia);
    block[AT_M22] = own;
    block[AT_M12] = mass * l * l / 2;
    block[AT_STIFFNESS] = a->joint_stiffness;
    block[AT_DAMPING] = a->joint_damping;
    block[AT_LENGTH] = l;
    block[AT_REACH_X] = point ? a->wall.x : l * a->wall.cosine;
    block[AT_REACH_Y] = point ? a->wall.y : l * a->wall.sine;
    block[AT_DRIVE] = a->motor.torque - now.friction * a->motor.stiction;
    block[AT_VISCOUS] = a->motor.damping;
    block[AT_HUB_STIFFNESS] = a->hub_stiffness;
    block[AT_HUB_DAMPING] = a->hub_joint_damping;
    block[AT_HUB_INERTIA] = a->hub_inertia;
    block[AT_STUCK] = now.friction == HUB_STICK;

    // the state
    block[AT_START_ANGLE] = q[0];
    block[AT_START_ANGLE + 1] = q[a->first];
    block[AT_START_ANGLE + 2] = q[a->first + 1];
    block[AT_START_VELOCITY] = w[0];
    block[AT_START_VELOCITY + 1] = w[a->first];
    block[AT_START_VELOCITY + 2] = w[a->first + 1];
    block[AT_WANTED] = wanted;
}

// The length that is tried, and the order that is enough for it.
static double wanted_stride(const arm *a, const motion *m, double remaining, int *order)
{
    // how far a series of each order reaches with small last terms, in units of the fastest rate
    static const struct {
        int order;
        double reach;
    } orders[] = {{8, 0.04},  {10, 0.1},  {12, 0.2},  {14, 0.33},
                  {16, 0.48}, {18, 0.66}, {20, 0.88}, {22, 1.1}};
    enum { ORDERS = sizeof orders / sizeof orders[0] };

    // as far as the fastest mode, the rotation and the fastest decay let the highest order reach
    const double *w = state_velocities(m, m->state);
    double rate = a->highest_frequency > 1e-3 ? a->highest_frequency : 1e-3;
    for (int i = 0; i < m->dof; i++) {
        rate = rate < 1.2 * fabs(w[i]) ? 1.2 * fabs(w[i]) : rate;
    }
    const double turning = 1.2 * fabs(w[a->first + 1] - w[a->first]); // the bend turns, too
    rate = rate < turning ? turning : rate;
    double wanted = LONGEST_REACH / rate;
    wanted = remaining < wanted ? remaining : wanted;
    if (a->fastest_decay * wanted > LONGEST_DECAY) {
        wanted = LONGEST_DECAY / a->fastest_decay;
    }

    // and the lowest order that reaches so far
    *order = TAYLOR_MOST;
    for (int i = ORDERS - 1; i >= 0; i--) {
        *order = wanted * rate <= orders[i].reach ? orders[i].order : *order;
    }
    return wanted;
}

static void set_polynomial(polynomial *p, const double *terms, int count, double factor)
{
    p->count = count + count % 2;
    p->divided = false;
    p->terms[p->count - 1] = 0;
    for (int n = 0; n < count; n++) {
        p->terms[n] = factor * terms[n];
    }
}

// The functions that say when this contact state ends.
static void prepare_watched(const arm *a, const motion *m, taylor_stride *s)
{
    const int order = s->form.order;
    const bool jumped = m->state[SLOT_JUMPED] != 0;
    bool wall_at_edge = jumped;
    const contact_state now = contact_state_of(m->state);
    const double stiction = a->motor.stiction;

    // the wall
    if (now.contact) {
        set_polynomial(&s->watched[WATCH_FORCE], s->block + AT_FORCE, order, 1);
    } else {
        polynomial *distance = &s->watched[WATCH_GAP];
        set_polynomial(distance, s->block + AT_GAP, order + 2, 1);
        if (distance->terms[0] < 0 && distance->terms[0] > -EDGE_DEPTH && distance->terms[1] > 0) {
            distance->terms[0] = 0;
            wall_at_edge = true;
        }
    }

    // the hub
    if (now.friction != HUB_STICK) {
        const double *rate = s->block + (a->hub_spring ? AT_RATE_0 : AT_RATE_1);
        set_polynomial(&s->watched[WATCH_HUB], rate, order + 1, now.friction);
    } else {
        const double sign = s->block[AT_HOLD] < 0 ? -1 : 1;
        set_polynomial(&s->watched[WATCH_STICTION], s->block + AT_HOLD, order, -sign);
        set_polynomial(&s->far_limit, s->block + AT_HOLD, order, sign);
        s->watched[WATCH_STICTION].terms[0] += stiction;
        s->far_limit.terms[0] += stiction;
    }

    // just after an event they may begin at zero, as the gap does after a bounce cut short
    const double acceleration = EDGE_RATE * (wall_at_edge || jumped ? motion_rounding(a, m) : 0);
    const double reaction[] = {EDGE_VALUE, EDGE_RATE, EDGE_MORE};
    const double gap[] = {EDGE_GAP, EDGE_RATE, fmax(EDGE_MORE, acceleration)};
    const double hub_rate[] = {0, acceleration, EDGE_MORE};
    if (wall_at_edge) {
        leave_edge(&s->watched[now.contact ? WATCH_FORCE : WATCH_GAP],
                   now.contact ? reaction : gap);
    }
    if (jumped) {
        const bool stuck = now.friction == HUB_STICK;
        if (!stuck) {
            leave_edge(&s->watched[WATCH_HUB], hub_rate);
        } else if (fabs(s->watched[WATCH_STICTION].terms[0]) <= EDGE_VALUE) {
            s->watched[WATCH_STICTION].terms[0] = EDGE_VALUE; // what holds it may hold as much more
        }
    }
}

static void prepare(const arm *a, motion *m, double remaining)
{
    taylor_stride *s = m->memory;
    int order;
    double wanted = wanted_stride(a, m, remaining, &order);
    put_inputs(a, m, wanted, s->block);
    s->form = (taylor_form){.contact = m->state[SLOT_CONTACT] != 0,
                            .point = a->wall.kind == WALL_POINT,
                            .hub_spring = a->hub_spring,
                            .damped = a->joint_damping > 0 || a->hub_joint_damping > 0,
                            .order = order};
}

static double begin(const arm *a, motion *m, double remaining, double step)
{
    taylor_stride *s = m->memory;
    (void)step;
    if (!s->ready) {
        prepare(a, m, remaining);
        taylor_compute_one(s->block, s->form);
    }
    s->ready = false;
    s->force_until = -1;
    prepare_watched(a, m, s);
    return s->block[AT_ALLOWED];
}

bool taylor_prepare(const arm *a, motion *m, double remaining, taylor_request *request)
{
    assert(a != NULL && m != NULL && request != NULL);
    taylor_stride *s = m->memory;
    if (m->engine != &taylor_engine || motion_held_still(m)) {
        return false;
    }
    prepare(a, m, remaining);
    s->ready = true;
    *request = (taylor_request){.form = s->form, .block = s->block};
    return true;
}

// Gap, velocity and acceleration of it from angles, velocities and accelerations; in contact all
// three ought to be zero, and the last one is taken so.
static void measure_gap(const arm *a, const motion *m, double *state)
{
    const double *q = state_angles(m, state) + a->first, *w = state_velocities(m, state) + a->first;
    const double l = a->link_length;

    // where the tip is, and how it moves
    double s1, c1, s2, c2;
    inline_sincos(q[0], &s1, &c1);
    inline_sincos(q[1], &s2, &c2);
    const double vx = -l * s1 * w[0], vy = l * c1 * w[0];
    wall_contact at = wall_contact_at(&a->wall, l, l * c1, l * s1, vx, vy, c2, s2, w[1]);

    state[SLOT_GAP] = -at.penetration;
    const double lever = wall_last_lever(&at, l, c2, s2);
    state[SLOT_GAP_VELOCITY] = -wall_penetration_rate(&at, vx, vy, lever, w[1]);

    // what follows from the accelerations
    if (state[SLOT_CONTACT] != 0) {
        state[SLOT_GAP_ACCELERATION] = 0;
        return;
    }
    const double *al = state_accelerations(m, state) + a->first;
    const double ax = -l * (s1 * al[0] + c1 * w[0] * w[0]);
    const double ay = l * (c1 * al[0] - s1 * w[0] * w[0]);
    state[SLOT_GAP_ACCELERATION] = -(at.ex * ax + at.ey * ay + lever * al[1] + at.convective);
}

static status state_at(const arm *a, motion *m, double h)
{
    const taylor_stride *s = m->memory;
    const int order = s->form.order;
    const double *block = s->block, *before = state_quadratures(m, m->state);
    double *state = m->trial, *quadrature = state_quadratures(m, state);
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    double *acceleration = state_accelerations(m, state);

    // the motion
    for (int i = 0; i < m->dof; i++) {
        double d[3];
        derivatives_at(block + AT_ANGLE_0 + (i + 1 - a->first) * MOST_TERMS, order + 2, h, d);
        q[i] = d[0];
        w[i] = d[1];
        acceleration[i] = state_algorithmic(m, state)[i] = d[2];
    }
    if (state[SLOT_FRICTION] == HUB_STICK) {
        w[0] = acceleration[0] = 0;
    }

    // what it has lost and pressed
    quadrature[QUADRATURE_VISCOUS] =
        before[QUADRATURE_VISCOUS] +
        a->motor.damping * integral_to(block + AT_HUB_SQUARE, order, h);
    quadrature[QUADRATURE_DAMPING] = before[QUADRATURE_DAMPING];
    if (s->form.damped) {
        quadrature[QUADRATURE_DAMPING] += integral_to(block + AT_DISSIPATION, order, h);
        state[SLOT_DAMPING_POWER] = value_at(block + AT_DISSIPATION, order, h);
    }
    quadrature[QUADRATURE_FORCE] = before[QUADRATURE_FORCE];
    state[SLOT_VISCOUS_POWER] = a->motor.damping * w[0] * w[0];

    // friction and wall
    state[SLOT_FRICTION_TORQUE] = state[SLOT_FRICTION] == HUB_STICK
                                      ? value_at(block + AT_HOLD, order, h)
                                      : -state[SLOT_FRICTION] * a->motor.stiction;
    if (s->form.contact) {
        state[SLOT_FORCE] = value_at(block + AT_FORCE, order, h);
        quadrature[QUADRATURE_FORCE] += integral_to(block + AT_FORCE, order, h);
        measure_gap(a, m, state);
        motion_project(a, m, state);
    } else if (wall_stands(&a->wall)) {
        measure_gap(a, m, state);
    }
    return STATUS_OK;
}

static void take_instant(const arm *a, const motion *m, double *start, const taylor_instants *at,
                         int i, double *state)
{
    const taylor_stride *s = m->memory;
    const double *before = state_quadratures(m, start);
    double *quadrature = state_quadratures(m, state);

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
    if (s->form.damped) {
        quadrature[QUADRATURE_DAMPING] += at->dissipated[i];
        state[SLOT_DAMPING_POWER] = at->dissipation[i];
    }
    quadrature[QUADRATURE_FORCE] = before[QUADRATURE_FORCE];
    state[SLOT_VISCOUS_POWER] = a->motor.damping * turn * turn;

    // friction and wall
    const bool stuck = state[SLOT_FRICTION] == HUB_STICK;
    state[SLOT_FRICTION_TORQUE] = stuck ? at->hold[i] : -state[SLOT_FRICTION] * a->motor.stiction;
    if (s->form.contact) {
        state[SLOT_FORCE] = at->force[i];
        quadrature[QUADRATURE_FORCE] += at->pressed[i];
    }
    if (wall_stands(&a->wall)) {
        state[SLOT_GAP] = at->gap[i];
        state[SLOT_GAP_VELOCITY] = at->gap_velocity[i];
        state[SLOT_GAP_ACCELERATION] = s->form.contact ? 0 : at->gap_acceleration[i];
    }
}

static bool states_at(const arm *a, motion *m, double *start, const double *h, int count,
                      double *const *states, state_energy *energies)
{
    const taylor_stride *s = m->memory;
    const int width = taylor_width();
    for (int i = 0; i < m->dof; i++) {
        if (!(fabs(state_angles(m, start)[i]) < MOST_TURNED)) {
            return false;
        }
    }

    for (int done = 0; done < count; done += width) {
        taylor_instants at;
        const int more = count - done < width ? count - done : width;
        memcpy(at.time, h + done, (size_t)more * sizeof *h);
        taylor_evaluate(a, s->block, s->form, more, &at);
        for (int i = 0; i < more; i++) {
            double *state = states[done + i];
            take_instant(a, m, start, &at, i, state);
            energies[done + i] = (state_energy){at.kinetic[i], at.strain[i]};
            if (s->form.contact && motion_project(a, m, state)) {
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
    const polynomial *p = &s->watched[w];
    (void)a;
    glance near = h > 0 ? glance_at(p->terms, p->count, h) : (glance){p->terms[0], p->terms[1]};
    if (w != WATCH_STICTION) {
        return near;
    }
    glance far = glance_at(s->far_limit.terms, s->far_limit.count, h);
    return near.value < far.value ? near : far;
}

static double bend(const arm *a, const motion *m, watch w, double from, double to)
{
    const taylor_stride *s = m->memory;
    (void)a, (void)from;
    double near = bend_of(&s->watched[w], to);
    if (w == WATCH_FORCE && s->watched[w].divided) {
        // divided by the time: the force itself may bend more
        polynomial force;
        set_polynomial(&force, s->block + AT_FORCE, s->form.order, 1);
        return fmax(near, bend_of(&force, to));
    }
    return w == WATCH_STICTION ? fmax(near, bend_of(&s->far_limit, to)) : near;
}

static glance force_at(const arm *a, const motion *m, double h)
{
    const taylor_stride *s = m->memory;
    (void)a;
    const double *force = s->block + AT_FORCE;
    return h > 0 ? glance_at(force, s->form.order, h) : (glance){force[0], force[1]};
}

static bool clear(const arm *a, motion *m, watch w, double h)
{
    taylor_stride *s = m->memory;
    const polynomial *p = &s->watched[w];
    range within = range_of(p->terms, p->count, h);
    (void)a;
    if (w == WATCH_FORCE && !p->divided) {
        s->force_most = within.high;
        s->force_until = h;
    } else if (w == WATCH_STICTION) {
        const range far = range_of(s->far_limit.terms, s->far_limit.count, h);
        within.low = far.low < within.low ? far.low : within.low;
    }
    return within.low > 0;
}

static bool bounded(const arm *a, motion *m, double h, double most)
{
    const taylor_stride *s = m->memory;
    (void)a;
    return h <= s->force_until && s->force_most <= most;
}

const engine taylor_engine = {.name = "Taylor series",
                              .begin = begin,
                              .state_at = state_at,
                              .states_at = states_at,
                              .look = look,
                              .bend = bend,
                              .clear = clear,
                              .bounded = bounded,
                              .force_at = force_at,
                              .memory_size = sizeof(taylor_stride)};
