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
    double ramp_time;           // of a change of speed that leaves no vibration [s],
    double ramp_edge;           // of which its acceleration rises, and falls [s]
    double divergence;          // s, with which a wrong force in contact runs away [1/s]
    sampled_model flight_model; // of the free arm under a torque,
    sampled_model plan_model;   // and without damping, which the plan moves
} observer_design;

// What the design is to do with the arm of a setup.
typedef struct observer_task {
    double force;            // to press with [N]
    double stopping_force;   // that may be used to stop the tip [N]
    double approach_voltage; // of the fastest approach [V]
    double tip_mass;         // that the tip carries [kg]
    double wall_stiffness;   // of a wall that gives, 0: a rigid one [N/m]
} observer_task;

// Designs for the arm that the setup describes, of setup->links links. NULL, or a
// sentence that says why that cannot be.
const char *observer_design_init(observer_design *d, const controller_setup *setup,
                                 const observer_task *task);

// --- the arms that the law holds possible ----------------------------------------------

// The arms that the law `observer` holds possible: the one that it is told of, beams of
// other numbers of links, a hub that gives, and the arm told of at walls that give. Each
// has an observer and gains of its own; all observers follow the same readings, and the
// law goes on with the arm that foretells them best.

enum { OBSERVER_MOST_ARMS = 11 };

typedef struct observer_arms {
    observer_design arms[OBSERVER_MOST_ARMS]; // the first is the one told of
    int count, on;                            // on: the one that the law goes by
    hub_sensors sensors;                      // that all of them follow
    bool thrown; // the tip has left the wall, which one that gives so much would not have
                 // let it
    int giving;  // the first of those at a wall that gives
    int loaded;  // the first of those with a mass at the tip, which no contact shows
} observer_arms;

// Designs for the arm that the setup describes and for those that it may be instead: two,
// three and six links and a hub that gives a sixth of what the beam does, but for those
// that are as stiff at the wall as the one told, within a quarter, and so are one with
// it; and at walls of 60 to 940 N/m, on which the tip swings slowly enough to be
// followed. The law begins with the arm told of. NULL, or a sentence that says why that
// cannot be.
const char *observer_arms_init(observer_arms *a, const controller_setup *setup,
                               const observer_task *task);

// The design and the observer that the law goes by.
const observer_design *observer_arms_design(const observer_arms *a);
const arm_observer *observer_arms_observer(const observer_arms *a);

// What becomes of all observers: arm_observer_start, _know_wall, _sample, _touch and
// _leave.
void observer_arms_start(observer_arms *a, const controller_input *in);
void observer_arms_know_wall(observer_arms *a, double angle);
void observer_arms_sample(observer_arms *a, const controller_input *in, int felt);
void observer_arms_touch(observer_arms *a, double time);
void observer_arms_leave(observer_arms *a, double time);

// Goes over to the arm that foretells the readings best, where they leave no doubt: by a
// likelihood ratio of a million, since the errors of a wrong parameter come many in a
// row. Returns whether that is another than before.
bool observer_arms_choose(observer_arms *a);
