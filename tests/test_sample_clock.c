// The clock of a recording, against stamps whose rate, origin and errors are known.
#include "src/base/sample_clock.h"

#include "tests/check.h"

enum { ROWS = 700 };

// Stamps of samples at a rate [1/s] from an instant on, each off by up to `error` [s] and
// rounded to multiples of `digit` [s] (0: not); of samples that `missing` divides there
// is none (0: of all there is one).
static size_t make_stamps(double *stamps, double rate, double begin, double error,
                          double digit, int missing)
{
    random_generator random;
    size_t count = 0;
    random_seed(&random, 7);
    for (int n = 0; n < ROWS; n++) {
        double stamp = begin + n / rate + error * (2 * random_uniform(&random) - 1);
        if (digit > 0) {
            stamp = digit * floor(stamp / digit + 0.5);
        }
        if (n == 0 || missing == 0 || n % missing != 0) {
            stamps[count++] = stamp;
        }
    }
    return count;
}

// The least squares' period has the standard deviation s/sqrt(sum (n - mean)^2) with s^2
// = error^2/3 of even scatter: here it is at most five of them off. Errors of rounding
// follow each other; of up to digit/2 each the period is at most 1.5 digit/ROWS off, the
// origin 2 digit.
TEST(rate_and_origin_come_out_of_stamps_with_errors)
{
    static const struct {
        double rate, begin, error, digit;
        int missing;
    } cases[] = {
        {500, 0, 0, 0, 0},
        {500, 0, 5e-6, 0, 0},
        {500.01, 0, 0, 1e-6, 0},
        {333, 0, 0, 1e-3, 0},
        {1000, 1764420000.25, 1e-5, 0, 0},
        {200, -3, 1e-3, 0, 0},
        {250, 40, 4e-4, 1e-4, 5},
        {12000, 3, 8e-6, 1e-6, 0},
    };
    for (EACH(c, cases)) {
        double stamps[ROWS];
        sample_clock clock;
        const size_t rows =
            make_stamps(stamps, c->rate, c->begin, c->error, c->digit, c->missing);
        assert_true(sample_clock_fit(&clock, stamps, rows));

        const double scatter = sqrt(c->error * c->error / 3 + c->digit * c->digit / 12);
        const double spread = sqrt(ROWS * (ROWS * (double)ROWS - 1) / 12);
        const double rounding = 1e-15 * (fabs(c->begin) + ROWS / c->rate);
        check_close(clock.period, 1 / c->rate,
                    5 * c->error / spread + 1.5 * c->digit / ROWS + 4 * rounding / ROWS);
        check_close(clock.origin, c->begin,
                    8 * c->error / sqrt(ROWS) + 2 * c->digit + 4 * rounding);
        check_close(clock.scatter, scatter, 0.1 * scatter + 4 * rounding);
        const size_t missing = c->missing > 0 ? (ROWS - 1) / (size_t)c->missing : 0;
        assert_int_equal(clock.missing, missing);
        assert_int_equal(clock.gaps, missing);
        check_close(sample_clock_number(&clock, stamps[rows - 1]), ROWS - 1, 0);
    }
}

TEST(samples_without_a_steady_rate_have_no_clock)
{
    double stamps[ROWS], time = 0;
    random_generator random;
    sample_clock clock;
    random_seed(&random, 3);
    for (int i = 0; i < ROWS; i++) {
        time += 0.001 + 0.02 * random_uniform(&random);
        stamps[i] = time;
    }
    assert_true(sample_clock_fit(&clock, stamps, ROWS));
    check_close(clock.period, 0, 0);
    assert_true(sample_clock_fit(&clock, stamps, 1));
    check_close(clock.period, 0, 0);
}

// Rows that stand twice are one sample.
TEST(rows_of_one_sample_have_its_number)
{
    double stamps[ROWS];
    sample_clock clock;
    for (int i = 0; i < ROWS; i++) {
        stamps[i] = 0.004 * (i / 2);
    }
    assert_true(sample_clock_fit(&clock, stamps, ROWS));
    check_close(clock.period, 0.004, 1e-15);
    assert_int_equal(clock.missing, 0);
    check_close(sample_clock_number(&clock, stamps[9]), 4, 0);
}

TEST(a_clock_is_foreign_where_a_recording_misses_the_run)
{
    assert_true(sample_clock_is_foreign(500, 100, 101, 2));
    assert_true(sample_clock_is_foreign(500, -3, -1, 2));
    assert_false(sample_clock_is_foreign(500, -1, 1, 2));
    assert_false(sample_clock_is_foreign(500, 1.5, 9, 2));
    assert_false(sample_clock_is_foreign(2, 100, 101, 2));
}

MAIN_AFTER((void)0, NULL, NULL)
