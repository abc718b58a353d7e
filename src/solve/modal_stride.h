// A stride of the chain's smooth motion by exponential collocation on the straight chain's modes,
// in Hamilton's form (chain_momentum.h).
//
// From the stride's start let q = q0 + V x, and y the modal momenta V' P, with the hub's viscous
// damping taken in: y_k = V_k' P + kv (V_0k (q - q0)_0 - V_0k^2 x_k). Then
//
//     x' = y + r(t),      y' = -w^2 x - 2 a y + s(t),      2 a = c w^2 + kv V_0k^2,
//
// is exact. r and s are the remainders: what the O(N) sweeps give beyond the linear part of the
// straight chain. They vary slowly where the chain is nearly straight, because fast vibrations
// enter them undifferentiated and in products of small quantities. They are approximated by the
// polynomials through their values at the Lobatto points of the stride. The response of a mode to a
// polynomial is known in closed form, however fast the mode (modal_response.h); it gives angles and
// momenta at those points, and these give r and s anew. Such collocation sweeps (Picard iteration)
// are repeated until nothing changes.
#pragma once

#include "src/arm/chain_momentum.h"
#include "src/solve/modal_basis.h"
#include "src/solve/modal_response.h"
#include "src/solve/modal_sum.h"

enum { MODAL_NODES = 6, MODAL_CONTACT_STATES = 4 };

// Lengths of strides whose responses are kept in each contact state.
enum { MODAL_KEPT = 24 };

// Responses of all modes at one instant, arrays of as many as there are modes.
typedef struct modal_table {
    double *impulse, *impulse_rate;
    double *power[MODAL_POWERS];
} modal_table;

// Responses at the points of collocation of a stride of one length, 0 if of none; [0] is unused.
typedef struct modal_kept {
    double length; // [s]
    modal_table at[MODAL_NODES];
} modal_kept;

// Vibrations e^(-a x) (C cos bx + D sin bx) over a time, x being the share of it; behind the last
// one stand as many that do nothing as a vector has lanes.
typedef struct modal_transients {
    int count;
    double *decay, *turn;          // a, b
    double *cosine, *sine;         // C, D
    double *end_cosine, *end_sine; // e^-a cos b, e^-a sin b
} modal_transients;

typedef struct modal_stride {
    // bases of the contact states, by contact + 2 * stuck, as far as they were wanted yet
    modal_basis basis[MODAL_CONTACT_STATES];
    modal_vibrations vibrations[MODAL_CONTACT_STATES];
    bool known[MODAL_CONTACT_STATES];
    modal_kept kept[MODAL_CONTACT_STATES][MODAL_KEPT];
    int oldest[MODAL_CONTACT_STATES]; // of these
    // of hub and joints, and all damping: what the bases were computed for
    double stiffness[5];
    double *scratch;

    // the stride
    const modal_basis *modes; // of its contact state
    modal_vibrations *now;    // the same
    contact_state mode;
    int dof, count;
    int row;                    // doubles of an array by mode: dof, up to a whole number of vectors
    double length;              // [s]
    double shown_turn;          // up to which the points show a vibration [rad]
    bool start_holds;           // drifts[0] and forces[0] are those of the start itself
    double start_energy;        // kinetic and strain [J]
    double per_stiffness;       // c, structural damping over stiffness [s]
    double *damping;            // a, by mode [1/s]
    double *viscous;            // kv V_0k^2, by mode [1/s]
    double *softness;           // 1/w^2, by mode; 0 without a spring [s2]
    double hub_response;        // length of V_0k over the modes: of a unit impulse on the hub
    double *start;              // y at the start, by mode
    double *momentum;           // P at the start, by degree of freedom
    double *drift[MODAL_NODES]; // r(t) = sum drift[j] t^j / j!, by mode
    double *force[MODAL_NODES]; // s(t), the same
    double *followed[MODAL_NODES]; // what a mode with a spring does under them without vibrating:
                                   // x = sum followed[j] t^j / j!, by mode
    modal_table at[MODAL_NODES]; // responses at the points of collocation; [0] at any other instant
    double *drifts[MODAL_NODES], *forces[MODAL_NODES]; // r and s there, by mode
    double *columns, *more_columns, *modal;            // 2 * MODAL_NODES vectors of a row each
    double tip[MODAL_NODES];             // lambda (modal_basis.h) at the points [N m s]
    double *lanes;                       // of modal_sweep_points
    double *angles, *velocities, *rates; // at one instant
    double *point_angles[MODAL_NODES], *point_velocities[MODAL_NODES]; // at the points; [0] unused
    double *place, *momenta;     // x and y at the instant of the state last asked for
    double time;                 // that instant [s]
    const modal_table *ending;   // responses there
    modal_transients transients; // of the hub's velocity until that instant
    double next;                 // length proposed for the next stride [s]
} modal_stride;

// Bytes that the stride of an arm wants, and its arrays laid into so many.
size_t modal_stride_size(const arm *a);
void modal_stride_place(modal_stride *s, const arm *a);

// Prepares a stride from angles and velocities in a contact state. STATUS_SINGULAR.
status modal_stride_start(modal_stride *s, const arm *a, chain_link *links, contact_state mode,
                          const double *q, const double *w);

// Fits r and s to a stride of the given length, s->start_energy being set.
typedef struct modal_fit {
    double left;   // estimate of what further sweeps would change, from the convergence so far: a
                   // share of the momenta that start_energy and the motor would give
    int sweeps;    // that were made
    double defect; // largest effect of the polynomials' last terms, as the same share: it shrinks
                   // with the fifth power of the length
} modal_fit;
modal_fit modal_stride_fit(modal_stride *s, const arm *a, const double *q, double length);

// Polynomial sum out[j] t^j / j! through values at the points of collocation of a stride [s].
void modal_polynomial(const double values[MODAL_NODES], double length, double out[MODAL_NODES]);

// Angles and velocities at t within the stride, and the impulse of the contact force until then.
// s->more_columns begins with the angles turned until then, to full relative precision.
void modal_stride_state(modal_stride *s, const arm *a, chain_link *links, double t, const double *q,
                        double *qt, double *wt, double *impulse);

// Rate of the fastest mode that vibrates, of those in hand [rad/s].
double modal_stride_fastest(const modal_stride *s);

// Rate of the fastest vibration that the collocation points of a stride from here on must resolve
// [rad/s]: all faster ones together have less than `energy` [J] at its start, their quasi-static
// response not counted. A number near zero if there is none.
double modal_stride_shown(const modal_stride *s, double energy);

// Energy lost until the instant of the state last asked for [J]: to back EMF and viscous friction,
// and in the springs. Integrals of the modes' own motion, not of samples.
typedef struct modal_losses {
    double viscous, damping;
} modal_losses;
modal_losses modal_stride_losses(modal_stride *s, const arm *a, double t);
