// An arm in a tilted plane, whose weight acts along the angle -pi/2: pendulum, sag and
// frequencies of beams.
#include "src/base/dense.h"
#include "tests/passage.h"

#define GRAVITY 9.80665

enum { LINKS = 64 };

// Deflection of the tip of a clamped beam under its weight w: w L^3/8EI; where the tip is
// held the wall bears 3/8 of w.
TEST(a_level_beam_sags_as_eulers_does)
{
    const arm a =
        arm_with(SETTINGS("arm.links=64", "arm.hub_joint=beam", "arm.tilt=1e-3"));
    const double length = a.link_length * LINKS,
                 weight = a.link_mass * LINKS * a.amount.gravity;
    const double EI = a.joint_stiffness * a.link_length;
    double q[LINKS + 1], x, y, force;
    check_relative(a.amount.gravity, GRAVITY * sin(1e-3), 1e-14);

    assert_int_equal(modes_sag(&a, TIP_FREE, q, &force), STATUS_OK);
    chain_node(&a, q, LINKS, &x, &y);
    check_relative(y, -weight * pow(length, 3) / (8 * EI), 1e-3);
    check_close(force, 0, 0);

    // a propped one, against the wall at the angle 0
    arm held = a;
    held.wall.cosine = 1;
    held.wall.sine = 0;
    assert_int_equal(modes_sag(&held, TIP_PINNED, q, &force), STATUS_OK);
    chain_node(&held, q, LINKS, &x, &y);
    check_close(y, 0, 1e-15);
    check_relative(-force, 3.0 / 8 * weight, 1e-3);
}

// The first frequencies of a beam that hangs from a clamp, by Ritz with x^2, x^3, ...:
// the weight below a place x is a tension there.
static void frequencies_of_a_hanging_beam(const arm *a, double *frequency, int count)
{
    enum { TERMS = 7 };
    const double length = a->link_length * LINKS, density = a->link_mass / a->link_length;
    const double EI = a->joint_stiffness * a->link_length;
    double k[TERMS * TERMS], m[TERMS * TERMS], values[TERMS], scratch[2 * TERMS];
    for (int i = 0; i < TERMS; i++) {
        for (int j = 0; j < TERMS; j++) {
            const double p = i + 2, r = j + 2, both = p * r, sum = p + r;
            k[i * TERMS + j] =
                EI / pow(length, 3) * both * (p - 1) * (r - 1) / (sum - 3) +
                density * a->amount.gravity * both * (1 / (sum - 1) - 1 / sum);
            m[i * TERMS + j] = density * length / (sum + 1);
        }
    }
    assert_true(symmetric_eigen_pair(TERMS, k, m, values, scratch));
    for (int i = 0; i < count; i++) {
        frequency[i] = sqrt(values[i]);
    }
}

TEST(a_hanging_beam_has_its_frequencies)
{
    enum { COUNT = 3 };
    const arm a =
        arm_with(SETTINGS("arm.links=64", "arm.hub_joint=beam",
                          "arm.tilt=1.5707963267949", "initial.angle=-1.5707963267949"));
    double expected[COUNT];
    const arm_modes m = modes_of(&a, HUB_LOCKED, TIP_FREE);
    frequencies_of_a_hanging_beam(&a, expected, COUNT);
    for (int i = 0; i < COUNT; i++) {
        printf("mode %d: %.9g rad/s, the beam's %.9g, off by %.2g\n", i, m.w[i],
               expected[i], m.w[i] / expected[i] - 1);
        check_relative(m.w[i], expected[i], 1e-3);
    }

    // the weight counts: level, the first one is lower
    check_below(3.5160153 *
                    sqrt(a.joint_stiffness * a.link_length / a.link_mass * a.link_length /
                         pow(a.link_length * LINKS, 4)) *
                    1.05,
                m.w[0]);
}

// One link without friction swings through the lowest point at the speed of its fall.
TEST(a_single_link_is_a_pendulum)
{
    const parameters p = fixture_parameters(
        SETTINGS("arm.links=1", "wall.kind=none", "motor.voltage=0", "motor.stiction=0",
                 "motor.viscous_friction=0", "motor.back_emf=0", "arm.tilt=-0.6",
                 "initial.angle=0.3"));
    STARTED(a, m, &p, NULL, 0.3, 0);
    assert_ptr_equal(m->engine, &stiff_engine);
    const double inertia =
        a.hub_inertia + a.link_mass * a.link_length * a.link_length / 3;
    const double torque = a.link_mass * a.link_length / 2 * GRAVITY * sin(0.6);
    double fastest = 0;
    while (m->state[SLOT_TIME] < 6) {
        step_on(&a, m, 6, 1e-3);
        const double q = state_angles(m, m->state)[0],
                     w = state_velocities(m, m->state)[0];
        check_relative(w * w / 2 * inertia + 1, torque * (sin(q) - sin(0.3)) + 1, 1e-11);
        check_close(motion_energy_residual(&a, m, m->state), 0, 1e-11);
        fastest = fmax(fastest, fabs(w));
    }
    check_below(0.98 * sqrt(2 * torque * (1 - sin(0.3)) / inertia), fastest);
}

// No law knows of the weight, which may hold its arm off: a run of one says so, one
// without does not.
TEST(a_law_is_not_told_the_weight)
{
    static const struct {
        const char *settings[5], *says;
    } cases[] = {
        {{"control.law=hybrid", "arm.tilt=0.2"}, "does not come to the wall"},
        {{"control.law=hybrid", "arm.tilt=-0.01"}, "not told of the weight"},
        {{"control.law=hybrid"}, NULL},
        {{"control.law=none", "arm.tilt=0.2", "motor.voltage=3"}, NULL},
    };
    for (EACH(c, cases)) {
        const char *all[8] = {"wall.angle=0", "initial.angle=-0.1"};
        memcpy(all + 2, c->settings, sizeof c->settings);
        KEPT_RUN(r) = run_arm(fixture_parameters(all), false);
        assert_int_equal(r.summary.status, STATUS_OK);
        assert_true(c->says == NULL ? strstr(r.summary.message, "weight") == NULL
                                    : strstr(r.summary.message, c->says) != NULL);
    }
}

// What knows no weight says so.
TEST(what_knows_no_weight_says_so)
{
    static const char *const engines[] = {"pair", NULL}; // NULL: the printed model
    for (EACH(c, engines)) {
        parameters p = fresh(*c == NULL ? ARM_PRINTED : ARM_CORRECTED);
        give(&p, "arm.tilt", "0.1");
        if (*c != NULL) {
            give(&p, "method.engine", *c);
        }
        REFUSED(STATUS_BAD_SCENARIO, *c == NULL ? "arm.tilt" : "level",
                parameters_resolve(&p, &f));
    }
}
