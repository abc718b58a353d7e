// The two-link arm by power series (taylor_kernel.c): a dense engine.
//
// The step goes as far as the fastest mode and the rotation let a series of the highest
// order reach, and is shortened until its last terms are small; where they are small
// before, as in one that something else ends sooner, the series end with them. Everything
// within it (events, rows, peaks, quadratures) is a polynomial.
//
// Steps that end within an internal step without an event (a sample in contact whose
// command stays, an instant that a program stops at) continue in it: the state says where
// it began, the engine's memory holds its series. While commands stay, a step is made for
// twice as long as the one before; just after a change for twice the time since the
// change before.
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/sincos.h"
#include "src/engines/motion_create.h"
#include "src/engines/pair/taylor_integrator.h"

// Steps stay below this over the fastest rate and the angular velocities.
#define LONGEST_REACH 2.0
// Limit of (decay rate) x (step): the series of the highest order is stable on the
// negative real axis to beyond 7.
#define LONGEST_DECAY 4.0
// On a flat wall the first link turns by no more than this share of what is left to a
// fold.
#define LONGEST_TURN 0.1

// Less of a step left than this share of it is rounding.
#define LEAST_LEFT 1e-9

// --- a step ----------------------------------------------------------------------------

// Writes the numbers that the series need into the block of a lane: arm, wall and motor,
// and a motion that starts from the angles q and velocities w.
static void put_inputs(const arm *a, const motion *m, const double *q, const double *w,
                       double wanted, double *block)
{
    const bool point = a->wall.kind == WALL_POINT;

    // the arm, its wall and its motor
    block[AT_MASS] = a->link_mass;
    block[AT_INERTIA] = a->link_inertia;
    block[AT_LENGTH] = a->link_length;
    block[AT_STIFFNESS] = a->joint_stiffness;
    block[AT_DAMPING] = a->joint_damping;
    block[AT_WALL_X] = point ? a->wall.x : a->wall.cosine;
    block[AT_WALL_Y] = point ? a->wall.y : a->wall.sine;
    block[AT_TORQUE] = a->motor.torque;
    block[AT_STICTION] = a->motor.stiction;
    block[AT_VISCOUS] = a->motor.damping;
    block[AT_HUB_INERTIA] = a->hub_inertia;
    block[AT_HUB_STIFFNESS] = a->hub_stiffness;
    block[AT_HUB_DAMPING] = a->hub_joint_damping;

    // the state
    block[AT_FRICTION] = m->state[SLOT_FRICTION];
    block[AT_START_ANGLE] = q[0];
    block[AT_START_ANGLE + 1] = q[a->first];
    block[AT_START_ANGLE + 2] = q[a->first + 1];
    block[AT_START_VELOCITY] = w[0];
    block[AT_START_VELOCITY + 1] = w[a->first];
    block[AT_START_VELOCITY + 2] = w[a->first + 1];
    block[AT_WANTED] = wanted;

    // rounding of the hub's rate just after an event; -1 for none
    block[AT_EDGE_RATE] = -1;
    if (state_kept(m, m->state)[KEPT_JUMPED] != 0) {
        block[AT_EDGE_RATE] = EDGE_RATE * motion_rounding_at(a, m->dof, q, w);
    }
}

// The length for which a series is computed from velocities w on [s], up to `most`: as
// far as the fastest mode, the rotation and the fastest decay let the highest order
// reach.
static double wanted_step(const arm *a, const double *w, double most)
{
    const double first = w[a->first], second = w[a->first + 1];
    const double links = larger(fabs(first), fabs(second));
    // the bend between the links turns, too, and so does the hub
    const double turning = larger(fabs(second - first), fabs(w[0]));
    const double rate =
        larger(1.2 * larger(links, turning), larger(a->highest_frequency, 1e-3));
    const double wanted = smaller(most, LONGEST_REACH / rate);
    if (a->fastest_decay * wanted > LONGEST_DECAY) {
        return LONGEST_DECAY / a->fastest_decay;
    }
    return wanted;
}

// Records in the state the internal step that begins there, at most `most` [s] long.
static void keep_step_start(motion *m, double most)
{
    double *kept = state_kept(m, m->state);
    const double *q = state_angles(m, m->state), *w = state_velocities(m, m->state);
    kept[KEPT_LENGTH] = kept[KEPT_USED] = 0;
    kept[KEPT_WANTED] = most;
    kept[KEPT_JUMPED] = m->state[SLOT_JUMPED];
    memcpy(kept + KEPT_QUADRATURES, state_quadratures(m, m->state), 3 * sizeof *kept);
    for (int i = 0; i < m->dof; i++) { // three with a hub on a spring
        kept[KEPT_ANGLES + i] = q[i];
        kept[KEPT_VELOCITIES + i] = w[i];
    }
}

// Fills in the inputs of the series of the step that the state keeps.
static void prepare_series(const arm *a, motion *m)
{
    taylor_integrator *s = m->memory;
    const double *kept = state_kept(m, m->state);
    const double *q = kept + KEPT_ANGLES, *w = kept + KEPT_VELOCITIES;
    put_inputs(a, m, q, w, wanted_step(a, w, kept[KEPT_WANTED]), s->lane.block);
    s->lane.form =
        (taylor_form){.contact = m->state[SLOT_CONTACT] != 0,
                      .point = a->wall.kind == WALL_POINT,
                      .hub_spring = a->hub_spring,
                      .damped = a->joint_damping > 0 || a->hub_joint_damping > 0};
}

// Whether the internal step that the state keeps continues: if it reaches to the end of
// what remains, or if its own length is no more than what remains.
static bool continues_step(motion *m, double remaining)
{
    const double *kept = state_kept(m, m->state);
    const double length = kept[KEPT_LENGTH], left = length - kept[KEPT_USED];
    return m->state[SLOT_JUMPED] == 0 && left > LEAST_LEFT * length &&
           (left >= remaining || length <= remaining);
}

// The greatest length of a new internal step [s]. It is what remains or, where nothing
// has changed but the instant to go to, twice the step before if that is more. Just after
// a change it is at most twice the time since the change before, as the next one may come
// as soon.
static double longest_step(motion *m, double remaining)
{
    const double *kept = state_kept(m, m->state);
    if (m->state[SLOT_TIME] == kept[KEPT_CHANGED] && kept[KEPT_INTERVAL] > 0) {
        return smaller(2 * kept[KEPT_INTERVAL], remaining);
    }
    const double before = kept[KEPT_LENGTH], ahead = kept[KEPT_WANTED] - kept[KEPT_USED];
    const bool same = m->state[SLOT_JUMPED] == 0 && before > 0;
    if (same && fabs(ahead - remaining) > LEAST_LEFT * remaining) {
        return larger(2 * before, remaining);
    }
    return remaining;
}

// Continues in the internal step that the state keeps. Its series are computed again if
// the engine's memory holds those of another step.
static void resume_taylor_step(const arm *a, motion *m)
{
    taylor_integrator *s = m->memory;
    double *kept = state_kept(m, m->state);
    const size_t start = KEPT_WANTED * sizeof *kept, size = sizeof s->kept - start;
    if (m->step.history_invalid || !s->own ||
        memcmp(s->kept + KEPT_WANTED, kept + KEPT_WANTED, size) != 0) {
        prepare_series(a, m);
        taylor_compute_one(&s->lane);
        s->known = 0;
    }
    s->lane.group = NULL;
    s->lane.end = -1;
    s->lane.pieces = 0;
    s->own = true;
}

// The length of the step whose series are computed [s]: what the series allow but, on a
// flat wall, clear of the fold over the hub's axis. There the contact force has a pole
// that the velocities do not show: their series pass it with small terms, while that of
// the force diverges.
static double length_of_step(const arm *a, const taylor_lane *lane)
{
    const double allowed = lane->block[AT_ALLOWED];
    if (!lane->form.contact || lane->form.point) {
        return allowed;
    }

    // a bound on how far the first link turns, by its series; in contact both links are
    // at the same angle from the direction across the wall
    const double *q = taylor_term(lane, AT_ANGLE_1);
    const int spacing = taylor_spacing(lane);
    double turn = 0;
    for (int n = lane->form.order + 1; n > 0; n--) {
        turn = (turn + fabs(q[n * spacing])) * allowed;
    }

    // shortened in proportion, as in a share of the length it turns by at most that share
    double sine, cosine;
    inline_sincos(*q, &sine, &cosine);
    const double left = fabs(cosine * a->wall.cosine + sine * a->wall.sine);
    if (turn > LONGEST_TURN * left) {
        return allowed * (LONGEST_TURN * left / turn);
    }
    return allowed;
}

// Continues the internal step or begins a new one; returns how far the motion can go in
// it [s], at most `remaining`. Series that taylor_lanes.c computed in a group are taken
// over.
static double taylor_advance(const arm *a, motion *m, double remaining, double step)
{
    taylor_integrator *s = m->memory;
    double *kept = state_kept(m, m->state);
    (void)step;
    if (!s->ready && continues_step(m, remaining)) {
        resume_taylor_step(a, m);
    } else {
        if (!s->ready) {
            keep_step_start(m, longest_step(m, remaining));
            prepare_series(a, m);
            taylor_compute_one(&s->lane);
        }
        kept[KEPT_LENGTH] = length_of_step(a, &s->lane);
        s->known = 0;

        // series of a group are copied if the motion stops within the step and goes on
        const double way = smaller(m->record.tstop - m->state[SLOT_TIME], remaining);
        s->own = s->lane.group == NULL || kept[KEPT_LENGTH] > way;
        if (s->own && s->lane.group != NULL) {
            taylor_fetch(&s->lane);
        }
    }

    // the step is in hand, and the state keeps it
    s->ready = false;
    m->step.history_invalid = false;
    m->most_force = s->lane.block[AT_FORCE_MOST];
    memcpy(s->kept, kept, sizeof s->kept);
    s->used = kept[KEPT_USED];
    return smaller(kept[KEPT_LENGTH] - s->used, remaining);
}

// Begins without any step, if there is memory; returns the bytes that the engine needs.
static size_t taylor_init(const arm *a, void *memory)
{
    taylor_integrator *s = memory;
    (void)a;
    if (s != NULL) {
        s->ready = s->own = false;
    }
    return sizeof *s;
}

taylor_lane *taylor_prepare(const arm *a, motion *m, double remaining)
{
    taylor_integrator *s = m->memory;
    if (m->engine != &taylor_engine || m->out_of_memory || motion_held_still(m) ||
        continues_step(m, remaining)) {
        return NULL;
    }
    keep_step_start(m, longest_step(m, remaining));
    prepare_series(a, m);
    s->ready = true;
    return &s->lane;
}

const engine taylor_engine = {.name = "pair",
                              .init = taylor_init,
                              .advance = taylor_advance,
                              .state_at = taylor_state_at,
                              .states_at = taylor_states_at,
                              .dense_output = taylor_dense_output,
                              .event_function = taylor_event_function,
                              .second_derivative = taylor_second_derivative,
                              .excludes_event = taylor_excludes_event,
                              .first_event = taylor_first_event,
                              .retorque = taylor_retorque,
                              .left_out = LEFT_OUT};
