// An arm that coasts to rest without Coulomb friction: its velocities fall to the smallest numbers
// there are, on which processors compute slowly. A run must not be caught there.
#include <time.h>

#include "src/solve/contact_machine.h"
#include "tests/arm_fixture.h"

static double computing_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

// The least computing time of ten stretches of 4 s, which go on from each other [s].
static double best_stretch(const arm *a, motion *m)
{
    double best = (double)INFINITY;
    for (int i = 0; i < 10; i++) {
        double until = m->state[SLOT_TIME] + 4, start = computing_time();
        motion_report report;
        assert_int_equal(motion_advance(a, m, until, 1e-3, &report), STATUS_OK);
        assert_int_equal(report.event, MOTION_REACHED);
        best = fmin(best, computing_time() - start);
    }
    return best;
}

static void check_decay(const char *links, const char *method, double rest)
{
    parameters p = fixture_parameters(SETTINGS(links, method, "wall.kind=none", "motor.voltage=0",
                                               "motor.stiction=0", "arm.damping_ratio=0.3"));
    motion_report report;
    arm a;
    arm_init(&a, &p);
    motion *m = motion_create(&a, &p.method);
    motion_start(&a, m, 0, 1);
    double lively = best_stretch(&a, m);
    assert_true(fabs(state_velocities(m, m->state)[0]) > 1e-30);
    // half way the squares of the velocities are denormal, in the end the velocities themselves
    assert_int_equal(motion_advance(&a, m, 440, 1e-3, &report), STATUS_OK);
    double squares = best_stretch(&a, m);
    assert_int_equal(motion_advance(&a, m, 640, 1e-3, &report), STATUS_OK);
    double resting = best_stretch(&a, m);
    assert_true(fabs(state_velocities(m, m->state)[0]) < rest);
    print_message("%s %s: %.2f and %.2f times as slow as in full motion\n", links, method,
                  squares / lively, resting / lively);
    check_below(squares, 4 * lively);
    check_below(resting, 4 * lively);
    motion_destroy(m);
}

static void coming_to_rest_does_not_slow_the_event_method(void **state)
{
    (void)state;
    check_decay("arm.links=1", "method.name=event", 1e-300);
    check_decay("arm.links=2", "method.name=event", 1e-300);
}

static void coming_to_rest_does_not_slow_the_implicit_methods(void **state)
{
    (void)state;
    check_decay("arm.links=2", "method.name=newmark", 1e-9);
    check_decay("arm.links=2", "method.name=generalized-alpha", 1e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coming_to_rest_does_not_slow_the_event_method),
        cmocka_unit_test(coming_to_rest_does_not_slow_the_implicit_methods),
    };
    return cmocka_run_group_tests(tests, NULL, NULL) != 0;
}
