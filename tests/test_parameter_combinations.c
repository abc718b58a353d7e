// Combinations of parameters: contradictions, and values derived from given ones.
#include "src/arm/chain.h"
#include "tests/given_parameters.h"

// Of several that contradict one another the first that was given is to blame; defaults
// are not.
TEST(defaults_are_never_to_blame)
{
    parameters p = fresh(ARM_CORRECTED);
    fault f = {0};
    give(&p, "wall.angle", "-2 rad");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_BAD_SCENARIO);
    assert_string_equal(f.path, "wall.angle");
    give(&p, "initial.angle", "-1 rad");
    assert_int_equal(parameters_resolve(&p, &f), STATUS_BAD_SCENARIO);
    assert_string_equal(f.path, "initial.angle");
}

// Where a straight arm starts: how far its tip is behind the flat wall, or its line
// behind the point, is by the sine of the angle between them, for any number of links.
static void check_start(parameters p, double angle, double wall)
{
    fault f = {0};
    arm a;
    double q[5], rest[5] = {0};
    p.initial.angle = angle;
    p.wall.angle = wall;
    p.set[parameter_find("initial.angle")] = p.set[parameter_find("wall.angle")] = true;
    const status code = parameters_resolve(&p, &f);
    p.arm.hub_joint = p.arm.model == ARM_PRINTED ? HUB_RIGID : p.arm.hub_joint;
    arm_init(&a, &p);
    assert_in_range(a.dof, 1, 5);
    for (int k = 0; k < a.dof; k++) {
        q[k] = angle;
    }
    const double behind = chain_penetration(&a, q, rest).depth;
    const bool far = angle > wall + 1e-14; // where the wall is in front only after a turn
    fail_if(fabs(behind) > 1e-14 && (code == STATUS_OK) != (behind < 0 && !far),
            "start at %.17g, wall at %.17g, %.3g m behind: %s", angle, wall, behind,
            f.text);
    const double ahead = wall - angle;
    if (ahead == 0 || ahead == M_PI) {
        assert_int_equal(code, STATUS_OK);
    }
    assert_true(code == STATUS_OK || strcmp(f.path, "initial.angle") == 0);
}

TEST(an_arm_starts_in_front_of_its_wall)
{
    static const char *const kinds[] = {"point", "plane"};
    static const char *const contacts[] = {"rigid", "kelvin-voigt", "hunt-crossley"};
    static const char *const methods[] = {"event", "newmark", "generalized-alpha"};
    static const char *const links[] = {"1", "2", "5"};
    random_generator g = seeded(29);
    for (int i = 0; i < 3000; i++) {
        const int contact = (int)random_below(&g, 3);
        parameters p = fresh(i % 10 == 0 ? ARM_PRINTED : ARM_CORRECTED);
        if (i % 10 > 0) {
            give(&p, "wall.kind", kinds[random_below(&g, 2)]);
            give(&p, "wall.contact", contacts[contact]);
            give(&p, "method.name", methods[contact > 0 ? 0 : random_below(&g, 3)]);
            give(&p, "arm.links", links[random_below(&g, 3)]);
        }
        const double wall = 6 * random_uniform(&g) - 3,
                     near = exp(-40 * random_uniform(&g));
        const double sign = random_uniform(&g) < 0.5 ? -1 : 1;
        check_start(p, 6 * random_uniform(&g) - 3, wall);
        check_start(p, wall, wall);
        check_start(p, fmax(-3, fmin(wall + sign * near, 3)), wall);
        if (wall - M_PI - near >= -3) {
            check_start(p, wall - M_PI, wall);
            check_start(p, wall - M_PI + sign * near, wall);
        }
    }

    // without a wall anywhere
    resolved("wall.kind=none initial.angle=2");
}

// The bound of what the ledger may lack follows the method, unless it was given.
TEST(the_ledgers_bound_follows_the_method)
{
    static const char *const methods[] = {"event", "newmark", "generalized-alpha"};
    double bound[3];
    for (int i = 0; i < 3; i++) {
        parameters p = fresh(ARM_CORRECTED), own = p, back;
        fault f = {0};
        give(&p, "method.name", methods[i]);
        give(&own, "method.name", methods[i]);
        give(&own, "method.residual_bound", "3e-5");
        back = p;
        assert_int_equal(parameters_resolve(&p, &f), STATUS_OK);
        assert_int_equal(parameters_resolve(&own, &f), STATUS_OK);
        bound[i] = p.method.residual_bound;
        check_close(own.method.residual_bound, 3e-5, 0);

        // resolved for one method and then for another it is the other's
        parameters_resolve(&back, &f);
        give(&back, "method.name", "event");
        assert_int_equal(parameters_resolve(&back, &f), STATUS_OK);
        check_close(back.method.residual_bound, bound[0], 0);
    }
    check_close(
        bound[0],
        parameter_table[parameter_find("method.residual_bound")].default_corrected, 0);
    check_close(bound[1], 1e-2, 0);
    check_close(bound[2], 1e-2, 0);
}

TEST(resolving_twice_changes_nothing)
{
    parameters p = resolved("arm.links=7");
    const parameters once = p;
    DONE(parameters_resolve(&p, &f));
    assert_memory_equal(&p, &once, sizeof p);
}

// What a combination of settings is resolved to: accepted, or refused for one of them.
TEST(conditions_hold_up_to_their_limits)
{
    static const struct {
        const char *settings; // path=value, between blanks
        const char *blamed;   // NULL: accepted
        const char *says;     // NULL: whatever
    } cases[] = {
        // faces that are none
        {"wall.contact=kelvin-voigt wall.mass=0"},
        {"wall.contact=kelvin-voigt wall.mass=1e-9"},
        {"wall.contact=kelvin-voigt wall.mass=0.999e-9", "wall.mass",
         "expected 0 (none) or at least"},
        {"wall.contact=hunt-crossley wall.mass=0"},
        {"wall.contact=rigid wall.mass=0.1", "wall.mass", "kelvin-voigt"},
        {"wall.contact=hunt-crossley wall.mass=0.1", "wall.mass", "kelvin-voigt"},

        // restitution is of what has a mass to be thrown back
        {"wall.contact=rigid wall.restitution=0.5"},
        {"wall.contact=kelvin-voigt wall.restitution=0.5", "wall.restitution",
         "is for wall.contact = rigid"},
        {"wall.contact=kelvin-voigt wall.restitution=0.5 wall.mass=0.1"},
        {"wall.contact=rigid method.name=newmark"},
        {"wall.contact=hunt-crossley method.name=newmark", "wall.contact", "event only"},

        // delays and jitter as long as the periods allow, and beyond
        {"control.rate=100 control.delay=0.05"},
        {"control.rate=100 control.delay=0.0501", "control.delay",
         "longer than 5 periods of 0.01"},
        {"control.rate=64 control.delay=0.0078125 control.delay_periods=4.5"},
        {"control.rate=64 control.delay=0.0078125 control.delay_periods=4.51",
         "control.delay_periods"},
        {"control.delay_periods=5"},
        {"control.rate=64 control.jitter=0.015625"},
        {"control.rate=64 control.jitter=0.01563", "control.jitter", "jitter"},

        // a sensor that is asked for is there, unless it was left out
        {"control.impact_angle=film"},
        {"control.impact_angle=film sensor.film=true"},
        {"control.impact_angle=film sensor.film=false", "control.impact_angle",
         "sensor.film"},
        {"sensor.film=false"},
        {"control.impact_angle=accelerometer"},
        {"control.impact_angle=accelerometer sensor.accelerometer=false",
         "control.impact_angle", "sensor.accelerometer = false"},
        {"control.impact_angle=accelerometer sensor.film=false"},
        {"sensor.force=piezo"},
        {"sensor.force=piezo sensor.piezo=false", "sensor.force"},
        {"sensor.piezo=false"},

        // a band-pass has its edges in order
        {"sensor.piezo_leak_time=1e-3 sensor.piezo_rise_time=1e-3"},
        {"sensor.piezo_leak_time=0.99e-3 sensor.piezo_rise_time=1e-3",
         "sensor.piezo_leak_time", "sensor.piezo_leak_time"},
        {"sensor.piezo_leak_time=0 sensor.piezo_rise_time=1e-3"},

        // motors
        {"motor.inductance=1e-3"},
        {"motor.inductance=1e-3 method.name=newmark", "motor.inductance",
         "method.name = event only"},
        {"motor.inductance=1e-3 motor.drive=current", "motor.inductance",
         "motor.drive = voltage"},
        {"motor.current_limit=2 method.name=newmark", "motor.current_limit",
         "under a voltage"},
        {"motor.current_limit=2 motor.drive=current method.name=newmark"},
        {"motor.current_limit=2"},
        {"motor.transconductance=1 motor.drive=current"},
        {"motor.transconductance=1", "motor.transconductance", "motor.drive = current"},

        // laws that are found elsewhere
        {"control.law=plugin", "control.law", "control.plugin"},
        {"control.law=plugin control.plugin=x.so"},
        {"control.law=process", "control.law", "control.command"},
        {"control.law=process control.command=x"},
        {"control.plugin=x.so control.command=x"},

        // walls
        {"wall.contact=hunt-crossley wall.restitution=0.5", "wall.restitution", "rigid"},
        {"wall.contact=kelvin-voigt method.name=newmark", "wall.contact", "event only"},
        {"control.delay_periods=4.8 control.delay=0.002", "control.delay_periods",
         "periods of 0.005 s"},

        // the beam, its springs and their lists
        {"arm.link_inertia=1e-5 arm.links=3", "arm.link_inertia", "two links only"},
        {"arm.EI=2.46 arm.k2=4.92", "arm.EI", "both given"},
        {"arm.hub_joint=beam arm.k1=90", "arm.k1", "k2 N = 9.84"},
        {"arm.hub_joint=beam arm.hub_inertia=0", "arm.hub_inertia", "nothing to move"},
        {"arm.links=4 arm.joint_stiffness=10,12", "arm.joint_stiffness",
         "has 2 numbers, expected 3"},
        {"arm.links=3 arm.hub_joint=beam arm.joint_stiffness=10,12",
         "arm.joint_stiffness", "has 2 numbers, expected 3"},
        {"arm.hub_joint=beam arm.joint_stiffness=7", "arm.joint_stiffness",
         "a joint before each"},
        {"arm.joint_stiffness=10 arm.k2=10", "arm.joint_stiffness",
         "arm.k2 are both given"},
        {"arm.joint_stiffness=10 arm.EI=10", "arm.joint_stiffness",
         "arm.EI are both given"},
        {"arm.joint_stiffness=10 arm.stiffening=1", "arm.stiffening",
         "equal links and joints"},
        {"arm.links=3 arm.link_lengths=0.5,0.5", "arm.link_lengths", "has 2 numbers"},
        {"arm.links=3 arm.link_lengths=1", "arm.link_lengths",
         "has 1 number, expected 3"},
        {"arm.links=1 arm.link_lengths=0.5,0.5", "arm.link_lengths", "has 2 numbers"},
        {"arm.links=1 arm.hub_joint=beam arm.link_lengths=0.1,0.2", "arm.link_lengths",
         "arm.links = 1"},
        {"arm.link_lengths=0.4,0.6 arm.length=1", "arm.link_lengths", "both given"},
        {"arm.link_lengths=0.4,0.6 arm.link_inertia=1e-5", "arm.link_inertia",
         "two equal links"},
        {"arm.link_lengths=0.4,0.6 arm.stiffening=1", "arm.stiffening",
         "equal links and joints"},
        {"arm.link_lengths=0.4,0.6 method.name=newmark", "arm.link_lengths",
         "event only"},
        {"arm.modal_ratios=0.1 arm.damping_ratio=0.1", "arm.modal_ratios", "both given"},
        {"arm.modal_ratios=0.1,0.2", "arm.modal_ratios", "expected at most 1"},
        {"arm.links=24 arm.modal_ratios=0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0.1",
         "arm.modal_ratios", "has 17 numbers, expected at most 16"},
        {"arm.links=1 arm.modal_ratios=0.1,0.2", "arm.modal_ratios",
         "expected at most 0: arm.links = 1"},
        {"arm.links=200 arm.modal_ratios=0.1", "arm.modal_ratios", "at most"},
        {"arm.modal_ratios=0.1 method.name=newmark", "arm.modal_ratios",
         "method.name = event only"},
        {"arm.air_drag=1 method.name=newmark", "arm.air_drag",
         "method.name = event only"},
        {"method.name=generalized-alpha arm.joint_stiffness=[] arm.stiffening=0"},

        // the printed arm
        {"arm.model=printed"},
        {"arm.model=printed wall.kind=none"},
        {"arm.model=printed arm.links=1", "arm.links", "two links"},
        {"arm.model=printed method.name=generalized-alpha", "method.name", "newmark"},
        {"arm.model=printed arm.hub_joint=spring"},
        {"arm.model=printed arm.hub_joint=rigid", "arm.hub_joint", "hub spring"},
        {"arm.model=printed arm.hub_joint=beam", "arm.hub_joint", "hub spring"},
        {"arm.model=printed method.name=event", "method.name", "newmark"},
        {"arm.model=printed wall.kind=plane", "wall.kind", "point or none"},
        {"arm.model=printed arm.tip_mass=0.02", "arm.tip_mass", "printed model has none"},
        {"arm.model=printed arm.damping_ratio=0.5", "arm.damping_ratio",
         "printed model has none"},
        {"arm.model=printed arm.damping_ratio=0"},
        {"arm.model=printed wall.restitution=0.5", "wall.restitution",
         "printed model has none"},
        {"arm.model=printed method.rest_speed=1e-3", "method.rest_speed"},
        {"arm.model=printed method.residual_bound=1e-3", "method.residual_bound"},
        {"arm.model=printed arm.air_drag=0.1", "arm.air_drag", "printed model has none"},
    };
    for (EACH(c, cases)) {
        parameters p = fresh(ARM_CORRECTED);
        fault f = {0};
        give_all(&p, c->settings);
        const status code = parameters_resolve(&p, &f);
        const bool right = c->blamed != NULL && strcmp(f.path, c->blamed) == 0 &&
                           strstr(f.text, f.path) != NULL &&
                           (c->says == NULL || strstr(f.text, c->says) != NULL);
        fail_if(code == STATUS_OK ? c->blamed != NULL : !right, "%s: %s: %s", c->settings,
                f.path, f.text);
    }
}

// Parameters that are not given follow from the others.
TEST(walls_motors_and_sensors_follow_what_was_given)
{
    parameters p = resolved("motor.amplifier_gain=3 motor.resistance=4");
    check_close(p.motor.transconductance, 0.75, 0);
    assert_false(p.sensor.film || p.sensor.accelerometer || p.sensor.piezo);

    // damping of a Hunt-Crossley wall is 3/2 of its loss times its stiffness
    p = resolved("wall.contact=hunt-crossley wall.stiffness=2e5");
    check_relative(p.wall.damping, 0.3 * 2e5, 1e-15);
    p = resolved("wall.contact=hunt-crossley wall.damping=7");
    check_close(p.wall.stiffness, 1e6, 0);
    check_close(p.wall.damping, 7, 0);
    p = resolved("wall.contact=kelvin-voigt");
    check_close(p.wall.stiffness, 75e3, 0);
    check_close(p.wall.damping, 20, 0);

    // what a law or a signal is taken from is there
    static const char *const asked[] = {"control.impact_angle=film",
                                        "control.impact_angle=accelerometer",
                                        "sensor.force=piezo"};
    for (int i = 0; i < 3; i++) {
        p = resolved(asked[i]);
        assert_int_equal(p.sensor.film, i == 0);
        assert_int_equal(p.sensor.accelerometer, i == 1);
        assert_int_equal(p.sensor.piezo, i == 2);
    }
}
