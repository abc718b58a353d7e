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

double plain_log(double x)
{
    assert(x >= 0);
    if (x == 0 || isinf(x)) {
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
    const double f = m - 1, s = f / (2 + f), z = s * s;
    static const double shares[] = {2. / 21, 2. / 19, 2. / 17, 2. / 15, 2. / 13,
                                    2. / 11, 2. / 9,  2. / 7,  2. / 5,  2. / 3};
    double tail = 0;
    for (size_t i = 0; i < sizeof shares / sizeof shares[0]; i++) {
        tail = (tail + shares[i]) * z;
    }
    return n * log2_high + (f - (s * (f - tail) - n * log2_low));
}

double plain_pow(double x, double y)
{
    assert(x >= 0);
    return y == 0 ? 1 : plain_exp(y * plain_log(x));
}
