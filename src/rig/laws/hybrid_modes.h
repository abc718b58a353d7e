// The modes of the thesis's hybrid impact and force controller, 5.2 to 5.4, for it and for the laws
// that share them: another approach (speed-limit, bang-bang), another answer to the impact
// (reverse-torque), and the controller that 5.4 calls ideal (recovering).
//
// In contact the arm has one degree of freedom, theta, with the wall at theta_imp
// (docs/explanation/control-design.md):
//
//     M theta'' = K u - D theta' - k_st sign(theta') + 4 k2 (theta_imp - theta)       (5.13)
//     M = I1 + 2 I + m l^2/2                                                         (5.21)
//
// APPROACH sends the constant command. IMPACT follows the quintic (5.15) from the state at contact
// to rest at the angle at which the beam presses with the wanted force f,
//
//     theta_f = theta_imp + f l/(2 k2)                                                       (5.23)
//
// by the inverse of the model along it and feedback of both errors, (5.24). FORCE holds theta_f
// with the static torque 2 f l in advance, (5.25). Printed coefficients have 6 k2, 3 f l and M = 2
// m eps^2 instead (errata B2).
//
// theta_imp is what the law is told, or in IMPACT the mean of what a sensor says of it, as 5.2
// suggests: of film, theta3 - theta2, by (5.8) theta2 + theta3 = 2 theta_imp, or of an
// accelerometer by (5.13).
#pragma once

#include "src/rig/laws/laws.h"

enum { APPROACH, IMPACT, FORCE, RECOVER }; // modes; the last is recovering's alone
extern const char *const hybrid_modes[];   // without RECOVER

// Values of control.gains.
enum { GAINS_TORQUE, GAINS_VOLTS, GAINS_PRINTED };

// Values of control.impact_angle.
enum { ANGLE_TOLD, ANGLE_BY_FILM, ANGLE_BY_ACCELEROMETER };

// Parameters that these laws share, in this order; OWN is the law's own behind them.
enum {
    FORCE_WANTED,
    APPROACH_VOLTAGE,
    KP,
    KV,
    GAINS,
    COEFFICIENTS,
    TRANSITION,
    THRESHOLD,
    IMPACT_ANGLE,
    OWN
};
#define HYBRID_PARAMETERS                                                                          \
    {.name = "force"}, {.name = "approach_voltage"}, {.name = "kp"}, {.name = "kv"},               \
        {.name = "gains"}, {.name = "coefficients"}, {.name = "transition_time"},                  \
        {.name = "contact_threshold"},                                                             \
    {                                                                                              \
        .name = "impact_angle"                                                                     \
    }

typedef struct hybrid_memory {
    controller_setup rig;
    double force, approach_voltage, kp, kv, transition, threshold, own;
    int gains;
    bool printed;        // coefficients
    int source;          // of the impact angle
    double impact_angle; // theta_imp, as told or as the sensors have shown [rad]
    int readings;        // that it is the mean of; 0: as told
    int mode;
    double since;       // start of the present mode [s]
    double a[6];        // quintic of the impact mode, (5.15)
    double begun;       // when the quintic begins [s]
    double length;      // and how long it is [s]
    bool replans;       // force or t_f have changed since
    double start_angle; // at the first sample [rad]
    bool started, reversed;
    int readings_without_contact;
} hybrid_memory;

// Takes setup and parameters into a hybrid_memory, at the start or later; never refuses. In the
// impact mode the trajectory is then planned anew from where the arm is, for what is left of t_f.
// The second is for laws with a parameter of their own behind the shared ones, memory->own.
const char *hybrid_start(void *memory, const controller_setup *setup);
const char *hybrid_start_with_own(void *memory, const controller_setup *setup);

// Hub angle at which the beam presses with the wanted force, (5.23) [rad].
double hybrid_final_angle(const hybrid_memory *m);

// Tip force that (5.14) calculates from the hub's angle and acceleration [N].
double hybrid_calculated_force(const hybrid_memory *m, const controller_input *in);

// Goes into a mode. Entering the impact mode plans the trajectory from the present state and
// command on, so that the command goes on from where it is.
void hybrid_begin(hybrid_memory *m, int mode, const controller_input *in);

// Goes into the mode the law is held in. False if it is not: then it chooses itself, beginning with
// the mode that it is in.
bool hybrid_held(hybrid_memory *m, const controller_input *in);

// Force mode: PD round the final angle with the static torque in advance, (5.25) [V].
double hybrid_force_command(const hybrid_memory *m, const controller_input *in,
                            controller_output *out);

// The three modes with their switching, contact and then t_f, behind an approach with the given
// command [V]. Fills out but for the command, which it returns.
double hybrid_command(hybrid_memory *m, const controller_input *in, controller_output *out,
                      double approach);

// Command that keeps the hub at a speed [rad/s], friction included, with a proportional
// correction [V].
double hybrid_speed_command(const hybrid_memory *m, const controller_input *in, double speed);

// A controller of this family: word, modes, table of parameters, start and sample function.
#define HYBRID_LAW(law, names, table, starts, samples)                                             \
    CONTROLLER_LAW(law, names, table, hybrid_memory, .lockable = true, .start = starts,            \
                   .sample = samples, .tune = starts)
