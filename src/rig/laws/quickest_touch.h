// The way to a wall whose place is known in the least time: the voltages, each held over a period,
// after which the tip meets the wall with just the motion that the wanted force stops.
//
// After a touch the force
//
//     F = w^2 (a + a'/s)/(h L),     a = X a_free - p theta_wall     (observer_design.h)
//
// stops the first mode in contact. Tip angle and F after n periods are sums over the torques of
// those periods. The first plan is for the least n in which torques within the limits bring both
// about, some of the voltage kept for what the plan does not know; every later sample plans anew
// for what is left of n from where the arm is. Of all torques that do it the plan takes those with
// the least sum of squares.
#pragma once

#include "src/rig/laws/observer_design.h"

enum { QUICKEST_PERIODS = 400 }; // at most, from now to the touch

typedef struct quickest_touch {
    sampled_model flight;                // free coordinates and rates under a torque, over a period
    double tip[ESTIMATOR_STATES];        // tip angle by the state [rad]
    double force[ESTIMATOR_STATES];      // F by the state [N],
    double force_per_wall;               // and by the wall's angle [N/rad]
    double tip_gain[QUICKEST_PERIODS];   // what a torque k periods before the last one adds to the
    double force_gain[QUICKEST_PERIODS]; // tip's angle [rad/(N m)], and to F [1/m]
    double torque[QUICKEST_PERIODS];     // planned, the next one at left - 1 [N m]
    int left;                            // periods until the planned touch
    bool planned;
} quickest_touch;

// What a plan starts from, and has to do.
typedef struct quickest_task {
    const double *z;  // free coordinates and rates when the next command takes effect
    double low, high; // net torque that can be had on the hub, damping apart [N m]
    double wall;      // [rad]
    double force;     // that is to stop the tip [N]
} quickest_task;

// For the arm of a design. Nothing is planned yet.
void quickest_touch_init(quickest_touch *q, const observer_design *d);

// Plans from the present state on. Where that has no solution in time, or up to two periods later,
// the plan before stays. False if there is none.
bool quickest_touch_plan(quickest_touch *q, const quickest_task *task);

// The next period's net torque [N m], which is taken off the plan; some must be left.
double quickest_touch_next(quickest_touch *q);
