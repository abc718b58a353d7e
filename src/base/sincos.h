// Sine and cosine together, inline, from nothing but IEEE additions and multiplications.
//
// The C library's sincos costs half of a step of the two-link arm, is not inlined into vector
// loops, and picks its code (with or without fused multiply-add) by the processor, so that the last
// bit of a run would depend on the machine. This one gives the same bits everywhere.
//
// x is reduced by the nearest multiple n of pi/2, in three parts (Cody and Waite), and the minimax
// polynomials of Sun's fdlibm for |r| <= pi/4 are evaluated. Error below 2 ulp for |x| < 1e5;
// larger arguments go to the C library.
#pragma once

#include <math.h>

static inline __attribute__((always_inline)) void inline_sincos(double x, double *sine,
                                                                double *cosine)
{
    double r = x;
    int quadrant = 0;
    if (__builtin_expect(!(fabs(x) <= 0.78539816339744831), 0)) {
        if (!(fabs(x) < 1e5)) {
            sincos(x, sine, cosine);
            return;
        }
        // adding and taking away 1.5 * 2^52 rounds to a whole number
        const double round = 6755399441055744.0;
        const double n = (x * 6.36619772367581382433e-01 + round) - round;
        const double part2 = n * 6.07710050630396597660e-11;
        const double part3 = n * 2.02226624879595063154e-21;
        r = x - n * 1.57079632673412561417e+00;
        const double r_high = r - part2;
        r = r_high - (part3 - ((r - r_high) - part2));
        quadrant = (int)n & 3;
    }

    const double z = r * r, zz = z * z;
    const double s_tail = (8.33333333332248946124e-03 + z * -1.98412698298579493134e-04) +
                          zz * ((2.75573137070700676789e-06 + z * -2.50507602534068634195e-08) +
                                zz * 1.58969099521155010221e-10);
    const double s = r + z * r * (-1.66666666666666324348e-01 + z * s_tail);

    const double c_tail =
        zz * ((4.16666666666666019037e-02 + z * -1.38888888888741095749e-03) +
              zz * ((2.48015872894767294178e-05 + z * -2.75573143513906633035e-07) +
                    zz * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)));
    const double half = 0.5 * z, w = 1 - half;
    const double c = w + (((1 - w) - half) + c_tail);

    if (__builtin_expect(quadrant == 0, 1)) {
        *sine = s;
        *cosine = c;
        return;
    }
    const double a = quadrant & 1 ? c : s, b = quadrant & 1 ? s : c;
    *sine = quadrant & 2 ? -a : a;
    *cosine = (quadrant + 1) & 2 ? -b : b;
}

static inline double inline_sin(double x)
{
    double sine, cosine;
    inline_sincos(x, &sine, &cosine);
    return sine;
}

static inline double inline_cos(double x)
{
    double sine, cosine;
    inline_sincos(x, &sine, &cosine);
    return cosine;
}
