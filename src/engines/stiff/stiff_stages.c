// Stages of a step: the arm as numbers, Newton's iteration, the error (stiff_step.h).
#include <math.h>
#include <string.h>

#include "src/base/extremes.h"
#include "src/base/sincos.h"
#include "src/engines/stiff/stiff_integrator.h"

#define NEWTON_SHARE 3e-3 // of the tolerance, what the iteration leaves
// polynomials of the step before are extrapolated up to so many of its lengths
#define FARTHEST    2
#define LEAST_RATE  1e-4  // least rate of convergence that is believed
#define SLOW_RATE   0.6   // rate of convergence from which a shorter step is cheaper
#define LEAST_SHARE 1e-14 // of the scale, a correction that is only rounding
#define LAST_DIGITS 1e-14 // rounding of angles, which corrections cannot go below
#define MOST_LEFT   30    // times the wanted size, the largest such correction accepted
#define ANGLE_RATE  20    // turns an angle's error into one of a velocity [1/s]

enum { MOST_ITERATIONS = 12 };

// --- the arm ---------------------------------------------------------------------------

// Chooses the equation of an electric drive at the step's start: the current is held at
// its limit if the voltage would drive it beyond that; else it flows through an
// inductance or, without one, follows the voltage at once. `w` and `acceleration` are the
// hub's.
static void choose_drive(stiff_step *s, const motor_model *m, double current, double w,
                         double acceleration)
{
    const double limit = m->current_limit, rounding = 1e-11;
    const double wanted = (m->gain * m->voltage - m->back_emf * w) / m->resistance;
    const bool flows = m->inductance > 0;
    const double present = flows ? current : wanted;
    const double side = present < 0 ? -1 : 1;
    if (flows) {
        s->drive = STIFF_FLOWS;
    } else {
        s->drive = STIFF_FOLLOWS;
    }
    s->limited = side * limit;
    if (limit == HUGE_VAL || (flows && fabs(current) < limit * (1 - rounding))) {
        return;
    }

    // limited where the voltage would drive the current beyond, or is about to
    const double beyond = side * wanted - limit,
                 grows = -side * m->back_emf * acceleration;
    const bool off_limit = fabs(beyond) > rounding * limit;
    if ((off_limit && beyond > 0) || (!off_limit && grows > 0)) {
        s->drive = STIFF_LIMITED;
    }
}

void stiff_set_arm(stiff_integrator *integrator, const arm *a, const motion *m)
{
    stiff_step *s = &integrator->step;
    const contact_state now = contact_state_of(m->state);
    s->links = a->links;
    s->dof = a->dof;
    s->first = a->first;
    for (int k = 0; k < a->links; k++) {
        const arm_link own = arm_link_of(a, k);
        s->link[k] = (stiff_link){.length = own.length,
                                  .mass = own.mass,
                                  .inertia = own.inertia,
                                  .forces = force_constants_of(a, k)};
    }
    s->tip_mass = a->tip_mass;
    s->tip = force_constants_of_tip(a);
    s->amount = &a->amount;

    // damped modes, in the bodies' velocities
    s->modes = a->damped_modes;
    memset(s->mode, 0, (size_t)(s->modes * s->dof) * sizeof *s->mode);
    for (int i = 0; i < s->modes; i++) {
        for (int k = a->first > 0 ? 0 : 1; k < a->links; k++) {
            s->mode[i * s->dof + a->first + k] += a->modal_damping[i][k];
            s->mode[i * s->dof + a->first + k - 1] -= a->modal_damping[i][k];
        }
    }

    // the hub
    s->hub_inertia = a->hub_inertia;
    const bool held = now.contact && motion_wall_is_rigid(m) && a->dof == 1;
    s->stuck = now.friction == HUB_STICK && !held;
    if (held) {
        s->friction = 0;
    } else {
        s->friction = now.friction * a->motor.stiction;
    }
    s->motor = &a->motor;
    s->drive = STIFF_DIRECT;
    if (a->motor.electric) {
        s->current0 = state_quadratures(m, m->state)[QUADRATURE_CURRENT];
        choose_drive(s, &a->motor, s->current0, state_velocities(m, m->state)[0],
                     state_accelerations(m, m->state)[0]);
    }

    // the wall
    s->wall = &a->wall;
    if (!now.contact) {
        s->contact = STIFF_FREE;
    } else if (motion_wall_is_rigid(m)) {
        s->contact = STIFF_RIGID;
    } else {
        s->contact = STIFF_GIVES;
    }
}

void stiff_set_start(stiff_integrator *integrator, motion *m)
{
    stiff_step *s = &integrator->step;
    const size_t size = (size_t)s->dof * sizeof(double);
    memcpy(s->q0, state_angles(m, m->state), size);
    memcpy(s->w0, state_velocities(m, m->state), size);
    memcpy(s->a0, state_accelerations(m, m->state), size);
    s->force0 = m->state[SLOT_FORCE];
    s->time = m->state[SLOT_TIME];
    for (int k = 0; k < s->links; k++) {
        inline_sincos(s->q0[s->first + k], &s->link[k].sine, &s->link[k].cosine);
    }
}

// --- Newton ----------------------------------------------------------------------------

// Weights by which the accelerations at the stages j of the step before predict those at
// the stages i of this one: the former's polynomial at offset + ratio c_i of its length.
// `offset` is where in that step this one starts, `ratio` that of their lengths.
static void weights_of_last_step(double offset, double ratio,
                                 double weight[RADAU_STAGES][RADAU_LANES])
{
    for (int i = 0; i < RADAU_STAGES; i++) {
        double value[RADAU_LANES];
        radau_values_at(smaller(offset + ratio * radau_node[i], FARTHEST), value);
        for (int j = 0; j < RADAU_STAGES; j++) {
            weight[j][i] = value[j];
        }
    }
}

// Sets the shift and velocity of a wall that moves, at the stages and (in the last lane)
// at the step's start.
static void place_wall(stiff_step *s)
{
    for (int i = 0; i < RADAU_LANES; i++) {
        double instant = s->time;
        if (i < RADAU_STAGES) {
            instant += radau_node[i] * s->length;
        }
        const wall_shift at = wall_motion_at(&s->wall->motion, instant);
        s->shift[0].at[i] = at.place;
        s->shift[1].at[i] = at.velocity;
    }
}

bool stiff_solve_stages(stiff_integrator *integrator, bool fresh, double offset,
                        double ratio, double *rate)
{
    // the prediction: without weights only the velocities at the start
    stiff_step *s = &integrator->step;
    _Alignas(32) double weight[RADAU_STAGES][RADAU_LANES] = {{0}};
    if (!fresh) {
        weights_of_last_step(offset, ratio, weight);
    }
    if (wall_moves(s->wall)) {
        place_wall(s);
    }
    integrator->loops->predict(s, stiff_accelerations(integrator),
                               stiff_force(integrator), weight[0]);

    // simplified Newton iterations, all with the tangent at the prediction
    const double scale = integrator->kept[STIFF_SCALE];
    const double wanted = NEWTON_SHARE * integrator->tolerance * scale;
    double before = 0;
    for (int i = 0; i < MOST_ITERATIONS; i++) {
        if (!integrator->loops->residual(s, false)) {
            return false;
        }
        if (i == 0) {
            integrator->loops->factor(s);
        }
        const double now = integrator->loops->correct(s);
        if (!(now < 1e3 * (1 + scale))) {
            return false;
        }

        // What is left after corrections that shrink by theta each is a geometric series.
        // The first correction is judged by the rate of the step before.
        double theta = *rate, left = now * theta;
        if (i > 0) {
            theta = now / before;
            left = now * theta / (1 - theta);
            *rate = smaller(larger(theta, LEAST_RATE), 0.5);
        }
        const bool converges = i == 0 || theta < 1;
        if ((converges && left < wanted) || now < LEAST_SHARE * scale) {
            return true;
        }

        // slow convergence: enough where the rest is the rounding of the angles
        if (i > 1 && theta > SLOW_RATE) {
            const double rounding =
                LAST_DIGITS * stiff_momentum(integrator, s->q0) / s->length;
            return now < smaller(rounding, MOST_LEFT * wanted);
        }
        before = now;
    }
    return false;
}

void stiff_keep_stages(stiff_integrator *integrator)
{
    const stiff_step *s = &integrator->step;
    double *kept = integrator->kept;
    memcpy(kept + STIFF_VALUES, s->values, sizeof s->values);
    memcpy(stiff_angles(integrator), s->q0, (size_t)s->dof * sizeof(double));
    memcpy(stiff_velocities(integrator), s->w0, (size_t)s->dof * sizeof(double));
    double *a = stiff_accelerations(integrator);
    for (int k = 0; k < s->dof; k++) {
        memcpy(a + (size_t)RADAU_LANES * (size_t)k, s->stage[k].a, sizeof s->stage[k].a);
    }

    // One link on a rigid wall, or two whose hub is stuck, are held to the last bit: they
    // have no accelerations, and the same force throughout unless the current changes.
    const bool rigid = s->contact == STIFF_RIGID && !wall_moves(s->wall);
    const bool one = rigid && s->dof == 1, both = rigid && s->dof == 2 && s->stuck;
    if (one || both) {
        memset(a, 0, (size_t)s->dof * RADAU_LANES * sizeof *a);
    }
    for (int i = 0; i < RADAU_LANES && (both || (one && s->drive != STIFF_FLOWS)); i++) {
        stiff_force(integrator)[i] = s->force.at[RADAU_LANES - 1];
    }
    kept[STIFF_LENGTH] = s->length;
}

// --- the error -------------------------------------------------------------------------

// The error is estimated as RADAU5 does it: by the difference between the embedded
// formula of order 7 and the stages, filtered by the real system.

// A norm of velocities: sqrt(I_hub w0^2 + sum of m v^2) of the arm stretched out, v being
// the speed of each link's outer end [kg^(1/2) m/s].
double stiff_momentum(const stiff_integrator *integrator, const double *w)
{
    const stiff_step *s = &integrator->step;
    double v = 0, sum = s->hub_inertia * w[0] * w[0];
    for (int k = 0; k < s->links; k++) {
        v += s->link[k].length * w[s->first + k];
        sum += s->link[k].mass * v * v;
    }
    return sqrt(sum);
}

// Sum of a row's numbers times y.
static inline double real_row_product(const stiff_step *s, const double *row,
                                      const double *y)
{
    double sum = 0;
    for (int k = 0; k < s->dof; k++) {
        sum += row[k] * y[k];
    }
    return sum;
}

// Computes out = M v + gamma D x over all bodies: M the mass matrix, D the matrix of all
// damping, and gamma = 1/g of the real system. fx and fy [links] are scratch, the forces
// on the links.
static void inertia_and_damping(stiff_step *s, double gamma, const double *v,
                                const double *x, double *out, double *fx, double *fy)
{
    // from hub to tip: a sums v, b sums x over the links, as places of their ends
    double ax = 0, ay = 0, bx = 0, by = 0;
    for (int k = 0; k < s->links; k++) {
        const stiff_pivot *p = &s->pivot[k];
        const double mass = s->link[k].mass, drag = gamma * p->drag;
        const double a = v[s->first + k], b = x[s->first + k];
        fx[k] = mass * (ax - 0.5 * p->ls * a) + drag * (bx - 0.5 * p->ls * b);
        fy[k] = mass * (ay + 0.5 * p->lc * a) + drag * (by + 0.5 * p->lc * b);
        ax -= p->ls * a, ay += p->lc * a;
        bx -= p->ls * b, by += p->lc * b;
    }

    // from tip to hub: the sum of forces, which begins with that of the tip's mass and of
    // friction along the wall
    const double slip = gamma * s->slip_damping * (s->along_x * bx + s->along_y * by);
    double tx = s->tip_mass * ax + slip * s->along_x;
    double ty = s->tip_mass * ay + slip * s->along_y, outer = 0;
    for (int k = s->links - 1; k >= 0; k--) {
        const stiff_pivot *p = &s->pivot[k];
        const int i = s->first + k;
        double inner = 0;
        if (i > 0) {
            inner = gamma * p->joint_damping * (x[i] - x[i - 1]);
        }
        out[i] = s->link[k].inertia * v[i] + p->lc * (ty + 0.5 * fy[k]) -
                 p->ls * (tx + 0.5 * fx[k]) + inner - outer + gamma * p->turning * x[i];
        tx += fx[k];
        ty += fy[k];
        outer = inner;
    }

    // the hub, and the damped modes
    if (s->first > 0) {
        out[0] = -outer;
    }
    out[0] += s->hub_inertia * v[0] + gamma * s->hub_damping * x[0];
    for (int i = 0; i < s->modes; i++) {
        const double *g = stiff_border_row(s, i), sum = real_row_product(s, g, x);
        for (int k = 0; k < s->dof; k++) {
            out[k] += gamma * sum * g[k];
        }
    }
    if (s->stuck) {
        out[0] = 0;
    }
}

// Solves the real system without its borders (damped modes, contact), in place: y is the
// right side before and the solution after. The same as solve_unbordered of
// stiff_kernel.c for the first lane only.
static void real_solve_unbordered(const stiff_step *s, double *y)
{
    // elimination from tip to hub
    double fx = 0, fy = 0, t = 0;
    for (int k = s->links - 1; k >= 0; k--) {
        const stiff_pivot *p = &s->pivot[k];
        double *own = &y[s->first + k];
        *own = (*own - t - (p->lc * fy - p->ls * fx)) * p->inverse.r[0];
        fx += p->ux.r[0] * *own;
        fy += p->uy.r[0] * *own;
        t = -p->kappa.r[0] * *own;
    }
    if (s->first > 0) {
        y[0] = (y[0] - t) * s->hub_inverse.r[0];
    }

    // substitution from hub to tip
    double ax = 0, ay = 0, before = y[0];
    for (int k = 0; k < s->links; k++) {
        const stiff_pivot *p = &s->pivot[k];
        double *own = &y[s->first + k];
        if (s->first + k > 0) {
            const double base = p->ux.r[0] * ax + p->uy.r[0] * ay;
            *own += p->share.r[0] * before - base * p->inverse.r[0];
        }
        before = *own;
        ax -= p->ls * before;
        ay += p->lc * before;
    }
}

// Solves the real system with its borders, in place; `target` is the right side of the
// contact's equation.
static void real_solve_bordered(const stiff_step *s, double target, double *y)
{
    real_solve_unbordered(s, y);
    const int count = stiff_borders(s);
    double z[STIFF_BORDERS];

    // the borders' own small system: its right side, forwards and back through its
    // factors
    for (int i = 0; i < count; i++) {
        const double sum = real_row_product(s, stiff_border_row(s, i), y);
        if (i < s->modes) {
            z[i] = s->g.r[0] * sum;
        } else if (s->contact == STIFF_GIVES) {
            z[i] = target + s->press.r[0] * sum;
        } else {
            z[i] = target - sum;
        }
        for (int j = 0; j < i; j++) {
            z[i] -= s->corner[i][j].r[0] * z[j];
        }
    }
    for (int i = count - 1; i >= 0; i--) {
        for (int j = i + 1; j < count; j++) {
            z[i] -= s->corner[i][j].r[0] * z[j];
        }
        z[i] *= s->corner[i][i].r[0];
    }

    // the borders' unknowns act on the bodies
    for (int i = 0; i < count; i++) {
        for (int k = 0; k < s->dof; k++) {
            y[k] += z[i] * s->border[i][k].r[0];
        }
    }
}

// The difference between the embedded formula and the stages for the integral over the
// step of a quantity with these values at the stages; `start` is radau_start times its
// value at the step's start.
static double quadrature_error(const stiff_step *s, double start,
                               const stiff_nodes *values)
{
    double sum = start;
    for (int i = 0; i < RADAU_STAGES; i++) {
        sum += radau_difference[i] * values->at[i];
    }
    return s->length * sum;
}

// Moment of inertia of the stretched arm about the hub [kg m2], with each link's mass at
// its end, and into *reach the arm's length [m].
static double stretched_inertia(const stiff_step *s, double *reach)
{
    double inertia = s->hub_inertia;
    *reach = 0;
    for (int k = 0; k < s->links; k++) {
        *reach += s->link[k].length;
        inertia += s->link[k].mass * *reach * *reach;
    }
    return inertia;
}

// The error of a current that flows through an inductance, as a momentum: that which its
// torque would give the stretched arm in the time 1 / ANGLE_RATE. It is filtered like the
// other errors, by 1 + R / (L gamma).
static double current_error(const stiff_step *s, double gamma, bool twice)
{
    const motor_model *m = s->motor;
    const double volts = m->gain * m->voltage - m->back_emf * s->w0[0];
    const double start =
        radau_start * (volts - m->resistance * s->current0) / m->inductance;
    const double filter = 1 + m->resistance / (m->inductance * gamma);
    double reach;
    const double filtered =
        quadrature_error(s, start, &s->current_rate) / (twice ? filter * filter : filter);
    return m->torque_constant * filtered /
           (ANGLE_RATE * sqrt(stretched_inertia(s, &reach)));
}

// The error of the contact force's impulse, as a momentum of the stretched arm.
static double impulse_error(const stiff_step *s)
{
    double reach;
    const double inertia = stretched_inertia(s, &reach);
    return quadrature_error(s, radau_start * s->force0, &s->force) * reach /
           sqrt(inertia);
}

// Filters the errors of angles x and velocities w by the real system, in place: solves
// (1 - g J) e = (x, w) for e, J being the tangent of the equations of motion and
// g = 1 / gamma.
static void filter(stiff_integrator *integrator, double gamma, double *x, double *w)
{
    stiff_step *s = &integrator->step;
    double *y = integrator->scratch[2];
    for (int k = 0; k < s->dof; k++) {
        w[k] = gamma * (w[k] + gamma * x[k]);
    }
    inertia_and_damping(s, gamma, w, x, y, integrator->scratch[3],
                        integrator->scratch[3] + s->links);

    // the contact's equation
    double target = 0;
    if (s->contact != STIFF_FREE) {
        const double along_x = real_row_product(s, s->jacobian, x),
                     along_w = real_row_product(s, s->jacobian, w);
        if (s->contact == STIFF_RIGID) {
            target = gamma * gamma * along_x;
        } else {
            target = -gamma * s->wall_damping * along_x - s->wall->face_mass * along_w;
        }
    }
    real_solve_bordered(s, target, y);
    for (int k = 0; k < s->dof; k++) {
        w[k] = y[k] / gamma - gamma * x[k];
        x[k] = y[k] / (gamma * gamma);
    }
}

double stiff_error(stiff_integrator *integrator, bool twice)
{
    // what the embedded formula adds to angles (x) and velocities (w)
    stiff_step *s = &integrator->step;
    const double h = s->length, gamma = 1 / (h * radau_start);
    double *x = integrator->scratch[0], *w = integrator->scratch[1];
    integrator->loops->differences(s, x, w);
    for (int k = 0; k < s->dof; k++) {
        x[k] *= h;
        w[k] *= h;
    }

    // filtered once, or again to take out decays that end within the step
    filter(integrator, gamma, x, w);
    if (twice) {
        filter(integrator, gamma, x, w);
    }

    // both as momenta
    for (int k = 0; k < s->dof; k++) {
        x[k] *= ANGLE_RATE;
    }
    const double of_velocities = stiff_momentum(integrator, w);
    const double of_angles = stiff_momentum(integrator, x);
    double square = of_velocities * of_velocities + of_angles * of_angles;

    // and the errors of the current and of the wall's impulse
    if (s->drive == STIFF_FLOWS) {
        const double of_current = current_error(s, gamma, twice);
        square += of_current * of_current;
    }
    if (s->contact == STIFF_GIVES) {
        const double of_impulse = impulse_error(s);
        square += of_impulse * of_impulse;
    }
    return sqrt(square);
}
