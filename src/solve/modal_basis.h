// The modes of the straight chain in one contact state, in which its stiff part is diagonal.
//
// M0 and K of the straight chain are the same for any rotation of the whole. With V the modes,
// V' M0 V = 1, V' K V = diag(w^2), structural damping, being proportional to K, is diagonal too:
// V' C V = diag(c w^2). A stuck hub takes no part; a touching tip leaves the angles with
// sum q_k = const, and one more vector, M0^-1 times the gradient of that sum, completes the basis
// for what the exact constraint needs beyond.
#pragma once

#include "src/base/status.h"
#include "src/solve/modal_shapes.h"

typedef struct modal_basis {
    int count;       // of modes, that vector included
    double *rate;    // w[count] [rad/s], zero for that vector and up to a whole vector of eight
    int across;      // index of that vector, the last; -1 without contact
    double *pull;    // V' K times that vector, by mode and itself; zero without contact [1/s2]
    double *by_mode; // V, row k holds mode k's angles at all degrees of freedom
    double *by_dof;  // the same, row i holds angle i of all modes
} modal_basis;

// Doubles that a basis of n degrees of freedom takes, and that computing one takes besides.
size_t modal_basis_size(int n);
size_t modal_basis_scratch(int n);

// Lays the arrays of a basis into storage of modal_basis_size(n) doubles.
void modal_basis_place(modal_basis *b, int n, double *storage);

// Computes the basis of the arm in contact or not, its hub stuck or not. STATUS_SINGULAR.
status modal_basis_compute(modal_basis *b, const arm *a, bool contact, bool stuck, double *scratch);

// angles[column][dof] = sum over modes of coordinates[column][mode] V, for some columns at once;
// columns are `stride` doubles apart.
void modal_to_angles(const modal_basis *b, int dof, int columns, const double *coordinates,
                     double *angles, int stride);
// coordinates[column][mode] = V' angles[column].
void modal_from_angles(const modal_basis *b, int dof, int columns, const double *angles,
                       double *coordinates, int stride);
