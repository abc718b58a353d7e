// Equations of motion of the hub-and-links chain, solved in a time that grows linearly with N.
//
// From the Lagrangian of N uniform rods in the horizontal plane,
//
//     M(q) a + c(q, w) = tau(q, w) - J^T f,      M_ij = A_ij cos(q_i - q_j),
//
// with A_ij = m l^2 (N - max(i, j) + 1/2) off the diagonal (i, j = 1..N). M is never formed. The
// chain is swept from the tip to the hub: what the links beyond node k demand of it is a force
//
//     F_k = P_k a_{k-1} + Q_k            (a_{k-1}: acceleration of the node at the base of link k)
//
// where P_k (2 x 2, symmetric) is the mass those links show at the node and Q_k gathers velocity
// terms, spring torques and the contact force. The balance of moments of link k about its base,
//
//     (I + m l^2/4 + l^2 t'P t) alpha_k + u'a_{k-1} = tau_k - l t'(Q - l w_k^2 P r),
//     u = (m l/2) t + l P t,
//
// gives alpha_k and, eliminated, P_{k-1} and Q_{k-1}. A second sweep from the hub to the tip then
// yields all accelerations. With N = 2, I1 added to the first link and f at the contact point these
// are the corrected forms of (2.15)-(2.17); see docs/physics.md.
#pragma once

#include "src/arm/arm.h"

// Scratch of one link during the sweeps.
typedef struct chain_link {
    double c, s;   // r_k = (c, s), t_k = (-s, c)
    double inv_d;  // 1 / (I + m l^2/4 + l^2 t'P t) [1/(kg m2)]
    double ux, uy; // u [kg m]
    double free;   // acceleration with a resting base, no contact [rad/s2]
    double unit;   // the same from a unit contact force [rad/s2 per N]
} chain_link;

typedef enum hub_friction { HUB_STICK = 0, HUB_FORWARD = 1, HUB_BACKWARD = -1 } hub_friction;

// What holds at an instant: the wall touched or not, the hub stuck or sliding which way.
typedef struct contact_state {
    bool contact;
    hub_friction friction;
} contact_state;

typedef struct chain_reaction {
    double force;             // f, zero without contact [N]
    double friction;          // Coulomb friction torque on the hub [N m]
    double gap, gap_velocity; // of the contact point, infinite and zero without a wall [m], [m/s]
    double gap_acceleration;  // second derivative of the gap, zero in contact [m/s2]
    double viscous_power;     // lost to back EMF and viscous friction [W]
    double damping_power;     // lost in the springs' structural damping [W]
} chain_reaction;

// Accelerations alpha[dof] at angles q[dof] and velocities w[dof] under the given mode, and the
// reactions. work: links elements of scratch. In contact, f follows from d2g/dt2 = 0, the
// derivative of the wall's constraint, (3.13) for N = 2; a stuck hub has no acceleration and
// friction is what that takes. With one link on a rigid hub a touched wall already holds the hub:
// friction is then taken as zero.
void chain_accelerations(const arm *a, chain_link *work, const double *q, const double *w,
                         contact_state mode, double *alpha, chain_reaction *reaction);

// Penetration g [m], its rate [m/s] (either may be NULL).
void chain_penetration(const arm *a, const double *q, const double *w, double *g, double *rate);

// Response to a unit contact force: response[dof] = -M^-1 J^T, and compliance J M^-1 J^T > 0
// [1/kg]. hub_locked keeps the hub where it is.
void chain_contact_response(const arm *a, chain_link *work, const double *q, bool hub_locked,
                            double *response, double *compliance);

// The rate of penetration of a velocity-like vector: J v, J taken at q.
double chain_penetration_rate(const arm *a, const double *q, const double *v);

// response[dof] = M^-1 of a unit impulse at the tip, across the last link towards growing angle.
void chain_tip_response(const arm *a, chain_link *work, const double *q, double *response);

// Kinetic energy [J] and strain energy [J].
double chain_kinetic_energy(const arm *a, const double *q, const double *w);
double chain_strain_energy(const arm *a, const double *q);

// Position of node k = 0..N (0 the hub axis, N the tip) [m].
void chain_node(const arm *a, const double *q, int k, double *x, double *y);
