// A watched function over a stride of the two-link arm, as a polynomial of the time since its
// start.
//
// With u = t^2 it is E(u) + t O(u), its even and its odd terms, which Horner's rule takes side by
// side. So the number of terms is even, the last one zero if need be.
#pragma once

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "src/solve/engine.h"
#include "src/solve/taylor_series.h"

enum { MOST_TERMS = TAYLOR_MOST + 2 };

typedef struct polynomial {
    double terms[MOST_TERMS]; // zeros behind the last one
    int count;                // of terms, even
    bool divided;             // by a power of the time
} polynomial;

// Takes the `count` terms, which stand `spacing` apart, each times the factor.
static inline void set_polynomial(polynomial *p, const double *terms, int spacing, int count,
                                  double factor)
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

// p' = O + 2 t (E' + t O'), the dashes on the right by u.
static inline glance glance_at(const double *terms, int count, double t)
{
    const double u = t * t;
    pair value = terms_at(terms, count - 2), slope = {0, 0};
    for (int n = count - 4; n >= 0; n -= 2) {
        slope = slope * u + value;
        value = value * u + terms_at(terms, n);
    }
    return (glance){value[0] + t * value[1], value[1] + 2 * t * (slope[0] + t * slope[1])};
}

// The largest second derivative for times from 0 to t, from the magnitudes of the terms.
static inline double bend_of(const polynomial *p, double t)
{
    const double u = t * t;
    pair bound = {0, 0};
    for (int n = p->count - 2; n >= 2; n -= 2) {
        bound = bound * u + magnitudes(terms_at(p->terms, n)) * terms_at(falling, n);
    }
    return bound[0] + t * bound[1];
}

// What the function stays above for times from 0 to t: its straight part is least at an end, what
// bends it takes a little more than the sum of its terms' magnitudes at most.
static inline double low_of(const polynomial *p, double t)
{
    const double u = t * t, *terms = p->terms;
    pair sum = {0, 0};
    for (int n = p->count - 2; n >= 2; n -= 2) {
        sum = sum * u + magnitudes(terms_at(terms, n));
    }
    sum *= u;
    const double bent = sum[0] + t * sum[1];
    const double straight = terms[0] + t * terms[1];
    return fmin(terms[0], straight) - ((bent + fabs(terms[0]) + fabs(terms[1]) * t) * 1e-12 + bent);
}

// Divides the function by the time as often as its first coefficients are nothing but rounding,
// below the limits.
static inline void leave_edge(polynomial *p, const double limits[3])
{
    int edge = 0;
    while (edge < 3 && fabs(p->terms[edge]) <= limits[edge]) {
        edge++;
    }

    // falling to its edge rather than from it, it is left as it is: its root is what matters; nor
    // is a rate or an acceleration rounding that speaks against falling at once
    if (edge > 0 && p->terms[edge] < 0) {
        edge = p->terms[0] > 0 ? 0 : p->terms[edge - 1] > 0 ? edge - 1 : edge;
    }

    if (edge > 0) {
        memmove(p->terms, p->terms + edge, (size_t)(p->count - edge) * sizeof(double));
        memset(p->terms + p->count - edge, 0, (size_t)edge * sizeof(double));
        p->divided = true;
    }
}
