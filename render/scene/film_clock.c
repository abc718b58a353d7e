// Which instant of a run a film shows when: slow motion near every impact.
#include "render/scene/film.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "src/base/numbers.h"

enum { CLOCK_CELLS = 4000 };

#define LEAST_IMPULSE 0.05 // of the largest

// Parts of the run's length.
#define BEFORE 0.01
#define AFTER  0.04
#define TAPER  0.03

static void add_impact(film_clock *c, double time)
{
    if (c->impact_count < FILM_IMPACTS) {
        c->impacts[c->impact_count++] = time;
    }
}

// The impacts of a run, or where contact begins in one without impulses.
static void add_impacts(film_clock *c, const trace *t)
{
    double largest = 0;
    for (size_t i = 0; i < t->event_count; i++) {
        if (t->events[i].kind == EVENT_IMPACT) {
            largest = fmax(largest, t->events[i].impulse);
        }
    }

    for (size_t i = 0; i < t->event_count && largest > 0; i++) {
        const event *e = &t->events[i];
        if (e->kind == EVENT_IMPACT && e->impulse >= LEAST_IMPULSE * largest) {
            add_impact(c, e->time);
        }
    }

    // a force that grows from nothing
    for (size_t i = 1; i < t->row_count && !(largest > 0); i++) {
        if (t->rows[i].contact > 0.5 && !(t->rows[i - 1].contact > 0.5)) {
            add_impact(c, t->rows[i].time);
        }
    }
}

static void set_windows(film_clock *c)
{
    const double span = c->end - c->start;
    c->before = BEFORE * span;
    c->after = AFTER * span;
    c->taper = TAPER * span;
}

// The clock of runs shown together: slow near the impacts of all of them.
film_clock film_clock_of(const run_result *const *results, int count, double seconds,
                         double slow)
{
    assert(count > 0 && seconds > 0 && slow >= 1);
    film_clock c = {.start = -HUGE_VAL,
                    .end = HUGE_VAL,
                    .slow = slow,
                    .seconds = seconds};

    // what all of them have
    for (int i = 0; i < count; i++) {
        const trace *t = &results[i]->trace;
        assert(t->row_count > 0);
        c.start = fmax(c.start, t->rows[0].time);
        c.end = fmin(c.end, t->rows[t->row_count - 1].time);
        add_impacts(&c, t);
    }
    qsort(c.impacts, (size_t)c.impact_count, sizeof c.impacts[0], compare_numbers);

    set_windows(&c);
    return c;
}

film_clock film_clock_round(double start, double end, double instant, double slow)
{
    assert(end >= start && isfinite(instant) && slow >= 1);
    film_clock c = {start, end, .slow = slow, .impacts = {instant}, .impact_count = 1};
    set_windows(&c);
    return c;
}

// 1 far from all impacts, the full factor at one, half a cosine between.
double film_clock_slowness(const film_clock *c, double t)
{
    double outside = HUGE_VAL;
    for (int i = 0; i < c->impact_count; i++) {
        double until = c->impacts[i] - c->before - t,
               since = t - c->impacts[i] - c->after;
        outside = fmin(outside, fmax(fmax(until, since), 0));
    }
    if (outside >= c->taper) {
        return 1;
    }
    return 1 + (c->slow - 1) * 0.5 * (1 + cos(M_PI * outside / c->taper));
}

// Which instant of the run a film shows: the run is cut into cells, each of which takes a
// share of the film as large as it is slow.
double film_clock_time(const film_clock *c, double film_time, double *speed)
{
    assert(c->seconds > 0);
    const double cell = (c->end - c->start) / CLOCK_CELLS;

    // the slownesses of all cells are the shares that they have of the film
    double total = 0, passed = 0;
    for (int i = 0; i < CLOCK_CELLS; i++) {
        total += film_clock_slowness(c, c->start + (i + 0.5) * cell);
    }

    // the cell in which the share of the film's time is passed
    double wanted = fmin(1, fmax(0, film_time / c->seconds)) * total;
    for (int i = 0; i < CLOCK_CELLS; i++) {
        double here = film_clock_slowness(c, c->start + (i + 0.5) * cell);
        if (passed + here >= wanted) {
            *speed = total * cell / c->seconds / here;
            return c->start + (i + (wanted - passed) / here) * cell;
        }
        passed += here;
    }

    // rounding passed the last cell
    *speed = total * cell / c->seconds / film_clock_slowness(c, c->end);
    return c->end;
}
