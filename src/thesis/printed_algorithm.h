// The thesis's own simulation: Table 3.2 with the habits of its listing, on the printed
// equations.
//
// Driven step by step: start, then step until the end; between two steps parameters and
// command may change.
//
//     printed_motion m;
//     printed_motion_start(&m, &parameters);
//     while (code == STATUS_OK && !printed_motion_ended(&m)) {
//         code = printed_motion_step(&m, &f);
//     }
#pragma once

#include "src/thesis/printed_arm.h"
#include "src/base/fault.h"

// What the printed algorithm knows after a step.
typedef struct printed_row {
    double time;            // [s]
    double angle[3];        // theta1, theta2, theta3 [rad]
    double velocity[3];     // [rad/s]
    double acceleration[3]; // as re-evaluated in contact, Newmark's own in free flight
                            // [rad/s2]
    double newmark_acceleration[3]; // Newmark's own [rad/s2]
    double force;                   // contact force [N]
    double gap;                     // of (3.9), positive when open [m]
    bool contact;                   // the constraint was enforced in this step
} printed_row;

// A simulation in progress, in the caller's storage; it holds no memory of its own. All
// but `row` is the algorithm's.
typedef struct printed_motion {
    printed_row row; // after the last step; before the first: the initial state

    printed_arm arm;
    method_parameters method;
    long steps, step_count;     // done, and in the whole run
    double fed_acceleration[3]; // what the next step starts from [rad/s2]
    double newmark_force; // the constraint's force in Newmark's own system, a first guess
                          // [N]
    double force;         // as re-evaluated [N]
    bool in_contact;      // the constraint is to be enforced in the coming step
    int contact_steps;    // steps since contact began, zero only before the first of them
} printed_motion;

// Starts from the initial state of resolved parameters, over p->run.duration with step
// p->method.step. m->row is the initial state, a row of time 0. As listed, the first step
// starts from zero acceleration: where the motor pushes from the first instant,
// velocities lag by half a step.
void printed_motion_start(printed_motion *m, const parameters *p);

// Adopts parameters changed by a script for the coming steps; the command is
// motor.voltage again, until motor_set_voltage puts another one in force.
void printed_motion_rebind(printed_motion *m, const parameters *p);

// Whether the run's last step has been made.
bool printed_motion_ended(const printed_motion *m);

// One time step into m->row. Its time is the end of the step (the listing prints the
// start). A step that would end behind the wall is done again with the constraint; its
// row carries the first contact. STATUS_NOT_FINITE or STATUS_SINGULAR if a state becomes
// infinite or the Jacobian singular: f says when and which, m->row stays, and no further
// step can be made.
status printed_motion_step(printed_motion *m, fault *f);
