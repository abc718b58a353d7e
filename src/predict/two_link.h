// What the predictors share: the two-link arm at a given bend, as masses, levers and
// constraint.
//
// Rows as in (2.16) and (2.17): balance of both links together, balance of the second
// link alone.
#pragma once

#include <stdbool.h>

#include "src/tables/parameters.h"
#include "src/predict/predict.h"

// Which of the thesis's simplifications the terms carry.
typedef enum two_link_form {
    FORM_LISTED_IMPACT, // the listing's impact predictor: I2, I3 left out but in one
                        // place, cos d = 1 in two terms, (a, b) where the wall is
    FORM_LISTED_ENERGY, // the listing's energy predictor: whole masses, both levers as in
                        // (4.34)
    FORM_CORRECTED,     // the project's derivation, with the contact point on the arm
} two_link_form;

typedef struct two_link {
    double length, centre; // l, e [m]
    double m22, m23;       // factors of the accelerations in (2.16) [kg m2]
    double m32, m33;       // the same in (2.17) [kg m2]
    double both, last;     // levers of the contact force in (2.16), (2.17) [m]
    double j2, j3;         // dg/dtheta2, dg/dtheta3 of the contact constraint [m]
    bool rigid_hub; // hub and first link are one body: m22 holds I1 (corrected form only)
    double motor_torque; // kT/Ra times the amplified, limited command [N m]
    double hub_damping;  // kfr + kT kB/Ra [N m s/rad]
} two_link;

// Terms of the arm at angles theta2, theta3 [rad].
void two_link_at(two_link *t, const parameters *p, two_link_form form, double angle2,
                 double angle3);

// 1, -1, or 0 of 0.
double sign_of(double x);

// Moment of inertia of one of two uniform links about its centre of mass: the parameter
// where the arm has two links, else that of a uniform rod half as long as the arm [kg
// m2].
double two_link_inertia(const parameters *p);

// Speed at which the contact point comes through the link's line, positive when closing
// [m/s].
double two_link_approach_speed(const two_link *t, const three_body_state *s);

// Solves m22 x2 + m23 x3 + both x4 = r[0], m32 x2 + m33 x3 + last x4 = r[1], j2 x2 + j3
// x3 = r[2] in place: accelerations and force, or velocity increments and impulse. False
// if singular.
bool two_link_solve(const two_link *t, double r[3]);

// Velocity increments of a plastic impact, (4.11), (4.12), (4.14): M (Dw2, Dw3) = -(both,
// last) p and J (w + Dw) = 0. The hub's own increment is zero by (4.10) because its
// spring gives only a finite torque; without a spring it is one body with the first link.
// after[3]: velocities just after [rad/s], *impulse p [N s]. STATUS_SINGULAR with a
// sentence if there is no single solution.
status two_link_velocity_jump(const two_link *t, const three_body_state *s,
                              double after[3], double *impulse, fault *f);

// Coefficient of restitution of an impact with this approach: of the corrected arm,
// beside a speed below which it is plastic; the printed equations know none, 0.
double two_link_restitution(const two_link *t, const parameters *p,
                            const three_body_state *s);

// Contact force just after the impact [N], from (2.16) without the doubled spring, (2.17)
// and the constraint's second derivative at the velocities after[3]. Corrected form only.
// Where it is negative the arm leaves the wall at once. NaN if singular.
double two_link_first_force(const two_link *t, const parameters *p,
                            const three_body_state *s, const double after[3]);

// STATUS_NOT_FINITE with a sentence that names the first number of the state that is not
// finite.
status three_body_state_check(const three_body_state *s, fault *f);
