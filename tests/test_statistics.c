// Statistics of piecewise linear signals, cut anywhere, against exact values.
#include "tests/check.h"

#include "src/base/random.h"
#include "src/run/trace.h"

static void add(trace *t, double time, double force)
{
    const double none[1] = {0};
    sample row = {.time = time, .force = force};
    assert_int_equal(trace_add_row(t, &row, none, none), STATUS_OK);
}

// The force rises from 0 to 2 N within a second, jumps to 5 N and stays there for another
// second. Expected: the areas of a triangle (1) and a rectangle (5); for the mean square
// the integrals of (2 t)^2 and 25 over a second each, 4/3 and 25.
TEST(a_ramp_and_a_step)
{
    const int force = SIGNAL_INDEX(force);
    SCOPED(trace_finish) trace t;
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

    // a value that is missing ends the pieces on both of its sides
    for (int missing = 0; missing < 2; missing++) {
        SCOPED(trace_finish) trace part;
        trace_init(&part, 1);
        add(&part, 0, missing == 0 ? (double)NAN : 1);
        add(&part, 1, missing == 1 ? (double)NAN : 1);
        add(&part, 2, 1);
        add(&part, 3, 1);
        s = trace_statistics(&part, force, 0, 3);
        check_close(s.duration, missing == 0 ? 2 : 1, 0);
        check_close(s.mean, 1, 1e-15);
    }

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
}

// Sums over the pieces between two rows, each cut, by Simpson's rule, which is exact for
// them.
static signal_statistics by_pieces(const double *times, const double *values, int rows,
                                   double from, double to)
{
    signal_statistics s = {.minimum = HUGE_VAL, .maximum = -HUGE_VAL};
    double squares = 0;
    for (int i = 0; i + 1 < rows; i++) {
        const double begin = fmax(times[i], from), end = fmin(times[i + 1], to);
        const bool last = from == times[rows - 1];
        if (times[i] == times[i + 1] || end < begin || (times[i + 1] == from && !last) ||
            isnan(values[i] + values[i + 1])) {
            continue;
        }
        double at[3];
        for (int k = 0; k < 3; k++) {
            const double share =
                (begin + k * (end - begin) / 2 - times[i]) / (times[i + 1] - times[i]);
            at[k] = values[i] + share * (values[i + 1] - values[i]);
            s.minimum = fmin(s.minimum, at[k]);
            s.maximum = fmax(s.maximum, at[k]);
        }
        s.duration += end - begin;
        s.integral += (end - begin) * (at[0] + 4 * at[1] + at[2]) / 6;
        squares +=
            (end - begin) * (at[0] * at[0] + 4 * at[1] * at[1] + at[2] * at[2]) / 6;
    }
    s.mean = s.duration > 0 ? s.integral / s.duration : s.minimum;
    s.rms = s.duration > 0 ? sqrt(squares / s.duration) : fabs(s.minimum);
    return s;
}

// Rows at eighths of a second, some of them twice, some without a value, cut at
// sixteenths.
TEST(whatever_is_cut_is_the_sum_of_its_pieces)
{
    enum { ROWS = 12 };
    random_generator g;
    random_seed(&g, 9);
    for (int trial = 0; trial < 3000; trial++) {
        double times[ROWS], values[ROWS];
        SCOPED(trace_finish) trace t;
        trace_init(&t, 1);
        for (int i = 0; i < ROWS; i++) {
            times[i] = i == 0 ? 0 : times[i - 1] + (double)random_below(&g, 3) / 8;
            values[i] = (double)random_below(&g, 17) - 8;
            values[i] =
                trial % 3 == 0 && random_below(&g, 8) == 0 ? (double)NAN : values[i];
            add(&t, times[i], values[i]);
        }

        // within the run, an instant among them
        const double end = times[ROWS - 1];
        const double a = (double)random_below(&g, (uint64_t)(16 * end) + 1) / 16;
        const double b = (double)random_below(&g, (uint64_t)(16 * end) + 1) / 16;
        const double from = fmin(a, b), to = trial % 5 == 0 ? from : fmax(a, b);
        const signal_statistics s = trace_statistics(&t, SIGNAL_INDEX(force), from, to);
        const signal_statistics x = by_pieces(times, values, ROWS, from, to);
        if (from < end && x.maximum >= x.minimum) {
            check_close(s.minimum, x.minimum, 1e-14);
            check_close(s.maximum, x.maximum, 1e-14);
            check_close(s.duration, x.duration, 1e-14);
            check_close(s.integral, x.integral, 1e-13);
            check_close(s.mean, x.mean, 1e-13);
            check_close(s.rms, x.rms, 1e-13);
        } else if (from == end && isfinite(values[ROWS - 1])) {
            const double last = values[ROWS - 1];
            check_close(s.minimum, last, 0);
            check_close(s.maximum, last, 0);
            check_close(s.mean, last, 0);
            check_close(s.rms, fabs(last), 0);
            check_close(fabs(s.integral) + s.duration, 0, 0);
        } else {
            check_close(s.duration, 0, 0);
        }
    }
}

// Whole pieces have the values of their rows, to the last bit.
TEST(extremes_are_values_of_rows)
{
    random_generator g;
    random_seed(&g, 3);
    for (int trial = 0; trial < 200; trial++) {
        const double value[] = {random_uniform(&g), random_uniform(&g)};
        SCOPED(trace_finish) trace t;
        trace_init(&t, 1);
        add(&t, random_uniform(&g), value[0]);
        add(&t, 1 + random_uniform(&g), value[1]);
        const signal_statistics s = trace_statistics(&t, SIGNAL_INDEX(force), 0, 3);
        check_close(s.minimum, fmin(value[0], value[1]), 0);
        check_close(s.maximum, fmax(value[0], value[1]), 0);
    }
}
