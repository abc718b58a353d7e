// Combinations of parameters: contradictions, and values derived from given ones.
#include "src/arm/chain.h"
#include "src/base/random.h"
#include "tests/given_parameters.h"

// The pair of settings cannot be resolved and the sentence says `expected`.
static void check_conflict(const char *first, const char *first_text, const char *second,
                           const char *second_text, const char *expected)
{
    parameters p = fresh(ARM_CORRECTED);
    fault f = {0};
    give(&p, first, first_text);
    give(&p, second, second_text);
    assert_int_equal(parameters_resolve(&p, &f), STATUS_BAD_SCENARIO);
    fail_if(strstr(f.text, expected) == NULL, "'%s' does not say '%s'", f.text, expected);
    // to blame is the one that the sentence begins with, of those that were given
    assert_true(strcmp(f.path, first) == 0 || strcmp(f.path, second) == 0);
    assert_non_null(strstr(f.text, f.path));
}

TEST(impossible_combinations_are_refused)
{
    check_conflict("arm.link_inertia", "1e-5", "arm.links", "3", "two links only");
    check_conflict("arm.model", "printed", "arm.links", "3", "two links");
    check_conflict("arm.model", "printed", "arm.hub_joint", "rigid", "hub spring");
    check_conflict("arm.model", "printed", "arm.hub_joint", "beam", "hub spring");
    check_conflict("arm.EI", "2.46", "arm.k2", "4.92", "both given");
    check_conflict("arm.hub_joint", "beam", "arm.k1", "90", "k2 N = 9.84");
    check_conflict("arm.model", "printed", "method.name", "event", "newmark");
    check_conflict("arm.model", "printed", "wall.kind", "plane", "point or none");
    check_conflict("arm.model", "printed", "arm.tip_mass", "0.02", "carries nothing");
    check_conflict("wall.contact", "hunt-crossley", "wall.restitution", "0.5", "rigid");
    check_conflict("wall.contact", "hunt-crossley", "wall.mass", "0.5", "kelvin-voigt");
    check_conflict("wall.contact", "kelvin-voigt", "wall.mass", "1e-12", "at least");
    check_conflict("arm.hub_joint", "beam", "arm.hub_inertia", "0", "nothing to move");
    check_conflict("wall.contact", "kelvin-voigt", "method.name", "newmark", "event only");
    check_conflict("control.delay", "0.06", "control.rate", "100", "longer than 5 periods of 0.01");
    check_conflict("control.delay_periods", "4.8", "control.delay", "0.002", "periods of 0.005 s");
}

// Two settings that look like a conflict and are none.
static void check_goes_together(const char *const *settings)
{
    parameters p = fresh(ARM_CORRECTED);
    for (int i = 0; settings[i] != NULL; i += 2) {
        give(&p, settings[i], settings[i + 1]);
    }
    DONE(parameters_resolve(&p, &f));
}

TEST(what_only_looks_like_a_conflict_is_none)
{
    // a limit that the amplifier holds by itself, a face that bounces
    check_goes_together((const char *const[]){"method.name", "generalized-alpha", "motor.drive",
                                              "current", "motor.current_limit", "5", NULL});
    check_goes_together((const char *const[]){"wall.contact", "kelvin-voigt", "wall.mass", "0.5",
                                              "wall.restitution", "0.5", NULL});

    // and what is given as nothing
    check_goes_together((const char *const[]){"method.name", "generalized-alpha",
                                              "arm.joint_stiffness", "", "arm.stiffening", "0",
                                              NULL});
}

// Of several that contradict one another the first that was given is to blame; defaults are not.
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

// Where a straight arm starts: how far its tip is behind the flat wall, or its line behind the
// point, is by the sine of the angle between them, for any number of links.
static void check_start(parameters p, double angle, double wall)
{
    fault f = {0};
    arm a;
    double q[5], rest[5] = {0}, behind;
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
    chain_penetration(&a, q, rest, &behind, NULL);

    const bool far = angle > wall + 1e-14; // where the wall is in front only after a turn
    fail_if(fabs(behind) > 1e-14 && (code == STATUS_OK) != (behind < 0 && !far),
            "start at %.17g, wall at %.17g, %.3g m behind: %s", angle, wall, behind, f.text);
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
    random_generator g;
    random_seed(&g, 29);
    for (int i = 0; i < 3000; i++) {
        const int contact = (int)random_below(&g, 3);
        parameters p = fresh(i % 10 == 0 ? ARM_PRINTED : ARM_CORRECTED);
        if (i % 10 > 0) {
            give(&p, "wall.kind", kinds[random_below(&g, 2)]);
            give(&p, "wall.contact", contacts[contact]);
            give(&p, "method.name", methods[contact > 0 ? 0 : random_below(&g, 3)]);
            give(&p, "arm.links", links[random_below(&g, 3)]);
        }
        const double wall = 6 * random_uniform(&g) - 3, near = exp(-40 * random_uniform(&g));
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
    parameters p = fresh(ARM_CORRECTED);
    give(&p, "wall.kind", "none");
    give(&p, "initial.angle", "2");
    DONE(parameters_resolve(&p, &f));
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
    check_close(bound[0],
                parameter_table[parameter_find("method.residual_bound")].default_corrected, 0);
    check_close(bound[1], 1e-2, 0);
    check_close(bound[2], 1e-2, 0);
}

TEST(resolving_twice_changes_nothing)
{
    parameters p = fresh(ARM_CORRECTED);
    give(&p, "arm.links", "7");
    DONE(parameters_resolve(&p, &f));
    parameters once = p;
    DONE(parameters_resolve(&p, &f));
    assert_memory_equal(&p, &once, sizeof p);
}

// What a combination of settings is resolved to: accepted, or refused for one of them.
TEST(conditions_hold_up_to_their_limits)
{
    static const struct {
        const char *settings[4]; // path=value
        const char *blamed;      // NULL: accepted
    } cases[] = {
        // faces that are none
        {{"wall.contact=kelvin-voigt", "wall.mass=0"}, NULL},
        {{"wall.contact=kelvin-voigt", "wall.mass=1e-9"}, NULL},
        {{"wall.contact=kelvin-voigt", "wall.mass=0.999e-9"}, "wall.mass"},
        {{"wall.contact=hunt-crossley", "wall.mass=0"}, NULL},
        {{"wall.contact=rigid", "wall.mass=0.1"}, "wall.mass"},
        {{"wall.contact=hunt-crossley", "wall.mass=0.1"}, "wall.mass"},

        // restitution is of what has a mass to be thrown back
        {{"wall.contact=rigid", "wall.restitution=0.5"}, NULL},
        {{"wall.contact=kelvin-voigt", "wall.restitution=0.5"}, "wall.restitution"},
        {{"wall.contact=kelvin-voigt", "wall.restitution=0.5", "wall.mass=0.1"}, NULL},
        {{"wall.contact=rigid", "method.name=newmark"}, NULL},
        {{"wall.contact=hunt-crossley", "method.name=newmark"}, "wall.contact"},

        // delays and jitter as long as the periods allow, and beyond
        {{"control.rate=100", "control.delay=0.05"}, NULL},
        {{"control.rate=100", "control.delay=0.0501"}, "control.delay"},
        {{"control.rate=64", "control.delay=0.0078125", "control.delay_periods=4.5"}, NULL},
        {{"control.rate=64", "control.delay=0.0078125", "control.delay_periods=4.51"},
         "control.delay_periods"},
        {{"control.delay_periods=5"}, NULL},
        {{"control.rate=64", "control.jitter=0.015625"}, NULL},
        {{"control.rate=64", "control.jitter=0.01563"}, "control.jitter"},

        // a sensor that is asked for is there, unless it was left out
        {{"control.impact_angle=film"}, NULL},
        {{"control.impact_angle=film", "sensor.film=true"}, NULL},
        {{"control.impact_angle=film", "sensor.film=false"}, "control.impact_angle"},
        {{"sensor.film=false"}, NULL},
        {{"control.impact_angle=accelerometer"}, NULL},
        {{"control.impact_angle=accelerometer", "sensor.accelerometer=false"},
         "control.impact_angle"},
        {{"control.impact_angle=accelerometer", "sensor.film=false"}, NULL},
        {{"sensor.force=piezo"}, NULL},
        {{"sensor.force=piezo", "sensor.piezo=false"}, "sensor.force"},
        {{"sensor.piezo=false"}, NULL},

        // a band-pass has its edges in order
        {{"sensor.piezo_leak_time=1e-3", "sensor.piezo_rise_time=1e-3"}, NULL},
        {{"sensor.piezo_leak_time=0.99e-3", "sensor.piezo_rise_time=1e-3"},
         "sensor.piezo_leak_time"},
        {{"sensor.piezo_leak_time=0", "sensor.piezo_rise_time=1e-3"}, NULL},

        // motors
        {{"motor.inductance=1e-3"}, NULL},
        {{"motor.inductance=1e-3", "method.name=newmark"}, "motor.inductance"},
        {{"motor.inductance=1e-3", "motor.drive=current"}, "motor.inductance"},
        {{"motor.current_limit=2", "method.name=newmark"}, "motor.current_limit"},
        {{"motor.current_limit=2", "motor.drive=current", "method.name=newmark"}, NULL},
        {{"motor.current_limit=2"}, NULL},
        {{"motor.transconductance=1", "motor.drive=current"}, NULL},
        {{"motor.transconductance=1"}, "motor.transconductance"},

        // laws that are found elsewhere
        {{"control.law=plugin"}, "control.law"},
        {{"control.law=plugin", "control.plugin=x.so"}, NULL},
        {{"control.law=process"}, "control.law"},
        {{"control.law=process", "control.command=x"}, NULL},
        {{"control.plugin=x.so", "control.command=x"}, NULL},

        // the printed arm
        {{"arm.model=printed"}, NULL},
        {{"arm.model=printed", "wall.kind=none"}, NULL},
        {{"arm.model=printed", "arm.links=1"}, "arm.links"},
        {{"arm.model=printed", "method.name=generalized-alpha"}, "method.name"},
        {{"arm.model=printed", "arm.hub_joint=spring"}, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        parameters p = fresh(ARM_CORRECTED);
        fault f = {0};
        for (int k = 0; k < 4 && cases[i].settings[k] != NULL; k++) {
            char path[64];
            const char *equals = strchr(cases[i].settings[k], '=');
            snprintf(path, sizeof path, "%.*s", (int)(equals - cases[i].settings[k]),
                     cases[i].settings[k]);
            give(&p, path, equals + 1);
        }
        const status code = parameters_resolve(&p, &f);
        fail_if((code == STATUS_OK) != (cases[i].blamed == NULL) ||
                    (cases[i].blamed != NULL && strcmp(f.path, cases[i].blamed) != 0),
                "case %zu, %s ...: %s %s", i, cases[i].settings[0], f.path, f.text);
    }
}

// Parameters that are not given follow from the others.
TEST(walls_motors_and_sensors_follow_what_was_given)
{
    parameters p = fresh(ARM_CORRECTED);
    give(&p, "motor.amplifier_gain", "3");
    give(&p, "motor.resistance", "4");
    DONE(parameters_resolve(&p, &f));
    check_close(p.motor.transconductance, 0.75, 0);
    assert_false(p.sensor.film || p.sensor.accelerometer || p.sensor.piezo);

    // damping of a Hunt-Crossley wall is 3/2 of its loss times its stiffness
    give(&p, "wall.contact", "hunt-crossley");
    give(&p, "wall.stiffness", "2e5");
    DONE(parameters_resolve(&p, &f));
    check_relative(p.wall.damping, 0.3 * 2e5, 1e-15);
    p = fresh(ARM_CORRECTED);
    give(&p, "wall.contact", "hunt-crossley");
    give(&p, "wall.damping", "7");
    DONE(parameters_resolve(&p, &f));
    check_close(p.wall.stiffness, 1e6, 0);
    check_close(p.wall.damping, 7, 0);
    p = fresh(ARM_CORRECTED);
    give(&p, "wall.contact", "kelvin-voigt");
    DONE(parameters_resolve(&p, &f));
    check_close(p.wall.stiffness, 75e3, 0);
    check_close(p.wall.damping, 20, 0);

    // what a law or a signal is taken from is there
    static const char *const asked[][2] = {{"control.impact_angle", "film"},
                                           {"control.impact_angle", "accelerometer"},
                                           {"sensor.force", "piezo"}};
    for (int i = 0; i < 3; i++) {
        p = fresh(ARM_CORRECTED);
        give(&p, asked[i][0], asked[i][1]);
        DONE(parameters_resolve(&p, &f));
        assert_int_equal(p.sensor.film, i == 0);
        assert_int_equal(p.sensor.accelerometer, i == 1);
        assert_int_equal(p.sensor.piezo, i == 2);
    }
}
