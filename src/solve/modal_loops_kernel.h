// The loops over modes, built once for each width of the processor's vectors (loops_wide_1.c and
// its like), which is WIDTH.
#pragma once

#include "src/solve/modal_loops.h"

#include <assert.h>

// Vectors are handed to inline functions of this file only.
#pragma GCC diagnostic ignored "-Wpsabi"

#define LANES 8
#include "src/solve/taylor_numbers.h"

typedef double loose __attribute__((vector_size(8 * LANES), aligned(8), may_alias));

// Modes k to k + 7 of an array by mode.
#define OF(array, k) (*(loose *)((array) + (k)))
#define IN(array, k) ((real) * (const loose *)((array) + (k)))

// Below this square of an exponent its integral is that of a series, to the last bits.
#define SMALL_SQUARE 1e-6

static_assert(LANES == MODAL_LANES, "arrays go on to whole vectors");

static void loop_momenta(const modal_stride *s, const modal_table *at, double *x, double *y)
{
    // every mode for itself: from its start, then what the polynomials do to it
    for (int k = 0; k < s->row; k += LANES) {
        const real rate = IN(s->modes->rate, k), twice = 2 * IN(s->damping, k);
        const real stiff = rate * rate, start = IN(s->start, k);
        real lower = IN(at->impulse, k);
        real place = start * lower, speed = start * IN(at->impulse_rate, k);
#pragma GCC unroll 6
        for (int j = 0; j < MODAL_NODES; j++) {
            const real power = IN(at->power[j], k), f = IN(s->force[j], k), d = IN(s->drift[j], k);
            place += f * power + d * (lower + twice * power);
            speed += f * lower - stiff * d * power;
            lower = power;
        }
        OF(x, k) = place;
        OF(y, k) = speed;
    }
}

KERNEL double total(real x)
{
    return ((x[0] + x[1]) + (x[2] + x[3])) + ((x[4] + x[5]) + (x[6] + x[7]));
}

static double loop_fit(modal_stride *s)
{
    const modal_table *end = &s->at[MODAL_NODES - 1];
    double scale[MODAL_NODES] = {1}; // j! / length^j
    for (int j = 1; j < MODAL_NODES; j++) {
        scale[j] = scale[j - 1] * (j / s->length);
    }

    real square = {0};
    for (int k = 0; k < s->row; k += LANES) {
        const real rate = IN(s->modes->rate, k), twice = 2 * IN(s->damping, k);
        const real softness = IN(s->softness, k), zero = {0};
        real drifts[MODAL_NODES], forces[MODAL_NODES], driven[MODAL_NODES];
        for (int i = 0; i < MODAL_NODES; i++) {
            drifts[i] = IN(s->drifts[i], k);
            forces[i] = IN(s->forces[i], k);
        }

        // power by power: the new coefficients, and what their change does until the end
        real moved = zero, placed = zero, lower = IN(end->impulse, k);
#pragma GCC unroll 6
        for (int j = 0; j < MODAL_NODES; j++) {
            real drift = zero, force = zero;
#pragma GCC unroll 6
            for (int i = 0; i < MODAL_NODES; i++) {
                drift += modal_to_powers[j][i] * drifts[i];
                force += modal_to_powers[j][i] * forces[i];
            }
            drift *= scale[j];
            force *= scale[j];
            const real dd = drift - IN(s->drift[j], k), df = force - IN(s->force[j], k);
            const real power = IN(end->power[j], k);
            placed += df * power + dd * (lower + twice * power);
            moved += df * lower - rate * rate * dd * power;
            lower = power;
            OF(s->drift[j], k) = drift;
            OF(s->force[j], k) = force;
            driven[j] = force + twice * drift;
        }
        square += moved * moved + rate * rate * placed * placed;

        // what the modes do under them without vibrating
        real last = zero, next = zero;
#pragma GCC unroll 6
        for (int j = MODAL_NODES - 1; j >= 0; j--) {
            const real turn = j + 1 < MODAL_NODES ? IN(s->drift[j + 1], k) : zero;
            const real p = (driven[j] + turn - twice * next - last) * softness;
            OF(s->followed[j], k) = p;
            last = next;
            next = p;
        }
    }

    return total(square);
}

static void loop_leave_out(const modal_stride *s, double t, double *x, double *y)
{
    const double slowest = s->shown_turn / s->length;
    double power[MODAL_NODES] = {1}; // t^j / j!
    for (int j = 1; j < MODAL_NODES; j++) {
        power[j] = power[j - 1] * (t / j);
    }

    for (int k = 0; k < s->row; k += LANES) {
        const real rate = IN(s->modes->rate, k);
        const mask fast = MASK(IN(s->damping, k) < rate) & MASK(rate > (real){0} + slowest);
        real place = {0}, speed = {0};
#pragma GCC unroll 6
        for (int j = 0; j < MODAL_NODES; j++) {
            const real next = j + 1 < MODAL_NODES ? IN(s->followed[j + 1], k) : (real){0};
            place += IN(s->followed[j], k) * power[j];
            speed += (next - IN(s->drift[j], k)) * power[j];
        }
        OF(x, k) = choose(fast, place, IN(x, k));
        OF(y, k) = choose(fast, speed, IN(y, k));
    }
}

static void loop_take(const modal_stride *s, int point, const double *x, const double *y,
                      const double *modal)
{
    double *drifts = s->drifts[point], *forces = s->forces[point];
    for (int k = 0; k < s->row; k += LANES) {
        const real rate = IN(s->modes->rate, k), v = IN(modal, k), force = IN(modal + s->row, k);
        OF(drifts, k) = v - IN(y, k);
        OF(forces, k) = force - IN(s->viscous, k) * v + rate * rate * IN(x, k) +
                        2 * IN(s->damping, k) * IN(y, k);
    }
    for (int k = s->count; k < s->row; k++) {
        drifts[k] = forces[k] = 0;
    }
}

// Integral of the product of two polynomials.
KERNEL real product(const real p[MODAL_NODES], const real q[MODAL_NODES], modal_weights weights)
{
    real sum = {0};
#pragma GCC unroll 6
    for (int i = 0; i < MODAL_NODES; i++) {
        real row = {0};
#pragma GCC unroll 6
        for (int j = 0; j < MODAL_NODES; j++) {
            row += weights[i][j] * q[j];
        }
        sum += p[i] * row;
    }
    return sum;
}

// Moments of modes k and on: of x, integral of t^j / j! x, and of v = x', the same.
KERNEL void moments(const modal_stride *s, int k, const double *term, const real *force,
                    const real *drift, real *of_x, real *of_v)
{
    const modal_table *at = s->ending;
    const real twice = 2 * IN(s->damping, k), start = IN(s->start, k), place = IN(s->place, k);
    real power[2 * MODAL_NODES], repeated[MODAL_NODES];
    for (int j = 0; j < 2 * MODAL_NODES; j++) {
        power[j] = IN(at->power[j], k);
    }

    // x integrated i + 1 times
#pragma GCC unroll 6
    for (int i = 0; i < MODAL_NODES; i++) {
        real sum = start * power[i];
#pragma GCC unroll 6
        for (int j = 0; j < MODAL_NODES; j++) {
            const real lower = power[i + j], higher = power[i + j + 1];
            sum += force[j] * higher + drift[j] * (lower + twice * higher);
        }
        repeated[i] = sum;
    }

    // by parts
#pragma GCC unroll 6
    for (int j = 0; j < MODAL_NODES; j++) {
        real sum = {0};
#pragma GCC unroll 6
        for (int i = 0; i <= j; i++) {
            sum += (i % 2 ? -term[j - i] : term[j - i]) * repeated[i];
        }
        of_x[j] = sum;
        of_v[j] = term[j] * place - (j > 0 ? of_x[j - 1] : (real){0});
    }
}

static void loop_losses(const modal_stride *s, modal_mode_losses *l)
{
    double term[MODAL_NODES] = {1}; // t^j / j!
    for (int j = 1; j < MODAL_NODES; j++) {
        term[j] = term[j - 1] * l->time / j;
    }

    for (int k = 0; k < s->row; k += LANES) {
        const real rate = IN(s->modes->rate, k), twice = 2 * IN(s->damping, k);
        real force[MODAL_NODES], drift[MODAL_NODES], of_x[MODAL_NODES], of_v[MODAL_NODES];
        for (int j = 0; j < MODAL_NODES; j++) {
            force[j] = IN(s->force[j], k);
            drift[j] = IN(s->drift[j], k);
        }
        moments(s, k, term, force, drift, of_x, of_v);

        // 2 a v^2, from the change of y^2 + w^2 x^2
        const real x = IN(s->place, k), y = IN(s->momenta, k), y0 = IN(s->start, k);
        real loss = -0.5 * ((y - y0) * (y + y0) + rate * rate * x * x);
#pragma GCC unroll 6
        for (int j = 0; j < MODAL_NODES; j++) {
            force[j] += twice * drift[j];
            loss += (force[j] + twice * drift[j]) * of_v[j] + rate * rate * drift[j] * of_x[j];
        }
        loss -= product(force, drift, l->weights);
        OF(l->all, k) = loss;
    }
}

// By parts: the integral of p(x) e^(zx) is sum (-1)^j (p^(j)(1) e^z - p^(j)(0)) / z^(j+1).
static double loop_series(const modal_transients *v, const double *start, const double *end,
                          int terms)
{
    real sum = {0};
    for (int k = 0; k < v->count; k += LANES) {
        const real x = -IN(v->decay, k), y = IN(v->turn, k), per = 1 / (x * x + y * y);
        const real u = x * per, w = -y * per; // 1 / z
        const real e = IN(v->end_cosine, k), s = IN(v->end_sine, k);
        real re = {0}, im = {0};
        for (int j = terms - 1; j >= 0; j--) {
            const real f = end[j] * e - start[j] - re, g = end[j] * s - im;
            re = f * u - g * w;
            im = f * w + g * u;
        }
        sum += IN(v->cosine, k) * re + IN(v->sine, k) * im;
    }
    return total(sum);
}

// Real and imaginary part of the integral of e^(zx) from 0 to 1, (e^z - 1) / z, where e^z is known.
KERNEL void growth(real x, real y, real end_x, real end_y, real *re, real *im)
{
    const real square = x * x + y * y;
    const mask small = MASK(square < (real){0} + SMALL_SQUARE);
    const real per = 1 / choose(small, (real){0} + 1, square), ex = end_x - 1;

    // near zero 1 + z/2 (1 + z/3 (1 + z/4))
    real u = 1 + x / 4, v = y / 4;
    real next = 1 + (x * u - y * v) / 3;
    v = (x * v + y * u) / 3;
    u = 1 + (x * next - y * v) / 2;
    v = (x * v + y * next) / 2;
    *re = choose(small, u, (ex * x + end_y * y) * per);
    *im = choose(small, v, (end_y * x - ex * y) * per);
}

static double loop_overlap(const modal_transients *v)
{
    real sum = {0};
    for (int i = 0; i < v->count; i++) {
        const double a = v->decay[i], b = v->turn[i], c = v->cosine[i], d = v->sine[i];
        const double end = v->end_cosine[i], end_sine = v->end_sine[i];
        for (int k = i + 1; k < v->count; k += LANES) {
            const real x = -(IN(v->decay, k) + a), turn = IN(v->turn, k);
            const real cosine = IN(v->cosine, k), sine = IN(v->sine, k);
            const real e = IN(v->end_cosine, k), s = IN(v->end_sine, k);

            // half of Re((C - iD)(C' - iD') e^(z + z')) + Re((C - iD)(C' + iD') e^(z + z'*))
            real re, im;
            growth(x, b + turn, end * e - end_sine * s, end * s + end_sine * e, &re, &im);
            real both = (c * cosine - d * sine) * re + (c * sine + d * cosine) * im;
            growth(x, b - turn, end * e + end_sine * s, end_sine * e - end * s, &re, &im);
            both += (c * cosine + d * sine) * re + (d * cosine - c * sine) * im;
            sum += both;
        }
    }
    return 0.5 * total(sum);
}

const modal_loops GLUE(modal_loops_, WIDTH) = {loop_momenta, loop_fit,    loop_leave_out, loop_take,
                                               loop_losses,  loop_series, loop_overlap};
