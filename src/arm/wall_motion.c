#include "src/arm/wall_motion.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/sincos.h"

#define SAME_INSTANT 1e-13 // [s]

wall_motion wall_motion_of(const wall_parameters *p)
{
    wall_motion_kind kind = MOTION_NONE;
    if (p->kind != WALL_NONE) {
        kind = (wall_motion_kind)p->motion;
    }
    return (wall_motion){.kind = kind,
                         .amplitude = p->motion_amplitude,
                         .frequency = p->motion_frequency,
                         .time = p->motion_time};
}

// --- a table ---------------------------------------------------------------------------

// Computes the rates m, at the rows, of the cubic spline through them that has slope 0 at
// both ends. Its acceleration is continuous at the rows between if, with h the intervals
// and d the slopes of the chords,
//
//     h_i m_(i-1) + 2 (h_(i-1) + h_i) m_i + h_(i-1) m_(i+1) = 3 (h_i d_(i-1) + h_(i-1)
//     d_i)
//
// a diagonally dominant tridiagonal system, solved by elimination; scratch[rows].
static void find_rates(wall_path *p, double *scratch)
{
    const size_t last = p->rows - 1;
    p->rates[0] = scratch[0] = 0;
    for (size_t i = 1; i < last; i++) {
        const double before = p->times[i] - p->times[i - 1],
                     after = p->times[i + 1] - p->times[i];
        const double chord_before = (p->places[i] - p->places[i - 1]) / before;
        const double chord_after = (p->places[i + 1] - p->places[i]) / after;
        const double pivot = 2 * (before + after) - after * scratch[i - 1];
        const double right = 3 * (after * chord_before + before * chord_after);
        scratch[i] = before / pivot;
        p->rates[i] = (right - after * p->rates[i - 1]) / pivot;
    }
    p->rates[last] = 0;
    for (size_t i = last; i-- > 1;) {
        p->rates[i] -= scratch[i] * p->rates[i + 1];
    }
}

// Keeps one row for each instant; f says at which line another place stands at the same
// one.
static status take_places(wall_path *p, const csv_table *table, fault *f)
{
    size_t kept = 1;
    for (size_t i = 1; i < table->rows; i++) {
        if (p->times[i] > p->times[kept - 1]) {
            p->times[kept] = p->times[i];
            p->places[kept++] = p->places[i];
        } else if (p->places[i] != p->places[kept - 1]) {
            const int line = table->lines[i];
            const int column = csv_table_find(table, csv_table_clock(table)) + 1;
            return fault_set_place(
                f, STATUS_BAD_ARGUMENT, line, column,
                "%.300s:%d:%d: time = %g s again: a wall is at one place at a time",
                table->file, line, column, p->times[i]);
        }
    }
    p->rows = kept;
    return STATUS_OK;
}

status wall_path_create(wall_path **created, const parameters *known, fault *f)
{
    csv_table table = {0};
    sample_clock clock;
    wall_path *p = calloc(1, sizeof *p);
    *created = NULL;
    if (p == NULL) {
        return fault_no_memory(f);
    }

    // the columns, at times that rise
    status code = csv_table_read(&table, known->wall.motion_file, 2, f);
    if (code == STATUS_OK) {
        code = csv_table_play(&table, known->control.rate, known->wall.motion_time,
                              known->run.duration, &clock, &p->times, p->told, f);
    }
    if (code == STATUS_OK) {
        code = csv_table_numbers(&table, "place", "m", GAPS_REFUSED, &p->places, f);
    }
    if (code == STATUS_OK) {
        code = take_places(p, &table, f);
    }
    csv_table_finish(&table);

    // the spline through them
    double *scratch = NULL;
    if (code == STATUS_OK) {
        p->rates = calloc(p->rows, sizeof *p->rates);
        scratch = calloc(p->rows, sizeof *scratch);
        if (p->rates == NULL || scratch == NULL) {
            code = fault_no_memory(f);
        }
    }
    if (code == STATUS_OK) {
        find_rates(p, scratch);
    }
    free(scratch);
    if (code == STATUS_OK) {
        *created = p;
        return STATUS_OK;
    }

    // a file with faults is a scenario with faults
    wall_path_destroy(p);
    if (f != NULL && code != STATUS_NO_MEMORY) {
        f->code = code = STATUS_BAD_SCENARIO;
        f->path = "wall.motion_file";
    }
    return code;
}

void wall_path_destroy(wall_path *p)
{
    if (p != NULL) {
        free(p->times);
        free(p->places);
        free(p->rates);
        free(p);
    }
}

// The last row that is not after an instant of the table's own time, by bisection; a row
// that is after it only by rounding counts, too. -1 before the first row.
static long interval_of(const wall_path *p, double time)
{
    long low = -1, high = (long)p->rows;
    while (high - low > 1) {
        const long middle = (low + high) / 2;
        if (p->times[middle] <= time + SAME_INSTANT) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// Place, velocity and acceleration of a wall whose motion is a table, at an instant of
// the table's time: Hermite's cubic between two rows, and at rest before and after them.
static wall_shift path_at(const wall_path *p, double time)
{
    const long i = interval_of(p, time), last = (long)p->rows - 1;
    if (i < 0) {
        return (wall_shift){.place = p->places[0]};
    }
    if (i == last) {
        return (wall_shift){.place = p->places[last]};
    }
    const double h = p->times[i + 1] - p->times[i], x = (time - p->times[i]) / h;
    const double rise = p->places[i + 1] - p->places[i];
    const double a = h * p->rates[i], b = h * p->rates[i + 1];

    // places[i] + a x + (3 rise - 2 a - b) x^2 + (a + b - 2 rise) x^3
    const double square = 3 * rise - 2 * a - b, cube = a + b - 2 * rise;
    return (wall_shift){.place = p->places[i] + x * (a + x * (square + x * cube)),
                        .velocity = (a + x * (2 * square + x * 3 * cube)) / h,
                        .acceleration = (2 * square + x * 6 * cube) / (h * h)};
}

// --- where it is -----------------------------------------------------------------------

wall_shift wall_motion_at(const wall_motion *m, double time)
{
    const double since = time - m->time;
    switch (m->kind) {
    case MOTION_SINE: {
        double s, c;
        const double rate = 2 * M_PI * m->frequency;
        inline_sincos(rate * since, &s, &c);
        return (wall_shift){time, m->amplitude * s, m->amplitude * rate * c,
                            -m->amplitude * rate * rate * s};
    }
    case MOTION_STEP: {
        const double rate = 2 * m->frequency, x = fmax(0, fmin(rate * since, 1)),
                     y = 1 - x;
        return (wall_shift){time, m->amplitude * x * x * x * (10 - 15 * x + 6 * x * x),
                            m->amplitude * rate * 30 * x * x * y * y,
                            m->amplitude * rate * rate * 60 * x * y * (y - x)};
    }
    case MOTION_FILE: {
        wall_shift at = {0};
        if (m->path != NULL) {
            at = path_at(m->path, since);
        }
        at.time = time;
        return at;
    }
    case MOTION_NONE:
        break;
    }
    return (wall_shift){.time = time};
}

bool wall_motion_series(const wall_motion *m, double time, int count, double *terms)
{
    assert(count >= 4);
    const double acceleration = wall_motion_at(m, time).acceleration;
    const double since = time - m->time, rate = 2 * m->frequency;
    memset(terms, 0, (size_t)count * sizeof *terms);
    if (m->kind == MOTION_SINE) {
        const double turn = 2 * M_PI * m->frequency;
        terms[0] = acceleration;
        terms[1] = -turn * turn * wall_motion_at(m, time).velocity;
        for (int n = 2; n < count; n++) {
            terms[n] = -turn * turn * terms[n - 2] / (n * (n - 1));
        }
        return true;
    }
    if (m->kind == MOTION_STEP && wall_motion_rate(m, time) > 0) {
        // 60 (x - 3 x^2 + 2 x^3) at the phase x
        const double x = fmax(rate * since, 0), scale = 60 * m->amplitude * rate * rate;
        terms[0] = acceleration;
        terms[1] = scale * rate * (1 - 6 * x * (1 - x));
        terms[2] = scale * rate * rate * (6 * x - 3);
        terms[3] = scale * rate * rate * rate * 2;
        return true;
    }
    if (m->kind == MOTION_FILE && wall_motion_rate(m, time) > 0) {
        // the acceleration of a cubic is a straight line
        const long i = interval_of(m->path, since);
        const double h = m->path->times[i + 1] - m->path->times[i];
        const double rise = m->path->places[i + 1] - m->path->places[i];
        terms[0] = acceleration;
        terms[1] =
            (6 * (m->path->rates[i] + m->path->rates[i + 1]) - 12 * rise / h) / (h * h);
        return true;
    }
    return false;
}

double wall_motion_rate(const wall_motion *m, double time)
{
    if (m->kind == MOTION_FILE) {
        // one over the interval between two rows
        long i = -1;
        if (m->path != NULL) {
            i = interval_of(m->path, time - m->time);
        }
        if (i >= 0 && i + 1 < (long)m->path->rows) {
            return 1 / (m->path->times[i + 1] - m->path->times[i]);
        }
        return 0;
    }
    const bool rises = m->kind == MOTION_STEP && time - m->time > -SAME_INSTANT &&
                       wall_motion_lasts(m, time) < HUGE_VAL;
    if (m->kind == MOTION_SINE || rises) {
        return 2 * M_PI * m->frequency;
    }
    return 0;
}

double wall_motion_lasts(const wall_motion *m, double time)
{
    const double since = time - m->time;
    if (m->kind == MOTION_FILE && m->path != NULL) {
        const long next = interval_of(m->path, since) + 1;
        if (next < (long)m->path->rows) {
            return m->path->times[next] - since;
        }
        return HUGE_VAL;
    }
    if (m->kind != MOTION_STEP) {
        return HUGE_VAL;
    }
    const double rises = 1 / (2 * m->frequency);
    if (since < -SAME_INSTANT) {
        return -since;
    }
    if (since < rises - SAME_INSTANT) {
        return rises - since;
    }
    return HUGE_VAL;
}
