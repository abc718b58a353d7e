// The wall's geometry against differences of the penetration, and its law of restitution.
#include "src/arm/forces.h"
#include "tests/arm_fixture.h"

static wall_model wall_of(const char *const *settings)
{
    wall_model w;
    parameters p = fixture_parameters(settings);
    wall_init(&w, &p);
    return w;
}

TEST(the_contact_point_lies_the_arms_length_from_the_hub)
{
    wall_model w = wall_of(SETTINGS("wall.angle=0.7", "arm.length=1.5"));
    check_close(hypot(w.x, w.y), 1.5, 1e-15);
    check_close(atan2(w.y, w.x), 0.7, 1e-15);
    check_close(wall_along(&w, cos(0.7), sin(0.7)), 1.5, 1e-15);
    check_close(wall_right_of(&w, cos(0.7), sin(0.7)), 0, 1e-15);
}

// The last link of a moving arm: base, direction, and their rates.
typedef struct last_link {
    double x, y, vx, vy, ax, ay; // base [m], [m/s], [m/s2]
    double angle, omega, alpha;  // [rad], [rad/s], [rad/s2]
} last_link;

// After a time, with constant accelerations.
static last_link after(last_link l, double t)
{
    l.x += t * (l.vx + t * l.ax / 2);
    l.y += t * (l.vy + t * l.ay / 2);
    l.vx += t * l.ax;
    l.vy += t * l.ay;
    l.angle += t * (l.omega + t * l.alpha / 2);
    l.omega += t * l.alpha;
    return l;
}

static wall_contact contact_of(const wall_model *w, last_link l)
{
    return wall_contact_at(w, 0.5, l.x, l.y, l.vx, l.vy, cos(l.angle), sin(l.angle),
                           l.omega);
}

static double rate_of(const wall_model *w, last_link l)
{
    wall_contact at = contact_of(w, l);
    double lever = wall_last_lever(&at, 0.5, cos(l.angle), sin(l.angle));
    return wall_penetration_rate(&at, l.vx, l.vy, lever, l.omega);
}

TEST(rates_are_the_derivatives_of_the_penetration)
{
    const last_link now = {0.49, 0.08, -0.3, 0.7, 2, -1.5, 0.25, -1.1, 4};
    for (EACH_TEXT(c, "wall.kind=point", "wall.kind=plane")) {
        wall_model w = wall_of(SETTINGS(*c, "wall.angle=0.2"));
        const double h = 1e-5;
        last_link before = after(now, -h), later = after(now, h);
        wall_contact at = contact_of(&w, now);
        double slope =
            (contact_of(&w, later).penetration - contact_of(&w, before).penetration);
        check_close(rate_of(&w, now), slope / (2 * h), 1e-8);

        // d2g/dt2 = J alpha + (base acceleration)'e + the velocity terms
        double lever = wall_last_lever(&at, 0.5, cos(now.angle), sin(now.angle));
        double second =
            lever * now.alpha + at.ex * now.ax + at.ey * now.ay + at.convective;
        check_close(second, (rate_of(&w, later) - rate_of(&w, before)) / (2 * h), 1e-7);
    }
}

TEST(a_straight_arm_at_the_walls_angle_touches_it)
{
    for (EACH_TEXT(c, "wall.kind=point", "wall.kind=plane")) {
        wall_model w = wall_of(SETTINGS(*c, "wall.angle=0.3"));
        last_link l = {.x = 0.5 * cos(0.3), .y = 0.5 * sin(0.3), .angle = 0.3};
        assert_true(wall_stands(&w));
        check_close(contact_of(&w, l).penetration, 0, 1e-15);
        check_close(contact_of(&w, l).lever, 0, 1e-15);
        // turned on about its base it is behind the wall, turned back before it
        l.angle = 0.3 + 1e-3;
        check_close(contact_of(&w, l).penetration, 0.5 * sin(1e-3), 1e-15);
        l.angle = 0.3 - 1e-3;
        check_close(contact_of(&w, l).penetration, -0.5 * sin(1e-3), 1e-15);
    }
    wall_model none = wall_of(SETTINGS("wall.kind=none"));
    assert_false(wall_stands(&none));
}

TEST(slow_impacts_are_plastic)
{
    wall_model w = wall_of(SETTINGS("wall.restitution=0.6", "method.rest_speed=0.01"));
    check_close(wall_restitution(&w, 0.5), 0.6, 0);
    check_close(wall_restitution(&w, 0.01), 0.6, 0);
    check_close(wall_restitution(&w, 0.0099), 0, 0);

    // nor of what no engine can tell from rest
    w.rest_speed = 0;
    check_close(wall_restitution(&w, 4e-9), 0.6, 0);
    check_close(wall_restitution(&w, 3e-9), 0, 0);
}

// What the spring stores, against the integral.
TEST(a_soft_walls_force_has_its_energy)
{
    for (EACH_TEXT(c, "wall.contact=kelvin-voigt", "wall.contact=hunt-crossley")) {
        const wall_model w = wall_of(
            SETTINGS(*c, "wall.stiffness=2e4", "wall.damping=30", "wall.exponent=1.7"));
        const double depth = 2e-3;

        // the midpoint rule over the depth, without the damper
        double stored = 0;
        enum { PARTS = 2000 };
        for (int i = 0; i < PARTS; i++) {
            stored += wall_normal_force(&w, depth * (i + 0.5) / PARTS, 0) * depth / PARTS;
        }
        check_relative(wall_stored_energy(&w, depth), stored, 1e-6);
        check_close(wall_stored_energy(&w, -depth), 0, 0);
        check_close(wall_stored_energy(&w, 0), 0, 0);
    }
}

// A face swings back at its own rate; one that rests in its place does nothing.
TEST(a_face_at_rest_has_no_rate)
{
    const wall_model w =
        wall_of(SETTINGS("wall.contact=kelvin-voigt", "wall.stiffness=1e4",
                         "wall.damping=1", "wall.mass=0.04"));
    check_close(wall_face_rate(&w, (wall_face){0, 0}), 0, 0);
    check_relative(wall_face_rate(&w, (wall_face){0, 0.1}), 500.0, 1e-12);
    check_relative(wall_face_rate(&w, (wall_face){1e-3, 0}), 500.0, 1e-12);
}

// A mass that meets the wall: its rate is that of the wall's spring where it is deepest,
// or of its damper where that is faster; the deepest point is found by following the
// mass.
TEST(the_rate_is_that_at_the_deepest_point)
{
    const double mass = 0.04, speeds[] = {0.1, 0.7, 3};
    for (EACH(c, speeds)) {
        wall_model w = wall_of(SETTINGS("wall.contact=hunt-crossley",
                                        "wall.stiffness=1e5", "wall.damping=0"));
        double depth = 0, speed = *c, step = 1e-7;
        while (speed > 0) {
            // the midpoint's force, from energy conserved over half a step
            const double middle = depth + 0.5 * step * speed;
            speed -= step * wall_spring_force(&w, middle) / mass;
            depth = middle + 0.5 * step * speed;
        }
        const double stiffness = 1.5 * wall_spring_force(&w, depth) / depth;
        check_relative(wall_rate(&w, 1 / mass, 0, *c), sqrt(stiffness / mass), 1e-4);

        // leaving it, it comes no deeper than it is
        const double left = 1.5 * wall_spring_force(&w, 1e-3) / 1e-3;
        check_relative(wall_rate(&w, 1 / mass, 1e-3, -*c), sqrt(left / mass), 1e-12);
    }
    wall_model damped = wall_of(
        SETTINGS("wall.contact=kelvin-voigt", "wall.stiffness=10", "wall.damping=500"));
    check_relative(wall_rate(&damped, 1 / mass, 0, 1), 500 / mass, 1e-12);
}

// Where a damper that grows with the depth stops the mass, the rate is that of the damper
// there, whether the mass has just met the wall or is in it already.
TEST(a_damper_that_grows_stops_the_mass)
{
    const double mass = 0.04, speed = 0.7, begins[] = {0, 1e-3};
    const wall_model w = wall_of(
        SETTINGS("wall.contact=hunt-crossley", "wall.stiffness=1", "wall.damping=1e6"));
    for (int i = 0; i < 2; i++) {
        // the mass loses damping * depth^exponent of its momentum on each part of its way
        double depth = begins[i], left = mass * speed;
        const double part = 1e-8;
        for (; left > 0; depth += part) {
            left -= part * (wall_normal_force(&w, depth + part / 2, 1) -
                            wall_normal_force(&w, depth + part / 2, 0));
        }
        const double damping =
            wall_normal_force(&w, depth, 1) - wall_normal_force(&w, depth, 0);
        check_relative(wall_rate(&w, 1 / mass, begins[i], speed), damping / mass, 1e-4);
    }
}
