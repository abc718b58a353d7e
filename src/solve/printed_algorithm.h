// The thesis's own simulation: Table 3.2 with the habits of its listing, on the printed equations.
#pragma once

#include "src/quantities/parameters.h"
#include "src/base/status.h"

// What the printed algorithm knows after a step.
typedef struct printed_row {
    double time;            // [s]
    double angle[3];        // theta1, theta2, theta3 [rad]
    double velocity[3];     // [rad/s]
    double acceleration[3]; // as re-evaluated in contact, Newmark's own in free flight [rad/s2]
    double newmark_acceleration[3]; // Newmark's own [rad/s2]
    double force;                   // contact force [N]
    double gap;                     // of (3.9), positive when open [m]
    bool contact;                   // the constraint was enforced in this step
} printed_row;

// Called after each step with the row; a return value of false stops the run.
typedef bool (*printed_observer)(void *context, const printed_row *row);

// Called before the step that starts at `time` [s]; may change p's timed parameters (scripted
// playback). May be NULL.
typedef void (*printed_script)(void *context, double time, parameters *p);

// Runs Table 3.2 from the initial state over p->run.duration with step p->method.step. The row of
// time 0 is the initial state. A row's time is the end of its step (the listing prints the start).
// As listed, the first step starts from zero acceleration: where the motor pushes from the first
// instant, velocities lag by half a step. A step that would end behind the wall is done again with
// the constraint; its row carries the first contact. On a non-finite state or a singular Jacobian
// it stops and f says when and which state; the rows until then were observed.
status printed_run(const parameters *p, printed_observer observe, printed_script script,
                   void *context, fault *f);
