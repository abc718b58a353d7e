#include "src/base/plain_math.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

// log(2), the first part with so few bits that its product with an exponent is exact
static const double log2_high = 0x1.62e42feep-1, log2_low = 0x1.a39ef35793c76p-33;

#define LARGEST_EXPONENT  709.79
#define SMALLEST_EXPONENT (-745.2)

// Exponents of two from minus to plus this are those of normal numbers.
#define NORMAL_EXPONENT 1000

// Adding and taking away this rounds to a whole number, which stands in the sum's last bits.
#define WHOLE_NUMBERS 6755399441055744.0

// c[0] + c[1] x + ... + c[11] x^11, in four sums that do not wait for each other.
static double twelve_terms(const double c[12], double x)
{
    const double x2 = x * x, x4 = x2 * x2;
    double sums[4];
    for (int i = 0; i < 4; i++) {
        sums[i] = c[i] + x4 * (c[i + 4] + x4 * c[i + 8]);
    }
    return (sums[0] + x * sums[1]) + x2 * (sums[2] + x * sums[3]);
}

double plain_exp(double x)
{
    // 2^(i/32), and log(2)/32 in two parts
    static const double roots[32] = {
        0x1.0000000000000p+0, 0x1.059b0d3158574p+0, 0x1.0b5586cf9890fp+0, 0x1.11301d0125b51p+0,
        0x1.172b83c7d517bp+0, 0x1.1d4873168b9aap+0, 0x1.2387a6e756238p+0, 0x1.29e9df51fdee1p+0,
        0x1.306fe0a31b715p+0, 0x1.371a7373aa9cbp+0, 0x1.3dea64c123422p+0, 0x1.44e086061892dp+0,
        0x1.4bfdad5362a27p+0, 0x1.5342b569d4f82p+0, 0x1.5ab07dd485429p+0, 0x1.6247eb03a5585p+0,
        0x1.6a09e667f3bcdp+0, 0x1.71f75e8ec5f74p+0, 0x1.7a11473eb0187p+0, 0x1.82589994cce13p+0,
        0x1.8ace5422aa0dbp+0, 0x1.93737b0cdc5e5p+0, 0x1.9c49182a3f090p+0, 0x1.a5503b23e255dp+0,
        0x1.ae89f995ad3adp+0, 0x1.b7f76f2fb5e47p+0, 0x1.c199bdd85529cp+0, 0x1.cb720dcef9069p+0,
        0x1.d5818dcfba487p+0, 0x1.dfc97337b9b5fp+0, 0x1.ea4afa2a490dap+0, 0x1.f50765b6e4540p+0};
    const double part_high = 0x1.62e42fep-6, part_low = 0x1.f473de6af278fp-35;

    if (!(x < LARGEST_EXPONENT)) {
        return isnan(x) ? x : HUGE_VAL;
    }
    if (x < SMALLEST_EXPONENT) {
        return 0;
    }

    // x = n log(2)/32 + r with |r| <= log(2)/64
    const double shifted = x * 0x1.71547652b82fep+5 + WHOLE_NUMBERS, n = shifted - WHOLE_NUMBERS;
    const double r = (x - n * part_high) - n * part_low, rr = r * r;

    // e^r - 1 by its series, the terms left out below 1e-17
    const double rest =
        r + rr * ((0.5 + r * (1. / 6)) + rr * ((1. / 24 + r * (1. / 120)) + rr * (1. / 720)));
    const int whole = (int)n, power = (whole - (whole & 31)) / 32;
    const double root = roots[whole & 31], value = root + root * rest;
    if (power < -NORMAL_EXPONENT || power > NORMAL_EXPONENT) {
        return ldexp(value, power);
    }

    // times 2^power
    const uint64_t bits = (uint64_t)(power + (DBL_MAX_EXP - 1)) << (DBL_MANT_DIG - 1);
    double scale;
    memcpy(&scale, &bits, sizeof scale);
    return value * scale;
}

// 2 (artanh(s) - s)/s of z = s^2 by its series, the terms left out below 1e-18 for s up to
// (sqrt(2) - 1)/(sqrt(2) + 1)
#define ARTANH_SERIES_ENDS 0.1716
static double artanh_tail(double z)
{
    static const double shares[12] = {2. / 3,  2. / 5,  2. / 7,  2. / 9,  2. / 11, 2. / 13,
                                      2. / 15, 2. / 17, 2. / 19, 2. / 21, 2. / 23, 2. / 25};
    return z * twelve_terms(shares, z);
}

// The exponent n of a number x = 2^n m above zero, and m from sqrt(1/2) to sqrt(2).
static int split_number(double x, double *m)
{
    // one that is not normal has fewer digits
    if (x < DBL_MIN) {
        return split_number(x * 0x1p54, m) - 54;
    }

    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int n = (int)(bits >> (DBL_MANT_DIG - 1)) - (DBL_MAX_EXP - 1);
    bits -= (uint64_t)n << (DBL_MANT_DIG - 1);
    memcpy(m, &bits, sizeof *m);
    if (*m > M_SQRT2) {
        *m /= 2;
        n++;
    }
    return n;
}

double plain_log(double x)
{
    assert(!(x < 0));
    if (x == 0 || !isfinite(x)) {
        return x == 0 ? -HUGE_VAL : x;
    }

    // x = 2^n m
    double m;
    const int n = split_number(x, &m);

    // log(m) = 2 artanh(s), s = f/(2 + f): f - s (f - tail), as f is exact and s is not
    const double f = m - 1, s = f / (2 + f);
    return n * log2_high + (f - (s * (f - artanh_tail(s * s)) - n * log2_low));
}

double plain_pow(double x, double y)
{
    assert(x >= 0);
    return y == 0 ? 1 : plain_exp(y * plain_log(x));
}

double plain_sinh(double x)
{
    const double size = fabs(x);
    if (size > 1) {
        const double half = plain_exp(size) / 2;
        return copysign(isinf(half) ? half : half - 0.25 / half, x);
    }

    // its series, as the difference of exponentials would lose digits
    double tail = 0;
    for (int k = 19; k >= 3; k -= 2) {
        tail = (1 + tail) * (x * x / (k * (k - 1)));
    }
    return x + x * tail;
}

double plain_cosh(double x)
{
    const double half = plain_exp(fabs(x)) / 2;
    return isinf(half) ? half : half + 0.25 / half;
}

double plain_atanh(double x)
{
    assert(fabs(x) < 1);
    if (fabs(x) < ARTANH_SERIES_ENDS) {
        return x + x * artanh_tail(x * x) / 2;
    }
    return copysign(plain_log((1 + fabs(x)) / (1 - fabs(x))) / 2, x);
}

// Arctangent of `low`/`high`, 0 <= low <= high, high > 0.
static double arctangent(double low, double high)
{
    // turned back by one of three angles, so that what is left has a tangent of at most 1/4
    static const double tangents[] = {0, 0.5, 1};
    static const double angles[] = {0, 0x1.dac670561bb4fp-2, 0x1.921fb54442d18p-1};
    static const double rests[] = {0, 0x1.a2b7f222f65e2p-56, 0x1.1a62633145c07p-55};
    const int at = low < 0.25 * high ? 0 : low < 0.75 * high ? 1 : 2;
    const double t = (low - tangents[at] * high) / (high + tangents[at] * low), z = t * t;

    // the series, the terms left out below 1e-17
    static const double shares[12] = {1. / 3,  -1. / 5,  1. / 7,  -1. / 9,  1. / 11, -1. / 13,
                                      1. / 15, -1. / 17, 1. / 19, -1. / 21, 1. / 23, -1. / 25};
    const double tail = z * twelve_terms(shares, z);
    return angles[at] + (t - (t * tail - rests[at]));
}

double plain_atan2(double y, double x)
{
    assert(isfinite(x) && isfinite(y));
    const double across = fabs(y), along = fabs(x), largest = fmax(across, along);
    if (largest == 0) {
        return 0;
    }

    // in the first quadrant, then mirrored
    double angle = across <= along
                       ? arctangent(across, along)
                       : 0x1.921fb54442d18p+0 - (arctangent(along, across) - 0x1.1a62633145c07p-54);
    if (x < 0) {
        angle = 0x1.921fb54442d18p+1 - (angle - 0x1.1a62633145c07p-53);
    }
    return copysign(angle, y);
}
