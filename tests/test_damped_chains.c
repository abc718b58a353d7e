// Chains of many links whose fast modes decay: long strides however far the arm bends, and bounces
// that do not depend on what is asked besides.
#include <math.h>
#include <stdlib.h>

#include "src/solve/contact_machine.h"
#include "tests/arm_fixture.h"

// What became of a motion.
typedef struct passage {
    int steps, impacts;
    double open; // share of the energy put in that the ledger lacks
} passage;

static passage passage_of(const parameters *p, double until, int most_steps)
{
    arm a;
    arm_init(&a, p);
    motion *m = motion_create(&a, &p->method);
    assert_non_null(m);
    motion_start(&a, m, 0, 0);
    passage all = {0};
    while (m->state[SLOT_TIME] < until) {
        motion_report r;
        assert_int_equal(motion_step(&a, m, until, 1e-3, &r), STATUS_OK);
        assert_true(++all.steps <= most_steps);
        motion_apply(&a, m, &r);
        all.impacts += r.event == MOTION_IMPACT;
        const double open = fabs(motion_energy_residual(&a, m, m->state));
        all.open = fmax(all.open, open / (fabs(m->state[SLOT_MOTOR_WORK]) + 1e-9));
    }
    motion_destroy(m);
    return all;
}

// 256 links from rest into a wall, against which they bend: the last link's line meets a point by a
// fifth of a link beyond its end.
static void a_chain_that_bends_keeps_its_strides(void **state)
{
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        const parameters p = fixture_parameters(
            SETTINGS("arm.links=256", "arm.damping_ratio=0.01", "motor.voltage=1",
                     kind == 0 ? "wall.kind=point" : "wall.kind=plane"));
        const passage all = passage_of(&p, 0.36, 200);
        assert_int_equal(all.impacts, 1);
        check_below(all.open, 1e-7);
    }
}

// Impacts of an arm in front of its wall, and the largest force of what follows them.
typedef struct bounces {
    int impacts;
    double slowest; // of them [m/s]
    double peak;    // [N]
    double peak_time;
} bounces;

static bounces bounces_of(const parameters *p, const engine *by, double gap, double velocity,
                          double until)
{
    arm a;
    arm_init(&a, p);
    motion *m = motion_create_by(&a, &p->method, by);
    assert_non_null(m);
    motion_start(&a, m, p->wall.angle - gap, velocity);
    bounces all = {0};
    while (m->state[SLOT_TIME] < until) {
        motion_report r;
        assert_int_equal(motion_step(&a, m, until, 1e-3, &r), STATUS_OK);
        motion_apply(&a, m, &r);
        if (r.event == MOTION_IMPACT) {
            all.impacts++;
            all.slowest = r.speed;
        }
    }
    all.peak = m->pulse_peak;
    all.peak_time = m->pulse_peak_time;
    motion_destroy(m);
    return all;
}

// Strongly damped chains bounce ever lower, to flights of 1e-9 s and 1e-13 m, and what is left of
// their speed makes the peak force. By the modes that is as by series, however long the run is.
static void low_bounces_are_those_of_the_series(void **state)
{
    (void)state;
    const parameters p = fixture_parameters(
        SETTINGS("arm.links=18", "arm.damping_ratio=0.9149", "arm.k2=50.78", "arm.mass=1.48",
                 "arm.hub_inertia=0.02198", "motor.voltage=2.55", "motor.stiction=0",
                 "wall.kind=plane", "wall.angle=0.1", "wall.restitution=0.2228783812"));
    const bounces series = bounces_of(&p, &series_engine, 1e-4, 0.65, 1.6e-4);
    assert_int_equal(series.impacts, 7);
    for (int i = 1; i <= 4; i++) {
        const bounces modes = bounces_of(&p, &modal_engine, 1e-4, 0.65, 1.6e-4 * i * i);
        assert_int_equal(modes.impacts, series.impacts);
        check_relative(modes.slowest, series.slowest, 1e-6);
        check_relative(modes.peak, series.peak, 1e-6);
        check_close(modes.peak_time, series.peak_time, 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_chain_that_bends_keeps_its_strides),
                                       cmocka_unit_test(low_bounces_are_those_of_the_series)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
