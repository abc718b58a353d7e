// The chain with the beam's own root against the Euler-Bernoulli beam: order two in 1/N.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/arm/chain.h"
#include "src/arm/modes.h"
#include "tests/arm_fixture.h"

static arm beam_of(int links, parameters *p)
{
    char n[32];
    arm a;
    snprintf(n, sizeof n, "arm.links=%d", links);
    *p = fixture_parameters(SETTINGS(n, "arm.hub_joint=beam"));
    arm_init(&a, p);
    return a;
}

// Deflection of the tip under a unit force across the straight arm, its hub held: every joint
// bends by the moment there, the distance to the tip, over its stiffness.
static double tip_compliance(const arm *a)
{
    double sum = 0;
    for (int k = 0; k < a->links; k++) {
        double lever = (a->links - k) * a->link_length;
        sum += lever * lever / (k > 0 ? a->joint_stiffness : a->hub_stiffness);
    }
    return sum;
}

static double beam_compliance(const parameters *p)
{
    return pow(p->arm.length, 3) / (3 * p->arm.EI);
}

static void static_compliance_converges_at_second_order(void **state)
{
    (void)state;
    const int links[] = {2, 4, 12, 32};
    double error[4];
    for (int i = 0; i < 4; i++) {
        parameters p;
        arm a = beam_of(links[i], &p);
        error[i] = tip_compliance(&a) / beam_compliance(&p) - 1;
        // (1 + 2 sum j^2/N^2) over the integral of the same moments
        check_relative(1 + error[i], 1 + 0.5 / (links[i] * links[i]), 1e-12);
    }
    check_close(log(error[2] / error[3]) / log(32.0 / 12), 2, 0.1);
}

// The same deflection out of the strain energy and the geometry of the chain, for small loads: the
// potential energy V - F y is least where the joints are bent as tip_compliance has it.
static void joints_bent_by_the_moment_balance_the_load(void **state)
{
    (void)state;
    parameters p;
    arm a = beam_of(6, &p);
    const double load = 1e-3;
    double q[7] = {0};
    for (int k = 0; k < a.links; k++) {
        double moment = load * (a.links - k) * a.link_length;
        q[1 + k] = q[k] + moment / (k > 0 ? a.joint_stiffness : a.hub_stiffness);
    }
    for (int i = 1; i < a.dof; i++) {
        double potential[2];
        for (int side = 0; side < 2; side++) {
            double moved[7], x, y, e = side ? 1e-5 : -1e-5;
            memcpy(moved, q, sizeof moved);
            moved[i] += e;
            chain_node(&a, moved, a.links, &x, &y);
            potential[side] = chain_strain_energy(&a, moved) - load * y;
        }
        check_close((potential[1] - potential[0]) / 2e-5, 0, 1e-6 * load);
    }
    double x, y;
    chain_node(&a, q, a.links, &x, &y);
    check_relative(y / load, tip_compliance(&a), 1e-5);
}

// Frequency of mode `mode` with the hub held, over the beam's (beta L)^2 sqrt(EI/(rho A L^4)).
static double frequency_ratio(int links, tip_end tip, int mode, double beta_length)
{
    parameters p;
    arm a = beam_of(links, &p);
    int count;
    double *frequencies = calloc((size_t)a.dof, sizeof *frequencies);
    double *shapes = calloc((size_t)(a.dof * a.dof), sizeof *shapes);
    assert_int_equal(modes_compute(&a, HUB_LOCKED, tip, &count, frequencies, shapes), STATUS_OK);
    assert_true(mode < count);
    double density = p.arm.mass / p.arm.length;
    double beam = beta_length * beta_length * sqrt(p.arm.EI / (density * pow(p.arm.length, 4)));
    double ratio = frequencies[mode] / beam;
    free(frequencies);
    free(shapes);
    return ratio;
}

static void frequencies_converge_at_second_order(void **state)
{
    (void)state;
    // roots of cos cosh = -1 and tan = tanh
    const double clamped_free[3] = {1.875104068711961, 4.694091132974175, 7.854757438237613};
    const double clamped_pinned[3] = {3.926602312047919, 7.068582745628732, 10.210176122813031};
    for (int mode = 0; mode < 3; mode++) {
        for (int pinned = 0; pinned < 2; pinned++) {
            tip_end tip = pinned ? TIP_PINNED : TIP_FREE;
            double beta_length = pinned ? clamped_pinned[mode] : clamped_free[mode];
            double coarse = frequency_ratio(24, tip, mode, beta_length) - 1;
            double fine = frequency_ratio(48, tip, mode, beta_length) - 1;
            print_message("%s mode %d: off by %.2e and %.2e with 24 and 48 links, order %.3f\n",
                          pinned ? "pinned" : "free", mode + 1, coarse, fine, log2(coarse / fine));
            check_close(log2(coarse / fine), 2, 0.1);
            check_below(fabs(fine), 1e-2);
        }
    }
}

// The damping ratio is asked for the first clamped-free mode, that of the beam with its root.
static void first_mode_has_the_damping_asked_for(void **state)
{
    (void)state;
    const double wanted = 0.02;
    parameters p =
        fixture_parameters(SETTINGS("arm.links=8", "arm.hub_joint=beam", "arm.damping_ratio=0.02"));
    arm a;
    arm_init(&a, &p);
    int count;
    double frequencies[9], shapes[81];
    assert_int_equal(modes_compute(&a, HUB_LOCKED, TIP_FREE, &count, frequencies, shapes),
                     STATUS_OK);
    check_relative(a.joint_damping / a.joint_stiffness, 2 * wanted / frequencies[0], 1e-6);
    check_relative(a.hub_joint_damping / a.hub_stiffness, 2 * wanted / frequencies[0], 1e-6);
}

// A mass at the tip: 1 + cos cosh + mu x (cos sinh - sin cosh) = 0 for x = beta L, mu its share of
// the beam's mass.
static void a_mass_at_the_tip_lowers_the_frequencies(void **state)
{
    (void)state;
    const double mass = 0.1, mu = mass / 0.40108;
    double lo = 1, hi = 1.8751, error[2];
    for (int i = 0; i < 100; i++) {
        double x = (lo + hi) / 2;
        double left = 1 + cos(x) * cosh(x) + mu * x * (cos(x) * sinh(x) - sin(x) * cosh(x));
        *(left > 0 ? &lo : &hi) = x;
    }
    for (int i = 0; i < 2; i++) {
        char n[32];
        snprintf(n, sizeof n, "arm.links=%d", 8 << i);
        parameters p = fixture_parameters(
            SETTINGS(n, "arm.hub_joint=beam", "arm.tip_mass=0.1", "arm.damping_ratio=0.02"));
        arm a;
        arm_init(&a, &p);
        int count;
        double frequencies[17], shapes[17 * 17];
        assert_int_equal(modes_compute(&a, HUB_LOCKED, TIP_FREE, &count, frequencies, shapes),
                         STATUS_OK);
        error[i] = frequencies[0] / (lo * lo * sqrt(p.arm.EI / p.arm.mass)) - 1;
        check_relative(a.joint_damping / a.joint_stiffness, 2 * 0.02 / frequencies[0], 1e-6);
    }
    check_close(log2(error[0] / error[1]), 2, 0.1);
}

static void stiffness_may_be_given_as_the_beams(void **state)
{
    (void)state;
    parameters p = fixture_parameters(
        SETTINGS("arm.EI=8.1 N m2", "arm.length=2 m", "arm.hub_joint=beam", "arm.links=5"));
    check_relative(p.arm.k2, 8.1, 1e-15);     // 2 EI / length
    check_relative(p.arm.k1, 5 * 8.1, 1e-15); // k2 N

    // what depends on a stiffness follows it
    assert_int_equal(parameter_set_number(&p, PARAMETER_INDEX(arm.EI), 4, NULL), STATUS_OK);
    parameters_follow(&p, PARAMETER_INDEX(arm.EI));
    check_relative(p.arm.k2, 4.0, 1e-15);
    check_relative(p.arm.k1, 20.0, 1e-15);
    assert_int_equal(parameter_set_number(&p, PARAMETER_INDEX(arm.k2), 6, NULL), STATUS_OK);
    parameters_follow(&p, PARAMETER_INDEX(arm.k2));
    check_relative(p.arm.EI, 6.0, 1e-15);
    check_relative(p.arm.k1, 30.0, 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(static_compliance_converges_at_second_order),
        cmocka_unit_test(joints_bent_by_the_moment_balance_the_load),
        cmocka_unit_test(frequencies_converge_at_second_order),
        cmocka_unit_test(first_mode_has_the_damping_asked_for),
        cmocka_unit_test(a_mass_at_the_tip_lowers_the_frequencies),
        cmocka_unit_test(stiffness_may_be_given_as_the_beams),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
