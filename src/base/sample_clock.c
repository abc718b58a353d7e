#include "src/base/sample_clock.h"

#include <math.h>
#include <stdlib.h>

#include "src/base/extremes.h"
#include "src/base/numbers.h"
#include "src/base/scoped.h"

#define NEAR        0.25 // of a period: how far a stamp may lie from its sample
#define STEADY      0.95 // share of the stamps that have to
#define ALIKE       1.5  // ratio of steps that are one period
#define CLOCK_ERROR 1e-3 // relative, of a recorder's clock

enum { LEAST_ROWS = 4 };

double sample_clock_number(const sample_clock *c, double stamp)
{
    return floor((stamp - c->origin) / c->period + 0.5);
}

double sample_clock_instant(const sample_clock *c, double n)
{
    return c->origin + n * c->period;
}

// What a stamp is off its sample [s].
static double stamp_error(const sample_clock *c, double stamp)
{
    return stamp - sample_clock_instant(c, sample_clock_number(c, stamp));
}

// --- the line through the stamps -------------------------------------------------------

// Improves the clock by the straight line through stamps over the numbers that it gives
// them, with the sums of deviations from the means,
//
//     period = sum (n - mean n) (t - mean t) / sum (n - mean n)^2
static void improve_clock(sample_clock *c, const double *stamps, size_t rows)
{
    // the means, of times since the first row
    const double first = stamps[0];
    double mean_number = 0, mean_time = 0;
    for (size_t i = 0; i < rows; i++) {
        const double count = (double)(i + 1);
        mean_number += (sample_clock_number(c, stamps[i]) - mean_number) / count;
        mean_time += (stamps[i] - first - mean_time) / count;
    }

    // the line
    double products = 0, squares = 0;
    for (size_t i = 0; i < rows; i++) {
        const double number = sample_clock_number(c, stamps[i]) - mean_number;
        products += number * (stamps[i] - first - mean_time);
        squares += number * number;
    }
    if (products > 0) {
        c->period = products / squares;
        c->origin = first + (mean_time - mean_number * c->period);
        c->error = 1 / sqrt(squares);
    }
}

// Fits the line from a first guess of the period on. Numbers are certain only as far as
// the guess reaches, so that the line goes through few stamps first and through twice as
// many each time.
static void fit_from(sample_clock *c, double guess, const double *stamps, size_t rows)
{
    *c = (sample_clock){.period = guess, .origin = stamps[0]};
    for (size_t some = LEAST_ROWS; some < rows; some *= 2) {
        improve_clock(c, stamps, some);
        improve_clock(c, stamps, some);
    }
    improve_clock(c, stamps, rows);
    improve_clock(c, stamps, rows);
}

// Whether nearly all stamps are near a sample.
static bool is_steady(const sample_clock *c, const double *stamps, size_t rows)
{
    size_t near = 0;
    for (size_t i = 0; i < rows; i++) {
        if (fabs(stamp_error(c, stamps[i])) <= NEAR * c->period) {
            near++;
        }
    }
    return (double)near >= STEADY * (double)rows;
}

// --- what the clock leaves -------------------------------------------------------------

// Counts the samples that have no row, lets the first row be sample 0, and finds how far
// the stamps scatter.
static void judge_clock(sample_clock *c, const double *stamps, size_t rows)
{
    c->origin = sample_clock_instant(c, sample_clock_number(c, stamps[0]));
    double squares = 0;
    for (size_t i = 0; i < rows; i++) {
        const double off = stamp_error(c, stamps[i]);
        squares += off * off;
        if (i == 0) {
            continue;
        }
        const double step =
            sample_clock_number(c, stamps[i]) - sample_clock_number(c, stamps[i - 1]);
        if (step > 1) {
            c->gaps++;
            c->missing += (size_t)(step - 1);
            c->longest = larger(c->longest, stamps[i] - stamps[i - 1]);
        }
    }
    c->scatter = sqrt(squares / (double)rows);
    c->error *= c->scatter;
}

// The mean of the steps that are like one of them, steps[count] by size: those of one
// period, which rounding makes unequal.
static double mean_step(const double *steps, size_t count, double like)
{
    double sum = 0, number = 0;
    for (size_t i = 0; i < count; i++) {
        if (steps[i] > like / ALIKE && steps[i] < like * ALIKE) {
            sum += steps[i];
            number++;
        }
    }
    return sum / number;
}

bool sample_clock_fit(sample_clock *c, const double *stamps, size_t rows)
{
    *c = (sample_clock){.period = 0};
    SCOPED(free_kept) double *steps = calloc(rows + 1, sizeof *steps);
    if (steps == NULL) {
        return false;
    }

    // the steps between rows of different times, by size
    size_t count = 0;
    for (size_t i = 1; i < rows; i++) {
        if (stamps[i] > stamps[i - 1]) {
            steps[count++] = stamps[i] - stamps[i - 1];
        }
    }
    if (count < LEAST_ROWS - 1) {
        return true;
    }
    qsort(steps, count, sizeof *steps, compare_numbers);

    // most steps are one period, or most samples are missing and a short step is
    static const double shares[] = {0.5, 0.25, 0.1};
    for (size_t i = 0; i < sizeof shares / sizeof *shares; i++) {
        const double like = steps[(size_t)((double)count * shares[i])];
        fit_from(c, mean_step(steps, count, like), stamps, rows);
        if (is_steady(c, stamps, rows)) {
            judge_clock(c, stamps, rows);
            return true;
        }
    }
    *c = (sample_clock){.period = 0};
    return true;
}

// --- whose clock it is -----------------------------------------------------------------

double sample_clock_correction(const sample_clock *c, double rate)
{
    if (c->period == 0) {
        return 1;
    }

    // the nearest whole number of samples to a sample
    const double ratio = 1 / (rate * c->period);
    double whole = floor(ratio + 0.5);
    if (ratio < 1) {
        whole = 1 / floor(1 / ratio + 0.5);
    }
    const double factor = ratio / whole;
    if (fabs(factor - 1) > CLOCK_ERROR) {
        return 1;
    }
    return factor;
}

bool sample_clock_is_foreign(size_t rows, double first, double last, double end)
{
    return rows >= RECORDED_ROWS && (first > end || last < 0);
}
