// The ways of the law `observer`: to the neighbourhood of the wall, from there to the
// touch, and from the touch to the wanted force.
#pragma once

#include <stdbool.h>

#include "src/rig/laws/observer_design.h"

// --- an approach that leaves no vibration ----------------------------------------------

// The approach that leaves no vibration behind. The rotation speeds up from rest to a
// cruising speed, slows down to the speed of a soft touch before it comes to where the
// wall may be, and speeds up again, to search, where it has found no wall. Each of these
// ramps accelerates for one period of the first free vibration, with edges of one period
// of the second: a box convolved with a box, which leaves neither vibration behind.

// One change of the rotation's speed.
typedef struct speed_ramp {
    double change;  // of the speed, in all [rad/s]
    double elapsed; // since it began [s]
} speed_ramp;

enum { SPEED_UP, SLOW_DOWN, SPEED_RAMPS };

typedef struct smooth_approach {
    double period; // between samples [s]
    double wall_nearest,
        wall_furthest;              // tip angles between which the wall probably is [rad]
    double state[ESTIMATOR_STATES]; // planned: free coordinates and rates
    double start_angle;             // [rad]
    double overlap;     // share of speeding up after which slowing down may begin
    double start_speed; // of the rotation before both ramps [rad/s]
    double overshoot;   // of the tip, past where it rests after slowing down [rad]
    speed_ramp ramp[SPEED_RAMPS]; // which may overlap
    bool slows;                   // slowing down has begun
    bool searches;                // no wall was found where it probably is
} smooth_approach;

// Begins at rest at an angle [rad]. The caller has set the period and both angles of the
// wall. The cruising speed leaves room to slow down in.
void smooth_approach_begin(smooth_approach *p, const observer_design *d, double angle);

// Goes over to another design: the plan becomes what it would be if the ramps under way
// had been begun, at the same instants, with that design.
void smooth_approach_restart(smooth_approach *p, const observer_design *d);

// Begins the next phase when it is due: slowing down where the tip, or the rotation of
// the whole arm, would otherwise reach the wall's nearest angle too fast; and the search
// where the tip has passed the wall's furthest angle [rad].
void smooth_approach_advance(smooth_approach *p, const observer_design *d, double tip,
                             double rotation);

// Planned speed of the rotation [rad/s].
double smooth_approach_speed(const smooth_approach *p, const observer_design *d);

// Moves the plan on by a period. Returns the torque that accelerates it meanwhile [N m].
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
// stops the first mode in contact. Tip angle and F after n periods are linear in the
// torques of those periods. The first plan is for the least n in which torques within the
// limits bring both to their wanted values; it keeps a share of the torque in reserve for
// what the model does not know. Every later sample plans again, from where the arm is
// then, for the periods that are left of n. Of all torques that solve the task the plan
// takes those with the least sum of squares.

enum { QUICKEST_PERIODS = 400 }; // at most, from now to the touch

typedef struct quickest_touch {
    sampled_model flight; // free coordinates and rates under a torque, over a period
    double tip[ESTIMATOR_STATES];   // tip angle by the state [rad]
    double force[ESTIMATOR_STATES]; // F by the state [N],
    double force_per_wall;          // and by the wall's angle [N/rad]
    // what a unit of torque, k periods before the last one, adds to the tip's angle
    // [rad/(N m)] and to F [1/m]
    double tip_gain[QUICKEST_PERIODS], force_gain[QUICKEST_PERIODS];
    double torque[QUICKEST_PERIODS]; // planned, the next one at left - 1 [N m]
    int left;                        // periods until the planned touch
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

// Plans from the present state on. Where no torques solve the task in the periods left,
// or in up to two more, the plan before stays. False if there is no plan at all.
bool quickest_touch_plan(quickest_touch *q, const quickest_task *task);

// Takes the next period's net torque [N m] off the plan, of which a period must be left.
double quickest_touch_next(quickest_touch *q);

// --- from the touch to the wanted force ------------------------------------------------

// The course of the force from a touch to the wanted force which has the least integral
// of (f - wanted)^2.
//
// With the force as input the first mode in contact obeys a'' = s^2 (a - f)
// (observer_design.h; a force stands here for the coordinate in which the mode rests
// under it). Its stopping force x = a + a'/s obeys x' = s (x - f), which is unstable: x
// runs away from any constant force but x itself. The input that brings x to the wanted
// force w at the least cost is f = w + 2 (x - w), by which both decay as exp(-s t):
//
//     f = w + 2 y exp(-s t),     a = w + (a0 - w + s t y) exp(-s t),     y = x0 - w.
//
// Where this f would begin beyond a bound of the force, the force stays at the bound
// until f has come back to it.

typedef struct force_rise_task {
    double coordinate, rate; // of the mode at the beginning
    double divergence;       // s [1/s]
    double end;              // rest under the wanted force, above 0
    double least, most;      // bounds of the force; most may be infinite
    double time;             // of the beginning [s]
} force_rise_task;

typedef struct force_rise {
    double begun;      // when [s]
    double time;       // until the force is near the wanted one [s]
    double divergence; // s [1/s]
    double start, end; // coordinates at the beginning and at rest
    double excess;     // y, of the stopping force over the wanted one, at the beginning
    double bound;      // at which the force stays first, NaN where it need not
    double bound_time; // for how long it does [s]
} force_rise;

// Plans the course of the force. A motion too slow for a force of `least` begins with no
// force at all, and one that no force up to `most` stops may exceed that bound.
force_rise force_rise_begin(const force_rise_task *task);

// The mode's coordinate, its rate and its second derivative at an instant [s].
void force_rise_at(const force_rise *r, double time, double motion[3]);

// Whether the rise is still under way at an instant [s].
bool force_rise_moves(const force_rise *r, double time);
