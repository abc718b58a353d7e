// What the law `observer` makes of one arm that it may be on: the observer of that arm,
// gains from Riccati equations, and the speeds of its approach.
// docs/explanation/control-design.md derives them.
#pragma once

#include "src/rig/estimation/arm_observer.h"

// Share of the wanted force below which the law lets it fall at no time.
#define OBSERVER_LEAST_FORCE 0.1

typedef struct observer_design {
    arm_observer observer;
    double travel_gain[ESTIMATOR_STATES]; // in flight [V per unit of state]
    double land_gain[ESTIMATOR_STATES];   // after a bounce [V per unit of state]
    double press_gain[ESTIMATOR_STATES];  // in contact [V per unit of state]
    double touch_speed, top_speed;        // of the rotation [rad/s],
    double arrival_speed;                 // of the first touch [rad/s]
    double ramp_time;       // of a change of speed that leaves no vibration [s],
    double ramp_edge;       // of which its acceleration rises, and falls [s]
    double divergence;      // s, with which a wrong force in contact runs away [1/s]
    modal_model plan_model; // of the free arm without damping, which the plan moves
} observer_design;

// What the law is to do with the arm of a setup.
typedef struct observer_task {
    double force;            // to press with [N]
    double stopping_force;   // greatest force that may stop the tip [N]
    double approach_voltage; // of the fastest approach [V]
    double tip_mass;         // that the tip carries [kg]
    double wall_stiffness;   // of a wall that gives, 0: a rigid one [N/m]
} observer_task;

// Designs for the arm that the setup describes, of setup->links links. NULL, or a
// sentence that says why that cannot be.
const char *observer_design_init(observer_design *d, const controller_setup *setup,
                                 const observer_task *task);

// Coordinates and rates of its free arm, damped, under a torque [N m].
void observer_design_flight(const observer_design *d, sampled_model *model);

// --- the arms that the law holds possible ----------------------------------------------

// The arms that the law `observer` holds possible: the arm of its setup, beams of other
// numbers of links, a hub that gives, and the arm of the setup at walls that give and
// with masses at its tip. Each has an observer and gains of its own. All observers follow
// the same readings, and the law goes by the arm whose observer predicts them best.

enum { OBSERVER_MOST_ARMS = 10 };

typedef struct observer_arms {
    observer_design arms[OBSERVER_MOST_ARMS]; // the first is the setup's
    int count, on;       // on: the index of the one that the law goes by
    hub_sensors sensors; // that all of them follow
    bool thrown;         // the tip has left the wall, so it is none that gives
    int giving;          // index of the first arm at a wall that gives
    int loaded;          // index of the first arm with a mass at its tip
} observer_arms;

// Designs for the arm that the setup describes and for those that it may be instead: arms
// of two, three and six links; a hub on a spring with a sixth of the beam's compliance;
// walls of 60 to 940 N/m, on which the tip swings slowly enough to be followed; and
// a mass at the tip. An arm of other links whose stiffness at the wall is within a
// quarter of the given arm's is left out, since readings do not tell the two apart. The
// law begins with the arm of the setup. NULL, or a sentence that says why that cannot be.
const char *observer_arms_init(observer_arms *a, const controller_setup *setup,
                               const observer_task *task);

// The design and the observer that the law goes by.
const observer_design *observer_arms_design(const observer_arms *a);
const arm_observer *observer_arms_observer(const observer_arms *a);

// The functions arm_observer_start, _know_wall, _sample, _touch and _leave for the
// observers of all arms.
void observer_arms_start(observer_arms *a, const controller_input *in);
void observer_arms_know_wall(observer_arms *a, double angle);
void observer_arms_sample(observer_arms *a, const controller_input *in, int felt);
void observer_arms_touch(observer_arms *a, double time);
void observer_arms_leave(observer_arms *a, double time);

// Goes over to the arm whose observer predicts the readings best, where they leave no
// doubt: by a likelihood ratio of a million, since a wrong parameter causes many errors
// in a row. An arm that predicts them worse by one of 10^54 is followed no longer.
// Returns whether that is another arm than before.
bool observer_arms_choose(observer_arms *a);
