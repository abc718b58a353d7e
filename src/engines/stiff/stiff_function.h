// Functions of the time within a step as polynomials in Bernstein's form, for the
// location of events: on the step from 0 to 1 of degree n
//
//     f(x) = sum of b_i n!/(i! (n-i)!) x^i (1 - x)^(n-i).
//
// f lies between the least and the greatest b, so that coefficients that are all above
// zero prove that f has no root; those of f' are n times the differences of the b.
#pragma once

#include "src/contact/engine.h"
#include "src/engines/stiff/stiff_formula.h"

enum { FUNCTION_MOST = RADAU_LANES + 2 };

typedef struct stiff_function {
    int degree;
    double b[FUNCTION_MOST];
} stiff_function;

// Through values at the stages and at the start.
void function_through(stiff_function *f, const double *nodes);
// The same with a derivative by x at the start, too, if the stages resolve it; of one
// degree more.
void function_through_rising(stiff_function *f, const double *nodes, double slope);
// The integral from 0, from a value on.
void function_integrate(stiff_function *f, double start, double factor);
// f times a number, and a number added.
void function_scale(stiff_function *f, double factor, double offset);
// (f - f(0)) / x.
void function_divide(stiff_function *f);
// Coefficients of the first four powers of x; the degree is at least 3.
void function_start(const stiff_function *f, double powers[4]);

// Value and derivative by x.
value_and_slope function_at(const stiff_function *f, double x);
// A bound on the magnitude of the second derivative by x from one x to another.
double function_curvature(const stiff_function *f, double from, double to);
// The least and the greatest coefficient.
double function_least(const stiff_function *f);
double function_greatest(const stiff_function *f);
