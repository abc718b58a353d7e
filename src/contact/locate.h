// What happens within a step, and when: located by stepping again from the step's start
// or, where the engine is dense (engine.h), in the internal step itself.
#pragma once

#include "src/contact/motion.h"

#define FORCE_TOLERANCE 1e-9 // tension that counts as a release [N]
// approach speed below which a touch carries no impulse [m/s]
#define TOUCH_SPEED 1e-11

// Whether a fall of the event function below zero would end the motion's present contact
// state.
static inline bool event_function_active(const arm *a, const motion *m, event_function w)
{
    bool contact = m->state[SLOT_CONTACT] != 0;
    bool stuck = m->state[SLOT_FRICTION] == HUB_STICK;
    bool held = m->dof == 1 && contact && motion_wall_is_rigid(m);

    // an event function is of use only where its event could end the present state
    if (w == EVENT_OF_GAP) {
        return (!contact || m->wall_gives) && wall_stands(&a->wall);
    }
    if (w == EVENT_OF_FORCE) {
        return contact;
    }
    if (w == EVENT_OF_HUB) {
        return !stuck && !held && a->motor.stiction > 0;
    }
    if (w == EVENT_OF_STICTION) {
        return stuck && !held;
    }
    return m->electric && a->motor.current_limit < HUGE_VAL;
}

// Tolerance of the event function: how far below zero still counts as admissible, in its
// unit.
double event_tolerance(event_function w);

// Looks for the first function that leaves its admissible side within (0, end->length],
// m->trial being the state after a step of that length. If there is one, *end says which,
// and it and m->trial move to the far side of that instant. Returns why, if a step fails.
status locate_first_event(const arm *a, motion *m, step_end *end);

// A function at one instant of a step.
typedef struct step_point {
    double time; // since the step's start [s]
    value_and_slope at;
} step_point;

// The gap to the wall at rest and its rate at an instant of the step [s].
typedef value_and_slope (*rest_gap_function)(const arm *a, motion *m, double h);

// Raises m->record.largest_penetration to the deepest point between two of that function,
// if it falls at the first and rises at the second; the instant is exact to `resolution`
// [s].
void locate_deepest(const arm *a, motion *m, step_point lo, step_point hi,
                    double resolution, rest_gap_function at);

// Records the largest force within the step from m->state to m->trial, located between
// its ends by refining a parabola, and the deepest point of an arm that turns back within
// a wall that gives. m->trial is left as it was.
status locate_peak(const arm *a, motion *m, double h);

// --- in the internal step of a dense engine (dense_location.c) -------------------------

// Guarantee: the first fall of an event function below zero by more than its tolerance
// (1e-12 m, 1e-9 N, 1e-12 N m, 1e-12 rad/s) is found, and its root is exact to rounding;
// a dip that stays above minus the tolerance may be missed.

// The first instant in [0, end->length] of the internal step at which an event function
// leaves its admissible side, by finding the roots of those that the engine's
// excludes_event leaves: *end as locate_first_event has it; m->trial is left alone.
void dense_search_event(const arm *a, motion *m, step_end *end);

// Raises m->record.pulse_peak to the largest force in [0, h] of an internal step in
// contact.
void dense_peak(const arm *a, motion *m, double h);

// Raises m->record.largest_penetration to the deepest point in [0, h] of an internal step
// within a wall that gives, or above a face that the arm has left and that is pushed in.
void dense_deepest(const arm *a, motion *m, double h);
