#include "src/contact/motion.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/sincos.h"
#include "src/contact/edge_limits.h"

// The remainders of decays change little within this share of the time since the event.
#define GRADING 0.2

// Drift from the contact constraint beyond which a state is projected back onto it.
#define PROJECTION_GAP  1e-14 // [m]
#define PROJECTION_RATE 1e-13 // [m/s]

// A link that friction holds so near the wall rests on it [m].
#define RESTING_GAP 1e-12

// A few units in the last place of an acceleration, relative to 1e-9, which counts as
// zero in a slow soft arm.
#define LAST_BITS 4e-4

const arm *motion_arm_at(const arm *a, motion *m, double time)
{
    if (m->moved == NULL) {
        return a;
    }
    if (a != m->moved) {
        *m->moved = *a;
    }
    m->moved->wall.shift = wall_motion_at(&a->wall.motion, time);
    return m->moved;
}

void motion_evaluate(const arm *a, motion *m, double *state)
{
    a = motion_arm_at(a, m, state[SLOT_TIME]);
    chain_reaction r;
    contact_state mode = contact_state_of(state);
    mode.current = state_quadratures(m, state)[QUADRATURE_CURRENT];
    chain_accelerations(a, m->links, state_angles(m, state), state_velocities(m, state),
                        mode, state_accelerations(m, state), &r);
    state[SLOT_MOTOR_TORQUE] = r.motor_torque;
    state[SLOT_FORCE] = r.force;
    state[SLOT_FRICTION_TORQUE] = r.friction;
    state[SLOT_GAP_ACCELERATION] = r.gap_acceleration;
    state[SLOT_GAP] = r.gap;
    state[SLOT_GAP_VELOCITY] = r.gap_velocity;
    state[SLOT_VISCOUS_POWER] = r.viscous_power;
    state[SLOT_DAMPING_POWER] = r.damping_power;
    state[SLOT_WALL_POWER] = r.wall_power;
    state[SLOT_WALL_WORK] = r.wall_work;

    // In contact the wall's face moves with the arm. A face that swings by itself is not
    // where the wall stands at rest: the gap is that to the face.
    if (mode.contact && !motion_wall_is_rigid(m)) {
        state[SLOT_FACE] = -r.gap;
        state[SLOT_FACE_VELOCITY] = -r.gap_velocity;
    } else if (state_face_swings(m, state)) {
        const wall_face face = state_face(state);
        state[SLOT_GAP] += face.position;
        state[SLOT_GAP_VELOCITY] += face.velocity;
        state[SLOT_GAP_ACCELERATION] += wall_face_acceleration(&a->wall, face);
    }
}

force_bounds motion_held_forces(const arm *a, const motion *m, double *state)
{
    assert(m->dof == 1 && wall_stands(&a->wall));
    const double one = 1, *q = state_angles(m, state),
                 lever = chain_penetration_rate(a, q, &one);
    double weight = 0;
    if (a->amount.gravity != 0) {
        weight = chain_weight(a, 0) * inline_cos(q[0]);
    }
    const double balanced = (a->motor.torque + state[SLOT_MOTOR_TORQUE] - weight) / lever;
    const double friction = a->motor.stiction / fabs(lever);
    return (force_bounds){larger(balanced - friction, 0), larger(balanced + friction, 0)};
}

force_bounds motion_force_bounds(const arm *a, const motion *m, double *state)
{
    const contact_state now = contact_state_of(state);
    const bool single =
        m->dof == 1 && !m->wall_moves && wall_stands(&a->wall) && motion_wall_is_rigid(m);
    const bool held_near = state[SLOT_GAP] <= RESTING_GAP && now.friction == HUB_STICK;
    const bool rests =
        single && state_velocities(m, state)[0] == 0 && (now.contact || held_near);
    if (rests) {
        return motion_held_forces(a, m, state);
    }
    return (force_bounds){state[SLOT_FORCE], state[SLOT_FORCE]};
}

void motion_reset_peak(motion *m)
{
    m->record.pulse_peak = -1;
    m->record.pulse_peak_time = m->state[SLOT_TIME];
}

double motion_rounding(const arm *a, const motion *m)
{
    return motion_rounding_at(a, m->dof, state_angles(m, m->state),
                              state_velocities(m, m->state));
}

double motion_face_rounding(const arm *a, const motion *m)
{
    if (m->wall_has_face) {
        return EDGE_PLACE * a->wall.stiffness;
    }
    return 0;
}

double motion_wall_rounding(const arm *a, const motion *m)
{
    double terms[4];
    const double time = m->state[SLOT_TIME],
                 since = fabs(time) + fabs(a->wall.motion.time);
    wall_motion_series(&a->wall.motion, time, 4, terms);
    return LAST_BITS * fabs(terms[1]) * since;
}

void motion_gap_edges(const arm *a, const motion *m, double limits[3])
{
    // Rounding errors of the contact force, and of the face's spring force, accelerate a
    // face by that error divided by its mass. A face without a mass returns at a rate
    // times its place, and so carries the rounding error of the place where it was left.
    const bool returns = m->wall_gives && state_face_swings(m, m->state);
    double rate = 0, inverse_mass = 0;
    if (returns) {
        rate = wall_face_rate(&a->wall, state_face(m->state));
    }
    if (m->wall_has_face) {
        inverse_mass = 1 / a->wall.face_mass;
    }
    limits[0] = EDGE_GAP;
    limits[1] = EDGE_RATE + EDGE_PLACE * rate;
    limits[2] = EDGE_RATE * (motion_rounding(a, m) + inverse_mass) +
                EDGE_PLACE * rate * rate + inverse_mass * motion_face_rounding(a, m);
    limits[2] = fmax(EDGE_MORE, limits[2]);
}

double motion_rounding_at(const arm *a, int dof, const double *q, const double *w)
{
    double angle = 0, rate = 0;
    for (int i = 0; i < dof; i++) {
        angle = larger(fabs(q[i]), angle);
        rate = larger(fabs(w[i]), rate);
    }
    return 1 + LAST_BITS *
                   (a->highest_frequency * a->highest_frequency * angle + rate * rate);
}

double motion_decay_length(const arm *a, double reach, double since)
{
    return fmax(GRADING * since, reach / fmax(a->highest_frequency, a->fastest_decay));
}

// How much a unit force of a wall that gives accelerates the gap in contact [1/kg].
static double wall_compliance(const arm *a, motion *m, double *state)
{
    a = motion_arm_at(a, m, state[SLOT_TIME]);
    const bool locked = contact_state_of(state).friction == HUB_STICK && m->dof > 1;
    const double compliance =
        chain_contact_response(a, m->links, state_angles(m, state), locked, m->scratch);
    return compliance / (1 + a->wall.face_mass * compliance); // both masses on the spring
}

// Fastest rate (frequency or decay) of the arm on a wall that gives, or of a face left
// alone, in a state of this motion [1/s]; 0 for other walls.
static double fastest_wall_rate(const arm *a, motion *m, double *state)
{
    if (motion_wall_is_rigid(m) || !contact_state_of(state).contact) {
        const wall_model wall = wall_at(&a->wall, state[SLOT_TIME]);
        if (state_face_swings(m, state)) {
            return wall_face_rate(&wall, state_face(state));
        }
        return 0;
    }
    return wall_rate(&a->wall, wall_compliance(a, m, state), fmax(-state[SLOT_GAP], 0),
                     -state[SLOT_GAP_VELOCITY]);
}

double motion_vibration(const arm *a, motion *m, double *state)
{
    // most arms have no rates but those of their joints
    if (motion_wall_is_rigid(m) && a->amount.stiffening == 0 &&
        a->motor.inductance == 0) {
        return a->highest_frequency;
    }
    const double wall = fastest_wall_rate(a, m, state);
    double current = 0;
    if (a->motor.inductance > 0) {
        current = a->motor.resistance / a->motor.inductance;
    }
    const double arm_rate =
        a->highest_frequency * chain_stiffened(a, state_angles(m, state));
    if (wall > 0 || current > 0) {
        return sqrt(arm_rate * arm_rate + wall * wall + current * current);
    }
    return arm_rate;
}

state_energy motion_energy(const arm *a, const motion *m, double *state)
{
    const double *q = state_angles(m, state), *w = state_velocities(m, state);
    return (state_energy){chain_kinetic_energy(a, q, w), chain_strain_energy(a, q)};
}

double motion_energy_residual(const arm *a, const motion *m, double *state)
{
    const state_energy has = motion_energy(a, m, state);
    const double energy = has.kinetic + has.strain;
    return motion_unaccounted(m, state, energy + motion_held_energy(a, m, state));
}

// --- a step of smooth motion -----------------------------------------------------------

bool motion_project(const arm *a, motion *m, double *state)
{
    const bool locked = contact_state_of(state).friction == HUB_STICK && m->dof > 1;
    const bool drifted = !(fabs(state[SLOT_GAP]) <= PROJECTION_GAP &&
                           fabs(state[SLOT_GAP_VELOCITY]) <= PROJECTION_RATE);
    if ((m->dof == 1 && !m->wall_moves) || !drifted) {
        return false;
    }
    a = motion_arm_at(a, m, state[SLOT_TIME]);
    double *response = m->scratch, *q = state_angles(m, state),
           *w = state_velocities(m, state);
    const double compliance = chain_contact_response(a, m->links, q, locked, response);

    // position first, then velocity at the new position
    double shift = -state[SLOT_GAP] / compliance; // g = -gap falls along the response
    for (int i = 0; i < m->dof; i++) {
        q[i] += shift * response[i];
    }
    const double jump = chain_penetration(a, q, w).rate / compliance;
    for (int i = 0; i < m->dof; i++) {
        w[i] += jump * response[i];
    }
    motion_evaluate(a, m, state);
    return true;
}

// Sets the parts of a state that need no evaluation, from those of the state `from`, a
// time h earlier: the slots, the quadratures that stay the same, and the place and
// velocity of a wall's face that swings by itself.
static void set_slots(const arm *a, const motion *m, double *from, double h,
                      double *state)
{
    static const int unchanged[] = {QUADRATURE_WALL, QUADRATURE_CURRENT, QUADRATURE_MOTOR,
                                    QUADRATURE_PUSHED};
    memcpy(state, from, SLOT_COUNT * sizeof(double));
    state[SLOT_TIME] += h;
    state[SLOT_JUMPED] = state[SLOT_IMPULSE] = 0;
    for (size_t i = 0; i < sizeof unchanged / sizeof *unchanged; i++) {
        const int quadrature = unchanged[i];
        state_quadratures(m, state)[quadrature] = state_quadratures(m, from)[quadrature];
    }
    if (state_face_swings(m, from)) {
        const wall_model wall = wall_at(&a->wall, from[SLOT_TIME]);
        const wall_face face = wall_face_after(&wall, state_face(from), h);
        state[SLOT_FACE] = face.position;
        state[SLOT_FACE_VELOCITY] = face.velocity;
    }
}

// Adds to the energy ledger of an evaluated state what happened since an earlier state
// `from`: the work of motor and friction on the hub, and the work and losses of a wall's
// face that swings by itself.
static void update_energy_ledger(const arm *a, const motion *m, double *from,
                                 double *state)
{
    // the face loses what its energy and the work on it do not account for
    if (state_face_swings(m, from)) {
        const wall_model wall = wall_at(&a->wall, from[SLOT_TIME]);
        const double work =
            wall_face_work(&wall, state_face(from), state[SLOT_TIME] - from[SLOT_TIME]);
        state_quadratures(m, state)[QUADRATURE_PUSHED] += work;
        state_quadratures(m, state)[QUADRATURE_WALL] +=
            motion_wall_energy(a, m, from) + work - motion_wall_energy(a, m, state);
    }

    // constant torques on the hub work by the angle it turned
    const double turned = state_angles(m, state)[0] - state_angles(m, from)[0];
    state[SLOT_MOTOR_WORK] += a->motor.torque * turned;
    state[SLOT_FRICTION_LOSS] += state[SLOT_FRICTION] * a->motor.stiction * turned;
}

// Whether contact force, angles and velocities of a state are numbers: their sum is not
// finite if one of them is not.
static bool is_finite(const motion *m, double *state)
{
    double sum = state[SLOT_FORCE];
    for (int i = 0; i < 2 * m->dof; i++) {
        sum += state_angles(m, state)[i];
    }
    return isfinite(sum);
}

status motion_try_step(const arm *a, motion *m, double h, state_extent extent)
{
    double *trial = m->trial;
    m->step.trial_energy = unknown_energy;

    // in an arm that is held still only time passes
    if (motion_held_still(m)) {
        memcpy(trial, m->state, (size_t)m->size * sizeof *trial);
        trial[SLOT_TIME] += h;
        state_quadratures(m, trial)[QUADRATURE_FORCE] += h * m->state[SLOT_FORCE];
        return STATUS_OK;
    }

    // the engine's state at h; its ledger, unless the engine keeps one of its own
    set_slots(a, m, m->state, h, trial);
    TRY(m->engine->state_at(a, m, h, extent));
    if (m->engine->kept == 0) {
        update_energy_ledger(a, m, m->state, trial);
    }
    if (is_finite(m, trial)) {
        return STATUS_OK;
    }
    return STATUS_NOT_FINITE;
}

bool motion_between_all(const arm *a, motion *m, const double *times, int count,
                        state_energy *energies)
{
    assert(count >= 1 && count <= MOTION_TOGETHER);
    double *start = m->trial, *states[MOTION_TOGETHER], h[MOTION_TOGETHER];
    if (m->engine->states_at == NULL || state_is_held_still(m, start)) {
        return false;
    }

    // the engine evaluates all states together, from the step's start
    for (int i = 0; i < count; i++) {
        states[i] = m->between + i * m->size;
        h[i] = times[i] - start[SLOT_TIME];
        set_slots(a, m, start, h[i], states[i]);
    }
    m->engine->states_at(a, m, h, count, states, energies);

    // each gets its ledger and its time to the last bit
    bool finite = true;
    for (int i = 0; i < count; i++) {
        update_energy_ledger(a, m, start, states[i]);
        states[i][SLOT_TIME] = times[i];
        finite = finite && is_finite(m, states[i]);
    }
    return finite;
}
