// Equations of motion of the hub-and-links chain, solved in a time that grows linearly
// with N.
//
// From the Lagrangian of N uniform rods in the horizontal plane,
//
//     M(q) a + c(q, w) = tau(q, w) - J^T f,      M_ij = A_ij cos(q_i - q_j),
//
// with A_ij = m l^2 (N - max(i, j) + 1/2) off the diagonal (i, j = 1..N). M is never
// formed. The chain is swept from the tip to the hub: what the links beyond node k demand
// of it is a force
//
//     F_k = P_k a_{k-1} + Q_k            (a_{k-1}: acceleration of the node at the base
//     of link k)
//
// where P_k (2 x 2, symmetric) is the mass those links show at the node and Q_k gathers
// velocity terms, spring torques and the contact force. The balance of moments of link k
// about its base,
//
//     (I + m l^2/4 + l^2 t'P t) alpha_k + u'a_{k-1} = tau_k - l t'(Q - l w_k^2 P r),
//     u = (m l/2) t + l P t,
//
// gives alpha_k and, eliminated, P_{k-1} and Q_{k-1}. A second sweep from the hub to the
// tip then yields all accelerations. With N = 2, I1 added to the first link and f at the
// contact point these are the corrected forms of (2.15)-(2.17); see
// docs/explanation/model.md.
#pragma once

#include "src/arm/chain_link.h"

// Accelerations alpha[dof] at angles q[dof] and velocities w[dof] under the given mode,
// and the reactions. work: links elements of scratch. In contact with a rigid wall, f
// follows from d2g/dt2
// = 0, the derivative of the wall's constraint, (3.13) for N = 2; a wall that gives has
// its law; a stuck hub has no acceleration and friction is what that takes. With one link
// on a rigid hub a touched wall already holds the hub: friction is then taken as zero.
void chain_accelerations(const arm *a, chain_link *work, const double *q, const double *w,
                         contact_state mode, double *alpha, chain_reaction *reaction);

// Whether every link stands across a flat wall to CHAIN_FOLDED [rad]: the arm is folded
// over the hub's axis, through which the wall passes, and the tip is there. Then J of
// chain.h is zero, no force of the wall turns any link, and the constraint's equation J
// M^-1 J^T f = ... says nothing of the force, which grows on the way there without bound.
#define CHAIN_FOLDED 1e-3
bool chain_is_folded(const arm *a, const double *q);

// The penetration, seen from a wall that moves.
typedef struct penetration {
    double depth; // g [m]
    double rate;  // [m/s]
} penetration;
penetration chain_penetration(const arm *a, const double *q, const double *w);

// Response to a unit contact force: response[dof] = -M^-1 J^T. Returns the compliance J
// M^-1 J^T > 0 [1/kg]. hub_locked keeps the hub where it is.
double chain_contact_response(const arm *a, chain_link *work, const double *q,
                              bool hub_locked, double *response);

// The rate of penetration of a velocity-like vector: J v, J taken at q.
double chain_penetration_rate(const arm *a, const double *q, const double *v);

// response[dof] = M^-1 of a unit impulse at the tip, across the last link towards growing
// angle.
void chain_tip_response(const arm *a, chain_link *work, const double *q,
                        double *response);

// Kinetic energy [J] and strain energy [J].
double chain_kinetic_energy(const arm *a, const double *q, const double *w);
double chain_strain_energy(const arm *a, const double *q);
// Potential energy of the weight in a tilted plane, from the hub's axis on [J].
double chain_weight_energy(const arm *a, const double *q);
// The torque of the weight on link k is -weight cos(q_k) [N m]: half of the link's own
// and all that it carries hang at its end.
double chain_weight(const arm *a, int k);

// Position of node k = 0..N (0 the hub axis, N the tip) [m].
void chain_node(const arm *a, const double *q, int k, double *x, double *y);

// How many times faster the arm vibrates for the bends of its joints at angles q[dof]
// [rad]: they stiffen by 3 s b^2, of a root by four times that, which may grow a little
// within a stride.
double chain_stiffened(const arm *a, const double *q);
