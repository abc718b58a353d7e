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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_chain_that_bends_keeps_its_strides)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
