// Newmark and generalised-alpha on the chain, see implicit_stepper.c.
#pragma once

#include "src/solve/motion.h"

// One link's share of the tangent system, kept between the two sweeps of its solution.
typedef struct implicit_sweep {
    double c, s;             // direction of the link
    double com_x, com_y;     // acceleration of its centre of mass [m/s2]
    double force_x, force_y; // force it gives to the links beyond [N]
    double zx, zy;           // d(node acceleration)/d(angle) / l [1/s2]
    double vx, vy;           // dependence on the base's acceleration, over the pivot
    double to_parent;        // dependence on the parent's angle, over the pivot
    double free, unit;       // right-hand sides over the pivot
} implicit_sweep;

enum { IMPLICIT_SWEEP_SIZE = sizeof(implicit_sweep) };
