// A second, independent simulation of the corrected arm, to judge the library by.
//
// It shares no code with src/: dense mass matrix, dense KKT systems, GSL's adaptive
// Runge-Kutta 8(9) and bisection on re-integration. Slow and plain on purpose.
#pragma once

#include <stdbool.h>

enum { REFERENCE_SAMPLES = 501 }; // of the momentum, from first contact on

#define REFERENCE_INTERVAL 1e-4 // between them [s]

// What is simulated. The arm starts straight, at rest and at angle zero unless said
// otherwise.
typedef struct reference_case {
    const char *name;
    int links;           // N, 1 to 64
    bool spring_hub;     // hub on the spring k1 instead of rigidly on the first link
    bool plane_wall;     // flat wall for the tip instead of the fixed point
    double voltage;      // command [V]
    double restitution;  // e [-]; impacts below 1e-4 m/s are plastic
    double duration;     // [s]
    double tolerance;    // absolute and relative, of the integrator
    double longest_step; // between two looks at the event functions [s]
    bool beam_root;      // the hub on the beam's root, a spring k2 N
    double damping;      // of the first clamped mode, structural [-]
    double angle;        // of all links at the start [rad]
    double velocity;     // of all links at the start [rad/s]
} reference_case;

// What comes out. What did not occur is NaN.
typedef struct reference_answer {
    double first_contact; // [s]
    double first_impulse; // [N s]
    double
        first_approach; // speed of the gap's closing just before the first impact [m/s]
    double first_pulse_peak;    // largest force from first contact to first release [N]
    double first_pulse_delay;   // of that force, after first contact [s]
    double first_pulse;         // first contact to first release [s]
    double peak;                // largest force of the whole run [N]
    double peak_delay;          // of that force, after first contact [s]
    double steady_force;        // mean over the last 0.1 s [N]
    int impacts;                // closings with an approach velocity
    int touches;                // free phases after first contact, however short
    int separations;            // those of them with a gap above 1 um
    double smallest_separation; // largest gap of the narrowest counted separation [m]
    double largest_touch;       // largest gap of the widest one not counted [m]
    double slowest_approach;    // of all impacts [m/s]
    double last_impact;         // instant of the last impact [s]
    double weakest_hold; // smallest |f| that decided hold or release after an impact [N]
    double final_hub_angle; // [rad]
    double motor_work;      // of the torque the command makes, back EMF not taken off [J]
    double viscous_loss;    // back EMF and viscous friction [J]
    double damping_loss;    // structural damping [J]
    double friction_loss;   // Coulomb friction [J]
    double impact_loss;     // [J]
    double energy_residual; // largest |energy - work + losses| over the run [J]
    double
        largest_gap_error; // largest |gap| of a step in contact before its projection [m]

    // impulses and integral of the force until k intervals after first contact [N s]; as
    // many of them as the run is long enough for
    double momentum[REFERENCE_SAMPLES];
    int samples;
} reference_answer;

// Simulates the case. On failure returns false with a sentence in message (size bytes).
bool reference_simulate(const reference_case *c, reference_answer *answer, char *message,
                        int size);
