// The Kalman filter and the optimal gain that controllers use.
#include "src/rig/estimator.h"
#include "tests/rig_fixture.h"

static void gain_makes_the_cost_least(void **state)
{
    (void)state;
    // the arm in contact at 200 Hz; the cost of 400 samples from one start, gains moved either way
    double rate[ESTIMATOR_STATES][ESTIMATOR_STATES] = {{0, 1}, {-510, -4.7}},
           input[ESTIMATOR_STATES] = {0, 11.3}, gain[2];
    const double output[2] = {28.2, 0.08}, direct = -0.19, effort = 2e-3;
    sampled_model m;
    sampled_model_init(&m, 2, rate, input, 0.005);
    assert_true(optimal_gain(&m, output, direct, effort, 1, gain));
    double costs[5];
    for (int trial = 0; trial < 5; trial++) {
        double k[2] = {gain[0], gain[1]}, z[2] = {0.02, 0.5};
        k[(trial - 1) / 2] *= trial == 0 ? 1 : trial % 2 ? 1.01 : 0.99;
        costs[trial] = 0;
        for (int i = 0; i < 400; i++) {
            double u = -k[0] * z[0] - k[1] * z[1];
            double f = output[0] * z[0] + output[1] * z[1] + direct * u;
            double next = m.a[0][0] * z[0] + m.a[0][1] * z[1] + m.b[0] * u;
            z[1] = m.a[1][0] * z[0] + m.a[1][1] * z[1] + m.b[1] * u;
            z[0] = next;
            costs[trial] += f * f + effort * u * u;
        }
    }
    for (int trial = 1; trial < 5; trial++) {
        check_below(costs[0], costs[trial]);
    }
}

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
        cmocka_unit_test(gain_makes_the_cost_least),
        cmocka_unit_test(estimator_finds_a_constant),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
