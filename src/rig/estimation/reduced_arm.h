// The nominal arm of a controller, reduced to its first modes: in free flight, and with
// its tip at the wall.
//
// With M and K of the straight chain, J = (l ... l) the tip's displacement by the link
// angles and r the rotation of all bodies together, K r = 0, the modes phi are those of K
// phi = w^2 M phi, free or with J phi = 0, scaled to phi'M phi = 1. In either state q =
// sum a_i phi_i (+ r theta_wall in contact) and
//
//     a_i'' = -w_i^2 a_i - c_i a_i' + h_i T,        h_i = phi_i at the hub,
//
// with T the torque on the hub, damping and friction included. The angular momentum of
// all bodies gives the contact force without loss at rest, however many modes are left
// out:
//
//     L f = T - sum p_i a_i'',                      p_i = phi_i'M r.
//
// A plastic touch keeps what M projects: a_contact = X a_free - p theta_wall with X =
// phi_c'M phi_f, and a release a_free = X'a_contact + p_free theta_wall.
#pragma once

#include "src/rig/controller.h"

enum { REDUCED_MODES = 5 }; // at most

// At a wall that gives the modes in contact are those with a spring J'k J at the tip, its
// wall at rest at theta_wall; a touch then keeps all of the motion.

// The modes of one of both states.
typedef struct mode_set {
    int count;
    double square[REDUCED_MODES];  // w^2 [1/s2]
    double damping[REDUCED_MODES]; // c [1/s]
    double hub[REDUCED_MODES];     // h: hub angle [1/sqrt(kg m2)]
    double tip[REDUCED_MODES]; // tip displacement over the arm's length [1/sqrt(kg m2)]
    double momentum[REDUCED_MODES]; // p [sqrt(kg m2)]
} mode_set;

typedef struct reduced_arm {
    double length;  // L [m]
    double inertia; // of all bodies about the hub, r'M r [kg m2]
    mode_set free, contact;
    double touch[REDUCED_MODES][REDUCED_MODES]; // X: contact by free
} reduced_arm;

// Reduces the arm of a setup, a mass [kg] at its tip and at a wall of a stiffness [N/m]
// (HUGE_VAL: a rigid one), to the modes below half the Nyquist frequency of its samples,
// at least one that bends and at most REDUCED_MODES. NULL, or a sentence that says why
// that cannot be: reduced_arm_no_memory itself where there was no memory, which says
// nothing of the arm.
const char *reduced_arm_init(reduced_arm *r, const controller_setup *setup,
                             double tip_mass, double wall_stiffness);
extern const char reduced_arm_no_memory[];

// Static compliance: rotation of the hub per torque with the tip at the wall [rad/(N m)].
double reduced_arm_compliance(const reduced_arm *r);
