// The drive at the hub: D/A converter, amplifier and DC motor, as constants derived from
// the parameters, and the command it is at.
//
// The converter limits the commanded voltage u, the amplifier multiplies it, and with the
// armature's inductance left out the motor gives
//
//     torque = gain kT / Ra u - (kfr + kT kB / Ra) w - Coulomb friction.
//
// An amplifier that holds a current (motor.drive = current) gives G u amperes whatever
// the speed,
//
//     torque = G kT u - kfr w - Coulomb friction,
//
// and its limit of current is one of the command.
//
// With the armature's inductance L the current is a state of its own,
//
//     L di/dt = gain u - Ra i - kB w,      torque = kT i - kfr w - Coulomb friction,
//
// and where an amplifier of voltage limits the current, i stays within the limit either
// way: without inductance it is (gain u - kB w)/Ra cut there. Such a drive is called
// electric here; its constants `torque` and `damping` hold nothing of the current.
//
// `motor.voltage` among the parameters is the command of an arm without a controller, and
// the one every arm starts with. The command in force is `voltage` here: a controller
// changes it from sample to sample, and leaves the parameter alone.
#pragma once

#include <math.h>

#include "src/tables/parameters.h"

typedef struct motor_model {
    double voltage_limit;   // largest command, of converter and current limit [V]
    double torque_per_volt; // of the command [N m/V]
    double damping;         // viscous friction and back EMF [N m s/rad]
    double stiction;        // Coulomb friction torque, kst [N m]
    double voltage;         // command in force, as the converter limits it [V]
    double torque;          // that it gives before back EMF and friction [N m]
    bool electric;          // the current is followed: the rest is of such a drive
    double gain;            // of the amplifier [-]
    double torque_constant; // kT [N m/A]
    double back_emf;        // kB [V s/rad]
    double resistance;      // Ra [ohm]
    double inductance;      // L, 0: the current follows immediately [H]
    double current_limit;   // HUGE_VAL: none [A]
} motor_model;

// Current [A] of an electric drive at the hub's velocity w [rad/s]; `state` is the
// current where it is a state of its own.
static inline double motor_current(const motor_model *m, double state, double w)
{
    double current = m->inductance > 0
                         ? state
                         : (m->gain * m->voltage - m->back_emf * w) / m->resistance;
    return fmax(-m->current_limit, fmin(current, m->current_limit));
}

// Derives the constants from resolved parameters; the command is `motor.voltage`.
void motor_init(motor_model *m, const motor_parameters *p);

// Another command [V], which the converter limits; costs a multiplication.
void motor_set_voltage(motor_model *m, double volts);

// Largest command either way: of the converter, and of the current a current drive may
// give [V].
double motor_command_limit(const motor_parameters *p);

// A command after that limit [V].
double motor_limited_voltage(const motor_parameters *p, double volts);

// Torque per volt of command, gain kT / Ra, of a current drive G kT [N m/V].
double motor_torque_per_volt(const motor_parameters *p);

// Damping torque per hub velocity, viscous friction plus back EMF, kfr + kT kB / Ra; of a
// current drive kfr alone [N m s/rad].
double motor_damping(const motor_parameters *p);

// What the amplifier feeds into the motor [J] while a command [V] is in force for
// `duration` [s] and the hub turns by `turn` [rad]: the integral of V (V - kB w) / Ra, V
// = gain x limited command; of a current drive that of i (Ra i + kB w). NaN of an
// electric drive, whose current these do not say.
double motor_electrical_energy(const motor_parameters *p, double volts, double duration,
                               double turn);
