// Arms of many links at the default step. The implicit methods resolve few of their modes
// there: the run stays stable and ends pressing on the wall with the force a static beam
// would give, and its ledger shows what it lost. The event method is exact for any number
// of links.

#include "tests/arm_fixture.h"

static void check_case(int links, const char *hub, const char *wall, double volts)
{
    scenario s = {.parameters =
                      parameters_with("method.name=generalized-alpha arm.links=%d %s %s "
                                      "motor.voltage=%.17g run.duration=1",
                                      links, hub, wall, volts)};
    KEPT_RUN(r);
    fail_if(run_scenario(&s, false, &r) != STATUS_OK, "%d links, %s, %s, %g V: %s", links,
            hub, wall, volts, r.summary.message);
    // motor torque within the friction's band, over the length of 1 m
    double torque = motor_torque_per_volt(&s.parameters.motor) * volts;
    check_close(r.summary.steady_force_N, torque, 0.045 + 0.05 * torque);
    // the touch comes when the beam as a whole gets there, for any number of links
    check_close(r.summary.first_contact_s, volts > 2 ? 0.1509 : 0.3004, 3e-3);
    // events are located to a millionth of a step, in which the tip goes some nanometres
    check_below(r.summary.max_penetration_m, 1e-7);
    // a method's own damping may take energy, nothing may make any
    assert_true(r.summary.energy_residual_J < 0.35 * r.summary.motor_work_J);
}

TEST(runs_stay_stable)
{
    static const int links[] = {50, 64, 128, 300, 1024};
    static const char *const hubs[] = {"arm.hub_joint=rigid", "arm.hub_joint=spring"};
    static const char *const walls[] = {"wall.kind=point", "wall.kind=plane"};
    for (int i = 0; i < 5 * 8; i++) {
        // of the longest chains two opposite corners
        const int corner = i % 8;
        if (links[i / 8] < 300 || corner == 1 || corner == 6) {
            check_case(links[i / 8], hubs[i & 1], walls[i >> 1 & 1], i & 4 ? 5 : 1);
        }
    }
}

// Hub joints, walls, damping and restitution: located events, a ledger that closes.
TEST(the_event_method_stays_exact)
{
    static const char *const cases[][5] = {
        {"arm.links=50", "arm.hub_joint=rigid", "wall.kind=plane", "arm.damping_ratio=0",
         "wall.restitution=0"},
        {"arm.links=50", "arm.hub_joint=beam", "wall.kind=point", "arm.damping_ratio=0",
         "wall.restitution=0"},
        {"arm.links=32", "arm.hub_joint=beam", "wall.kind=plane",
         "arm.damping_ratio=0.01", "wall.restitution=0"},
        {"arm.links=32", "arm.hub_joint=rigid", "wall.kind=point",
         "arm.damping_ratio=0.01", "wall.restitution=0"},
        {"arm.links=64", "arm.hub_joint=rigid", "wall.kind=plane",
         "arm.damping_ratio=0.01", "wall.restitution=0"},
    };
    for (EACH(one, cases)) {
        const char *const *c = *one;
        scenario s = {.parameters = parameters_with("%s %s %s %s %s run.duration=0.32",
                                                    c[0], c[1], c[2], c[3], c[4])};
        KEPT_RUN(r);
        fail_if(run_scenario(&s, false, &r) != STATUS_OK, "%s, %s, %s, %s: %s", c[0],
                c[1], c[2], c[3], r.summary.message);
        assert_string_equal(summary_status(&r.summary), "ok");
        check_below(r.summary.energy_residual_J, 1e-6 * r.summary.motor_work_J);
        check_below(r.summary.max_penetration_m, 1e-10);
        check_close(r.summary.first_contact_s, 0.302, 3e-3);
    }
}

// What a chain with 1 % damping gives the wall in the first 50 ms of contact, impulses
// and forces.
static double momentum_of_50_ms(int links)
{
    scenario s = {
        .parameters =
            parameters_with("arm.links=%d arm.hub_joint=beam arm.damping_ratio=0.01 "
                            "wall.kind=plane motor.voltage=1 initial.angle=0.095 "
                            "initial.velocity=0.7 run.duration=0.0571",
                            links)};

    // the run is shorter than the window of the steady force, which is then the mean of
    // all of it
    KEPT_RUN(r) = run_done(&s, false);
    assert_string_equal(summary_status(&r.summary), "ok");
    check_close(r.summary.impacts, 1, 0);
    double momentum = r.summary.contact_impulse_Ns +
                      r.summary.steady_force_N * s.parameters.run.duration;
    return momentum;
}

// The links become a beam with the square of their length.
TEST(momentum_converges_to_a_beams)
{
    double momentum[4], last = 0;
    for (int i = 0; i < 4; i++) {
        momentum[i] = momentum_of_50_ms(16 << i);
    }
    for (int i = 2; i < 4; i++) {
        last = momentum[i] - momentum[i - 1];
        check_close(log2((momentum[i - 1] - momentum[i - 2]) / last), 2, 0.1);
    }
    double beam = momentum[3] + last / 3;
    check_relative(momentum[2], beam, 1e-3);
    check_relative(momentum[3], beam, 1e-3);
}

// Three links whipped about at 10^3 rad/s by a motor without friction: strides follow the
// fastest link, whichever it is, so that answers do not depend on the time step.
TEST(strides_follow_the_fastest_link)
{
    static const char *const steps[] = {"method.step=1e-3", "method.step=2e-4",
                                        "method.step=5e-5"};
    summary first = {0};
    for (int i = 0; i < 3; i++) {
        scenario s = {
            .parameters = parameters_with(
                "arm.links=3 arm.hub_joint=beam wall.kind=plane wall.angle=0.1 "
                "motor.voltage=1 motor.viscous_friction=0 motor.amplifier_gain=1000 "
                "run.duration=1 %s",
                steps[i])};
        KEPT_RUN(r) = run_done(&s, false);
        assert_string_equal(summary_status(&r.summary), "ok");
        first = i == 0 ? r.summary : first;
        check_relative(r.summary.motor_work_J, first.motor_work_J, 1e-5);
        check_relative(r.summary.peak_force_N, first.peak_force_N, 1e-6);
        check_close(r.summary.impacts, first.impacts, 0);
    }
}
