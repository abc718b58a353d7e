// What happens within a step, and when: located by stepping again from the step's start.
#pragma once

#include "src/solve/motion.h"

#define FORCE_TOLERANCE 1e-9 // tension that counts as a release [N]

// Looks for the first function that leaves its admissible side within (0, *h], m->trial being the
// state after a step *h. If there is one, *any is true, *first says which, and *h and m->trial move
// to the far side of that instant. What a step could not be taken for is returned.
status locate_first_event(const arm *a, motion *m, double *h, watch *first, bool *any);

// Records the largest force within the step from m->state to m->trial, located between its ends by
// refining a parabola. m->trial is left as it was.
status locate_peak(const arm *a, motion *m, double h);
