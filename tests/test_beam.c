// The chain with the beam's own root against the Euler-Bernoulli beam: order two in 1/N.
#include "tests/arm_fixture.h"

static arm beam_of(int links, parameters *p)
{
    *p = parameters_with("arm.links=%d arm.hub_joint=beam", links);
    return arm_of(p);
}

// Deflection of the tip under a unit force across the straight arm, its hub held: every
// joint bends by the moment there, the distance to the tip, over its stiffness.
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

TEST(static_compliance_converges_at_second_order)
{
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

// The same deflection out of the strain energy and the geometry of the chain, for small
// loads: the potential energy V - F y is least where the joints are bent as
// tip_compliance has it.
TEST(joints_bent_by_the_moment_balance_the_load)
{
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

// Frequency of mode `mode` with the hub held, over the beam's (beta L)^2 sqrt(EI/(rho A
// L^4)).
static double frequency_ratio(int links, tip_end tip, int mode, double beta_length)
{
    parameters p;
    const arm a = beam_of(links, &p);
    const arm_modes m = modes_of(&a, HUB_LOCKED, tip);
    assert_true(mode < m.count);
    double density = p.arm.mass / p.arm.length;
    double beam =
        beta_length * beta_length * sqrt(p.arm.EI / (density * pow(p.arm.length, 4)));
    return m.w[mode] / beam;
}

TEST(frequencies_converge_at_second_order)
{
    // roots of cos cosh = -1 and tan = tanh
    const double clamped_free[3] = {1.875104068711961, 4.694091132974175,
                                    7.854757438237613};
    const double clamped_pinned[3] = {3.926602312047919, 7.068582745628732,
                                      10.210176122813031};
    for (int mode = 0; mode < 3; mode++) {
        for (int pinned = 0; pinned < 2; pinned++) {
            tip_end tip = pinned ? TIP_PINNED : TIP_FREE;
            double beta_length = pinned ? clamped_pinned[mode] : clamped_free[mode];
            double coarse = frequency_ratio(24, tip, mode, beta_length) - 1;
            double fine = frequency_ratio(48, tip, mode, beta_length) - 1;
            print_message(
                "%s mode %d: off by %.2e and %.2e with 24 and 48 links, order %.3f\n",
                pinned ? "pinned" : "free", mode + 1, coarse, fine, log2(coarse / fine));
            check_close(log2(coarse / fine), 2, 0.1);
            check_below(fabs(fine), 1e-2);
        }
    }
}

// The damping ratio is asked for the first clamped-free mode, that of the beam with its
// root; with links and joints that differ, with a mass at the tip, and without a root
// that bends.
TEST(any_arm_has_the_damping_asked_for)
{
    const char *const *const arms[] = {
        given("arm.links=2"),
        given("arm.links=5 arm.tip_mass=0.1"),
        given("arm.links=5 arm.hub_joint=beam arm.tip_mass=0.1"),
        given("arm.links=4 arm.joint_stiffness=30,12,5"),
        given("arm.links=4 arm.joint_stiffness=5,12,30 arm.link_lengths=0.1,0.4,0.2,0.3"),
        given("arm.links=3 arm.joint_stiffness=60,5,12 arm.hub_joint=beam "
              "arm.tip_mass=0.05 arm.link_lengths=0.2,0.5,0.3"),
        given("arm.links=1 arm.hub_joint=beam"),
        given("arm.links=8 arm.hub_joint=beam"),
        given("arm.links=1 arm.hub_joint=beam arm.joint_stiffness=7"),
        given("arm.links=1 arm.hub_joint=spring arm.k1=30"),
        given("arm.links=1 arm.hub_joint=spring arm.tip_mass=0.2"),
    };
    for (EACH(c, arms)) {
        parameters p = fixture_parameters(*c);
        p.arm.damping_ratio = 0.02;
        arm a = arm_of(&p);
        const double seconds = 2 * 0.02 / modes_of(&a, HUB_LOCKED, TIP_FREE).w[0];
        check_relative(a.joint_damping / a.joint_stiffness, seconds, 1e-6);
        check_close(a.hub_joint_damping, a.hub_stiffness * seconds,
                    1e-6 * a.hub_stiffness * seconds);
        const bool root = p.arm.hub_joint == HUB_BEAM || p.arm.links == 1;
        for (int k = root ? 0 : 1; k < a.links; k++) {
            const arm_link link = arm_link_of(&a, k);
            check_relative(link.damping, link.stiffness * seconds, 1e-6);
        }
    }

    // a rigid arm has no mode
    parameters p = parameters_with("arm.links=1 arm.damping_ratio=0.02");
    arm a = arm_of(&p);
    check_close(a.joint_damping, 0, 0);
}

// No free mode is faster than what steps are chosen for, nor slower by a tenth, whatever
// the joints.
TEST(the_highest_frequency_bounds_the_modes)
{
    const char *const arms[][2] = {{"arm.links=2", "arm.hub_joint=rigid"},
                                   {"arm.links=2", "arm.hub_joint=spring"},
                                   {"arm.links=2", "arm.hub_joint=beam"},
                                   {"arm.links=3", "arm.hub_joint=rigid"},
                                   {"arm.links=8", "arm.hub_joint=rigid"}};
    for (EACH(c, arms)) {
        arm a = arm_with(given("%s %s", (*c)[0], (*c)[1]));
        const arm_modes m = modes_of(&a, HUB_FREE, TIP_FREE);
        check_below(m.w[m.count - 1], a.highest_frequency);
        check_below(a.highest_frequency, 1.1 * m.w[m.count - 1]);
    }
}

// A mode that is damped beyond its limit creeps by two decays whose product is the square
// of its frequency w and whose sum is 2 zeta w; the faster one is what steps have to
// follow.
TEST(an_overdamped_mode_decays_by_the_roots_of_its_equation)
{
    arm a = arm_with(given("arm.links=8 arm.damping_ratio=0.1"));
    const double w = a.highest_frequency, fast = a.fastest_decay, slow = w * w / fast;
    assert_true(fast > 2 * w);
    check_relative(fast + slow, w * w * a.joint_damping / a.joint_stiffness, 1e-12);
}

// What is not the beam decays by itself: the hub under its friction and the back EMF, the
// current through its inductance, the links in the air.
TEST(whatever_decays_faster_is_followed)
{
    const double mass = 0.40108 / 2, l = 0.5;
    for (int spring = 0; spring < 2; spring++) {
        const char *joint = spring ? "arm.hub_joint=spring" : "arm.hub_joint=rigid";
        parameters p = parameters_with("%s motor.viscous_friction=1e3", joint);
        arm a = arm_of(&p);
        const motor_parameters *m = &p.motor;
        const double emf = m->torque_constant * m->back_emf / m->resistance;
        const double hub = p.arm.hub_inertia + (spring ? 0 : mass * l * l / 12);
        check_relative(a.fastest_decay, (1e3 + emf) / hub, 1e-12);
        check_relative(a.fastest_rate, fmax(a.highest_frequency, a.fastest_decay / 8),
                       1e-12);

        // a limited current brakes no less
        p = parameters_with("%s motor.viscous_friction=1e3 motor.current_limit=2", joint);
        arm_init(&a, &p);
        check_relative(a.fastest_decay, (1e3 + emf) / hub, 1e-12);

        p = parameters_with("%s motor.inductance=1e-6", joint);
        arm_init(&a, &p);
        check_relative(a.fastest_decay, m->resistance / 1e-6, 1e-12);
        check_relative(a.fastest_rate, m->resistance / 1e-6, 1e-12);

        p = parameters_with("%s arm.air_drag=1e4", joint);
        arm_init(&a, &p);
        check_relative(a.fastest_decay, 1e4 * l / mass, 1e-12);
    }

    // a hub that weighs nothing has nothing that brakes it, its link has
    parameters p = parameters_with("arm.links=2");
    p.arm.hub_inertia = 0;
    arm a = arm_of(&p);
    check_relative(a.fastest_decay, a.motor.damping / (mass * l * l / 12), 1e-12);
}

// Of the one mode of two links, its damping goes to the springs of an arm whose hub is
// free: it decays by 2 zeta of the held arm's frequency, as much more as the free arm is
// faster squared.
TEST(damping_by_mode_is_followed)
{
    arm a = arm_with(given("arm.links=2 arm.modal_ratios=0.9"));
    const arm_modes held = modes_of(&a, HUB_LOCKED, TIP_FREE);
    const double free = modes_of(&a, HUB_FREE, TIP_FREE).w[1];
    assert_int_equal(held.count, 1);
    check_relative(a.fastest_decay, 1.05 * 2 * 0.9 * free * free / held.w[0], 1e-5);
}

// Set up where a longer, stiffer arm was, an arm has nothing of that.
TEST(an_arm_has_nothing_of_the_one_before)
{
    const parameters stiff = parameters_with("arm.links=4 arm.joint_stiffness=9,500,500");
    const parameters soft = parameters_with("arm.links=3 arm.joint_stiffness=7,5");
    arm a = arm_of(&stiff);
    arm_init(&a, &soft);
    check_close(a.joint_stiffness, 7, 0);
}

// The longest chain is as good as a beam: w1 = 1.8751^2 sqrt(EI / (m L^3)), with EI = k2
// L / 2.
TEST(the_longest_chain_has_the_damping_of_a_beam)
{
    for (EACH_TEXT(c, "arm.hub_joint=rigid", "arm.hub_joint=beam")) {
        const parameters p =
            parameters_with("arm.links=1024 arm.damping_ratio=0.03 %s", *c);
        arm a = arm_of(&p);
        const double w =
            1.8751 * 1.8751 * sqrt(p.arm.k2 / (2 * p.arm.mass)) / p.arm.length;
        check_relative(a.joint_damping, 2 * 0.03 / w * a.joint_stiffness, 0.01);
    }
}

// beta L of the first mode of the clamped beam with a mass [kg] at its tip, mu its share
// of the beam's mass: 1 + cos cosh + mu x (cos sinh - sin cosh) = 0.
static double beam_with_mass(double mass)
{
    const double mu = mass / 0.40108;
    double lo = 1, hi = 1.8751;
    for (int i = 0; i < 100; i++) {
        double x = (lo + hi) / 2;
        double left =
            1 + cos(x) * cosh(x) + mu * x * (cos(x) * sinh(x) - sin(x) * cosh(x));
        *(left > 0 ? &lo : &hi) = x;
    }
    return lo;
}

TEST(a_mass_at_the_tip_lowers_the_frequencies)
{
    const double root = beam_with_mass(0.1);
    double error[2];
    for (int i = 0; i < 2; i++) {
        parameters p = parameters_with(
            "arm.links=%d arm.hub_joint=beam arm.tip_mass=0.1 arm.damping_ratio=0.02",
            8 << i);
        arm a = arm_of(&p);
        const double w = modes_of(&a, HUB_LOCKED, TIP_FREE).w[0];
        error[i] = w / (root * root * sqrt(p.arm.EI / p.arm.mass)) - 1;
        check_relative(a.joint_damping / a.joint_stiffness, 2 * 0.02 / w, 1e-6);
    }
    check_close(log2(error[0] / error[1]), 2, 0.1);
}

// First frequency [rad/s] of the motion itself, hub held by friction: the arm starts at
// rest in its first mode, and the last link is straight a quarter of a period later.
static double swing(const arm *a, const method_parameters *method, double expected)
{
    enum { QUARTER = 500 };
    const arm_modes modes = modes_of(a, HUB_LOCKED, TIP_FREE);
    double before = 1, crossing = 0;
    const double h = M_PI / 2 / expected / QUARTER;
    motion_report report;
    KEPT_MOTION(m) = motion_create(a, method);
    motion_start(a, m, 0, 0);
    for (int i = 0; i < a->dof; i++) {
        state_angles(m, m->state)[i] = 1e-4 * modes.shapes[i];
    }
    motion_evaluate(a, m, m->state);
    memcpy(state_algorithmic(m, m->state), state_accelerations(m, m->state),
           (size_t)m->dof * sizeof(double));

    // to where the last angle changes its sign, which it does at an even pace
    for (int i = 1; i < 2 * QUARTER && crossing == 0; i++) {
        assert_int_equal(motion_advance(a, m, i * h, fmin(method->step, h), &report),
                         STATUS_OK);
        assert_true(m->state[SLOT_FRICTION] == HUB_STICK);
        const double now =
            state_angles(m, m->state)[a->dof - 1] / (1e-4 * modes.shapes[a->dof - 1]);
        crossing = now <= 0 ? (i - now / (now - before)) * h : 0;
        before = now;
    }
    return M_PI / 2 / crossing;
}

// With a mass at the tip of a stiff chain every engine swings it as the beam does.
TEST(every_engine_carries_the_mass_of_a_stiff_chain)
{
    const double first = beam_with_mass(0.1) * beam_with_mass(0.1);
    const char *const methods[] = {"method.engine=stiff", "method.name=newmark",
                                   "method.name=generalized-alpha"};
    for (int i = 0; i < 6; i++) {
        const int links = i < 3 ? 8 : 16;
        const bool implicit = i % 3 >= 1;
        parameters p = parameters_with(
            "arm.links=%d %s arm.hub_joint=beam arm.k2=2e4 motor.stiction=1000 "
            "motor.voltage=0 wall.kind=none %s",
            links, methods[i % 3], implicit ? "method.step=1e-5" : "method.step=1e-3");
        p.arm.tip_mass = 0.1;
        arm a = arm_of(&p);
        const double beam = first * sqrt(p.arm.EI / p.arm.mass);
        const double found = swing(&a, &p.method, beam);
        print_message("%d links, %s: %.6f of the beam's frequency\n", links,
                      methods[i % 3], found / beam);
        // the chain is stiffer or softer than the beam by the square of a link's length
        check_close(found / beam, 1, 0.5 / (links * links));
    }
}

TEST(stiffness_may_be_given_as_the_beams)
{
    parameters p = fixture_parameters(SETTINGS("arm.EI=8.1 N m2", "arm.length=2 m",
                                               "arm.hub_joint=beam", "arm.links=5"));
    check_relative(p.arm.k2, 8.1, 1e-15);     // 2 EI / length
    check_relative(p.arm.k1, 5 * 8.1, 1e-15); // k2 N

    // what depends on a stiffness follows it
    assert_int_equal(parameter_set_number(&p, PARAMETER_INDEX(arm.EI), 4, NULL),
                     STATUS_OK);
    parameters_follow(&p, PARAMETER_INDEX(arm.EI));
    check_relative(p.arm.k2, 4.0, 1e-15);
    check_relative(p.arm.k1, 20.0, 1e-15);
    assert_int_equal(parameter_set_number(&p, PARAMETER_INDEX(arm.k2), 6, NULL),
                     STATUS_OK);
    parameters_follow(&p, PARAMETER_INDEX(arm.k2));
    check_relative(p.arm.EI, 6.0, 1e-15);
    check_relative(p.arm.k1, 30.0, 1e-15);
}
