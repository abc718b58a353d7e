#include "tests/reference/soft_wall.h"

#include <math.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_odeiv2.h>

// Behind angles and velocities: wall's loss, work, drag, impulse, depth of the face and its rate.
enum { MOST = 9, AFTER = 6, SIZE = 2 * MOST + AFTER };

#define LOOK       5e-5  // between two looks at the events [s]
#define RESOLUTION 1e-13 // of an event [s]
#define TOLERANCE  1e-13 // of the integrator

typedef enum phase { FREE, PRESSED } phase;

typedef struct soft_arm {
    const soft_wall_case *c;
    int bodies, first;
    double length, mass, torque, drag;
    double inertia[MOST], root[MOST]; // [kg m2], springs between the bodies [N m/rad]
    phase now;
    bool face_rests; // at its stop, until the arm presses it
} soft_arm;

static void build(soft_arm *arm, const soft_wall_case *c)
{
    const double kt = 0.249092 * 9.80665;
    memset(arm, 0, sizeof *arm);
    arm->c = c;
    arm->first = c->beam_root ? 1 : 0;
    arm->bodies = c->links + arm->first;
    arm->length = 1.0 / c->links;
    arm->mass = 0.40108 / c->links;
    for (int i = arm->first; i < arm->bodies; i++) {
        arm->inertia[i] = arm->mass * arm->length * arm->length / 12;
    }
    arm->inertia[0] += 5.2e-3;
    for (int i = 0; i + 1 < arm->bodies; i++) {
        arm->root[i] = 4.92 * c->links / (i < arm->first ? 1.0 : 2.0);
    }
    arm->torque = 6.02 * kt / 33.6 * c->voltage;
    arm->drag = kt * 2.443 / 33.6 + 5.4192e-3;
}

// Depth behind the wall's face and its gradient by the angles.
static double depth_at(const soft_arm *arm, const double *q, double *gradient)
{
    const int last = arm->bodies - 1;
    const double phi = 0.1, l = arm->length;
    double x = 0, y = 0, depth;
    for (int i = arm->first; i < last; i++) {
        x += l * cos(q[i]);
        y += l * sin(q[i]);
    }
    memset(gradient, 0, sizeof(double) * MOST);
    if (arm->c->plane_wall) {
        x += l * cos(q[last]);
        y += l * sin(q[last]);
        depth = y * cos(phi) - x * sin(phi);
        for (int i = arm->first; i <= last; i++) {
            gradient[i] = l * cos(q[i] - phi);
        }
        return depth;
    }
    // the point lies to the right of the last link's line by the depth
    double dx = cos(phi) - x, dy = sin(phi) - y, c = cos(q[last]), s = sin(q[last]);
    for (int i = arm->first; i < last; i++) {
        gradient[i] = l * cos(q[last] - q[i]);
    }
    gradient[last] = dx * c + dy * s;
    return dx * s - dy * c;
}

static double depth_rate(const soft_arm *arm, const double *y, double *depth)
{
    double gradient[MOST], rate = 0;
    *depth = depth_at(arm, y, gradient);
    for (int i = 0; i < arm->bodies; i++) {
        rate += gradient[i] * y[arm->bodies + i];
    }
    return rate;
}

static double law(const soft_wall_case *c, double depth, double rate)
{
    if (!c->hunt_crossley) {
        return c->stiffness * depth + c->damping * rate;
    }
    return depth > 0 ? exp(c->exponent * log(depth)) * (c->stiffness + c->damping * rate) : 0;
}

static double stored(const soft_wall_case *c, double depth)
{
    double n = c->hunt_crossley ? c->exponent : 1;
    return depth > 0 ? c->stiffness * pow(depth, n + 1) / (n + 1) : 0;
}

static bool has_mass(const soft_arm *arm)
{
    return arm->c->face_mass > 0;
}

// Depth and rate of the wall's face. With a mass it is integrated, without one it is where the arm
// is or, left alone, as fast as a law without force demands.
static void face_at(const soft_arm *arm, const double *y, double *x, double *v)
{
    const double *face = y + 2 * arm->bodies + 4, k = arm->c->stiffness, c = arm->c->damping;
    *x = face[0];
    *v = face[1];
    if (arm->now == PRESSED) {
        *v = depth_rate(arm, y, x);
    } else if (arm->face_rests) {
        *x = *v = 0;
    } else if (!has_mass(arm)) {
        *v = arm->c->hunt_crossley ? -k / c : -k * *x / c;
    }
}

// How fast the rate of the depth grows at constant angular velocities: dG/dt w.
static double depth_bend(const soft_arm *arm, const double *y)
{
    const double phi = 0.1, l = arm->length;
    const int last = arm->bodies - 1;
    const double *q = y, *w = y + arm->bodies, c = cos(q[last]), s = sin(q[last]);
    double sum = 0, dx = cos(phi), dy = sin(phi), along = 0;
    for (int i = arm->first; arm->c->plane_wall && i <= last; i++) {
        sum -= l * sin(q[i] - phi) * w[i] * w[i];
    }
    if (arm->c->plane_wall) {
        return sum;
    }
    for (int i = arm->first; i < last; i++) {
        sum -= l * sin(q[last] - q[i]) * (w[last] - w[i]) * w[i];
        dx -= l * cos(q[i]);
        dy -= l * sin(q[i]);
        along += l * (-sin(q[i]) * c + cos(q[i]) * s) * w[i];
    }
    return sum + (-along + (dy * c - dx * s) * w[last]) * w[last];
}

// Velocity of the centre of link k, or of the tip for k = bodies, per unit velocity of body i.
static double lever(const soft_arm *arm, int i, int k)
{
    return i < arm->first || i > k ? 0 : i == k ? arm->length / 2 : arm->length;
}

static double coupling(const soft_arm *arm, int i, int j)
{
    double sum = arm->c->tip_mass * lever(arm, i, arm->bodies) * lever(arm, j, arm->bodies);
    for (int k = arm->first; k < arm->bodies; k++) {
        sum += arm->mass * lever(arm, i, k) * lever(arm, j, k);
    }
    return sum;
}

// Solves (mass matrix + face G G') x = right; face is zero unless arm and face move as one.
static void accelerate(const soft_arm *arm, const double *q, double face, double *right, double *x)
{
    const int n = arm->bodies;
    double m[MOST * MOST], gradient[MOST];
    depth_at(arm, q, gradient);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            m[i * n + j] = coupling(arm, i, j) * cos(q[i] - q[j]) + (i == j ? arm->inertia[i] : 0) +
                           face * gradient[i] * gradient[j];
        }
    }
    gsl_matrix_view matrix = gsl_matrix_view_array(m, (size_t)n, (size_t)n);
    gsl_vector_view b = gsl_vector_view_array(right, (size_t)n);
    gsl_vector_view solution = gsl_vector_view_array(x, (size_t)n);
    gsl_linalg_cholesky_decomp1(&matrix.matrix);
    gsl_linalg_cholesky_solve(&matrix.matrix, &b.vector, &solution.vector);
}

static double energy_at(const soft_arm *arm, const double *y)
{
    const int n = arm->bodies;
    double sum = 0, x, v;
    for (int i = 0; i < n; i++) {
        sum += arm->inertia[i] * y[n + i] * y[n + i] / 2;
        for (int j = 0; j < n; j++) {
            sum += coupling(arm, i, j) * cos(y[i] - y[j]) * y[n + i] * y[n + j] / 2;
        }
        if (i + 1 < n) {
            sum += arm->root[i] * (y[i + 1] - y[i]) * (y[i + 1] - y[i]) / 2;
        }
    }
    face_at(arm, y, &x, &v);
    return sum + arm->c->face_mass * v * v / 2 + stored(arm->c, fabs(x));
}

// The accelerations x, the face's among them, and the force at a state.
static double dynamics(const soft_arm *arm, const double *y, double *x, double *face)
{
    const int n = arm->bodies;
    double right[MOST] = {0}, gradient[MOST], depth, force = 0;
    const double rate = depth_rate(arm, y, &depth), bend = depth_bend(arm, y);
    const double joined = arm->now == PRESSED ? arm->c->face_mass : 0;
    depth_at(arm, y, gradient);
    if (arm->now == PRESSED) {
        force = law(arm->c, depth, rate) + joined * bend;
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            right[i] -= coupling(arm, i, j) * sin(y[i] - y[j]) * y[n + j] * y[n + j];
        }
        right[i] -= gradient[i] * force;
        right[i] += i + 1 < n ? arm->root[i] * (y[i + 1] - y[i]) : 0;
        right[i] -= i > 0 ? arm->root[i - 1] * (y[i] - y[i - 1]) : 0;
    }
    right[0] += arm->torque - arm->drag * y[n];
    accelerate(arm, y, joined, right, x);

    // the face goes along, or on its own
    *face = 0;
    if (joined > 0) {
        *face = bend;
        for (int i = 0; i < n; i++) {
            *face += gradient[i] * x[i];
        }
        force = law(arm->c, depth, rate) + arm->c->face_mass * *face;
    } else if (has_mass(arm) && !arm->face_rests) {
        *face = -law(arm->c, y[2 * n + 4], y[2 * n + 5]) / arm->c->face_mass;
    }
    return force;
}

static double force_at(const soft_arm *arm, const double *y)
{
    double x[MOST], face;
    return arm->now == PRESSED ? dynamics(arm, y, x, &face) : 0;
}

static int derivative(double t, const double y[], double dydt[], void *context)
{
    (void)t;
    const soft_arm *arm = context;
    const int n = arm->bodies;
    double x[MOST], face, depth, rate;
    const double f = dynamics(arm, y, x, &face);
    face_at(arm, y, &depth, &rate);
    for (int i = 0; i < n; i++) {
        dydt[i] = y[n + i];
        dydt[n + i] = x[i];
    }
    double spring = law(&(soft_wall_case){.hunt_crossley = arm->c->hunt_crossley,
                                          .stiffness = arm->c->stiffness,
                                          .exponent = arm->c->exponent},
                        depth, rate);
    dydt[2 * n] = (law(arm->c, depth, rate) - spring) * rate;
    dydt[2 * n + 1] = arm->torque * y[n];
    dydt[2 * n + 2] = arm->drag * y[n] * y[n];
    dydt[2 * n + 3] = f;
    dydt[2 * n + 4] = rate;
    dydt[2 * n + 5] = face;
    return GSL_SUCCESS;
}

typedef struct soft_run {
    soft_arm arm;
    gsl_odeiv2_system system;
    gsl_odeiv2_driver *driver;
    double time, y[SIZE];
    bool failed;
} soft_run;

// The state h later, in the present phase.
static void later(soft_run *r, double h, double *y)
{
    double t = 0;
    memcpy(y, r->y, sizeof r->y);
    if (h > 0) {
        gsl_odeiv2_driver_reset_hstart(r->driver, fmin(h, 1e-7));
        r->failed |= gsl_odeiv2_driver_apply(r->driver, &t, h, y) != GSL_SUCCESS;
    }
}

// What ends the present phase when it falls below zero: 0 the way to the face, or in contact to its
// place at rest, 1 the force, or of Hunt and Crossley's the factor that may be negative, 2 the way
// of their face to its stop.
static double watched(const soft_run *r, const double *y, int which)
{
    const soft_wall_case *c = r->arm.c;
    double depth, rate = depth_rate(&r->arm, y, &depth), x, v;
    face_at(&r->arm, y, &x, &v);
    if (r->arm.now == FREE) {
        return which == 0                                             ? x - depth
               : which == 2 && c->hunt_crossley && !r->arm.face_rests ? x
                                                                      : 1;
    }
    if (has_mass(&r->arm)) {
        return which == 1 ? force_at(&r->arm, y) : 1;
    }
    return which == 0         ? depth
           : which == 2       ? 1
           : c->hunt_crossley ? c->stiffness + c->damping * rate
                              : law(c, depth, rate);
}

// The first instant in (0, h] at which something ends the phase; h and which = -1 if nothing does.
static double first_end(soft_run *r, double h, int *which)
{
    double y[SIZE];
    *which = -1;
    for (int w = 0; w < 3; w++) {
        double lo = 0, hi = h;
        later(r, h, y);
        // what starts at its edge (a touch) may be below it by rounding only
        if (!(watched(r, y, w) < 0)) {
            continue;
        }
        while (hi - lo > RESOLUTION) {
            double x = (lo + hi) / 2;
            later(r, x, y);
            if (watched(r, y, w) < 0 && x > 1e-10) {
                hi = x;
            } else {
                lo = x;
            }
        }
        h = hi;
        *which = w;
    }
    return h;
}

// The largest force (sign 1) or depth (sign 0) within the next h, by golden section.
static double largest(soft_run *r, double h, bool force, double *at)
{
    const double ratio = (sqrt(5) - 1) / 2;
    double lo = 0, hi = h, best = 0, y[SIZE], depth;
    while (hi - lo > 1e-11) {
        double x[2] = {hi - ratio * (hi - lo), lo + ratio * (hi - lo)}, v[2];
        for (int i = 0; i < 2; i++) {
            later(r, x[i], y);
            depth_rate(&r->arm, y, &depth);
            v[i] = force ? force_at(&r->arm, y) : depth;
        }
        best = fmax(v[0], v[1]);
        *at = (lo + hi) / 2;
        if (v[0] < v[1]) {
            lo = x[0];
        } else {
            hi = x[1];
        }
    }
    return best;
}

// Arm and face strike each other and go on as one.
static void strike(soft_run *r, soft_wall_answer *a)
{
    const int n = r->arm.bodies;
    double gradient[MOST], right[MOST], x[MOST], depth, compliance = 1 / r->arm.c->face_mass;
    double speed = depth_rate(&r->arm, r->y, &depth) - r->y[2 * n + 5];
    depth_at(&r->arm, r->y, gradient);
    memcpy(right, gradient, sizeof right);
    accelerate(&r->arm, r->y, 0, right, x);
    for (int i = 0; i < n; i++) {
        compliance += gradient[i] * x[i];
    }
    const double impulse = speed / compliance;
    for (int i = 0; i < n; i++) {
        r->y[n + i] -= impulse * x[i];
    }
    r->y[2 * n + 5] += impulse / r->arm.c->face_mass;
    a->impulse = a->touches == 0 ? impulse : a->impulse;
    a->impact_loss += impulse * speed / 2;
}

// What the present phase gives way to.
static void change_phase(soft_run *r, int which, soft_wall_answer *a)
{
    double *face = r->y + 2 * r->arm.bodies + 4, depth;
    depth_rate(&r->arm, r->y, &depth);
    if (which == 2) {
        // the stop takes what a mass still has
        r->y[2 * r->arm.bodies] += r->arm.c->face_mass * face[1] * face[1] / 2;
        r->arm.face_rests = true;
        face[0] = face[1] = 0;
    } else if (r->arm.now == FREE) {
        if (has_mass(&r->arm)) {
            strike(r, a);
        }
        r->arm.now = PRESSED;
        r->arm.face_rests = false;
        face[0] = depth;
        a->touches++;
        a->first_contact = a->touches == 1 ? r->time : a->first_contact;
        a->third_contact = a->touches == 3 ? r->time : a->third_contact;
    } else {
        r->arm.now = FREE;
        r->arm.face_rests = !has_mass(&r->arm) && (which == 0 || r->arm.c->damping == 0);
        a->first_pulse = a->first_pulse < 0 ? r->time - a->first_contact : a->first_pulse;
    }
}

bool soft_wall_simulate(const soft_wall_case *c, soft_wall_answer *a)
{
    soft_run r = {.arm = {.now = FREE}};
    build(&r.arm, c);
    r.arm.face_rests = true;
    const int n = r.arm.bodies;
    r.system = (gsl_odeiv2_system){derivative, NULL, (size_t)(2 * n + AFTER), &r.arm};
    r.driver =
        gsl_odeiv2_driver_alloc_y_new(&r.system, gsl_odeiv2_step_rk8pd, 1e-6, TOLERANCE, TOLERANCE);
    *a = (soft_wall_answer){.first_contact = -1, .first_pulse = -1, .third_contact = -1};
    double window = c->duration - 0.1, at_window = 0;
    while (r.time < c->duration - 1e-12 && !r.failed) {
        double until = r.time < window - 1e-12 ? window : c->duration;
        if (fabs(r.time - window) <= 1e-12) {
            at_window = r.y[2 * n + 3];
        }
        int which;
        double h = first_end(&r, fmin(LOOK, until - r.time), &which), y[SIZE], at = 0;

        // largest force and depth of a look around which they rose and fell
        later(&r, h, y);
        double d0, d1, v0 = depth_rate(&r.arm, r.y, &d0), v1 = depth_rate(&r.arm, y, &d1);
        bool first_pulse = r.arm.now == PRESSED && a->first_pulse < 0;
        if (v0 > 0 && v1 < 0 && fmax(d0, d1) > 0.9 * a->deepest) {
            a->deepest = fmax(a->deepest, largest(&r, h, false, &at));
        }
        if (first_pulse) {
            double top = fmax(force_at(&r.arm, r.y), force_at(&r.arm, y));
            double found = top > 0.99 * a->peak ? largest(&r, h, true, &at) : 0;
            double start = force_at(&r.arm, r.y);
            if (start > found) {
                found = start;
                at = 0;
            }
            if (found > a->peak) {
                a->peak = found;
                a->peak_delay = r.time + at - a->first_contact;
            }
        }
        memcpy(r.y, y, sizeof y);
        r.time += h;
        if (which >= 0) {
            change_phase(&r, which, a);
        }
    }
    gsl_odeiv2_driver_free(r.driver);
    a->wall_loss = r.y[2 * n];
    a->steady_force = (r.y[2 * n + 3] - at_window) / 0.1;
    a->final_hub_angle = r.y[0];
    a->energy_residual =
        energy_at(&r.arm, r.y) - r.y[2 * n + 1] + r.y[2 * n + 2] + r.y[2 * n] + a->impact_loss;
    return !r.failed;
}
