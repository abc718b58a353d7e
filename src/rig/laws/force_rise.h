// The way from a touch to the wanted force that costs the least integral of (f - wanted)^2.
//
// With the force as input the first mode in contact obeys a'' = s^2 (a - f) (observer_design.h; a
// force stands here for the coordinate in which the mode rests under it). Its stopping force
// x = a + a'/s obeys x' = s (x - f), which runs away from any force but its own: to bring it to the
// wanted one, w, at the least cost is f = w + 2 (x - w), by which both decay as exp(-s t),
//
//     f = w + 2 y exp(-s t),     a = w + (a0 - w + s t y) exp(-s t),     y = x0 - w.
//
// Where that begins beyond a bound of the force, the force stays at the bound first.
#pragma once

#include <stdbool.h>

typedef struct force_rise_task {
    double coordinate, rate; // of the mode at the beginning
    double divergence;       // s [1/s]
    double end;              // rest under the wanted force, above 0
    double least, most;      // under the forces between which it is to be; most may be infinite
    double time;             // of the beginning [s]
} force_rise_task;

typedef struct force_rise {
    double begun;      // when [s]
    double time;       // until the force is near the wanted one [s]
    double divergence; // s [1/s]
    double from, end;  // coordinates at the beginning and at rest
    double off;        // y, of the stopping force at the beginning
    double bound;      // where the force is at first,
    double bounded;    // and for how long [s]
} force_rise;

// Plans the way. Too slow a motion for a force above `least` presses with none for a while, and one
// that no force up to `most` stops brakes with what it takes.
force_rise force_rise_begin(const force_rise_task *task);

// Coordinate, its rate and its second derivative at an instant [s].
void force_rise_at(const force_rise *r, double time, double way[3]);

// Whether it is still under way.
bool force_rise_moves(const force_rise *r, double time);
