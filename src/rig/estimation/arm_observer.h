// An observer of the arm for controllers: a Kalman filter on the reduced arm, free or
// with its tip at the wall, with a constant torque and the wall's angle among its states,
// and the estimate carried over where contact begins and ends.
#pragma once

#include "src/rig/estimation/estimator.h"
#include "src/rig/estimation/hub_sensors.h"
#include "src/rig/estimation/reduced_arm.h"

// Standard deviation that the torque is taken to have from sample to sample [N m].
#define ARM_OBSERVER_TORQUE_NOISE 0.1

// States: modal coordinates, their rates, in contact the wall's angle, and last the
// torque that the model does not know of.
typedef struct arm_observer {
    reduced_arm arm;
    double torque_per_volt; // [N m/V]
    double hub_damping;     // [N m s/rad]
    double stiction;        // [N m]
    double period, delay;   // [s]
    // either state over the delay of a command, with the one before in effect, and over
    // the rest
    modal_model free_model[2], contact_model[2];
    bool touches;        // the tip is at the wall
    bool young;          // and for so short a time that it may have bounced off unseen
    estimator e;         // the estimate
    estimator flown;     // a second one while a contact is young: the tip has bounced off
    double last_voltage; // in effect at the sample before [V]
    double since;        // when the contact or the flight began [s]
    double wall, wall_variance; // as last known [rad], [rad2]
    double tip_before, tip_now; // tip angle in flight at the last two samples [rad]
    double met;                 // wall's angle at the touch [rad]
    // stiffness of the first mode in contact over its nominal one; the two sums whose
    // quotient it is; and what is added to both for the nominal one [N2 s]
    double stiffness, stiff_force, stiff_bend, stiff_nominal;
    // misfit of its predictions to the readings while the hub moved: -2 log likelihood of
    // the readings, each with its own noise and Student's tails; its difference from
    // another model's misfit is the evidence for this one; infinite where nobody follows
    double missed;
    bool moves; // the hub moves at the present sample
} arm_observer;

// Models the arm that the setup describes, at rest at an angle still to be read, which is
// to press with about `force` [N] and carries tip_mass [kg] at its tip, at a wall of a
// stiffness [N/m], HUGE_VAL a rigid one. NULL, or a sentence that says why it cannot.
const char *arm_observer_init(arm_observer *o, const controller_setup *setup,
                              double force, double tip_mass, double wall_stiffness);

// Starts at rest where the encoder is.
void arm_observer_start(arm_observer *o, const controller_input *in);

// Tells the observer, before the first touch, the wall's exact angle [rad].
void arm_observer_know_wall(arm_observer *o, double angle);

// Takes in one sample: the estimate follows the arm over the period before it and takes
// in all readings. `in` is what hub_sensors_read has returned and `s` what it has
// learned. `felt` is the number of readings in a row that have shown contact; the force
// of the first one is not taken in, since it shows the impact too.
void arm_observer_sample(arm_observer *o, const hub_sensors *s,
                         const controller_input *in, int felt);

// The tip met the wall, plastically, or left it, after the last sample and before now.
void arm_observer_touch(arm_observer *o, double time);
void arm_observer_leave(arm_observer *o, double time);

// Whether the tip, left by a young contact, is on its way to the wall again.
bool arm_observer_returns(const arm_observer *o);

// The estimate at the instant at which a command given now takes effect, with a voltage
// in effect until then [V].
estimator arm_observer_ahead(const arm_observer *o, double voltage);

// The index of the torque among the states.
int arm_observer_torque_index(const arm_observer *o);

// Square of the frequency of mode i of the present state [1/s2], of the first in contact
// with the stiffness that the readings have shown: what a wrong k2, a spring at the hub
// or more links than nominal come to at rest.
double arm_observer_square(const arm_observer *o, int i);

// Of an estimate: tip angle [rad], hub velocity [rad/s].
double arm_observer_tip(const arm_observer *o, const estimator *e);
double arm_observer_rate(const arm_observer *o, const estimator *e);

// Torque that holds the hub where the estimate has it, without friction, that of the
// unknown torque included [N m].
double arm_observer_holding_torque(const arm_observer *o, const estimator *e);

// Contact force of an estimate in contact under a motor torque on the hub [N].
double arm_observer_force(const arm_observer *o, const estimator *e, double drive);

// Standard deviation that a reading of the force sensor is taken to have at a force [N].
double arm_observer_force_noise(double force);

// Change of that force with the torque, at once [1/m].
double arm_observer_force_per_torque(const arm_observer *o);
