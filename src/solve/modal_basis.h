// The modes of the straight chain in one contact state, in which its stiff part is diagonal.
//
// M0 and K of the straight chain are the same for any rotation of the whole. With V the modes,
// V' M0 V = 1, V' K V = diag(w^2), structural damping, being proportional to K, is diagonal too:
// V' C V = diag(c w^2). A stuck hub takes no part. Contact leaves the angles with g' q = const: g
// is 1 for each link and 1 + s/l for the last one, of length l, which the wall holds the distance s
// beyond its end.
//
// The exact constraint needs one more vector e, with g' e not zero, which completes the basis. It
// is chosen so that springs and damping do not couple it to the modes, V' K e = 0: K e is a
// multiple of g. (Any other choice, such as M0^-1 g, bends joints near the tip, and the modes'
// response has to cancel that.) It is not orthogonal to the modes in M0, so that angles turn by
// x = V x_k + e x_e and momenta P are
//
//     x_e = g' x / g' e,                     x_k = V_k' M0 (x - e x_e),
//     P = M0 sum_k V_k V_k' P + g lambda,    lambda = (e' P - sum_k (V_k' M0 e) V_k' P) / g' e.
#pragma once

#include "src/base/fault.h"
#include "src/solve/modal_shapes.h"

typedef struct modal_basis {
    int count;       // of modes, that vector included
    double *rate;    // w[count] [rad/s], zero for e and up to a whole vector of eight
    int across;      // index of e, the last; -1 without contact
    double *shared;  // V' M0 e, by mode
    double lever;    // of the wall, in link lengths beyond the last link's end
    double reach;    // g' e, e being of unit length in M0
    double stiff;    // e' K e [1/s2]
    double *by_mode; // V, row k holds mode k's angles at all degrees of freedom
    double *by_dof;  // the same, row i holds angle i of all modes
} modal_basis;

// Doubles that a basis of n degrees of freedom takes, and that computing one takes besides.
size_t modal_basis_size(int n);
size_t modal_basis_scratch(int n);

// Lays the arrays of a basis into storage of modal_basis_size(n) doubles.
void modal_basis_place(modal_basis *b, int n, double *storage);

// Computes the basis of the arm as it is held. STATUS_SINGULAR.
status modal_basis_compute(modal_basis *b, const arm *a, modal_ends ends, double *scratch);

// g' x of angles or velocities x[dof].
double modal_basis_across(const modal_basis *b, const arm *a, const double *x);

// angles[column][dof] = sum over modes of coordinates[column][mode] V, for some columns at once;
// columns are `stride` doubles apart.
void modal_to_angles(const modal_basis *b, int dof, int columns, const double *coordinates,
                     double *angles, int stride);
// coordinates[column][mode] = V' angles[column].
void modal_from_angles(const modal_basis *b, int dof, int columns, const double *angles,
                       double *coordinates, int stride);
