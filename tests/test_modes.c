// Modes of the chain against the Euler-Bernoulli beam it approximates.
#include "src/arm/modes.h"
#include "tests/arm_fixture.h"

// beta L of mode i of the chain: w = (beta L)^2 sqrt(EI / (rho A L^4)). N links with joints of
// stiffness k2 N/2 at distances L/N stand for EI = k2 L / 2.
static double beta_length(int links, tip_end tip, int mode)
{
    char n[32];
    snprintf(n, sizeof n, "arm.links=%d", links);
    parameters p = fixture_parameters(SETTINGS(n));
    arm a = arm_of(&p);
    int count;
    SCOPED(free_kept) double *frequencies = calloc((size_t)links, sizeof *frequencies);
    SCOPED(free_kept) double *shapes = calloc((size_t)(links * links), sizeof *shapes);
    assert_int_equal(modes_compute(&a, HUB_LOCKED, tip, &count, frequencies, shapes), STATUS_OK);
    assert_true(mode < count);
    double stiffness = p.arm.k2 * p.arm.length / 2, density = p.arm.mass / p.arm.length;
    double result =
        sqrt(frequencies[mode] / sqrt(stiffness / density) * p.arm.length * p.arm.length);
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

TEST(clamped_free_modes_converge)
{
    check_mode(TIP_FREE, 0, 1.8751040687);
    check_mode(TIP_FREE, 1, 4.6940911330);
    check_mode(TIP_FREE, 2, 7.8547574382);
}

TEST(clamped_pinned_modes_converge)
{
    check_mode(TIP_PINNED, 0, 3.9266023120);
    check_mode(TIP_PINNED, 1, 7.0685827456);
}

TEST(two_links_with_locked_hub_have_the_closed_form)
{
    parameters p = fixture_parameters(NULL);
    arm a = arm_of(&p);
    int count;
    double w[2], shapes[4], m = 0.20054, l = 0.5;
    assert_int_equal(modes_compute(&a, HUB_LOCKED, TIP_FREE, &count, w, shapes), STATUS_OK);
    assert_int_equal(count, 1);
    check_relative(w[0], sqrt(4.92 / (m * l * l / 3)), 1e-12); // rod on its own joint
    check_close(shapes[0], 0, 0);
    check_close(shapes[1], 1, 0);
}

TEST(free_hub_has_one_mode_of_rigid_turning)
{
    parameters p = fixture_parameters(SETTINGS("arm.links=4", "arm.hub_joint=spring"));
    arm a = arm_of(&p);
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

static const char *const *const any_arms[] = {
    SETTINGS("arm.links=1", "arm.hub_joint=beam"),
    SETTINGS("arm.links=2"),
    SETTINGS("arm.links=5", "arm.hub_joint=spring", "arm.tip_mass=0.1"),
    SETTINGS("arm.links=5", "arm.hub_joint=beam"),
    SETTINGS("arm.links=4", "arm.joint_stiffness=5,12,30", "arm.link_lengths=0.1,0.4,0.2,0.3"),
    SETTINGS("arm.links=3", "arm.hub_joint=beam", "arm.joint_stiffness=60,5,12",
             "arm.link_lengths=0.2,0.5,0.3", "arm.tip_mass=0.05"),
};

// A product x'A y is what the energy of both together has more than that of each.
TEST(matrices_are_those_of_the_energies)
{
    for (EACH(c, any_arms)) {
        parameters p = fixture_parameters(*c);
        arm a = arm_of(&p);
        const int n = a.dof;
        const double straight[9] = {0};
        double mass[81] = {0}, stiffness[81] = {0};
        modes_matrices(&a, mass, stiffness);
        for (int j = 0; j < n; j++) {
            for (int k = 0; k < n; k++) {
                double x[9] = {0}, y[9] = {0}, both[9] = {0};
                x[j] = y[k] = 1;
                both[j] += 1;
                both[k] += 1;
                check_close(mass[j * n + k],
                            chain_kinetic_energy(&a, straight, both) -
                                chain_kinetic_energy(&a, straight, x) -
                                chain_kinetic_energy(&a, straight, y),
                            1e-15);
                check_close(stiffness[j * n + k],
                            chain_strain_energy(&a, both) - chain_strain_energy(&a, x) -
                                chain_strain_energy(&a, y),
                            1e-12 * (1 + stiffness[j * n + j] + stiffness[k * n + k]));
            }
        }
    }
}

// (K - w^2 M) x is nothing but what holds the hub and a force on the tip, at whose levers the links
// are; and the tip is where it is held.
TEST(every_mode_balances_but_for_what_holds_the_arm)
{
    for (size_t i = 0; i < 4 * sizeof any_arms / sizeof any_arms[0]; i++) {
        const hub_end hub = i % 2 ? HUB_LOCKED : HUB_FREE;
        const tip_end tip = i / 2 % 2 ? TIP_PINNED : TIP_FREE;
        parameters p = fixture_parameters(any_arms[i / 4]);
        arm a = arm_of(&p);
        const int n = a.dof;
        double mass[81] = {0}, stiffness[81] = {0}, w[9], shapes[81];
        int count;
        modes_matrices(&a, mass, stiffness);
        assert_int_equal(modes_compute(&a, hub, tip, &count, w, shapes), STATUS_OK);
        assert_int_equal(count, n - (hub == HUB_LOCKED) - (tip == TIP_PINNED));
        for (int mode = 0; mode < count; mode++) {
            const double *x = shapes + mode * n;
            double left[9], largest = 0, deflection = 0, scale = 0;
            for (int j = 0; j < n; j++) {
                left[j] = 0;
                for (int k = 0; k < n; k++) {
                    left[j] += (stiffness[j * n + k] - w[mode] * w[mode] * mass[j * n + k]) * x[k];
                }
                scale = fmax(scale, stiffness[j * n + j]);
                largest = fmax(largest, x[j]);
                assert_true(fabs(x[j]) <= 1);
                deflection += j >= a.first ? arm_link_of(&a, j - a.first).length * x[j] : 0;
            }
            check_close(largest, 1, 0);
            assert_true(mode == 0 || w[mode] >= w[mode - 1]);
            check_close(hub == HUB_LOCKED ? x[0] : 0, 0, 0);
            check_close(tip == TIP_PINNED ? deflection : 0, 0, 1e-12);
            const double force =
                tip == TIP_PINNED ? left[n - 1] / arm_link_of(&a, a.links - 1).length : 0;
            for (int j = hub == HUB_LOCKED; j < n; j++) {
                const double lever = j >= a.first ? arm_link_of(&a, j - a.first).length : 0;
                check_close(left[j], force * lever, 1e-9 * scale);
            }
        }
    }
}
