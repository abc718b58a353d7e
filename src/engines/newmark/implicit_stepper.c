// Newmark's method and generalised-alpha (Chung and Hulbert 1993, in the form of Arnold
// and Bruls 2007 for constrained systems) on the chain, with a Newton iteration that
// costs O(N).
//
// Unknown are the angles q1 at the end of the step and the contact force f. With
// algorithmic accelerations A,
//
//     q1 = q0 + h w0 + h^2 ((1/2 - beta) A0 + beta A1) (3.7) w1 = w0 + h ((1 - gamma) A0
//     + gamma A1)                                        (3.6) (1 - alpha_m) A1 + alpha_m
//     A0 = (1 - alpha_f) a1 + alpha_f a0,
//
// where a1 satisfies the equations of motion at q1, w1 exactly and g(q1) = 0 in contact.
// Newmark is alpha_m = alpha_f = 0. After the step the velocities are projected onto
// dg/dt = 0.
//
// Where the step resolves the fastest mode, a1 and f are then evaluated again from q1, w1
// and d2g/dt2 = 0: the strategy of section 3.1.3, which keeps the oscillation of the
// constraint's force out of the results. Where it does not (many links), accelerations of
// modes faster than the step carry no information: a1 and f stay those of the step's own
// balance. In contact and just after a jump the step is then one of backward Euler, beta
// = gamma = 1, which does not use the accelerations before it, with dg/dt = 0 as the
// constraint, on which the force does no work; the drift of g is removed by bending along
// a smooth shape that costs next to no strain. It is of first order, but loses energy
// whatever the step, whereas generalised-alpha, started from the jumps of a thousand
// links, was seen to gain energy.
#include <math.h>

#include "src/arm/forces.h"
#include "src/engines/newmark/implicit_newton.h"
#include "src/contact/motion.h"

#define NEWTON_ITERATIONS 30
// The iteration ends with a correction below this share of the largest angle or of 1 rad.
// It converges quadratically, or by 1e-5 a step where the lever is left out, so that what
// is left is below 1e-12.
#define NEWTON_TOLERANCE 1e-8

// Projects the velocities w onto the constraint J w = 0 of contact: the nearest ones in
// the metric of the kinetic energy.
static void project_velocity(const arm *a, motion *m, const double *q, double *w,
                             bool stuck)
{
    double *response = m->scratch;
    const double compliance = chain_contact_response(a, m->links, q, stuck, response);
    const double jump = chain_penetration_rate(a, q, w) / compliance;
    for (int i = 0; i < a->dof; i++) {
        w[i] += jump * response[i];
    }
}

// Computes the accelerations and velocities that belong to the trial state's angles by
// (3.6), (3.7) and the alpha rule above; those of a stuck hub are zero.
static void update_rates(motion *m, const implicit_coefficients *k, double h, bool stuck)
{
    const double *q1 = state_angles(m, m->trial);
    double *w1 = state_velocities(m, m->trial), *A1 = state_algorithmic(m, m->trial);
    double *a1 = state_accelerations(m, m->trial);
    const double *q0 = state_angles(m, m->state), *w0 = state_velocities(m, m->state);
    const double *a0 = state_accelerations(m, m->state),
                 *A0 = state_algorithmic(m, m->state);
    const double per_square = 1 / (h * h * k->beta), own = 1 / (1 - k->alpha_f);
    for (int i = 0; i < m->dof; i++) {
        A1[i] =
            (q1[i] - q0[i] - h * w0[i] - h * h * (0.5 - k->beta) * A0[i]) * per_square;
        w1[i] = w0[i] + h * ((1 - k->gamma) * A0[i] + k->gamma * A1[i]);
        a1[i] =
            ((1 - k->alpha_m) * A1[i] + k->alpha_m * A0[i] - k->alpha_f * a0[i]) * own;
    }
    if (stuck) {
        w1[0] = A1[0] = a1[0] = 0;
    }
}

// Newton's iteration for the angles and the force at the end of the step; it->q etc.
// point into the trial state.
static status solve_step(const arm *a, motion *m, double h,
                         const implicit_coefficients *k, implicit_iterate *it)
{
    const int n = a->dof;
    const double *q0 = state_angles(m, m->state), *w0 = state_velocities(m, m->state);
    double *q1 = state_angles(m, m->trial);
    double *dq = m->scratch + 2 * n, *unit = m->scratch + 3 * n;

    // backward Euler starts from rest: a predictor from the velocities just after a jump
    // would put the shortest links' angles far off
    const double first = k->beta < 1 ? h : 0, second = 0.5 * h * first;
    implicit_tangent t = {(1 - k->alpha_m) / ((1 - k->alpha_f) * k->beta * h * h),
                          k->gamma / (k->beta * h)};
    for (int i = 0; i < n; i++) {
        q1[i] = q0[i] + first * w0[i] + second * state_algorithmic(m, m->state)[i];
    }

    for (int iteration = 0; iteration < NEWTON_ITERATIONS; iteration++) {
        // rates of the guess
        if (it->stuck) {
            q1[0] = q0[0];
        }
        update_rates(m, k, h, it->stuck);

        // its correction
        it->force += implicit_correction(a, m->memory, it, t, dq, unit);
        double size = 0, largest = 1;
        for (int i = 0; i < n; i++) {
            q1[i] += dq[i];
            size = fmax(size, fabs(dq[i]));
            largest = fmax(largest, fabs(q1[i]));
        }
        if (!isfinite(size)) {
            return STATUS_NOT_FINITE;
        }

        // small enough: the rates that go with the angles found
        if (size <= NEWTON_TOLERANCE * largest) {
            update_rates(m, k, h, it->stuck);
            return STATUS_OK;
        }
    }
    return STATUS_NEWTON_FAILED;
}

// Completes the trial state of a step that does not resolve the fastest mode: force and
// friction are those of the step's own balance, which Newton's iteration found.
static void keep_balance(const arm *a, motion *m, const implicit_iterate *it)
{
    double *trial = m->trial, *q = state_angles(m, trial),
           *w = state_velocities(m, trial);

    // the impulse of an impact within the step is not part of the force's impulse
    double impulsive = m->state[SLOT_IMPULSE] / (trial[SLOT_TIME] - m->state[SLOT_TIME]);
    if (it->contact) {
        trial[SLOT_FORCE] = it->force;
    } else {
        trial[SLOT_FORCE] = 0;
    }
    if (it->contact && it->force > 0 && m->state[SLOT_IMPULSE] > 0) {
        trial[SLOT_FORCE] = fmax(it->force - impulsive, 0);
    }

    // friction, and the gap
    const penetration at = chain_penetration(a, q, w);
    if (it->stuck) {
        trial[SLOT_FRICTION_TORQUE] = -it->excess;
    } else {
        trial[SLOT_FRICTION_TORQUE] = it->sliding;
    }
    trial[SLOT_GAP] = -at.depth;
    trial[SLOT_GAP_VELOCITY] = -at.rate;
    trial[SLOT_GAP_ACCELERATION] = 0; // asked for only at events, which evaluate it

    // powers that the quadratures integrate
    trial[SLOT_VISCOUS_POWER] = a->motor.damping * w[0] * w[0];
    double power = 0;
    for (int k = 1; k < a->dof; k++) {
        const force_constants joint = force_constants_of(a, k - a->first);
        power += joint_forces(&joint, &a->amount, 0, w[k] - w[k - 1]).lost;
    }
    trial[SLOT_DAMPING_POWER] = power;
}

// Removes the drift of the constraint by bending the arm: changes the angles by
// c x (2 - x), x from 0 at the hub to 1 at the tip, as a load at its tip bends a beam.
// The factor c is found by Newton's method.
static void bend_to_wall(const arm *a, motion *m)
{
    // the shape for c = 1, in which a hub does not turn
    double *q = state_angles(m, m->trial), *shape = m->scratch;
    for (int k = 0; k < a->dof; k++) {
        double x = a->links > 1 ? (double)(k - a->first) / (a->links - 1) : 1;
        if (k < a->first) {
            shape[k] = 0;
        } else {
            shape[k] = x * (2 - x);
        }
    }

    // the gap depends on c almost linearly: two iterations are enough
    for (int i = 0; i < 2; i++) {
        const double g = chain_penetration(a, q, q).depth;
        const double along = chain_penetration_rate(a, q, shape);
        for (int k = 0; k < a->dof; k++) {
            q[k] -= g / along * shape[k];
        }
    }
}

// Whether the trial state holds more energy than the step's start and the motor account
// for. A jump can leave the shortest links turning by a good part of a radian in a step;
// the equations of the step then have more than one solution.
static bool makes_energy(const arm *a, const motion *m)
{
    double energy[2], weight[2];
    for (int i = 0; i < 2; i++) {
        double *state = i == 0 ? m->state : m->trial;
        const state_energy has = motion_energy(a, m, state);
        energy[i] = has.kinetic + has.strain;
        weight[i] = chain_weight_energy(a, state_angles(m, state));
    }
    double turned = state_angles(m, m->trial)[0] - state_angles(m, m->state)[0];
    const double gained = energy[1] - energy[0] + weight[1] - weight[0];
    return gained > fmax(a->motor.torque * turned, 0) + 1e-3 * energy[0] + 1e-9;
}

// Computes the trial state at the end of a step of length h: solves the step's equations,
// then evaluates the state, or completes it where the step does not resolve all modes.
static status implicit_step(const arm *a, motion *m, double h, state_extent extent)
{
    (void)extent; // always the whole state
    const contact_state mode = contact_state_of(m->state);
    const bool resolved = !motion_unresolved(a, m);

    // the method's coefficients, or backward Euler's
    const bool euler = !resolved && (mode.contact || m->state[SLOT_JUMPED] != 0);
    const implicit_coefficients k =
        euler ? (implicit_coefficients){0, 0, 1, 1} : m->implicit;
    implicit_iterate it = {.q = state_angles(m, m->trial),
                           .w = state_velocities(m, m->trial),
                           .acceleration = state_accelerations(m, m->trial),
                           .force = m->state[SLOT_FORCE],
                           .contact = mode.contact,
                           .stuck = mode.friction == HUB_STICK,
                           .velocity_level = !resolved,
                           .sliding = -mode.friction * a->motor.stiction};
    TRY(solve_step(a, m, h, &k, &it));

    // where the step resolves all modes: velocities onto the constraint, then force and
    // accelerations from the equations of motion
    if (it.contact && resolved) {
        project_velocity(a, m, state_angles(m, m->trial), state_velocities(m, m->trial),
                         it.stuck);
    }
    if (resolved) {
        motion_evaluate(a, m, m->trial);
    } else {
        if (it.contact) {
            bend_to_wall(a, m);
        }
        keep_balance(a, m, &it);
        if (k.beta == 1 && makes_energy(a, m)) {
            return STATUS_UNSTABLE;
        }
    }

    // quadratures by the trapezoidal rule, with the powers at both ends
    const double *x0 = state_quadratures(m, m->state);
    double *x1 = state_quadratures(m, m->trial);
    static const int powers[] = {SLOT_VISCOUS_POWER, SLOT_DAMPING_POWER, SLOT_FORCE};
    for (int i = 0; i < QUADRATURE_WALL; i++) {
        x1[i] = x0[i] + h / 2 * (m->state[powers[i]] + m->trial[powers[i]]);
    }
    return STATUS_OK;
}

// The length of the step: a whole time step, or what remains if that is less.
static double implicit_advance(const arm *a, motion *m, double remaining,
                               double step_length)
{
    (void)a, (void)m;
    if (remaining < step_length * (1 + 1e-9)) {
        return remaining;
    }
    return step_length;
}

static size_t implicit_init(const arm *a, void *memory)
{
    (void)memory; // scratch
    return (size_t)a->links * sizeof(implicit_sweep);
}

// The two engines differ only in the coefficients of a motion (motion.implicit).
#define STEPPER(title)                                                                   \
    {                                                                                    \
        .name = (title), .init = implicit_init, .advance = implicit_advance,             \
        .state_at = implicit_step, .implicit = true                                      \
    }
const engine newmark_engine = STEPPER("Newmark");
const engine generalized_alpha_engine = STEPPER("generalised-alpha");
