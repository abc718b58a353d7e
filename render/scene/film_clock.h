// When in a run each moment of a film is: slower round every impact.
#pragma once

#include "src/run/run_result.h"

enum { FILM_IMPACTS = 64 }; // most impacts that are slowed down

typedef struct film_clock {
    double start, end;            // of the run [s]
    double impacts[FILM_IMPACTS]; // instants round which it is slowed down [s], ascending
    int impact_count;
    double before, after; // each time it is slowed down fully from `before` until `after` it [s]
    double taper;         // the time over which that comes and goes [s]
    double slow;          // how much slower than the rest
    double seconds;       // of the film
} film_clock;

// A clock of runs that are shown together: `seconds` of film, and the time from shortly before
// every impact of any of them until the force has risen `slow` times slower than the rest. Impacts
// with less than a twentieth of the largest impulse are left out; in a run without impulses every
// begin of contact counts.
film_clock film_clock_of(const run_result *const *results, int count, double seconds, double slow);

// The same for a time from `start` to `end` [s] and what happens at an instant of it [s]; the
// film's length is left open.
film_clock film_clock_round(double start, double end, double instant, double slow);

// How many times slower the run goes at an instant [s] than where it is not slowed down: between,
// half a cosine.
double film_clock_slowness(const film_clock *c, double time);

// The instant of the run [s] shown at a film's time [s], and how many seconds of the run pass in a
// second of film there.
double film_clock_time(const film_clock *c, double film_time, double *speed);
