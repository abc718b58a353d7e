// What series come to at instants of their steps, side by side: those of one arm at LANES
// instants, or of LANES arms at one each. An instant has the same bits wherever it is
// computed, and its energies are those of chain_kinetic_energy and chain_strain_energy.
//
// With u = t^2 a polynomial is E(u) + t O(u), its even and its odd terms.
#pragma once

#include "src/engines/pair/taylor_numbers.h"
#include "src/engines/pair/taylor_products.h"

// A block of one arm, whose numbers all lanes share, or of an arm a lane.
typedef struct coefficients {
    const double *first;
    bool shared;
} coefficients;

KERNEL real load_lanes(const double *place)
{
    real x;
    memcpy(&x, place, sizeof x);
    return x;
}

KERNEL void store_lanes(double *place, real x)
{
    memcpy(place, &x, sizeof x);
}

KERNEL real term(coefficients x, int n)
{
    return x.shared ? x.first[n] - (real){0} : load_lanes(x.first + n * LANES);
}

KERNEL coefficients from(coefficients x, int place)
{
    return (coefficients){x.first + (x.shared ? place : place * LANES), x.shared};
}

KERNEL real polynomial_value(coefficients x, int count, real t, real u)
{
    real even = term(x, count - 2), odd = term(x, count - 1);
    for (int n = count - 4; n >= 0; n -= 2) {
        even = even * u + term(x, n);
        odd = odd * u + term(x, n + 1);
    }
    return even + t * odd;
}

KERNEL real integral_of(coefficients x, int count, real t, real u)
{
    real even = term(x, count - 2) * inverse[count - 1],
         odd = term(x, count - 1) * inverse[count];
    for (int n = count - 4; n >= 0; n -= 2) {
        even = even * u + term(x, n) * inverse[n + 1];
        odd = odd * u + term(x, n + 1) * inverse[n + 2];
    }
    return t * (even + t * odd);
}

// Value, first and second derivative, p' = O + 2 t (E' + t O'), p'' = 2 E' + 6 t O' + 4 u
// (E'' + t O''), the dashes on the right by u.
KERNEL void derivatives_of(coefficients x, int count, real t, real u, real result[3])
{
    const real zero = (real){0};
    real even = term(x, count - 2), odd = term(x, count - 1);
    real even1 = zero, odd1 = zero, even2 = zero, odd2 = zero;
    for (int n = count - 4; n >= 0; n -= 2) {
        even2 = even2 * u + even1;
        odd2 = odd2 * u + odd1;
        even1 = even1 * u + even;
        odd1 = odd1 * u + odd;
        even = even * u + term(x, n);
        odd = odd * u + term(x, n + 1);
    }
    result[0] = even + t * odd;
    result[1] = odd + 2 * t * (even1 + t * odd1);
    result[2] = 2 * even1 + 6 * t * odd1 + 8 * u * (even2 + t * odd2);
}

// Value and first derivative, by the operations of value_and_slope_at
// (taylor_polynomial.h): terms in pairs, the pairs by turns.
KERNEL void value_slope_of(coefficients x, int count, real t, double *value,
                           double *slope)
{
    const real u = t * t, v = u * u;
    real even[2] = {(real){0}, (real){0}}, odd[2] = {(real){0}, (real){0}};
    real even1[2] = {(real){0}, (real){0}}, odd1[2] = {(real){0}, (real){0}}, at[2],
         by_u[2];
    int n = count - 2;
    if (n % 4 == 0) {
        even[0] = term(x, n);
        even[1] = term(x, n + 1);
        n -= 2;
    }
    for (; n >= 2; n -= 4) {
        for (int i = 0; i < 2; i++) {
            odd1[i] = odd1[i] * v + odd[i];
            odd[i] = odd[i] * v + term(x, n + i);
            even1[i] = even1[i] * v + even[i];
            even[i] = even[i] * v + term(x, n - 2 + i);
        }
    }
    for (int i = 0; i < 2; i++) {
        at[i] = even[i] + u * odd[i];
        by_u[i] = odd[i] + 2 * (u * even1[i] + v * odd1[i]);
    }
    store_lanes(value, at[0] + t * at[1]);
    store_lanes(slope, at[1] + 2 * t * (by_u[0] + t * by_u[1]));
}

// Gap, its rate and second derivative from directions, velocities and accelerations of
// the links.
KERNEL void gap_of(coefficients x, const bool point, const real s[2], const real c[2],
                   const real w[2], const real al[2], taylor_instants *at)
{
    const real l = term(x, AT_LENGTH), wall_x = term(x, AT_WALL_X),
               wall_y = term(x, AT_WALL_Y);
    const real vx = -l * s[0] * w[0], vy = l * c[0] * w[0];
    const real base_x = l * c[0], base_y = l * s[0], omega = w[1];
    real ex = -s[1], ey = c[1], off = (real){0}, penetration, convective;

    // a point pushes across the link, a plane across its own surface
    if (point) {
        const real dx = wall_x - base_x, dy = wall_y - base_y;
        off = c[1] * dx + s[1] * dy - l;
        penetration = s[1] * dx - c[1] * dy;
        convective = -penetration * omega * omega - 2 * omega * (c[1] * vx + s[1] * vy);
    } else {
        ex = -wall_y;
        ey = wall_x;
        penetration = ex * (base_x + l * c[1]) + ey * (base_y + l * s[1]);
        convective = -l * omega * omega * (ex * c[1] + ey * s[1]);
    }
    const real lever = off + l * (c[1] * ey - s[1] * ex);

    const real ax = -l * (s[0] * al[0] + c[0] * w[0] * w[0]);
    const real ay = l * (c[0] * al[0] - s[0] * w[0] * w[0]);
    store_lanes(at->gap, -penetration);
    store_lanes(at->gap_velocity, -(ex * vx + ey * vy + lever * omega));
    store_lanes(at->gap_acceleration, -(ex * ax + ey * ay + lever * al[1] + convective));
}

// Energies of motion and of bending.
KERNEL void energies_of(coefficients x, const bool hub_spring, const real s[2],
                        const real c[2], const real q[3], const real w[3],
                        taylor_instants *at)
{
    const real l = term(x, AT_LENGTH), mass = term(x, AT_MASS),
               inertia = term(x, AT_INERTIA);
    const int hub = hub_spring ? 0 : 1;
    real vx = (real){0}, vy = vx, strain = vx;
    real kinetic = term(x, AT_HUB_INERTIA) * w[hub] * w[hub];
    for (int k = 0; k < 2; k++) {
        const real turn = w[k + 1], across_x = -l * s[k] * turn,
                   across_y = l * c[k] * turn;
        const real cx = vx + across_x / 2, cy = vy + across_y / 2;
        kinetic += mass * (cx * cx + cy * cy) + inertia * turn * turn;
        vx += across_x;
        vy += across_y;
    }
    if (hub_spring) {
        const real bend = q[1] - q[0];
        strain += term(x, AT_HUB_STIFFNESS) * bend * bend;
    }
    const real bend = q[2] - q[1];
    strain += term(x, AT_STIFFNESS) * bend * bend;
    store_lanes(at->kinetic, kinetic / 2);
    store_lanes(at->strain, strain / 2);
}

#if LANES == 1
// Even and odd terms of two series, which fill a vector.
#define TERMS_OF_BOTH(x, y, n) FOUR((x)[n], (x)[(n) + 1], (y)[n], (y)[(n) + 1])

// derivatives_of for both links.
KERNEL void derivatives_of_links(coefficients x, int count, real t, real u,
                                 real result[2][3])
{
    const real *first = x.first + AT_ANGLE_1, *second = x.first + AT_ANGLE_2;
    four value = TERMS_OF_BOTH(first, second, count - 2), by_u = {0}, by_u2 = {0};
    for (int n = count - 4; n >= 0; n -= 2) {
        by_u2 = by_u2 * u + by_u;
        by_u = by_u * u + value;
        value = value * u + TERMS_OF_BOTH(first, second, n);
    }
    for (int i = 0; i < 2; i++) {
        const int even = 2 * i, odd = even + 1;
        result[i][0] = value[even] + t * value[odd];
        result[i][1] = value[odd] + 2 * t * (by_u[even] + t * by_u[odd]);
        result[i][2] =
            2 * by_u[even] + 6 * t * by_u[odd] + 8 * u * (by_u2[even] + t * by_u2[odd]);
    }
}
#else
KERNEL void derivatives_of_links(coefficients x, int count, real t, real u,
                                 real result[2][3])
{
    derivatives_of(from(x, AT_ANGLE_1), count, t, u, result[0]);
    derivatives_of(from(x, AT_ANGLE_2), count, t, u, result[1]);
}
#endif

// Angles, velocities and accelerations; a stuck hub has no motion.
KERNEL void motion_of(coefficients x, taylor_form form, real t, real u, mask stuck,
                      real q[3], real w[3], real al[3])
{
    const int hub = form.hub_spring ? 0 : 1, count = form.order + 2;
    const real zero = (real){0};
    real d[3][3];
    if (form.hub_spring) {
        derivatives_of(from(x, AT_ANGLE_0), count, t, u, d[0]);
    }
    derivatives_of_links(x, count, t, u, d + 1);
    for (int i = hub; i < 3; i++) {
        q[i] = d[i][0];
        w[i] = i == hub ? select_lanes(stuck, zero, d[i][1]) : d[i][1];
        al[i] = i == hub ? select_lanes(stuck, zero, d[i][2]) : d[i][2];
    }
}

// What it has lost and pressed.
KERNEL void losses_of(coefficients x, taylor_form form, real t, real u, mask stuck,
                      taylor_instants *at)
{
    const int order = form.order;
    store_lanes(at->hub_square, integral_of(from(x, AT_HUB_SQUARE), order, t, u));
    if (form.contact) {
        store_lanes(at->force, polynomial_value(from(x, AT_FORCE), order, t, u));
        store_lanes(at->pressed, integral_of(from(x, AT_FORCE), order, t, u));
    }
    if (form.damped) {
        store_lanes(at->dissipated, integral_of(from(x, AT_DISSIPATION), order, t, u));
        store_lanes(at->dissipation,
                    polynomial_value(from(x, AT_DISSIPATION), order, t, u));
    }
    if (any(stuck)) {
        store_lanes(at->hold, polynomial_value(from(x, AT_HOLD), order, t, u));
    }
}

KERNEL void evaluate_instants(coefficients x, taylor_form form, taylor_instants *at)
{
    const real t = load_lanes(at->time), u = t * t, zero = (real){0};
    const mask stuck = MASK(term(x, AT_FRICTION) == 0);
    real q[3] = {zero, zero, zero}, w[3] = {zero, zero, zero}, al[3] = {zero, zero, zero};

    // the motion, and what it has lost and pressed
    motion_of(x, form, t, u, stuck, q, w, al);
    for (int i = form.hub_spring ? 0 : 1; i < 3; i++) {
        store_lanes(at->angle[i], q[i]);
        store_lanes(at->velocity[i], w[i]);
        store_lanes(at->acceleration[i], al[i]);
    }
    losses_of(x, form, t, u, stuck, at);

    // where the links point, and what follows from that
    real s[2], c[2];
    sines_cosines(q + 1, s, c);
    gap_of(x, form.point, s, c, w + 1, al + 1, at);
    energies_of(x, form.hub_spring, s, c, q, w, at);
}

static void instants(const double *block, taylor_form form, taylor_instants *at)
{
    evaluate_instants((coefficients){block, true}, form, at);
}

static void values(const double *terms, int count, const double *time, double *value,
                   double *slope)
{
    value_slope_of((coefficients){terms, true}, count, load_lanes(time), value, slope);
}

#if LANES > 1
static void ends(const double *block, taylor_form form, taylor_instants *at)
{
    evaluate_instants((coefficients){block, false}, form, at);
}

static void pieces(const double *block, int order, int count, taylor_pieces *of)
{
    const real width = load_lanes(of->width);
    const coefficients force = from((coefficients){block, false}, AT_FORCE);
    for (int i = 0; i < count; i++) {
        value_slope_of(force, order, (i + 1) * width, of->force[i], of->slope[i]);
    }
}
#endif
