// The contact state at an instant, in which every transition of the contact machine ends
// (contact_machine.c).
#pragma once

#include "src/contact/motion.h"

// Kinds of event the machine meets.
typedef enum motion_event {
    MOTION_REACHED, // the wanted time
    MOTION_IMPACT,
    MOTION_TOUCH, // contact begins without an approach velocity
    MOTION_RELEASE,
    MOTION_STICK,
    MOTION_SLIP,
} motion_event;

// Finds the one combination of contact and hub friction that violates nothing and
// evaluates the state under it. Gauss's principle makes the problem a strictly convex
// one, since the friction torque is bounded independently of the contact force: there is
// exactly one solution. At an event two combinations satisfy the conditions to rounding;
// `event` tells which of them the motion has just left. A wall that gives leaves no
// choice: it is touched if `touching`, and friction alone is to be found.
void contact_resolve(const arm *a, motion *m, bool touching, motion_event event);

// Checks the numbered invariants of contact_machine.c.
void contact_check(const arm *a, const motion *m);
