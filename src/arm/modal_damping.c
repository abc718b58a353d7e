#include "src/arm/modal_damping.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/arm/modes.h"
#include "src/base/symmetric.h"

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
