// The clock of a recording: how fast its samples came, and when the first of them.
//
// A recorder stamps its samples, rounded and a little late or early, by a clock that has
// its own rate and its own zero. Where the samples came at a steady rate the stamps are
//
//     t_i = origin + n_i period + error_i
//
// with whole numbers n_i, some of which may be missing or stand in several rows. Period
// and origin are those with the least squares of the errors.
#pragma once

#include <stdbool.h>
#include <stddef.h>

// A table of fewer rows may have been written by a person, each time as it was meant.
enum { RECORDED_ROWS = 10 };

typedef struct sample_clock {
    double period;  // between samples [s]; 0: they came at no steady rate
    double origin;  // of sample 0, which is the first row's [s]
    double error;   // standard error of the period [s]
    double scatter; // root of the mean square of the stamps' errors [s]
    size_t missing; // samples between the first and the last that have no row
    size_t gaps;    // how many pieces those are
    double longest; // of these pieces, from row to row [s]
} sample_clock;

// Finds the clock of stamps that do not fall, stamps[rows] [s]. At a steady rate at least
// 19 of 20 stamps lie within a quarter of a period of their samples. False without
// memory.
bool sample_clock_fit(sample_clock *c, const double *stamps, size_t rows);

// The number n of the sample that a stamp [s] is nearest to; period > 0.
double sample_clock_number(const sample_clock *c, double stamp);

// The instant of sample n [s].
double sample_clock_instant(const sample_clock *c, double n);

// What a recording's times have to be multiplied by, so that its samples come at a rig's
// rate [1/s], whole numbers of them to one of the rig's or the other way round, where
// they do but for an error of the recorder's clock of 0.1 %; else 1.
double sample_clock_correction(const sample_clock *c, double rate);

// Whether a recording has a clock of its own, such as the time of day, that has nothing
// to do with a run from 0 to `end`: of the rows of a recording, from the instant `first`
// to `last`, none lies in the run [s].
bool sample_clock_is_foreign(size_t rows, double first, double last, double end);
