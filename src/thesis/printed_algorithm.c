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
        double free = from->angle[i] + h * from->velocity[i] +
                      h * h * (0.5 - beta) * m->fed_acceleration[i];
        alpha[i] = (q[i] - free) / (h * h * beta);
        w[i] = from->velocity[i] +
               h * ((1 - gamma) * m->fed_acceleration[i] + gamma * alpha[i]);
    }
}

// Solves the discretised equations by a fixed number of Newton steps (3.8) from the state
// at the start of the time step: three unknowns in free flight, four with the constraint
// (3.9). It ends early once residual or change are nil. The first guess, unchanged
// angles, implies velocities of about (1 - gamma/beta) times the old ones, of the wrong
// sign: with a single Newton step the friction of (2.15) would push the hub on, so that
// at least two are needed.
static status solve_printed_step(printed_motion *m, printed_row *r)
{
    const double tolerance = 1e-6, h = m->method.step;
    const printed_arm *a = &m->arm;
    const double *start = m->row.angle;
    newmark_slopes slopes = {1 / (m->method.beta * h * h),
                             m->method.gamma / (m->method.beta * h)};
    double x[4] = {start[0], start[1], start[2], 0};
    int n = 3;
    if (r->contact) {
        x[3] = m->newmark_force;
        n = 4;
    }

    for (int iteration = 0; iteration < a->switches.newton_iterations; iteration++) {
        double w[3], alpha[3], residual[4], full[4][4], matrix[16], error = 0, change = 0;

        // the system at the present guess
        newmark_rates(m, x, w, alpha);
        printed_residual(a, x, w, alpha, x[3], residual);
        printed_newmark_jacobian(a, slopes, x, w, alpha, x[3], full);
        for (int i = 0; i < n; i++) {
            memcpy(matrix + i * n, full[i], (size_t)n * sizeof(double));
            residual[i] = -residual[i];
            error += fabs(residual[i]);
        }
        if (!isfinite(error)) {
            return STATUS_NOT_FINITE;
        }
        if (error <= tolerance) {
            break;
        }

        // its correction
        if (!dense_solve(n, matrix, residual)) {
            return STATUS_SINGULAR;
        }
        for (int i = 0; i < n; i++) {
            x[i] += residual[i];
            change += fabs(residual[i]);
        }
        if (change <= tolerance) {
            break;
        }
    }

    memcpy(r->angle, x, sizeof r->angle);
    if (r->contact) {
        m->newmark_force = x[3];
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

// Accelerations and force from (2.15)-(2.17) and (3.13), the second run of the thesis's
// strategy. With `force_after_release` the listing's own condition, which looks at the
// last force and not at the contact, so that a force may outlive it.
static status reevaluate(printed_motion *m, printed_row *r)
{
    bool wanted = r->contact;
    if (m->arm.switches.force_after_release) {
        wanted = m->force > 0 || m->contact_steps == 1;
    }

    memcpy(r->acceleration, r->newmark_acceleration, sizeof r->acceleration);
    if (!wanted) {
        m->force = 0;
        return STATUS_OK;
    }

    // the single run has the multiplier of the constraint, and nothing but Newmark's
    // accelerations
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

// One time step of Table 3.2 into *r. A step that ends behind the wall is taken back and
// done again with the constraint.
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

// Name of the first number of the step's end that is not finite, or NULL.
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
