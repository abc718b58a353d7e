// Statistics of a signal: of straight pieces they are known, cut anywhere.
#include "tests/check.h"

#include <math.h>

#include "src/run/statistics.h"

static void add(trace *t, double time, double force)
{
    const double none[1] = {0};
    sample row = {.time = time, .force = force};
    assert_int_equal(trace_add_row(t, &row, none, none), STATUS_OK);
}

static void a_ramp_and_a_step(void **state)
{
    (void)state;
    const int force = SIGNAL_INDEX(force);
    trace t;
    trace_init(&t, 1);

    // from 0 to 2 in a second, a jump to 5, that for another second
    add(&t, 0, 0);
    add(&t, 1, 2);
    add(&t, 1, 5);
    add(&t, 2, 5);
    signal_statistics s = trace_statistics(&t, force, 0, 2);
    check_close(s.minimum, 0, 0);
    check_close(s.maximum, 5, 0);
    check_close(s.integral, 1 + 5, 1e-15);
    check_close(s.mean, 3, 1e-15);
    check_close(s.rms, sqrt((4.0 / 3 + 25) / 2), 1e-15);

    // between rows
    s = trace_statistics(&t, force, 0.25, 0.75);
    check_close(s.minimum, 0.5, 1e-15);
    check_close(s.maximum, 1.5, 1e-15);
    check_close(s.integral, 0.5, 1e-15);
    check_close(s.rms, sqrt((1.5 * 1.5 * 1.5 - 0.5 * 0.5 * 0.5) / 3 / 2 / 0.5), 1e-15);

    // a jump at the end, both of its sides within
    s = trace_statistics(&t, force, 0, 1);
    check_close(s.maximum, 5, 0);
    check_close(s.integral, 1, 1e-15);

    // of an instant, beyond the run, and of what has no value
    s = trace_statistics(&t, force, 1.5, 1.5);
    check_close(s.mean, 5, 0);
    check_close(s.integral, 0, 0);
    s = trace_statistics(&t, force, -3, 9);
    check_close(s.duration, 2, 1e-15);
    for (size_t r = 0; r < t.row_count; r++) {
        t.rows[r].command = (double)NAN;
    }
    s = trace_statistics(&t, SIGNAL_INDEX(command), 0, 2);
    assert_true(isnan(s.mean) && isnan(s.maximum) && s.duration == 0);
    trace_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_ramp_and_a_step)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
