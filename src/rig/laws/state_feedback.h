// State feedback with an observer on the linearised arm.
//
// In contact the two-link arm has one degree of freedom, x = theta2 - theta_imp:
//
//     M x'' = Kt u - D x' - friction - 4 k2 x,      f = 4 k2 x - mu x'',
//     M = I1 + 2 I + m l^2/2,     mu = (m l^2/4 - I)/l  (l = 1/2 of the beam)
//
// so braking presses, and with f as the input x'' = s^2 (x - f/(4 k2)), s^2 = 4 k2/mu, is unstable.
// The feedback that makes the sum of (f - command)^2 + effort u^2 least comes from the discrete
// Riccati equation. What it asks for is limited to commands that keep the force positive.
//
// The observer is a Kalman filter: in free flight on both links, so that the wall is found where
// the tip is when the force sensor first feels it; in contact on theta2, its velocity, the wall's
// angle and a constant torque, from encoder, tachometer and force sensor.
//
// optimal comes in with the constant command; predictive as fast as a limit on the force allows.
#pragma once

#include "src/rig/estimation/estimator.h"
#include "src/rig/laws/laws.h"

enum { APPROACH, PRESS, HOLD };
extern const char *const state_feedback_modes[];

// Parameters that both laws have, in this order; OWN is predictive's limit behind them.
enum { FORCE_WANTED, APPROACH_VOLTAGE, THRESHOLD, OWN };
#define STATE_FEEDBACK_PARAMETERS                                                                  \
    {.name = "force"}, {.name = "approach_voltage"},                                               \
    {                                                                                              \
        .name = "contact_threshold"                                                                \
    }

typedef struct optimal_memory {
    controller_setup rig;
    double force, approach_voltage, threshold;
    double force_limit; // HUGE_VAL if there is none [N]
    double jump[2];     // rate of x after an impact, of both links' velocities before it
    int mode;
    bool started;
    bool flies;          // the estimate is of the free flight
    double inertia;      // M [kg m2]
    double stiffness;    // 4 k2 [N m/rad]
    double spring_force; // of x: 2 k2/l [N/rad]
    double mass_force;   // mu [N s2/rad]
    double divergence;   // s [1/s]
    double gain[2];      // of x and its rate [V/rad], [V s/rad]
    sampled_model flight, contact, during_delay;
    estimator e;         // of the flight or of the contact
    double ceiling;      // largest force to brake with [N]
    double hold_command; // [V]
    double held_force;   // reading of the force sensor, smoothed [N]
    int readings_without_force;
} optimal_memory;

// Takes setup and parameters, models the arm and finds the gains. Refuses an arm without a motor or
// without inertia, and one whose Riccati equation has no stabilising solution. The second is for a
// law with a limit on the force behind the shared parameters.
const char *state_feedback_start(void *memory, const controller_setup *setup);
const char *state_feedback_start_with_limit(void *memory, const controller_setup *setup);

// Observer, mode and command of one sample.
void state_feedback_sample(void *memory, const controller_input *in, controller_output *out);

// A controller of this family: word, table of parameters, start function.
#define STATE_FEEDBACK_LAW(law, table, starts)                                                     \
    CONTROLLER_LAW(law, state_feedback_modes, table, optimal_memory, .lockable = true,             \
                   .start = starts, .sample = state_feedback_sample)
