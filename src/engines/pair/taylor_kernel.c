// Series of the two-link arm's motion, for LANES arms at once (a power of two; vectors
// are those of the compiler), as LOOPS: src/engines/meson.build gives both, else one. The
// equations stand in taylor_order.h.
//
// Every operation is written out in its order (taylor_numbers.h), so all widths give the
// same bits.
#ifndef LOOPS
#define LANES 1
#define LOOPS taylor_loops_1
#endif

#include "src/engines/pair/taylor_instants.h"
#include "src/engines/pair/taylor_order.h"
#include "src/engines/pair/taylor_roots.h"

// The last terms of the velocities stay below this share of 1 rad/s or the largest
// velocity, and, where the series end before the highest order, those of the losses below
// this share of 1 J times its square; the first one left out is about ten times smaller.
#define LAST_TERMS 4e-12
// The lowest order at which the series may end: they end with the first even order from
// it on whose terms are small enough at the wanted length.
#define LEAST_ORDER 8
// A step that is too long for the highest order is shortened by this factor, at most so
// often.
#define SHORTENING       0.875
#define MOST_SHORTENINGS 200

// --- series ----------------------------------------------------------------------------

// Magnitudes of the coefficients of the last order but one (`before`) and of the last,
// and the power of the step's length h that the former is multiplied with at its end:
// h^(order - 1) for velocities, h^order for losses.
typedef struct last_terms {
    real before, last, power;
} last_terms;

// The lanes whose last two terms are larger than a limit at the end of a step of length
// h.
KERNEL mask too_large(last_terms x, real h, real limit)
{
    return ~MASK((x.last * h + x.before) * x.power <= limit);
}

// The longest step with small last terms, shortened from the length h that the terms x
// belong to. Series of the highest order are assumed, so that a step shortened by s has
// its power shortened by s^(TAYLOR_MOST - 1), which is computed by squaring.
KERNEL real allowed_step(real h, last_terms x, real limit)
{
    double shrinking = 1, factor = SHORTENING;
    for (int e = TAYLOR_MOST - 1; e > 0; e >>= 1) {
        if ((e & 1) != 0) {
            shrinking *= factor;
        }
        factor *= factor;
    }

    // all lanes continue until the last of them is short enough, only those that are too
    // long are cut
    for (int i = 0; i < MOST_SHORTENINGS; i++) {
        const mask bad = too_large(x, h, limit);
        if (!any(bad)) {
            break;
        }
        h = select_lanes(bad, SHORTENING * h, h);
        x.power = select_lanes(bad, shrinking * x.power, x.power);
    }
    return h;
}

// Sets the coefficients beyond an arm's own order to zero in its lane, if those of other
// lanes go further; open[i] has the lanes that go beyond the order 2 i.
KERNEL void cut_off(real *block, const mask *open, int order)
{
    for (int n = LEAST_ORDER + 1; n <= order; n++) {
        const mask own = open[(n - 1) / 2];
        for (int i = 0; i < 3; i++) {
            real *q = block + AT_ANGLE_0 + i * (TAYLOR_MOST + 2) + n + 1;
            real *w = block + AT_RATE_0 + i * (TAYLOR_MOST + 1) + n;
            *q = real_of(bits_of(*q) & own);
            *w = real_of(bits_of(*w) & own);
        }
        real *gap = block + AT_GAP + n + 1;
        *gap = real_of(bits_of(*gap) & own);
        for (int i = 0; i < 4; i++) {
            real *x = block + AT_FORCE + i * TAYLOR_MOST + n - 1;
            *x = real_of(bits_of(*x) & own);
        }
    }
}

// The n-th coefficient of the gap.
KERNEL real gap_term(const factors *x, ptrdiff_t n, real l, const int point)
{
    const real S2 = PART(DIRECTIONS(x, n), 3);
    if (point) {
        return l * PART(DIRECTIONS(x, n), 1) - S2;
    }
    return -(PART(DIRECTION1(x, n), 1) + S2);
}

// Bounds the event function of the wall over the step: the gap or, in contact, the force,
// as a series `wall` of `count` terms. Into the block go its least value, the greatest
// force and, where it may fall below zero, its first root.
KERNEL void bound_wall(real *block, const int contact, const real *wall, int count,
                       mask jumped)
{
    const real zero = (real){0}, one = zero + 1.0, h = block[AT_ALLOWED];
    const real value = zero + (contact ? EDGE_VALUE : EDGE_GAP);
    const enclosure near = enclosure_of(wall, count, h);
    const real lacking =
        contact ? zero : EDGE_RATE + LEFT_OUT * (block[AT_EDGE_RATE] - EDGE_RATE);
    const edge_limits edge = {value, zero + EDGE_RATE,
                              greater(lacking, zero + EDGE_MORE)};
    const real first = least_at_first(&near, wall, one, h, jumped, &edge);
    block[AT_WALL_LEAST] = least_of(&near, one, first);
    block[AT_FORCE_MOST] = highest(&near);
    block[AT_WALL_ROOT] = zero - 1.0;
    if (any(~MASK(block[AT_WALL_LEAST] > 0))) {
        const enclosed_function gone = {wall, count, &near, one, first, h, jumped};
        block[AT_WALL_ROOT] = first_root(&gone);
    }
}

// Bounds the event function of the hub over the step in the same way: its velocity in the
// direction in which it slides or, where it is stuck, what is left up to stiction.
KERNEL void bound_hub(real *block, const real *rates, const real *hold, int order,
                      mask stuck, mask jumped)
{
    const real zero = (real){0}, one = zero + 1.0, h = block[AT_ALLOWED];
    const real sense = select_lanes(MASK(block[AT_FRICTION] < 0), -one, one);
    const enclosure turning = enclosure_of(rates, order + 1, h);
    const edge_limits edge = {zero, block[AT_EDGE_RATE], zero + EDGE_MORE};
    const real first = least_at_first(&turning, rates, sense, h, jumped, &edge);
    real left = least_of(&turning, sense, first);

    // stuck lanes: stiction less the largest torque in either direction
    if (any(stuck)) {
        const enclosure torque = enclosure_of(hold, order, h);
        const real low = lowest(&torque, torque.start - torque.off);
        const real most = greater(highest(&torque), -low);
        const real spared = select_lanes(jumped, zero + EDGE_VALUE, zero);
        left = select_lanes(stuck, block[AT_STICTION] - most - spared, left);
    }

    // the root, of lanes that slide
    block[AT_HUB_LEAST] = left;
    block[AT_HUB_ROOT] = zero - 1.0;
    if (any(~stuck & ~MASK(left > 0))) {
        const enclosed_function gone = {rates, order + 1, &turning, sense,
                                        first, h,         jumped};
        block[AT_HUB_ROOT] = select_lanes(stuck, zero - 1.0, first_root(&gone));
    }
}

// The last terms of the velocities in series that end with the order n + 1.
KERNEL last_terms rate_terms(const real *block, ptrdiff_t n, real power,
                             const int hub_spring)
{
    const real *w0 = block + AT_RATE_0, *w1 = block + AT_RATE_1, *w2 = block + AT_RATE_2;
    last_terms x = {magnitude(w1[n]) + magnitude(w2[n]),
                    magnitude(w1[n + 1]) + magnitude(w2[n + 1]), power};
    if (hub_spring) {
        x.before += magnitude(w0[n]);
        x.last += magnitude(w0[n + 1]);
    }
    return x;
}

// The last terms of the losses (viscous and structural) in the same series.
KERNEL last_terms loss_terms(const real *block, const equations *e, ptrdiff_t n,
                             real power)
{
    const real *hub_square = block + AT_HUB_SQUARE, *dissipation = block + AT_DISSIPATION;
    last_terms x = {e->viscous * magnitude(hub_square[n - 1]),
                    e->viscous * magnitude(hub_square[n]), power};
    if (e->damped) {
        x.before += magnitude(dissipation[n - 1]);
        x.last += magnitude(dissipation[n]);
    }
    return x;
}

// The lanes whose series cannot end with the order n + 1, as their terms are too large at
// the wanted length. `limit` is that on terms of the velocities, which is proportional to
// the largest velocity, `scale`.
KERNEL mask needs_more_terms(const real *block, const equations *e, const factors *x,
                             ptrdiff_t n, real power, real limit, real scale,
                             const int contact, const int point, const int hub_spring)
{
    const real wanted = block[AT_WANTED], l = e->l, *hold = block + AT_HOLD;
    mask large = too_large(rate_terms(block, n, power, hub_spring), wanted, limit);
    if (any(~large)) {
        // what decays is lost twice as fast as it decays: the losses' series end later
        large |= too_large(loss_terms(block, e, n, power), wanted, limit * scale);
    }
    if (!contact && any(~large)) {
        // of the gap the coefficients so far, which are of one order less
        const last_terms swing = {magnitude(gap_term(x, n, l, point)) * (double)n,
                                  magnitude(gap_term(x, n + 1, l, point)) *
                                      (double)(n + 1),
                                  power};
        large |= too_large(swing, wanted, limit * wanted * l);
    }
    if (!hub_spring && e->sticks && any(~large)) {
        const last_terms held = {magnitude(hold[n - 1]) * inverse[n],
                                 magnitude(hold[n]) * inverse[n + 1], power};
        large |= e->stuck & too_large(held, wanted, limit * e->m11);
    }
    return large;
}

// Writes the series of the gap, which goes as far as that of the angles.
KERNEL void put_gap(real *block, const equations *e, factors *x, ptrdiff_t order,
                    sums *sum, const int point)
{
    add_directions(x, order, block[AT_RATE_1 + order], block[AT_RATE_2 + order], sum,
                   point);
    for (int n = 0; n <= order + 1; n++) {
        block[AT_GAP + n] = gap_term(x, n, e->l, point);
    }
}

// The last terms of all series of this order, each scaled so that the velocities' limit
// holds for their sum.
KERNEL last_terms all_last_terms(const real *block, const equations *e, ptrdiff_t order,
                                 real power, real scale, const int contact,
                                 const int hub_spring)
{
    last_terms tail = rate_terms(block, order - 1, power, hub_spring);

    // the gap's rate: of large swings its series is longer than those of the velocities
    if (!contact) {
        const real *gap = block + AT_GAP, per_length = 1 / e->l;
        tail.last += magnitude(gap[order + 1]) * (double)(order + 1) * per_length;
        tail.before += magnitude(gap[order]) * (double)order * per_length;
    }

    // the torque that holds a stuck hub
    if (!hub_spring && e->sticks) {
        const real *hold = block + AT_HOLD;
        const real per_inertia = select_lanes(e->stuck, 1 / e->m11, (real){0});
        tail.last += magnitude(hold[order - 1]) * inverse[order] * per_inertia;
        tail.before += magnitude(hold[order - 2]) * inverse[order - 1] * per_inertia;
    }

    // the losses
    const real per_scale = 1 / scale;
    const last_terms lost = loss_terms(block, e, order - 1, power);
    tail.before += lost.before * per_scale;
    tail.last += lost.last * per_scale;
    return tail;
}

// The equations of a step, from the block's inputs.
KERNEL equations equations_of(const real *block, const int hub_spring, bool damped)
{
    const real zero = (real){0}, mass = block[AT_MASS], l = block[AT_LENGTH];
    const mask stuck = MASK(block[AT_FRICTION] == 0);
    equations e = {.l = l,
                   .k = block[AT_STIFFNESS],
                   .kd = block[AT_DAMPING],
                   .kh = block[AT_HUB_STIFFNESS],
                   .khd = block[AT_HUB_DAMPING],
                   .viscous = block[AT_VISCOUS],
                   .m22 = block[AT_INERTIA] + mass * l * l / 4,
                   .m12 = mass * l * l / 2,
                   .drive = block[AT_TORQUE] - block[AT_FRICTION] * block[AT_STICTION],
                   .stuck = stuck,
                   .sticks = any(stuck),
                   .damped = damped};
    e.m11 = e.m22 + mass * l * l + (hub_spring ? zero : block[AT_HUB_INERTIA]);
    e.inverse_hub =
        hub_spring ? select_lanes(stuck, zero, 1 / block[AT_HUB_INERTIA]) : zero;
    return e;
}

// Computes the series of a step for all lanes, as LAST_TERMS asks, and the length and
// bounds that follow from them, into the block. Returns their order.
KERNEL int series(real *block, const int contact, const int point, const int hub_spring,
                  bool damped)
{
    // the start
    const real zero = (real){0};
    equations e = equations_of(block, hub_spring, damped);
    factors x;
    real hub_rate[TAYLOR_MOST + 1]; // of the hub spring
#if LANES > 1
    x.w1 = block + AT_RATE_1;
    x.w2 = block + AT_RATE_2;
    x.hub = block + (hub_spring ? AT_RATE_0 : AT_RATE_1);
    x.f = block + AT_FORCE;
#endif
    put_start(block, &e, &x, point, hub_spring);
    invert_start(&e, &x, contact, point, hub_spring);

    // order by order, until the terms are small enough in every lane
    const real *w1 = block + AT_RATE_1, *w2 = block + AT_RATE_2;
    const real wanted = block[AT_WANTED];
    const real scale = greater(greater(magnitude(w1[0]), magnitude(w2[0])), zero + 1.0);
    const real limit = LAST_TERMS * scale;
    real power = zero + 1.0; // wanted^n
    mask open[TAYLOR_MOST / 2 + 1];
    ptrdiff_t order = TAYLOR_MOST;
    newest last = {zero, w1[0], w2[0], no_sums};
    for (ptrdiff_t n = 0; n < order; n++) {
        add_order(block, &e, &x, hub_rate, n, &last, contact, point, hub_spring);
        if (n > 0) {
            power *= wanted;
        }

        // every other order: whether some lane needs more
        if (n % 2 == 1 && n + 1 >= LEAST_ORDER && n + 1 < TAYLOR_MOST) {
            const mask large = needs_more_terms(block, &e, &x, n, power, limit, scale,
                                                contact, point, hub_spring);
            const mask before = n + 1 > LEAST_ORDER ? open[(n - 1) / 2] : ~(mask){0};
            open[(n + 1) / 2] = before & large;
            if (!any(open[(n + 1) / 2])) {
                order = n + 1;
            }
        }
    }

    // angles and gap have one order more
    for (int i = hub_spring ? 0 : 1; i < 3; i++) {
        const real rate = block[AT_RATE_0 + i * (TAYLOR_MOST + 1) + order];
        block[AT_ANGLE_0 + i * (TAYLOR_MOST + 2) + order + 1] = rate * inverse[order + 1];
    }
    if (!contact) {
        put_gap(block, &e, &x, order, &last.sum, point);
    }

    // the step is shortened in the lanes in which no order was enough
    last_terms tail = all_last_terms(block, &e, order, power, scale, contact, hub_spring);
    const mask ended = order < TAYLOR_MOST ? ~(mask){0} : ~open[TAYLOR_MOST / 2 - 1];
    tail.last = select_lanes(ended, zero, tail.last);
    tail.before = select_lanes(ended, zero, tail.before);
    const real h = allowed_step(wanted, tail, limit);
    if (LANES > 1 && order > LEAST_ORDER && any(~open[order / 2 - 1])) {
        cut_off(block, open, (int)order);
    }
    block[AT_ALLOWED] = h;

    // bounds and roots of the event functions of wall and hub
    const mask jumped = MASK(block[AT_EDGE_RATE] >= 0);
    if (contact) {
        bound_wall(block, contact, block + AT_FORCE, (int)order, jumped);
    } else {
        bound_wall(block, contact, block + AT_GAP, (int)order + 2, jumped);
    }
    const real *hub_rates = w1;
    if (hub_spring) {
        hub_rates = block + AT_RATE_0;
    }
    bound_hub(block, hub_rates, block + AT_HOLD, (int)order, e.stuck, jumped);
    return (int)order;
}

// --- entries ---------------------------------------------------------------------------

// The series against a point wall or a plane one; constants as arguments give each form
// loops of its own.
KERNEL int series_of_wall(real *block, taylor_form f, const int contact,
                          const int hub_spring)
{
    if (f.point) {
        return series(block, contact, 1, hub_spring, f.damped);
    }
    return series(block, contact, 0, hub_spring, f.damped);
}

// Computes the series of a block by the loops of its form.
static int compute_series(double *block, taylor_form f)
{
    real *lanes = (real *)block;
    if (f.hub_spring && f.contact) {
        return series_of_wall(lanes, f, 1, 1);
    }
    if (f.hub_spring) {
        return series_of_wall(lanes, f, 0, 1);
    }
    if (f.contact) {
        return series_of_wall(lanes, f, 1, 0);
    }
    return series_of_wall(lanes, f, 0, 0);
}

#if LANES > 1
// Copies the inputs of LANES blocks of single arms into the lanes of one block.
static void gather(double *block, const double *const *own)
{
    // by whole vectors: a load would wait for earlier stores of parts of its vector
    for (int place = 0; place < AT_INPUTS; place++) {
        real x = (real){0};
        for (int i = 0; i < LANES; i++) {
            x[i] = own[i][place];
        }
        ((real *)block)[place] = x;
    }
}

const taylor_loops LOOPS = {compute_series, instants, values, gather, ends, pieces};
#else
const taylor_loops LOOPS = {compute_series, instants, values, NULL, NULL, NULL};
#endif
