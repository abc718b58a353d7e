// The arm near rest as a linear system, alone, sampled, and in the loop of a control law.
//
//     x' = A x + B u,    y = C x + D u       u: the command [V]
//
// about the arm at rest: free, pressing on the wall, or pressing with the hub held by friction.
// Coulomb friction itself has no linear part. Back EMF, viscous friction, damping, the wall's law
// and the bend under the force are in A. Eigenvalues are LAPACK's, which is loaded by the first
// call that needs it.
#pragma once

#include <complex.h>

#include "src/scenario/scenario.h"

typedef enum linear_place { LINEAR_FREE, LINEAR_CONTACT, LINEAR_STUCK } linear_place;

// A system of one input, matrices row by row.
typedef struct linear_system {
    int states, outputs;
    double *a, *b, *c, *d; // [states * states], [states], [outputs * states], [outputs]
} linear_system;

// Makes room for a system of zeros, to be freed with linear_system_finish. STATUS_NO_MEMORY.
status linear_system_init(linear_system *s, int states, int outputs, fault *f);
void linear_system_finish(linear_system *s); // one of zeros is accepted

// Outputs of the arm, in this order.
enum {
    LINEAR_HUB_ANGLE,
    LINEAR_HUB_VELOCITY,
    LINEAR_HUB_ACCELERATION,
    LINEAR_BENDING, // last link's angle minus the first's
    LINEAR_TIP,     // its displacement across the line from the hub
    LINEAR_FORCE,
    LINEAR_OUTPUTS
};
typedef struct linear_output_info {
    const char *name, *unit;
} linear_output_info;
extern const linear_output_info linear_output_table[LINEAR_OUTPUTS];

enum { LINEAR_MOST_LINKS = 64 };

// The arm about its place of rest. States: angles that the wall and a held hub leave, in the order
// of the bodies from the hub outwards, their rates, and the current of a motor with inductance.
typedef struct linear_arm {
    linear_system system;
    double voltage;   // command that holds the arm there, friction aside [V]
    double force;     // with which it presses [N]
    double hub_angle; // [rad]
    double bending;   // [rad]
} linear_arm;

// Linearises the corrected arm of a scenario. It presses with control.force where a law is to hold
// it, else under motor.voltage. STATUS_BAD_ARGUMENT, with a sentence in f, for an arm that has no
// such place of rest. To be freed with linear_system_finish(&arm->system).
status linear_arm_init(linear_arm *arm, const parameters *p, linear_place place, fault *f);

// --- eigenvalues and answers ------------------------------------------------------------------

// Eigenvalues of matrix[n * n], which is overwritten, in rising order of their size; a pair has its
// positive imaginary part first. STATUS_SINGULAR if the iteration does not end, STATUS_SINGULAR,
// too, with a sentence in f where there is no LAPACK.
status linear_eigenvalues(int n, double *matrix, double complex *values, fault *f);

// Poles of a system, values[states].
status linear_poles(const linear_system *s, double complex *values, fault *f);

// Zeros from its input to an output, of which there are *count, at most states. A system whose
// output does not see the input has none.
status linear_zeros(const linear_system *s, int output, int *count, double complex *values,
                    fault *f);

// Damping ratio of a pole or zero; 1 of a decaying real one, NaN at the origin.
double linear_damping(double complex s);
