#include "src/thesis/printed_algorithm.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/dense.h"

// Below this force contact is given up at the next step [N].
#define RELEASE_FORCE 1e-6

// Velocities and accelerations that Newmark's approximation (3.6), (3.7) gives for angles
// q at the end of a step that starts from m->row.
static void newmark_rates(const printed_motion *m, const double q[3], double w[3],
                          double alpha[3])
{
    const printed_row *from = &m->row;
    double h = m->method.step, beta = m->method.beta, gamma = m->method.gamma;
    for (int i = 0; i < 3; i++) {
        // what alpha adds to the angle known before it is beta h^2 alpha
        double predicted = from->angle[i] + h * from->velocity[i] +
                           h * h * (0.5 - beta) * m->fed_acceleration[i];
        alpha[i] = (q[i] - predicted) / (h * h * beta);
        w[i] = from->velocity[i] +
               h * ((1 - gamma) * m->fed_acceleration[i] + gamma * alpha[i]);
    }
}

// Sets up one Newton step (3.8) at a guess of the `count` unknowns: the three angles and,
// with the constraint (3.9), the force. matrix[count * count] gets the Jacobian and
// right_side[4] minus the residual; returns the sum of the residual's magnitudes.
static double set_up_newton_step(const printed_motion *m, const double unknown[4],
                                 int count, double *matrix, double right_side[4])
{
    const double h = m->method.step;
    const newmark_slopes slopes = {1 / (m->method.beta * h * h),
                                   m->method.gamma / (m->method.beta * h)};
    const double force = unknown[3];
    double velocity[3], acceleration[3], jacobian[4][4], error = 0;

    // Newmark's rule makes velocities and accelerations functions of the angles
    newmark_rates(m, unknown, velocity, acceleration);
    printed_residual(&m->arm, unknown, velocity, acceleration, force, right_side);
    printed_newmark_jacobian(&m->arm, slopes, unknown, velocity, acceleration, force,
                             jacobian);

    // without the constraint its row and column are left out
    for (int i = 0; i < count; i++) {
        memcpy(matrix + i * count, jacobian[i], (size_t)count * sizeof(double));
        right_side[i] = -right_side[i];
        error += fabs(right_side[i]);
    }
    return error;
}

// Solves the discretised equations by a fixed number of Newton steps (3.8) from the state
// at the start of the time step: three unknowns in free flight, four with the constraint
// (3.9). It ends early once residual or change are below a tolerance. The first guess,
// unchanged angles, implies velocities of about (1 - gamma/beta) times the old ones, of
// the wrong sign: with a single Newton step the friction of (2.15) would push the hub on,
// so that at least two are needed.
static status solve_printed_step(printed_motion *m, printed_row *r)
{
    const double tolerance = 1e-6;
    const double *start = m->row.angle;
    double unknown[4] = {start[0], start[1], start[2], 0};
    int count = 3;
    if (r->contact) {
        unknown[3] = m->newmark_force;
        count = 4;
    }

    // Newton's method; the solution of each linear system is the change of the unknowns
    for (int i = 0; i < m->arm.switches.newton_iterations; i++) {
        double matrix[16], correction[4];
        const double error = set_up_newton_step(m, unknown, count, matrix, correction);
        if (!isfinite(error)) {
            return STATUS_NOT_FINITE;
        }
        if (error <= tolerance) {
            break;
        }
        if (!dense_solve(count, matrix, correction)) {
            return STATUS_SINGULAR;
        }

        double change = 0;
        for (int k = 0; k < count; k++) {
            unknown[k] += correction[k];
            change += fabs(correction[k]);
        }
        if (change <= tolerance) {
            break;
        }
    }

    // the step's end
    memcpy(r->angle, unknown, sizeof r->angle);
    if (r->contact) {
        m->newmark_force = unknown[3];
    } else {
        m->newmark_force = 0;
    }
    newmark_rates(m, r->angle, r->velocity, r->newmark_acceleration);
    return STATUS_OK;
}

// Chooses the system to solve as the listing does: the constraint stays as long as the
// force is positive, and in any case for the first step of a contact.
static void choose_system(printed_motion *m, printed_row *r)
{
    r->contact = m->in_contact && (m->force > RELEASE_FORCE || m->contact_steps == 0);
    if (r->contact) {
        m->contact_steps++;
        return;
    }
    // the step of the release itself keeps its count: it may not begin a new contact
    if (!m->in_contact) {
        m->contact_steps = 0;
    }
    m->in_contact = false;
    m->newmark_force = 0;
}

// Computes accelerations and force again from (2.15)-(2.17) and (3.13): the second run of
// the thesis's strategy. It happens in contact or, with `force_after_release`, where the
// listing does it: that looks at the last force instead of the contact, so that a force
// may last longer than its contact.
static status reevaluate(printed_motion *m, printed_row *r)
{
    bool has_force = r->contact;
    if (m->arm.switches.force_after_release) {
        has_force = m->force > 0 || m->contact_steps == 1;
    }

    // without a force Newmark's accelerations stay
    memcpy(r->acceleration, r->newmark_acceleration, sizeof r->acceleration);
    if (!has_force) {
        m->force = 0;
        return STATUS_OK;
    }

    // a strategy without the second run takes the constraint's multiplier as the force
    if (m->arm.switches.reevaluation == REEVALUATE_NONE) {
        m->force = m->newmark_force;
    } else if (!printed_reevaluate(&m->arm, r->angle, r->velocity, r->acceleration,
                                   &m->force)) {
        return STATUS_SINGULAR;
    }
    if (m->arm.switches.clamp_force) {
        m->force = fmax(m->force, 0);
    }
    return STATUS_OK;
}

// Computes one time step of Table 3.2 into *r. If a free step ends behind the wall, it is
// computed again with the constraint.
static status try_step(printed_motion *m, printed_row *r)
{
    for (;;) {
        choose_system(m, r);
        TRY(solve_printed_step(m, r)); // with Newmark's rule
        TRY(reevaluate(m, r));

        // the strategy of Table 3.2: contact is found by its violation
        bool touched = !m->in_contact && m->contact_steps == 0 &&
                       wall_stands(&m->arm.wall) &&
                       printed_penetration(&m->arm, r->angle) >= 0;
        if (!touched) {
            return STATUS_OK;
        }
        m->in_contact = true;
    }
}

// The name of the first number that is not finite at the step's end, or NULL if all are.
static const char *not_finite(const printed_row *r)
{
    static const char *const names[3][3] = {
        {"theta1 (hub angle)", "theta2 (first link's angle)",
         "theta3 (second link's angle)"},
        {"the hub's velocity", "the first link's velocity", "the second link's velocity"},
        {"the hub's acceleration", "the first link's acceleration",
         "the second link's acceleration"}};

    const double *values[3] = {r->angle, r->velocity, r->acceleration};
    for (int kind = 0; kind < 3; kind++) {
        for (int i = 0; i < 3; i++) {
            if (!isfinite(values[kind][i])) {
                return names[kind][i];
            }
        }
    }
    if (isfinite(r->force)) {
        return NULL;
    }
    return "the contact force";
}

// Gap between the arm and the wall at these angles [m], infinite without a wall.
static double gap_at(const printed_arm *a, const double angle[3])
{
    if (wall_stands(&a->wall)) {
        return -printed_penetration(a, angle);
    }
    return HUGE_VAL;
}

void printed_motion_start(printed_motion *m, const parameters *p)
{
    assert(p->method.step > 0);
    memset(m, 0, sizeof *m);
    printed_motion_rebind(m, p);
    m->step_count = lround(p->run.duration / p->method.step);
    for (int i = 0; i < 3; i++) {
        m->row.angle[i] = p->initial.angle;
        m->row.velocity[i] = p->initial.velocity;
    }
    m->row.gap = gap_at(&m->arm, m->row.angle);
}

void printed_motion_rebind(printed_motion *m, const parameters *p)
{
    printed_arm_init(&m->arm, p);
    m->method = p->method;
}

bool printed_motion_ended(const printed_motion *m)
{
    return m->steps >= m->step_count;
}

status printed_motion_step(printed_motion *m, fault *f)
{
    assert(!printed_motion_ended(m));
    const double start = m->row.time, end = (double)(m->steps + 1) * m->method.step;
    printed_row r = {.time = end};

    // the equations' own failures
    status result = try_step(m, &r);
    const char *where = r.contact ? "in" : "without";
    const char *why = "have a residual that is not finite";
    if (result == STATUS_SINGULAR) {
        why = "are singular";
    }
    FAULT_IF(result != STATUS_OK, f, result,
             "the equations of the step from t = %.9g s %s contact %s", start, where,
             why);

    // an overflow, reported before the next step starts from it
    r.force = m->force;
    const char *name = not_finite(&r);
    FAULT_IF(name != NULL, f, STATUS_NOT_FINITE,
             "%s is not finite after the step from t = %.9g s to t = %.9g s", name, start,
             end);

    // the step's end is what the next one starts from
    const double *fed = r.acceleration;
    if (m->arm.switches.feed_newmark_acceleration) {
        fed = r.newmark_acceleration;
    }
    memcpy(m->fed_acceleration, fed, sizeof m->fed_acceleration);
    m->steps++;
    r.gap = gap_at(&m->arm, r.angle);
    m->row = r;
    return STATUS_OK;
}
