// A bench that shares no code with the lab: a chain of rods on a motor that meets a wall
// which gives, with what no scenario of the lab holds. Recordings for identify.
//
//     tau u' = command - u                                   amplifier's lag
//     I phi" = torque_per_volt u - damping phi' - stiction tanh(phi'/v) - c
//     c = coupling of the rotor to the first rod: a stiff spring with a play
//
// and for the rods' angles q, with A_ij = l^2 (m (N - max(i, j) - 1/2) + m_tip) for i /=
// j, l^2 (m (N - i - 2/3) + m_tip) for i = j, counted from 0,
//
//     sum over j of A_ij (cos(q_i - q_j) q_j" + sin(q_i - q_j) q_j'^2) = Q_i
#pragma once

#include <stdbool.h>

enum { BENCH_LINKS = 32 };

typedef struct bench_arm {
    int links;
    double length, mass;                       // of the beam [m], [kg]
    double tip_mass;                           // [kg]
    double rotor_inertia;                      // of motor and hub [kg m2]
    double joint_stiffness;                    // of each joint between two rods [N m/rad]
    double torque_per_volt, damping, stiction; // [N m/V], [N m s/rad], [N m]
    double wall_stiffness, wall_damping;       // at angle 0 [N/m], [N s/m]
    double start;                              // angle, at rest [rad]
    double amplifier_lag;                      // time constant [s]
    double play;                               // of the hub on the rotor, in all [rad]
    double coupling;      // of the hub to the rotor, out of its play [N m/rad]
    double joint_damping; // of each joint between two rods, by MuJoCo alone [N m s/rad]
    double force_lag;     // time constant of the force sensor [s]
} bench_arm;

// What there is to read at a sample.
typedef struct bench_sample {
    double angle, velocity; // of the rotor [rad], [rad/s]
    double force;           // that has arrived in the force sensor [N]
    double pressed; // mean force of the wall since the sample before; by MuJoCo alone [N]
} bench_sample;

// Runs the bench: sample k of `samples` is taken at k/rate, and command[k] [V] holds from
// then on.
void bench_arm_run(const bench_arm *a, const double *command, int samples, double rate,
                   bench_sample *to);

// The command [V] that a board gives from sample k on, of which `to` has the samples up
// to that one.
// NaN ends the run.
typedef double bench_board(void *context, int k, const bench_sample *to);

// The same by MuJoCo, under a board. False where this program was built without.
bool bench_has_mujoco(void);
bool bench_arm_run_mujoco(const bench_arm *a, bench_board *board, void *context,
                          int samples, double rate, bench_sample *to);
