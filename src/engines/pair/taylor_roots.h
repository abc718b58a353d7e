// Bounds of the functions that are watched over a step (taylor_kernel.c), from their
// series, and where they first fall below zero.
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

// That of a polynomial for times from 0 to t. A function deviates from its chord of
// length h by at most h^2/8 times its largest second derivative. Rounding is allowed for.
KERNEL enclosure enclosure_of(const real *terms, int count, real t)
{
    const real zero = (real){0}, u = t * t, none = zero;
    const four time = FOUR(t * 0.25, t * 0.5, t * 0.75, t);
    const four squared = FOUR(u * 0.0625, u * 0.25, u * 0.5625, u);
    const int last = count - 1 - count % 2; // of the odd terms
    const real single = count % 2 == 0 ? zero : terms[count - 1];
    four even = FOUR(single, single, single, single), odd = FOUR(none, none, none, none);
    real even2 = count % 2 == 0 ? zero : magnitude(single) * falling[count - 1],
         odd2 = zero;
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
    c.off =
        sag * 0.0625 + 1e-12 * (sag + magnitude(c.start) + magnitude(PART(c.ends, 3)));
    return c;
}

KERNEL real smaller_of(real x, real y)
{
    return select_lanes(MASK(x < y), x, y);
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

// Lower bound of sign times a function in the first piece; where an event has left it at
// zero and it grows from there, the bound of the function divided by the time, or by its
// square: in that
// piece, of length h, p = p0 + p1 t + p2 t^2 + r has |p - p0 - p1 t| <= curvature t^2/2,
// and |r| <= (curvature - 2 |p2|) t^2/6 h/t_end.
KERNEL real least_at_first(const enclosure *c, const real *terms, real sign, real t,
                           mask jumped, const edge_limits *limits)
{
    const real first = sign * c->start - c->off;
    const real rate = sign * terms[1], more = sign * terms[2];
    const real once = rate - c->curvature * t * (0.125 * (1 + 1e-12)) - limits->rate;
    const real rest = c->curvature - 2 * magnitude(more) + 1e-12 * c->curvature;
    const real twice = more - rest * (1. / 24) - limits->more;
    const mask off_edge = MASK(magnitude(c->start) > limits->value);
    const mask leaves = MASK(magnitude(rate) > limits->rate);
    const real divided = select_lanes(leaves, once, twice);
    const real edge = select_lanes(off_edge, first - limits->value, divided);
    return select_lanes(jumped, edge, first);
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

// --- roots -----------------------------------------------------------------------------

enum { MOST_ITERATIONS = 6 }; // of Newton's method

// A function over steps of length t, positive times its sign at first: what it stays
// above in the first piece, and whether it has jumped there.
typedef struct enclosed_function {
    const real *terms;
    int count;
    const enclosure *enclosure;
    real sign, first, t;
    mask jumped;
} enclosed_function;

// The piece in which it may first be below zero, where it is so at that piece's end.
typedef struct fall {
    real from, length; // of the piece [s]
    real above, below; // at its ends
    mask there;        // whether there is one
} fall;

KERNEL fall first_enclosed_zero(const enclosed_function *f)
{
    const real zero = (real){0}, off = f->enclosure->off;
    fall found = {.from = zero,
                  .length = f->t * 0.25,
                  .above = zero + 1.0,
                  .below = zero - 1.0};
    mask all_clear = ~(mask){0};
    real start = f->sign * f->enclosure->start;
    for (int i = 0; i < 4; i++) {
        const real end = f->sign * PART(f->enclosure->ends, i);
        const mask starts = i == 0 ? MASK(f->first > 0) : MASK(start > off);
        const mask ends = i == 0 ? f->jumped | MASK(end > off) : MASK(end > off);
        const mask clear = starts & ends, edge = i == 0 ? f->jumped : (mask){0};
        const mask falls = all_clear & ~clear & ~edge & MASK(start > 0) & MASK(end < 0);
        found.from = select_lanes(falls, i * found.length, found.from);
        found.above = select_lanes(falls, start, found.above);
        found.below = select_lanes(falls, end, found.below);
        found.there |= falls;
        all_clear &= clear;
        start = end;
    }
    return found;
}

// Value and slope.
KERNEL void value_slope_at(const enclosed_function *f, real t, real *value, real *slope)
{
    const real zero = (real){0}, u = t * t;
    const int pairs = f->count - f->count % 2;
    real even = f->count % 2 == 0 ? zero : f->terms[f->count - 1];
    real odd = zero, even1 = zero, odd1 = zero; // the dashes by u
    for (int n = pairs - 1; n >= 1; n -= 2) {
        even1 = even1 * u + even;
        odd1 = odd1 * u + odd;
        even = even * u + f->terms[n - 1];
        odd = odd * u + f->terms[n];
    }
    *value = f->sign * (even + t * odd);
    *slope = f->sign * (odd + 2 * t * (even1 + t * odd1));
}

// The first instant at which it falls through zero; -1 if it is not found here. Newton's
// method, until the error of the next step is below the resolution of time. Between the
// piece's start and a root at a distance l from it the function lies at most curvature
// l^2/8 below its chord, and stays above zero if it starts above curvature l^2/2.
static __attribute__((noinline)) real first_root(const enclosed_function *f)
{
    const real zero = (real){0};
    const fall in = first_enclosed_zero(f);
    real root = zero - 1.0;
    if (!any(in.there)) {
        return root;
    }

    const real curvature = f->enclosure->curvature, to = in.from + in.length;
    const real resolution = 1e-16 + 2e-16 * to;
    real t = in.from + in.length * (in.above / (in.above - in.below));
    mask open = in.there;
    for (int i = 0; i < MOST_ITERATIONS && any(open); i++) {
        real value, slope;
        value_slope_at(f, t, &value, &slope);
        const real step = value / slope, next = t - step, way = next - in.from;
        const mask within = MASK(next > in.from) & MASK(next < to) & MASK(slope < 0);
        const mask settled =
            MASK(curvature * step * step <= resolution * magnitude(slope));
        const mask first = MASK(curvature * way * way * (0.5 + 1e-9) < in.above);
        root = select_lanes(open & settled & within & first, next, root);
        open &= ~settled & within;
        t = select_lanes(open, next, t);
    }
    return root;
}
