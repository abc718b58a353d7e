// Modes of the chain against the Euler-Bernoulli beam it approximates.
#include "tests/arm_fixture.h"

// beta L of mode i of the chain: w = (beta L)^2 sqrt(EI / (rho A L^4)). N links with
// joints of stiffness k2 N/2 at distances L/N stand for EI = k2 L / 2.
static double beta_length(int links, tip_end tip, int mode)
{
    parameters p = fixture_parameters(SETTINGS(formatted("arm.links=%d", links)));
    const arm a = arm_of(&p);
    const arm_modes m = modes_of(&a, HUB_LOCKED, tip);
    assert_true(mode < m.count);
    double stiffness = p.arm.k2 * p.arm.length / 2, density = p.arm.mass / p.arm.length;
    return sqrt(m.w[mode] / sqrt(stiffness / density) * p.arm.length * p.arm.length);
}

// The root is held by a whole rigid link, so the clamp sits half a link too far out:
// first order in 1/N. Richardson's extrapolation of two values takes that error away.
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
    arm a = arm_with(NULL);
    const double mass = 0.20054, l = 0.5;
    const arm_modes m = modes_of(&a, HUB_LOCKED, TIP_FREE);
    assert_int_equal(m.count, 1);
    check_relative(m.w[0], sqrt(4.92 / (mass * l * l / 3)),
                   1e-12); // rod on its own joint
    check_close(m.shapes[0], 0, 0);
    check_close(m.shapes[1], 1, 0);
}

TEST(free_hub_has_one_mode_of_rigid_turning)
{
    arm a = arm_with(SETTINGS("arm.links=4", "arm.hub_joint=spring"));
    const arm_modes m = modes_of(&a, HUB_FREE, TIP_FREE);
    assert_int_equal(m.count, 5);
    check_close(m.w[0], 0, 1e-2);
    for (int i = 0; i < 5; i++) {
        check_close(m.shapes[i], 1, 1e-6);
    }
    // the stepper's estimate of the highest frequency is not below the true one
    assert_true(a.highest_frequency >= m.w[4]);
    check_relative(a.highest_frequency, m.w[4], 0.2);
}

static const char *const *const any_arms[] = {
    SETTINGS("arm.links=1", "arm.hub_joint=beam"),
    SETTINGS("arm.links=2"),
    SETTINGS("arm.links=5", "arm.hub_joint=spring", "arm.tip_mass=0.1"),
    SETTINGS("arm.links=5", "arm.hub_joint=beam"),
    SETTINGS("arm.links=4", "arm.joint_stiffness=5,12,30",
             "arm.link_lengths=0.1,0.4,0.2,0.3"),
    SETTINGS("arm.links=3", "arm.hub_joint=beam", "arm.joint_stiffness=60,5,12",
             "arm.link_lengths=0.2,0.5,0.3", "arm.tip_mass=0.05"),
};

// With the quadratic energy E(x) = x'A x / 2 an element of its matrix is
// A_jk = E(e_j + e_k) - E(e_j) - E(e_k), e_j being the unit vector of the coordinate j.
TEST(matrices_are_those_of_the_energies)
{
    for (EACH(c, any_arms)) {
        arm a = arm_with(*c);
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

// The lever of a force on the tip with which it turns the coordinate j: the length of the
// link, and nothing for the hub.
static double lever_of_tip(const arm *a, int j)
{
    if (j < a->first) {
        return 0;
    }
    return arm_link_of(a, j - a->first).length;
}

// (K - w^2 M) x, the torques that a mode with the frequency w and the shape x leaves
// over, are zero but for those that hold the arm: one on a locked hub, and those of a
// force on a pinned tip, which turns each link by its lever. And such a hub and tip do
// not move.
TEST(every_mode_balances_but_for_what_holds_the_arm)
{
    for (size_t i = 0; i < 4 * sizeof any_arms / sizeof any_arms[0]; i++) {
        // each arm with both kinds of hub and of tip
        const hub_end hub = i % 2 ? HUB_LOCKED : HUB_FREE;
        const tip_end tip = i / 2 % 2 ? TIP_PINNED : TIP_FREE;
        arm a = arm_with(any_arms[i / 4]);
        const int n = a.dof;
        double mass[81] = {0}, stiffness[81] = {0};
        modes_matrices(&a, mass, stiffness);
        const arm_modes m = modes_of(&a, hub, tip);
        assert_int_equal(m.count, n - (hub == HUB_LOCKED) - (tip == TIP_PINNED));
        for (int mode = 0; mode < m.count; mode++) {
            // what is left over, and how far the tip moves
            const double *x = m.shapes + mode * n;
            double left[9], largest = 0, deflection = 0, scale = 0;
            for (int j = 0; j < n; j++) {
                left[j] = 0;
                for (int k = 0; k < n; k++) {
                    left[j] +=
                        (stiffness[j * n + k] - m.w[mode] * m.w[mode] * mass[j * n + k]) *
                        x[k];
                }
                scale = fmax(scale, stiffness[j * n + j]);
                largest = fmax(largest, x[j]);
                assert_true(fabs(x[j]) <= 1);
                deflection += lever_of_tip(&a, j) * x[j];
            }

            // the shape is scaled to 1, modes are in order, and what is held stays
            check_close(largest, 1, 0);
            assert_true(mode == 0 || m.w[mode] >= m.w[mode - 1]);
            check_close(hub == HUB_LOCKED ? x[0] : 0, 0, 0);
            check_close(tip == TIP_PINNED ? deflection : 0, 0, 1e-12);

            // the force on the tip follows from the last link; a locked hub takes
            // anything
            double force = 0;
            if (tip == TIP_PINNED) {
                force = left[n - 1] / lever_of_tip(&a, n - 1);
            }
            const int first_free = hub == HUB_LOCKED ? 1 : 0;
            for (int j = first_free; j < n; j++) {
                check_close(left[j], force * lever_of_tip(&a, j), 1e-9 * scale);
            }
        }
    }
}
