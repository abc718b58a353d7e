// The mutable side of a simulation: one contiguous state vector, its scratch, and a stride of its
// smooth motion.
//
// Between events an engine (engine.h) advances the motion in one contact state. Events and what
// they change are the contact machine's (contact_machine.h), which stands on this and on locate.h.
#pragma once

#include <math.h>

#include "src/arm/chain.h"
#include "src/base/status.h"
#include "src/solve/engine.h"

// Drift that is projected away in contact.
#define PROJECTION_GAP  1e-14 // [m]
#define PROJECTION_RATE 1e-13 // [m/s]

// So many states within a step are evaluated together.
enum { MOTION_TOGETHER = 8 };

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
    SLOT_GAP,              // [m]; to a face with a mass, but in contact minus the depth of both
    SLOT_GAP_VELOCITY,     // [m/s]
    SLOT_VISCOUS_POWER,    // at this state [W]
    SLOT_DAMPING_POWER,    // at this state [W]
    SLOT_JUMPED,           // 1 just after an event, before the first step
    SLOT_IMPULSE,          // of an unresolved impact, which the next step is to deliver [N s]
    SLOT_PARTED,           // 1 within a wall that gives whose face no longer follows
    SLOT_MOTOR_TORQUE,     // of an electric drive's current, at this state [N m]
    SLOT_WALL_POWER,       // lost in a wall that gives, at this state [W]
    SLOT_LAST_IMPACT,      // when it was, -1 if there was none [s]
    SLOT_SHORT_FLIGHTS,    // in a row up to that impact
    SLOT_STRIDE,           // that the engine proposes, 0 if none [s]
    SLOT_FACE,             // how far a wall's face with a mass is pushed in [m]
    SLOT_FACE_VELOCITY,    // [m/s]
    SLOT_COUNT
};

// Quadratures integrated with the motion, after the angles and velocities.
enum motion_quadrature {
    QUADRATURE_VISCOUS, // lost to back EMF and viscous friction [J]
    QUADRATURE_DAMPING, // lost to structural damping [J]
    QUADRATURE_FORCE,   // integral of f dt [N s]
    QUADRATURE_WALL, // lost in a wall that gives; engines for plain arms leave it and what follows
                     // [J]
    QUADRATURE_CURRENT, // current of an electric drive, where it is a state: enters the motion [A]
    QUADRATURE_MOTOR,   // work of an electric drive's torque [J]
    QUADRATURE_COUNT
};

// No state's.
static const state_energy unknown_energy = {-1, -1};

// The stride that a state lies in, behind everything else, of an engine whose strides outlive the
// steps they are cut into: where it began and how much of it is used up. A motion that goes on from
// a copy of its state goes on in that stride.
enum motion_kept {
    KEPT_LENGTH,                        // of the stride, 0 if there is none to go on with [s]
    KEPT_USED,                          // of it, up to this state [s]
    KEPT_CHANGED,                       // instant at which torque or arm last changed [s]
    KEPT_INTERVAL,                      // from the change before to that one [s]
    KEPT_WANTED,                        // length that was asked for [s]
    KEPT_JUMPED,                        // 1 if it began just after an event
    KEPT_QUADRATURES,                   // at its start, up to QUADRATURE_FORCE
    KEPT_ANGLES = KEPT_QUADRATURES + 3, // [rad]
    KEPT_VELOCITIES = KEPT_ANGLES + 3,  // [rad/s]
    KEPT_COUNT = KEPT_VELOCITIES + 3
};

struct motion {
    // A checkpoint is a copy of `state`, size doubles:
    // slots, q[n], w[n], quadratures, accelerations a[n], algorithmic accelerations[n], what is
    // kept of the stride.
    double *state;
    int size;
    int dof;
    int link_count;
    double start_energy; // kinetic and strain energy at the start [J]

    // how the smooth motion is advanced
    const engine *engine;
    bool chosen;         // it is not to follow the arm
    double nominal_step; // method.step [s]
    bool wall_gives;     // contact is no constraint
    bool wall_has_face;  // contact ties the arm to a mass on a spring
    bool electric;       // the motor's current is followed
    bool starved;        // no memory for the engine that a changed arm asks for
    double cut; // an instant at which a step ends without being made for it [s]; HUGE_VAL: none
    double alpha_m, alpha_f, beta, gamma; // implicit engines' coefficients [-]

    // scratch, nothing of it outlives a step
    double *trial;   // state at the end of the step tried; after it, at the step's start
    double *between; // states within the last step: MOTION_TOGETHER of a dense engine, else one
    double *scratch; // vectors of length dof
    chain_link *links;
    void *sweeps; // the implicit solver's scratch, one element a link
    void *memory; // the engine's own: the stride it is in
    bool forgets; // that stride may be another arm's: what is kept of it in the state is all to go
                  // by

    // what m->trial holds, and m->state as motion_step left it, where the engine has found it with
    // the state, else unknown_energy
    state_energy holds, reached;

    double made; // length of the step that motion_step made, to its end as the engine met it [s]

    // the stride to come, where motion_look_ahead has looked at it
    struct {
        bool known;
        bool begun;    // else it cannot be made
        double length; // to its end, the cut or the first event [s]
        bool any;      // an event ends it
        watch first;   // that event's
    } ahead;

    void *block, *engine_block; // where all of that lies

    // records since motion_watch
    long steps;                 // time steps taken: `step` long, or cut short by an event or a stop
    double pulse_peak;          // largest f since the last impact or touch, -1 if none [N]
    double pulse_peak_time;     // [s]
    double largest_penetration; // [m]
    double failure_time;        // where a step could not be taken [s]
};

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
static inline double *state_kept(const motion *m, double *state)
{
    return state + SLOT_COUNT + 4 * m->dof + QUADRATURE_COUNT;
}
static inline contact_state contact_state_of(const double *state)
{
    return (contact_state){state[SLOT_CONTACT] != 0, (hub_friction)(int)state[SLOT_FRICTION],
                           state[SLOT_PARTED] != 0};
}

// The wall's face of a state, at rest in place where it has no mass.
static inline wall_face state_face(const double *state)
{
    return (wall_face){state[SLOT_FACE], state[SLOT_FACE_VELOCITY]};
}

// Gap to where the wall's face stands at rest [m], and its rate [m/s].
static inline double state_rest_gap(const double *state)
{
    return state[SLOT_GAP] - (state[SLOT_CONTACT] != 0 ? 0 : state[SLOT_FACE]);
}
static inline double state_rest_gap_velocity(const double *state)
{
    return state[SLOT_GAP_VELOCITY] - (state[SLOT_CONTACT] != 0 ? 0 : state[SLOT_FACE_VELOCITY]);
}

// Length of the smooth part of the state: angles, velocities, quadratures.
static inline int smooth_length(const motion *m)
{
    return 2 * m->dof + QUADRATURE_COUNT;
}

// Prepares a motion of the arm with the given method; all storage is allocated here. NULL if out of
// memory.
motion *motion_create(const arm *a, const method_parameters *method);

// The same by an engine of the event method that the caller chooses, whatever becomes of the arm,
// so that engines can be compared. It has to be one for such arms.
motion *motion_create_by(const arm *a, const method_parameters *method, const engine *chosen);
void motion_destroy(motion *m); // m may be NULL

// A motion of the arm as motion_create gives it, in the storage of one that is over where that fits
// (m may be NULL); m is used up. NULL if out of memory.
motion *motion_renew(motion *m, const arm *a, const method_parameters *method);

// To be called after the arm's constants changed: the event method takes the engine that is now
// right, which is the one that motion_create would choose. It has no stride in hand then. Where
// there is no memory for it, the next step fails with STATUS_NO_MEMORY.
void motion_follow_arm(const arm *a, motion *m);

// To be called after m->state became a copy of an earlier state, whatever the arm was in between.
static inline void motion_forget_stride(motion *m)
{
    m->forgets = true;
    m->ahead.known = false;
}

// To be called after anything changed that a stride follows from and that is no jump: what comes
// next is a stride of its own.
static inline void motion_end_stride(motion *m)
{
    state_kept(m, m->state)[KEPT_LENGTH] = 0;
}

// To be called where the motor's torque or the arm changes: strides learn how soon the next change
// may come.
static inline void motion_note_change(motion *m)
{
    double *kept = state_kept(m, m->state);
    const double now = m->state[SLOT_TIME], interval = now - kept[KEPT_CHANGED];
    if (interval > 0) {
        kept[KEPT_CHANGED] = now;
        kept[KEPT_INTERVAL] = interval;
    }
}

// Forgets the recorded peak: the next one counts from the present state.
void motion_watch(motion *m);

// Takes note of a force [N] in contact at an instant [s]: the pulse's peak if none was larger.
static inline void motion_note_force(motion *m, double time, double force)
{
    if (force > m->pulse_peak) {
        m->pulse_peak = force;
        m->pulse_peak_time = time;
    }
}

// Evaluates accelerations, reactions and gap of a state in its own contact state.
void motion_evaluate(const arm *a, motion *m, double *state);

// Whether contact holds the arm still in the wall's direction.
static inline bool motion_wall_is_rigid(const motion *m)
{
    return !m->wall_gives && !m->wall_has_face;
}

// Whether contact and friction together leave the arm no way to move, and nothing else can change.
static inline bool state_is_held_still(const motion *m, const double *state)
{
    // a sliding hub is the usual case
    if ((state[SLOT_FRICTION] != HUB_STICK && m->dof > 1) || m->dof > 2 || m->electric) {
        return false;
    }
    const contact_state now = contact_state_of(state);
    const bool stuck = now.friction == HUB_STICK, held = now.contact && motion_wall_is_rigid(m);
    const bool face_moves =
        !now.contact && (state[SLOT_FACE] != 0 || state[SLOT_FACE_VELOCITY] != 0);
    return !face_moves && (m->dof == 1 ? stuck || held : stuck && held);
}
static inline bool motion_held_still(const motion *m)
{
    return state_is_held_still(m, m->state);
}

// Begins a stride from m->state that is not to go beyond `remaining` [s]; `step` as engine.begin
// has it. Returns its length [s]: all that remains for an arm that is held still.
double motion_begin_stride(const arm *a, motion *m, double remaining, double step);

// The state at h in the stride begun into m->trial, with the ledger booked and the result checked
// for finiteness. Stepping engines need no stride: they step from m->state.
status motion_try_step(const arm *a, motion *m, double h);

// Books in an evaluated state what motor and friction did since the hub was at an angle [rad].
static inline void motion_book(const arm *a, const motion *m, double hub, double *state)
{
    const double turned = state_angles(m, state)[0] - hub;
    state[SLOT_MOTOR_WORK] += a->motor.torque * turned;
    state[SLOT_FRICTION_LOSS] += state[SLOT_FRICTION] * a->motor.stiction * turned;
}

// The states at `count` instants [s] within the step just made, which left its start in m->trial,
// and what each of them holds: count up to MOTION_TOGETHER, one after the other in m->between.
// False if the engine has no such way; then motion_between of contact_machine.h gives them one by
// one.
bool motion_between_all(const arm *a, motion *m, const double *times, int count,
                        state_energy *energies);

// Whether rounding has led a state in contact so far from its constraint, by a gap [m] and its rate
// [m/s], that it has to be put back.
static inline bool motion_drifted(double gap, double rate)
{
    return !(fabs(gap) <= PROJECTION_GAP && fabs(rate) <= PROJECTION_RATE);
}

// Puts an evaluated state in contact back onto the constraint, position and velocity, along
// M^-1 J^T: the nearest admissible state in the metric of the kinetic energy. Evaluates it again if
// that moved it, and says whether it did.
bool motion_project(const arm *a, motion *m, double *state);

// How many times more than in a slow soft arm rounding shows in accelerations, at least 1: a spring
// of stiffness k between bodies of inertia I turns a last bit of an angle q into a change of
// (k/I) q 2^-52, where k/I is the square of the arm's highest frequency at most, and what turns at
// w has accelerations of w^2, to their last bit.
double motion_rounding(const arm *a, const motion *m);
// The same of the gap's acceleration: a face answers the rounding of a force by one over its mass.
double motion_gap_rounding(const arm *a, const motion *m);
// motion_rounding for dof angles q [rad] and velocities w [rad/s].
double motion_rounding_at(const arm *a, int dof, const double *q, const double *w);

// Whether the motion's steps are those of an implicit method.
static inline bool motion_is_implicit(const motion *m)
{
    return m->engine == &newmark_engine || m->engine == &generalized_alpha_engine;
}

// Whether the motion's steps are too long for the arm's fastest modes, as with many links.
static inline bool motion_unresolved(const arm *a, const motion *m)
{
    return motion_is_implicit(m) && m->nominal_step * a->fastest_rate > 1;
}

// Work of the motor's torque up to a state of this motion [J].
static inline double motion_motor_work(const motion *m, double *state)
{
    return state[SLOT_MOTOR_WORK] + state_quadratures(m, state)[QUADRATURE_MOTOR];
}

// How fast a wall that gives and the arm on it in a state of this motion can move, or a face alone:
// frequency or decay [1/s]; 0 of others.
double motion_wall_rate(const arm *a, motion *m, double *state);
// How much a unit force of that wall accelerates the gap in contact [1/kg].
double motion_wall_compliance(const arm *a, motion *m, double *state);

// How fast the force can change in a state of this motion, but for decays of the arm's [1/s]: by
// its fastest vibration, that wall, a motor's inductance.
double motion_vibration(const arm *a, motion *m, double *state);

// How long [s] a parabola does for what decays of the force on a damped chain, `since` [s] after
// the last event, which set it going: what is left of it changes in a share of that time, and
// nothing before `reach` / (fastest decay).
double motion_decay_length(const arm *a, double reach, double since);

// Energy that a wall that gives holds, with that of its face's motion; 0 in a rigid one [J].
double motion_wall_energy(const arm *a, const motion *m, const double *state);

// Energy of motion and of bending in a state of this motion.
state_energy motion_energy(const arm *a, const motion *m, double *state);

// Energy that the ledger does not account for at a state of this motion [J].
double motion_energy_residual(const arm *a, const motion *m, double *state);

// The same where what the state holds is known: kinetic and strain energy, and a giving wall's [J].
double motion_unaccounted(const motion *m, double *state, double energy);
