// The contact machine: an arm in free flight or on its wall, its hub stuck or sliding.
//
// Between events motion_step() moves the arm in one contact state; it ends a step at the
// first event, just beyond it. motion_apply() then takes the transition:
//
//                   gap closes:  impact() at a speed, touch without
//     motion_start  +--------+ --------------------------> +---------+
//     ------------> |  FREE  |                             | CONTACT | --+  impact():
//               +-> |        | <-------------------------- |         | <-+  motion_push()
//               into |   +--------+   force falls below zero:   +---------+      the wall
//               |       |               release()
//               +-------+
//          impact() that rebounds
//
//                     hub comes to rest:  stick()
//         +---------+ --------------------------> +-------+
//     +-- | SLIDING |                             | STUCK |      SLIDING is forwards or
//     backwards
//     +-> |         | <-------------------------- |       |
//         +---------+  torque beyond stiction:    +-------+
//       stick() where        slip()
//       nothing holds it
//
// The two are coupled: an impact may set a stuck hub sliding, a hub that sticks may lift
// the arm off. So each transition sets only what the event itself determines (a velocity,
// that the wall is touched) and leaves the rest to contact_resolve(), which finds the one
// pair of states that violates no condition. The calls from outside, motion_push(),
// motion_retorque() and motion_rebind(), end in contact_resolve() too. Where steps do not
// resolve the fastest modes, accelerations at an instant carry no information: release(),
// stick() and slip() then take the state that the event suggests, and the next step
// corrects it.
//
// A wall that gives has a face, which goes with the arm in contact and moves on its own
// while the arm is free (motion_try_step); gap and speed are those to the face. One with
// a mass is met as a rigid wall is, by impact() and release(). One without imposes no
// constraint and causes no impact: there a touch begins the contact at any speed, and
// release() ends it where the law's force falls to zero. Behind its place at rest a
// damped face cannot follow then, and returns at its own rate (wall.h).
//
// After every transition hold:
//
//   1  contact is 0 or 1; friction is one of stuck, forwards, backwards
//   2  without a wall there is no contact
//   3  without contact there is no force
//   4  a stuck hub does not turn
//   5  a hub with friction does not slide against the direction its friction is for
//   6  an arm that contact and friction hold still is at rest
//   7  an impact never increases the energy
//
// 4 to 6 need not hold while an impact is yet to be delivered by the next step
// (SLOT_IMPULSE).
#include "src/contact/contact_machine.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/arm/forces.h"
#include "src/arm/impact.h"
#include "src/contact/locate.h"

// a flight shorter than this share of the arm's shortest period is a short one
#define SHORT_FLIGHT 0.01
#define SAME_PLACE   1e-12 // gap to a wall that is only rounding [m]

// --- a face that is left ---------------------------------------------------------------

// Makes the arm leave the face of a wall that gives; the face returns by itself. If it
// returns at once, a damper takes up at once the energy that wall and face held.
static void leave_face(const arm *a, motion *m)
{
    double *state = m->state;
    const double held = motion_wall_energy(a, m, state);
    const wall_face face = wall_face_left_behind(&a->wall, state[SLOT_FACE]);
    state[SLOT_FACE] = face.position;
    state[SLOT_FACE_VELOCITY] = face.velocity;
    if (a->wall.damping > 0) {
        state_quadratures(m, state)[QUADRATURE_WALL] +=
            held - motion_wall_energy(a, m, state);
    }
}

// Whether an arm on the face of a wall that gives still presses on the face after the
// arm's velocity or the wall's law changed. If it does not, it leaves the face.
static bool face_follows(const arm *a, motion *m)
{
    const penetration at =
        chain_penetration(a, state_angles(m, m->state), state_velocities(m, m->state));
    const bool follows = wall_normal_force(&a->wall, at.depth, at.rate) >= 0;
    if (!follows) {
        leave_face(a, m);
    }
    return follows;
}

// --- the transitions -------------------------------------------------------------------

// Counts flights that are too short for arm or face to change in them, and returns
// whether the chatter rule applies to this impact: after more than
// MOTION_MOST_SHORT_FLIGHTS in a row, if without a rebound it loses a negligible share of
// the energy that arm and face hold. `result` is that of the impact with the restitution
// e. The flights of a rigid link are never short, as it has no period; its only motion is
// the bounces.
static bool chatters(const arm *a, motion *m, const impact_result *result, double e)
{
    // whether the flight that this impact ends was short
    double *state = m->state;
    double flight = state[SLOT_TIME] - state[SLOT_LAST_IMPACT];
    double fastest = a->highest_frequency;
    if (m->wall_has_face) {
        fastest = fmax(fastest, sqrt(a->wall.stiffness / a->wall.face_mass));
    }
    bool is_short =
        state[SLOT_LAST_IMPACT] >= 0 && flight * fastest < SHORT_FLIGHT * 2 * M_PI;
    if (is_short) {
        state[SLOT_SHORT_FLIGHTS] = state[SLOT_SHORT_FLIGHTS] + 1;
    } else {
        state[SLOT_SHORT_FLIGHTS] = 0;
    }
    state[SLOT_LAST_IMPACT] = state[SLOT_TIME];
    if (!(state[SLOT_SHORT_FLIGHTS] > MOTION_MOST_SHORT_FLIGHTS)) {
        return false;
    }

    // the loss without a rebound is speed times impulse / 2, of the impulse for e = 0
    const state_energy own = motion_energy(a, m, state);
    const double held = own.kinetic + own.strain + motion_wall_energy(a, m, state);
    return 0.5 * result->speed * result->impulse / (1 + e) < MOTION_CHATTER_SHARE * held;
}

// The jump of an impact, and the contact state after it. Slower than the rest speed, or
// by the chatter rule, it is plastic: a sequence of ever smaller bounces ends in contact.
static void impact(const arm *a, motion *m, motion_report *report)
{
    double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    double *increment = m->scratch;
    const double face = m->state[SLOT_FACE_VELOCITY];

    // the jump of an instantaneous impact, with the wall's coefficient of restitution or
    // without
    double e = wall_restitution(&a->wall, chain_penetration(a, q, w).rate - face);
    impact_result result =
        impact_velocity_increments(a, m->links, q, w, face, e, increment);
    if (chatters(a, m, &result, e)) {
        m->state[SLOT_SHORT_FLIGHTS] = 0;
        report->chatter = e > 0;
        e = 0;
        result = impact_velocity_increments(a, m->links, q, w, face, e, increment);
    }
    report->speed = result.speed;
    report->impulse = result.impulse;
    report->loss = result.loss;
    assert(!(result.loss < 0)); // 7

    m->state[SLOT_CONTACT] = 1;
    if (motion_unresolved(a, m) && e == 0 && !motion_held_still(m)) {
        // the impact happens within the next step, whose own damping takes the loss
        // (after Moreau)
        m->state[SLOT_FORCE] = 0;
        m->state[SLOT_IMPULSE] = result.impulse;
        m->state[SLOT_JUMPED] = 1;
        return;
    }

    m->state[SLOT_IMPACT_LOSS] += result.loss;
    state_quadratures(m, m->state)[QUADRATURE_PUSHED] += result.work;
    for (int i = 0; i < m->dof; i++) {
        w[i] += increment[i];
    }
    if (m->wall_has_face) {
        m->state[SLOT_FACE_VELOCITY] += result.impulse / a->wall.face_mass;
    }
    contact_resolve(a, m, e == 0, MOTION_IMPACT);
}

// The wall would have to pull: the arm leaves it.
static void release_contact(const arm *a, motion *m)
{
    if (motion_unresolved(a, m)) {
        m->state[SLOT_CONTACT] = m->state[SLOT_FORCE] = 0;
        m->state[SLOT_JUMPED] = 1;
    } else if (m->wall_gives) {
        leave_face(a, m);
        contact_resolve(a, m, false, MOTION_REACHED);
    } else {
        contact_resolve(a, m, true, MOTION_RELEASE);
    }
}

// The hub comes to rest: friction holds it, or it turns back.
static void stick(const arm *a, motion *m)
{
    const bool contact = m->state[SLOT_CONTACT] != 0;
    state_velocities(m, m->state)[0] = 0;
    if (contact && motion_unresolved(a, m)) {
        m->state[SLOT_FRICTION] = HUB_STICK;
        m->state[SLOT_JUMPED] = 1;
    } else {
        contact_resolve(a, m, contact, MOTION_STICK);
    }
}

// The stuck hub breaks away.
static void slip(const arm *a, motion *m)
{
    double *state = m->state;
    if (motion_unresolved(a, m)) {
        // it slides against the friction that held it
        if (state[SLOT_FRICTION_TORQUE] < 0) {
            state[SLOT_FRICTION] = HUB_FORWARD;
            state[SLOT_FRICTION_TORQUE] = -a->motor.stiction;
        } else {
            state[SLOT_FRICTION] = HUB_BACKWARD;
            state[SLOT_FRICTION_TORQUE] = a->motor.stiction;
        }
        state[SLOT_JUMPED] = 1;
    } else {
        contact_resolve(a, m, state[SLOT_CONTACT] != 0, MOTION_SLIP);
    }
}

void motion_apply(const arm *a, motion *m, motion_report *report)
{
    a = motion_arm_at(a, m, m->state[SLOT_TIME]);

    // the transition that belongs to the event
    switch (report->event) {
    case MOTION_REACHED:
        return;
    case MOTION_IMPACT:
        impact(a, m, report);
        break;
    case MOTION_TOUCH:
        // without speed, or on a wall that gives at any speed
        contact_resolve(a, m, true, MOTION_TOUCH);
        break;
    case MOTION_RELEASE:
        release_contact(a, m);
        break;
    case MOTION_STICK:
        stick(a, m);
        break;
    case MOTION_SLIP:
        slip(a, m);
        break;
    }

    // what holds after each of them; a gap of rounding is no force that pulls
    if (!motion_wall_is_rigid(m)) {
        m->state[SLOT_FORCE] = fmax(m->state[SLOT_FORCE], 0);
    }
    report->holds = m->state[SLOT_CONTACT] != 0;
    contact_check(a, m);
}

// --- from outside ----------------------------------------------------------------------

void motion_start_at(const arm *a, motion *m, const double *angles,
                     const double *velocities, double current)
{
    a = motion_arm_at(a, m, 0);
    memset(m->state, 0, (size_t)m->size * sizeof(double));
    double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    memcpy(q, angles, (size_t)m->dof * sizeof *q);
    memcpy(w, velocities, (size_t)m->dof * sizeof *w);
    state_quadratures(m, m->state)[QUADRATURE_CURRENT] = current;

    m->state[SLOT_LAST_IMPACT] = -1;
    m->state[SLOT_START_WEIGHT] = chain_weight_energy(a, q);
    m->record.start_energy = chain_kinetic_energy(a, q, w) + chain_strain_energy(a, q);
    m->record.steps = 0;
    m->record.largest_penetration = m->record.overheld = 0;
    motion_reset_peak(m);

    // an arm on a rigid wall or a face, at rest, that moves into it counts as free until
    // the impact that follows immediately; a gap of rounding is none
    const penetration at = chain_penetration(a, q, w);
    const bool closed = at.depth >= -START_ROUNDING * a->links * a->link_length;
    const bool stays = at.rate == 0 || (m->wall_gives && at.rate > 0);
    const bool touching = closed && stays;
    contact_resolve(a, m, touching, MOTION_REACHED);
    m->record.start_energy +=
        motion_wall_energy(a, m, m->state); // of a depth by rounding
}

void motion_start(const arm *a, motion *m, double angle, double velocity)
{
    assert(isfinite(angle) && isfinite(velocity));
    double *q = m->scratch, *w = m->trial;
    for (int i = 0; i < m->dof; i++) {
        q[i] = angle;
        w[i] = velocity;
    }
    motion_start_at(a, m, q, w, 0);
}

void motion_push(const arm *a, motion *m, double impulse, motion_report *report)
{
    assert(isfinite(impulse));
    a = motion_arm_at(a, m, m->state[SLOT_TIME]);
    double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    bool contact = m->state[SLOT_CONTACT] != 0;
    double *response = m->scratch, before = chain_kinetic_energy(a, q, w);

    *report = (motion_report){.event = MOTION_REACHED};
    chain_tip_response(a, m->links, q, response);
    for (int i = 0; i < m->dof; i++) {
        w[i] += impulse * response[i];
    }
    m->state[SLOT_EXTERNAL_WORK] += chain_kinetic_energy(a, q, w) - before;

    // in contact the wall takes up the part of the push that is directed into it
    if (m->wall_gives) {
        contact_resolve(a, m, contact && face_follows(a, m), MOTION_REACHED);
    } else {
        const double speed =
            chain_penetration(a, q, w).rate - m->state[SLOT_FACE_VELOCITY];
        if (contact && speed > TOUCH_SPEED) {
            report->event = MOTION_IMPACT;
            impact(a, m, report);
        } else {
            // a speed that is only rounding causes neither an impact nor a release
            contact_resolve(a, m, contact && speed >= -TOUCH_SPEED, MOTION_REACHED);
        }
    }
    report->holds = m->state[SLOT_CONTACT] != 0;
}

void motion_retorque(const arm *a, motion *m, double before)
{
    if (motion_unresolved(a, m)) {
        return; // an instant's accelerations say nothing: the next step finds out
    }
    motion_note_change(m);

    // a stuck hub: friction takes up what the motor does, the rest stays
    double *state = m->state;
    const bool sticks = contact_state_of(state).friction == HUB_STICK;
    double friction = state[SLOT_FRICTION_TORQUE] - (a->motor.torque - before);
    if (sticks && !m->electric && m->dof > 1 &&
        fabs(friction) < a->motor.stiction * (1 - 1e-9)) {
        state[SLOT_FRICTION_TORQUE] = friction;
        motion_end_internal_step(m); // that was with the other torque
        return;
    }

    // a moving hub keeps sliding in its direction, unless the contact is lost
    bool moves = !sticks && state_velocities(m, state)[0] != 0;
    if (moves && m->engine->retorque != NULL) {
        m->engine->retorque(a, m, a->motor.torque - before);
    } else {
        motion_evaluate(a, m, state);
    }
    if (!moves || (state[SLOT_CONTACT] != 0 && state[SLOT_FORCE] <= 0)) {
        contact_resolve(a, m, state[SLOT_CONTACT] != 0, MOTION_REACHED);
        return;
    }
    memcpy(state_algorithmic(m, state), state_accelerations(m, state),
           (size_t)m->dof * sizeof(double));
    state[SLOT_JUMPED] = 1;
}

double motion_gap_with(const arm *a, motion *m)
{
    a = motion_arm_at(a, m, m->state[SLOT_TIME]);
    return m->state[SLOT_FACE] -
           chain_penetration(a, state_angles(m, m->state), state_velocities(m, m->state))
               .depth;
}

void motion_rebind(const arm *before, const arm *after, motion *m)
{
    assert(after->dof == m->dof);
    const double *q = state_angles(m, m->state);
    motion_note_change(m);

    // the energy that other springs hold at these angles came from outside
    m->state[SLOT_EXTERNAL_WORK] +=
        chain_strain_energy(after, q) - chain_strain_energy(before, q);
    const bool turned = after->wall.cosine != before->wall.cosine ||
                        after->wall.sine != before->wall.sine;

    // a wall that was turned away from the arm ends the contact
    bool contact = m->state[SLOT_CONTACT] != 0;
    if (contact && turned && motion_gap_with(after, m) > SAME_PLACE) {
        contact = false;
        if (m->wall_gives) {
            leave_face(after, m);
        }
    }
    after = motion_arm_at(after, m, m->state[SLOT_TIME]);
    contact_resolve(after, m, contact && (!m->wall_gives || face_follows(after, m)),
                    MOTION_REACHED);
}
