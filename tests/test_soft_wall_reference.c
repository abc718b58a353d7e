// Arms that meet walls that give, from rest on: the library, and an integrator that
// shares no code with it.
#include "tests/arm_fixture.h"
#include "tests/chain_outcome.h"
#include "tests/reference/implicit_arm.h"

#define DURATION 0.6

static const struct wall_case {
    const char *name, *settings[8];
} cases[] = {
    {"Kelvin-Voigt, point, N = 2, 1 V",
     {"motor.voltage=1", "wall.stiffness=75e3", "wall.damping=20"}},
    {"Kelvin-Voigt, plane, N = 2, 5 V",
     {"wall.kind=plane", "motor.voltage=5", "wall.stiffness=1e4", "wall.damping=5"}},
    {"Kelvin-Voigt, plane, N = 4, beam, sensor",
     {"arm.links=4", "arm.hub_joint=beam", "arm.tip_mass=0.02", "wall.kind=plane",
      "motor.voltage=2", "wall.stiffness=2e4", "wall.damping=10"}},
    {"Kelvin-Voigt, overdamped, N = 2",
     {"motor.voltage=2", "wall.stiffness=1e3", "wall.damping=60"}},
    {"Kelvin-Voigt, slow to return, N = 4, beam",
     {"arm.links=4", "arm.hub_joint=beam", "wall.kind=plane", "motor.voltage=4",
      "wall.stiffness=2e3", "wall.damping=100"}},
    {"Hunt-Crossley, point, N = 2, 1 V",
     {"wall.contact=hunt-crossley", "motor.voltage=1", "wall.stiffness=1e6",
      "wall.damping=3e5"}},
    {"Hunt-Crossley, plane, N = 3, beam",
     {"wall.contact=hunt-crossley", "arm.links=3", "arm.hub_joint=beam",
      "wall.kind=plane", "motor.voltage=3", "wall.stiffness=1e6", "wall.damping=3e5"}},
    {"Hunt-Crossley, n = 1.3, N = 2, sensor",
     {"wall.contact=hunt-crossley", "arm.tip_mass=0.05", "wall.kind=plane",
      "motor.voltage=2", "wall.stiffness=2e5", "wall.damping=6e4", "wall.exponent=1.3"}},
    {"Hunt-Crossley, slow to return, N = 4, beam",
     {"wall.contact=hunt-crossley", "arm.links=4", "arm.hub_joint=beam",
      "wall.kind=plane", "motor.voltage=8", "wall.stiffness=1e4", "wall.damping=1e5"}},
    {"Hunt-Crossley, met at rest, N = 4, beam",
     {"wall.contact=hunt-crossley", "arm.links=4", "arm.hub_joint=beam",
      "wall.kind=plane", "motor.voltage=8", "wall.stiffness=1e5", "wall.damping=1e6"}},
    {"face of 0.2 kg, point, N = 2, 1 V",
     {"wall.mass=0.2", "motor.voltage=1", "wall.stiffness=75e3", "wall.damping=20"}},
    {"face of 50 g, plane, N = 2, 5 V",
     {"wall.mass=0.05", "wall.kind=plane", "motor.voltage=5", "wall.stiffness=1e4",
      "wall.damping=0"}},
    {"face of 1 g, point, N = 2, overdamped",
     {"wall.mass=1e-3", "motor.voltage=2", "wall.stiffness=1e3", "wall.damping=60"}},
    {"face of 20 g, plane, N = 4, beam, sensor",
     {"wall.mass=0.02", "arm.links=4", "arm.hub_joint=beam", "arm.tip_mass=0.02",
      "wall.kind=plane", "motor.voltage=2", "wall.stiffness=2e4", "wall.damping=10"}},
};

TEST(an_independent_integrator_finds_the_same)
{
    for (EACH(c, cases)) {
        const char *settings[12] = {"motor.stiction=0", "wall.contact=kelvin-voigt"};
        for (int i = 0; i < 8; i++) {
            settings[2 + i] = c->settings[i];
        }
        const parameters p = fixture_parameters(settings);
        const chain_start start = {&p, 0, 0, DURATION, DURATION, NULL, OUTCOME_CONTACTS};
        const chain_outcome l = chain_outcome_of(&start),
                            r = implicit_outcome_of(&start, 1e-10);
        const double peak = l.peak / r.peak - 1;
        print_message(
            "%s: %d contacts to %.6f s, peak %.9g N, off by %.1e, %.1e s later\n",
            c->name, r.contacts, r.ended, r.peak, peak, l.peak_time - r.peak_time);
        assert_true(l.status == STATUS_OK && r.status == STATUS_OK);

        // contacts, forces, momentum, losses
        assert_int_equal(l.contacts, r.contacts);
        for (int i = 0; i < r.contacts && i < OUTCOME_CONTACTS; i++) {
            check_close(l.contact_times[i], r.contact_times[i], 1e-9);
        }
        assert_int_equal(l.samples, r.samples);
        for (int i = 1; i < r.samples; i++) {
            check_relative(l.momentum[i], r.momentum[i], 1e-7);
        }
        check_close(peak, 0, 1e-6);
        check_close(l.peak_time, r.peak_time, 1e-5);
        check_close(l.first_impulse, r.first_impulse, 1e-9 * fabs(r.first_impulse));
        check_relative(l.motor_work, r.motor_work, 1e-8);
        for (int i = 0; i < 6; i++) {
            check_close(l.lost[i], r.lost[i], 1e-8 * r.put_in);
        }
        check_below(l.residual, 1e-9);
    }
}
