// What the sweeps along the chain work on and give back: chain.h has the derivation.
#pragma once

#include "src/arm/arm.h"

// Scratch of one link during the sweeps.
typedef struct chain_link {
    double c, s;   // r_k = (c, s), t_k = (-s, c)
    double inv_d;  // 1 / (I + m l^2/4 + l^2 t'P t) [1/(kg m2)]
    double ux, uy; // u [kg m]
    double free;   // acceleration with a resting base, no contact [rad/s2]
    double unit;   // the same from a unit contact force [rad/s2 per N]
} chain_link;

typedef enum hub_friction {
    HUB_STICK = 0,
    HUB_FORWARD = 1,
    HUB_BACKWARD = -1
} hub_friction;

// What holds at an instant: the wall touched or not, the hub stuck or sliding which way.
typedef struct contact_state {
    bool contact;
    hub_friction friction;
    double current; // of a motor whose current is a state of its own [A]
} contact_state;

typedef struct chain_reaction {
    double force;    // f, zero without contact [N]
    double friction; // Coulomb friction torque on the hub [N m]
    double gap,
        gap_velocity; // of the contact point, infinite and zero without a wall [m], [m/s]
    double gap_acceleration; // second derivative of the gap, zero on a rigid wall [m/s2]
    double viscous_power;    // lost to back EMF and viscous friction [W]
    double damping_power;    // lost in the springs' structural damping [W]
    double wall_power;       // lost in a wall that gives [W]
    double wall_work;        // power of a wall that moves [W]
    double motor_torque;     // of the current of an electric drive, else 0 [N m]
} chain_reaction;
