// Arms that fold over the hub's axis, where the model ends, and a pair that its motor
// brakes.

#include "tests/arm_fixture.h"

static run_result run_with(const char *const *settings)
{
    const scenario s = {.name = (char *)"test",
                        .parameters = fixture_parameters(settings)};
    run_result r;
    run_scenario(&s, true, &r);
    return r;
}

// Soft springs let the arm fold over the hub's axis, with its tip sliding on the flat
// wall. On the way there the wall's reaction grows as 1/lever, and where the lever is
// nothing the run ends: with the ledger closed, the links opposite to each other and the
// tip at the axis.
TEST(test_an_arm_folded_over_the_hub_ends_the_run)
{
    const char *const *const arms[] = {
        given("wall.kind=plane motor.voltage=8.238 motor.resistance=3.68 "
              "wall.angle=-0.541 arm.k2=0.09 initial.angle=-1.977"),
        given("wall.kind=plane motor.voltage=-3.753 motor.back_emf=0 arm.mass=0.539 "
              "arm.k2=0.0817"),
        given("wall.kind=plane motor.voltage=-8.97 motor.back_emf=0 arm.k2=0.1 "
              "wall.angle=0.94 initial.angle=0.71 arm.hub_joint=spring arm.k1=500"),
        // what could go through the fold in one stride, the velocities being smooth there
        given("wall.kind=plane wall.angle=0.0018 wall.restitution=0.08 "
              "motor.voltage=8.2 arm.mass=1.5 arm.length=0.3 "
              "arm.hub_inertia=0.00036 arm.k2=0.27"),
    };
    for (EACH(c, arms)) {
        KEPT_RUN(r) = run_with(*c);
        const trace *t = &r.trace;
        assert_int_equal(r.summary.status, STATUS_FOLDED);
        assert_true(r.summary.message[0] != '\0');
        assert_true(r.summary.energy_residual_J < 1e-9);

        // the last rows: ever more force on ever less lever
        assert_true(t->row_count > 10);
        const sample *last = LAST_ROW(t);
        const double bend =
            fabs(remainder(last->last_angle - last->first_angle, 2 * M_PI));
        assert_true(bend > 2);
        assert_true(isfinite(r.summary.peak_force_N) && r.summary.peak_force_N < 1e6);
    }
}

// On its way to a fold and back the force has a pole nearby, of which the velocities know
// nothing: it is what the stiff engine makes of it, which a tip mass of next to nothing
// takes.
TEST(test_the_force_near_a_fold_is_that_of_another_engine)
{
    static const char *const further[] = {"", "arm.tip_mass=1e-15 method.step=1e-4"};
    double peak[2];
    for (int i = 0; i < 2; i++) {
        KEPT_RUN(r) = run_with(
            given("wall.kind=plane arm.mass=0.659275 arm.length=0.888161 "
                  "arm.k2=0.075065 arm.hub_inertia=0.000270442 wall.angle=0.190554 "
                  "motor.voltage=4.96717 run.duration=0.4 motor.back_emf=1 %s",
                  further[i]));
        assert_int_equal(r.summary.status, STATUS_OK);
        peak[i] = r.summary.peak_force_N;
    }
    check_relative(peak[0], peak[1], 1e-4);
}

// Neither do the strides of chains lead through a fold, nor to a release in it.
TEST(test_no_step_leads_through_a_fold)
{
    for (EACH_TEXT(c, "motor.voltage=8.6", "motor.voltage=8.8", "motor.voltage=9.8")) {
        KEPT_RUN(r) = run_with(
            SETTINGS("wall.kind=plane", "wall.angle=0.0018", "wall.restitution=0.08",
                     "arm.mass=1.5", "arm.length=0.3", "arm.hub_inertia=0.00036",
                     "arm.k2=0.27", "arm.tip_mass=1e-15", "run.duration=0.3", *c));
        assert_int_equal(r.summary.status, STATUS_FOLDED);
    }
}

// A light hub that its motor brakes with 5e5 1/s, in fast rotation: a decay that strides
// are only as brief as is no reason to leave the series of two links.
TEST(test_a_braked_pair_stays_with_its_series)
{
    KEPT_RUN(r) = run_with(
        given("wall.kind=point arm.hub_joint=beam motor.voltage=-7.4496752248724825 "
              "motor.torque_constant=10.322410847758455 "
              "motor.back_emf=17.837703213025179 motor.resistance=3.5671540043350509 "
              "motor.viscous_friction=0.17745084082087847 "
              "motor.stiction=0.36796164717472457 wall.angle=-0.91273846733037911 "
              "wall.restitution=1 arm.mass=0.17792530335853379 "
              "arm.hub_inertia=0.00011178115888277645 arm.k2=2.0395296601095732 "
              "initial.angle=-1.6935095618531402 initial.velocity=-1.6808487213046144"));
    KEPT_RUN(usual) = run_with(given("motor.voltage=1"));
    assert_int_equal(r.summary.status, STATUS_OK);
    assert_true(r.summary.energy_residual_J < 1e-9);
    assert_string_equal(r.summary.method, usual.summary.method);
}
