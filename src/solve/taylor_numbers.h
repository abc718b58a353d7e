// Numbers in vectors of LANES (a power of two, given by whoever includes this): those of the
// compiler. Every operation is written out in its order, without a branch on what a lane holds but
// where all take the same value from both ways, so that all widths give the same bits.
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "src/solve/taylor_series.h"

#define GLUE_(a, b) a##b
#define GLUE(a, b)  GLUE_(a, b)
#define KERNEL      static inline __attribute__((always_inline))

#if LANES == 1
typedef double real;
typedef int64_t mask;
#define MASK(condition) ((condition) ? (mask)-1 : (mask)0)
#else
typedef double real __attribute__((vector_size(8 * LANES)));
typedef int64_t mask __attribute__((vector_size(8 * LANES)));
#define MASK(condition) ((mask)(condition))
#endif

// 1/n
static const double inverse[TAYLOR_MOST + 2] = {
    0,       1,       1. / 2,  1. / 3,  1. / 4,  1. / 5,  1. / 6,  1. / 7,  1. / 8,
    1. / 9,  1. / 10, 1. / 11, 1. / 12, 1. / 13, 1. / 14, 1. / 15, 1. / 16, 1. / 17,
    1. / 18, 1. / 19, 1. / 20, 1. / 21, 1. / 22, 1. / 23, 1. / 24, 1. / 25};

// n (n - 1)
static const double falling[TAYLOR_MOST + 2] = {0,   0,   2,   6,   12,  20,  30,  42,  56,
                                                72,  90,  110, 132, 156, 182, 210, 240, 272,
                                                306, 342, 380, 420, 462, 506, 552, 600};

KERNEL mask bits_of(real x)
{
    mask m;
    memcpy(&m, &x, sizeof m);
    return m;
}

KERNEL real real_of(mask m)
{
    real x;
    memcpy(&x, &m, sizeof x);
    return x;
}

KERNEL real choose(mask where, real yes, real no)
{
    return real_of((where & bits_of(yes)) | (~where & bits_of(no)));
}

KERNEL real magnitude(real x)
{
    return real_of(bits_of(x) & INT64_MAX);
}

KERNEL real greater(real x, real y)
{
    return choose(MASK(x > y), x, y);
}

KERNEL bool any(mask m)
{
#if LANES == 1
    return m != 0;
#else
    int64_t some = 0;
    for (int i = 0; i < LANES; i++) {
        some |= m[i];
    }
    return some != 0;
#endif
}

// inline_sincos (src/base/sincos.h) to the last bit, for |x| < 1e5.
KERNEL void sine_cosine(real x, real *sine, real *cosine)
{
    real r = x;
    mask quadrant = (mask){0};
    const mask large = ~MASK(magnitude(x) <= 0.78539816339744831);
    const bool reduced = any(large);
    if (reduced) {
        // adding and taking away 1.5 * 2^52 rounds to a whole number
        const real shifted = x * 6.36619772367581382433e-01 + 6755399441055744.0;
        const real n = choose(large, shifted - 6755399441055744.0, (real){0});
        const real part2 = n * 6.07710050630396597660e-11;
        const real part3 = n * 2.02226624879595063154e-21;
        quadrant = large & bits_of(shifted) & 3;
        r = x - n * 1.57079632673412561417e+00;
        const real high = r - part2;
        r = choose(large, high - (part3 - ((r - high) - part2)), x);
    }

    const real z = r * r, zz = z * z;
    const real s_tail = (8.33333333332248946124e-03 + z * -1.98412698298579493134e-04) +
                        zz * ((2.75573137070700676789e-06 + z * -2.50507602534068634195e-08) +
                              zz * 1.58969099521155010221e-10);
    const real s = r + z * r * (-1.66666666666666324348e-01 + z * s_tail);

    const real c_tail =
        zz * ((4.16666666666666019037e-02 + z * -1.38888888888741095749e-03) +
              zz * ((2.48015872894767294178e-05 + z * -2.75573143513906633035e-07) +
                    zz * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)));
    const real half = 0.5 * z, w = 1 - half;
    const real c = w + (((1 - w) - half) + c_tail);

    *sine = s;
    *cosine = c;
    if (reduced) {
        const mask odd = -(quadrant & 1), lower = -((quadrant >> 1) & 1);
        const mask left = -(((quadrant + 1) >> 1) & 1);
        const real a = choose(odd, c, s), b = choose(odd, s, c);
        *sine = choose(lower, -a, a);
        *cosine = choose(left, -b, b);
    }
}
