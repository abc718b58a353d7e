// A linear model sampled at a fixed period, and a Kalman filter on it: small, fixed sizes, nothing
// allocated. For controllers.
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
void sampled_model_init(sampled_model *m, int n, double rate[ESTIMATOR_STATES][ESTIMATOR_STATES],
                        const double input[ESTIMATOR_STATES], double h);

// A state one period on.
void sampled_model_step(const sampled_model *m, double *z, double u);

typedef struct estimator {
    double z[ESTIMATOR_STATES];                   // estimate
    double p[ESTIMATOR_STATES][ESTIMATOR_STATES]; // its covariance
} estimator;

// Estimate and covariance one period on; noise[i]: variance that state i gains meanwhile.
void estimator_predict(estimator *e, const sampled_model *m, double u, const double *noise);

// Takes in one reading of row z + offset with the given variance.
void estimator_correct(estimator *e, int n, const double *row, double offset, double reading,
                       double variance);

// Another view of the state: an estimate of `from` states becomes one of `to` states, t z with the
// covariance t p t'; t: [to][from].
void estimator_transform(estimator *e, int from, int to,
                         double t[ESTIMATOR_STATES][ESTIMATOR_STATES]);
