#include "src/arm/modes.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/dense.h"

void modes_matrices(const arm *a, double *mass, double *stiffness)
{
    const int n = a->dof, N = a->links;

    // straight, all cosines are 1: every link beyond the outer one counts whole, that one half
    double beyond = a->tip_mass;
    for (int j = N - 1; j >= 0; j--) {
        const double l = arm_link_length(a, j), m = arm_link_mass(a, j);
        double *row = mass + (a->first + j) * n + a->first;
        for (int i = 0; i < j; i++) {
            row[i] = mass[(a->first + i) * n + a->first + j] =
                l * arm_link_length(a, i) * (beyond + 0.5 * m);
        }
        row[j] = l * l * (beyond + 0.25 * m) + arm_link_inertia(a, j);
        beyond += m;
    }
    mass[0] += a->hub_inertia;

    // a spring between each body and the one before
    for (int k = 1; k < n; k++) {
        double s = arm_joint_stiffness(a, k - a->first);
        stiffness[(k - 1) * n + k - 1] += s;
        stiffness[k * n + k] += s;
        stiffness[(k - 1) * n + k] -= s;
        stiffness[k * n + k - 1] -= s;
    }
}

// Basis of the angles that hub and tip allow, one column after another; returns how many.
static int allowed_basis(const arm *a, hub_end hub, tip_end tip, double *basis)
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
            basis[columns * n + n - 1] =
                -arm_link_length(a, k - a->first) / arm_link_length(a, a->links - 1);
        }
        columns++;
    }
    return columns;
}

// reduced = basis^T matrix basis
static void reduce(const double *matrix, const double *basis, int n, int columns, double *product,
                   double *reduced)
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

status modes_compute(const arm *a, hub_end hub, tip_end tip, int *count, double *frequencies,
                     double *shapes)
{
    assert(a != NULL && a->dof > 0 && count != NULL && frequencies != NULL && shapes != NULL);
    const int n = a->dof;

    // one block for all matrices and vectors
    size_t square = (size_t)n * (size_t)n;
    double *block = calloc(5 * square + (size_t)(4 * n), sizeof *block);
    if (block == NULL) {
        return STATUS_NO_MEMORY;
    }
    double *mass = block, *stiffness = mass + square, *basis = stiffness + square;
    double *k = basis + square, *m = k + square, *product = m + square;
    double *values = product + n, *scratch = values + n;

    // K x = omega^2 M x on the angles that hub and tip allow
    modes_matrices(a, mass, stiffness);
    const int columns = allowed_basis(a, hub, tip, basis);
    reduce(stiffness, basis, n, columns, product, k);
    reduce(mass, basis, n, columns, product, m);
    *count = columns;
    const bool found = columns == 0 || symmetric_eigen_pair(columns, k, m, values, scratch);

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
            largest = fabs(angle) > fabs(largest) ? angle : largest;
        }
        for (int j = 0; j < n; j++) {
            shapes[i * n + j] /= largest;
        }
    }
    free(block);
    return found ? STATUS_OK : STATUS_SINGULAR;
}

// --- damping of modes ------------------------------------------------------------------------

enum { MOST_BODIES = PARAMETER_LIST_MOST + 1 };

// K^(-1/2) M K^(-1/2) in the bends of the joints that begin at body `first` of n, whose angle is
// the sum of the bends up to its own.
static void scaled_mass(const arm *a, int first, double *scaled)
{
    enum { EDGE = MOST_BODIES + 1 };
    double mass[MOST_BODIES * MOST_BODIES] = {0}, stiffness[MOST_BODIES * MOST_BODIES] = {0};
    double common[EDGE * EDGE] = {0}; // with a row and a column of zeros behind the last
    const int n = a->dof, size = n - first;
    assert(n <= (int)MOST_BODIES);
    modes_matrices(a, mass, stiffness);

    // what the bodies from i and from j on have in common, less the roots of both stiffnesses
    for (int i = n - 1; i >= first; i--) {
        for (int j = n - 1; j >= first; j--) {
            double *here = common + i * EDGE + j;
            const double below = here[EDGE], right = here[1], both = here[EDGE + 1];
            *here = mass[i * n + j] + (below + right - both);
            const double own = arm_joint_stiffness(a, i - a->first);
            const double other = arm_joint_stiffness(a, j - a->first);
            scaled[(i - first) * size + j - first] = *here / sqrt(own * other);
        }
    }
}

int modal_damping_rows(const arm *a, const char *ratios, double rows[][PARAMETER_LIST_MOST])
{
    assert(a != NULL && ratios != NULL && rows != NULL);
    double ratio[PARAMETER_LIST_MOST], scaled[MOST_BODIES * MOST_BODIES];
    double values[MOST_BODIES], scratch[2 * MOST_BODIES];
    const int count = parameter_list_numbers(ratios, ratio), first = 1, size = a->dof - first;
    if (count == 0) {
        return 0;
    }

    // the slowest mode has the largest value
    assert(count <= size && count <= PARAMETER_MODES_MOST && a->links <= PARAMETER_LIST_MOST);
    scaled_mass(a, first, scaled);
    const bool found = symmetric_eigen(size, scaled, values, scratch);
    assert(found);
    (void)found;
    for (int i = 0; i < count; i++) {
        const double *y = scaled + (size - 1 - i) * size;
        const double factor = sqrt(2 * ratio[i] * sqrt(values[size - 1 - i]));
        memset(rows[i], 0, sizeof rows[i]);
        for (int k = 0; k < size; k++) {
            const int joint = k + first - a->first;
            rows[i][joint] = factor * sqrt(arm_joint_stiffness(a, joint)) * y[k];
        }
    }
    return count;
}
