// Series of the two-link arm's motion, for LANES arms at once (a power of two, given by whoever
// includes this; vectors are those of the compiler).
//
// Let d = q2 - q1 be the bend, s and c its sine and cosine, and S, C those of an angle from the
// wall times a length. The equations of chain.h for two links are those of the momenta
//
//     p1 = m11 w1 + m12 c w2,     p1' = drive - kv w1 + pull - J1 f
//     p2 = m12 c w1 + m22 w2,     p2' =               - pull - J2 f
//     pull = m12 s w1 w2 + k d + kd d'
//
// with a hub on a spring taking drive and kv away from p1' into I1 w0' = drive - kv w0 - hub
// spring. In contact f keeps the gap's derivative, gap' = -(J1 w1 + J2 w2), at zero:
//
//     point: gap = l s - S2,      J1 = l c,  J2 = C2 - l c,  gap' = l c d' - C2 w2
//     plane: gap = -(S1 + S2),    J1 = C1,   J2 = C2,        gap' = -(C1 w1 + C2 w2)
//
// Put x = sum x_n t^n. Sums and springs go by coefficient, products are Cauchy's,
// (x y)_n = sum x_j y_(n-j), and sine and cosine of an angle with the velocity v follow from
// s' = v c, c' = -v s:
//
//     n s_n = (v c)_(n-1),     n c_n = -(v s)_(n-1)
//
// which are the products that gap' is made of, and p2's as c w1 = c w2 - c d'. Of the n-th
// coefficient of p1', p2' and the (n+1)-th of gap' all is known but w1_(n+1), w2_(n+1) and f_n,
// which the matrix of the stride's start, inverted once, gives; q_(n+1) = w_n/(n + 1) follows.
//
// Every operation is written out in its order (taylor_numbers.h), so all widths give the same bits.
#include "src/engines/pair/taylor_enclosure.h"
#include "src/engines/pair/taylor_numbers.h"
#include "src/engines/pair/taylor_products.h"
#include "src/engines/pair/taylor_roots.h"
#include "src/engines/pair/taylor_series.h"

#ifndef SERIES
#define SERIES GLUE(taylor_series_, LANES)
#endif
#define INPUTS GLUE(taylor_inputs_, LANES)

// The last terms of the velocities stay below this share of 1 rad/s or the largest velocity, and,
// where the series end before the highest order, those of the losses below this share of 1 J times
// its square; the first one left out is about ten times smaller.
#define LAST_TERMS 4e-12
// The lowest order at which the series may end: they end with the first even order from it on whose
// terms are small enough at the wanted length.
#define LEAST_ORDER 8
// A stride that is too long for the highest order is shortened by this factor, at most so often.
#define SHORTENING       0.875
#define MOST_SHORTENINGS 200

// --- series -----------------------------------------------------------------------------------

// Magnitudes of the coefficients of the two last orders, and what those of the earlier one are
// multiplied with at the end of a stride of a length h: of velocities h^(order - 1), of losses h
// times that.
typedef struct last_terms {
    real before, last, power;
} last_terms;

KERNEL mask too_large(last_terms x, real h, real limit)
{
    return ~MASK((x.last * h + x.before) * x.power <= limit);
}

// The longest stride, up to the one of length h that x is of, whose last terms are small; of the
// highest order.
KERNEL real allowed_stride(real h, last_terms x, real limit)
{
    double shrinking = 1, factor = SHORTENING;
    for (int e = TAYLOR_MOST - 1; e > 0; e >>= 1) {
        shrinking = e & 1 ? shrinking * factor : shrinking;
        factor *= factor;
    }

    // all lanes go on until the last of them is short enough, only those that are too long are cut
    for (int i = 0; i < MOST_SHORTENINGS; i++) {
        const mask bad = too_large(x, h, limit);
        if (!any(bad)) {
            break;
        }
        h = choose(bad, SHORTENING * h, h);
        x.power = choose(bad, shrinking * x.power, x.power);
    }
    return h;
}

// Takes what lies beyond an arm's own order out of its lane, where others have gone further;
// open[i]: the lanes that go beyond the order 2 i.
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
    return point ? l * PART(DIRECTIONS(x, n), 1) - S2 : -(PART(DIRECTION1(x, n), 1) + S2);
}

// What a stride leaves of the function that the wall has watched, and where it ends in between:
// `count` terms of the gap, or in contact of the force.
KERNEL void bound_wall(real *block, const int contact, const real *wall, int count, mask jumped)
{
    const real zero = (real){0}, one = zero + 1.0, h = block[AT_ALLOWED];
    const real value = zero + (contact ? EDGE_VALUE : EDGE_GAP);
    const course near = enclosure_of(wall, count, h);
    const real lacking = contact ? zero : EDGE_RATE + LEFT_OUT * (block[AT_EDGE_RATE] - EDGE_RATE);
    const edge_limits edge = {value, zero + EDGE_RATE, greater(lacking, zero + EDGE_MORE)};
    const real first = least_at_first(&near, wall, one, h, jumped, &edge);
    block[AT_WALL_LEAST] = least_of(&near, one, first);
    block[AT_FORCE_MOST] = highest(&near);
    block[AT_WALL_ROOT] = zero - 1.0;
    if (any(~MASK(block[AT_WALL_LEAST] > 0))) {
        const enclosed_function gone = {wall, count, &near, one, first, h, jumped};
        block[AT_WALL_ROOT] = first_root(&gone);
    }
}

// The same of the hub: of its velocity, or where it is stuck of what holds it.
KERNEL void bound_hub(real *block, const real *rates, const real *hold, int order, mask stuck,
                      mask jumped)
{
    const real zero = (real){0}, one = zero + 1.0, h = block[AT_ALLOWED];
    const real sense = choose(MASK(block[AT_FRICTION] < 0), -one, one);
    const course turning = enclosure_of(rates, order + 1, h);
    const edge_limits edge = {zero, block[AT_EDGE_RATE], zero + EDGE_MORE};
    const real first = least_at_first(&turning, rates, sense, h, jumped, &edge);
    real left = least_of(&turning, sense, first);
    if (any(stuck)) {
        const course torque = enclosure_of(hold, order, h);
        const real low = lowest(&torque, torque.start - torque.off);
        const real most = greater(highest(&torque), -low);
        const real spared = choose(jumped, zero + EDGE_VALUE, zero);
        left = choose(stuck, block[AT_STICTION] - most - spared, left);
    }
    block[AT_HUB_LEAST] = left;
    block[AT_HUB_ROOT] = zero - 1.0;
    if (any(~stuck & ~MASK(left > 0))) {
        const enclosed_function gone = {rates, order + 1, &turning, sense, first, h, jumped};
        block[AT_HUB_ROOT] = choose(stuck, zero - 1.0, first_root(&gone));
    }
}

KERNEL int series(real *block, const int contact, const int point, const int hub_spring,
                  bool damped)
{
    const real zero = (real){0};
    const mask stuck = MASK(block[AT_FRICTION] == 0);
    const bool sticks = any(stuck);
    const real mass = block[AT_MASS], l = block[AT_LENGTH];
    const real k = block[AT_STIFFNESS], kd = block[AT_DAMPING];
    const real kh = block[AT_HUB_STIFFNESS], khd = block[AT_HUB_DAMPING];
    const real viscous = block[AT_VISCOUS];
    real *q0 = block + AT_ANGLE_0, *q1 = block + AT_ANGLE_1, *q2 = block + AT_ANGLE_2;
    real *w0 = block + AT_RATE_0, *w1 = block + AT_RATE_1, *w2 = block + AT_RATE_2;
    real *f = block + AT_FORCE, *hold = block + AT_HOLD, *gap = block + AT_GAP;
    real *hub_square = block + AT_HUB_SQUARE, *dissipation = block + AT_DISSIPATION;
    factors x;
    sums sum = no_sums;
    const int directions = TURNING | (point ? 0 : TURNING1);
    const int all_sums = PRODUCTS | directions | (contact ? LEVERED : 0);
    real *v = x.v, hub_rate[TAYLOR_MOST + 1]; // of the bend and the hub spring

    // inertias of the links about their bases, the first carrying the second, and what couples them
    const real m22 = block[AT_INERTIA] + mass * l * l / 4, m12 = mass * l * l / 2;
    const real m11 = m22 + mass * l * l + (hub_spring ? zero : block[AT_HUB_INERTIA]);
    const real drive = block[AT_TORQUE] - block[AT_FRICTION] * block[AT_STICTION];

#if LANES > 1
    x.w1 = w1;
    x.w2 = w2;
    x.hub = hub_spring ? w0 : w1;
    x.f = f;
#endif

    // the state at the start, and the angles' sines and cosines there
    q1[0] = block[AT_START_ANGLE + 1];
    q2[0] = block[AT_START_ANGLE + 2];
    w1[0] = block[AT_START_VELOCITY + 1];
    w2[0] = block[AT_START_VELOCITY + 2];
    if (hub_spring) {
        q0[0] = block[AT_START_ANGLE];
        w0[0] = block[AT_START_VELOCITY];
    }
    const real turned_by[2] = {q2[0] - q1[0], q2[0]};
    real sines[2], cosines[2];
    sines_cosines(turned_by, sines, cosines);
    const real s0 = sines[0], c0 = cosines[0], sine = sines[1], cosine = cosines[1];
    const real reach_x = point ? block[AT_WALL_X] : l * block[AT_WALL_X];
    const real reach_y = point ? block[AT_WALL_Y] : l * block[AT_WALL_Y];
    const real S20 = reach_x * sine - reach_y * cosine;
    const real C20 = reach_x * cosine + reach_y * sine;
    DIRECTIONS(&x, 0) = FOUR(c0, s0, C20, S20);
    if (!point) {
        DIRECTION1(&x, 0) = TWO(C20 * c0 + S20 * s0, S20 * c0 - C20 * s0);
    }

    // the matrix of the start, inverted; a stuck rigid hub takes the first row away
    const real coupling = m12 * c0;
    const real inverse_det = 1 / (m11 * m22 - coupling * coupling);
    real i11 = m22 * inverse_det, i12 = -(coupling * inverse_det), i22 = m11 * inverse_det;
    if (!hub_spring) {
        i11 = choose(stuck, zero, i11);
        i12 = choose(stuck, zero, i12);
        i22 = choose(stuck, 1 / m22, i22);
    }
    real y1 = zero, y2 = zero, per_force = zero; // M^-1 J/(J M^-1 J), 1/(J M^-1 J)
    const real j1 = point ? l * c0 : PART(DIRECTION1(&x, 0), 0);
    const real j2 = point ? C20 - l * c0 : C20;
    if (contact) {
        // in contact without what the wall takes of it, M^-1 - M^-1 J J' M^-1/(J M^-1 J)
        const real r1 = i11 * j1 + i12 * j2, r2 = i12 * j1 + i22 * j2;
        per_force = 1 / (j1 * r1 + j2 * r2);
        y1 = r1 * per_force;
        y2 = r2 * per_force;
        i11 -= r1 * y1;
        i12 -= r1 * y2;
        i22 -= r2 * y2;
    }

    const real inverse_hub = hub_spring ? choose(stuck, zero, 1 / block[AT_HUB_INERTIA]) : zero;

    // as far as the terms matter
    const real wanted = block[AT_WANTED];
    const real scale = greater(greater(magnitude(w1[0]), magnitude(w2[0])), zero + 1.0);
    const real limit = LAST_TERMS * scale;
    real power = zero + 1.0; // wanted^n
    mask open[TAYLOR_MOST / 2 + 1];
    ptrdiff_t order = TAYLOR_MOST;

    // An order waits for what is known last: the products with its rates, then those with the
    // newest directions. Sums take these at their ends, so that little is left to do behind them.
    const real first1 = w1[0], first2 = w2[0], first_hub = hub_spring ? w0[0] : first1;
    real product = zero, rate1 = first1, rate2 = first2; // (w1 w2)_(n-1), w1_n, w2_n
    for (ptrdiff_t n = 0; n < order; n++) {
        // directions of the next order end what the last pass has left open
        const double share = inverse[n + 1];
        const real hub = hub_spring ? w0[n] : rate1;
        const real bend_rate = rate2 - rate1;
        keep_rates(&x, n, bend_rate, rate1, rate2);
        add_products(&sum, &x, n, n - 1, directions, point);
        four next;
        turn(&sum.turning, share, &next);
        DIRECTIONS(&x, n + 1) = next;
        if (!point) {
            turn_one(&sum.turning1, share, &DIRECTION1(&x, n + 1));
        }

        // products: what is known of (c w2)_(n+1), (w1 w2)_n, (s w1 w2)_n, the hub's square; of the
        // turning of the order after next
        keep_products(&x, n, rate1, rate2, product, hub);
        if (contact) {
            keep_levers(&x, n, point);
        }
        inner_sums(&x, n, all_sums, point, &sum);
        if (n > 0) {
            add_products(&sum, &x, 0, n, PRODUCTS, point);
            add_products(&sum, &x, n, n, directions, point);
        }
        add_products(&sum, &x, 0, n, directions, point);
        product = PART(sum.products, 1) + rate1 * first2;
        hub_square[n] = PART(sum.products, 3) + hub * first_hub;
        const real swung = PART(sum.products, 0) + PART(next, 0) * first2;
        const real turned = s0 * product + PART(sum.products, 2), bent = PART(sum.turning, 0);

        // derivatives of the momenta without what f_n and these give
        const real pull = k * (q2[n] - q1[n]) + kd * bend_rate;
        const real driven = n == 0 ? drive : zero;
        real push1 = pull, push2 = -pull;
        if (hub_spring) {
            hub_rate[n] = rate1 - hub;
            const real hub_pull = kh * (q1[n] - q0[n]) + khd * hub_rate[n];
            const real moment = driven - viscous * hub + hub_pull;
            push1 -= hub_pull;
            hold[n] = -moment;
            w0[n + 1] = moment * inverse_hub * share;
            q0[n + 1] = hub * share;
        } else {
            push1 += driven - viscous * rate1;
        }
        if (contact && n > 0) {
            add_products(&sum, &x, 0, n, LEVERED, point);
            const real first = point ? l * PART(sum.levered, 0) : PART(sum.levered, 0);
            push1 -= first;
            push2 -= point ? PART(sum.levered, 1) - first : PART(sum.levered, 1);
        }
        push1 += m12 * turned;
        push2 -= m12 * turned;

        // velocities, and in contact the force that keeps the gap from changing
        const real coupled = m12 * swung;
        const real b1 = push1 * share - coupled, b2 = (push2 * share + m12 * bent) - coupled;
        real x1 = i11 * b1 + i12 * b2, x2 = i12 * b1 + i22 * b2;
        if (contact) {
            const real closing = point ? PART(sum.turning, 2) - l * bent
                                       : PART(sum.turning1, 0) + PART(sum.turning, 2);
            f[n] = ((y1 * b1 + y2 * b2) + per_force * closing) * (double)(n + 1);
            keep_force(&x, n, f[n]);
            x1 -= y1 * closing;
            x2 -= y2 * closing;
        }
        w1[n + 1] = x1;
        w2[n + 1] = x2;
        q1[n + 1] = rate1 * share;
        q2[n + 1] = rate2 * share;
        rate1 = x1;
        rate2 = x2;

        // what holds a stuck hub, and what springs lose
        if (!hub_spring && sticks) {
            hold[n] = (coupling * x2 + m12 * swung) * (double)(n + 1) - push1;
            if (contact) {
                hold[n] += j1 * f[n];
            }
        }
        if (damped) {
            dissipation[n] = kd * square(v, n);
            if (hub_spring) {
                dissipation[n] += khd * square(hub_rate, n);
            }
        }

        // an order lower than the highest at which they may be small enough
        power = n > 0 ? power * wanted : power;
        if (n % 2 == 1 && n + 1 >= LEAST_ORDER && n + 1 < TAYLOR_MOST) {
            last_terms now = {magnitude(w1[n]) + magnitude(w2[n]), magnitude(x1) + magnitude(x2),
                              power};
            if (hub_spring) {
                now.before += magnitude(w0[n]);
                now.last += magnitude(w0[n + 1]);
            }
            mask large = too_large(now, wanted, limit);
            if (any(~large)) {
                // what decays is lost twice as fast as it decays: the losses' series end later
                last_terms lost = {viscous * magnitude(hub_square[n - 1]),
                                   viscous * magnitude(hub_square[n]), power};
                if (damped) {
                    lost.before += magnitude(dissipation[n - 1]);
                    lost.last += magnitude(dissipation[n]);
                }
                large |= too_large(lost, wanted, limit * scale);
            }
            if (!contact && any(~large)) {
                // of the gap the coefficients so far, which are of one order less
                const real gap_before = gap_term(&x, n, l, point);
                const real gap_last = gap_term(&x, n + 1, l, point);
                const last_terms swing = {magnitude(gap_before) * (double)n,
                                          magnitude(gap_last) * (double)(n + 1), power};
                large |= too_large(swing, wanted, limit * wanted * l);
            }
            if (!hub_spring && sticks && any(~large)) {
                const last_terms held = {magnitude(hold[n - 1]) * inverse[n],
                                         magnitude(hold[n]) * inverse[n + 1], power};
                large |= stuck & too_large(held, wanted, limit * m11);
            }
            const mask before = n + 1 > LEAST_ORDER ? open[(n - 1) / 2] : ~(mask){0};
            open[(n + 1) / 2] = before & large;
            order = any(open[(n + 1) / 2]) ? order : n + 1;
        }
    }
    q1[order + 1] = w1[order] * inverse[order + 1];
    q2[order + 1] = w2[order] * inverse[order + 1];
    last_terms tail = {magnitude(w1[order - 1]) + magnitude(w2[order - 1]),
                       magnitude(w1[order]) + magnitude(w2[order]), power};
    if (hub_spring) {
        q0[order + 1] = w0[order] * inverse[order + 1];
        tail.before += magnitude(w0[order - 1]);
        tail.last += magnitude(w0[order]);
    }

    // the gap, as far as the angles are known
    if (!contact) {
        keep_rates(&x, order, w2[order] - w1[order], w1[order], w2[order]);
        add_products(&sum, &x, order, order - 1, directions, point);
        turn(&sum.turning, inverse[order + 1], &DIRECTIONS(&x, order + 1));
        if (!point) {
            turn_one(&sum.turning1, inverse[order + 1], &DIRECTION1(&x, order + 1));
        }
        for (int n = 0; n <= order + 1; n++) {
            gap[n] = gap_term(&x, n, l, point);
        }

        // its rate counts as the velocities do: sines of large swings go on where those have ended
        const real per_length = 1 / l;
        tail.last += magnitude(gap[order + 1]) * (double)(order + 1) * per_length;
        tail.before += magnitude(gap[order]) * (double)order * per_length;
    }

    // so does what a stuck hub is held from
    if (!hub_spring && sticks) {
        const real per_inertia = choose(stuck, 1 / m11, zero);
        tail.last += magnitude(hold[order - 1]) * inverse[order] * per_inertia;
        tail.before += magnitude(hold[order - 2]) * inverse[order - 1] * per_inertia;
    }

    // so do the losses, as above
    const real per_scale = 1 / scale;
    real lost_before = viscous * magnitude(hub_square[order - 2]);
    real lost_last = viscous * magnitude(hub_square[order - 1]);
    if (damped) {
        lost_before += magnitude(dissipation[order - 2]);
        lost_last += magnitude(dissipation[order - 1]);
    }
    tail.before += lost_before * per_scale;
    tail.last += lost_last * per_scale;

    // where no order was enough the stride is shortened
    const mask ended = order < TAYLOR_MOST ? ~(mask){0} : ~open[TAYLOR_MOST / 2 - 1];
    tail.last = choose(ended, zero, tail.last);
    tail.before = choose(ended, zero, tail.before);
    const real h = allowed_stride(wanted, tail, limit);
    if (LANES > 1 && order > LEAST_ORDER && any(~open[order / 2 - 1])) {
        cut_off(block, open, (int)order);
    }
    block[AT_ALLOWED] = h;

    // what the stride leaves of the wall's function and the hub's, and where it ends in between
    const mask jumped = MASK(block[AT_EDGE_RATE] >= 0);
    bound_wall(block, contact, contact ? f : gap, contact ? (int)order : (int)order + 2, jumped);
    bound_hub(block, hub_spring ? w0 : w1, hold, (int)order, stuck, jumped);
    return (int)order;
}

// --- entries ----------------------------------------------------------------------------------

#define FORM(name, contact, point, hub_spring)                                                     \
    static __attribute__((noinline)) int name(real *block, bool damped)                            \
    {                                                                                              \
        return series(block, contact, point, hub_spring, damped);                                  \
    }
FORM(free_plane, 0, 0, 0)
FORM(free_point, 0, 1, 0)
FORM(held_plane, 1, 0, 0)
FORM(held_point, 1, 1, 0)
FORM(spring_free_plane, 0, 0, 1)
FORM(spring_free_point, 0, 1, 1)
FORM(spring_held_plane, 1, 0, 1)
FORM(spring_held_point, 1, 1, 1)
#undef FORM

int SERIES(double *block, taylor_form form)
{
    static int (*const forms[2][2][2])(real *, bool) = {
        {{free_plane, free_point}, {held_plane, held_point}},
        {{spring_free_plane, spring_free_point}, {spring_held_plane, spring_held_point}}};
    return forms[form.hub_spring][form.contact][form.point]((real *)block, form.damped);
}

#ifndef ONE_ARM
void INPUTS(double *block, const double *const *own)
{
    // whole vectors: loads that follow on stores of parts of theirs wait for them
    for (int place = 0; place < AT_INPUTS; place++) {
#if LANES == 1
        block[place] = own[0][place];
#else
        real x = (real){0};
        for (int i = 0; i < LANES; i++) {
            x[i] = own[i][place];
        }
        ((real *)block)[place] = x;
#endif
    }
}
#endif
