// Sine and cosine together, inline, from nothing but IEEE additions and multiplications.
//
// The C library's sincos costs half of a step of the two-link arm, is not inlined into
// vector loops, and picks its code (with or without fused multiply-add) by the processor,
// so that the last bit of a run would depend on the machine. This one gives the same bits
// everywhere.
//
// x is reduced by the nearest multiple n of pi/2, in three parts (Cody and Waite), and
// the minimax polynomials of Sun's fdlibm for |r| <= pi/4 are evaluated. Error below 2
// ulp for |x| < 1e5; larger arguments go to the C library.
#pragma once

#include <math.h>

// The three steps, for numbers as for vectors of them (taylor_numbers.h), which get the
// same bits.
//
// Added and taken away, it rounds to a whole number, whose last bits are then those of
// the sum.
#define SINCOS_ROUND 6755399441055744.0 // 1.5 * 2^52

// x times 2/pi, and x less n times pi/2.
#define SINCOS_QUARTERS(x) ((x)*6.36619772367581382433e-01)
#define SINCOS_REDUCE(real, x, n, r)                                                     \
    do {                                                                                 \
        const real part2_ = (n)*6.07710050630396597660e-11;                              \
        const real part3_ = (n)*2.02226624879595063154e-21;                              \
        const real part1_ = (x) - (n)*1.57079632673412561417e+00,                        \
                   high_ = part1_ - part2_;                                              \
        (r) = high_ - (part3_ - ((part1_ - high_) - part2_));                            \
    } while (0)

// Sine and cosine of |r| <= pi/4.
#define SINCOS_NEAR_ZERO(real, r, sine, cosine)                                          \
    do {                                                                                 \
        const real z_ = (r) * (r), zz_ = z_ * z_, half_ = 0.5 * z_, w_ = 1 - half_;      \
        const real s_tail_ =                                                             \
            (8.33333333332248946124e-03 + z_ * -1.98412698298579493134e-04) +            \
            zz_ * ((2.75573137070700676789e-06 + z_ * -2.50507602534068634195e-08) +     \
                   zz_ * 1.58969099521155010221e-10);                                    \
        const real c_tail_ =                                                             \
            zz_ *                                                                        \
            ((4.16666666666666019037e-02 + z_ * -1.38888888888741095749e-03) +           \
             zz_ * ((2.48015872894767294178e-05 + z_ * -2.75573143513906633035e-07) +    \
                    zz_ * (2.08757232129817482790e-09 +                                  \
                           z_ * -1.13596475577881948265e-11)));                          \
        (sine) = (r) + z_ * (r) * (-1.66666666666666324348e-01 + z_ * s_tail_);          \
        (cosine) = w_ + (((1 - w_) - half_) + c_tail_);                                  \
    } while (0)

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
        const double n = (SINCOS_QUARTERS(x) + SINCOS_ROUND) - SINCOS_ROUND;
        SINCOS_REDUCE(double, x, n, r);
        quadrant = (int)n & 3;
    }

    double s, c;
    SINCOS_NEAR_ZERO(double, r, s, c);
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
