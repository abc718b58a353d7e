// A chain of links by power series (chain_series.h): a dense engine, exact to rounding. The
// two-link arm has its own (taylor_kernel.h), which is the same mathematics written out.
#include <math.h>
#include <string.h>

#include "src/engines/series/chain_series.h"
#include "src/contact/edge_limits.h"
#include "src/contact/locate.h"
#include "src/contact/motion.h"

// Share of a limit of the current below which its margin counts as rounding (edge_limits.h).
#define EDGE_CURRENT 1e-10

// A function over a stride as a polynomial in x = t/L, the share of the stride's length.
typedef struct series_function {
    double term[SERIES_TERMS];
    int count;
    bool divided; // by a power of x
} series_function;

typedef struct series_stride {
    series_function watched[WATCHES]; // those of the contact state; stiction, current: nearer limit
    series_function far_limit, far_current; // the other ones
    series_function force;                  // never divided
    bool force_apart;                       // what is watched of the force is not the force itself
    double force_most, force_until; // the force's bound, for times up to the second [N], [s]
    chain_series *series;
} series_stride;

// --- polynomials --------------------------------------------------------------------------------

static glance terms_at(const double *term, int count, double x)
{
    double value = 0, slope = 0;
    for (int n = count - 1; n >= 0; n--) {
        slope = slope * x + value;
        value = value * x + term[n];
    }
    return (glance){value, slope};
}

static glance glance_at(const series_function *p, double x)
{
    return terms_at(p->term, p->count, x);
}

// The largest second derivative for shares from 0 to x, from the magnitudes of the terms.
static double bend_of(const series_function *p, double x)
{
    double bound = 0;
    for (int n = p->count - 1; n >= 2; n--) {
        bound = bound * x + fabs(p->term[n]) * (n * (n - 1));
    }
    return bound;
}

// How far at most the function goes from its first term for shares from 0 to x.
static double spread_of(const series_function *p, double x)
{
    double sum = 0;
    for (int n = p->count - 1; n >= 1; n--) {
        sum = (sum + fabs(p->term[n])) * x;
    }
    return sum * (1 + 1e-12);
}

static double integral_to(const double *term, int count, double x)
{
    double sum = 0;
    for (int n = count - 1; n >= 0; n--) {
        sum = sum * x + term[n] / (n + 1);
    }
    return sum * x;
}

static void set_function(series_function *p, const double *term, int count, double factor)
{
    p->count = count;
    p->divided = false;
    for (int n = 0; n < count; n++) {
        p->term[n] = factor * term[n];
    }
}

// Divides the function by the time once for each of its first coefficients that is only rounding.
static void leave_edge(series_function *p, const double limits[3], double length)
{
    const int powers = edge_powers(p->term, limits, length);
    if (powers > 0) {
        memmove(p->term, p->term + powers, (size_t)(p->count - powers) * sizeof(double));
        p->count -= powers;
        p->divided = true;
    }
}

// --- a stride -----------------------------------------------------------------------------------

static size_t memory_for(const arm *a)
{
    return sizeof(series_stride) + chain_series_size(a);
}

static void open(const arm *a, motion *m)
{
    series_stride *s = m->memory;
    memset(s, 0, sizeof *s);
    s->series = (chain_series *)(s + 1);
    chain_series_place(s->series, a);
}

// Of an arm in contact with a wall that gives: its depth, and of Hunt and Crossley's law, for the
// force itself, the factor k + c v of the power, which is analytic.
static void prepare_within(series_stride *s, const arm *a)
{
    const chain_series *c = s->series;
    series_function *law = &s->watched[WATCH_FORCE];
    set_function(&s->watched[WATCH_GAP], c->gap.term, c->order + 2, -1);
    if (a->wall.law == WALL_KELVIN_VOIGT) {
        return;
    }
    law->count = c->order + 1;
    for (int n = 0; n < law->count; n++) {
        const double rate = -(n + 1) * c->gap.term[n + 1] / c->length;
        law->term[n] = a->wall.damping * rate + (n == 0 ? a->wall.stiffness : 0);
    }
}

// The functions that say when this contact state ends. face_lacks: as chain_series_add_face has it.
static void prepare_watched(series_stride *s, const arm *a, const motion *m, double face_lacks)
{
    const chain_series *c = s->series;
    const int order = c->order;
    const bool jumped = m->state[SLOT_JUMPED] != 0;
    bool wall_at_edge = jumped;
    const contact_state now = contact_state_of(m->state);
    const double stiction = a->motor.stiction, per = 1 / c->length;

    // the wall
    series_function *distance = &s->watched[WATCH_GAP];
    set_function(&s->force, c->force.term, now.contact ? order : 1, per * per);
    s->watched[WATCH_FORCE] = s->force;
    if (m->wall_gives && now.contact) {
        prepare_within(s, a);
    } else if (!now.contact) {
        set_function(distance, c->gap.term, order + 2, 1);
        if (distance->term[0] < 0 && distance->term[0] > -EDGE_DEPTH && distance->term[1] > 0) {
            distance->term[0] = 0;
            wall_at_edge = true;
        }
    }

    // the hub
    if (now.friction != HUB_STICK) {
        double rate[SERIES_TERMS];
        for (int n = 0; n <= order; n++) {
            rate[n] = a->hub_spring ? c->hub_rate.term[n] : chain_series_first_rate(c, n);
        }
        set_function(&s->watched[WATCH_HUB], rate, order + 1, per * now.friction);
    } else {
        const double sign = c->hold.term[0] < 0 ? -1 : 1;
        set_function(&s->watched[WATCH_STICTION], c->hold.term, order, -sign * per * per);
        set_function(&s->far_limit, c->hold.term, order, sign * per * per);
        s->watched[WATCH_STICTION].term[0] += stiction;
        s->far_limit.term[0] += stiction;
    }

    // the current: on either side of a limit it begins there
    if (a->motor.electric && a->motor.current_limit < HUGE_VAL) {
        const motor_model *motor = &a->motor;
        const double rounding = EDGE_CURRENT * motor->current_limit;
        const double rate = motor->inductance > 0 ? motor->resistance / motor->inductance : 0;
        const double edge[] = {rounding, rounding * rate, 0};
        set_function(&s->watched[WATCH_CURRENT], c->to_limit.term, order, 1);
        set_function(&s->far_current, c->to_far_limit.term, order, 1);
        leave_edge(&s->watched[WATCH_CURRENT], edge, c->length);
    }

    // just after an event they may begin at zero, as the gap does after a bounce cut short
    const double place = m->wall_gives ? EDGE_GAP : m->wall_has_face ? EDGE_PLACE : 0;
    const double stiffness = a->wall.stiffness * place;
    const double reaction[] = {EDGE_VALUE + stiffness, EDGE_RATE + stiffness, EDGE_MORE};
    if (wall_at_edge && now.contact) {
        leave_edge(&s->watched[WATCH_FORCE], reaction, c->length);
    }
    s->force_apart = s->watched[WATCH_FORCE].divided || !now.contact ||
                     (m->wall_gives && a->wall.law == WALL_HUNT_CROSSLEY);
    if (wall_at_edge && (!now.contact || m->wall_gives)) {
        double gap[3];
        motion_gap_edges(a, m, gap);
        gap[1] += 2 * face_lacks;
        leave_edge(distance, gap, c->length);
    }
    if (jumped && now.friction != HUB_STICK) {
        const double hub_rate[] = {0, EDGE_RATE * motion_rounding(a, m), EDGE_MORE};
        leave_edge(&s->watched[WATCH_HUB], hub_rate, c->length);
    } else if (jumped && fabs(s->watched[WATCH_STICTION].term[0]) <= EDGE_VALUE) {
        s->watched[WATCH_STICTION].term[0] = EDGE_VALUE; // what holds it may hold as much more
    }
}

static double begin(const arm *a, motion *m, double remaining, double step)
{
    series_stride *s = m->memory;
    (void)step;
    const double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    chain_series *c = s->series;
    c->mode = contact_state_of(m->state);
    c->gives = m->wall_gives || m->wall_has_face;
    if (a->motor.electric) {
        c->mode.current = state_quadratures(m, m->state)[QUADRATURE_CURRENT];
        chain_series_choose_drive(c, a, c->mode.current, w[0], state_accelerations(m, m->state)[0]);
    }

    // as far as the arm's rates and the wall's allow
    const double own = chain_series_rate(a, q, w);
    wall_approach approach = {.own_rate = own,
                              .wall_rate = motion_wall_rate(a, m, m->state),
                              .depth = fmax(-m->state[SLOT_GAP], 0),
                              .speed = -m->state[SLOT_GAP_VELOCITY],
                              .acceleration = -m->state[SLOT_GAP_ACCELERATION]};
    if (m->wall_gives && c->mode.contact && a->wall.law == WALL_HUNT_CROSSLEY) {
        approach.compliance = motion_wall_compliance(a, m, m->state);
    }
    const bool swings = state_face_swings(m->state);
    double reach = chain_series_wall_reach(c, a, &approach);
    if (swings) {
        reach = fmin(reach, wall_face_lasts(&a->wall, state_face(m->state)));
    }
    const double length = fmin(remaining, reach);
    chain_series_compute(c, a, q, w, length);
    double face_lacks = 0;
    if (swings) {
        face_lacks = chain_series_add_face(c, a, state_face(m->state));
    }
    s->force_until = -1;

    // in a stride that is not finite nothing is searched: the state at its end reports it
    if (!(s->series->allowed > 0)) {
        static const double one = 1;
        for (int i = WATCH_GAP; i < WATCHES; i++) {
            set_function(&s->watched[i], &one, 1, 1);
        }
        set_function(&s->far_limit, &one, 1, 1);
        set_function(&s->far_current, &one, 1, 1);
        set_function(&s->force, &one, 1, 1);
        return length;
    }
    prepare_watched(s, a, m, face_lacks);
    return s->series->allowed;
}

static status state_at(const arm *a, motion *m, double h)
{
    const series_stride *s = m->memory;
    const chain_series *c = s->series;
    const double x = h / c->length, per = 1 / c->length;
    const double *before = state_quadratures(m, m->state);
    double *state = m->trial, *after = state_quadratures(m, state);
    chain_series_state(c, a, h, state_angles(m, state), state_velocities(m, state));

    // what it has lost and pressed
    after[QUADRATURE_VISCOUS] =
        before[QUADRATURE_VISCOUS] +
        per * a->motor.damping * integral_to(c->hub_square.term, c->square_terms, x);
    after[QUADRATURE_DAMPING] = before[QUADRATURE_DAMPING];
    if (c->damped || a->damped_modes > 0 || a->air_drag > 0) {
        after[QUADRATURE_DAMPING] += per * integral_to(c->dissipation.term, c->square_terms, x);
    }
    if (a->motor.electric) {
        const double most = a->motor.current_limit;
        const double current = terms_at(c->current.term, c->order, x).value;
        after[QUADRATURE_MOTOR] =
            before[QUADRATURE_MOTOR] + integral_to(c->motor_work.term, c->square_terms, x);
        after[QUADRATURE_CURRENT] =
            a->motor.inductance > 0 ? fmax(-most, fmin(current, most)) : before[QUADRATURE_CURRENT];
    }
    after[QUADRATURE_FORCE] = before[QUADRATURE_FORCE];
    if (c->mode.contact) {
        after[QUADRATURE_FORCE] += per * integral_to(c->force.term, c->order, x);
    }

    // what follows from the state
    motion_evaluate(a, m, state);
    if (c->mode.contact && !c->gives) {
        motion_project(a, m, state);
    }
    if (c->mode.contact && c->gives) {
        after[QUADRATURE_WALL] = before[QUADRATURE_WALL] +
                                 per * per * integral_to(c->wall_loss.term, c->square_terms, x);
    }
    memcpy(state_algorithmic(m, state), state_accelerations(m, state),
           (size_t)m->dof * sizeof(double));
    return STATUS_OK;
}

// --- what the contact machine asks --------------------------------------------------------------

static glance look(const arm *a, const motion *m, watch w, double h)
{
    const series_stride *s = m->memory;
    (void)a;
    const double x = h / s->series->length;
    glance near = glance_at(&s->watched[w], x);
    if (w >= WATCH_STICTION) {
        const glance far = glance_at(w == WATCH_CURRENT ? &s->far_current : &s->far_limit, x);
        near = near.value < far.value ? near : far;
    }
    return (glance){near.value, near.slope / s->series->length};
}

static double bend(const arm *a, const motion *m, watch w, double from, double to)
{
    const series_stride *s = m->memory;
    (void)a, (void)from;
    const double length = s->series->length, x = to / length;
    double bend = bend_of(&s->watched[w], x);
    if (w == WATCH_FORCE && s->force_apart) {
        bend = fmax(bend, bend_of(&s->force, x)); // the force itself may bend more
    } else if (w >= WATCH_STICTION) {
        bend = fmax(bend, bend_of(w == WATCH_CURRENT ? &s->far_current : &s->far_limit, x));
    }
    return bend / (length * length);
}

// Whether the current stays clear of the limit that it is farther from.
static bool far_is_clear(const series_stride *s, double h)
{
    return s->far_current.term[0] > spread_of(&s->far_current, h / s->series->length);
}

static bool clear(const arm *a, motion *m, watch w, double h)
{
    series_stride *s = m->memory;
    (void)a;
    // of two limits the nearer one, as far as the other
    const series_function *p = &s->watched[w];
    const double spread = spread_of(p, h / s->series->length);
    if (w == WATCH_FORCE && !s->force_apart) {
        s->force_most = p->term[0] + spread;
        s->force_until = h;
    }
    const bool far = w == WATCH_CURRENT && p->divided; // else it is as far as that
    return p->term[0] > spread && (!far || far_is_clear(s, h));
}

static bool bounded(const arm *a, motion *m, double h, double most)
{
    const series_stride *s = m->memory;
    (void)a;
    return h <= s->force_until && s->force_most <= most;
}

static glance force_at(const arm *a, const motion *m, double h)
{
    const series_stride *s = m->memory;
    (void)a;
    const glance g = glance_at(&s->force, h / s->series->length);
    return (glance){g.value, g.slope / s->series->length};
}

static glance gap_at(const arm *a, const motion *m, double h)
{
    const series_stride *s = m->memory;
    const chain_series *c = s->series;
    if (!wall_stands(&a->wall)) {
        return (glance){HUGE_VAL, 0};
    }
    const glance g = terms_at(c->gap.term, c->order + 2, h / c->length);
    return (glance){g.value, g.slope / c->length};
}

const engine series_engine = {.name = "series",
                              .begin = begin,
                              .state_at = state_at,
                              .look = look,
                              .bend = bend,
                              .clear = clear,
                              .bounded = bounded,
                              .force_at = force_at,
                              .gap_at = gap_at,
                              .memory_for = memory_for,
                              .open = open};
