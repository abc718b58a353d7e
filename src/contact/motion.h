// The mutable side of a simulation: one contiguous state vector, its scratch, and an
// internal step of its smooth motion.
//
// Between events an engine (engine.h) advances the motion in one contact state. Events
// and their jumps belong to the contact machine (contact_machine.h), which is built on
// this module and on locate.h.
#pragma once

#include "src/arm/chain.h"
#include "src/base/fault.h"
#include "src/contact/engine.h"

// The most states within a step that are evaluated together.
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
    SLOT_GAP, // to the wall's face; in contact minus the depth of arm and face [m]
    SLOT_GAP_VELOCITY,  // [m/s]
    SLOT_VISCOUS_POWER, // at this state [W]
    SLOT_DAMPING_POWER, // at this state [W]
    SLOT_JUMPED,        // 1 just after an event, before the first step
    SLOT_IMPULSE,      // of an unresolved impact, which the next step is to deliver [N s]
    SLOT_MOTOR_TORQUE, // of an electric drive's current, at this state [N m]
    SLOT_WALL_POWER,   // lost in a wall that gives, at this state [W]
    SLOT_LAST_IMPACT,  // when it was, -1 if there was none [s]
    SLOT_SHORT_FLIGHTS, // in a row up to that impact
    SLOT_FACE,          // how far the face of a wall that gives is pushed in [m]
    SLOT_FACE_VELOCITY, // [m/s]
    SLOT_WALL_WORK,     // power of a wall that moves, at this state [W]
    SLOT_START_WEIGHT,  // energy of the weight at the start [J]
    SLOT_COUNT
};

// Quadratures integrated with the motion, after the angles and velocities.
enum motion_quadrature {
    QUADRATURE_VISCOUS, // lost to back EMF and viscous friction [J]
    QUADRATURE_DAMPING, // lost to structural damping [J]
    QUADRATURE_FORCE,   // integral of f dt [N s]
    QUADRATURE_WALL,    // lost in a wall that gives; engines for plain arms leave it and
                        // what follows [J]
    QUADRATURE_CURRENT, // current of an electric drive, where it is a state: enters the
                        // motion [A]
    QUADRATURE_MOTOR,   // work of an electric drive's torque [J]
    QUADRATURE_PUSHED,  // work of a wall that moves [J]
    QUADRATURE_COUNT
};

// Marks energies that have not been computed; no state has negative ones.
static const state_energy unknown_energy = {-1, -1};

// The last part of the state vector, for engines whose internal steps are longer than the
// steps taken of them: where the present internal step began and how much of it is used
// up. So a motion continued from a copy of its state continues the same internal step.
enum motion_kept {
    KEPT_LENGTH,      // of the internal step, 0 if there is none to continue [s]
    KEPT_USED,        // part of it before this state [s]
    KEPT_CHANGED,     // instant at which torque or arm last changed [s]
    KEPT_INTERVAL,    // between that change and the one before [s]
    KEPT_WANTED,      // length requested for the internal step [s]
    KEPT_JUMPED,      // 1 if it began just after an event
    KEPT_QUADRATURES, // at its start, up to QUADRATURE_FORCE
    KEPT_ANGLES = KEPT_QUADRATURES + 3, // [rad]
    KEPT_VELOCITIES = KEPT_ANGLES + 3,  // [rad/s]
    KEPT_COUNT = KEPT_VELOCITIES + 3
};

// What holds between calls beside the state vector; a checkpoint has both (motion_save).
typedef struct motion_record {
    long steps; // time steps taken: `step` long, or cut short by an event or a stop
    double start_energy; // kinetic and strain energy at the start [J]
    double tstop;      // where a step ends early, as it was before [s]; HUGE_VAL: nowhere
    double pulse_peak; // largest f since the last impact or touch, -1 if none [N]
    double pulse_peak_time;     // [s]
    double largest_penetration; // [m]
    double overheld; // largest friction torque beyond stiction that held the hub [N m]
} motion_record;

// The step that was taken last and the one to come. Nothing of it is kept with a state.
typedef struct motion_steps {
    double last; // length of the last step, up to its end as the engine located it [s]
    double aim; // instant where a state is wanted, if it is to be met to the last bit [s]

    // energies of m->trial, and of m->state as motion_step left it, if the engine
    // computed them with the state; else unknown_energy
    state_energy trial_energy, energy;
    bool history_invalid; // the step in hand may be another arm's: only what the state
                          // keeps of it is valid

    // the coming step, if motion_examine_step has examined it
    struct {
        bool known;
        bool begun;   // else it cannot be made
        step_end end; // its own, tstop or the first event
    } coming;
} motion_steps;

// Coefficients of the implicit methods (implicit_stepper.c) [-].
typedef struct implicit_coefficients {
    double alpha_m, alpha_f, beta, gamma;
} implicit_coefficients;

struct motion {
    // A checkpoint is a copy of `state`, size doubles: slots, q[n], w[n], quadratures,
    // accelerations a[n], algorithmic accelerations[n], what is kept of the internal
    // step.
    double *state;
    int size;      // of this engine's states
    int most_size; // of the states of any engine that a changed arm may get
    int head_size; // without what only some engines keep
    int dof;
    int link_count;

    // how the smooth motion is advanced
    const engine *engine;
    bool chosen;         // by the caller: it stays when the arm changes
    double nominal_step; // method.step [s]
    double tolerance;    // method.tolerance, of the stiff engine's steps [-]
    bool wall_gives;     // contact is no constraint
    bool wall_has_face;  // contact ties the arm to a mass on a spring
    bool electric;       // the motor's current is followed
    bool wall_moves;     // nothing rests for long
    bool wall_is_shaken; // and shakes a face with a mass
    bool out_of_memory;  // no memory for the engine that a changed arm asks for
    implicit_coefficients implicit; // of an implicit engine

    // scratch, nothing of it outlives a step
    double *trial;   // state at the end of the step tried; after it, at the step's start
    double *between; // states within the last step: MOTION_TOGETHER of a dense engine,
                     // else one
    double *scratch; // vectors of length dof
    chain_link *links;
    arm *moved;   // the arm with its wall at an instant, where that moves, else NULL
    void *memory; // the engine's own: the internal step it is in
    double
        most_force; // upper bound of the force in the internal step of a dense engine [N]
    motion_steps step; // the last one and the coming one

    void *block, *engine_block; // where all of that lies
    size_t engine_length;       // of the latter [bytes]

    motion_record record; // that a copy of the state continues with
    double failure_time;  // instant from which a step failed [s]
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
    return (contact_state){state[SLOT_CONTACT] != 0,
                           (hub_friction)(int)state[SLOT_FRICTION]};
}

// The wall's face of a state, at rest in place where the wall is rigid.
static inline wall_face state_face(const double *state)
{
    return (wall_face){state[SLOT_FACE], state[SLOT_FACE_VELOCITY]};
}

// Whether that face moves on its own.
static inline bool state_face_swings(const motion *m, const double *state)
{
    const bool moved = state[SLOT_FACE] != 0 || state[SLOT_FACE_VELOCITY] != 0;
    return state[SLOT_CONTACT] == 0 && (moved || m->wall_is_shaken);
}

// Gap to where the wall's face stands at rest [m], and its rate [m/s].
static inline value_and_slope state_rest_gap(const double *state)
{
    const wall_face face = state[SLOT_CONTACT] != 0 ? (wall_face){0} : state_face(state);
    return (value_and_slope){state[SLOT_GAP] - face.position,
                             state[SLOT_GAP_VELOCITY] - face.velocity};
}

// Bounds of a contact force [N].
typedef struct force_bounds {
    double low, high;
} force_bounds;

// The forces with which friction can hold one link on a rigid hub at rest in an evaluated
// state: f
// >= 0 with |T - J f| <= kst, T the torque of motor and weight and J = dg/dq.
force_bounds motion_held_forces(const arm *a, const motion *m, double *state);

// The bounds of the contact force in an evaluated state, both the force itself where it
// is determined. It is not for one link on a rigid hub that rests on a rigid wall: wall
// and friction hold it both, with any of the forces above. The state's own is that
// without friction, T/J.
force_bounds motion_force_bounds(const arm *a, const motion *m, double *state);

// To be called after m->state was overwritten by a copy of an earlier state, even if the
// arm changed in between.
static inline void motion_invalidate_history(motion *m)
{
    m->step.history_invalid = true;
    m->step.coming.known = false;
}

// To be called after a change, other than a jump of the state, of anything that an
// internal step depends on: the motion then begins a new internal step.
static inline void motion_end_internal_step(motion *m)
{
    state_kept(m, m->state)[KEPT_LENGTH] = 0;
}

// To be called where the motor's torque or the arm changes: the interval between changes
// tells engines how soon the next one may come.
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
void motion_reset_peak(motion *m);

// Records a force [N] in contact at an instant [s] as the pulse's peak if none was
// larger.
static inline void motion_note_force(motion *m, double time, double force)
{
    if (force > m->record.pulse_peak) {
        m->record.pulse_peak = force;
        m->record.pulse_peak_time = time;
    }
}

// The arm with a wall that moves where it is at an instant [s]; good until the next call.
// `a` itself where it does not.
const arm *motion_arm_at(const arm *a, motion *m, double time);

// Evaluates accelerations, reactions and gap of a state in its own contact state.
void motion_evaluate(const arm *a, motion *m, double *state);

// Whether contact constrains the arm rigidly: the wall does not give and its face has no
// mass.
static inline bool motion_wall_is_rigid(const motion *m)
{
    return !m->wall_gives && !m->wall_has_face;
}

// Whether contact and friction together lock the arm, and nothing else (face, current)
// can change.
static inline bool state_is_held_still(const motion *m, const double *state)
{
    // a sliding hub is the usual case
    if ((state[SLOT_FRICTION] != HUB_STICK && m->dof > 1) || m->dof > 2 || m->electric ||
        m->wall_moves) {
        return false;
    }
    const contact_state now = contact_state_of(state);
    const bool stuck = now.friction == HUB_STICK,
               held = now.contact && motion_wall_is_rigid(m);
    if (state_face_swings(m, state)) {
        return false;
    }
    if (m->dof == 1) {
        return stuck || held;
    }
    return stuck && held;
}
static inline bool motion_held_still(const motion *m)
{
    return state_is_held_still(m, m->state);
}

// Computes the state at h in the internal step in hand, as much of it as `extent` says,
// into m->trial, updates its energy ledger and checks that it is finite. Stepping engines
// need no internal step: they step from m->state.
status motion_try_step(const arm *a, motion *m, double h, state_extent extent);

// A quantity of the internal step of a dense engine, and its slope, at h.
static inline value_and_slope motion_output(const arm *a, motion *m, output_quantity of,
                                            double h)
{
    value_and_slope at;
    m->engine->dense_output(a, m, of, h, h, 0, &at);
    return at;
}

// Computes the states at `count` instants [s], at most MOTION_TOGETHER, within the step
// just made, which left its start in m->trial: one after the other into m->between, and
// the energy of each. False if the engine has no states_at, if the arm was held still
// during the step, or if a state is not finite: then motion_between of contact_machine.h
// gives them one by one.
bool motion_between_all(const arm *a, motion *m, const double *times, int count,
                        state_energy *energies);

// Puts an evaluated state in contact back onto the constraint, position and velocity,
// along M^-1 J^T: the nearest admissible state in the metric of the kinetic energy.
// Evaluates it again if that moved it, and says whether it did.
bool motion_project(const arm *a, motion *m, double *state);

// Amplification of rounding errors in accelerations, at least 1, the value of a slow soft
// arm: a spring of stiffness k between bodies of inertia I turns an error in the last bit
// of an angle q into an acceleration error of (k/I) q 2^-52, where k/I is at most the
// square of the arm's highest frequency; and what turns at w has accelerations of w^2,
// with an error in their last bit.
double motion_rounding(const arm *a, const motion *m);
// What the force on a wall's face with a mass errs by: its spring times the rounding of
// its place [N]; 0 without such a face.
double motion_face_rounding(const arm *a, const motion *m);

// That of a moving wall's acceleration, by the instant's, in the same measure.
double motion_wall_rounding(const arm *a, const motion *m);
// What counts as rounding of the gap just after an event, and of its first and second
// derivatives by time (edge_limits.h) [m], [m/s], [m/s2].
void motion_gap_edges(const arm *a, const motion *m, double limits[3]);
// motion_rounding for dof angles q [rad] and velocities w [rad/s].
double motion_rounding_at(const arm *a, int dof, const double *q, const double *w);

// Whether the motion's steps are those of an implicit method.
static inline bool motion_is_implicit(const motion *m)
{
    return m->engine->implicit;
}

// Whether the motion's steps are too long to resolve the arm's fastest modes, as with
// many links.
static inline bool motion_unresolved(const arm *a, const motion *m)
{
    return motion_is_implicit(m) && m->nominal_step * a->fastest_rate > 1;
}

// Work of the motor's torque up to a state of this motion [J].
static inline double motion_motor_work(const motion *m, double *state)
{
    return state[SLOT_MOTOR_WORK] + state_quadratures(m, state)[QUADRATURE_MOTOR];
}

// Fastest rate at which the force can change in a state of this motion [1/s]: by the
// arm's fastest vibration, the wall or the motor's inductance. Decays of the arm are left
// out.
double motion_vibration(const arm *a, motion *m, double *state);

// Length [s] over which a parabola represents the decaying part of the force on a damped
// chain, `since` [s] after the event that excited it. At least `reach` / (fastest rate of
// the arm), else in proportion to `since`: what has not decayed by then changes slowly.
double motion_decay_length(const arm *a, double reach, double since);

// Energy that a wall that gives holds, with that of its face's motion; 0 in a rigid one
// [J].
static inline double motion_wall_energy(const arm *a, const motion *m,
                                        const double *state)
{
    if (motion_wall_is_rigid(m)) {
        return 0;
    }
    const wall_model wall = wall_at(&a->wall, state[SLOT_TIME]);
    return wall_face_energy(&wall, state_face(state));
}

// The same with what the weight has gained since the start in a tilted plane [J].
static inline double motion_held_energy(const arm *a, const motion *m, double *state)
{
    double weight = 0;
    if (a->amount.gravity != 0) {
        weight =
            chain_weight_energy(a, state_angles(m, state)) - state[SLOT_START_WEIGHT];
    }
    return motion_wall_energy(a, m, state) + weight;
}

// Energy of motion and of bending in a state of this motion.
state_energy motion_energy(const arm *a, const motion *m, double *state);

// Residual of the energy balance at a state of this motion [J]: what the ledger of works
// and losses does not account for.
double motion_energy_residual(const arm *a, const motion *m, double *state);

// The same if the energy of the state is known already: kinetic and strain energy and
// what motion_held_energy says [J].
static inline double motion_unaccounted(const motion *m, double *state, double energy)
{
    const double *quadrature = state_quadratures(m, state);
    const double stored = energy - m->record.start_energy;
    const double work = motion_motor_work(m, state) + state[SLOT_EXTERNAL_WORK] +
                        quadrature[QUADRATURE_PUSHED];
    const double lost = state[SLOT_FRICTION_LOSS] + state[SLOT_IMPACT_LOSS] +
                        quadrature[QUADRATURE_VISCOUS] + quadrature[QUADRATURE_DAMPING] +
                        quadrature[QUADRATURE_WALL];
    return stored + lost - work;
}
