// What the law `observer` makes of one arm that it may be on: the observer of that arm, gains from
// Riccati equations, and the speeds of its approach. docs/explanation/control-design.md derives
// them.
#pragma once

#include "src/rig/estimation/arm_observer.h"

// Share of the wanted force below which the law lets it fall at no time.
#define OBSERVER_LEAST_FORCE 0.1

typedef struct observer_design {
    arm_observer observer;
    double travel_gain[ESTIMATOR_STATES]; // in flight [V per unit of state]
    double press_gain[ESTIMATOR_STATES];  // in contact [V per unit of state]
    double touch_speed, top_speed;        // of the rotation [rad/s]
    double ramp_time;                     // of a change of speed that leaves no vibration [s],
    double ramp_edge;                     // of which its acceleration rises, and falls [s]
    double divergence;                    // s, with which a wrong force in contact runs away [1/s]
    sampled_model flight_model;           // of the free arm under a torque,
    sampled_model plan_model;             // and without damping, which the plan moves
} observer_design;

// What the design is to do with the arm of a setup.
typedef struct observer_task {
    double force;            // to press with [N]
    double stopping_force;   // that may be used to stop the tip [N]
    double approach_voltage; // of the fastest approach [V]
} observer_task;

// Designs for the arm that the setup describes, of setup->links links. NULL, or a sentence that
// says why that cannot be.
const char *observer_design_init(observer_design *d, const controller_setup *setup,
                                 const observer_task *task);
