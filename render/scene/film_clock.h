// The instant of a run for each instant of a film, with slow motion near every impact.
#pragma once

#include "src/run/run_result.h"

enum { FILM_IMPACTS = 64 }; // most impacts shown in slow motion

typedef struct film_clock {
    double start, end;            // of the run [s]
    double impacts[FILM_IMPACTS]; // instants of slow motion [s], ascending
    int impact_count;
    double before, after; // full slow motion from `before` until `after` each of them [s]
    double taper;         // duration of the transitions [s]
    double slow;          // factor of slow motion
    double seconds;       // of the film
} film_clock;

// A clock of runs that are shown together: `seconds` of film, and the time from shortly before
// every impact of any of them until the force has risen `slow` times slower than the rest. Impacts
// with less than a twentieth of the largest impulse are left out; in a run without impulses every
// beginning of contact is used.
film_clock film_clock_of(const run_result *const *results, int count, double seconds, double slow);

// The same for a time from `start` to `end` [s] and a single event at an instant [s]; the length of
// the film is not set.
film_clock film_clock_round(double start, double end, double instant, double slow);

// The factor of slow motion at an instant [s], 1 outside; the transitions are half a cosine.
double film_clock_slowness(const film_clock *c, double time);

// The instant of the run [s] shown at a film's time [s], and how many seconds of the run pass in a
// second of film there.
double film_clock_time(const film_clock *c, double film_time, double *speed);
