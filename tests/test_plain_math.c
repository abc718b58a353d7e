// The functions of the project against the C library's in extended precision.
#include "src/base/plain_math.h"

#include <float.h>

#include "tests/check.h"

enum { TRIALS = 20000 };

// How far a result is from the exact one, in units in its last place.
static double units_off(double found, long double exact)
{
    const double unit = nextafter(fabs((double)exact), HUGE_VAL) - fabs((double)exact);
    return (double)(fabsl((long double)found - exact) / (long double)unit);
}

TEST(exponentials_are_right_to_two_units)
{
    random_generator g = seeded(1);
    for (int i = 0; i < TRIALS; i++) {
        const double size = i % 2 == 0 ? 1 : 700, x = size * (2 * random_uniform(&g) - 1);
        assert_true(units_off(plain_exp(x), expl((long double)x)) < 2);
    }
    check_close(plain_exp(0), 1, 0);
    assert_true(isinf(plain_exp(710)) && isinf(plain_exp((double)INFINITY)));
    check_close(plain_exp(-800), 0, 0);
    assert_true(isnan(plain_exp((double)NAN)));

    // where the result is hardly normal any more, or hardly finite
    assert_true(units_off(plain_exp(709.5), expl(709.5L)) < 2);
    assert_true(units_off(plain_exp(-708), expl(-708.0L)) < 2);
    check_close(plain_exp(-740), exp(-740), 2 * DBL_TRUE_MIN);
}

TEST(logarithms_are_right_to_two_units)
{
    random_generator g = seeded(2);
    for (int i = 0; i < TRIALS; i++) {
        const double u = random_uniform(&g);
        const double x = i % 2 == 0 ? 0.5 + u : ldexp(u + DBL_MIN, i % 2000 - 1000);
        if (x > DBL_MIN && x != 1) {
            assert_true(units_off(plain_log(x), logl((long double)x)) < 2);
        }
    }
    check_close(plain_log(1), 0, 0);
    assert_true(units_off(plain_log(DBL_TRUE_MIN), logl((long double)DBL_TRUE_MIN)) < 2);
    assert_true(units_off(plain_log(DBL_MIN / 3), logl((long double)(DBL_MIN / 3))) < 2);
    assert_true(units_off(plain_log(DBL_MAX), logl((long double)DBL_MAX)) < 2);
    assert_true(isinf(plain_log(0)) && plain_log(0) < 0);
    assert_true(plain_log(HUGE_VAL) == HUGE_VAL && isnan(plain_log((double)NAN)));
}

TEST(powers_are_those_of_the_library)
{
    random_generator g = seeded(3);
    for (int i = 0; i < TRIALS; i++) {
        const double x = 1e-6 + random_uniform(&g) * (i % 2 == 0 ? 1 : 1e4);
        const double y = 6 * random_uniform(&g) - 3, exact = pow(x, y);
        check_close(plain_pow(x, y), exact, 1e-14 * exact);
    }
    check_close(plain_pow(0, 0), 1, 0);
    check_close(plain_pow(0, 2), 0, 0);
}

TEST(arctangents_are_right_to_two_units)
{
    random_generator g = seeded(5);
    for (int i = 0; i < TRIALS; i++) {
        const double size = i % 2 == 0 ? 1 : ldexp(1, i % 400 - 200);
        const double x = 2 * random_uniform(&g) - 1,
                     y = size * (2 * random_uniform(&g) - 1);
        assert_true(units_off(plain_atan2(y, x), atan2l((long double)y, (long double)x)) <
                    2);
    }

    // the diagonal, where both ways to it meet: an eighth of a turn to the last bit
    for (int power = -300; power <= 300; power += 60) {
        const double x = ldexp(1.1, power);
        check_close(plain_atan2(x, x), atan2(1, 1), 0);
    }

    // both axes, both signs, and the origin
    for (int quarter = -1; quarter <= 2; quarter++) {
        const double x = quarter == 0 ? 3 : quarter == 2 ? -3 : 0, y = quarter % 2 * 5;
        check_close(plain_atan2(y, x), quarter * acos(0), 0);
    }
    check_close(plain_atan2(-0.0, -1), -acos(-1), 0);
    check_close(plain_atan2(0, 0), 0, 0);
}
