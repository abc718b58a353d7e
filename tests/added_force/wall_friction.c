// Whether the force that wall_friction.patch adds acts as physics has it: built by
// test_added_force.sh from sources with the patch, not by the project itself.
#include "src/arm/chain.h"
#include "src/contact/contact_machine.h"
#include "src/engines/motion_create.h"
#include "src/tables/features.h"
#include "tests/given_parameters.h"

#define FRICTION 0.8 // [N s/m]

// An arm that meets a flat wall at the angle 0.
static parameters arm_at_wall(const char *settings)
{
    parameters p = fresh(ARM_CORRECTED);
    give_all(&p, "wall.kind=plane wall.angle=0 wall.contact=kelvin-voigt "
                 "wall.stiffness=2e4 wall.damping=5 initial.angle=-0.3 motor.voltage=4");
    give_all(&p, settings);
    DONE(parameters_resolve(&p, &f));
    return p;
}

// Twice the kinetic energy of two links.
static double square(const arm *a, const double *q, double w1, double w2)
{
    return 2 * chain_kinetic_energy(a, q, (const double[]){w1, w2});
}

// With v = J w, J = -l (sin q1, sin q2) along the wall, friction c takes M^-1 J' c v from
// the accelerations.
TEST(friction_slows_two_links_along_the_wall)
{
    const double q[] = {0.4, -0.35}, w[] = {1.7, -0.9};
    const contact_state touching = {.contact = true, .friction = HUB_FORWARD};
    double alpha[2][2];
    chain_reaction reaction[2];
    arm a;
    for (int i = 0; i < 2; i++) {
        const parameters p =
            arm_at_wall(i == 0 ? "wall.friction=0" : "wall.friction=0.8");
        chain_link work[2];
        arm_init(&a, &p);
        chain_accelerations(&a, work, q, w, touching, alpha[i], &reaction[i]);
    }

    // M from the kinetic energy
    const double m11 = square(&a, q, 1, 0), m22 = square(&a, q, 0, 1);
    const double m12 = (square(&a, q, 1, 1) - m11 - m22) / 2;
    const double j1 = -a.link_length * sin(q[0]), j2 = -a.link_length * sin(q[1]);
    const double slip = j1 * w[0] + j2 * w[1],
                 per = FRICTION * slip / (m11 * m22 - m12 * m12);
    check_relative(alpha[1][0] - alpha[0][0], -per * (m22 * j1 - m12 * j2), 1e-9);
    check_relative(alpha[1][1] - alpha[0][1], -per * (m11 * j2 - m12 * j1), 1e-9);
    check_relative(reaction[1].wall_power - reaction[0].wall_power,
                   FRICTION * slip * slip, 1e-9);
}

// What the springs, the wall's and the motion itself have lost, the ledger of a run
// knows.
static double lost_at_the_wall(const char *settings)
{
    const parameters p = arm_at_wall(settings);
    arm a;
    arm_init(&a, &p);
    motion *m = motion_create(&a, &p.method);
    assert_non_null(m);
    motion_start(&a, m, p.initial.angle, 0);

    long steps = 0;
    while (m->state[SLOT_TIME] < 0.8) {
        motion_report report;
        assert_int_equal(motion_step(&a, m, 0.8, 0.8, &report), STATUS_OK);
        motion_apply(&a, m, &report);
        assert_true(++steps < 20000);
    }

    const double lost = state_quadratures(m, m->state)[QUADRATURE_WALL];
    const double residual = motion_energy_residual(&a, m, m->state);
    printf("%s: %ld steps, lost %.9g J, residual %.2g J\n", settings, steps, lost,
           residual);
    check_close(residual, 0, 1e-8);
    motion_destroy(m);
    return lost;
}

TEST(friction_takes_energy_that_the_ledger_knows)
{
    const double without = lost_at_the_wall("arm.links=5 arm.hub_joint=beam");
    const double with =
        lost_at_the_wall("arm.links=5 arm.hub_joint=beam wall.friction=3");
    assert_true(fabs(with - without) > 1e-4);
    lost_at_the_wall("arm.links=2 wall.friction=0.8");

    // so much that its derivative has to be in the tangent
    lost_at_the_wall("arm.links=5 wall.friction=1e3");
}

// Where it cannot act it is refused, or said to be without effect.
TEST(what_has_no_such_force_refuses_it)
{
    const char *const refused[] = {
        "wall.contact=kelvin-voigt method.name=newmark wall.friction=1",
        "wall.contact=kelvin-voigt method.engine=pair wall.friction=1",
        "wall.friction=1"};
    for (int i = 0; i < 3; i++) {
        parameters p = fresh(ARM_CORRECTED);
        fault f = {0};
        give_all(&p, refused[i]);
        assert_int_equal(parameters_resolve(&p, &f), STATUS_BAD_SCENARIO);
        printf("%s\n", f.text);
    }

    const parameters none = resolved("wall.kind=none wall.friction=1");
    assert_non_null(features_inert(features_of(&none), parameter_find("wall.friction")));
}
