#include "src/solve/modal_response.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "src/base/sincos.h"

enum { SERIES_TERMS = 30 };

// 1/i.
static const double reciprocal[] = {
    0,       1,       1. / 2,  1. / 3,  1. / 4,  1. / 5,  1. / 6,  1. / 7,  1. / 8,  1. / 9,
    1. / 10, 1. / 11, 1. / 12, 1. / 13, 1. / 14, 1. / 15, 1. / 16, 1. / 17, 1. / 18, 1. / 19,
    1. / 20, 1. / 21, 1. / 22, 1. / 23, 1. / 24, 1. / 25, 1. / 26, 1. / 27, 1. / 28, 1. / 29,
    1. / 30, 1. / 31, 1. / 32, 1. / 33, 1. / 34, 1. / 35, 1. / 36, 1. / 37, 1. / 38, 1. / 39,
    1. / 40, 1. / 41, 1. / 42, 1. / 43, 1. / 44, 1. / 45, 1. / 46, 1. / 47, 1. / 48, 1. / 49};

double modal_decay(double x)
{
    if (x == 0 || x < -700) {
        return x == 0 ? 1 : 0;
    }

    const double ln2_high = 6.93147180369123816490e-01, ln2_low = 1.90821492927058770002e-10;
    const double n = floor(x * 1.44269504088896338700 + 0.5);
    const double r = (x - n * ln2_high) - n * ln2_low;

    // even and odd powers of r side by side, times 1/i!
    static const double even[] = {1,          1. / 2,       1. / 24,        1. / 720,
                                  1. / 40320, 1. / 3628800, 1. / 479001600, 1. / 87178291200};
    static const double odd[] = {1,           1. / 6,        1. / 120,       1. / 5040,
                                 1. / 362880, 1. / 39916800, 1. / 6227020800};
    const double square = r * r;
    double evens = even[7] * square + even[6], odds = odd[6];
    for (int i = 5; i >= 0; i--) {
        evens = evens * square + even[i];
        odds = odds * square + odd[i];
    }
    const double sum = evens + r * odds;

    // times 2^n, no less than 2^-1010
    const uint64_t bits = (uint64_t)((int)n + 1023) << 52;
    double scale;
    memcpy(&scale, &bits, sizeof scale);
    return sum * scale;
}

// Small t: powers of t. g_m = -2 a g_{m-1} - w^2 g_{m-2} are the derivatives of G at 0. The two
// highest of F by F_j = t^(j+2) sum g_m t^m / (j + m + 2)!, the others downwards, where nothing
// cancels: F_{j-2} = t^j / j! - 2 a F_{j-1} - w^2 F_j.
static void respond_by_series(double a, double w, double t, int powers, modal_response *r)
{
    // the derivatives, scaled: g_m t^m
    const double p = -2 * a * t, q = -w * w * t * t;
    double g[SERIES_TERMS + 1];
    g[0] = 1;
    g[1] = p;
    for (int i = 2; i <= SERIES_TERMS; i++) {
        g[i] = p * g[i - 1] + q * g[i - 2];
    }

    // t^j / j!
    double term[MODAL_POWERS + 2];
    term[0] = 1;
    for (int j = 1; j < powers + 2; j++) {
        term[j] = term[j - 1] * t * reciprocal[j];
    }

    // f[j + 2] = F_j, with F_-1 = G and F_-2 = G'
    double f[MODAL_POWERS + 2];
    const int top = powers - 1;
    for (int j = top - 1; j <= top; j++) {
        double sum = 0;
        for (int i = SERIES_TERMS; i >= 0; i--) {
            sum = g[i] + sum * reciprocal[j + i + 3];
        }
        f[j + 2] = term[j + 2] * sum;
    }
    for (int j = top; j >= 0; j--) {
        f[j] = term[j] - 2 * a * f[j + 1] - w * w * f[j + 2];
    }

    r->impulse_rate = f[0];
    r->impulse = f[1];
    for (int j = 0; j < powers; j++) {
        r->power[j] = f[j + 2];
    }
}

// From G and G' upwards: w^2 F_j = t^j / j! - 2 a F_{j-1} - F_{j-2}.
static void climb(double a, double w, double t, int powers, modal_response *r)
{
    const double per = 1 / (w * w);
    double lower = r->impulse_rate, last = r->impulse, term = 1;
    for (int j = 0; j < powers; j++) {
        double f = (term - 2 * a * last - lower) * per;
        r->power[j] = f;
        lower = last;
        last = f;
        term *= t / (j + 1);
    }
}

// t^k phi_k(x t) for x <= 0, k = 0..count - 1: phi_0 = e^z, phi_{k+1} = (phi_k - 1/k!) / z.
static void phi(double x, double t, int count, double *out)
{
    const double z = x * t;

    // near zero the highest by its series, the others downwards: t^k / k! + x t^k+1 phi_k+1
    if (z > -2) {
        double scale[MODAL_POWERS + 2] = {1}, sum = 0;
        for (int k = 1; k < count; k++) {
            scale[k] = scale[k - 1] * t * reciprocal[k];
        }
        for (int i = SERIES_TERMS; i >= 0; i--) {
            sum = 1 + sum * z * reciprocal[count + i];
        }
        out[count - 1] = scale[count - 1] * sum;
        for (int k = count - 2; k >= 0; k--) {
            out[k] = scale[k] + x * out[k + 1];
        }
        return;
    }

    double term = 1;
    out[0] = modal_decay(z);
    for (int k = 1; k < count; k++) {
        out[k] = (out[k - 1] - term) / x;
        term *= t / k;
    }
}

void modal_respond(double a, double w, double t, int powers, modal_response *r)
{
    // slow against t
    if (w * t <= 4 && a * t <= 1) {
        respond_by_series(a, w, t, powers, r);
        return;
    }

    // vibrating
    if (a <= w) {
        double rate = sqrt((w - a) * (w + a)), s, c, e = modal_decay(-a * t);
        inline_sincos(rate * t, &s, &c);
        double sine = rate * t > 1e-4 ? s / rate : t;
        r->impulse = e * sine;
        r->impulse_rate = e * (c - a * sine);
        climb(a, w, t, powers, r);
        return;
    }

    // overdamped: two decays
    const double root = sqrt((a - w) * (a + w));
    const double slow = -w * w / (a + root), fast = -(a + root), per = 1 / (slow - fast);
    double one[MODAL_POWERS + 2], two[MODAL_POWERS + 2];
    phi(slow, t, powers + 2, one);
    phi(fast, t, powers + 2, two);
    r->impulse = (one[0] - two[0]) * per;
    r->impulse_rate = (slow * one[0] - fast * two[0]) * per;
    for (int j = 0; j < powers; j++) {
        r->power[j] = (one[j + 1] - two[j + 1]) * per;
    }
}
