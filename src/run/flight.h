// Quantities of a step in free flight that depend on its whole course, not only on its ends. The
// step is the one that motion_step has just made.
#pragma once

#include "src/solve/motion.h"

// Whether the gap was a separation, above SEPARATION_GAP, at any instant of the step.
bool flight_separated(const arm *a, motion *m);

// How fast the tip came towards the wall at most in the step [m/s]: at its ends or, where it was
// faster and then slower, in between. Negative if it only went away; 0 without a wall.
double flight_closing_speed(const arm *a, motion *m);
