// Newmark's method and generalised-alpha (Chung and Hulbert 1993, in the form of Arnold and Bruls
// 2007 for constrained systems) on the chain, with a Newton iteration that costs O(N).
//
// Unknown are the angles q1 at the end of the step and the contact force f. With algorithmic
// accelerations A,
//
//     q1 = q0 + h w0 + h^2 ((1/2 - beta) A0 + beta A1)                               (3.7)
//     w1 = w0 + h ((1 - gamma) A0 + gamma A1)                                        (3.6)
//     (1 - alpha_m) A1 + alpha_m A0 = (1 - alpha_f) a1 + alpha_f a0,
//
// where a1 satisfies the equations of motion at q1, w1 exactly and g(q1) = 0 in contact. Newmark is
// alpha_m = alpha_f = 0. After the step the velocities are projected onto dg/dt = 0.
//
// Where the step resolves the fastest mode, a1 and f are then evaluated again from q1, w1 and
// d2g/dt2 = 0: the strategy of section 3.1.3, which keeps the oscillation of the constraint's force
// out of the results. Where it does not (many links), accelerations of modes faster than the step
// are no information: a1 and f stay those of the step's own balance, and in contact and just after
// a jump the step is backward Euler's, beta = gamma = 1, which asks nothing of the accelerations
// before it, with dg/dt = 0 for a constraint, on which the force does no work; what g drifts is
// bent away along a smooth shape that costs next to no strain. It is of first order, but loses
// energy whatever the step; generalised-alpha, started from the jumps of a thousand links, was seen
// to make some.
//
// Newton's linear system is solved by two sweeps like those of chain.h. With dw = gamma' dq and
// da = beta' dq, the acceleration of a node changes by da_k = da_{k-1} + l z_k dq_k,
//     z_k = t_k (beta' - w_k^2) - r_k (alpha_k + 2 gamma' w_k),
// and the links beyond node k answer with force and joint torque
//     dF = P da_{k-1} + p_f dq_{k-1} + F0,   dT = p_t' da_{k-1} + y dq_{k-1} + T0.
// Only the small change of the contact point's lever with the base's displacement is left out
// (it is of order f l against I / h^2), so Newton converges a little slower than quadratically.
#include "src/solve/motion.h"
#include "src/base/sincos.h"

#include <math.h>
#include <string.h>

#define NEWTON_ITERATIONS 30
// The iteration ends with a correction below this share of the largest angle or of 1 rad. It
// converges quadratically, or by 1e-5 a step where the lever is left out, so that what is left is
// below 1e-12.
#define NEWTON_TOLERANCE 1e-8

// One link's share of the tangent system, kept between the two sweeps of its solution.
typedef struct implicit_sweep {
    double c, s;             // direction of the link
    double com_x, com_y;     // acceleration of its centre of mass [m/s2]
    double force_x, force_y; // force it gives to the links beyond [N]
    double zx, zy;           // d(node acceleration)/d(angle) / l [1/s2]
    double vx, vy;           // dependence on the base's acceleration, over the pivot
    double to_parent;        // dependence on the parent's angle, over the pivot
    double free, unit;       // right-hand sides over the pivot
} implicit_sweep;

typedef struct tangent {
    double beta;  // beta': acceleration per angle [1/s2]
    double gamma; // gamma': velocity per angle [1/s]
} tangent;

// Residual quantities of the iterate: forces between the links and node accelerations.
static void forces_between_links(const arm *a, implicit_sweep *link, const double *w,
                                 const double *acceleration, double fx, double fy)
{
    const double l = a->link_length, m = a->link_mass;
    double ax = 0, ay = 0;

    // accelerations from hub to tip, then the forces that they need from tip to hub
    for (int k = 0; k < a->links; k++) {
        double al = acceleration[a->first + k], w2 = w[a->first + k] * w[a->first + k];
        double dx = -l * (link[k].s * al + link[k].c * w2);
        double dy = l * (link[k].c * al - link[k].s * w2);
        link[k].com_x = ax + dx / 2;
        link[k].com_y = ay + dy / 2;
        ax += dx;
        ay += dy;
    }
    fx += a->tip_mass * ax;
    fy += a->tip_mass * ay;

    for (int k = a->links - 1; k >= 0; k--) {
        link[k].force_x = fx;
        link[k].force_y = fy;
        fx += m * link[k].com_x;
        fy += m * link[k].com_y;
    }
}

// Penetration, and how the wall acts at q: direction, lever.
typedef struct contact_point {
    double ex, ey, lever, g, angle_force; // angle_force: e' = -r of a point wall, see below
} contact_point;

static contact_point contact_at(const arm *a, const implicit_sweep *link)
{
    const double l = a->link_length;
    const implicit_sweep *end = &link[a->links - 1];
    double x = 0, y = 0;
    for (int k = 0; k < a->links - 1; k++) {
        x += l * link[k].c;
        y += l * link[k].s;
    }
    wall_contact at = wall_contact_at(&a->wall, l, x, y, 0, 0, end->c, end->s, 0);
    return (contact_point){at.ex, at.ey, at.lever, at.penetration, a->wall.kind == WALL_POINT};
}

// J v from the directions in `link`.
static double rate_along(const arm *a, const implicit_sweep *link, contact_point p, const double *v)
{
    double sum = 0, l = a->link_length;
    for (int k = 0; k < a->links; k++) {
        sum += l * (link[k].c * p.ey - link[k].s * p.ex) * v[a->first + k];
    }
    return sum + p.lever * v[a->dof - 1];
}

// d(dg/dt)/dq . dq from the directions in `link`, dw = gamma' dq, at velocities w.
static double rate_change(const arm *a, const implicit_sweep *link, contact_point p,
                          const double *w, double gamma, const double *dq)
{
    const double l = a->link_length, *v = w + a->first, *x = dq + a->first;
    const implicit_sweep *end = &link[a->links - 1];
    const int last = a->links - 1;
    double sum = gamma * rate_along(a, link, p, dq);
    if (a->wall.kind == WALL_PLANE) {
        for (int k = 0; k <= last; k++) {
            sum -= l * (link[k].c * p.ex + link[k].s * p.ey) * v[k] * x[k];
        }
        return sum;
    }

    // dg/dt = s w + t'v_base with s = r'd, see wall.h
    double along = 0; // r'v_base
    for (int k = 0; k < last; k++) {
        double sine = end->s * link[k].c - end->c * link[k].s; // r'(l t_k) = l sin(q_N - q_k)
        along += l * sine * v[k];
        sum += l * (-sine * v[last] + sine * v[k]) * x[k];
    }
    return sum + (-p.g * v[last] - along) * x[last];
}

typedef struct iterate {
    const double *q, *w, *acceleration;
    double force;
    bool contact, stuck;
    bool velocity_level; // the constraint is dg/dt = 0 instead of g = 0
    double sliding;      // Coulomb friction torque while sliding [N m]
    double excess;       // out: what the balance of a stuck hub lacks, minus friction [N m]
} iterate;

// Solves the tangent system for the corrections of the angles, dq[dof], and of the force. One
// function, since its sweeps share what they keep in registers.
static double newton_correction(const arm *a, implicit_sweep *link, iterate *it, tangent t,
                                double *dq, double *unit)
{
    const double l = a->link_length, m = a->link_mass, half = 0.5 * l;
    const double *q = it->q, *w = it->w, *al = it->acceleration;
    const int first = a->first, last = a->links - 1;
    contact_point point = {0};

    // residual quantities of the iterate
    for (int k = 0; k <= last; k++) {
        inline_sincos(q[first + k], &link[k].s, &link[k].c);
    }
    if (it->contact) {
        point = contact_at(a, link);
    }
    forces_between_links(a, link, w, al, it->force * point.ex, it->force * point.ey);

    // elimination from tip to hub
    double pxx = a->tip_mass, pxy = 0, pyx = 0, pyy = a->tip_mass; // P, no longer symmetric
    double hx = -it->force * point.angle_force * link[last].c; // p_f: the point wall's force turns
    double hy = -it->force * point.angle_force * link[last].s; // with the last link
    double gx = 0, gy = 0, yy = 0;                             // p_t and y of the joint beyond
    double fx = 0, fy = 0, torque0 = 0;                        // F0, T0 of the residual
    double ex = point.ex, ey = point.ey, torque1 = 0;          // and of a unit force
    double outer = 0;                                          // torque of the joint beyond
    for (int k = last; k >= 0; k--) {
        implicit_sweep *L = &link[k];
        double c = L->c, s = L->s, omega = w[first + k], alpha = al[first + k];

        // how the node's acceleration changes with the link's angle
        double across = t.beta - omega * omega, along = alpha + 2 * t.gamma * omega;
        L->zx = -s * across - c * along;
        L->zy = c * across - s * along;

        // the joint's torque, and what it changes with
        double kappa = 0, inner = 0;
        if (first + k > 0) {
            double stiffness = k > 0 ? a->joint_stiffness : a->hub_stiffness;
            double damping = k > 0 ? a->joint_damping : a->hub_joint_damping;
            kappa = stiffness + damping * t.gamma;
            inner = stiffness * (q[first + k] - q[first + k - 1]) +
                    damping * (omega - w[first + k - 1]);
        }

        // the link's balance of torques about its node: residual, and its slope by the angle
        double residual = a->link_inertia * alpha + half * m * (c * L->com_y - s * L->com_x) +
                          l * (c * L->force_y - s * L->force_x) - outer + inner;
        double lever_force = 0;
        if (k == last) {
            residual += it->force * point.lever;
            lever_force = point.lever;
        }
        double zpx = pxx * L->zx + pxy * L->zy, zpy = pyx * L->zx + pyy * L->zy; // P z
        double pivot = a->link_inertia * t.beta - half * m * (c * L->com_x + s * L->com_y) -
                       l * (c * L->force_x + s * L->force_y) +
                       half * half * m * (c * L->zy - s * L->zx) +
                       l * (c * (l * zpy + hy) - s * (l * zpx + hx)) -
                       (l * (gx * L->zx + gy * L->zy) + yy) + kappa;
        double vx = -half * m * s + l * (c * pyx - s * pxx) - gx;
        double vy = half * m * c + l * (c * pyy - s * pxy) - gy;
        double right = -residual - l * (c * fy - s * fx) + torque0;
        double right1 = -lever_force - l * (c * ey - s * ex) + torque1;
        if (first + k == 0) {
            // the first link turns with the hub
            pivot += a->hub_inertia * t.beta + a->motor.damping * t.gamma;
            right -=
                a->hub_inertia * alpha + a->motor.damping * omega - a->motor.torque - it->sliding;
            if (it->stuck) {
                it->excess =
                    -residual - a->hub_inertia * alpha - a->motor.damping * omega + a->motor.torque;
                right = right1 = 0;
            }
        }

        // the angle as a function of what comes before the link
        L->vx = vx / pivot;
        L->vy = vy / pivot;
        L->to_parent = kappa / pivot;
        L->free = right / pivot;
        L->unit = right1 / pivot;

        // the answer of this link and all beyond it
        double px = m * half * L->zx + l * zpx + hx, py = m * half * L->zy + l * zpy + hy;
        pxx += m - px * L->vx;
        pxy -= px * L->vy;
        pyx -= py * L->vx;
        pyy += m - py * L->vy;
        hx = px * L->to_parent;
        hy = py * L->to_parent;
        fx += px * L->free;
        fy += py * L->free;
        ex += px * L->unit;
        ey += py * L->unit;
        gx = -kappa * L->vx;
        gy = -kappa * L->vy;
        yy = kappa * L->to_parent - kappa;
        torque0 = kappa * L->free;
        torque1 = kappa * L->unit;
        outer = inner;
    }

    // the hub on its spring
    dq[0] = unit[0] = 0;
    if (a->hub_spring && it->stuck) {
        it->excess = a->motor.torque + outer;
    } else if (a->hub_spring) {
        double pivot = a->hub_inertia * t.beta + a->motor.damping * t.gamma - yy;
        double residual = a->hub_inertia * al[0] + a->motor.damping * w[0] - a->motor.torque -
                          it->sliding - outer;
        dq[0] = (torque0 - residual) / pivot;
        unit[0] = torque1 / pivot;
    }

    // substitution from hub to tip: dq for the residual, `unit` for a unit contact force
    double ax = 0, ay = 0, bx = 0, by = 0;
    for (int k = 0; k <= last; k++) {
        implicit_sweep *L = &link[k];
        double parent = first + k > 0 ? dq[first + k - 1] : 0;
        double parent1 = first + k > 0 ? unit[first + k - 1] : 0;
        bool fixed = first + k == 0 && it->stuck;

        // a stuck hub stays
        double d = fixed ? 0 : L->free - L->vx * ax - L->vy * ay + L->to_parent * parent;
        double d1 = fixed ? 0 : L->unit - L->vx * bx - L->vy * by + L->to_parent * parent1;
        dq[first + k] = d;
        unit[first + k] = d1;
        ax += l * L->zx * d;
        ay += l * L->zy * d;
        bx += l * L->zx * d1;
        by += l * L->zy * d1;
    }
    if (!it->contact) {
        return 0;
    }

    // the force that meets the constraint
    double df;
    if (it->velocity_level) {
        double rate = rate_along(a, link, point, w);
        df = -(rate + rate_change(a, link, point, w, t.gamma, dq)) /
             rate_change(a, link, point, w, t.gamma, unit);
    } else {
        df = -(point.g + rate_along(a, link, point, dq)) / rate_along(a, link, point, unit);
    }
    for (int i = 0; i < a->dof; i++) {
        dq[i] += df * unit[i];
    }
    return df;
}

// Velocities onto J w = 0 in contact.
static void project_velocity(const arm *a, motion *m, const double *q, double *w, bool stuck)
{
    double compliance, *response = m->scratch;
    chain_contact_response(a, m->links, q, stuck, response, &compliance);
    double jump = chain_penetration_rate(a, q, w) / compliance;
    for (int i = 0; i < a->dof; i++) {
        w[i] += jump * response[i];
    }
}

// Coefficients of the step at hand.
typedef struct coefficients {
    double alpha_m, alpha_f, beta, gamma;
} coefficients;

// Accelerations and velocities that belong to angles q1.
static void update_rates(const motion *m, const coefficients *k, double h, const double *q1,
                         double *w1, double *A1, double *a1)
{
    const double *q0 = state_angles(m, m->state), *w0 = state_velocities(m, m->state);
    const double *a0 = state_accelerations(m, m->state), *A0 = state_algorithmic(m, m->state);
    const double per_square = 1 / (h * h * k->beta), own = 1 / (1 - k->alpha_f);
    for (int i = 0; i < m->dof; i++) {
        A1[i] = (q1[i] - q0[i] - h * w0[i] - h * h * (0.5 - k->beta) * A0[i]) * per_square;
        w1[i] = w0[i] + h * ((1 - k->gamma) * A0[i] + k->gamma * A1[i]);
        a1[i] = ((1 - k->alpha_m) * A1[i] + k->alpha_m * A0[i] - k->alpha_f * a0[i]) * own;
    }
}

// Newton's iteration for the angles and the force at the end of the step; it->q etc. point into the
// trial state.
static status solve_step(const arm *a, motion *m, double h, const coefficients *k, iterate *it)
{
    const int n = a->dof;
    const double *q0 = state_angles(m, m->state), *w0 = state_velocities(m, m->state);
    double *q1 = state_angles(m, m->trial), *w1 = state_velocities(m, m->trial);
    double *A1 = state_algorithmic(m, m->trial), *a1 = state_accelerations(m, m->trial);
    double *dq = m->scratch + 2 * n, *unit = m->scratch + 3 * n;

    // backward Euler starts from rest: a predictor from the velocities just after a jump would put
    // the shortest links' angles far off
    const double first = k->beta < 1 ? h : 0, second = 0.5 * h * first;
    tangent t = {(1 - k->alpha_m) / ((1 - k->alpha_f) * k->beta * h * h), k->gamma / (k->beta * h)};
    for (int i = 0; i < n; i++) {
        q1[i] = q0[i] + first * w0[i] + second * state_algorithmic(m, m->state)[i];
    }

    for (int iteration = 0; iteration < NEWTON_ITERATIONS; iteration++) {
        // rates of the guess; a stuck hub has none
        if (it->stuck) {
            q1[0] = q0[0];
        }
        update_rates(m, k, h, q1, w1, A1, a1);
        if (it->stuck) {
            w1[0] = A1[0] = a1[0] = 0;
        }

        // its correction
        it->force += newton_correction(a, m->sweeps, it, t, dq, unit);
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
            update_rates(m, k, h, q1, w1, A1, a1);
            if (it->stuck) {
                w1[0] = A1[0] = a1[0] = 0;
            }
            return STATUS_OK;
        }
    }
    return STATUS_NEWTON_FAILED;
}

// The state at the end of a step that does not resolve the fastest mode: what the step's own
// balance gave.
static void keep_balance(const arm *a, motion *m, const iterate *it)
{
    double *trial = m->trial, *q = state_angles(m, trial), *w = state_velocities(m, trial);
    double g, rate, power = 0;
    chain_penetration(a, q, w, &g, &rate);

    // the impulse of an impact within the step is none of the force's
    double impulsive = m->state[SLOT_IMPULSE] / (trial[SLOT_TIME] - m->state[SLOT_TIME]);
    trial[SLOT_FORCE] = it->contact ? it->force : 0;
    if (it->contact && it->force > 0 && m->state[SLOT_IMPULSE] > 0) {
        trial[SLOT_FORCE] = fmax(it->force - impulsive, 0);
    }

    trial[SLOT_FRICTION_TORQUE] = it->stuck ? -it->excess : it->sliding;
    trial[SLOT_GAP] = -g;
    trial[SLOT_GAP_VELOCITY] = -rate;
    trial[SLOT_GAP_ACCELERATION] = 0; // asked for only at events, which evaluate it

    // powers that the quadratures integrate
    trial[SLOT_VISCOUS_POWER] = a->motor.damping * w[0] * w[0];
    for (int k = 1; k < a->dof; k++) {
        double bend = w[k] - w[k - 1];
        power += (k == a->first ? a->hub_joint_damping : a->joint_damping) * bend * bend;
    }
    trial[SLOT_DAMPING_POWER] = power;
}

// Bends a drift of the constraint away: angles c x (2 - x) with x from 0 at the hub to 1 at the
// tip, like a beam under a load at its tip.
static void bend_to_wall(const arm *a, motion *m)
{
    double *q = state_angles(m, m->trial), *shape = m->scratch;
    double g, along;
    for (int k = 0; k < a->dof; k++) {
        double x = a->links > 1 ? (double)(k - a->first) / (a->links - 1) : 1;
        shape[k] = k < a->first ? 0 : x * (2 - x);
    }

    // the gap depends on it almost linearly: twice is enough
    for (int i = 0; i < 2; i++) {
        chain_penetration(a, q, q, &g, NULL);
        along = chain_penetration_rate(a, q, shape);
        for (int k = 0; k < a->dof; k++) {
            q[k] -= g / along * shape[k];
        }
    }
}

// Whether the trial state holds more energy than the step's start and the motor account for. A jump
// can leave the shortest links turning by a good part of a radian in a step; the equations of the
// step then have more than one solution.
static bool makes_energy(const arm *a, const motion *m)
{
    double energy[2];
    for (int i = 0; i < 2; i++) {
        double *state = i == 0 ? m->state : m->trial;
        const double *q = state_angles(m, state);
        energy[i] =
            chain_kinetic_energy(a, q, state_velocities(m, state)) + chain_strain_energy(a, q);
    }
    double turned = state_angles(m, m->trial)[0] - state_angles(m, m->state)[0];
    return energy[1] - energy[0] > fmax(a->motor.torque * turned, 0) + 1e-3 * energy[0] + 1e-9;
}

static status step(const arm *a, motion *m, double h)
{
    const contact_state mode = contact_state_of(m->state);
    const bool resolved = !motion_unresolved(a, m);

    // the method's coefficients, or backward Euler's
    coefficients k = {m->alpha_m, m->alpha_f, m->beta, m->gamma};
    if (!resolved && (mode.contact || m->state[SLOT_JUMPED] != 0)) {
        k = (coefficients){0, 0, 1, 1};
    }
    iterate it = {.q = state_angles(m, m->trial),
                  .w = state_velocities(m, m->trial),
                  .acceleration = state_accelerations(m, m->trial),
                  .force = m->state[SLOT_FORCE],
                  .contact = mode.contact,
                  .stuck = mode.friction == HUB_STICK,
                  .velocity_level = !resolved,
                  .sliding = -mode.friction * a->motor.stiction};
    status s = solve_step(a, m, h, &k, &it);
    if (s != STATUS_OK) {
        return s;
    }

    // onto the constraint, with the force evaluated anew where the step resolves all modes
    if (it.contact && resolved) {
        project_velocity(a, m, state_angles(m, m->trial), state_velocities(m, m->trial), it.stuck);
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

// A time step, or what remains.
static double begin(const arm *a, motion *m, double remaining, double step_length)
{
    (void)a, (void)m;
    return remaining < step_length * (1 + 1e-9) ? remaining : step_length;
}

const engine newmark_engine = {
    .name = "Newmark", .begin = begin, .state_at = step, .link_scratch = sizeof(implicit_sweep)};
const engine generalized_alpha_engine = {.name = "generalised-alpha",
                                         .begin = begin,
                                         .state_at = step,
                                         .link_scratch = sizeof(implicit_sweep)};
