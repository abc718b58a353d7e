#include "src/contact/contact_state.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/contact/locate.h"

#define AT_REST 1e-20 // velocities all of which are below it are rounding of rest [rad/s]

void contact_check(const arm *a, const motion *m)
{
    const double *state = m->state;
    const double friction = state[SLOT_FRICTION],
                 hub_velocity = state[SLOT_COUNT + m->dof];
    const bool contact = state[SLOT_CONTACT] != 0, settled = state[SLOT_IMPULSE] == 0;

    assert(state[SLOT_CONTACT] == 0 || state[SLOT_CONTACT] == 1); // 1
    assert(friction == HUB_STICK || friction == HUB_FORWARD ||
           friction == HUB_BACKWARD);                                             // 1
    assert(!contact || wall_stands(&a->wall));                                    // 2
    assert(contact || state[SLOT_FORCE] == 0);                                    // 3
    assert(!settled || friction != HUB_STICK || hub_velocity == 0);               // 4
    assert(!settled || a->motor.stiction == 0 || !(friction * hub_velocity < 0)); // 5
    assert(!settled || !motion_held_still(m) || hub_velocity == 0);               // 6
    (void)a, (void)friction, (void)hub_velocity, (void)contact, (void)settled;
}

// By how much an evaluated state violates the conditions of its contact state: the
// largest of a wall that pulls, an acceleration into the wall that is just touched and
// counts as left, friction beyond stiction, and an acceleration of a hub at rest against
// the direction in which it is taken to slide. 0 if it violates none.
static double violation(const arm *a, const motion *m, const double *state, bool touching,
                        bool hub_rests)
{
    contact_state now = contact_state_of(state);
    double worst = 0;

    // the wall: no tension, no acceleration into it
    if (now.contact && !m->wall_gives) {
        worst = fmax(worst, -state[SLOT_FORCE]);
    } else if (touching && !m->wall_gives) {
        // for a face of less than 1 kg, the force on it: its acceleration would amplify
        // the force's rounding error
        const double mass = m->wall_has_face ? fmin(a->wall.face_mass, 1) : 1;
        worst = fmax(worst, -state[SLOT_GAP_ACCELERATION] * mass);
    }

    // the hub: within stiction, or sliding the way it was taken to
    if (now.friction == HUB_STICK) {
        worst = fmax(worst, fabs(state[SLOT_FRICTION_TORQUE]) - a->motor.stiction);
    } else if (hub_rests) {
        worst = fmax(worst,
                     -now.friction * state[SLOT_COUNT + 2 * m->dof + QUADRATURE_COUNT]);
    }
    return worst;
}

// Sets all velocities to zero if all of them are only rounding errors of rest. Otherwise
// these would say that contact or friction end.
static void end_rounding(motion *m)
{
    double *w = state_velocities(m, m->state);
    bool rests = true;
    for (int i = 0; i < m->dof; i++) {
        rests = rests && fabs(w[i]) < AT_REST;
    }
    if (rests) {
        memset(w, 0, (size_t)m->dof * sizeof *w);
    }
}

// The three states of friction of a hub at rest (stuck, forwards, backwards) in the order
// in which they are tried. A stuck hub is tried first, unless the event is that it slips,
// or it slides already while the contact changes. A hub that slips slides against the
// friction that held it.
static const hub_friction *friction_order(const double *state, motion_event event)
{
    static const hub_friction orders[][3] = {{HUB_STICK, HUB_FORWARD, HUB_BACKWARD},
                                             {HUB_FORWARD, HUB_BACKWARD, HUB_STICK},
                                             {HUB_BACKWARD, HUB_FORWARD, HUB_STICK}};
    const bool breaks_away = (event == MOTION_RELEASE || event == MOTION_TOUCH) &&
                             state[SLOT_FRICTION] != HUB_STICK;
    const bool slides = event == MOTION_SLIP || breaks_away;
    if (!slides) {
        return orders[0];
    }
    bool backwards = state[SLOT_FRICTION_TORQUE] > 0;
    if (breaks_away) {
        backwards = state[SLOT_FRICTION] == HUB_BACKWARD;
    }
    return backwards ? orders[2] : orders[1];
}

// The violation that may be a rounding error in the states that an event leads to. After
// a release or a slip accelerations decide, and rounding errors are amplified in these
// (motion_rounding).
static double rounding_after(const arm *a, const motion *m, motion_event event)
{
    double left_out = 1, amplified = 0;
    if (event == MOTION_RELEASE) {
        left_out = larger(m->engine->left_out, 1);
    }
    if (event == MOTION_RELEASE || event == MOTION_SLIP) {
        amplified = left_out * (motion_rounding(a, m) - 1 + motion_wall_rounding(a, m));
    }
    return FORCE_TOLERANCE * (1 + amplified) + motion_face_rounding(a, m);
}

// How many of the states tried first are taken even if rounding makes them look worse
// than others. They are the successors of the state that the event ends, which would be
// violated an instant later. `choices` is the number of states of friction that are tried
// with each state of contact.
static int preferred_states(motion_event event, int choices)
{
    if (event == MOTION_RELEASE || event == MOTION_TOUCH) {
        return choices;
    }
    if (event == MOTION_SLIP) {
        return 2;
    }
    if (event == MOTION_STICK) {
        return 1;
    }
    return 0;
}

void contact_resolve(const arm *a, motion *m, bool touching, motion_event event)
{
    // one link that touches a rigid wall at rest has no velocity but for rounding
    double *state = m->state;
    end_rounding(m);
    const hub_friction *at_rest = friction_order(state, event);
    if (touching && m->dof == 1 && motion_wall_is_rigid(m) && !m->wall_moves) {
        state_velocities(m, state)[0] = 0;
    }

    // the candidates: a hub at rest has three states of friction, and an arm that touches
    // may be in contact or leave
    double hub_velocity = state_velocities(m, state)[0];
    bool hub_rests = hub_velocity == 0 && a->motor.stiction > 0;
    hub_friction sliding = hub_velocity < 0 ? HUB_BACKWARD : HUB_FORWARD;
    int choices = hub_rests ? 3 : 1;
    int contacts = touching && !m->wall_gives ? 2 : 1;

    // The first candidate that violates no condition is taken, else the least violated.
    // At a release the free arm is tried first, else the one in contact.
    const int preferred = preferred_states(event, choices);
    const double rounding = rounding_after(a, m, event);
    double least = 0;
    contact_state best = {false, sliding}, tried = best;
    for (int i = 0; i < contacts * choices; i++) {
        bool second = i >= choices;
        state[SLOT_CONTACT] =
            touching && (m->wall_gives || second == (event == MOTION_RELEASE));
        if (hub_rests) {
            state[SLOT_FRICTION] = at_rest[i % choices];
        } else {
            state[SLOT_FRICTION] = sliding;
        }

        // by how much it violates its conditions
        motion_evaluate(a, m, state);
        const double violated = violation(a, m, state, touching, hub_rests);
        tried = contact_state_of(state);
        if (i == 0 || violated < least) {
            least = violated;
            best = tried;
        }
        const double allowed = i < preferred ? rounding : FORCE_TOLERANCE / 1000;
        if (violated <= allowed) {
            best = tried;
            break;
        }
    }

    // the state is evaluated in the one chosen, unless that was the last one tried
    state[SLOT_CONTACT] = best.contact;
    state[SLOT_FRICTION] = best.friction;
    if (motion_held_still(m)) {
        memset(state_velocities(m, state), 0, (size_t)m->dof * sizeof(double));
        motion_evaluate(a, m, state);
    } else if (tried.contact != best.contact || tried.friction != best.friction) {
        motion_evaluate(a, m, state);
    }
    if (motion_held_still(m)) {
        memset(state_accelerations(m, state), 0, (size_t)m->dof * sizeof(double));
    }

    // the implicit methods start again, from the accelerations of this instant
    memcpy(state_algorithmic(m, state), state_accelerations(m, state),
           (size_t)m->dof * sizeof(double));
    state[SLOT_JUMPED] = 1;
    contact_check(a, m);
}
