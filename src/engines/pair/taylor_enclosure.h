// Bounds of the functions that are watched over a step (taylor_kernel.c), from their series.
#pragma once

#include "src/engines/pair/taylor_products.h"

// A function over a step, bounded in four equal pieces.
typedef struct enclosure {
    real start;
    four ends;      // its values where pieces end
    real curvature; // its largest second derivative at most
    real off;       // how far at most it leaves the chord between the ends of a piece
} enclosure;

// One more term of four sums.
KERNEL void add_term(four *sum, const four *u, real term)
{
#if LANES == 1
    *sum = *sum * *u + term;
#else
    for (int i = 0; i < 4; i++) {
        PART(*sum, i) = PART(*sum, i) * PART(*u, i) + term;
    }
#endif
}

// That of a polynomial for times from 0 to t. A function deviates from its chord of length h by at
// most h^2/8 times its largest second derivative. Rounding is allowed for.
KERNEL enclosure enclosure_of(const real *terms, int count, real t)
{
    const real zero = (real){0}, u = t * t, none = zero;
    const four time = FOUR(t * 0.25, t * 0.5, t * 0.75, t);
    const four squared = FOUR(u * 0.0625, u * 0.25, u * 0.5625, u);
    const int last = count - 1 - count % 2; // of the odd terms
    const real single = count % 2 == 0 ? zero : terms[count - 1];
    four even = FOUR(single, single, single, single), odd = FOUR(none, none, none, none);
    real even2 = count % 2 == 0 ? zero : magnitude(single) * falling[count - 1], odd2 = zero;
    for (int n = last; n >= 3; n -= 2) {
        add_term(&even, &squared, terms[n - 1]);
        add_term(&odd, &squared, terms[n]);
        even2 = even2 * u + magnitude(terms[n - 1]) * falling[n - 1];
        odd2 = odd2 * u + magnitude(terms[n]) * falling[n];
    }
    add_term(&even, &squared, terms[0]);
    add_term(&odd, &squared, terms[1]);

    enclosure c = {.start = terms[0], .curvature = even2 + t * odd2};
    for (int i = 0; i < 4; i++) {
        PART(c.ends, i) = PART(even, i) + PART(time, i) * PART(odd, i);
    }
    const real sag = c.curvature * u * 0.125;
    c.off = sag * 0.0625 + 1e-12 * (sag + magnitude(c.start) + magnitude(PART(c.ends, 3)));
    return c;
}

KERNEL real smaller_of(real x, real y)
{
    return choose(MASK(x < y), x, y);
}

// Its lower and upper bound.
KERNEL real lowest(const enclosure *c, real first)
{
    const real late = smaller_of(PART(c->ends, 2), PART(c->ends, 3)) - c->off;
    const real early = smaller_of(PART(c->ends, 0), PART(c->ends, 1)) - c->off;
    return smaller_of(first, smaller_of(early, late));
}
KERNEL real highest(const enclosure *c)
{
    const real late = greater(PART(c->ends, 2), PART(c->ends, 3));
    const real early = greater(PART(c->ends, 0), PART(c->ends, 1));
    return greater(c->start, greater(early, late)) + c->off;
}

// What is rounding in a function's first coefficients: the limits of deflate_root
// (taylor_polynomial.h).
typedef struct edge_limits {
    real value, rate, more;
} edge_limits;

// Lower bound of sign times a function in the first piece; where an event has left it at zero and
// it grows from there, the bound of the function divided by the time, or by its square: in that
// piece, of length h, p = p0 + p1 t + p2 t^2 + r has |p - p0 - p1 t| <= curvature t^2/2, and |r| <=
// (curvature - 2 |p2|) t^2/6 h/t_end.
KERNEL real least_at_first(const enclosure *c, const real *terms, real sign, real t, mask jumped,
                           const edge_limits *limits)
{
    const real first = sign * c->start - c->off;
    const real rate = sign * terms[1], more = sign * terms[2];
    const real once = rate - c->curvature * t * (0.125 * (1 + 1e-12)) - limits->rate;
    const real rest = c->curvature - 2 * magnitude(more) + 1e-12 * c->curvature;
    const real twice = more - rest * (1. / 24) - limits->more;
    const mask off_edge = MASK(magnitude(c->start) > limits->value);
    const mask leaves = MASK(magnitude(rate) > limits->rate);
    const real divided = choose(leaves, once, twice);
    const real edge = choose(off_edge, first - limits->value, divided);
    return choose(jumped, edge, first);
}

// Its lower bound over the whole step, `first` being that of the first piece.
KERNEL real least_of(const enclosure *c, real sign, real first)
{
    enclosure signed_one = *c;
    for (int i = 0; i < 4; i++) {
        PART(signed_one.ends, i) = sign * PART(c->ends, i);
    }
    return lowest(&signed_one, first);
}
