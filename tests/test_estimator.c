// The Kalman filter that controllers use.
#include "src/rig/estimator.h"
#include "tests/rig_fixture.h"

static void estimator_finds_a_constant(void **state)
{
    (void)state;
    estimator e = {.z = {0}, .p = {{4}}};
    const double row[4] = {2};
    for (int i = 0; i < 100; i++) {
        estimator_correct(&e, 1, row, 1, 7 + (i % 2 ? 0.1 : -0.1), 0.01);
    }
    check_close(e.z[0], 3, 1e-3);
    // variance of the mean of 100 readings of 2 z
    check_relative(e.p[0][0], 0.01 / 4 / 100, 1e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(estimator_finds_a_constant),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
