// Events and peaks within the internal step of a dense engine (engine.h), without another internal
// step.
//
// Guarantee: the first fall of an event function below zero by more than its tolerance (1e-12 m,
// 1e-9 N, 1e-12 N m, 1e-12 rad/s) is found, and its root is exact to rounding; a dip that stays
// above minus the tolerance may be missed.
#pragma once

#include "src/contact/motion.h"

// The first instant in [0, end->length] of the internal step at which an event function leaves its
// admissible side, by finding the roots of those that the engine's excludes_event leaves: *end as
// locate_first_event has it; m->trial is left alone.
void dense_search_event(const arm *a, motion *m, step_end *end);

// Raises m->record.pulse_peak to the largest force in [0, h] of an internal step in contact.
void dense_peak(const arm *a, motion *m, double h);

// Raises m->record.largest_penetration to the deepest point in [0, h] of an internal step within a
// wall that gives, or above a face that the arm has left and that is pushed in.
void dense_deepest(const arm *a, motion *m, double h);
