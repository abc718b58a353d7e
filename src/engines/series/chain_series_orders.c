#include "src/engines/series/chain_series.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "src/engines/by_width.h"
#include "src/engines/series/chain_series_parts.h"
#include "src/engines/pair/taylor_lanes.h"

#define TURNING     1.2   // rotation counts so many times
#define LEAST_RATE  0.1   // that counts as the largest velocity [rad/s]
#define LAST_TERMS  1e-13 // of the velocities, as a share of the largest one
#define SHORTENING  0.92  // of a stride that is too long for that
#define FORCE_TERMS 1e-9  // last terms of the contact force, as a share of its first ones
#define LEAST_FORCE 1e-6  // that counts as a force [N]
#define SMALL_TERM  1e-14 // of the first term that is left out, where the order may be lower

enum { LEAST_ORDER = 8, MOST_SHORTENINGS = 400, CACHE_LINE = 64 };

// --- storage ------------------------------------------------------------------------------------

enum { ROWS_OF_TERMS = 11, SINGLE_ROWS = 65 };

static int blocks_of(const arm *a)
{
    return (a->links + SERIES_LANES - 1) / SERIES_LANES;
}

size_t chain_series_size(const arm *a)
{
    const size_t row = (size_t)blocks_of(a) * SERIES_LANES;
    return sizeof(chain_series) + CACHE_LINE +
           (ROWS_OF_TERMS * SERIES_TERMS + SINGLE_ROWS) * row * sizeof(double);
}

void chain_series_place(chain_series *s, const arm *a)
{
    const size_t row = (size_t)blocks_of(a) * SERIES_LANES;
    const uintptr_t behind = (uintptr_t)(s + 1) + CACHE_LINE - 1;
    double *storage = (double *)(behind - behind % CACHE_LINE);
    chain_rows *r = &s->rows;
    memset(s, 0, chain_series_size(a));
    s->links = a->links;
    r->blocks = blocks_of(a);
    s->first_place = chain_place(r, 0);
    s->last_place = chain_place(r, a->links - 1);

    // by coefficient and link
    double **const terms[ROWS_OF_TERMS] = {&r->angle,       &r->rate,  &r->cosine,    &r->sine,
                                           &r->gx,          &r->gy,    &r->bend_rate, &r->bend,
                                           &r->bend_square, &r->air_x, &r->air_y};
    for (int i = 0; i < ROWS_OF_TERMS; i++) {
        *terms[i] = storage;
        storage += SERIES_TERMS * row;
    }

    // by link
    double **const rows[] = {
        &r->start_c, &r->start_s,     &r->length,  &r->half,         &r->stiffness, &r->damping,
        &r->air,     &r->air_turning, &r->torque,  &r->ux,           &r->uy,        &r->inv_d,
        &r->vx,      &r->vy,          &r->pxx,     &r->pxy,          &r->pyy,       &r->back_x,
        &r->back_y,  &r->rho_xx,      &r->rho_xy,  &r->rho_yy,       &r->unit,      &r->unit_fx,
        &r->unit_fy, &r->known_c,     &r->known_s, &r->moment,       &r->rho_x,     &r->rho_y,
        &r->add_x,   &r->add_y,       &r->free,    &r->acceleration, &r->qx,        &r->qy,
        &r->base_x,  &r->base_y,      &s->unit_x,  &s->unit_y};
    enum { ROWS = sizeof rows / sizeof rows[0] };
    _Static_assert(ROWS + 16 + 3 * (SERIES_TOGETHER - 1) == SINGLE_ROWS, "rows by link");
    for (int i = 0; i < ROWS; i++) {
        *rows[i] = storage;
        storage += row;
    }
    for (int i = 0; i < 4; i++) {
        r->matrix[i] = storage;
        r->inwards[i] = storage + row;
        r->outwards[i] = storage + 2 * row;
        r->whole[i] = storage + 3 * row;
        storage += 4 * row;
    }
    for (int i = 0; i < SERIES_TOGETHER - 1; i++) {
        r->next_c[i] = storage;
        r->next_s[i] = storage + row;
        r->next_moment[i] = storage + 2 * row;
        storage += 3 * row;
    }
}

// --- the stride's start -------------------------------------------------------------------------

double chain_series_rate(const arm *a, const double *q, const double *w)
{
    double turning = 0, last = 0;
    for (int i = 0; i < a->dof; i++) {
        const double own = fabs(w[i]), bending = fabs(w[i] - last);
        turning = own > turning ? own : turning;
        turning = bending > turning ? bending : turning;
        last = w[i];
    }
    const double vibrating = a->highest_frequency * chain_stiffened(a, q);
    const double rate = fmax(fmax(vibrating, a->fastest_decay), TURNING * turning);
    return fmax(rate, 1e-3);
}

// The lowest even order of which the first term left out is small for what turns by `turn`.
static int order_for(double turn)
{
    double term = 1;
    int order = 0;
    while (order < SERIES_MOST && (order < LEAST_ORDER || order % 2 != 0 || term > SMALL_TERM)) {
        order++;
        term *= turn / (order + 1);
    }
    return order;
}

// --- one order after the other ------------------------------------------------------------------

// Torque of the hub on the first link, whose joint has one beyond its linear one, and, where it is
// a body of its own, on itself into *hub.
static double root_torque(chain_series *s, const arm *a, int n, double beyond, double *hub)
{
    const double t = s->length, rate = s->rows.rate[chain_term(n, s->first_place)];
    double drive = 0;
    if (n == 0) {
        const double friction = s->pinned ? 0 : s->mode.friction * a->motor.stiction;
        drive = t * t * (a->motor.torque - friction);
    }
    if (a->motor.electric) {
        drive += chain_series_drive_torque(s, a, n);
    }
    if (!a->hub_spring) {
        return drive - t * a->motor.damping * rate;
    }
    const double angle = s->rows.angle[chain_term(n, s->first_place)];
    const double turn = rate - s->hub_rate.term[n];
    const double spring = t * t * arm_joint_stiffness(a, 0) * (angle - s->hub_angle.term[n]) +
                          t * arm_joint_damping(a, 0) * turn + beyond;
    s->root_rate.term[n] = turn;
    *hub = drive + spring - t * a->motor.damping * s->hub_rate.term[n];
    return -spring;
}

// F at the tip: what its mass demands, and the push of a plane.
static void force_at_tip(chain_series *s, const arm *a, chain_order *o)
{
    chain_rows *r = &s->rows;
    const size_t end = s->last_place;
    if (a->tip_mass > 0) {
        const double turn = r->acceleration[end], l = r->length[end], f = o->force;
        const double x = r->base_x[end] + f * s->unit_x[end],
                     y = r->base_y[end] + f * s->unit_y[end];
        o->tip_x = a->tip_mass * (x + r->vx[end] * turn + l * r->rho_x[end]);
        o->tip_y = a->tip_mass * (y + r->vy[end] * turn + l * r->rho_y[end]);
    }
    if (s->mode.contact && a->wall.kind == WALL_PLANE) {
        o->tip_x -= o->force * a->wall.sine;
        o->tip_y += o->force * a->wall.cosine;
    }
    if (s->links < r->blocks * SERIES_LANES) {
        const size_t beyond = chain_place(r, s->links);
        r->qx[beyond] = o->tip_x;
        r->qy[beyond] = o->tip_y;
    }
}

// F at the hub, where the first link's base rests; push: as chain_series_earlier_force has it, for
// the only link of an arm.
static void force_at_hub(chain_series *s, const arm *a, const chain_order *o, const double push[2])
{
    chain_rows *r = &s->rows;
    const size_t first = s->first_place, second = chain_place(r, 1);
    const double turn = r->acceleration[first], l = r->length[first];
    const double half = arm_link_mass(a, 0) / 2;
    r->qx[first] = r->qx[second] + half * (r->vx[first] * turn + l * r->rho_x[first]);
    r->qy[first] = r->qy[second] + half * (r->vy[first] * turn + l * r->rho_y[first]);
    if (a->air_drag > 0) {
        r->qx[first] += r->air[first] * r->air_x[chain_term(o->n, first)];
        r->qy[first] += r->air[first] * r->air_y[chain_term(o->n, first)];
    }
    if (s->links == 1 && s->mode.contact && a->wall.kind == WALL_POINT) {
        r->qx[first] += push[0] - o->force * r->start_s[first];
        r->qy[first] += push[1] + o->force * r->start_c[first];
    }
}

// The n-th coefficients of accelerations and forces, and what follows of the next ones.
static void next_order(chain_series *s, const arm *a, const chain_loops *loops, int n)
{
    chain_rows *r = &s->rows;
    const bool contact = s->mode.contact, point = contact && a->wall.kind == WALL_POINT;
    const size_t first = s->first_place, end = s->last_place;
    double hub = 0, push[2] = {0};
    chain_order o = {.n = n};

    // what is known
    loops->products(r, &o);
    loops->bends(r, &o);
    o.root = root_torque(s, a, n, chain_series_load_joints(s, a, n), &hub);
    const double on_first = r->torque[first] + o.root - r->moment[first];
    if (a->air_drag > 0) {
        chain_series_drag(s, n);
    }
    if (contact && s->gives) {
        chain_series_gap_term(s, a, n + 1);
    } else if (point) {
        chain_series_reach_point(s, a, n + 1);
    }
    if (point) {
        r->moment[end] += chain_series_earlier_force(s, n, push);
    }
    loops->prepare(r, &o);
    r->add_x[end] += push[0];
    r->add_y[end] += push[1];
    if (a->air_drag > 0) {
        chain_series_add_drag(s, n);
    }

    // the sweeps, and the force
    loops->sweep(r);
    if (contact) {
        o.force = s->force.term[n] = chain_series_force_term(s, a, n);
    }
    loops->finish(r, &o);

    force_at_tip(s, a, &o);
    force_at_hub(s, a, &o, push);
    loops->hand(r, &o);

    // the hub
    if (a->hub_spring) {
        s->hold.term[n] = -hub;
        s->hub_rate.term[n + 1] =
            s->mode.friction == HUB_STICK ? 0 : hub / a->hub_inertia / (n + 1);
        s->hub_angle.term[n + 2] = s->hub_rate.term[n + 1] / (n + 2);
    } else {
        const size_t now = chain_term(n, first);
        s->hold.term[n] =
            r->start_c[first] * r->gy[now] - r->start_s[first] * r->gx[now] - on_first;
        if (point && s->links == 1) { // the point is beyond the middle, where G has its force
            s->hold.term[n] += (s->along.term[0] - r->half[first]) * s->force.term[n];
        }
    }
}

// --- a stride ------------------------------------------------------------------------------------

// x^n.
static double power(double x, int n)
{
    double result = 1;
    for (; n > 0; n /= 2) {
        result *= n % 2 != 0 ? x : 1;
        x *= x;
    }
    return result;
}

// Whether the last terms of the contact force are small at a share of the stride. On a flat wall
// the force has a pole where the arm is folded over the hub's axis, which does not show in the
// velocities: their terms would be small even beyond it.
static bool force_converges(const chain_series *s, double share)
{
    const double *f = s->force.term;
    if (!s->mode.contact) {
        return true;
    }
    double first = fmax(fabs(f[0]), share * fmax(fabs(f[1]), share * fabs(f[2])));
    if (s->graded) { // next to what would stop the arm the force is small there
        first = fmax(first, fabs(s->gap.term[1] / s->response));
    }
    const double last = fabs(f[s->order - 2]) + share * fabs(f[s->order - 1]);
    const double least = LEAST_FORCE * s->length * s->length;
    return power(share, s->order - 2) * last <= FORCE_TERMS * fmax(first, least);
}

// How far the last terms are small, as a share of the stride; 0 if they are not finite. In free
// flight those of the gap's rate over the arm's length count, too, and in air those of the links'
// velocities: of a link that gathers speed the rate is a short polynomial, the gap the sine of one.
static double small_terms(const chain_series *s, const arm *a)
{
    const chain_rows *r = &s->rows;
    double largest = LEAST_RATE * s->length, last = 0, before = 0, sum = 0;
    const int order = s->order;
    for (int i = 0; i < r->blocks * SERIES_LANES; i++) {
        const size_t at = (size_t)i;
        const double now = fabs(r->rate[chain_term(0, at)]);
        const double high = fabs(r->rate[chain_term(order - 1, at)]);
        const double highest = fabs(r->rate[chain_term(order, at)]);
        largest = now > largest ? now : largest;
        before = high > before ? high : before;
        last = highest > last ? highest : last;
        sum += highest;
    }
    if (!s->mode.contact && wall_stands(&a->wall)) {
        const double *gap = s->gap.term, reach = a->links * a->link_length;
        before = fmax(before, order * fabs(gap[order]) / reach);
        last = fmax(last, (order + 1) * fabs(gap[order + 1]) / reach);
        sum += last;
    }
    if (a->air_drag > 0) {
        for (int k = 0; k < s->links; k++) {
            const size_t at = chain_term(order - 1, chain_place(r, k));
            const double speed = fmax(fabs(r->air_x[at]), fabs(r->air_y[at]));
            before = fmax(before, speed / a->link_length);
            sum += speed;
        }
    }
    if (!isfinite(sum)) {
        return 0;
    }
    double share = 1;
    for (int i = 0; i < MOST_SHORTENINGS; i++) {
        const double high = power(share, order - 1);
        if (high * (before + share * last) <= LAST_TERMS * largest && force_converges(s, share)) {
            break;
        }
        share *= SHORTENING;
    }
    return share;
}

void chain_series_compute(chain_series *s, const arm *a, const double *q, const double *w,
                          double length)
{
    assert(s != NULL && a != NULL && q != NULL && w != NULL && length > 0);
    assert(a->links == s->links);
    const chain_loops *loops = BY_WIDTH(&chain_loops_, taylor_width());
    chain_rows *r = &s->rows;
    const size_t size = (size_t)(r->blocks * SERIES_LANES) * sizeof(double);
    s->pinned = s->mode.contact && !s->gives && a->dof == 1;
    s->length = length;
    s->order = order_for(s->turning * length);
    if (s->graded && s->order < s->graded_order) {
        s->order = s->graded_order;
    }
    s->damped = a->joint_damping > 0 || a->hub_joint_damping > 0;

    // what all orders share
    chain_series_take_state(s, a, q, w);
    chain_series_prepare_sweep(s, a);
    loops->join(r);
    if (s->mode.contact) {
        chain_series_gap_term(s, a, 0);
        chain_series_prepare_contact(s, a);
    } else {
        memset(r->unit, 0, size);
        memset(r->unit_fx, 0, size);
        memset(r->unit_fy, 0, size);
    }

    // order by order
    for (int n = 0; n < s->order; n++) {
        next_order(s, a, loops, n);
    }
    if (s->mode.contact && s->gives) {
        chain_series_gap_term(s, a, s->order + 1);
    } else if (!s->mode.contact && wall_stands(&a->wall)) {
        for (int n = 0; n <= s->order + 1; n++) {
            chain_series_gap_term(s, a, n);
        }
    }
    chain_series_sum_losses(s, a);
    if (a->motor.electric) {
        chain_series_sum_drive(s, a);
    }
    s->allowed = length * small_terms(s, a);
}

double chain_series_first_rate(const chain_series *s, int n)
{
    return s->rows.rate[chain_term(n, s->first_place)];
}

void chain_series_state(const chain_series *s, const arm *a, double t, double *q, double *w)
{
    const chain_rows *r = &s->rows;
    const double x = t / s->length;
    double *angle = q + a->first, *rate = w + a->first;

    // Horner's rule, a block of links at once
    for (int b = 0; b < r->blocks; b++) {
        const size_t begin = chain_term(0, (size_t)b * SERIES_LANES);
        const double *terms = r->angle + begin, *rates = r->rate + begin;
        double value[SERIES_LANES], slope[SERIES_LANES] = {0};
        memcpy(value, terms + (s->order + 1) * SERIES_LANES, sizeof value);
        for (int n = s->order; n >= 0; n--) {
            for (int j = 0; j < SERIES_LANES; j++) {
                value[j] = value[j] * x + terms[n * SERIES_LANES + j];
                slope[j] = slope[j] * x + rates[n * SERIES_LANES + j];
            }
        }
        for (int j = 0; j < SERIES_LANES; j++) {
            const int k = j * r->blocks + b;
            if (k < s->links) {
                angle[k] = value[j];
                rate[k] = slope[j] / s->length;
            }
        }
    }

    // the hub
    if (a->hub_spring) {
        double value = s->hub_angle.term[s->order + 1], slope = 0;
        for (int n = s->order; n >= 0; n--) {
            value = value * x + s->hub_angle.term[n];
            slope = slope * x + s->hub_rate.term[n];
        }
        q[0] = value;
        w[0] = slope / s->length;
    }
    if (s->mode.friction == HUB_STICK || s->pinned) {
        w[0] = 0;
    }
}
