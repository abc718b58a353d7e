// The forces that not every arm has, by the place where they act. Joints that answer in
// proportion to their bend and its rate, a motor whose current follows at once, Coulomb
// friction at the hub and rigid walls are in every engine's equations and stand in no
// list.
//
// A row is
//     X(feature, law, path, amount, methods)
// with the bit of feature_bits.h that it makes; the function of src/arm/forces.h that
// adds the force; the parameter that brings it, which refusals name; how much of it there
// is for parameters p, 0 where it does not act; and whether ANY_METHOD (method.name) has
// it or EVENT_ONLY. The amount of a force is a member of arm.amount, by the name of its
// law; of one whose numbers stand elsewhere it is 1. Both sweeps along the chain and the
// tangent of the stiff engine call every law of a place, so that a row without its law,
// or a law without its row, does not compile. The engine `pair` knows none of these
// forces: an arm that has one goes to the stiff engine, and other methods and predictors
// refuse it, as everything refuses a parameter whose force does not act.
#pragma once

#include "src/base/sincos.h"

#define STANDARD_GRAVITY 9.80665 // [m/s2]

// In a joint, against its bend.
//     stiffening: share by which a joint stiffens with the square of its bend [1/rad2]
#define JOINT_FORCES(X)                                                                  \
    X(STIFFENS, stiffening, "arm.stiffening",                                            \
      p->arm.stiffening * p->arm.links * p->arm.links / 4, EVENT_ONLY)

// On a link, along its whole length, or on what the tip carries.
//     air_drag: force per length and velocity [N s/m2]
//     gravity: its part in the arm's plane, along the angle -pi/2 [m/s2]
#define LINK_FORCES(X)                                                                   \
    X(AIR, air_drag, "arm.air_drag", p->arm.air_drag, EVENT_ONLY)                        \
    X(TILTED, gravity, "arm.tilt", STANDARD_GRAVITY *inline_sin(p->arm.tilt), ANY_METHOD)

// In all joints at once, on the rate of a shape that the arm bends in.
//     modal_damper: arm.modal_damping has the shapes
#define SHAPE_FORCES(X)                                                                  \
    X(MODAL, modal_damper, "arm.modal_ratios", p->arm.modal_ratios[0] != '\0', EVENT_ONLY)

// At the hub.
//     armature_current: of a motor whose current has an equation of its own
#define HUB_FORCES(X)                                                                    \
    X(ELECTRIC, armature_current, "motor.inductance",                                    \
      p->motor.drive == DRIVE_VOLTAGE &&                                                 \
          (p->motor.inductance > 0 || p->motor.current_limit > 0),                       \
      EVENT_ONLY)

// At the wall, along its normal and across.
//     wall_yields: of a wall that gives
#define WALL_FORCES(X)                                                                   \
    X(GIVES, wall_yields, "wall.contact",                                                \
      p->wall.kind != WALL_NONE && p->wall.contact != WALL_RIGID, EVENT_ONLY)

#define FORCE_LIST(X)                                                                    \
    JOINT_FORCES(X)                                                                      \
    LINK_FORCES(X)                                                                       \
    SHAPE_FORCES(X)                                                                      \
    HUB_FORCES(X)                                                                        \
    WALL_FORCES(X)
