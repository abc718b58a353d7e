// A linear model sampled at a fixed period, a Kalman filter on it, and the gain of a
// linear quadratic regulator: small, fixed sizes, nothing allocated. For controllers.
#pragma once

#include <stdbool.h>

enum { ESTIMATOR_STATES = 12 };

// z' = a z + b u over one period.
typedef struct sampled_model {
    int n;
    double a[ESTIMATOR_STATES][ESTIMATOR_STATES];
    double b[ESTIMATOR_STATES];
} sampled_model;

// Samples dz/dt = rate z + input u, u constant over h [s].
void sampled_model_init(sampled_model *m, int n,
                        double rate[ESTIMATOR_STATES][ESTIMATOR_STATES],
                        const double input[ESTIMATOR_STATES], double h);

// A state one period on.
void sampled_model_step(const sampled_model *m, double *z, double u);

typedef struct estimator {
    double z[ESTIMATOR_STATES];                   // estimate
    double p[ESTIMATOR_STATES][ESTIMATOR_STATES]; // its covariance
} estimator;

// Estimate and covariance one period on; noise[i]: variance that state i gains meanwhile.
void estimator_predict(estimator *e, const sampled_model *m, double u,
                       const double *noise);

// Takes in one reading of row z + offset with the given variance.
void estimator_correct(estimator *e, int n, const double *row, double offset,
                       double reading, double variance);

// Another view of the state: an estimate of `from` states becomes one of `to` states, t z
// with the covariance t p t'; t: [to][from].
void estimator_transform(estimator *e, int from, int to,
                         double t[ESTIMATOR_STATES][ESTIMATOR_STATES]);

// --- the gain of a regulator, any weights ----------------------------------------------

// The sum over samples k of (z'Q z + 2 z's u + r u^2) growth^2k.
typedef struct quadratic_cost {
    double state[ESTIMATOR_STATES][ESTIMATOR_STATES]; // Q
    double cross[ESTIMATOR_STATES];                   // s
    double effort;                                    // r > 0
    double growth; // 1 is the plain optimum; above it errors die faster than growth^-k
} quadratic_cost;

// Adds weight (row z + direct u)^2 to a cost of n states.
void quadratic_cost_add(quadratic_cost *c, int n, const double *row, double direct,
                        double weight);

// Gain of the feedback u = -gain z that makes the cost least on a sampled model: the
// stabilising solution of the discrete Riccati equation by the structured doubling
// algorithm (Chu, Fan, Lin and Wang, International Journal of Control 77, 2004), which
// squares the closed loop's decay in each of its steps. False if it does not converge:
// there is no stabilising solution.
bool quadratic_gain(const sampled_model *m, const quadratic_cost *c, double *gain);
