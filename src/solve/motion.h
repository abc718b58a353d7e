// The mutable side of a simulation: one contiguous state vector, scratch, and the machine that
// moves it through free flight, impact, contact and release, sliding and sticking.
//
//     free -> impact -> contact -> release -> free,      gap >= 0, f >= 0, gap f = 0
//
// Between events a stepper (explicit or implicit) advances the smooth motion. A function that
// leaves its admissible side within a step is located by stepping again from the start of the
// step with a shorter one, bracketed until the bracket is as narrow as time resolves, and the far
// side is taken. Impacts are jumps of the velocities; what holds afterwards follows from the one
// combination of contact and hub friction that violates nothing.
#pragma once

#include "src/arm/chain.h"
#include "src/base/status.h"

// Bookkeeping at the head of the state vector; angles, velocities and the rest follow.
enum motion_slot {
    SLOT_TIME,             // [s]
    SLOT_CONTACT,          // 1 in contact
    SLOT_FRICTION,         // hub_friction
    SLOT_FORCE,            // f at this state [N]
    SLOT_FRICTION_TORQUE,  // at this state [N m]
    SLOT_GAP_ACCELERATION, // [m/s2]
    SLOT_MOTOR_WORK,       // [J]
    SLOT_EXTERNAL_WORK,    // [J]
    SLOT_FRICTION_LOSS,    // [J]
    SLOT_IMPACT_LOSS,      // [J]
    SLOT_GAP,              // [m]
    SLOT_GAP_VELOCITY,     // [m/s]
    SLOT_VISCOUS_POWER,    // at this state [W]
    SLOT_DAMPING_POWER,    // at this state [W]
    SLOT_JUMPED,           // 1 just after an event, before the first step
    SLOT_IMPULSE,          // of an unresolved impact, which the next step is to deliver [N s]
    SLOT_COUNT
};

// Quadratures integrated with the motion, after the angles and velocities.
enum motion_quadrature {
    QUADRATURE_VISCOUS, // lost to back EMF and viscous friction [J]
    QUADRATURE_DAMPING, // lost to structural damping [J]
    QUADRATURE_FORCE,   // integral of f dt [N s]
    QUADRATURE_COUNT
};

typedef struct motion {
    // A snapshot is a copy of `state`, size doubles:
    // slots, q[n], w[n], quadratures, accelerations a[n], algorithmic accelerations[n].
    double *state;
    int size;
    int dof;
    double start_energy; // kinetic and strain energy at the start [J]

    // how the smooth motion is advanced
    const struct stepper *stepper;
    double nominal_step; // method.step [s]
    bool brief;          // explicit: the stride takes the method of order 6
    double cut; // an instant at which a stride ends without being made for it [s]; HUGE_VAL: none
    double alpha_m, alpha_f, beta, gamma; // implicit steppers' coefficients [-]

    // scratch, nothing of it outlives a step
    double *trial;   // state at the end of the step tried; after it, at the step's start
    double *between; // state within the last step, for motion_between
    double *stages;  // explicit stages
    double *scratch; // vectors of length dof
    chain_link *links;
    void *sweeps; // the implicit solver's scratch, one element a link

    // records since motion_watch
    long steps;                 // time steps taken: `step` long, or cut short by an event or a stop
    double pulse_peak;          // largest f since the last impact or touch, -1 if none [N]
    double pulse_peak_time;     // [s]
    double largest_penetration; // [m]
    double failure_time;        // where a step could not be taken [s]
} motion;

// Advances `m->state` by h into `m->trial` under the mode the state is in: angles, velocities,
// quadratures, algorithmic accelerations.
typedef struct stepper {
    const char *name;
    status (*step)(const arm *a, motion *m, double h);
    int scratch_vectors; // how many vectors of the state's smooth length it wants in stages
} stepper;

extern const stepper explicit_stepper; // Runge-Kutta of order 8, of order 6 in brief strides
extern const stepper newmark_stepper;
extern const stepper generalized_alpha_stepper; // the same step with other coefficients

// Views into a state vector.
static inline double *state_angles(const motion *m, double *state)
{
    (void)m;
    return state + SLOT_COUNT;
}
static inline double *state_velocities(const motion *m, double *state)
{
    return state + SLOT_COUNT + m->dof;
}
static inline double *state_quadratures(const motion *m, double *state)
{
    return state + SLOT_COUNT + 2 * m->dof;
}
static inline double *state_accelerations(const motion *m, double *state)
{
    return state + SLOT_COUNT + 2 * m->dof + QUADRATURE_COUNT;
}
static inline double *state_algorithmic(const motion *m, double *state)
{
    return state + SLOT_COUNT + 3 * m->dof + QUADRATURE_COUNT;
}
static inline contact_state contact_state_of(const double *state)
{
    return (contact_state){state[SLOT_CONTACT] != 0, (hub_friction)(int)state[SLOT_FRICTION]};
}

// Length of the smooth part of the state: angles, velocities, quadratures.
static inline int smooth_length(const motion *m)
{
    return 2 * m->dof + QUADRATURE_COUNT;
}

// Prepares a motion of the arm with the given method; all storage is allocated here. NULL if out of
// memory.
motion *motion_create(const arm *a, const method_parameters *method);
void motion_destroy(motion *m); // m may be NULL

// Puts all bodies at `angle` [rad] with `velocity` [rad/s] at time 0 and finds the mode.
void motion_start(const arm *a, motion *m, double angle, double velocity);

// Kinds of event the machine meets.
typedef enum motion_event {
    MOTION_REACHED, // the wanted time
    MOTION_IMPACT,
    MOTION_TOUCH, // contact begins without an approach velocity
    MOTION_RELEASE,
    MOTION_STICK,
    MOTION_SLIP,
} motion_event;

typedef struct motion_report {
    motion_event event;
    double impulse; // of an impact [N s]
    double speed;   // approach speed of an impact [m/s]
    double loss;    // energy lost in an impact [J]
    bool holds;     // after an impact: contact goes on
} motion_report;

// Makes one stride towards `until`, or to the first event if that comes first. The implicit methods
// stride by `step`, the event method by as many steps as its accuracy allows (a fraction of one, if
// need be); an arm that contact and friction hold still strides to `until` at once. At an event the
// state is on the event's far side, before its jump: let the caller look at it, then call
// motion_apply.
//
// A stride that would go beyond m->cut is first tried as if the cut were not there, and ends at the
// cut only if no event comes before it. So what happens before the cut, to the last bit, is what
// happens without it. Fails with STATUS_NOT_FINITE, STATUS_NEWTON_FAILED or STATUS_SINGULAR; the
// state is then the last good one.
status motion_step(const arm *a, motion *m, double until, double step, motion_report *report);

// Strides until `until` or the first event.
status motion_advance(const arm *a, motion *m, double until, double step, motion_report *report);

// The state at `time` within the last stride, by stepping again from its start; a pointer that is
// good until the next call of any function here. To be called before motion_apply. NULL if the step
// fails.
double *motion_between(const arm *a, motion *m, double time);

// Applies the jump and change of mode of the event motion_advance reported; completes *report.
void motion_apply(const arm *a, motion *m, motion_report *report);

// A push: an impulse [N s] at the tip, across the last link, towards growing angle. In contact the
// wall answers; *report is then an impact, else MOTION_REACHED.
void motion_push(const arm *a, motion *m, double impulse, motion_report *report);

// To be called after the constants of the arm changed under a motion (`before` is the old arm): the
// change of strain energy is booked as external work and the mode found anew.
void motion_rebind(const arm *before, const arm *after, motion *m);

// To be called after nothing but the motor's torque changed from `before` [N m]: accelerations and
// reactions jump with it, and the mode is found anew where it may have changed.
void motion_retorque(const arm *a, motion *m, double before);

// Forgets the recorded peak: the next one counts from the present state.
void motion_watch(motion *m);

// Evaluates accelerations, reactions and gap of a state under its own mode.
void motion_evaluate(const arm *a, motion *m, double *state);

// Whether contact and friction together leave the arm no way to move.
bool motion_held_still(const motion *m);

// Advances m->state by h into m->trial, books the ledger, and checks the result for finiteness.
status motion_try_step(const arm *a, motion *m, double h);

// Puts an evaluated state in contact back onto the constraint, position and velocity, along
// M^-1 J^T: the nearest admissible state in the metric of the kinetic energy. Evaluates it again if
// that moved it.
void motion_project(const arm *a, motion *m, double *state);

// Whether the motion's steps are too long for the arm's fastest modes, as with many links.
bool motion_unresolved(const arm *a, const motion *m);

// Energy that the ledger does not account for at a state of this motion [J].
double motion_energy_residual(const arm *a, const motion *m, double *state);
