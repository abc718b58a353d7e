// A bound for every controller: the least time from rest until the arm presses with the
// wanted force for good, with a limited voltage and a limited force.
//
// In flight the two-link arm is linear in the deviation q = (theta2, theta3) - theta_imp,
// and so is what decides about the contact: whether the tip is at the wall, l (q2 + q3) =
// 0, and with which K xi the impact leaves the arm (best_stop.c; K xi has to end in the
// band round the force, and every way there takes at least the time of the largest or of
// no force). For each time of touch the attainable values of K xi form an interval, whose
// ends are the optima of linear programs over the voltage with one equality constraint:
// their solutions are bang-bang (full voltage either way), so that only one multiplier is
// to be found.
//
// It is a bound: friction is taken as a torque that the controller may choose within its
// limits, the tip may have passed the wall before, and the motor gives every force in
// contact.
#pragma once

#include "src/predict/best_stop.h"

// Instants of a touch are looked at in these steps, and the voltage changes at them only
// [s].
#define LEAST_TIME_STEP 5e-4

typedef struct least_time {
    double
        total; // until the force is in the band for good [s]; NaN where there is no way
    double touch;  // of the touch on that way [s]
    double press;  // end of the interval of K xi just after it, the one nearest to the
                   // band [N]
    double weight; // multiplier: the torque is U sign(g_press - weight g_tip), its sign
                   // for the largest K xi, turned for the least
    bool largest;  // that end is the upper one
    double slack;  // |tip's distance| that its torque leaves at the touch, as a share of
                   // the way
} least_time;

// The least time for the arm at rest at initial.angle, before the wall. `force` [N]
// wanted, within `band` (a share); no force above `peak` [N], or the band's upper edge
// where that is higher. total is NaN where pressed_arm_model_of holds no model, without a
// wall ahead, or with no way within two seconds.
least_time least_time_of(const parameters *p, double force, double band, double peak);

// Tip's distance from the wall's line [m] and K xi after a touch [N] that a torque,
// constant in each step, brings about in `steps` steps from rest. For checks that the
// bound is attained.
void least_time_follow(const parameters *p, const double *torque, int steps, double *tip,
                       double *press);
