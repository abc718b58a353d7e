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

// Adds a spring between body k and the one before.
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

    // straight, all cosines are 1: every link beyond the outer one counts whole, that one
    // half
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

// Angle of the line that a pinned tip stays on, and at which a hub is held [rad].
static double line_angle(const arm *a, tip_end tip)
{
    const bool at_wall = tip == TIP_PINNED && wall_stands(&a->wall);
    if (at_wall) {
        return plain_atan2(a->wall.sine, a->wall.cosine);
    }
    return a->held_angle;
}

// The balance of moments behind the hub at angles q[dof] under this share of the weight
// and the tip's force: what it lacks into change[dof - 1], its derivatives into
// matrix[size * size], both zeroed before. Of a pinned tip the last row and column are
// the line's that it stays on.
static void sag_equations(const arm *a, tip_end tip, const double *q, double force,
                          double share, int size, double *matrix, double *change)
{
    const double line = line_angle(a, tip);
    const int last = size - 1;
    for (int k = 1; k < a->dof; k++) {
        const int own = k - 1, link = k - a->first;
        const double length = arm_link_of(a, link).length;
        const double weight = chain_weight(a, link) * share;
        const double reach = length * inline_cos(q[k] - line);
        const double aside = length * inline_sin(q[k] - line);
        const force_constants constants = force_constants_of(a, link);
        const joint_force joint =
            joint_forces(&constants, &a->amount, q[k] - q[k - 1], 0);

        // the link's own balance
        change[own] -= joint.torque + weight * inline_cos(q[k]) + force * reach;
        matrix[own * size + own] +=
            joint.by_bend - weight * inline_sin(q[k]) - force * aside;

        // the joint's part in that of the body before
        if (own > 0) {
            change[own - 1] += joint.torque;
            matrix[(own - 1) * size + own - 1] += joint.by_bend;
            matrix[(own - 1) * size + own] -= joint.by_bend;
            matrix[own * size + own - 1] -= joint.by_bend;
        }
        if (tip == TIP_PINNED) {
            matrix[own * size + last] = matrix[last * size + own] = reach;
            change[last] -= aside;
        }
    }
}

status modes_sag(const arm *a, tip_end tip, double *q, double *force)
{
    enum { LOADS = 8, ITERATIONS = 40 };
    const int n = a->dof, size = n - 1 + (tip == TIP_PINNED ? 1 : 0);
    const size_t numbers = (size_t)(size * (size + 1));
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

    // the weight comes on in portions, each by Newton's method in the angles behind the
    // hub
    double *change = matrix + size * size, most = 1;
    bool found = true;
    for (int load = 1; load <= LOADS && found; load++) {
        most = 1;
        for (int i = 0; i < ITERATIONS && found && most > 1e-13; i++) {
            memset(matrix, 0, numbers * sizeof *matrix);
            sag_equations(a, tip, q, *force, (double)load / LOADS, size, matrix, change);
            found = dense_solve(size, matrix, change);
            most = 0;
            for (int k = 1; k < n && found; k++) {
                q[k] += change[k - 1];
                most = fmax(most, fabs(change[k - 1]));
            }
            if (tip == TIP_PINNED) {
                *force += change[size - 1];
            }
        }
        found = found && most < 1e-9;
    }
    free(matrix);
    if (found) {
        return STATUS_OK;
    }
    return STATUS_SINGULAR;
}

// M and K about the sag from those of the straight arm; constraint[n] gets what a pinned
// tip lets the angles do, sum of constraint x = 0.
static status add_sag(const arm *a, tip_end tip, double *q, double *mass,
                      double *stiffness, double *constraint)
{
    const int n = a->dof;
    double force;
    const status code = modes_sag(a, tip, q, &force);
    for (int k = a->first; k < n && code == STATUS_OK; k++) {
        const int link = k - a->first;
        const double l = arm_link_of(a, link).length, turned = q[k] - line_angle(a, tip);
        constraint[k] = l * inline_cos(turned);
        for (int j = a->first; j < n; j++) {
            mass[k * n + j] *= inline_cos(q[k] - q[j]);
        }
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

// Basis of the angles that hub and tip allow, one column after another; returns how many.
static int allowed_basis(const arm *a, hub_end hub, tip_end tip, const double *constraint,
                         double *basis)
{
    const int n = a->dof, start = hub == HUB_LOCKED ? 1 : 0;
    int columns = 0;
    for (int k = start; k < n; k++) {
        bool link = k >= a->first;
        if (tip == TIP_PINNED && link && k == n - 1) {
            break; // the last angle follows from the others
        }

        // a pinned tip moves the last link against each of the others, by their lengths
        basis[columns * n + k] = 1;
        if (tip == TIP_PINNED && link) {
            basis[columns * n + n - 1] = -constraint[k] / constraint[n - 1];
        }
        columns++;
    }
    return columns;
}

// reduced = basis^T matrix basis
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
        // a rigid mode's zero comes out as rounding of the stiffest mode's square
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

enum { MOST_BODIES = PARAMETER_LIST_MOST + 1 };

// K^(-1/2) M K^(-1/2) in the bends of the joints, the sum of which up to its own is the
// angle of a body behind the first.
static void scaled_mass(const arm *a, double *scaled)
{
    enum { EDGE = MOST_BODIES + 1 };
    double mass[MOST_BODIES * MOST_BODIES] = {0},
                              stiffness[MOST_BODIES * MOST_BODIES] = {0};
    double common[EDGE * EDGE] = {0}; // with a row and a column of zeros behind the last
    const int n = a->dof, size = n - 1;
    assert(n <= (int)MOST_BODIES);
    modes_matrices(a, mass, stiffness);

    // what the bodies from i and from j on have in common, less the roots of both
    // stiffnesses
    for (int i = n - 1; i >= 1; i--) {
        for (int j = n - 1; j >= 1; j--) {
            double *here = common + i * EDGE + j;
            const double below = here[EDGE], right = here[1], both = here[EDGE + 1];
            *here = mass[i * n + j] + (below + right - both);
            const double own = arm_link_of(a, i - a->first).stiffness;
            const double other = arm_link_of(a, j - a->first).stiffness;
            scaled[(i - 1) * size + j - 1] = *here / sqrt(own * other);
        }
    }
}

int modal_damping_rows(const arm *a, const char *ratios,
                       double rows[][PARAMETER_LIST_MOST])
{
    double ratio[PARAMETER_LIST_MOST], scaled[MOST_BODIES * MOST_BODIES];
    double values[MOST_BODIES], scratch[2 * MOST_BODIES];
    const int count = parameter_list_numbers(ratios, ratio), size = a->dof - 1;
    if (count == 0) {
        return 0;
    }

    // the slowest mode has the largest value
    assert(count <= size && count <= PARAMETER_MODES_MOST &&
           a->links <= PARAMETER_LIST_MOST);
    scaled_mass(a, scaled);
    const bool found = symmetric_eigen(size, scaled, values, scratch);
    assert(found);
    (void)found;
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
