// Each force's derivatives against differences of its value, its power against what takes
// energy, its energy against its work.
#include "src/arm/forces.h"
#include "tests/arm_fixture.h"

#define STEP 1e-6

// An arm that has all forces on its links and joints.
static arm arm_with_forces(void)
{
    return arm_with(SETTINGS("arm.links=4", "arm.hub_joint=beam", "arm.stiffening=2",
                             "arm.damping_ratio=0.1", "arm.air_drag=0.4", "arm.tilt=0.3",
                             "arm.tip_mass=0.2"));
}

TEST(a_joints_derivatives_are_those_of_its_torque)
{
    const arm a = arm_with_forces();
    for (int k = 0; k < a.links; k++) {
        const force_constants joint = force_constants_of(&a, k);
        const double bend = 0.2, rate = -1.5;
        const joint_force at = joint_forces(&joint, &a.amount, bend, rate);
        const joint_force more = joint_forces(&joint, &a.amount, bend + STEP, rate);
        const joint_force less = joint_forces(&joint, &a.amount, bend - STEP, rate);
        const joint_force fast = joint_forces(&joint, &a.amount, bend, rate + STEP);
        const joint_force still = joint_forces(&joint, &a.amount, bend, 0);

        check_relative(at.by_bend, (more.torque - less.torque) / (2 * STEP), 1e-8);
        check_relative(at.by_rate, (fast.torque - at.torque) / STEP, 1e-8);
        check_relative(still.torque, (more.energy - less.energy) / (2 * STEP), 1e-8);
        check_relative(at.lost, (at.torque - still.torque) * rate, 1e-12);
    }
}

TEST(a_links_drag_takes_what_it_loses)
{
    const arm a = arm_with_forces();
    const force_constants link = force_constants_of(&a, 1);
    const link_motion at = {.vx = 0.3, .vy = -0.8, .turn = 2};
    link_force f = {0}, still = {0};
    add_link_forces(&link, &a.amount, &at, &f);
    add_link_forces(&link, &a.amount, &(link_motion){0}, &still);

    // at rest there is the weight alone
    check_close(still.x, 0, 0);
    check_relative(still.y, a.amount.gravity * a.link_mass, 1e-15);
    check_close(still.lost, 0, 0);

    // a force on each piece against its velocity
    check_relative(f.x, a.amount.air_drag * a.link_length * at.vx, 1e-14);
    check_relative(f.lost, f.x * at.vx + (f.y - still.y) * at.vy + f.moment * at.turn,
                   1e-13);
    check_relative(f.by_speed, f.x / at.vx, 1e-14);
    check_relative(f.by_turn, f.moment / at.turn, 1e-14);
}

// Half of a link's own weight and all beyond hang at its end.
TEST(weight_turns_a_link_as_its_derivative_says)
{
    const arm a = arm_with_forces();
    const force_constants own = force_constants_of(&a, 3);
    const double beyond = force_constants_of_tip(&a).weight, q = 0.4;
    const double l = a.link_length;
    const double moment[] = {(beyond + own.weight / 2) * l * cos(q - STEP),
                             (beyond + own.weight / 2) * l * cos(q + STEP)};
    check_relative(beyond + own.weight / 2, chain_weight(&a, 3) / l, 1e-14);
    check_relative(weight_by_angle(&own, beyond, l * sin(q)),
                   (moment[1] - moment[0]) / (2 * STEP), 1e-8);
}

TEST(a_motors_derivatives_are_those_of_its_torque)
{
    const arm a = arm_with(SETTINGS("motor.inductance=0.1"));
    hub_force at = {0}, fast = {0}, strong = {0};
    add_hub_forces(&a.motor, 0.7, 0.3, &at);
    add_hub_forces(&a.motor, 0.7 + STEP, 0.3, &fast);
    add_hub_forces(&a.motor, 0.7, 0.3 + STEP, &strong);
    check_relative(at.by_rate, (fast.torque - at.torque) / STEP, 1e-7);
    check_relative(at.by_current, (strong.torque - at.torque) / STEP, 1e-7);
    check_relative(at.viscous, a.motor.damping * 0.7 * 0.7, 1e-15);
    check_relative(at.drive, a.motor.torque_constant * 0.3, 1e-15);
}

TEST(a_shape_is_damped_by_its_rate)
{
    const shape_force f = shape_forces(-0.6);
    check_close(f.size, -0.6, 0);
    check_relative(f.lost, 0.36, 1e-15);
    check_close(f.by_rate, 1, 0);
}

TEST(a_walls_derivatives_are_those_of_its_force)
{
    for (EACH_TEXT(law, "wall.contact=kelvin-voigt", "wall.contact=hunt-crossley")) {
        const arm a = arm_with(SETTINGS(*law, "wall.stiffness=2e4", "wall.damping=300",
                                        "wall.exponent=1.7"));
        const double depth = 2e-3, rate = 0.3, step = 1e-8;
        const wall_meeting here = {depth, rate, 0}, deeper = {depth + step, rate, 0};
        const wall_meeting faster = {depth, rate + step, 0};
        const wall_answer at = wall_forces(&a.wall, &a.amount, &here);
        const double by_depth =
            wall_forces(&a.wall, &a.amount, &deeper).normal - at.normal;
        const double by_rate =
            wall_forces(&a.wall, &a.amount, &faster).normal - at.normal;
        check_relative(at.by_depth, by_depth / step, 1e-4);
        check_relative(at.by_rate, by_rate / step, 1e-4);

        // heat is what the spring does not hold
        const double held = wall_normal_force(&a.wall, depth, 0);
        check_relative(at.lost, (at.normal - held) * rate, 1e-12);
        check_close(at.along, 0, 0);
    }
}

TEST(a_rigid_wall_has_no_law)
{
    const arm a = arm_with(SETTINGS("wall.contact=rigid"));
    const wall_answer at =
        wall_forces(&a.wall, &a.amount, &(wall_meeting){1e-3, 0.2, 0.4});
    check_close(at.normal, 0, 0);
    check_close(at.lost, 0, 0);
}
