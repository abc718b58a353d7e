#include "src/solve/printed_algorithm.h"

#include <math.h>
#include <string.h>

#include "src/arm/printed_arm.h"
#include "src/base/dense.h"

// Below this force contact is given up at the next step [N].
#define RELEASE_FORCE 1e-6

// What Table 3.2 carries from step to step.
typedef struct algorithm_state {
    double time;                // [s]
    double angle[3];            // [rad]
    double velocity[3];         // [rad/s]
    double fed_acceleration[3]; // what the next step starts from [rad/s2]
    double newmark_force;       // the constraint's force in Newmark's own system, a first guess [N]
    double force;               // as re-evaluated [N]
    bool in_contact;            // the constraint is to be enforced in the coming step
    int contact_steps;          // steps since contact began, zero only before the first of them
} algorithm_state;

// The end of a step that may yet be refused.
typedef struct step_result {
    double angle[3], velocity[3];
    double newmark_acceleration[3]; // from (3.7)
    double acceleration[3];         // re-evaluated where contact is, else Newmark's own
    double newmark_force;
    bool constrained;
} step_result;

// Velocities and accelerations that Newmark's approximation (3.6), (3.7) gives for angles q at the
// end of a step that started from s.
static void newmark_rates(const method_parameters *m, const algorithm_state *s, const double q[3],
                          double w[3], double alpha[3])
{
    double h = m->step;
    for (int i = 0; i < 3; i++) {
        double free =
            s->angle[i] + h * s->velocity[i] + h * h * (0.5 - m->beta) * s->fed_acceleration[i];
        alpha[i] = (q[i] - free) / (h * h * m->beta);
        w[i] = s->velocity[i] + h * ((1 - m->gamma) * s->fed_acceleration[i] + m->gamma * alpha[i]);
    }
}

// Solves the discretised equations by a fixed number of Newton steps (3.8) from the state at the
// start of the time step: three unknowns in free flight, four with the constraint (3.9). It ends
// early once residual or change are nil. The first guess, unchanged angles, implies velocities of
// about (1 - gamma/beta) times the old ones, of the wrong sign: with a single Newton step the
// friction of (2.15) would push the hub on, so that at least two are needed.
static status solve_step(const printed_arm *a, const parameters *p, const algorithm_state *s,
                         step_result *r)
{
    const double tolerance = 1e-6;
    const method_parameters *m = &p->method;
    newmark_slopes slopes = {1 / (m->beta * m->step * m->step), m->gamma / (m->beta * m->step)};
    int n = r->constrained ? 4 : 3;
    double x[4] = {s->angle[0], s->angle[1], s->angle[2], r->constrained ? s->newmark_force : 0};

    for (int iteration = 0; iteration < p->printed.newton_iterations; iteration++) {
        double w[3], alpha[3], residual[4], full[4][4], matrix[16], error = 0, change = 0;
        newmark_rates(m, s, x, w, alpha);
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
    r->newmark_force = r->constrained ? x[3] : 0;
    newmark_rates(m, s, r->angle, r->velocity, r->newmark_acceleration);
    return STATUS_OK;
}

// Chooses the system to solve as the listing does: the constraint stays as long as the force is
// positive, and in any case for the first step of a contact.
static void choose_mode(algorithm_state *s, step_result *r)
{
    r->constrained = s->in_contact && (s->force > RELEASE_FORCE || s->contact_steps == 0);
    if (r->constrained) {
        s->contact_steps++;
        return;
    }
    // the step of the release itself keeps its count: it may not begin a new contact
    if (!s->in_contact) {
        s->contact_steps = 0;
    }
    s->in_contact = false;
    s->newmark_force = 0;
}

// Accelerations and force from (2.15)-(2.17) and (3.13), the second run of the thesis's strategy.
// With `force_after_release` the listing's own condition, which looks at the last force and not at
// the contact, so that a force may outlive it.
static status reevaluate(const printed_arm *a, algorithm_state *s, step_result *r)
{
    bool wanted = r->constrained;
    if (a->switches.force_after_release) {
        wanted = s->force > 0 || s->contact_steps == 1;
    }
    memcpy(r->acceleration, r->newmark_acceleration, sizeof r->acceleration);
    if (!wanted) {
        s->force = 0;
        return STATUS_OK;
    }
    if (!printed_reevaluate(a, r->angle, r->velocity, r->acceleration, &s->force)) {
        return STATUS_SINGULAR;
    }
    s->force = fmax(s->force, 0);
    return STATUS_OK;
}

// One time step of Table 3.2 into *r. A step that ends behind the wall is taken back and done again
// with the constraint.
static status take_step(const printed_arm *a, const parameters *p, algorithm_state *s,
                        step_result *r)
{
    for (;;) {
        choose_mode(s, r);
        status result = solve_step(a, p, s, r);
        if (result == STATUS_OK) {
            result = reevaluate(a, s, r);
        }
        if (result != STATUS_OK) {
            return result;
        }
        bool touched = !s->in_contact && s->contact_steps == 0 && a->has_wall &&
                       printed_penetration(a, r->angle) >= 0;
        if (!touched) {
            return STATUS_OK;
        }
        s->in_contact = true;
    }
}

// Name of the first number of the step's end that is not finite, or NULL.
static const char *not_finite(const step_result *r, double force)
{
    static const char *const names[3][3] = {
        {"theta1 (hub angle)", "theta2 (first link's angle)", "theta3 (second link's angle)"},
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
    return isfinite(force) ? NULL : "the contact force";
}

static void accept_step(const parameters *p, const step_result *r, algorithm_state *s)
{
    const double *fed =
        p->printed.feed_newmark_acceleration ? r->newmark_acceleration : r->acceleration;
    memcpy(s->angle, r->angle, sizeof s->angle);
    memcpy(s->velocity, r->velocity, sizeof s->velocity);
    memcpy(s->fed_acceleration, fed, sizeof s->fed_acceleration);
    s->newmark_force = r->newmark_force;
}

static printed_row row_of(const printed_arm *a, const algorithm_state *s, const step_result *r)
{
    printed_row row = {.time = s->time, .force = s->force, .contact = r->constrained};
    memcpy(row.angle, r->angle, sizeof row.angle);
    memcpy(row.velocity, r->velocity, sizeof row.velocity);
    memcpy(row.acceleration, r->acceleration, sizeof row.acceleration);
    memcpy(row.newmark_acceleration, r->newmark_acceleration, sizeof row.newmark_acceleration);
    row.gap = a->has_wall ? -printed_penetration(a, r->angle) : HUGE_VAL;
    return row;
}

status printed_run(const parameters *given, printed_observer observe, printed_script script,
                   void *context, fault *f)
{
    parameters p = *given;
    printed_arm a;
    printed_arm_init(&a, &p);
    algorithm_state s = {.time = 0};
    step_result r = {.constrained = false};
    for (int i = 0; i < 3; i++) {
        s.angle[i] = r.angle[i] = p.initial.angle;
        s.velocity[i] = r.velocity[i] = p.initial.velocity;
    }
    // as listed, the first step starts from zero acceleration whatever the motor does
    printed_row row = row_of(&a, &s, &r);
    bool go_on = observe(context, &row);

    long steps = lround(p.run.duration / p.method.step);
    for (long step = 0; go_on && step < steps; step++) {
        if (script != NULL) {
            script(context, s.time, &p);
            printed_arm_init(&a, &p);
        }
        status result = take_step(&a, &p, &s, &r);
        if (result != STATUS_OK) {
            return fault_set(f, result, "the equations of the step from t = %.9g s %s contact %s",
                             s.time, r.constrained ? "in" : "without",
                             result == STATUS_SINGULAR ? "are singular"
                                                       : "have a residual that is not finite");
        }
        const char *name = not_finite(&r, s.force);
        if (name != NULL) {
            return fault_set(f, STATUS_NOT_FINITE,
                             "%s is not finite after the step from t = %.9g s to t = %.9g s", name,
                             s.time, (double)(step + 1) * p.method.step);
        }
        s.time = (double)(step + 1) * p.method.step;
        accept_step(&p, &r, &s);
        row = row_of(&a, &s, &r);
        go_on = observe(context, &row);
    }
    return STATUS_OK;
}
