// What a force sensor would read of the contact: a first-order lag over forces and impulses.
//
// The force of a rigid point contact is a finite force f(t) plus impulses p at instants. A sensor
// with time constant tau shows y with
//
//     tau dy/dt + y = f(t),     y jumps by p / tau at an impulse,
//
// which is the same equation for f plus p times Dirac's delta.
#pragma once

#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

// The lag, and the largest value it had.
typedef struct sensor_lag {
    double time_constant; // tau [s]
    double time, value;   // now [s], [N]
    double peak, peak_time;
} sensor_lag;

void sensor_lag_start(sensor_lag *s, double time_constant, double time);

// An impulse [N s] at this instant.
void sensor_lag_impulse(sensor_lag *s, double impulse);

// The force over a stretch of `length` seconds: `first` and `last` at its ends and its mean [N],
// taken as the parabola these three determine. The response to it is exact, and so is its peak.
void sensor_lag_force(sensor_lag *s, double length, double first, double last, double mean);

enum { SENSOR_CONSTANTS = 3 };
extern const double sensor_constants[SENSOR_CONSTANTS]; // [s]; the middle one is 1 ms

#define SENSOR_WINDOW   0.02  // after first contact in which peaks are looked for [s]
#define MOMENTUM_WINDOW 0.002 // after first contact over which momentum is summed [s]

// One number of links.
typedef struct sensor_view {
    int links;
    double speed;                    // approach speed of the first impact [m/s]
    double impulse;                  // of the first impact [N s]
    double momentum;                 // impulses and forces over MOMENTUM_WINDOW [N s]
    double peak;                     // largest force in SENSOR_WINDOW, impulses excluded [N]
    double sensed[SENSOR_CONSTANTS]; // largest value of the sensor in SENSOR_WINDOW [N]
    double delay[SENSOR_CONSTANTS];  // of that value after first contact [s]
    double impacts;                  // in SENSOR_WINDOW
} sensor_view;

// Runs the scenario with `links` links until SENSOR_WINDOW after first contact, by the event method
// with steps that resolve the chain. STATUS_BAD_SCENARIO for the printed model, a script, or if
// there is no contact within run.duration. STATUS_NO_PROGRESS for modes that take too many strides
// to follow. STATUS_STOPPED if `monitor` (NULL: nobody looks on) asked for it.
status sensor_view_compute(const scenario *s, int links, run_monitor *monitor, sensor_view *view,
                           fault *f);

// The limit of many links. The tip of an Euler-Bernoulli beam that is stopped from the speed v at
// t = 0 presses, as long as nothing has come back from its other end, with K / sqrt(t),
//
//     K = v (EI)^(1/4) (rho A)^(3/4) / sqrt(2 pi),     EI = k2 L / 2,  rho A = mass / L.
//
// Its momentum is 2 K sqrt(t), and a sensor reads 2 K / sqrt(tau) D(sqrt(t / tau)) with Dawson's
// integral D, which is largest at t = 0.854 tau.
double sensor_beam_momentum(const parameters *p, double speed, double time);
double sensor_beam_peak(const parameters *p, double speed, double time_constant);

enum { SENSOR_LENGTHS = 8 }; // numbers of links of the study: 2 to 32

// What is computed for each number of links, and what theory says of a beam that touches with the
// same speed.
typedef struct sensor_study {
    int count; // numbers of links that were computed, the first ones
    sensor_view views[SENSOR_LENGTHS];
    // columns of `views`, as curves need them
    double links[SENSOR_LENGTHS], impulse[SENSOR_LENGTHS], peak[SENSOR_LENGTHS];
    double momentum[SENSOR_LENGTHS];
    double sensed[SENSOR_CONSTANTS][SENSOR_LENGTHS];
    double beam_momentum[SENSOR_LENGTHS];               // over MOMENTUM_WINDOW [N s]
    double beam_peak[SENSOR_CONSTANTS][SENSOR_LENGTHS]; // [N]
} sensor_study;

// sensor_view_compute for every number of links. Fails as that does; the study then has those
// before, none where the modes of the largest number are too fast.
status sensor_study_compute(const scenario *s, run_monitor *monitor, sensor_study *study, fault *f);
