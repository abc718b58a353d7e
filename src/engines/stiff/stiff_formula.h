// Radau IIA of seven stages (order 13), in numbers. With f the integrand on a step from 0
// to 1, the stages x_i = c_i, and the Lagrange polynomials L_j through them,
//
//     integral of f from 0 to x_i = sum of a_ij f(x_j),      a_ij = integral of L_j from
//     0 to c_i;
//
// c are the roots of P_7(2x - 1) - P_6(2x - 1), P_k being Legendre's polynomials: the
// last one is 1, so that a_7j are the weights of a whole step. The inverse of a is T
// diag(root) T^-1 with one real root and three pairs of complex ones; of a pair only the
// root with a positive imaginary part is kept: a real vector is the real part of the sums
// with twice the pair's column.
//
// (Hairer, Wanner: Solving Ordinary Differential Equations II, sections IV.5 and IV.8.)
// The numbers were computed with sixty digits; tests/test_stiff_formula.c checks what
// defines them.
#pragma once

enum {
    RADAU_STAGES = 7,
    RADAU_LANES = 8,   // the stages, and the step's start in the last lane
    RADAU_SYSTEMS = 4, // the real root's, then those of the pairs
    RADAU_MIDDLE = 3   // the stage next to the middle of a step
};

extern const _Alignas(32) double radau_node[RADAU_LANES]; // c_i, and 0 for the start
extern const _Alignas(
    32) double radau_matrix[RADAU_STAGES]
                           [RADAU_LANES]; // a_ij, by [j][i], 0 for the start

extern const _Alignas(32) double radau_root_real[RADAU_SYSTEMS];
extern const _Alignas(32) double radau_root_imaginary[RADAU_SYSTEMS];
// T^-1 by [stage][system], and T by [system][stage], a pair's as 2 Re and -2 Im.
extern const _Alignas(32) double radau_to_real[RADAU_STAGES][RADAU_SYSTEMS];
extern const _Alignas(32) double radau_to_imaginary[RADAU_STAGES][RADAU_SYSTEMS];
extern const _Alignas(32) double radau_from_real[RADAU_SYSTEMS][RADAU_LANES];
extern const _Alignas(32) double radau_from_imaginary[RADAU_SYSTEMS][RADAU_LANES];

// Integral of f over the step by the embedded formula of order 7, less that by the
// stages: radau_start f(0) + sum of radau_difference_i f(c_i) (the last one is 0).
extern const double radau_start;
extern const _Alignas(32) double radau_difference[RADAU_LANES];

// L_j = sum over k of radau_legendre[k][j] P_k(2x - 1), and 0 in the last lane.
extern const _Alignas(32) double radau_legendre[RADAU_STAGES][RADAU_LANES];

// Bernstein's coefficients of the polynomial through the values at the stages and at the
// start, by [coefficient][value]; of the polynomial that is zero there and has slope 1 at
// the start.
extern const _Alignas(32) double radau_bernstein[RADAU_LANES][RADAU_LANES];
extern const _Alignas(32) double radau_slope[RADAU_LANES + 1];

// Weights of f's values at the stages for the value at x of the polynomial through them,
// of its integral from 0 and of that one's; 0 in the last lane. `start`: the integral
// from 0 to x of the polynomial that is 1 at the start and 0 at the stages, (P_6 -
// P_7)/2; 0 over a whole step.
typedef struct radau_weights {
    double value[RADAU_LANES], integral[RADAU_LANES], twice[RADAU_LANES];
    double start;
} radau_weights;
void radau_weights_at(double x, radau_weights *w);
void radau_values_at(double x, double value[RADAU_LANES]); // of these the first alone
