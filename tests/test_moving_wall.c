// A wall that moves: driven arms and impacts in closed form.
#include <math.h>
#include <stdlib.h>

#include "src/arm/impact.h"
#include "src/contact/engine.h"
#include "tests/passage.h"

// One link without friction, pressed by its weight against a flat wall at the angle 0.
#define PRESSED_LINK                                                                               \
    "arm.links=1", "wall.kind=plane", "wall.angle=0", "motor.voltage=0", "motor.stiction=0",       \
        "motor.viscous_friction=0", "motor.back_emf=0", "arm.tilt=-0.3", "wall.motion=sine"

// The angle at an instant, from rest at the wall.
static double angle_at(const char *const *settings, double time, double *force)
{
    const parameters p = fixture_parameters(settings);
    arm a;
    arm_init(&a, &p);
    motion *m = motion_create(&a, &p.method);
    assert_ptr_equal(m->engine, &stiff_engine);
    motion_start(&a, m, p.initial.angle, 0);
    const passage done = move_on(&a, m, time, 100000);
    check_below(done.open, 1e-10);
    const double angle = state_angles(m, m->state)[0];
    *force = m->state[SLOT_FORCE];
    motion_destroy(m);
    return angle;
}

// On a spring and damper the link is an oscillator that the wall drives:
// (-I w^2 + L^2 (k + i w c)) q = -L (k + i w c) u.
static void a_driven_spring_has_its_amplitude_and_phase(void **state)
{
    (void)state;
    const parameters p = fixture_parameters(SETTINGS(PRESSED_LINK));
    arm a;
    arm_init(&a, &p);
    const double length = a.link_length, k = 2000, c = 20, u = 1e-5;
    const double inertia = a.hub_inertia + a.link_mass * length * length / 3;
    static const char *const frequencies[] = {"2", "15", "20", "60"};
    for (size_t i = 0; i < sizeof frequencies / sizeof *frequencies; i++) {
        const double w = 2 * M_PI * atof(frequencies[i]), period = 2 * M_PI / w;
        const double lre = length * length * k - inertia * w * w, lim = length * length * w * c;
        const double d = lre * lre + lim * lim;
        const double re = -length * u * (k * lre + w * c * lim) / d;
        const double im = -length * u * (w * c * lre - k * lim) / d;
        char f[64];
        snprintf(f, sizeof f, "wall.motion_frequency=%s", frequencies[i]);
        for (int phase = 0; phase < 4; phase++) {
            const double t = 2 + phase * period / 4;
            double q[2], force;
            for (int side = 0; side < 2; side++) {
                q[side] = angle_at(
                    SETTINGS(PRESSED_LINK, "wall.contact=kelvin-voigt", "wall.stiffness=2000",
                             "wall.damping=20", f,
                             side ? "wall.motion_amplitude=-1e-5" : "wall.motion_amplitude=1e-5"),
                    t, &force);
            }
            const double expected = re * sin(w * t) + im * cos(w * t);
            check_close((q[0] - q[1]) / 2, expected, 2e-4 * hypot(re, im));
        }
    }
}

// On a rigid one the tip goes where the wall does, and the force makes it so.
static void a_rigid_wall_leads_the_tip(void **state)
{
    (void)state;
    const parameters p = fixture_parameters(SETTINGS(PRESSED_LINK));
    arm a;
    arm_init(&a, &p);
    const double length = a.link_length, u0 = 1e-3, w = 2 * M_PI * 2;
    const double inertia = a.hub_inertia + a.link_mass * length * length / 3;
    for (int i = 1; i < 8; i++) {
        // from its end on, where it comes to the arm at no speed
        const double t = 0.11 * i, s = u0 * sin(w * (t + 0.125)), v = u0 * w * cos(w * (t + 0.125));
        const double accelerates = -w * w * s;
        double force;
        char start[64];
        snprintf(start, sizeof start, "initial.angle=%.17g", -asin(u0 / length));
        const double q = angle_at(
            SETTINGS(PRESSED_LINK, "wall.motion_frequency=2", "wall.motion_time=-0.125", start), t,
            &force);
        check_close(q, -asin(s / length), 1e-9);

        // q' = -v/(L cos q), q" = -(a + L sin q q'^2 ... )/(L cos q), of s = -L sin q
        const double rate = -v / (length * cos(q));
        const double turn = -(accelerates - length * sin(q) * rate * rate) / (length * cos(q));
        const double weight = a.gravity * a.link_mass * length / 2 * cos(q);
        check_relative(force, (-weight - inertia * turn) / (length * cos(q)), 1e-6);
    }
}

// An arm at rest that a wall strikes gets the impulse with which it would strike the wall.
static void only_the_relative_velocity_counts_at_an_impact(void **state)
{
    (void)state;
    static const char *const kinds[] = {"wall.kind=plane", "wall.kind=point"};
    for (size_t i = 0; i < 2; i++) {
        const parameters p = fixture_parameters(
            SETTINGS("arm.links=3", "arm.hub_joint=spring", "wall.angle=0.2", kinds[i]));
        arm still, comes;
        arm_init(&still, &p);
        comes = still;
        comes.wall.motion.kind = MOTION_SINE;
        comes.wall.shift.velocity = 0.7;
        const double q[] = {0.19, 0.21, 0.2, 0.18}, rest[4] = {0};
        double w[4], reach, by_arm[4], by_wall[4], same;
        chain_link work[3];
        chain_contact_response(&still, work, q, false, w, &reach);
        chain_penetration(&comes, q, rest, NULL, &same);
        for (int k = 0; k < 4; k++) {
            w[k] *= -same / reach;
        }
        const impact_result one = impact_velocity_increments(&still, work, q, w, 0, 0.4, by_arm);
        const impact_result two =
            impact_velocity_increments(&comes, work, q, rest, 0, 0.4, by_wall);
        check_relative(one.speed, two.speed, 1e-13);
        check_relative(one.impulse, two.impulse, 1e-13);
        for (int k = 1; k < 4; k++) {
            check_close(by_arm[k], by_wall[k], 1e-12);
        }

        // the arm gains what the wall does less the loss
        check_relative(chain_kinetic_energy(&comes, q, by_wall), two.work - two.loss, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_driven_spring_has_its_amplitude_and_phase),
        cmocka_unit_test(a_rigid_wall_leads_the_tip),
        cmocka_unit_test(only_the_relative_velocity_counts_at_an_impact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
