// Modes of the chain against the Euler-Bernoulli beam it approximates.
#include <math.h>
#include <stdlib.h>

#include "src/arm/modes.h"
#include "tests/arm_fixture.h"

// beta L of mode i of the chain: w = (beta L)^2 sqrt(EI / (rho A L^4)). N links with joints of
// stiffness k2 N/2 at distances L/N stand for EI = k2 L / 2.
static double beta_length(int links, tip_end tip, int mode)
{
    char n[32];
    snprintf(n, sizeof n, "arm.links=%d", links);
    parameters p = fixture_parameters(SETTINGS(n));
    arm a;
    arm_init(&a, &p);
    int count;
    double *frequencies = calloc((size_t)links, sizeof *frequencies);
    double *shapes = calloc((size_t)(links * links), sizeof *shapes);
    assert_int_equal(modes_compute(&a, HUB_LOCKED, tip, &count, frequencies, shapes), STATUS_OK);
    assert_true(mode < count);
    double stiffness = p.arm.k2 * p.arm.length / 2, density = p.arm.mass / p.arm.length;
    double result =
        sqrt(frequencies[mode] / sqrt(stiffness / density) * p.arm.length * p.arm.length);
    free(frequencies);
    free(shapes);
    return result;
}

// The root is held by a whole rigid link, so the clamp sits half a link too far out: first order in
// 1/N. Richardson's extrapolation of two values takes that error away.
static void check_mode(tip_end tip, int mode, double expected)
{
    double coarse = beta_length(32, tip, mode), fine = beta_length(64, tip, mode);
    double finest = beta_length(128, tip, mode);
    double ratio = (coarse - expected) / (fine - expected);
    check_close(ratio, 2, 0.15); // order 1
    check_relative(finest, expected, 0.015);
    check_relative(2 * finest - fine, expected, 1e-3);
}

static void clamped_free_modes_converge(void **state)
{
    (void)state;
    check_mode(TIP_FREE, 0, 1.8751040687);
    check_mode(TIP_FREE, 1, 4.6940911330);
    check_mode(TIP_FREE, 2, 7.8547574382);
}

static void clamped_pinned_modes_converge(void **state)
{
    (void)state;
    check_mode(TIP_PINNED, 0, 3.9266023120);
    check_mode(TIP_PINNED, 1, 7.0685827456);
}

static void two_links_with_locked_hub_have_the_closed_form(void **state)
{
    (void)state;
    parameters p = fixture_parameters(NULL);
    arm a;
    arm_init(&a, &p);
    int count;
    double w[2], shapes[4], m = 0.20054, l = 0.5;
    assert_int_equal(modes_compute(&a, HUB_LOCKED, TIP_FREE, &count, w, shapes), STATUS_OK);
    assert_int_equal(count, 1);
    check_relative(w[0], sqrt(4.92 / (m * l * l / 3)), 1e-12); // rod on its own joint
    check_close(shapes[0], 0, 0);
    check_close(shapes[1], 1, 0);
}

static void free_hub_has_one_mode_of_rigid_turning(void **state)
{
    (void)state;
    parameters p = fixture_parameters(SETTINGS("arm.links=4", "arm.hub_joint=spring"));
    arm a;
    arm_init(&a, &p);
    int count;
    double w[5], shapes[25];
    assert_int_equal(modes_compute(&a, HUB_FREE, TIP_FREE, &count, w, shapes), STATUS_OK);
    assert_int_equal(count, 5);
    check_close(w[0], 0, 1e-2);
    for (int i = 0; i < 5; i++) {
        check_close(shapes[i], 1, 1e-6);
    }
    // the stepper's estimate of the highest frequency is not below the true one
    assert_true(a.highest_frequency >= w[4]);
    check_relative(a.highest_frequency, w[4], 0.2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clamped_free_modes_converge),
        cmocka_unit_test(clamped_pinned_modes_converge),
        cmocka_unit_test(two_links_with_locked_hub_have_the_closed_form),
        cmocka_unit_test(free_hub_has_one_mode_of_rigid_turning),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
