// The gain of a linear quadratic regulator on a sampled model, any weights.
#pragma once

#include "src/rig/estimation/estimator.h"

// The sum over samples k of (z'Q z + 2 z's u + r u^2) growth^2k.
typedef struct quadratic_cost {
    double state[ESTIMATOR_STATES][ESTIMATOR_STATES]; // Q
    double cross[ESTIMATOR_STATES];                   // s
    double effort;                                    // r > 0
    double growth; // 1 is the plain optimum; above it errors die faster than growth^-k
} quadratic_cost;

// Adds weight (row z + direct u)^2 to a cost of n states.
void quadratic_cost_add(quadratic_cost *c, int n, const double *row, double direct, double weight);

// Gain of the feedback u = -gain z that makes the cost least on a sampled model: the stabilising
// solution of the discrete Riccati equation by the structured doubling algorithm (Chu, Fan, Lin and
// Wang, International Journal of Control 77, 2004), which squares the closed loop's decay in each
// of its steps. False if it does not converge: there is no stabilising solution.
bool quadratic_gain(const sampled_model *m, const quadratic_cost *c, double *gain);
