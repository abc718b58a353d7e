// Where functions that are watched over a step (taylor_enclosure.h) first fall below zero.
#pragma once

#include "src/engines/pair/taylor_enclosure.h"

enum { MOST_ITERATIONS = 6 }; // of Newton's method

// A function over steps of length t, positive times its sign at first: what it stays above in
// the first piece, and whether it has jumped there.
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

KERNEL fall first_zero_crossing(const enclosed_function *f)
{
    const real zero = (real){0}, off = f->enclosure->off;
    fall found = {.from = zero, .length = f->t * 0.25, .above = zero + 1.0, .below = zero - 1.0};
    mask all_clear = ~(mask){0};
    real start = f->sign * f->enclosure->start;
    for (int i = 0; i < 4; i++) {
        const real end = f->sign * PART(f->enclosure->ends, i);
        const mask starts = i == 0 ? MASK(f->first > 0) : MASK(start > off);
        const mask ends = i == 0 ? f->jumped | MASK(end > off) : MASK(end > off);
        const mask clear = starts & ends, edge = i == 0 ? f->jumped : (mask){0};
        const mask falls = all_clear & ~clear & ~edge & MASK(start > 0) & MASK(end < 0);
        found.from = choose(falls, i * found.length, found.from);
        found.above = choose(falls, start, found.above);
        found.below = choose(falls, end, found.below);
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

// The first instant at which it falls through zero; -1 if it is not found here. Newton's method,
// until the error of the next step is below the resolution of time. Between the piece's start and a
// root at a distance l from it the function lies at most curvature l^2/8 below its chord, and stays
// above zero if it starts above curvature l^2/2.
static __attribute__((noinline)) real first_root(const enclosed_function *f)
{
    const real zero = (real){0};
    const fall in = first_zero_crossing(f);
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
        const mask settled = MASK(curvature * step * step <= resolution * magnitude(slope));
        const mask first = MASK(curvature * way * way * (0.5 + 1e-9) < in.above);
        root = choose(open & settled & within & first, next, root);
        open &= ~settled & within;
        t = choose(open, next, t);
    }
    return root;
}
