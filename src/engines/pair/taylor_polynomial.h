// An event function over a step of the two-link arm, as a polynomial of the time since
// its start.
//
// Terms are taken in pairs, so that their number is even, the last one zero if need be.
#pragma once

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "src/contact/edge_limits.h"
#include "src/contact/engine.h"
#include "src/engines/pair/taylor_series.h"

enum { MOST_TERMS = TAYLOR_MOST + 2 };

typedef struct polynomial {
    double terms[MOST_TERMS]; // zeros behind the last one
    int count;                // of terms, even
    bool divided;             // by a power of the time
} polynomial;

// Takes the `count` terms, which stand `spacing` apart, each times the factor.
static inline void set_polynomial(polynomial *p, const double *terms, int spacing,
                                  int count, double factor)
{
    p->count = count + count % 2;
    p->divided = false;
    p->terms[p->count - 1] = 0;
    for (int n = 0; n < count; n++) {
        p->terms[n] = factor * terms[n * spacing];
    }
}

typedef double pair __attribute__((vector_size(16)));

typedef int64_t pair_bits __attribute__((vector_size(16)));

static inline pair magnitudes(pair x)
{
    pair_bits bits;
    memcpy(&bits, &x, sizeof bits);
    bits &= INT64_MAX;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static inline pair terms_at(const double *terms, int n)
{
    pair p;
    memcpy(&p, terms + n, sizeof p);
    return p;
}

// The pairs of terms n, n + 1 are coefficients of u = t^2, and again by turns A(v) + u
// B(v) with v = u^2: four sums side by side, as each waits long for its last term. The
// values are those of a pair of terms that are x[0] + t x[1].
typedef struct turns {
    pair even, odd; // A, B
} turns;

// Value and slope: with the dashes by v, (A + u B)' by u is 2 u A' + B + 2 v B'.
static inline value_and_slope value_and_slope_at(const double *terms, int count, double t)
{
    const double u = t * t, v = u * u;
    turns value = {{0, 0}, {0, 0}}, slope = {{0, 0}, {0, 0}};
    int n = count - 2;
    if (n % 4 == 0) {
        value.even = terms_at(terms, n);
        n -= 2;
    }
    for (; n >= 2; n -= 4) {
        slope.odd = slope.odd * v + value.odd;
        value.odd = value.odd * v + terms_at(terms, n);
        slope.even = slope.even * v + value.even;
        value.even = value.even * v + terms_at(terms, n - 2);
    }
    const pair at = value.even + u * value.odd;
    const pair by_u = value.odd + 2 * (u * slope.even + v * slope.odd);
    return (value_and_slope){at[0] + t * at[1], at[1] + 2 * t * (by_u[0] + t * by_u[1])};
}

// The largest second derivative for times from 0 to t, from the magnitudes of the terms.
static inline double curvature_bound(const polynomial *p, double t)
{
    const double u = t * t, v = u * u;
    turns bound = {{0, 0}, {0, 0}};
    int n = p->count - 2;
    if (n % 4 == 2) {
        bound.even = magnitudes(terms_at(p->terms, n)) * terms_at(falling, n);
        n -= 2;
    }
    for (; n >= 4; n -= 4) {
        bound.odd =
            bound.odd * v + magnitudes(terms_at(p->terms, n)) * terms_at(falling, n);
        bound.even = bound.even * v +
                     magnitudes(terms_at(p->terms, n - 2)) * terms_at(falling, n - 2);
    }
    const pair all = bound.even + u * bound.odd;
    return all[0] + t * all[1];
}

// Divides the function by the time once for each of its first coefficients that is only
// rounding.
static inline void deflate_root(polynomial *p, const double limits[3])
{
    const int powers = edge_powers(p->terms, limits, 1);
    if (powers > 0) {
        memmove(p->terms, p->terms + powers,
                (size_t)(p->count - powers) * sizeof(double));
        memset(p->terms + p->count - powers, 0, (size_t)powers * sizeof(double));
        p->divided = true;
    }
}
