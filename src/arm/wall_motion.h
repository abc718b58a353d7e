// How a wall moves: displacement along its normal, positive towards the arm, away from where
// wall.angle has it.
//
//     sine: u = A sin(2 pi f (t - t0)), at all times
//     step: u = A S((t - t0)/T), S(x) = x^3 (10 - 15 x + 6 x^2) for x from 0 to 1: at rest before
//           and after, the acceleration without a jump; T = 1/(2 f)
//
// so that an arm in contact is never struck by the wall's motion itself. The motion is analytic but
// where a derivative jumps, at a step's begin and end; the engine's steps end there.
#pragma once

#include <stdbool.h>

#include "src/tables/parameters.h"

// Where a wall is at an instant.
typedef struct wall_shift {
    double place;        // [m]
    double velocity;     // [m/s]
    double acceleration; // [m/s2]
} wall_shift;

typedef struct wall_motion {
    wall_motion_kind kind;
    double amplitude; // A [m]
    double frequency; // f [Hz]
    double time;      // t0 [s]
} wall_motion;

// The motion of resolved parameters.
wall_motion wall_motion_of(const wall_parameters *p);

wall_shift wall_motion_at(const wall_motion *m, double time);

// How fast it changes from an instant on [1/s], 0 at rest.
double wall_motion_rate(const wall_motion *m, double time);

// How long after an instant it stays analytic [s].
double wall_motion_lasts(const wall_motion *m, double time);
