// Modes of the straight chain in closed form against the dense solution of the same problem.
#include <stdlib.h>

#include "src/arm/modes.h"
#include "src/base/random.h"
#include "src/solve/modal_basis.h"
#include "tests/arm_fixture.h"

enum { MOST_LINKS = 40, RUNS = 60 };

// A random arm: hub light and heavy, rigid and on springs soft and stiff.
static arm random_arm(int number)
{
    char links[32], hub[64];
    random_generator g;
    random_seed(&g, (uint64_t)number);
    const double joint = random_uniform(&g);
    snprintf(links, sizeof links, "arm.links=%d",
             2 + (int)(random_uniform(&g) * random_uniform(&g) * (MOST_LINKS - 1)));
    snprintf(hub, sizeof hub, "arm.hub_inertia=%.17g", 1e-2 * exp(8 * (random_uniform(&g) - 0.5)));
    parameters p = fixture_parameters(SETTINGS(links, hub,
                                               joint < 0.3   ? "arm.hub_joint=rigid"
                                               : joint < 0.6 ? "arm.hub_joint=beam"
                                                             : "arm.hub_joint=spring"));
    p.arm.k1 *= joint < 0.6 ? 1 : exp(16 * (random_uniform(&g) - 0.5));
    arm a;
    arm_init(&a, &p);
    return a;
}

// x' M0 y and x' K y, the latter by the bends.
static double inertia(const arm *a, const double *x, const double *y, double *product)
{
    double sum = 0;
    modal_mass_times(a, x, product);
    for (int i = 0; i < a->dof; i++) {
        sum += product[i] * y[i];
    }
    return sum;
}

static void check_basis(const arm *a, modal_ends ends)
{
    const bool contact = ends.contact, stuck = ends.stuck;
    const int n = a->dof;
    const size_t size = (size_t)n;
    double *storage = calloc(modal_basis_size(n) + modal_basis_scratch(n) + size * size + 2 * size,
                             sizeof *storage);
    assert_non_null(storage);
    double *scratch = storage + modal_basis_size(n), *rates = scratch + modal_basis_scratch(n);
    double *product = rates + n, *dense = product + n;
    modal_basis b;
    modal_basis_place(&b, n, storage);

    // as many, as fast as the dense matrices say to their digits where the tip itself is held
    int count;
    assert_int_equal(modal_basis_compute(&b, a, ends, scratch), STATUS_OK);
    assert_int_equal(modes_compute(a, stuck ? HUB_LOCKED : HUB_FREE,
                                   contact ? TIP_PINNED : TIP_FREE, &count, rates, dense),
                     STATUS_OK);
    assert_int_equal(b.count, count + contact);
    for (int k = 0; k < count && ends.lever == 0; k++) {
        const double square = b.rate[k] * b.rate[k], fastest = rates[count - 1];
        check_close(square, rates[k] * rates[k], 1e-12 * fastest * fastest);
    }

    // of unit mass, with nothing in common, at rest where they are held
    for (int k = 0; k < b.count; k++) {
        const double *mode = b.by_mode + (size_t)k * size;
        const double held = modal_basis_across(&b, a, mode);
        check_close(contact && k != b.across ? held : 0, 0, 1e-9);
        check_close(stuck ? mode[0] : 0, 0, 0);
        for (int j = 0; j <= k; j++) {
            const double *other = b.by_mode + (size_t)j * size;
            const bool beyond = k == b.across && j != k;
            const double expected = beyond ? b.shared[j] : j == k;
            check_close(inertia(a, mode, other, product), expected, 1e-11);
            if (beyond) {
                // moved by nothing that bends the modes
                const double scale = b.rate[j] * b.rate[count > 0 ? count - 1 : 0];
                check_close(bend_product(a, mode, other), 0, 1e-12 * scale);
            } else if (k != b.across && b.rate[j] > 0) {
                const double shared = bend_product(a, mode, other) / (b.rate[k] * b.rate[j]);
                check_close(shared, j == k, 1e-9);
            }
        }
    }
    free(storage);
}

static void modes_are_those_of_the_matrices(void **state)
{
    (void)state;
    for (int i = 0; i < RUNS; i++) {
        const arm a = random_arm(i);
        for (int j = 0; j < 4; j++) {
            if (a.dof > 2 || j != 3) {
                check_basis(&a, (modal_ends){j & 1, 0, j & 2});
            }
        }
        for (int stuck = 0; stuck < 2; stuck++) {
            // by a point beyond the tip of a bent arm
            if (a.dof > 2 || !stuck) {
                check_basis(&a, (modal_ends){true, 0.03 * (i + 1) * (i + 1), stuck});
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(modes_are_those_of_the_matrices)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
