#include "src/base/plain_math.h"

#include <assert.h>
#include <math.h>
#include <stddef.h>

// log(2), the first part with so few bits that its product with an exponent is exact
static const double log2_high = 0x1.62e42feep-1, log2_low = 0x1.a39ef35793c76p-33;

#define LARGEST_EXPONENT  709.79
#define SMALLEST_EXPONENT (-745.2)

double plain_exp(double x)
{
    if (!(x < LARGEST_EXPONENT)) {
        return isnan(x) ? x : HUGE_VAL;
    }
    if (x < SMALLEST_EXPONENT) {
        return 0;
    }

    // x = n log(2) + r with |r| <= log(2)/2
    const double n = nearbyint(x * (1 / (log2_high + log2_low)));
    const double r = (x - n * log2_high) - n * log2_low;

    // e^r - 1 - r by its series, the terms left out below 1e-18
    static const double shares[] = {1. / 14, 1. / 13, 1. / 12, 1. / 11, 1. / 10, 1. / 9, 1. / 8,
                                    1. / 7,  1. / 6,  1. / 5,  1. / 4,  1. / 3,  1. / 2};
    double tail = 0;
    for (size_t i = 0; i < sizeof shares / sizeof shares[0]; i++) {
        tail = (tail + 1) * (r * shares[i]);
    }
    return ldexp(1 + (r + r * tail), (int)n);
}

// 2 (artanh(s) - s)/s of z = s^2 by its series, the terms left out below 1e-18 for s up to
// (sqrt(2) - 1)/(sqrt(2) + 1)
#define ARTANH_SERIES_ENDS 0.1716
static double artanh_tail(double z)
{
    static const double shares[] = {2. / 21, 2. / 19, 2. / 17, 2. / 15, 2. / 13,
                                    2. / 11, 2. / 9,  2. / 7,  2. / 5,  2. / 3};
    double tail = 0;
    for (size_t i = 0; i < sizeof shares / sizeof shares[0]; i++) {
        tail = (tail + shares[i]) * z;
    }
    return tail;
}

double plain_log(double x)
{
    assert(!(x < 0));
    if (x == 0 || !isfinite(x)) {
        return x == 0 ? -HUGE_VAL : x;
    }

    // x = 2^n m with m from sqrt(1/2) to sqrt(2)
    int n;
    double m = frexp(x, &n);
    if (m < M_SQRT1_2) {
        m *= 2;
        n--;
    }

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

    // the series, the terms left out below 1e-18
    double tail = 0;
    for (int k = 27; k >= 3; k -= 2) {
        tail = (1. / k - tail) * z;
    }
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
