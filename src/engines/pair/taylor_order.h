// The equations of two links by powers of the time, one order after the other: part of
// taylor_kernel.c.
//
// Let d = q2 - q1 be the bend, s and c its sine and cosine, and S, C those of an angle
// from the wall times a length. The equations of chain.h for two links are those of the
// momenta
//
//     p1 = m11 w1 + m12 c w2,     p1' = drive - kv w1 + pull - J1 f
//     p2 = m12 c w1 + m22 w2,     p2' =               - pull - J2 f
//     pull = m12 s w1 w2 + k d + kd d'
//
// with a hub on a spring taking drive and kv away from p1' into I1 w0' = drive - kv w0 -
// hub spring. In contact f keeps the gap's derivative, gap' = -(J1 w1 + J2 w2), at zero:
//
//     point: gap = l s - S2,      J1 = l c,  J2 = C2 - l c,  gap' = l c d' - C2 w2
//     plane: gap = -(S1 + S2),    J1 = C1,   J2 = C2,        gap' = -(C1 w1 + C2 w2)
//
// Put x = sum x_n t^n. Sums and springs go by coefficient, products are Cauchy's, (x y)_n
// = sum x_j y_(n-j), and sine and cosine of an angle with the velocity v follow from s' =
// v c, c' = -v s:
//
//     n s_n = (v c)_(n-1),     n c_n = -(v s)_(n-1)
//
// which are the products that gap' is made of, and p2's as c w1 = c w2 - c d'. Of the
// n-th coefficient of p1', p2' and the (n+1)-th of gap' all is known but w1_(n+1),
// w2_(n+1) and f_n, which the matrix of the step's start, inverted once, gives; q_(n+1) =
// w_n/(n + 1) follows.
#pragma once

#include "src/engines/pair/taylor_products.h"

// The equations of a step: constants, and the matrix of its start, inverted, in contact
// without what the wall takes of it, M^-1 - M^-1 J J' M^-1/(J M^-1 J).
typedef struct equations {
    real l, k, kd, kh, khd, viscous;
    real m11, m12,
        m22;    // inertias about the bases, the first carrying the second; their coupling
    real drive; // torque of motor and sliding friction
    real s0, c0;        // of the bend
    real coupling;      // m12 c0
    real i11, i12, i22; // of the matrix
    real y1, y2;        // M^-1 J/(J M^-1 J)
    real per_force;     // 1/(J M^-1 J)
    real j1;            // of J
    real inverse_hub;   // 1/I1 of a hub on a spring that slides
    mask stuck;
    bool sticks, damped; // in some lane
} equations;

// Puts the state at the start into the series, with the angles' sines and cosines there.
KERNEL void put_start(real *block, equations *e, factors *x, const int point,
                      const int hub_spring)
{
    const real q1 = block[AT_START_ANGLE + 1], q2 = block[AT_START_ANGLE + 2];
    block[AT_ANGLE_1] = q1;
    block[AT_ANGLE_2] = q2;
    block[AT_RATE_1] = block[AT_START_VELOCITY + 1];
    block[AT_RATE_2] = block[AT_START_VELOCITY + 2];
    if (hub_spring) {
        block[AT_ANGLE_0] = block[AT_START_ANGLE];
        block[AT_RATE_0] = block[AT_START_VELOCITY];
    }
    const real turned_by[2] = {q2 - q1, q2};
    real sines[2], cosines[2];
    sines_cosines(turned_by, sines, cosines);
    e->s0 = sines[0];
    e->c0 = cosines[0];
    const real reach_x = point ? block[AT_WALL_X] : e->l * block[AT_WALL_X];
    const real reach_y = point ? block[AT_WALL_Y] : e->l * block[AT_WALL_Y];
    const real S20 = reach_x * sines[1] - reach_y * cosines[1];
    const real C20 = reach_x * cosines[1] + reach_y * sines[1];
    DIRECTIONS(x, 0) = FOUR(e->c0, e->s0, C20, S20);
    if (!point) {
        DIRECTION1(x, 0) = TWO(C20 * e->c0 + S20 * e->s0, S20 * e->c0 - C20 * e->s0);
    }
}

// The matrix of the start, inverted; a stuck rigid hub takes the first row away.
KERNEL void invert_start(equations *e, const factors *x, const int contact,
                         const int point, const int hub_spring)
{
    const real zero = (real){0};
    e->coupling = e->m12 * e->c0;
    const real inverse_det = 1 / (e->m11 * e->m22 - e->coupling * e->coupling);
    e->i11 = e->m22 * inverse_det;
    e->i12 = -(e->coupling * inverse_det);
    e->i22 = e->m11 * inverse_det;
    if (!hub_spring) {
        e->i11 = select_lanes(e->stuck, zero, e->i11);
        e->i12 = select_lanes(e->stuck, zero, e->i12);
        e->i22 = select_lanes(e->stuck, 1 / e->m22, e->i22);
    }
    e->y1 = e->y2 = e->per_force = zero;
    const real C20 = PART(DIRECTIONS(x, 0), 2);
    e->j1 = point ? e->l * e->c0 : PART(DIRECTION1(x, 0), 0);
    if (contact) {
        const real j1 = e->j1, j2 = point ? C20 - e->l * e->c0 : C20;
        const real r1 = e->i11 * j1 + e->i12 * j2, r2 = e->i12 * j1 + e->i22 * j2;
        e->per_force = 1 / (j1 * r1 + j2 * r2);
        e->y1 = r1 * e->per_force;
        e->y2 = r2 * e->per_force;
        e->i11 -= r1 * e->y1;
        e->i12 -= r1 * e->y2;
        e->i22 -= r2 * e->y2;
    }
}

// What an order leaves to the next: (w1 w2)_(n-1), w1_n, w2_n, and sums under way.
typedef struct newest {
    real product, rate1, rate2;
    sums sum;
} newest;

// The directions of the order after n from velocities of order n; `sum` has been left
// open for them.
KERNEL void add_directions(factors *x, ptrdiff_t n, real w1, real w2, sums *sum,
                           const int point)
{
    keep_rates(x, n, w2 - w1, w1, w2);
    accumulate_products(sum, x, n, n - 1, TURNING | (point ? 0 : TURNING1), point);
    set_directions(&sum->turning, inverse[n + 1], &DIRECTIONS(x, n + 1));
    if (!point) {
        turn_one(&sum->turning1, inverse[n + 1], &DIRECTION1(x, n + 1));
    }
}

// What joints, motor and friction give to the n-th coefficients of p1' and p2'; a hub on
// its spring goes on to the next ones.
KERNEL void push_links(real *block, const equations *e, const newest *last,
                       real *hub_rate, ptrdiff_t n, const int hub_spring, real push[2])
{
    const real *q0 = block + AT_ANGLE_0, *q1 = block + AT_ANGLE_1,
               *q2 = block + AT_ANGLE_2;
    const real pull = e->k * (q2[n] - q1[n]) + e->kd * (last->rate2 - last->rate1);
    const real driven = n == 0 ? e->drive : (real){0};
    push[0] = pull;
    push[1] = -pull;
    if (!hub_spring) {
        push[0] += driven - e->viscous * last->rate1;
        return;
    }
    const real hub = block[AT_RATE_0 + n];
    hub_rate[n] = last->rate1 - hub;
    const real hub_pull = e->kh * (q1[n] - q0[n]) + e->khd * hub_rate[n];
    const real moment = driven - e->viscous * hub + hub_pull;
    push[0] -= hub_pull;
    block[AT_HOLD + n] = -moment;
    block[AT_RATE_0 + n + 1] = moment * e->inverse_hub * inverse[n + 1];
    block[AT_ANGLE_0 + n + 1] = hub * inverse[n + 1];
}

// The n-th coefficient of what springs lose, the hub's at its rates of bending.
KERNEL void add_dissipation(real *block, const equations *e, const factors *x,
                            const real *hub_rate, ptrdiff_t n, const int hub_spring)
{
    real lost = e->kd * square(x->v, n);
    if (hub_spring) {
        lost += e->khd * square(hub_rate, n);
    }
    block[AT_DISSIPATION + n] = lost;
}

// The n-th coefficients, and of angles and velocities those after them.
//
// An order waits for what is known last: the products with its rates, then those with the
// newest directions. Sums take these at their ends, so that little is left to do behind
// them.
KERNEL void add_order(real *block, const equations *e, factors *x, real *hub_rate,
                      ptrdiff_t n, newest *last, const int contact, const int point,
                      const int hub_spring)
{
    const int directions = TURNING | (point ? 0 : TURNING1);
    const real first2 = block[AT_RATE_2];
    const real first_hub = hub_spring ? block[AT_RATE_0] : block[AT_RATE_1];
    const real rate1 = last->rate1, rate2 = last->rate2, m12 = e->m12, l = e->l;
    sums *sum = &last->sum;

    // directions of the next order
    const double share = inverse[n + 1];
    const real hub = hub_spring ? block[AT_RATE_0 + n] : rate1;
    add_directions(x, n, rate1, rate2, sum, point);

    // products: what is known of (c w2)_(n+1), (w1 w2)_n, (s w1 w2)_n, the hub's square;
    // of the turning of the order after next
    keep_products(x, n, rate1, rate2, last->product, hub);
    if (contact) {
        keep_levers(x, n, point);
    }
    inner_sums(x, n, PRODUCTS | directions | (contact ? LEVERED : 0), point, sum);
    if (n > 0) {
        accumulate_products(sum, x, 0, n, PRODUCTS, point);
        accumulate_products(sum, x, n, n, directions, point);
    }
    accumulate_products(sum, x, 0, n, directions, point);
    last->product = PART(sum->products, 1) + rate1 * first2;
    block[AT_HUB_SQUARE + n] = PART(sum->products, 3) + hub * first_hub;
    const real swung = PART(sum->products, 0) + PART(DIRECTIONS(x, n + 1), 0) * first2;
    const real turned = e->s0 * last->product + PART(sum->products, 2),
               bent = PART(sum->turning, 0);

    // derivatives of the momenta without what f_n and these give
    real push[2];
    push_links(block, e, last, hub_rate, n, hub_spring, push);
    if (contact && n > 0) {
        accumulate_products(sum, x, 0, n, LEVERED, point);
        const real first = point ? l * PART(sum->levered, 0) : PART(sum->levered, 0);
        push[0] -= first;
        push[1] -= point ? PART(sum->levered, 1) - first : PART(sum->levered, 1);
    }
    push[0] += m12 * turned;
    push[1] -= m12 * turned;

    // velocities, and in contact the force that keeps the gap from changing
    const real coupled = m12 * swung;
    const real b1 = push[0] * share - coupled,
               b2 = (push[1] * share + m12 * bent) - coupled;
    real x1 = e->i11 * b1 + e->i12 * b2, x2 = e->i12 * b1 + e->i22 * b2,
         force = (real){0};
    if (contact) {
        const real closing = point ? PART(sum->turning, 2) - l * bent
                                   : PART(sum->turning1, 0) + PART(sum->turning, 2);
        force = ((e->y1 * b1 + e->y2 * b2) + e->per_force * closing) * (double)(n + 1);
        block[AT_FORCE + n] = force;
        store_force(x, n, force);
        x1 -= e->y1 * closing;
        x2 -= e->y2 * closing;
    }
    block[AT_RATE_1 + n + 1] = x1;
    block[AT_RATE_2 + n + 1] = x2;
    block[AT_ANGLE_1 + n + 1] = rate1 * share;
    block[AT_ANGLE_2 + n + 1] = rate2 * share;
    last->rate1 = x1;
    last->rate2 = x2;

    // what holds a stuck hub, and what springs lose
    if (!hub_spring && e->sticks) {
        const real held = (e->coupling * x2 + m12 * swung) * (double)(n + 1) - push[0];
        block[AT_HOLD + n] = contact ? held + e->j1 * force : held;
    }
    if (e->damped) {
        add_dissipation(block, e, x, hub_rate, n, hub_spring);
    }
}
