// The mutable side of a simulation: one contiguous state vector, its scratch, and a step of its
// smooth motion.
//
// Between events a stepper (explicit or implicit) advances the motion in one contact state. Events
// and what they change are the contact machine's (contact_machine.h), which stands on this and on
// locate.h.
#pragma once

#include "src/arm/chain.h"
#include "src/base/status.h"

// Steps of a fraction of a time step keep (fastest rate) x (step) below this; the 8th-order method
// then loses a few parts in 1e12 of the fastest mode's energy in one.
#define EXPLICIT_RESOLUTION 0.36

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
    // A checkpoint is a copy of `state`, size doubles:
    // slots, q[n], w[n], quadratures, accelerations a[n], algorithmic accelerations[n].
    double *state;
    int size;
    int dof;
    double start_energy; // kinetic and strain energy at the start [J]

    // how the smooth motion is advanced
    const struct stepper *stepper;
    double nominal_step; // method.step [s]
    bool brief;          // explicit: the step takes the method of order 6
    double cut; // an instant at which a step ends without being made for it [s]; HUGE_VAL: none
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

// Advances `m->state` by h into `m->trial` in the contact state it is in: angles, velocities,
// quadratures, algorithmic accelerations.
typedef struct stepper {
    const char *name;
    status (*step)(const arm *a, motion *m, double h);
    int scratch_vectors; // how many vectors of the state's smooth length it wants in stages
    size_t link_scratch; // bytes a link it wants in sweeps
} stepper;

extern const stepper explicit_stepper; // Runge-Kutta of order 8, of order 6 in brief steps
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

// Forgets the recorded peak: the next one counts from the present state.
void motion_watch(motion *m);

// Evaluates accelerations, reactions and gap of a state in its own contact state.
void motion_evaluate(const arm *a, motion *m, double *state);

// Whether contact and friction together leave the arm no way to move.
static inline bool motion_held_still(const motion *m)
{
    contact_state now = contact_state_of(m->state);
    int holds = now.contact + (now.friction == HUB_STICK);
    return m->dof == 1 ? holds > 0 : holds >= m->dof;
}

// Advances m->state by h into m->trial, books the ledger, and checks the result for finiteness.
status motion_try_step(const arm *a, motion *m, double h);

// Puts an evaluated state in contact back onto the constraint, position and velocity, along
// M^-1 J^T: the nearest admissible state in the metric of the kinetic energy. Evaluates it again if
// that moved it.
void motion_project(const arm *a, motion *m, double *state);

// Whether the motion's steps are too long for the arm's fastest modes, as with many links.
static inline bool motion_unresolved(const arm *a, const motion *m)
{
    return m->stepper != &explicit_stepper && m->nominal_step * a->fastest_rate > 1;
}

// Energy that the ledger does not account for at a state of this motion [J].
double motion_energy_residual(const arm *a, const motion *m, double *state);
