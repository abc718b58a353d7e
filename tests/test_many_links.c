// Arms of many links at the default step, which resolves few of their modes: the run stays stable
// and ends pressing on the wall with the force a static beam would give.
#include <math.h>

#include "src/run/run.h"
#include "tests/arm_fixture.h"

static void check_case(int links, const char *hub, const char *wall, double volts)
{
    char n[32], v[48];
    snprintf(n, sizeof n, "arm.links=%d", links);
    snprintf(v, sizeof v, "motor.voltage=%.17g", volts);
    scenario s = {.parameters = fixture_parameters(SETTINGS(n, hub, wall, v, "run.duration=1"))};
    run_result r;
    if (run_scenario(&s, false, &r) != STATUS_OK) {
        fail_msg("%d links, %s, %s, %g V: %s", links, hub, wall, volts, r.summary.message);
    }
    // motor torque within the friction's band, over the length of 1 m
    double torque = motor_torque_per_volt(&s.parameters.motor) * volts;
    check_close(r.summary.steady_force_N, torque, 0.045 + 0.05 * torque);
    // the touch comes when the beam as a whole gets there, whatever the number of links
    check_close(r.summary.first_contact_s, volts > 2 ? 0.1509 : 0.3004, 3e-3);
    // events are located to a millionth of a step, in which the tip goes some nanometres
    check_below(r.summary.max_penetration_m, 1e-7);
    // a method's own damping may take energy, nothing may make any
    assert_true(r.summary.energy_residual_J < 0.35 * r.summary.motor_work_J);
    run_finish(&r);
}

static void runs_stay_stable(void **state)
{
    (void)state;
    static const int links[] = {50, 64, 128, 300, 1024};
    static const char *const hubs[] = {"arm.hub_joint=rigid", "arm.hub_joint=spring"};
    static const char *const walls[] = {"wall.kind=point", "wall.kind=plane"};
    for (int i = 0; i < 5 * 8; i++) {
        check_case(links[i / 8], hubs[i & 1], walls[i >> 1 & 1], i & 4 ? 5 : 1);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(runs_stay_stable)};
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
