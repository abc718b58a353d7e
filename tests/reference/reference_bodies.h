// The arm of the independent simulation: a chain of rigid bodies with its dense equations
// of motion, and the contact modes that they allow.
#pragma once

#include <math.h>

#include "tests/reference/reference_arm.h"

enum {
    LINKS_MAX = 64,
    BODIES_MAX = LINKS_MAX + 1,
    UNKNOWNS_MAX = BODIES_MAX + 2,
    // angles, velocities, motor work, viscous, Coulomb and damping loss, integral of the
    // force
    EXTRA = 5,
    STATE_MAX = 2 * BODIES_MAX + EXTRA,
};

// math.h's are floats, which clang minds
#define NOTHING ((double)NAN)
#define NEVER   ((double)INFINITY)

typedef struct body_chain {
    int bodies, links, first_link;
    bool plane;
    double length;                  // of a link [m]
    double mass;                    // of a link [kg]
    double own_inertia[BODIES_MAX]; // about the centre of mass, with the hub's [kg m2]
    double coupling[BODIES_MAX][BODIES_MAX];  // A_ij [kg m2]
    double stiffness[BODIES_MAX];             // joint between body i and i + 1 [N m/rad]
    double damping[BODIES_MAX];               // of the same joint [N m s/rad]
    double motor_torque, motor_drag, coulomb; // [N m], [N m s/rad], [N m]
    double direction;                         // of the wall [rad]
    double restitution;
} body_chain;

typedef struct contact_mode {
    bool touching;
    int sliding; // -1, 0 (sticking), +1: direction of the hub's motion
} contact_mode;

// Accelerations and the forces that go with them.
typedef struct balance {
    double acceleration[BODIES_MAX];
    double force;            // contact [N]
    double friction;         // torque that opposes positive motion [N m]
    double gap_acceleration; // second derivative of the gap [m/s2]
} balance;

// The chain of a case.
void body_chain_build(body_chain *arm, const reference_case *c);

// Penetration g (the gap is -g), its gradient, and the part of its second derivative that
// the velocities alone make.
double body_penetration(const body_chain *arm, const double *q, const double *w,
                        double *gradient, double *bias);

// The rate at which the gap grows [m/s].
double body_gap_rate(const body_chain *arm, const double *q, const double *w);

// The gap [m].
double body_gap(const body_chain *arm, const double *q, const double *w);

// Kinetic and strain energy [J].
double body_energy(const body_chain *arm, const double *q, const double *w);

// Solves M x + J' f + S' s = right, J x = along (if touching), S x = 0 (if sticking),
// where S picks the hub. Returns f and s.
bool balance_solve(const body_chain *arm, const double *q, const double *gradient,
                   bool touching, bool sticking, const double *right, double along,
                   double *x, double *f, double *s);

// Accelerations in a mode, whether or not the mode is admissible.
bool balance_find(const body_chain *arm, const double *y, contact_mode mode,
                  balance *out);

// The admissible mode at a state: contact (only if the gap is closed and stays so) and
// friction together, by trying all combinations.
bool mode_resolve(const body_chain *arm, const double *y, bool may_touch,
                  contact_mode *mode);
