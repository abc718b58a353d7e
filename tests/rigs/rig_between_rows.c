// What a quantity is between two rows, and how far it may be from that.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tests/rigs/random_rigs.h"

// The instant between two rows, at `from` and `to`, at which the voltage changes; NaN if
// there is none. *next is a sample at or before the first to be looked at: it is moved
// on.
static double change_within(const motion *m, int *next, double from, double to)
{
    while (*next < m->sample_count && m->samples[*next].applied < from - INSTANT) {
        ++*next;
    }
    for (int k = *next; k < m->sample_count && m->samples[k].applied < to + INSTANT;
         k++) {
        const double before = k > 0 ? m->samples[k - 1].voltage : 0;
        if (m->samples[k].voltage != before) {
            return fmax(from, fmin(to, m->samples[k].applied));
        }
    }
    return (double)NAN;
}

double slope(const piece *p)
{
    return (p->end - p->begin) / (p->to - p->from);
}

double bend(const piece *p, const piece *q)
{
    const bool joined = p->to == q->from && p->end == q->begin;
    const bool wide = p->to - p->from > INSTANT && q->to - q->from > INSTANT;
    return joined && wide ? 2 * fabs(slope(q) - slope(p)) / (q->to - p->from) : 0;
}

pieces pieces_of(const motion *m, const double *column)
{
    const double *t = m->of[TIME];
    pieces made = {.of = malloc((2 * m->count + 2) * sizeof(piece))};
    int next = 0;
    for (size_t i = 0; i + 1 < m->count; i++) {
        if (t[i + 1] <= t[i]) {
            continue;
        }
        const double at = m->of[VOLTAGE][i] != m->of[VOLTAGE][i + 1]
                              ? change_within(m, &next, t[i], t[i + 1])
                              : (double)NAN;
        if (isnan(at)) {
            made.of[made.count++] =
                (piece){t[i], t[i + 1], column[i], column[i + 1], 0, false};
            continue;
        }

        // the values on both sides of the jump: the line through the two rows before it,
        // and the line through the two rows after it, both drawn on to its instant
        double before = column[i], after = column[i + 1];
        if (i > 0 && t[i] - t[i - 1] > INSTANT) {
            before += (column[i] - column[i - 1]) / (t[i] - t[i - 1]) * (at - t[i]);
        }
        if (i + 2 < m->count && t[i + 2] - t[i + 1] > INSTANT) {
            after +=
                (column[i + 2] - column[i + 1]) / (t[i + 2] - t[i + 1]) * (at - t[i + 1]);
        }
        made.of[made.count++] = (piece){t[i], at, column[i], before, 0, true};
        made.of[made.count++] = (piece){at, t[i + 1], after, column[i + 1], 0, true};
    }

    // how far the function may be from its line: with D, twice the largest second
    // derivative nearby, by D h^2 / 8 between two rows, by D h^2 where it is drawn on
    for (size_t i = 0; i < made.count; i++) {
        double largest_bend = 0;
        for (size_t j = i >= 3 ? i - 3 : 0; j + 1 < made.count && j <= i + 2; j++) {
            largest_bend = fmax(largest_bend, bend(&made.of[j], &made.of[j + 1]));
        }
        piece *p = &made.of[i];
        const double h = p->drawn ? spacing : p->to - p->from;
        p->error = 2 * largest_bend * h * h / (p->drawn ? 1 : 8) +
                   1e-12 * (fabs(p->begin) + fabs(p->end));
    }
    return made;
}

double value_within(const piece *p, double t)
{
    const double share = p->to > p->from ? (t - p->from) / (p->to - p->from) : 0;
    return p->begin + share * (p->end - p->begin);
}

double integral(const pieces *f, double from, double to, double *error)
{
    double sum = 0;
    *error = 0;
    for (size_t i = 0; i < f->count; i++) {
        const piece *p = &f->of[i];
        // the part of the piece within the interval, by the trapezoidal rule
        const double a = fmax(p->from, from), b = fmin(p->to, to);
        if (b > a) {
            sum += (b - a) * (value_within(p, a) + value_within(p, b)) / 2;
            *error += (b - a) * p->error;
        }
    }
    *error += ROUNDING * fabs(sum);
    return sum;
}

blow_list impulses_of(const motion *m)
{
    const size_t most = impactlab_run_event_count(m->run);
    blow_list made = {.of = malloc((most + 1) * sizeof(blow))};
    for (size_t i = 0; i < most; i++) {
        impactlab_event e;
        impactlab_run_event(m->run, i, &e);
        if (strcmp(e.kind, "impact") == 0) {
            made.of[made.count++] = (blow){e.time, e.impulse};
        }
    }
    return made;
}

blow_list jumps_of(const motion *m, const double *column)
{
    blow_list made = {.of = malloc(m->count * sizeof(blow))};
    for (size_t i = 0; i + 1 < m->count; i++) {
        const double jump = column[i + 1] - column[i];
        if (m->of[TIME][i + 1] <= m->of[TIME][i] && jump != 0) {
            made.of[made.count++] = (blow){m->of[TIME][i], jump};
        }
    }
    return made;
}
