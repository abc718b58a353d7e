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

// --- modes -----------------------------------------------------------------------------

enum { MODAL_MOST = 5 }; // modes

// Modes under a torque that each feels by its own share h_i, and that a damper turns
// back,
//
//     a_i'' = -w_i^2 a_i - c_i a_i' + h_i (u - damping sum h_j a_j'),
//
// over a period. Of the states the coordinates come first, then the rates, and behind
// them any that stay. Other modes' part of the damper is held over the period.
typedef struct modal_model {
    int modes;
    double keep[MODAL_MOST][2][2]; // of coordinate and rate
    double gain[MODAL_MOST][2];    // of both by the torque
    double damper[MODAL_MOST];     // torque by each rate
} modal_model;

// w^2 [1/s2], c [1/s] and h of every mode, the hub's damping, over h [s].
typedef struct modal_motion {
    int modes;
    const double *square, *damping, *hub;
    double hub_damping;
} modal_motion;
void modal_model_init(modal_model *m, const modal_motion *of, double h);

// Coordinates and rates a period on.
void modal_model_step(const modal_model *m, double *z, double u);

// --- the filter ------------------------------------------------------------------------

typedef struct estimator {
    double z[ESTIMATOR_STATES];                   // estimate
    double p[ESTIMATOR_STATES][ESTIMATOR_STATES]; // its covariance
} estimator;

// Estimate and covariance of n states one period on; the last state adds to the torque u;
// noise[i]: variance that state i gains meanwhile.
void estimator_predict(estimator *e, int n, const modal_model *m, double u,
                       const double *noise);

// What an estimate of n states says of row z + offset: the value expected, its variance,
// and its covariance with every state.
typedef struct estimator_view {
    double expected, variance, spread[ESTIMATOR_STATES];
} estimator_view;
estimator_view estimator_look(const estimator *e, int n, const double *row,
                              double offset);

// Takes in a reading of what a view shows, with the variance of the reading.
void estimator_correct(estimator *e, int n, const estimator_view *view, double reading,
                       double variance);

// Another view of the state: an estimate of `from` states becomes one of `to` states, t z
// with the covariance t p t'; t: [to][from].
void estimator_transform(estimator *e, int from, int to,
                         double t[ESTIMATOR_STATES][ESTIMATOR_STATES]);

// --- the gain of a regulator -----------------------------------------------------------

// Gain of the feedback u = -gain z that makes the sum over all samples of sum weight_i
// z_i^2 + effort u^2 least on a sampled model: the stabilising solution of the discrete
// Riccati equation by the structured doubling algorithm (Chu, Fan, Lin and Wang,
// International Journal of Control 77, 2004), which squares the closed loop's decay in
// each of its steps. False if it does not converge: there is no stabilising solution.
bool quadratic_gain(const sampled_model *m, const double *weight, double effort,
                    double *gain);
