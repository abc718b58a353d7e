// How a wall moves: displacement along its normal, positive towards the arm, away from
// where wall.angle has it.
//
//     sine: u = A sin(2 pi f (t - t0)), at all times
//     step: u = A S((t - t0)/T), S(x) = x^3 (10 - 15 x + 6 x^2) for x from 0 to 1: at
//     rest before
//           and after, the acceleration without a jump; T = 1/(2 f)
//
//     file: the cubic spline through the rows of a table, at t - t0, that comes to rest
//     at its ends
//           and rests before and after; the acceleration jumps at the ends only
//
// so that an arm in contact is never struck by the wall's motion itself. The motion is
// analytic but where a derivative jumps: at a step's begin and end, at the rows of a
// table. The engine's steps end there.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/base/csv_table.h"
#include "src/base/fault.h"
#include "src/tables/parameters.h"

// Where a wall is at an instant.
typedef struct wall_shift {
    double time;         // that instant [s]
    double place;        // [m]
    double velocity;     // [m/s]
    double acceleration; // [m/s2]
} wall_shift;

// A motion given by a table.
typedef struct wall_path {
    size_t rows;         // at least 2
    double *times;       // rising [s]
    double *places;      // [m]
    double *rates;       // of the spline there, 0 at both ends [m/s]
    char told[CSV_TOLD]; // what a person should know of the file, "" if nothing
} wall_path;

// Reads the table of wall.motion_file, with the columns time [s] and place [m], and
// computes its spline; to be destroyed. STATUS_BAD_SCENARIO, with file, line and column,
// if it cannot be read, has fewer than two rows, or two places at one time;
// STATUS_NO_MEMORY. *created is then NULL.
status wall_path_create(wall_path **created, const parameters *known, fault *f);
void wall_path_destroy(wall_path *path); // may be NULL

typedef struct wall_motion {
    wall_motion_kind kind;
    double amplitude;      // A [m]
    double frequency;      // f [Hz]
    double time;           // t0 [s]
    const wall_path *path; // of a file; NULL: not read, the wall rests
} wall_motion;

// The motion of resolved parameters, without the path of a file.
wall_motion wall_motion_of(const wall_parameters *p);

wall_shift wall_motion_at(const wall_motion *m, double time);

// The first `count` coefficients of the acceleration's Taylor series at an instant
// [m/s2], [m/s3], ..., good up to where the motion stays analytic. Whether any is not
// zero.
bool wall_motion_series(const wall_motion *m, double time, int count, double *terms);

// How fast it changes from an instant on [1/s], 0 at rest.
double wall_motion_rate(const wall_motion *m, double time);

// How long after an instant it stays analytic [s].
double wall_motion_lasts(const wall_motion *m, double time);
