// Bounds for every controller: the least peak and the least settling time after an
// impact, for a controller that knows the whole state at every instant and commands
// without delay.
//
// In contact the two-link arm has one degree of freedom, x = theta2 - theta_imp
// (docs/explanation/control-design.md):
//
//     M x'' = T - D x' - friction - 4 k2 x,     |T| <= Kt times limit
//     f = (2 k2/l) x - mu x''
//
// which is linear: at 0.1 rad the force of the arm itself is some 2 % less.
#pragma once

#include "src/tables/parameters.h"
#include "src/predict/predict.h"

// The arm on the wall.
typedef struct pressed_arm_model {
    double inertia;        // M [kg m2]
    double stiffness;      // 4 k2 [N m/rad]
    double damping;        // D [N m s/rad]
    double viscous;        // of it what is no back EMF [N m s/rad]
    double stiction;       // [N m]
    double torque_limit;   // either way [N m]
    double current_torque; // either way of motor and back EMF, HUGE_VAL: any [N m]
    double spring_force;   // 2 k2/l [N/rad]
    double mass_force;     // mu, above 0 [N s2/rad]
} pressed_arm_model;

// Angle of the hub from the wall [rad] and its velocity [rad/s].
typedef struct pressed_state {
    double x, velocity;
} pressed_state;

// The model of an arm. False where it does not hold: other than two bare links, a spring
// at the hub, a beam with damping, a tilted plane, no wall or one that gives or moves,
// the printed model.
bool pressed_arm_model_of(const parameters *p, pressed_arm_model *m);

// The state just after a plastic impact at the angles and velocities of a state before
// it, (4.10)-(4.17). False if there is no single impulse.
bool pressed_after_impact(const parameters *p, const three_body_state *before,
                          pressed_state *after);

// The least peak [N] with which the arm can be brought to rest in contact: 4 k2 (x +
// x'/s) in the two-link arm's own numbers, more where the motor cannot brake as hard as
// that. NaN where the arm moves away from the wall or is bent so far back that it will.
double best_peak(const pressed_arm_model *m, pressed_state s);

// The least time [s] after which the force is within `band` (a share) of `force` for
// good, if it has to stay between 0 and `peak` [N], or the band's upper edge where that
// is higher. NaN where there is no way within a second: the arm leaves the wall, runs
// away under every such force, or the motor is too weak to hold the force.
double best_settling(const pressed_arm_model *m, pressed_state s, double force,
                     double band, double peak);
