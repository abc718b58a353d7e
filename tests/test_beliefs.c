// The parameters that a controller is told: the true ones, changed by belief.* of the
// scenario.
#include "src/rig/rig.h"
#include "tests/rig_fixture.h"

// The setup that the hybrid law got under the settings.
static controller_setup told(const char *const *settings)
{
    const parameters p = rig_parameters(settings);
    return setup_of(&p);
}

TEST(without_wrong_beliefs_it_is_the_truth)
{
    parameters p = rig_parameters_with("wall.angle=0.2");
    controller_setup s = told(given("wall.angle=0.2 control.delay=2e-3"));
    check_close(s.link_mass, p.arm.mass / 2, 0);
    check_close(s.hub_inertia, p.arm.hub_inertia, 0);
    check_close(s.link_inertia, p.arm.link_inertia, 0);
    check_close(s.k2, p.arm.k2, 0);
    check_close(s.stiction, p.motor.stiction, 0);
    check_close(s.hub_damping, motor_damping(&p.motor), 0);
    check_close(s.torque_per_volt, motor_torque_per_volt(&p.motor), 0);
    check_close(s.wall_angle, 0.2, 0);
    check_close(s.delay, 2e-3, 0);
    assert_int_equal(s.links, 2);
    assert_true(isinf(s.hub_spring));
}

TEST(each_belief_changes_what_it_names)
{
    controller_setup truth = told(given("control.delay=2e-3"));
    controller_setup s =
        told(given("control.delay=2e-3 belief.mass_factor=1.5 belief.inertia_factor=0.5 "
                   "belief.friction_factor=2 belief.torque_factor=1.2 "
                   "belief.k2_factor=0.8 belief.wall_error=0.03 "
                   "belief.delay_error=-1e-3 belief.links=5"));
    check_relative(s.link_mass, 1.5 * truth.link_mass, 1e-15);
    check_relative(s.link_inertia, 1.5 * truth.link_inertia, 1e-15);
    check_relative(s.hub_inertia, 0.5 * truth.hub_inertia, 1e-15);
    check_relative(s.stiction, 2 * truth.stiction, 1e-15);
    check_relative(s.torque_per_volt, 1.2 * truth.torque_per_volt, 1e-15);
    check_relative(s.k2, 0.8 * truth.k2, 1e-15);
    check_close(s.wall_angle - truth.wall_angle, 0.03, 1e-15);
    check_close(s.delay, 1e-3, 1e-15);
    assert_int_equal(s.links, 5);

    // viscous friction counts as friction, back EMF goes with kT
    parameters p = rig_parameters(NULL);
    check_relative(s.hub_damping,
                   2 * p.motor.viscous_friction + 1.2 * p.motor.torque_constant *
                                                      p.motor.back_emf /
                                                      p.motor.resistance,
                   1e-15);
}

TEST(a_spring_at_the_hub_is_told)
{
    controller_setup s =
        told(given("arm.hub_joint=spring arm.k1=90 belief.hub_spring_factor=1.1"));
    check_relative(s.hub_spring, 99.0, 1e-15);
}

// A belief changes the command and nothing of the arm: the same command moves it the
// same.
TEST(the_arm_has_no_beliefs)
{
    summary truth = rig_summary_with("control.law=open-loop");
    summary doubted = rig_summary_with(
        "control.law=open-loop belief.mass_factor=2 belief.inertia_factor=2 "
        "belief.friction_factor=2 belief.torque_factor=2 belief.k2_factor=2 "
        "belief.wall_error=0.1 belief.delay_error=1e-3 belief.links=7");
    check_close(doubted.peak_force_N, truth.peak_force_N, 0);
    check_close(doubted.first_contact_s, truth.first_contact_s, 0);
}

TEST(an_unknown_delay_is_never_negative)
{
    check_close(told(given("belief.delay_error=-1")).delay, 0, 0);
}
