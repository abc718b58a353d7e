// What the files of the chain's series (chain_series.h) share: their parts that nothing else wants.
//
//     chain_series_start.c   what all orders share
//     chain_series_orders.c  one order after the other, the stride
//     chain_series_sums.c    functions of all links: the tip's place, gap, losses
//     chain_series_loads.c   joints that stiffen, damping by mode, air
//     chain_series_drive.c   the current of an electric drive
//     chain_series_wall.c    the gap, the contact force
//     chain_loops_kernel.h   loops over all links
#pragma once

#include "src/engines/series/chain_series.h"

// Coefficient n of the last link, of an array by coefficient and link.
static inline double last_of(const chain_series *s, const double *terms, int n)
{
    return terms[chain_term(n, s->last_place)];
}

// The first coefficients, from angles q[dof] and velocities w[dof].
void chain_series_take_state(chain_series *s, const arm *a, const double *q, const double *w);

// P and what follows from it, from the tip to the hub; the sweeps' answer to a unit contact force.
void chain_series_prepare_sweep(chain_series *s, const arm *a);
void chain_series_prepare_contact(chain_series *s, const arm *a);

// The n-th coefficients of the tip's place and of the way from the last link's base to a point
// wall.
void chain_series_reach_point(chain_series *s, const arm *a, int n);

// Torques of order n beyond the linear ones added to those of the inner joints; returns what the
// root has beyond its own, times L^2.
double chain_series_load_joints(chain_series *s, const arm *a, int n);

// What air adds to the known moments of order n, and to Q.
void chain_series_drag(chain_series *s, int n);
void chain_series_add_drag(chain_series *s, int n);

// Torque of an electric drive's current of order n, times L^2; what bounds the current, its work.
double chain_series_drive_torque(chain_series *s, const arm *a, int n);
void chain_series_sum_drive(chain_series *s, const arm *a);

// Effect of the force's earlier coefficients at a point wall, whose direction turns with the link:
// the force on the link's base into push; returns the moment on the link.
double chain_series_earlier_force(const chain_series *s, int n, double push[2]);

// The n-th coefficient of the contact force, from the accelerations without it; where the wall
// gives, the gap is known to order n + 1.
double chain_series_force_term(chain_series *s, const arm *a, int n);

// The n-th coefficient of the gap, and of what chain_series_reach_point gives.
void chain_series_gap_term(chain_series *s, const arm *a, int n);

// The losses, from squares of the velocities of hub and joints, with all terms of the squares.
void chain_series_sum_losses(chain_series *s, const arm *a);
