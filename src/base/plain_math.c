#include "src/base/plain_math.h"

#include <assert.h>
#include <float.h>
#include <math.h>

// log(2), the first part with so few bits that its product with an exponent is exact
static const double log2_high = 0x1.62e42feep-1, log2_low = 0x1.a39ef35793c76p-33;

#define LARGEST_EXPONENT  709.79
#define SMALLEST_EXPONENT (-745.2)

// Exponents of two from minus to plus this are those of normal numbers.
#define NORMAL_EXPONENT 1000

// Adding and taking away this rounds to a whole number, which stands in the sum's last
// bits.
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
        0x1.0000000000000p+0, 0x1.059b0d3158574p+0, 0x1.0b5586cf9890fp+0,
        0x1.11301d0125b51p+0, 0x1.172b83c7d517bp+0, 0x1.1d4873168b9aap+0,
        0x1.2387a6e756238p+0, 0x1.29e9df51fdee1p+0, 0x1.306fe0a31b715p+0,
        0x1.371a7373aa9cbp+0, 0x1.3dea64c123422p+0, 0x1.44e086061892dp+0,
        0x1.4bfdad5362a27p+0, 0x1.5342b569d4f82p+0, 0x1.5ab07dd485429p+0,
        0x1.6247eb03a5585p+0, 0x1.6a09e667f3bcdp+0, 0x1.71f75e8ec5f74p+0,
        0x1.7a11473eb0187p+0, 0x1.82589994cce13p+0, 0x1.8ace5422aa0dbp+0,
        0x1.93737b0cdc5e5p+0, 0x1.9c49182a3f090p+0, 0x1.a5503b23e255dp+0,
        0x1.ae89f995ad3adp+0, 0x1.b7f76f2fb5e47p+0, 0x1.c199bdd85529cp+0,
        0x1.cb720dcef9069p+0, 0x1.d5818dcfba487p+0, 0x1.dfc97337b9b5fp+0,
        0x1.ea4afa2a490dap+0, 0x1.f50765b6e4540p+0};
    const double part_high = 0x1.62e42fep-6, part_low = 0x1.f473de6af278fp-35;

    if (!(x < LARGEST_EXPONENT)) {
        if (isnan(x)) {
            return x;
        }
        return HUGE_VAL;
    }
    if (x < SMALLEST_EXPONENT) {
        return 0;
    }

    // x = n log(2)/32 + r with |r| <= log(2)/64
    const double shifted = x * 0x1.71547652b82fep+5 + WHOLE_NUMBERS,
                 n = shifted - WHOLE_NUMBERS;
    const double r = (x - n * part_high) - n * part_low, rr = r * r;

    // e^r - 1 by its series, the terms left out below 1e-17
    const double rest = r + rr * ((0.5 + r * (1. / 6)) +
                                  rr * ((1. / 24 + r * (1. / 120)) + rr * (1. / 720)));
    const int whole = (int)n, power = (whole - (whole & 31)) / 32;
    const double root = roots[whole & 31], value = root + root * rest;
    if (power < -NORMAL_EXPONENT || power > NORMAL_EXPONENT) {
        return ldexp(value, power);
    }

    // times 2^power
    return value *
           double_of_bits((uint64_t)(power + (DBL_MAX_EXP - 1)) << (DBL_MANT_DIG - 1));
}

// The exponent n of a number x = 2^n m above zero, and m, above sqrt(1/2) and up to
// sqrt(2).
static int split_number(double x, double *m)
{
    // one that is not normal has fewer digits
    if (x < DBL_MIN) {
        return split_number(x * 0x1p54, m) - 54;
    }

    // counted from the number behind sqrt(1/2) exponents are what they are to be
    const int64_t least = (int64_t)double_bits(M_SQRT1_2) + 1,
                  bits = (int64_t)double_bits(x);
    const int64_t n = (bits - least) >> (DBL_MANT_DIG - 1);
    *m = double_of_bits((uint64_t)bits - ((uint64_t)n << (DBL_MANT_DIG - 1)));
    return (int)n;
}

// For c of few digits near 64/i: -log(c) in two parts, the first one so short that its
// sum with a multiple of log2_high is exact.
enum { FIRST_SHARE = 45 };
static const struct {
    double share, high, low;
} logarithms[] = {{0x1.6c0p+0, -0x1.686c81e9b1000p-2, -0x1.2bb110af84054p-44},
                  {0x1.640p+0, -0x1.51aad872e0000p-2, 0x1.f4bd8db0a7cc1p-44},
                  {0x1.5d0p+0, -0x1.3d54fa5c1f000p-2, -0x1.c3e1cd9a395e3p-44},
                  {0x1.550p+0, -0x1.2596010df7000p-2, -0x1.8e7bc224ea3e3p-44},
                  {0x1.4e0p+0, -0x1.1058bf9ae5000p-2, 0x1.4ab9d817d52cdp-44},
                  {0x1.480p+0, -0x1.fb9186d5e4000p-3, 0x1.d572aab993c87p-47},
                  {0x1.410p+0, -0x1.cf6354e09c000p-3, -0x1.771239a07d55bp-45},
                  {0x1.3b0p+0, -0x1.a8becfc882000p-3, -0x1.e3185cf21b9cfp-44},
                  {0x1.350p+0, -0x1.815c0a1436000p-3, 0x1.02a52f9201ce8p-44},
                  {0x1.2f0p+0, -0x1.59338d9982000p-3, -0x1.0ba68b7555d4ap-48},
                  {0x1.2a0p+0, -0x1.371fc201e8000p-3, -0x1.ee8779b2d8abcp-44},
                  {0x1.250p+0, -0x1.1478584674000p-3, -0x1.563451027c750p-46},
                  {0x1.1f0p+0, -0x1.d4313d66cc000p-4, 0x1.9454379135713p-45},
                  {0x1.1a0p+0, -0x1.8c345d6318000p-4, -0x1.b20f5acb42a66p-44},
                  {0x1.160p+0, -0x1.51b073f060000p-4, -0x1.83f69278e686ap-44},
                  {0x1.110p+0, -0x1.0759835990000p-4, 0x1.b8ecfe4b59987p-44},
                  {0x1.0d0p+0, -0x1.95c830ec90000p-5, 0x1.c148297c5feb8p-45},
                  {0x1.080p+0, -0x1.f829b0e780000p-6, -0x1.980267c7e09e4p-45},
                  {0x1.040p+0, -0x1.fc0a8b0fc0000p-7, -0x1.f1e7cf6d3a69cp-50},
                  {0x1.000p+0, 0, 0},
                  {0x1.f80p-1, 0x1.0205658930000p-6, 0x1.611d27c8e8417p-44},
                  {0x1.f00p-1, 0x1.0415d89e78000p-5, -0x1.dddc7f461c516p-44},
                  {0x1.ea0p-1, 0x1.67c94f2d48000p-5, 0x1.dac20827cca0cp-44},
                  {0x1.e20p-1, 0x1.eea31c0068000p-5, 0x1.c3dd83606d891p-44},
                  {0x1.da0p-1, 0x1.3bdf5a7d20000p-4, -0x1.19bd0ad125895p-44},
                  {0x1.d40p-1, 0x1.700d30aeac000p-4, 0x1.c1e8da99ded32p-49},
                  {0x1.ce0p-1, 0x1.a4e7640b1c000p-4, -0x1.e42b6b94407c8p-47},
                  {0x1.c80p-1, 0x1.da72763844000p-4, 0x1.a89401fa71733p-46},
                  {0x1.c00p-1, 0x1.1178e8227e000p-3, 0x1.1ef78ce2d07f2p-45},
                  {0x1.ba0p-1, 0x1.2d1610c868000p-3, 0x1.39d6ccb81b4a1p-47},
                  {0x1.b40p-1, 0x1.4913d8333c000p-3, -0x1.53e43558124c4p-44},
                  {0x1.b00p-1, 0x1.5bf406b544000p-3, -0x1.27023eb68981cp-46},
                  {0x1.aa0p-1, 0x1.7898d85444000p-3, 0x1.8e67be3dbaf3fp-44},
                  {0x1.a40p-1, 0x1.95a5adcf70000p-3, 0x1.7f22858a0ff6fp-47},
                  {0x1.9e0p-1, 0x1.b31d8575bc000p-3, 0x1.c794e562a63cbp-44},
                  {0x1.9a0p-1, 0x1.c6ffbc6f00000p-3, 0x1.ee138d3a69d43p-44},
                  {0x1.940p-1, 0x1.e530effe72000p-3, -0x1.fdbdbb13f7c18p-44},
                  {0x1.900p-1, 0x1.f991c6cb3c000p-3, -0x1.90d04cd7cc834p-44},
                  {0x1.8a0p-1, 0x1.0c42d67616000p-2, 0x1.7188b163ceae9p-45},
                  {0x1.860p-1, 0x1.16b5ccbad0000p-2, -0x1.23299042d74bfp-44},
                  {0x1.820p-1, 0x1.214456d0ec000p-2, -0x1.caf0428b728a3p-44},
                  {0x1.7e0p-1, 0x1.2bef07cdc9000p-2, 0x1.a9cfa4a5004f4p-45},
                  {0x1.780p-1, 0x1.3c25277333000p-2, 0x1.83b54b606bd5cp-46},
                  {0x1.740p-1, 0x1.4718dc271c000p-2, 0x1.06c18fb4c14c5p-44},
                  {0x1.700p-1, 0x1.522ae0738a000p-2, 0x1.ebe708164c759p-45},
                  {0x1.6c0p-1, 0x1.5d5bddf596000p-2, -0x1.a0b2a08a465dcp-47},
                  {0x1.680p-1, 0x1.68ac83e9c7000p-2, -0x1.7af966c548a30p-44}};

double plain_log(double x)
{
    assert(!(x < 0));
    if (x == 0 || !isfinite(x)) {
        if (x == 0) {
            return -HUGE_VAL;
        }
        return x;
    }

    // x = 2^n m, and m c = 1 + f, where f is small; each part of m times c is exact
    double m;
    const int n = split_number(x, &m), i = (int)(m * 64 + 0.5) - FIRST_SHARE;
    const double c = logarithms[i].share;
    const double upper = double_of_bits(double_bits(m) & ~UINT64_C(0x7ffffff));
    const double f = (upper * c - 1) + (m - upper) * c, ff = f * f, f4 = ff * ff;

    // log(1 + f) by its series, the terms left out below 1e-19
    const double tail = ((-1. / 2 + f * (1. / 3)) + ff * (-1. / 4 + f * (1. / 5))) +
                        f4 * ((-1. / 6 + f * (1. / 7)) + ff * (-1. / 8 + f * (1. / 9)));
    const double low = n * log2_low + logarithms[i].low;
    return (n * log2_high + logarithms[i].high) + (f + (ff * tail + low));
}

double plain_pow(double x, double y)
{
    assert(x >= 0);
    if (y == 0) {
        return 1;
    }
    return plain_exp(y * plain_log(x));
}

// Arctangent of `low`/`high`, 0 <= low <= high, high > 0.
static double arctangent(double low, double high)
{
    // turned back by one of three angles, so that what is left has a tangent of at most
    // 1/4
    static const double tangents[] = {0, 0.5, 1};
    static const double angles[] = {0, 0x1.dac670561bb4fp-2, 0x1.921fb54442d18p-1};
    static const double rests[] = {0, 0x1.a2b7f222f65e2p-56, 0x1.1a62633145c07p-55};
    int at = 0;
    if (!(low < 0.25 * high)) {
        if (low < 0.75 * high) {
            at = 1;
        } else {
            at = 2;
        }
    }
    const double t = (low - tangents[at] * high) / (high + tangents[at] * low), z = t * t;

    // the series, the terms left out below 1e-17
    static const double shares[12] = {1. / 3,  -1. / 5,  1. / 7,  -1. / 9,
                                      1. / 11, -1. / 13, 1. / 15, -1. / 17,
                                      1. / 19, -1. / 21, 1. / 23, -1. / 25};
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
    double angle;
    if (across <= along) {
        angle = arctangent(across, along);
    } else {
        angle =
            0x1.921fb54442d18p+0 - (arctangent(along, across) - 0x1.1a62633145c07p-54);
    }
    if (x < 0) {
        angle = 0x1.921fb54442d18p+1 - (angle - 0x1.1a62633145c07p-53);
    }
    return copysign(angle, y);
}
