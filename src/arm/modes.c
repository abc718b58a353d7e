#include "src/arm/modes.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/arm/chain.h"
#include "src/arm/forces.h"
#include "src/base/dense.h"
#include "src/base/plain_math.h"
#include "src/base/sincos.h"

// Adds a torsional spring between the bodies k - 1 and k to the stiffness matrix of n
// angles: its energy is stiffness (q[k] - q[k - 1])^2 / 2.
static void add_spring(int n, int k, double stiffness, double *matrix)
{
    matrix[(k - 1) * n + k - 1] += stiffness;
    matrix[k * n + k] += stiffness;
    matrix[(k - 1) * n + k] -= stiffness;
    matrix[k * n + k - 1] -= stiffness;
}

void modes_matrices(const arm *a, double *mass, double *stiffness)
{
    const int n = a->dof, N = a->links;

    // In a straight arm all cosines are 1. The angles of links i < j couple by their
    // lengths times the mass that both move: half of link j's own (its centre is halfway)
    // and all of what lies beyond it.
    double beyond = a->tip_mass;
    for (int j = N - 1; j >= 0; j--) {
        const double l = arm_link_of(a, j).length, m = arm_link_of(a, j).mass;
        double *row = mass + (a->first + j) * n + a->first;
        for (int i = 0; i < j; i++) {
            row[i] = mass[(a->first + i) * n + a->first + j] =
                l * arm_link_of(a, i).length * (beyond + 0.5 * m);
        }
        row[j] = l * l * (beyond + 0.25 * m) + arm_link_of(a, j).inertia;
        beyond += m;
    }
    mass[0] += a->hub_inertia;

    // a spring between each body and the one before
    for (int k = 1; k < n; k++) {
        add_spring(n, k, arm_link_of(a, k - a->first).stiffness, stiffness);
    }
}

// --- the sag of a tilted arm -----------------------------------------------------------

// The angle of the unloaded straight arm [rad]: along the wall if the tip is pinned to
// one, else the angle at which the hub is held.
static double line_angle(const arm *a, tip_end tip)
{
    const bool at_wall = tip == TIP_PINNED && wall_stands(&a->wall);
    if (at_wall) {
        return plain_atan2(a->wall.sine, a->wall.cosine);
    }
    return a->held_angle;
}

// Sets up a Newton step for the sag: the moments about each link's base at the angles
// q[dof], of the joints, of `share` of the weight and of the force on a pinned tip.
// Subtracts these moments from change[size] and adds their derivatives to
// matrix[size * size]; the caller has zeroed both. If the tip is pinned, `size` is one
// larger than the number of links' angles: the last equation keeps the tip on the wall's
// line, and its unknown is the force.
static void sag_equations(const arm *a, tip_end tip, const double *q, double force,
                          double share, int size, double *matrix, double *change)
{
    const double line = line_angle(a, tip);
    const int force_row = size - 1;
    for (int k = 1; k < a->dof; k++) {
        // the link's lever arms along and across the line, and the torque of its joint
        const int own = k - 1, link = k - a->first;
        const double length = arm_link_of(a, link).length;
        const double weight = chain_weight(a, link) * share;
        const double reach = length * inline_cos(q[k] - line);
        const double aside = length * inline_sin(q[k] - line);
        const force_constants constants = force_constants_of(a, link);
        const joint_force joint =
            joint_forces(&constants, &a->amount, q[k] - q[k - 1], 0);

        // the moments about the link's own base
        change[own] -= joint.torque + weight * inline_cos(q[k]) + force * reach;
        matrix[own * size + own] +=
            joint.by_bend - weight * inline_sin(q[k]) - force * aside;

        // the joint's reaction on the body before
        if (own > 0) {
            change[own - 1] += joint.torque;
            matrix[(own - 1) * size + own - 1] += joint.by_bend;
            matrix[(own - 1) * size + own] -= joint.by_bend;
            matrix[own * size + own - 1] -= joint.by_bend;
        }
        if (tip == TIP_PINNED) {
            matrix[own * size + force_row] = matrix[force_row * size + own] = reach;
            change[force_row] -= aside;
        }
    }
}

status modes_sag(const arm *a, tip_end tip, double *q, double *force)
{
    enum { LOADS = 8, ITERATIONS = 40 };
    const int n = a->dof, size = n - 1 + (tip == TIP_PINNED ? 1 : 0);
    const size_t numbers = (size_t)(size * (size + 1));

    // the straight arm, which is the answer where no weight bends it
    *force = 0;
    for (int k = 0; k < n; k++) {
        q[k] = line_angle(a, tip);
    }
    if (a->amount.gravity == 0 || size < 1 || (tip == TIP_PINNED && n - a->first < 2)) {
        return STATUS_OK;
    }
    double *matrix = malloc(numbers * sizeof *matrix);
    if (matrix == NULL) {
        return STATUS_NO_MEMORY;
    }

    // The weight is applied in LOADS equal portions; after each of them Newton's method
    // finds the angles of the links, starting from those found before.
    double *change = matrix + size * size, largest = 1;
    bool found = true;
    for (int load = 1; load <= LOADS && found; load++) {
        largest = 1;
        for (int i = 0; i < ITERATIONS && found && largest > 1e-13; i++) {
            memset(matrix, 0, numbers * sizeof *matrix);
            sag_equations(a, tip, q, *force, (double)load / LOADS, size, matrix, change);
            found = dense_solve(size, matrix, change);
            largest = 0;
            for (int k = 1; k < n && found; k++) {
                q[k] += change[k - 1];
                largest = fmax(largest, fabs(change[k - 1]));
            }
            if (tip == TIP_PINNED) {
                *force += change[size - 1];
            }
        }
        found = found && largest < 1e-9;
    }
    free(matrix);
    if (found) {
        return STATUS_OK;
    }
    return STATUS_SINGULAR;
}

// Turns the matrices M and K of the straight arm into those of small motions about the
// angles q at which it sags. constraint[n] gets the coefficients of the condition that a
// pinned tip puts on these motions x: the sum of constraint[k] x[k] is zero.
static status add_sag(const arm *a, tip_end tip, double *q, double *mass,
                      double *stiffness, double *constraint)
{
    const int n = a->dof;
    double force;
    const status code = modes_sag(a, tip, q, &force);
    for (int k = a->first; k < n && code == STATUS_OK; k++) {
        // inertia couples two links by the cosine of the angle between them
        const int link = k - a->first;
        const double l = arm_link_of(a, link).length, turned = q[k] - line_angle(a, tip);
        constraint[k] = l * inline_cos(turned);
        for (int j = a->first; j < n; j++) {
            mass[k * n + j] *= inline_cos(q[k] - q[j]);
        }

        // the weight and the tip's force stiffen or soften, and so does a bent spring
        stiffness[k * n + k] -=
            chain_weight(a, link) * inline_sin(q[k]) + force * l * inline_sin(turned);
        if (k > 0) {
            const double bend = q[k] - q[k - 1];
            const force_constants joint = force_constants_of(a, link);
            const double slope = joint_forces(&joint, &a->amount, bend, 0).by_bend;
            add_spring(n, k, slope - joint.stiffness, stiffness);
        }
    }
    return code;
}

// Finds a basis of the motions that the ends of the arm allow: column after column of dof
// angles, one for each angle that is free to move. Returns the number of columns.
static int allowed_basis(const arm *a, hub_end hub, tip_end tip, const double *constraint,
                         double *basis)
{
    const int n = a->dof, start = hub == HUB_LOCKED ? 1 : 0;
    int columns = 0;
    for (int k = start; k < n; k++) {
        // with a pinned tip the last link's angle follows from those of the others
        bool link = k >= a->first;
        if (tip == TIP_PINNED && link && k == n - 1) {
            break;
        }

        // it turns against each of them, so that the tip stays in place
        basis[columns * n + k] = 1;
        if (tip == TIP_PINNED && link) {
            basis[columns * n + n - 1] = -constraint[k] / constraint[n - 1];
        }
        columns++;
    }
    return columns;
}

// Computes reduced = basis^T matrix basis, of columns^2 numbers, from a symmetric matrix
// of n^2; product[n] is scratch.
static void project_onto_basis(const double *matrix, const double *basis, int n,
                               int columns, double *product, double *reduced)
{
    for (int c = 0; c < columns; c++) {
        for (int i = 0; i < n; i++) {
            double sum = 0;
            for (int j = 0; j < n; j++) {
                sum += matrix[i * n + j] * basis[c * n + j];
            }
            product[i] = sum;
        }

        for (int r = 0; r < columns; r++) {
            double sum = 0;
            for (int i = 0; i < n; i++) {
                sum += basis[r * n + i] * product[i];
            }
            reduced[c * columns + r] = sum;
        }
    }
}

status modes_compute(const arm *a, hub_end hub, tip_end tip, int *count,
                     double *frequencies, double *shapes)
{
    assert(a->dof > 0);
    const int n = a->dof;

    // one block for all matrices and vectors
    size_t square = (size_t)n * (size_t)n;
    double *block = calloc(5 * square + (size_t)(6 * n), sizeof *block);
    if (block == NULL) {
        return STATUS_NO_MEMORY;
    }
    double *mass = block, *stiffness = mass + square, *basis = stiffness + square;
    double *k = basis + square, *m = k + square, *product = m + square;
    double *values = product + n, *scratch = values + n;
    double *constraint = scratch + 2 * n, *sag = constraint + n;

    // K x = omega^2 M x on the angles that hub and tip allow
    modes_matrices(a, mass, stiffness);
    const status sags = add_sag(a, tip, sag, mass, stiffness, constraint);
    if (sags != STATUS_OK) {
        free(block);
        return sags;
    }
    const int columns = allowed_basis(a, hub, tip, constraint, basis);
    project_onto_basis(stiffness, basis, n, columns, product, k);
    project_onto_basis(mass, basis, n, columns, product, m);
    *count = columns;
    const bool found =
        columns == 0 || symmetric_eigen_pair(columns, k, m, values, scratch);

    // frequencies, and shapes scaled to a largest angle of one
    for (int i = 0; found && i < columns; i++) {
        // the zero of a rigid mode comes out as a rounding error of the largest value
        double value = values[i] > 1e-13 * values[columns - 1] ? values[i] : 0;
        frequencies[i] = sqrt(value);

        double largest = 0;
        for (int j = 0; j < n; j++) {
            double angle = 0;
            for (int c = 0; c < columns; c++) {
                angle += basis[c * n + j] * k[i * columns + c];
            }
            shapes[i * n + j] = angle;
            if (fabs(angle) > fabs(largest)) {
                largest = angle;
            }
        }
        for (int j = 0; j < n; j++) {
            shapes[i * n + j] /= largest;
        }
    }
    free(block);
    if (found) {
        return STATUS_OK;
    }
    return STATUS_SINGULAR;
}

// --- damping of modes ------------------------------------------------------------------

enum { MOST_BODIES = PARAMETER_MODAL_LINKS + 1 };

// Computes K^(-1/2) S K^(-1/2), of (dof - 1)^2 numbers, in the coordinates of the joints'
// bends, while the first body is held. The angle of body i is the sum of the bends of
// joints 1 to i. So K is diagonal, with the joints' stiffnesses, and the mass matrix S in
// these coordinates sums the mass matrix M of the angles over all bodies farther out:
//
//   S(i, j) = sum of M(r, s) over r >= i, s >= j
//           = M(i, j) + S(i+1, j) + S(i, j+1) - S(i+1, j+1)
static void scaled_mass(const arm *a, double *scaled)
{
    enum { WIDTH = MOST_BODIES + 1 };
    double mass[MOST_BODIES * MOST_BODIES] = {0},
                              stiffness[MOST_BODIES * MOST_BODIES] = {0};
    double sum[WIDTH][WIDTH] = {0}; // S, with a row and a column of zeros after the last
    const int n = a->dof, size = n - 1;
    assert(n <= (int)MOST_BODIES);
    modes_matrices(a, mass, stiffness);

    // from the tip inwards, each element divided by the square roots of the stiffnesses
    // of its two joints
    for (int i = n - 1; i >= 1; i--) {
        for (int j = n - 1; j >= 1; j--) {
            sum[i][j] =
                mass[i * n + j] + (sum[i + 1][j] + sum[i][j + 1] - sum[i + 1][j + 1]);
            const double stiffness_i = arm_link_of(a, i - a->first).stiffness;
            const double stiffness_j = arm_link_of(a, j - a->first).stiffness;
            scaled[(i - 1) * size + j - 1] = sum[i][j] / sqrt(stiffness_i * stiffness_j);
        }
    }
}

int modal_damping_rows(const arm *a, const char *ratios,
                       double rows[][PARAMETER_MODAL_LINKS])
{
    double ratio[PARAMETER_LIST_MOST], scaled[MOST_BODIES * MOST_BODIES];
    double values[MOST_BODIES], scratch[2 * MOST_BODIES];
    const int count = parameter_list_numbers(ratios, ratio), size = a->dof - 1;
    if (count == 0) {
        return 0;
    }

    // the modes of K^(-1/2) S K^(-1/2): values ascend, and the largest is 1 / omega^2 of
    // the slowest mode
    assert(count <= size && count <= PARAMETER_MODES_MOST &&
           a->links <= PARAMETER_MODAL_LINKS);
    scaled_mass(a, scaled);
    const bool found = symmetric_eigen(size, scaled, values, scratch);
    assert(found);
    (void)found;

    // a row is the mode's shape in the bends, scaled to damp that mode by its ratio
    for (int i = 0; i < count; i++) {
        const double *y = scaled + (size - 1 - i) * size;
        const double factor = sqrt(2 * ratio[i] * sqrt(values[size - 1 - i]));
        memset(rows[i], 0, sizeof rows[i]);
        for (int k = 0; k < size; k++) {
            const int joint = k + 1 - a->first;
            rows[i][joint] = factor * sqrt(arm_link_of(a, joint).stiffness) * y[k];
        }
    }
    return count;
}
