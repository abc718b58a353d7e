// Natural frequencies and shapes of the straight arm.
#pragma once

#include "src/arm/arm.h"
#include "src/base/fault.h"

typedef enum hub_end {
    HUB_LOCKED,
    HUB_FREE
} hub_end; // held by the controller, or only by inertia
typedef enum tip_end { TIP_FREE, TIP_PINNED } tip_end; // in the air, or touching the wall

// Small vibrations about the straight, undeformed arm or, in a tilted plane, about its
// sag, without damping and friction,
//
//     K x = w^2 M x,
//
// solved on dense matrices (analysis, not simulation: cost N^3). A pinned tip leaves the
// angles with sum l_k x_k = 0. The sag is that with the hub held at initial.angle or, of
// a pinned tip, at the wall's with the tip on the line from the hub to there; K then has
// the weight's part, too. count: how many modes there are (at most a->dof), in rising
// order. frequencies[dof]: w [rad/s]. shapes[dof * dof]: row i holds the angles of mode i
// at all degrees of freedom, scaled to a largest angle of 1. STATUS_SINGULAR if M is not
// positive definite or the weight is more than the arm can bear there, STATUS_NO_MEMORY.
status modes_compute(const arm *a, hub_end hub, tip_end tip, int *count,
                     double *frequencies, double *shapes);

// The angles q[dof] of that sag, equilibrium of joints, weight and, of a pinned tip, the
// force [N] that holds it, returned in *force. STATUS_NO_MEMORY, STATUS_SINGULAR if none
// is found.
status modes_sag(const arm *a, tip_end tip, double *q, double *force);

// M and K themselves of the straight arm, in absolute angles, added to mass[dof * dof]
// and stiffness[dof * dof] of zeroes: M_ij = A_ij of chain.h, K tridiagonal [kg m2], [N
// m/rad].
void modes_matrices(const arm *a, double *mass, double *stiffness);

// --- damping of modes ------------------------------------------------------------------

// Damping that is given mode by mode: torques in the joints that couple them.

// Rows g of arm.modal_damping for the damping ratios of a list as parameters have it:
// with the hub held, mode i of the straight arm decays as exp(-ratio_i w_i t). In the
// bends b of the joints,
//
//     M b" + C b' + K b = 0,      C = sum of g g',      g = (2 ratio/w)^(1/2) K^(1/2) y,
//
// y the unit eigenvectors of K^(-1/2) M K^(-1/2) with the values 1/w^2. C takes nothing
// from an arm that turns as a whole; ratios that grow with w make it proportional to K.
// Returns how many rows there are, 0 for the empty list. At most
// PARAMETER_MODAL_LINKS links.
int modal_damping_rows(const arm *a, const char *ratios,
                       double rows[][PARAMETER_MODAL_LINKS]);
