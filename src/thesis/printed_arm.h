// The arm as the thesis prints it: hub, two links, springs k1 and k2, equations
// (2.15)-(2.17) and the contact constraint (3.9). Each departure from sound mechanics
// hangs on a switch of parameters.printed, so that the thesis can be reproduced and its
// slips weighed one by one.
//
// Notation: angles q[3] = theta1, theta2, theta3 (hub, first link, second link) [rad],
// velocities w[3] [rad/s], accelerations alpha[3] [rad/s2], bend d = theta3 - theta2, f
// the contact force [N].
//
//     R1 = I1 alpha1 - k1 (theta2 - theta1) + kv w1 + kst sgn(w1) - torque         (2.15)
//     R2 = k1 (theta2 - theta1) - B k2 d
//          + (m e2 + m l2 + I + m l e cos d) alpha2 + (m e2 + I + m l e cos d) alpha3
//          - m l e sin d (w3^2 - w2^2) + f r2                                      (2.16)
//     R3 = k2 d + m l e cos d alpha2 + (m e2 + I) alpha3
//          + m l e sin d w2^2 + f r3                                               (2.17)
//     R4 = g = a sin theta3 - b cos theta3 - l sin d                               (3.9)
//
// with e2 = e^2, l2 = l^2, e the distance of a link's centre of mass from its joint and
// kv = kfr + kT kB/Ra. (2.16) is the balance of both links together, (2.17) that of the
// second. B = 1 with `spring_counted_twice` (the term does not belong there), else 0. The
// levers of f are r2 = l (1 + cos d), r3 = l with `force_at_link_end`, else those of the
// contact point itself, r2 = l cos d + A, r3 = A, A = dg/dtheta3 = a cos theta3 + b sin
// theta3 - l cos d.
#pragma once

#include <stdbool.h>

#include "src/arm/motor.h"
#include "src/arm/wall.h"

typedef struct printed_arm {
    double link_length;  // l [m]
    double centre;       // e, from a link's joint to its centre of mass [m]
    double link_mass;    // m2 = m3 [kg]
    double link_inertia; // I2 = I3 about the centre of mass [kg m2]
    double hub_inertia;  // I1 [kg m2]
    double k1, k2;       // [N m/rad]
    motor_model motor;   // kfr + kT kB/Ra, kst, and the command in force
    wall_model wall;     // only where it stands, (a, b)
    printed_parameters switches;
} printed_arm;

// Coefficients of Newmark's approximation: how acceleration and velocity at the end of a
// step answer to a change of the angle there.
typedef struct newmark_slopes {
    double acceleration; // 1 / (beta h^2) [1/s2]
    double velocity;     // gamma / (beta h) [1/s]
} newmark_slopes;

// Derives the constants from resolved parameters of a two-link arm.
void printed_arm_init(printed_arm *a, const parameters *p);

// Sign of a velocity [rad/s] as the listing takes it: zero in a dead band around rest,
// 1e-5 either way. The first of the listing's three tests names -1e-2 for the lower edge;
// the third overrules it, so that `sign_dead_band` changes nothing.
double printed_sign(double velocity);

// residual[4] = R1..R4 at angles q, velocities w, accelerations alpha and contact force
// f. Free flight is f = 0 and the first three.
void printed_residual(const printed_arm *a, const double q[3], const double w[3],
                      const double alpha[3], double force, double residual[4]);

// jacobian[4][4] = d(R1..R4) / d(theta1, theta2, theta3, f) with velocities and
// accelerations tied to the angles by Newmark's approximation. Exact but for the jumps of
// sgn.
void printed_newmark_jacobian(const printed_arm *a, newmark_slopes slopes,
                              const double q[3], const double w[3], const double alpha[3],
                              double force, double jacobian[4][4]);

// Penetration g of (3.9): positive when the contact point lies behind the link's line
// [m].
double printed_penetration(const printed_arm *a, const double q[3]);

// Gradient dg/dtheta [m] of (3.9); its product with the velocities is the left side of
// (3.12).
void printed_constraint_gradient(const printed_arm *a, const double q[3],
                                 double gradient[3]);

// Accelerations alpha[3] and contact force from the linear system of (2.15)-(2.17) and
// (3.13) at given angles and velocities. Where `reevaluation` is `listing` the term 2 l
// sin d w2 w3 of (3.13) multiplies the force. Returns false if the system is singular.
bool printed_reevaluate(const printed_arm *a, const double q[3], const double w[3],
                        double alpha[3], double *force);
