// An independent simulation of an arm against a wall that gives, to judge the library by.
//
// It shares no code with src/: dense mass matrix, GSL's adaptive Runge-Kutta 8(9), bisection on
// re-integration. The hub has no Coulomb friction here.
#pragma once

#include <stdbool.h>

typedef struct soft_wall_case {
    const char *name;
    int links;          // N, 1 to 8
    bool beam_root;     // hub on the beam's root, a spring k2 N, instead of rigidly on the link
    bool plane_wall;    // flat wall for the tip instead of the fixed point
    bool hunt_crossley; // f = x^n (k + c v) instead of k x + c v
    double stiffness;   // k [N/m^n]
    double damping;     // c [N s/m^n]
    double exponent;    // n, Hunt-Crossley only
    double tip_mass;    // [kg]
    double face_mass;   // M of the face, which the tip strikes plastically; 0: none. One of
                        // Hunt-Crossley's wall comes to rest at a stop where it stands [kg]
    double voltage;     // command [V]
    double duration;    // [s]
} soft_wall_case;

// What comes out; the first pulse lasts from the first touch to the instant at which the wall's
// force is zero again.
typedef struct soft_wall_answer {
    double first_contact; // [s]
    double first_pulse;   // its length [s]
    double peak;          // largest force of the first pulse [N]
    double peak_delay;    // after first contact [s]
    double deepest;       // largest depth of the whole run [m]
    double wall_loss;     // [J]
    double steady_force;  // mean over the last 0.1 s [N]
    double final_hub_angle;
    double energy_residual; // at the end [J]
    int touches;            // times that the force begins
    double third_contact;   // of them [s]
    double impulse;         // of the first impact on a face [N s]
    double impact_loss;     // in all of them [J]
} soft_wall_answer;

// False if GSL's integrator gives up.
bool soft_wall_simulate(const soft_wall_case *c, soft_wall_answer *answer);
