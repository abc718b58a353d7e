// The ways of the law `observer`: to the neighbourhood of the wall, from there to the
// touch, and from the touch to the wanted force.
#pragma once

#include <stdbool.h>

#include "src/rig/laws/observer_design.h"

// --- an approach that leaves no vibration ----------------------------------------------

// The approach that leaves no vibration behind: from rest to a cruising speed, from that
// to the speed of a soft touch before a guarded angle, and faster again where no wall
// was, each change of speed a box of one free vibration's period as acceleration,
// convolved with one of the next vibration's.

typedef struct smooth_approach {
    double period;          // between samples [s]
    double guarded, passed; // tip angles between which the wall is probably felt [rad]
    double state[ESTIMATOR_STATES]; // planned: free coordinates and rates
    double start_angle;             // [rad]
    double overlap;     // share of the first change after which the second may begin
    double from;        // the rotation's speed before both changes of it [rad/s],
    double beyond;      // by which the tip swings beyond the end of slowing down [rad]
    double change[2];   // which may overlap [rad/s],
    double changing[2]; // and how long each has been under way [s]
    bool slows;         // the second has begun, to the speed of the touch
    bool searches;      // the wall was not where it is probable
} smooth_approach;

// Begins at rest at an angle [rad], period and both angles of the wall being set; the
// cruising speed leaves room to slow down in.
void smooth_approach_begin(smooth_approach *p, const observer_design *d, double angle);

// The plan as it would be, had the present changes of speed been begun for the design of
// now.
void smooth_approach_restart(smooth_approach *p, const observer_design *d);

// Begins to slow down where the tip, or the rotation of the whole arm [rad], comes near
// the guarded angle; beyond the other, to search.
void smooth_approach_slow(smooth_approach *p, const observer_design *d, double tip,
                          double turned);

// Planned speed of the rotation [rad/s].
double smooth_approach_speed(const smooth_approach *p, const observer_design *d);

// Moves the plan on by a period; returns the torque that its rotation takes [N m].
double smooth_approach_follow(smooth_approach *p, const observer_design *d);

// --- the quickest touch ----------------------------------------------------------------

// The way to a wall whose place is known in the least time: the voltages, each held over
// a period, after which the tip meets the wall with just the motion that the wanted force
// stops.
//
// After a touch the force
//
//     F = w^2 (a + a'/s)/(h L),     a = X a_free - p theta_wall     (observer_design.h)
//
// stops the first mode in contact. Tip angle and F after n periods are sums over the
// torques of those periods. The first plan is for the least n in which torques within the
// limits bring both about, some of the voltage kept for what the plan does not know;
// every later sample plans anew for what is left of n from where the arm is. Of all
// torques that do it the plan takes those with the least sum of squares.

enum { QUICKEST_PERIODS = 400 }; // at most, from now to the touch

typedef struct quickest_touch {
    sampled_model flight; // free coordinates and rates under a torque, over a period
    double tip[ESTIMATOR_STATES];      // tip angle by the state [rad]
    double force[ESTIMATOR_STATES];    // F by the state [N],
    double force_per_wall;             // and by the wall's angle [N/rad]
    double tip_gain[QUICKEST_PERIODS]; // what a torque k periods before the last one adds
                                       // to the
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

// Plans from the present state on. Where that has no solution in time, or up to two
// periods later, the plan before stays. False if there is none.
bool quickest_touch_plan(quickest_touch *q, const quickest_task *task);

// The next period's net torque [N m], which is taken off the plan; some must be left.
double quickest_touch_next(quickest_touch *q);

// --- from the touch to the wanted force ------------------------------------------------

// The way from a touch to the wanted force that costs the least integral of (f -
// wanted)^2.
//
// With the force as input the first mode in contact obeys a'' = s^2 (a - f)
// (observer_design.h; a force stands here for the coordinate in which the mode rests
// under it). Its stopping force x = a + a'/s obeys x' = s (x - f), which runs away from
// any force but its own: to bring it to the wanted one, w, at the least cost is f = w + 2
// (x - w), by which both decay as exp(-s t),
//
//     f = w + 2 y exp(-s t),     a = w + (a0 - w + s t y) exp(-s t),     y = x0 - w.
//
// Where that begins beyond a bound of the force, the force stays at the bound first.

typedef struct force_rise_task {
    double coordinate, rate; // of the mode at the beginning
    double divergence;       // s [1/s]
    double end;              // rest under the wanted force, above 0
    double least,
        most;    // under the forces between which it is to be; most may be infinite
    double time; // of the beginning [s]
} force_rise_task;

typedef struct force_rise {
    double begun;      // when [s]
    double time;       // until the force is near the wanted one [s]
    double divergence; // s [1/s]
    double from, end;  // coordinates at the beginning and at rest
    double off;        // y, of the stopping force at the beginning
    double bound;      // where the force is at first,
    double bounded;    // and for how long [s]
} force_rise;

// Plans the way. Too slow a motion for a force above `least` presses with none for a
// while, and one that no force up to `most` stops brakes with what it takes.
force_rise force_rise_begin(const force_rise_task *task);

// Coordinate, its rate and its second derivative at an instant [s].
void force_rise_at(const force_rise *r, double time, double way[3]);

// Whether it is still under way.
bool force_rise_moves(const force_rise *r, double time);
