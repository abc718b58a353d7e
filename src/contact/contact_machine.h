// The machine that moves an arm through free flight, impact, contact and release, sliding
// and sticking:
//
//     free -> impact -> contact -> release -> free,      gap >= 0, f >= 0, gap f = 0
//
// Event location: where an event function leaves its admissible side within a step, its
// root is bracketed by shorter steps from the same start until the bracket is as narrow
// as time resolves, and the end beyond the root is taken (locate.h). Impacts are jumps of
// the velocities; the contact state after an event is the one combination of contact and
// hub friction that violates no condition. The state diagram stands at the top of
// contact_machine.c, which has the transitions; event_step.c has the steps between them.
#pragma once

#include "src/contact/contact_state.h"

// Chatter rule: after more than this number of flights in a row, each shorter than a
// hundredth of the arm's shortest period, an impact that has less than this share of the
// energy of arm and wall to lose is plastic whatever the coefficient of restitution.
enum { MOTION_MOST_SHORT_FLIGHTS = 50 };
#define MOTION_CHATTER_SHARE 1e-5

typedef struct motion_report {
    motion_event event;
    double impulse; // of an impact [N s]
    double speed;   // approach speed of an impact [m/s]
    double loss;    // energy lost in an impact [J]
    bool chatter;   // an elastic impact was made plastic: too many short flights in a row
    bool holds;     // after an event: the arm is in contact
} motion_report;

// Puts the bodies at angles[dof] [rad] with velocities[dof] [rad/s], and a motor with
// inductance at a current [A], at time 0 and finds the contact state. An arm that moves
// into a rigid wall there is free until the impact that follows immediately.
void motion_start_at(const arm *a, motion *m, const double *angles,
                     const double *velocities, double current);

// The same of a straight arm: all bodies at `angle` [rad] with `velocity` [rad/s].
void motion_start(const arm *a, motion *m, double angle, double velocity);

// Makes one step towards `until`, or to the first event if that comes first. The implicit
// methods take steps of `step`; the event method goes as far as its accuracy allows, many
// times `step` or a fraction of it; an arm that contact and friction hold still goes to
// `until` at once. At an event the state lies just beyond the event's root, before the
// event's jump: the caller may look at it and then calls motion_apply.
//
// A step that would go beyond m->record.tstop is first tried as if tstop were not there,
// and ends at tstop only if no event comes before it. So everything before tstop is, to
// the last bit, what it would be without it. Fails with STATUS_NOT_FINITE,
// STATUS_NEWTON_FAILED or STATUS_SINGULAR; the state is then the last good one.
// STATUS_NO_MEMORY as motion_follow_arm says. STATUS_FOLDED on a rigid flat wall that
// holds an arm folded over the hub's axis (chain_is_folded), or is about to: the state is
// the folded one, and the motion cannot be continued.
status motion_step(const arm *a, motion *m, double until, double step,
                   motion_report *report);

// Determines in advance, in m->step.coming, how far the next motion_step(a, m, until,
// step, ...) will go, and updates the recorded peak force for that step. The step may
// continue to `far` [s], `until` or later, while its internal step lasts, which is chosen
// for `until` only. For a dense engine and an arm that is not held still; motion_step
// does it itself, up to `until`, if nobody has. An arm that is held folded has no step.
void motion_examine_step(const arm *a, motion *m, double until, double far, double step);

// The state at `time` within the last step, as much of it as `extent` says, by stepping
// again from its start; a pointer that is good until the next call of any function here.
// To be called before motion_apply. NULL if the step fails.
double *motion_between(const arm *a, motion *m, double time, state_extent extent);

// Takes the transition of the event that motion_step reported; completes *report.
void motion_apply(const arm *a, motion *m, motion_report *report);

// A push: an impulse [N s] at the tip, across the last link, towards growing angle. In
// contact the wall answers; *report is then an impact, else MOTION_REACHED.
void motion_push(const arm *a, motion *m, double impulse, motion_report *report);

// How far the arm would be from the wall's face [m] with the wall that `a` has, a face
// that is pushed in moving with its wall.
double motion_gap_with(const arm *a, motion *m);

// To be called after the constants of the arm changed under a motion (`before` is the old
// arm) and motion_follow_arm (motion_create.h) chose its engine: the change of strain
// energy is booked as external work and the contact state found anew. A wall that was
// moved is in front of the arm.
void motion_rebind(const arm *before, const arm *after, motion *m);

// To be called after nothing but the motor's torque changed from `before` [N m]:
// accelerations and reactions jump with it, and the contact state is found anew where it
// may have changed.
void motion_retorque(const arm *a, motion *m, double before);
