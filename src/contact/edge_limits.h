// Rounding at the start of an event function (engine.h): just after an event it may start
// at zero, and its first coefficients are then only known to be small.
#pragma once

#include <math.h>

// Limits on the magnitudes of its value and of its first and second derivatives by time
// below which they count as rounding.
#define EDGE_VALUE 1e-9
#define EDGE_RATE  1e-9
#define EDGE_MORE  1e-7
#define EDGE_GAP   1e-12 // of the gap's value [m]
#define EDGE_PLACE 1e-15 // what a place of the arm is known to [m]

// Depth in the wall, by truncation of the preceding series, at which an arm may still be
// found that leaves it.
#define EDGE_DEPTH 1e-6 // [m]

// By how many powers of the time a function may be divided, 0 to 3: the number of its
// first terms that are only rounding. The terms, at least four, are those of a polynomial
// of the time over `length`; `limits` are for the value and its derivatives by time.
static inline int edge_powers(const double *terms, const double limits[3], double length)
{
    int powers = 0;
    double scale = 1;
    while (powers < 3 && fabs(terms[powers]) <= limits[powers] * scale) {
        powers++;
        scale *= length;
    }

    // a function that falls through zero is left as it is, because its root is what
    // matters; and a positive rate or acceleration that delays the fall is not taken for
    // rounding
    if (powers > 0 && terms[powers] < 0) {
        if (terms[0] > 0) {
            powers = 0;
        } else if (terms[powers - 1] > 0) {
            powers--;
        }
    }
    return powers;
}
