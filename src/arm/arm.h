// What the arm is: hub, N links, springs, motor and wall as constants derived from the parameters.
//
// Coordinates. Every link has an absolute angle, measured from the reference direction and growing
// towards the wall. With a rigid hub joint, hub and first link share one; with a spring (k1, or the
// root k2 N of a beam) the hub has its own. Degree of freedom 0 is always the body the motor turns.
// The unit vector along link k is r_k = (cos, sin), across it t_k = (-sin, cos).
//
// Contact. g(q) is the penetration: negative in free flight, zero in contact, gap = -g. The wall
// acts with the generalised force -J^T f, J = dg/dq, f >= 0.
#pragma once

#include "src/arm/motor.h"
#include "src/arm/wall.h"

typedef struct arm {
    int links;                // N
    int dof;                  // degrees of freedom n: N, or N + 1 with a hub spring
    int first;                // index of the first link's angle: 0, or 1 with a hub spring
    bool hub_spring;          // the hub is a body of its own, on a spring
    bool root_bends;          // that spring is part of the beam: its root
    double link_length;       // l [m]
    double link_mass;         // m [kg]
    double link_inertia;      // about the centre of mass [kg m2]
    double hub_inertia;       // I1 [kg m2]
    double tip_mass;          // that the tip carries [kg]
    double hub_stiffness;     // k1 or k2 N, zero with a rigid hub joint [N m/rad]
    double joint_stiffness;   // of each inner joint, k2 N/2 [N m/rad]
    double hub_joint_damping; // structural damping of the hub spring [N m s/rad]
    double joint_damping;     // structural damping of each inner joint [N m s/rad]
    motor_model motor;        // with the command in force
    wall_model wall;
    double highest_frequency; // upper estimate over the arm's free modes [rad/s]
    double fastest_decay;     // of overdamped modes and of the hub alone [1/s]
    double fastest_rate;      // the same or, if faster, weighted decays: sets the steps [1/s]
} arm;

// Derives the constants from resolved parameters (corrected model); the command is motor.voltage.
// Cost grows linearly with N. In arm_setup.c, which sweeps the chain for its fastest mode.
void arm_init(arm *a, const parameters *p);

// Puts another command [V] in force, at the cost of a multiplication; all else stays. The arm of a
// run under a controller is at the controller's command, whatever motor.voltage says.
void arm_set_voltage(arm *a, double volts);
