#include "render/plot/ticks.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "render/page/text.h"
#include "src/base/numbers.h"

// the nice numbers 1, 5, 2, 2.5, 4, 3 in tenths, nicest first
static const int nice_tenths[] = {10, 50, 20, 25, 40, 30};
enum { NICE = 6 };
static const double weight_simplicity = 0.25, weight_coverage = 0.2, weight_density = 0.5,
                    weight_legibility = 0.05;

// A labelling: tick i is at (start + i j) nice 10^power.
typedef struct labelling {
    double start;
    int j, nice, power, count;
    double score;
} labelling;

// The axis that ticks are wanted for, and how many.
typedef struct tick_request {
    double low, high; // ends of the axis
    int count;
} tick_request;

// The number of which all ticks are multiples, nice 10^power.
static double step_unit(const labelling *l)
{
    return 0.1 * nice_tenths[l->nice] * pow(10, l->power);
}

// number nice 10^power, by whole numbers and a single division or multiplication so that
// it is rounded once.
static double tick_value(const labelling *l, double number)
{
    double whole = number * nice_tenths[l->nice];
    int power = l->power - 1;
    if (power < 0) {
        return whole / pow(10, -power);
    }
    return whole * pow(10, power);
}

// The score of a labelling, the weighted sum of its parts.
static double combined(double simplicity, double coverage, double density)
{
    return weight_simplicity * simplicity + weight_coverage * coverage +
           weight_density * density + weight_legibility;
}

// Score for a simple labelling: its number early in the list, few multiples left out
// (small j), and 0 among the ticks.
static double simplicity(const labelling *l)
{
    double last = l->start + (double)(l->count - 1) * l->j;
    double score = 1 - (double)l->nice / (NICE - 1) - l->j;
    if (fmod(l->start, l->j) == 0 && l->start <= 0 && last >= 0) {
        score += 1;
    }
    return score;
}

// The greatest simplicity that any start and power can have.
static double simplicity_most(int nice, int j)
{
    return 2 - (double)nice / (NICE - 1) - j;
}

// Score for ticks whose first and last are near the ends of the axis.
static double coverage(double low, double high, double first, double last)
{
    double tenth = 0.1 * (high - low);
    return 1 - 0.5 * (pow(high - last, 2) + pow(low - first, 2)) / (tenth * tenth);
}

// The greatest coverage of ticks that span a length: with the axis in their middle.
static double coverage_most(double low, double high, double span)
{
    double range = high - low, half = (span - range) / 2;
    if (span > range) {
        return 1 - half * half / pow(0.1 * range, 2);
    }
    return 1;
}

// Score for a number of ticks per length that is near the wanted one.
static double density(int count, int wanted, double low, double high, double first,
                      double last)
{
    double have = (count - 1) / (last - first);
    double want = (wanted - 1) / (fmax(last, high) - fmin(low, first));
    return 2 - fmax(have / want, want / have);
}

// The greatest density score that a number of ticks can have.
static double density_most(int count, int wanted)
{
    if (count >= wanted) {
        return 2 - (double)(count - 1) / (wanted - 1);
    }
    return 1;
}

// Scores every start for the step and count of a labelling, and keeps the best that lies
// within the axis.
static void try_starts(labelling l, const tick_request *w, labelling *best)
{
    double unit = step_unit(&l), step = unit * l.j;
    double from = (floor(w->high / step) - (l.count - 1)) * l.j,
           to = ceil(w->low / step) * l.j;
    double slack = 1e-9 * (w->high - w->low);

    // starts are multiples of the step only: 0.04, 0.05 and never 0.045, 0.055
    for (l.start = from; l.start <= to; l.start += l.j) {
        double first = l.start * unit, last = first + step * (l.count - 1);
        l.score = combined(simplicity(&l), coverage(w->low, w->high, first, last),
                           density(l.count, w->count, w->low, w->high, first, last));
        if (l.score > best->score && first >= w->low - slack && last <= w->high + slack) {
            *best = l;
        }
    }
}

// Tries the powers of ten for a nice number and count, from the one that just spans the
// axis upwards.
static void try_powers(labelling l, const tick_request *w, labelling *best)
{
    double nice = 0.1 * nice_tenths[l.nice];
    l.power = (int)ceil(log10((w->high - w->low) / (l.count + 1) / l.j / nice));

    // ends where not even the greatest score of this power could win
    for (;; l.power++) {
        double span = l.j * step_unit(&l) * (l.count - 1);
        double most =
            combined(simplicity_most(l.nice, l.j), coverage_most(w->low, w->high, span),
                     density_most(l.count, w->count));
        if (most < best->score) {
            return;
        }
        try_starts(l, w, best);
    }
}

// The labelling with the best score. The search goes through j, nice number, count, power
// and start, and ends each loop where the greatest score left is below the best so far.
static labelling best_labelling(const tick_request *w)
{
    labelling best = {.score = -100}; // below any that lies within the axis

    // every j-th multiple of the nice numbers
    for (int j = 1;; j++) {
        for (int nice = 0; nice < NICE; nice++) {
            double simple = simplicity_most(nice, j);
            if (combined(simple, 1, 1) < best.score) {
                return best;
            }
            for (int count = 2;
                 combined(simple, 1, density_most(count, w->count)) >= best.score;
                 count++) {
                try_powers((labelling){.j = j, .nice = nice, .count = count}, w, &best);
            }
        }
    }
}

// Digits after the point that tick values in units of 10^exponent need.
static int decimals_needed(const ticks *t)
{
    double unit = pow(10, t->exponent);

    // the least number of digits at which all values are whole
    for (int decimals = 0; decimals < 15; decimals++) {
        bool enough = true;
        for (int i = 0; i < t->count && enough; i++) {
            double scaled = t->value[i] / unit * pow(10, decimals);
            enough = fabs(scaled - round(scaled)) <= 1e-6 + 1e-12 * fabs(scaled);
        }
        if (enough) {
            return decimals;
        }
    }
    return 15;
}

// greatest limit that gets ticks, so that no power of ten overflows
#define FARTHEST 1e100

// Orders the limits of an axis, separates equal ones, and limits the wanted count. False
// if a limit is not a number or too large.
static bool order_limits(tick_request *w)
{
    if (!(fabs(w->low) <= FARTHEST && fabs(w->high) <= FARTHEST)) {
        return false;
    }
    if (w->low > w->high) {
        double other = w->low;
        w->low = w->high;
        w->high = other;
    }

    // ends that are too near each other move apart
    double size = fmax(fabs(w->low), fabs(w->high));
    if (w->high - w->low <= 1e-10 * size || w->high == w->low) {
        double half = size > 0 ? 0.1 * size : 1;
        w->low -= half;
        w->high += half;
    }

    if (w->count < 2) {
        w->count = 2;
    } else if (w->count > TICKS_MOST / 2) {
        w->count = TICKS_MOST / 2;
    }
    return true;
}

// Fills in the values of all ticks: all multiples of the labelling's step that lie on the
// axis.
static void fill_values(ticks *t, const labelling *best, const tick_request *w)
{
    const double unit = step_unit(best), slack = 1e-9 * (w->high - w->low);

    // the first multiple on the axis, and how many there are from it on
    double first = best->start;
    while ((first - best->j) * unit >= w->low - slack) {
        first -= best->j;
    }
    t->count = (int)floor((w->high + slack - first * unit) / (best->j * unit)) + 1;
    if (t->count > TICKS_MOST) {
        t->count = TICKS_MOST;
    }

    for (int i = 0; i < t->count; i++) {
        t->value[i] = tick_value(best, first + (double)i * best->j);
        if (t->value[i] == 0) {
            t->value[i] = 0; // no minus zero
        }
    }
    if (t->count > 1) {
        t->step = tick_value(best, best->j);
    }
}

// The power of ten by which labels are divided where they would have many zeros; 0: none.
static int label_exponent(const ticks *t)
{
    double largest = 0;
    for (int i = 0; i < t->count; i++) {
        largest = fmax(largest, fabs(t->value[i]));
    }
    if (largest > 0 && (largest >= 1e5 || largest < 1e-2)) {
        return 3 * (int)floor(log10(largest) / 3);
    }
    return 0;
}

// Chooses the ticks of an axis: their values, minor ticks, and the exponent and decimals
// of their labels.
void ticks_between(ticks *t, double low, double high, int wanted)
{
    tick_request w = {low, high, wanted};
    memset(t, 0, sizeof *t);
    t->minor = 1;
    if (!order_limits(&w)) {
        return;
    }
    const labelling best = best_labelling(&w);
    fill_values(t, &best, &w);

    // minor ticks fall on rounder numbers than the step itself
    static const int parts[NICE] = {5, 5, 4, 5, 4, 3};
    if (best.j == 1) {
        t->minor = parts[best.nice];
    }
    t->exponent = label_exponent(t);
    t->decimals = decimals_needed(t);
}

void tick_label(const ticks *t, int index, char text[TICK_TEXT])
{
    assert(index >= 0 && index < t->count);
    double value = t->value[index] / pow(10, t->exponent);
    char digits[TICK_TEXT - 4];
    decimal_print(digits, sizeof digits, "%.*f", t->decimals, fabs(value));
    snprintf(text, TICK_TEXT, "%s%s", text_sign(value), digits);
}

void tick_factor(const ticks *t, char *text, size_t size)
{
    text[0] = '\0';
    if (t->exponent != 0) {
        snprintf(text, size, "\u00d710<sup>%s%d</sup>", text_sign(t->exponent),
                 abs(t->exponent));
    }
}
