#include "tests/reference/reference_arm.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

enum {
    LINKS_MAX = 64,
    BODIES_MAX = LINKS_MAX + 1,
    UNKNOWNS_MAX = BODIES_MAX + 2,
    // angles, velocities, motor work, viscous, Coulomb and damping loss, integral of the force
    EXTRA = 5,
    STATE_MAX = 2 * BODIES_MAX + EXTRA,
};

#define STEADY_WINDOW    0.1
#define SEPARATION_GAP   1e-6
#define REST_SPEED       1e-4 // slower impacts are plastic [m/s]
#define EVENT_RESOLUTION 1e-14
#define GAP_ROUNDING     1e-15 // of a gap [m]
#define EDGE_ROUNDING    4e-15 // of a gap, at most [m]

// math.h's are floats, which clang minds
#define NOTHING ((double)NAN)
#define NEVER   ((double)INFINITY)

typedef struct body_chain {
    int bodies, links, first_link;
    bool plane;
    double length;                            // of a link [m]
    double mass;                              // of a link [kg]
    double own_inertia[BODIES_MAX];           // about the centre of mass, with the hub's [kg m2]
    double coupling[BODIES_MAX][BODIES_MAX];  // A_ij [kg m2]
    double stiffness[BODIES_MAX];             // joint between body i and i + 1 [N m/rad]
    double damping[BODIES_MAX];               // of the same joint [N m s/rad]
    double motor_torque, motor_drag, coulomb; // [N m], [N m s/rad], [N m]
    double direction;                         // of the wall [rad]
    double restitution;
} body_chain;

typedef struct contact_mode {
    bool touching;
    int sliding; // -1, 0 (sticking), +1: direction of the hub's motion
} contact_mode;

// Accelerations and the forces that go with them.
typedef struct balance {
    double acceleration[BODIES_MAX];
    double force;            // contact [N]
    double friction;         // torque that opposes positive motion [N m]
    double gap_acceleration; // second derivative of the gap [m/s2]
} balance;

typedef struct flow {
    const body_chain *arm;
    contact_mode mode;
} flow;

// ---------------------------------------------------------------------------------------------
// the arm

// First frequency of the straight chain whose hub is held, or with it the first link where that is
// fixed to it.
static double first_clamped_frequency(const body_chain *arm)
{
    const int n = arm->bodies - 1; // body 0 rests
    gsl_matrix *k = gsl_matrix_calloc((size_t)n, (size_t)n);
    gsl_matrix *m = gsl_matrix_calloc((size_t)n, (size_t)n);
    gsl_vector *squares = gsl_vector_alloc((size_t)n);
    gsl_eigen_gensymm_workspace *work = gsl_eigen_gensymm_alloc((size_t)n);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            double own = i == j ? arm->own_inertia[i + 1] : 0;
            gsl_matrix_set(m, (size_t)i, (size_t)j, arm->coupling[i + 1][j + 1] + own);
        }
        gsl_matrix_set(k, (size_t)i, (size_t)i,
                       arm->stiffness[i] + (i + 1 < n ? arm->stiffness[i + 1] : 0));
        if (i + 1 < n) {
            gsl_matrix_set(k, (size_t)i, (size_t)i + 1, -arm->stiffness[i + 1]);
            gsl_matrix_set(k, (size_t)i + 1, (size_t)i, -arm->stiffness[i + 1]);
        }
    }
    gsl_eigen_gensymm(k, m, squares, work);
    double least = gsl_vector_min(squares);
    gsl_eigen_gensymm_free(work);
    gsl_vector_free(squares);
    gsl_matrix_free(m);
    gsl_matrix_free(k);
    return sqrt(least);
}

static void arm_build(body_chain *arm, const reference_case *c)
{
    const double beam_length = 1.0, beam_mass = 0.40108, hub_inertia = 5.2e-3;
    const double k1 = 169468.0882, k2 = 4.92;
    const double gain = 6.02, kt = 0.249092 * 9.80665, resistance = 33.6, kb = 2.443;
    memset(arm, 0, sizeof *arm);
    arm->links = c->links;
    arm->first_link = c->spring_hub || c->beam_root ? 1 : 0;
    arm->bodies = c->links + arm->first_link;
    arm->plane = c->plane_wall;
    arm->length = beam_length / c->links;
    arm->mass = beam_mass / c->links;
    for (int i = arm->first_link; i < arm->bodies; i++) {
        arm->own_inertia[i] = arm->mass * arm->length * arm->length / 12.0;
    }
    arm->own_inertia[0] += hub_inertia;

    // lever of body i in the velocity of the centre of link k
    for (int k = arm->first_link; k < arm->bodies; k++) {
        for (int i = arm->first_link; i <= k; i++) {
            for (int j = arm->first_link; j <= k; j++) {
                double lever_i = i < k ? arm->length : 0.5 * arm->length;
                double lever_j = j < k ? arm->length : 0.5 * arm->length;
                arm->coupling[i][j] += arm->mass * lever_i * lever_j;
            }
        }
    }
    for (int i = 0; i + 1 < arm->bodies; i++) {
        double root = c->beam_root ? k2 * c->links : k1;
        arm->stiffness[i] = i < arm->first_link ? root : 0.5 * k2 * c->links;
    }
    if (c->damping > 0) {
        double per_stiffness = 2 * c->damping / first_clamped_frequency(arm);
        for (int i = 0; i + 1 < arm->bodies; i++) {
            arm->damping[i] = per_stiffness * arm->stiffness[i];
        }
    }
    arm->motor_torque = gain * kt / resistance * c->voltage;
    arm->motor_drag = kt * kb / resistance + 5.4192e-3;
    arm->coulomb = 0.045;
    arm->direction = 0.1;
    arm->restitution = c->restitution;
}

// Penetration g (the gap is -g), its gradient, and the part of its second derivative that the
// velocities alone make.
static double penetration(const body_chain *arm, const double *q, const double *w, double *gradient,
                          double *bias)
{
    const int last = arm->bodies - 1;
    const double l = arm->length;
    double g = 0.0, velocity_part = 0.0;
    memset(gradient, 0, (size_t)arm->bodies * sizeof *gradient);
    if (arm->plane) {
        // height of the tip over the line through the hub axis
        for (int j = arm->first_link; j <= last; j++) {
            double s = sin(q[j] - arm->direction);
            g += l * s;
            gradient[j] = l * cos(q[j] - arm->direction);
            velocity_part -= l * s * w[j] * w[j];
        }
    } else {
        // distance of the fixed point from the line of the last link
        double a = cos(arm->direction), b = sin(arm->direction);
        double cn = cos(q[last]), sn = sin(q[last]);
        g = a * sn - b * cn;
        gradient[last] = a * cn + b * sn;
        velocity_part = (-a * sn + b * cn) * w[last] * w[last];
        for (int j = arm->first_link; j < last; j++) {
            double s = sin(q[last] - q[j]), co = cos(q[last] - q[j]);
            double relative = w[last] - w[j];
            g -= l * s;
            gradient[j] = l * co;
            gradient[last] -= l * co;
            velocity_part += l * s * relative * relative;
        }
    }
    if (bias) {
        *bias = velocity_part;
    }
    return g;
}

static double gap_rate(const body_chain *arm, const double *q, const double *w)
{
    double gradient[BODIES_MAX], rate = 0.0;
    penetration(arm, q, w, gradient, NULL);
    for (int i = 0; i < arm->bodies; i++) {
        rate -= gradient[i] * w[i];
    }
    return rate;
}

static double gap(const body_chain *arm, const double *q, const double *w)
{
    double gradient[BODIES_MAX];
    return -penetration(arm, q, w, gradient, NULL);
}

static void mass_matrix(const body_chain *arm, const double *q, double m[BODIES_MAX][BODIES_MAX])
{
    double c[BODIES_MAX], s[BODIES_MAX];
    for (int i = 0; i < arm->bodies; i++) {
        c[i] = cos(q[i]);
        s[i] = sin(q[i]);
    }
    for (int i = 0; i < arm->bodies; i++) {
        for (int j = 0; j < arm->bodies; j++) {
            m[i][j] = arm->coupling[i][j] * (c[i] * c[j] + s[i] * s[j]);
        }
        m[i][i] += arm->own_inertia[i];
    }
}

static double energy(const body_chain *arm, const double *q, const double *w)
{
    double m[BODIES_MAX][BODIES_MAX], sum = 0.0;
    mass_matrix(arm, q, m);
    for (int i = 0; i < arm->bodies; i++) {
        for (int j = 0; j < arm->bodies; j++) {
            sum += 0.5 * m[i][j] * w[i] * w[j];
        }
    }
    for (int i = 0; i + 1 < arm->bodies; i++) {
        double twist = q[i + 1] - q[i];
        sum += 0.5 * arm->stiffness[i] * twist * twist;
    }
    return sum;
}

// ---------------------------------------------------------------------------------------------
// dense systems

// Gaussian elimination with partial pivoting; false if singular.
static bool solve_dense(int n, double a[UNKNOWNS_MAX][UNKNOWNS_MAX], double *x)
{
    for (int k = 0; k < n; k++) {
        int pivot = k;
        for (int i = k + 1; i < n; i++) {
            if (fabs(a[i][k]) > fabs(a[pivot][k])) {
                pivot = i;
            }
        }
        if (!(fabs(a[pivot][k]) > 1e-14)) {
            return false;
        }
        for (int j = 0; j < n; j++) {
            double swap = a[k][j];
            a[k][j] = a[pivot][j];
            a[pivot][j] = swap;
        }
        double swap = x[k];
        x[k] = x[pivot];
        x[pivot] = swap;
        for (int i = k + 1; i < n; i++) {
            double factor = a[i][k] / a[k][k];
            for (int j = k; j < n; j++) {
                a[i][j] -= factor * a[k][j];
            }
            x[i] -= factor * x[k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++) {
            x[i] -= a[i][j] * x[j];
        }
        x[i] /= a[i][i];
    }
    return true;
}

// Solves M x + J' f + S' s = right, J x = along (if touching), S x = 0 (if sticking), where S
// picks the hub. Returns f and s.
static bool solve_bordered(const body_chain *arm, const double *q, const double *gradient,
                           bool touching, bool sticking, const double *right, double along,
                           double *x, double *f, double *s)
{
    double a[UNKNOWNS_MAX][UNKNOWNS_MAX], b[UNKNOWNS_MAX] = {0};
    double m[BODIES_MAX][BODIES_MAX];
    int n = arm->bodies, size = n;

    // as much of the matrix as this chain has
    for (int i = 0; i < n + 2; i++) {
        memset(a[i], 0, (size_t)(n + 2) * sizeof(double));
    }
    mass_matrix(arm, q, m);
    for (int i = 0; i < n; i++) {
        memcpy(a[i], m[i], (size_t)n * sizeof(double));
        b[i] = right ? right[i] : 0.0;
    }
    int contact_row = size;
    if (touching) {
        for (int i = 0; i < n; i++) {
            a[i][size] = a[size][i] = gradient[i];
        }
        b[size++] = along;
    }
    int stick_row = size;
    if (sticking) {
        a[0][size] = a[size][0] = 1.0;
        b[size++] = 0.0;
    }
    bool done = solve_dense(size, a, b);
    memcpy(x, b, (size_t)n * sizeof(double));
    *f = touching ? b[contact_row] : 0.0;
    *s = sticking ? b[stick_row] : 0.0;
    return done;
}

// Accelerations in a mode, whether or not the mode is admissible.
static bool balance_find(const body_chain *arm, const double *y, contact_mode mode, balance *out)
{
    const int n = arm->bodies;
    const double *q = y, *w = y + n;
    double right[BODIES_MAX] = {0}, gradient[BODIES_MAX], bias;
    double c[BODIES_MAX], s[BODIES_MAX];
    for (int i = 0; i < n; i++) {
        c[i] = cos(q[i]);
        s[i] = sin(q[i]);
    }
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            right[i] -= arm->coupling[i][j] * (s[i] * c[j] - c[i] * s[j]) * w[j] * w[j];
        }
    }
    for (int i = 0; i + 1 < n; i++) {
        double torque = arm->stiffness[i] * (q[i + 1] - q[i]) + arm->damping[i] * (w[i + 1] - w[i]);
        right[i] += torque;
        right[i + 1] -= torque;
    }
    right[0] += arm->motor_torque - arm->motor_drag * w[0] - mode.sliding * arm->coulomb;

    penetration(arm, q, w, gradient, &bias);
    bool done = solve_bordered(arm, q, gradient, mode.touching, mode.sliding == 0, right, -bias,
                               out->acceleration, &out->force, &out->friction);
    if (mode.sliding != 0) {
        out->friction = mode.sliding * arm->coulomb;
    }
    out->gap_acceleration = -bias;
    for (int i = 0; i < n; i++) {
        out->gap_acceleration -= gradient[i] * out->acceleration[i];
    }
    return done;
}

// How far a mode is from being admissible at this state; zero if it is.
static double inadmissible(const body_chain *arm, contact_mode mode, bool may_touch, bool at_rest,
                           const balance *b)
{
    double worst = 0.0;
    if (mode.touching) {
        worst = fmax(worst, -b->force);
    } else if (may_touch) {
        worst = fmax(worst, -b->gap_acceleration);
    }
    if (mode.sliding == 0) {
        worst = fmax(worst, fabs(b->friction) - arm->coulomb);
    } else if (at_rest) {
        worst = fmax(worst, -mode.sliding * b->acceleration[0]);
    }
    return worst;
}

// The admissible mode at a state: contact (only if the gap is closed and stays so) and friction
// together, by trying all combinations.
static bool mode_resolve(const body_chain *arm, const double *y, bool may_touch, contact_mode *mode)
{
    const double hub_speed = y[arm->bodies];
    double best = NEVER;
    for (int touching = may_touch ? 1 : 0; touching >= 0; touching--) {
        for (int k = 0; k < 3; k++) {
            const int directions[3] = {0, 1, -1};
            contact_mode trial = {touching != 0, directions[k]};
            bool at_rest = hub_speed == 0.0;
            if (!at_rest && trial.sliding != (hub_speed > 0.0 ? 1 : -1)) {
                continue;
            }
            balance b;
            if (!balance_find(arm, y, trial, &b)) {
                continue;
            }
            double violation = inadmissible(arm, trial, may_touch, at_rest, &b);
            if (violation < best) {
                best = violation;
                *mode = trial;
            }
        }
    }
    return best < 1e-6;
}

// ---------------------------------------------------------------------------------------------
// integration

static int derivative(double t, const double y[], double dydt[], void *context)
{
    (void)t;
    const flow *fl = context;
    const body_chain *arm = fl->arm;
    const int n = arm->bodies;
    balance b;
    if (!balance_find(arm, y, fl->mode, &b)) {
        return GSL_ESING;
    }
    for (int i = 0; i < n; i++) {
        dydt[i] = y[n + i];
        dydt[n + i] = b.acceleration[i];
    }
    if (fl->mode.sliding == 0) {
        dydt[0] = dydt[n] = 0.0;
    }
    dydt[2 * n] = arm->motor_torque * y[n];
    dydt[2 * n + 1] = arm->motor_drag * y[n] * y[n];
    dydt[2 * n + 2] = arm->coulomb * fabs(y[n]);
    dydt[2 * n + 3] = b.force;
    dydt[2 * n + 4] = 0.0;
    for (int i = 0; i + 1 < n; i++) {
        double rate = y[n + i + 1] - y[n + i];
        dydt[2 * n + 4] += arm->damping[i] * rate * rate;
    }
    return GSL_SUCCESS;
}

typedef struct simulation {
    const reference_case *c;
    body_chain arm;
    flow flow;
    gsl_odeiv2_system system;
    gsl_odeiv2_driver *driver;
    int size;
    double time;
    double y[STATE_MAX];
    double span;              // of the present step [s]
    double middle[STATE_MAX]; // state half way through it
    double end[STATE_MAX];    // and at its end
    double impact_loss;
    double start_energy; // kinetic [J]
    double impulses;     // of all impacts [N s]
    double phase_gap;    // largest gap of the present free phase
    double steady_from;  // integral of the force where the steady window begins
    bool in_first_pulse;
    int idle_events; // events in a row without time passing
    reference_answer *answer;
    char *message;
    int message_size;
} simulation;

static bool complain(simulation *s, const char *what)
{
    snprintf(s->message, (size_t)s->message_size, "%s: %s at t = %.15g s", s->c->name, what,
             s->time);
    return false;
}

// State after tau from `from`, in the present mode.
static bool advance(simulation *s, const double *from, double tau, double *to)
{
    memcpy(to, from, (size_t)s->size * sizeof(double));
    if (tau <= 0.0) {
        return true;
    }
    double t = 0.0;
    gsl_odeiv2_driver_reset_hstart(s->driver, tau);
    if (gsl_odeiv2_driver_apply(s->driver, &t, tau, to) != GSL_SUCCESS) {
        return complain(s, "the integrator gave up");
    }
    return true;
}

// Brings a touching state back onto gap = 0 and rate of gap = 0, the hub held if it sticks.
static bool project(simulation *s, double *y)
{
    const body_chain *arm = &s->arm;
    const int n = arm->bodies;
    bool held = s->flow.mode.sliding == 0;
    double gradient[BODIES_MAX], dx[BODIES_MAX], f, torque;
    for (int pass = 0; pass < 2; pass++) {
        double g = penetration(arm, y, y + n, gradient, NULL);
        if (!solve_bordered(arm, y, gradient, true, held, NULL, -g, dx, &f, &torque)) {
            return complain(s, "the projection is singular");
        }
        for (int i = 0; i < n; i++) {
            y[i] += held && i == 0 ? 0.0 : dx[i];
        }
    }
    double rate = -gap_rate(arm, y, y + n);
    penetration(arm, y, y + n, gradient, NULL);
    if (!solve_bordered(arm, y, gradient, true, held, NULL, -rate, dx, &f, &torque)) {
        return complain(s, "the projection is singular");
    }
    for (int i = 0; i < n; i++) {
        y[n + i] += held && i == 0 ? 0.0 : dx[i];
    }
    return true;
}

static double contact_force(simulation *s, const double *y)
{
    balance b;
    balance_find(&s->arm, y, s->flow.mode, &b);
    return b.force;
}

// ---------------------------------------------------------------------------------------------
// events: functions that are positive while the mode lasts

typedef enum event_function {
    GAP_OPEN,
    FORCE_PRESSES,
    HUB_MOVES,
    HUB_HELD,
    EVENT_FUNCTIONS
} event_function;

static bool event_active(contact_mode mode, event_function e)
{
    switch (e) {
    case GAP_OPEN:
        return !mode.touching;
    case FORCE_PRESSES:
        return mode.touching;
    case HUB_MOVES:
        return mode.sliding != 0;
    default:
        return mode.sliding == 0;
    }
}

static double event_value(const simulation *s, event_function e, const double *y)
{
    const int n = s->arm.bodies;
    contact_mode mode = s->flow.mode;
    if (e == GAP_OPEN) {
        return gap(&s->arm, y, y + n);
    }
    if (e == HUB_MOVES) {
        return mode.sliding * y[n];
    }
    balance b;
    balance_find(&s->arm, y, mode, &b);
    return e == FORCE_PRESSES ? b.force : s->arm.coulomb - fabs(b.friction);
}

// Value of an event function tau after the step's beginning.
static double event_value_at(simulation *s, event_function e, double tau)
{
    double y[STATE_MAX];
    return advance(s, s->y, tau, y) ? event_value(s, e, y) : NOTHING;
}

// Golden-section search over [lo, hi] for the least value of sign * (event function).
static double extreme_at(simulation *s, event_function e, double sign, double lo, double hi)
{
    const double ratio = 0.5 * (sqrt(5.0) - 1.0);
    double x1 = hi - ratio * (hi - lo), x2 = lo + ratio * (hi - lo);
    double v1 = sign * event_value_at(s, e, x1), v2 = sign * event_value_at(s, e, x2);
    while (hi - lo > 1e-11) {
        if (v1 < v2) {
            hi = x2;
            x2 = x1;
            v2 = v1;
            x1 = hi - ratio * (hi - lo);
            v1 = sign * event_value_at(s, e, x1);
        } else {
            lo = x1;
            x1 = x2;
            v1 = v2;
            x2 = lo + ratio * (hi - lo);
            v2 = sign * event_value_at(s, e, x2);
        }
    }
    return 0.5 * (lo + hi);
}

// Where the parabola through three equally spaced values has its extremum, in units of the whole
// interval; NaN if it is straight.
static double parabola_vertex(double v0, double vm, double v1)
{
    double bend = v0 - 2.0 * vm + v1;
    return bend != 0.0 ? 0.5 + 0.25 * (v0 - v1) / bend : NOTHING;
}

// Looks for the first zero of one event function in the present step; returns its offset, just
// past the zero, or NEVER.
static double event_offset(simulation *s, event_function e)
{
    double v0 = event_value(s, e, s->y), vm = event_value(s, e, s->middle),
           v1 = event_value(s, e, s->end);
    double lo = 0.0, hi = NEVER;
    if (vm < 0.0) {
        hi = 0.5 * s->span;
    } else if (v1 < 0.0) {
        lo = 0.5 * s->span;
        hi = s->span;
    } else {
        // a dip between the looks
        double x = parabola_vertex(v0, vm, v1);
        double bottom = vm - 0.125 * (v1 - v0) * (v1 - v0) / (v0 - 2.0 * vm + v1);
        bool dips = v0 - 2.0 * vm + v1 > 0.0 && x > 0.0 && x < 1.0 && v0 > 0.0 &&
                    bottom < 0.1 * fmin(v0, v1);
        if (dips) {
            // just after release the gap grows with the third power of time, so it is rounding only
            double at = extreme_at(s, e, 1.0, 0.0, s->span);
            if (event_value_at(s, e, at) < (e == GAP_OPEN ? -GAP_ROUNDING : 0.0)) {
                hi = at;
            }
        }
    }
    if (isinf(hi)) {
        return NEVER;
    }
    // just after a change of mode the function starts at zero, up to rounding: find where it rose
    double edge = 0.0;
    if (lo == 0.0 && v0 <= 0.0) {
        double probe = hi, value;
        do {
            probe *= 0.5;
            value = event_value_at(s, e, probe);
        } while (probe > EVENT_RESOLUTION && !(value > 0.0));
        // nowhere, as far as rounding tells: a flight too low for that ends beyond it
        edge = e == GAP_OPEN && !(value > 0.0) ? -EDGE_ROUNDING : 0.0;
        lo = edge < 0.0 ? 0.0 : probe;
    }
    while (hi - lo > EVENT_RESOLUTION) {
        double x = 0.5 * (lo + hi);
        if (event_value_at(s, e, x) < edge) {
            hi = x;
        } else {
            lo = x;
        }
    }
    return hi;
}

// ---------------------------------------------------------------------------------------------
// bookkeeping

static void note_force(simulation *s, double tau, double force)
{
    reference_answer *a = s->answer;
    double delay = s->time + tau - a->first_contact;
    if (!(force <= a->peak)) {
        a->peak = force;
        a->peak_delay = delay;
    }
    if (s->in_first_pulse && !(force <= a->first_pulse_peak)) {
        a->first_pulse_peak = force;
        a->first_pulse_delay = delay;
    }
}

// Notes the largest force or gap within the accepted step.
static void note_step(simulation *s)
{
    const int n = s->arm.bodies;
    if (s->flow.mode.touching) {
        double v0 = contact_force(s, s->y), vm = contact_force(s, s->middle),
               v1 = contact_force(s, s->end);
        double x = parabola_vertex(v0, vm, v1);
        note_force(s, 0.0, v0);
        note_force(s, s->span, v1);
        if (v0 - 2.0 * vm + v1 < 0.0 && x > -0.1 && x < 1.1) {
            double top = fmax(vm, fmax(v0, v1));
            if (!(top < 0.9 * s->answer->peak) ||
                (s->in_first_pulse && !(top < 0.9 * s->answer->first_pulse_peak))) {
                double at = extreme_at(s, FORCE_PRESSES, -1.0, 0.0, s->span);
                note_force(s, at, event_value_at(s, FORCE_PRESSES, at));
            }
        }
    } else {
        double v0 = gap(&s->arm, s->y, s->y + n), vm = gap(&s->arm, s->middle, s->middle + n),
               v1 = gap(&s->arm, s->end, s->end + n), bend = v0 - 2.0 * vm + v1;
        double x = parabola_vertex(v0, vm, v1), top = fmax(v0, fmax(vm, v1));
        if (bend < 0.0 && x > 0.0 && x < 1.0) {
            top = fmax(top, vm - 0.125 * (v1 - v0) * (v1 - v0) / bend);
        }
        s->phase_gap = fmax(s->phase_gap, top);
    }
}

static void note_energy(simulation *s)
{
    const int n = s->arm.bodies;
    double residual = energy(&s->arm, s->y, s->y + n) - s->y[2 * n] + s->y[2 * n + 1] +
                      s->y[2 * n + 2] + s->y[2 * n + 4] + s->impact_loss - s->start_energy;
    s->answer->energy_residual = fmax(s->answer->energy_residual, fabs(residual));
}

// A free phase after first contact is over.
static void note_touch(simulation *s)
{
    reference_answer *a = s->answer;
    a->touches++;
    if (s->phase_gap > SEPARATION_GAP) {
        a->separations++;
        a->smallest_separation = fmin(a->smallest_separation, s->phase_gap);
    } else {
        a->largest_touch = fmax(a->largest_touch, s->phase_gap);
    }
}

// ---------------------------------------------------------------------------------------------
// the machine

static bool mode_change(simulation *s, bool may_touch)
{
    contact_mode before = s->flow.mode;
    if (!mode_resolve(&s->arm, s->y, may_touch, &s->flow.mode)) {
        return complain(s, "no mode is admissible");
    }
    bool released = before.touching && !s->flow.mode.touching;
    if (released) {
        s->phase_gap = 0.0;
        if (s->in_first_pulse) {
            s->in_first_pulse = false;
            s->answer->first_pulse = s->time - s->answer->first_contact;
        }
    }
    return true;
}

// The gap has closed: M dw = -J'p, J (w + dw) = -e J w, then contact or release.
static bool impact(simulation *s)
{
    const body_chain *arm = &s->arm;
    const int n = arm->bodies;
    reference_answer *a = s->answer;
    double gradient[BODIES_MAX], dw[BODIES_MAX], p, unused;
    bool first = isnan(a->first_contact);
    if (first) {
        a->first_contact = s->time;
        s->in_first_pulse = true;
    } else {
        note_touch(s);
    }
    double approach = -gap_rate(arm, s->y, s->y + n);
    double restitution = approach < REST_SPEED ? 0.0 : arm->restitution;
    if (approach > 0.0) {
        penetration(arm, s->y, s->y + n, gradient, NULL);
        double before = energy(arm, s->y, s->y + n);
        if (!solve_bordered(arm, s->y, gradient, true, false, NULL, -(1.0 + restitution) * approach,
                            dw, &p, &unused)) {
            return complain(s, "the impact is singular");
        }
        for (int i = 0; i < n; i++) {
            s->y[n + i] += dw[i];
        }
        s->impact_loss += before - energy(arm, s->y, s->y + n);
        s->impulses += p;
        a->impacts++;
        a->last_impact = s->time;
        a->slowest_approach = fmin(a->slowest_approach, approach);
        if (first) {
            a->first_impulse = p;
            a->first_approach = approach;
        }
    }
    // contact can hold only if nothing was given back
    bool may_touch = restitution == 0.0;
    s->flow.mode.touching = true;
    if (may_touch) {
        contact_mode pressed = {true, s->y[n] > 0.0 ? 1 : (s->y[n] < 0.0 ? -1 : 0)};
        balance b;
        balance_find(arm, s->y, pressed, &b);
        a->weakest_hold = fmin(a->weakest_hold, fabs(b.force));
    }
    if (!mode_change(s, may_touch)) {
        return false;
    }
    return !s->flow.mode.touching || project(s, s->y);
}

// Takes the step up to the earliest event, and the event.
static bool step(simulation *s, double span)
{
    const int n = s->arm.bodies;
    s->span = span;
    if (!advance(s, s->y, 0.5 * span, s->middle) || !advance(s, s->middle, 0.5 * span, s->end)) {
        return false;
    }
    double earliest = NEVER;
    event_function which = EVENT_FUNCTIONS;
    for (event_function e = 0; e < EVENT_FUNCTIONS; e++) {
        double offset = event_active(s->flow.mode, e) ? event_offset(s, e) : NEVER;
        if (offset < earliest) {
            earliest = offset;
            which = e;
        }
    }
    if (which != EVENT_FUNCTIONS) {
        s->span = earliest;
        if (!advance(s, s->y, 0.5 * earliest, s->middle) || !advance(s, s->y, earliest, s->end)) {
            return false;
        }
    }
    note_step(s);
    s->idle_events = which != EVENT_FUNCTIONS && s->span < 1e-12 ? s->idle_events + 1 : 0;
    if (s->idle_events > 20) {
        return complain(s, "events follow one another without time passing");
    }
    s->time += s->span;
    memcpy(s->y, s->end, sizeof s->y);
    if (s->flow.mode.touching) {
        s->answer->largest_gap_error =
            fmax(s->answer->largest_gap_error, fabs(gap(&s->arm, s->y, s->y + n)));
        if (!project(s, s->y)) {
            return false;
        }
    }
    bool done = true;
    if (which == GAP_OPEN) {
        done = impact(s);
    } else if (which != EVENT_FUNCTIONS) {
        if (which == HUB_MOVES) {
            s->y[n] = 0.0;
        }
        done = mode_change(s, s->flow.mode.touching);
        if (done && s->flow.mode.touching) {
            done = project(s, s->y);
        }
    }
    note_energy(s);
    return done;
}

static bool run(simulation *s)
{
    const reference_case *c = s->c;
    const int n = s->arm.bodies;
    const double window_start = c->duration - STEADY_WINDOW;
    bool window_open = false;
    for (int i = 0; i < n; i++) {
        s->y[i] = c->angle;
        s->y[n + i] = c->velocity;
    }
    s->start_energy = energy(&s->arm, s->y, s->y + n);
    if (!mode_resolve(&s->arm, s->y, false, &s->flow.mode)) {
        return complain(s, "no mode is admissible");
    }
    while (s->time < c->duration) {
        if (!window_open && s->time >= window_start) {
            s->steady_from = s->y[2 * n + 3];
            window_open = true;
        }
        double until = window_open ? c->duration : window_start;
        reference_answer *a = s->answer;
        if (!isnan(a->first_contact) && a->samples < REFERENCE_SAMPLES) {
            double sample = a->first_contact + a->samples * REFERENCE_INTERVAL;
            if (sample - s->time < 1e-12) {
                a->momentum[a->samples++] = s->impulses + s->y[2 * n + 3];
                continue;
            }
            until = fmin(until, sample);
        }
        double left = until - s->time;
        if (left < 1e-12) {
            s->time = until;
            continue;
        }
        if (!step(s, fmin(left, c->longest_step))) {
            return false;
        }
    }
    if (!isnan(s->answer->first_contact) && !s->flow.mode.touching) {
        note_touch(s);
    }
    s->answer->steady_force = (s->y[2 * n + 3] - s->steady_from) / STEADY_WINDOW;
    s->answer->final_hub_angle = s->y[0];
    s->answer->motor_work = s->y[2 * n];
    s->answer->viscous_loss = s->y[2 * n + 1];
    s->answer->friction_loss = s->y[2 * n + 2];
    s->answer->damping_loss = s->y[2 * n + 4];
    s->answer->impact_loss = s->impact_loss;
    return true;
}

bool reference_simulate(const reference_case *c, reference_answer *answer, char *message, int size)
{
    simulation s = {.c = c, .answer = answer, .message = message, .message_size = size};
    *answer = (reference_answer){.first_contact = NOTHING,
                                 .first_impulse = NOTHING,
                                 .first_approach = NOTHING,
                                 .first_pulse_peak = NOTHING,
                                 .first_pulse_delay = NOTHING,
                                 .first_pulse = NOTHING,
                                 .peak = NOTHING,
                                 .peak_delay = NOTHING,
                                 .last_impact = NOTHING,
                                 .smallest_separation = NEVER,
                                 .slowest_approach = NEVER,
                                 .weakest_hold = NEVER};
    gsl_set_error_handler_off();
    arm_build(&s.arm, c);
    s.flow.arm = &s.arm;
    s.size = 2 * s.arm.bodies + EXTRA;
    s.system = (gsl_odeiv2_system){derivative, NULL, (size_t)s.size, &s.flow};
    s.driver = gsl_odeiv2_driver_alloc_y_new(&s.system, gsl_odeiv2_step_rk8pd, c->longest_step,
                                             c->tolerance, c->tolerance);
    if (!s.driver) {
        return complain(&s, "no memory for the integrator");
    }
    bool done = run(&s);
    gsl_odeiv2_driver_free(s.driver);
    return done;
}

// ---------------------------------------------------------------------------------------------
// check of the equations

// Kinetic minus strain energy from the links' positions, without the mass matrix.
static double lagrangian(const body_chain *arm, const double *q, const double *w)
{
    double vx = 0.0, vy = 0.0, sum = 0.0;
    for (int i = 0; i < arm->bodies; i++) {
        sum += 0.5 * arm->own_inertia[i] * w[i] * w[i];
        if (i >= arm->first_link) {
            double half = 0.5 * arm->length;
            double cx = vx - half * w[i] * sin(q[i]), cy = vy + half * w[i] * cos(q[i]);
            sum += 0.5 * arm->mass * (cx * cx + cy * cy);
            vx -= 2.0 * half * w[i] * sin(q[i]);
            vy += 2.0 * half * w[i] * cos(q[i]);
        }
        if (i + 1 < arm->bodies) {
            sum -= 0.5 * arm->stiffness[i] * (q[i + 1] - q[i]) * (q[i + 1] - q[i]);
        }
    }
    return sum;
}

// Penetration from the positions of joint and tip.
static double penetration_by_position(const body_chain *arm, const double *q)
{
    double x = 0.0, y = 0.0, before_x = 0.0, before_y = 0.0;
    for (int i = arm->first_link; i < arm->bodies; i++) {
        before_x = x;
        before_y = y;
        x += arm->length * cos(q[i]);
        y += arm->length * sin(q[i]);
    }
    double a = cos(arm->direction), b = sin(arm->direction);
    if (arm->plane) {
        return a * y - b * x;
    }
    // cross product of the last link's direction with joint minus point
    double ex = (x - before_x) / arm->length, ey = (y - before_y) / arm->length;
    return ey * (a - before_x) - ex * (b - before_y);
}

// Angles and velocities tau later at constant acceleration.
static void along_path(int n, const double *y, const double *acceleration, double tau, double *q,
                       double *w)
{
    for (int i = 0; i < n; i++) {
        q[i] = y[i] + tau * y[n + i] + 0.5 * tau * tau * acceleration[i];
        w[i] = y[n + i] + tau * acceleration[i];
    }
}

// Momentum of body i (dL/dw_i) there; exact, since L is quadratic in w.
static double momentum_along(const body_chain *arm, const double *y, const double *acceleration,
                             double tau, int i)
{
    double q[BODIES_MAX], up[BODIES_MAX], down[BODIES_MAX];
    along_path(arm->bodies, y, acceleration, tau, q, up);
    memcpy(down, up, sizeof down);
    up[i] += 1.0;
    down[i] -= 1.0;
    return 0.5 * (lagrangian(arm, q, up) - lagrangian(arm, q, down));
}

static double penetration_along(const body_chain *arm, const double *y, const double *acceleration,
                                double tau)
{
    double q[BODIES_MAX], w[BODIES_MAX];
    along_path(arm->bodies, y, acceleration, tau, q, w);
    return penetration_by_position(arm, q);
}

// A number between -1 and 1 from a linear congruential generator (Knuth, MMIX).
static double random_number(unsigned long long *seed)
{
    *seed = *seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(*seed >> 11) / 4503599627370496.0 - 1.0;
}

double reference_lagrangian_defect(const reference_case *c, unsigned seed)
{
    body_chain arm;
    arm_build(&arm, c);
    const int n = arm.bodies;
    double y[STATE_MAX] = {0}, worst = 0.0;
    unsigned long long state = seed;
    for (int i = 0; i < n; i++) {
        y[i] = 0.5 * random_number(&state);
        y[n + i] = 2.0 * random_number(&state);
        // the stiff hub spring would drown everything else
        y[i] = i == 1 && arm.first_link == 1 ? y[0] + 1e-5 * y[i] : y[i];
    }
    balance b;
    contact_mode mode = {true, y[n] > 0.0 ? 1 : -1};
    if (!balance_find(&arm, y, mode, &b)) {
        return NEVER;
    }
    double fastest = 1.0, largest = 1.0, gradient[BODIES_MAX], bias;
    for (int i = 0; i < n; i++) {
        fastest = fmax(fastest, fabs(b.acceleration[i]));
    }
    const double h = 1e-3 / sqrt(fastest);
    double g = penetration(&arm, y, y + n, gradient, &bias);
    for (int i = 0; i < n; i++) {
        // d/dt dL/dw_i - dL/dq_i - Q_i, differences of fourth order
        double rate = (8.0 * (momentum_along(&arm, y, b.acceleration, h, i) -
                              momentum_along(&arm, y, b.acceleration, -h, i)) -
                       momentum_along(&arm, y, b.acceleration, 2.0 * h, i) +
                       momentum_along(&arm, y, b.acceleration, -2.0 * h, i)) /
                      (12.0 * h);
        double slope[2], step_sizes[2] = {h, 2.0 * h}, across[2];
        for (int k = 0; k < 2; k++) {
            double up[BODIES_MAX], down[BODIES_MAX];
            memcpy(up, y, (size_t)n * sizeof(double));
            memcpy(down, y, (size_t)n * sizeof(double));
            up[i] += step_sizes[k];
            down[i] -= step_sizes[k];
            slope[k] = (lagrangian(&arm, up, y + n) - lagrangian(&arm, down, y + n)) /
                       (2.0 * step_sizes[k]);
            across[k] = (penetration_by_position(&arm, up) - penetration_by_position(&arm, down)) /
                        (2.0 * step_sizes[k]);
        }
        double applied = -(4.0 * across[0] - across[1]) / 3.0 * b.force;
        if (i == 0) {
            applied += arm.motor_torque - arm.motor_drag * y[n] - mode.sliding * arm.coulomb;
        }
        double defect = rate - (4.0 * slope[0] - slope[1]) / 3.0 - applied;
        worst = fmax(worst, fabs(defect));
        largest = fmax(largest, fabs(rate));
    }
    worst /= largest;
    // the gap itself, and that it does not accelerate in contact
    worst = fmax(worst, fabs(g - penetration_by_position(&arm, y)));
    double bend = 0.0;
    const double weights[5] = {-1.0, 16.0, -30.0, 16.0, -1.0};
    for (int k = 0; k < 5; k++) {
        bend += weights[k] * penetration_along(&arm, y, b.acceleration, (k - 2) * h);
    }
    return fmax(worst, fabs(bend) / (12.0 * h * h) / fastest);
}

void reference_print(const reference_case *c, const reference_answer *a)
{
    printf("%s\n", c->name);
    const struct {
        const char *label;
        double value;
    } lines[] = {
        {"first_contact_s", a->first_contact},
        {"first_approach_m_s", a->first_approach},
        {"contact_impulse_Ns", a->first_impulse},
        {"first_pulse_peak_N", a->first_pulse_peak},
        {"first_pulse_time_to_peak_s", a->first_pulse_delay},
        {"first_pulse_s", a->first_pulse},
        {"peak_force_N", a->peak},
        {"time_to_peak_s", a->peak_delay},
        {"steady_force_N", a->steady_force},
        {"impacts", a->impacts},
        {"touches", a->touches},
        {"separations", a->separations},
        {"smallest_separation_m", a->smallest_separation},
        {"largest_touch_m", a->largest_touch},
        {"slowest_approach_m_s", a->slowest_approach},
        {"last_impact_s", a->last_impact},
        {"weakest_hold_N", a->weakest_hold},
        {"final_hub_angle_rad", a->final_hub_angle},
        {"motor_work_J", a->motor_work},
        {"viscous_loss_J", a->viscous_loss},
        {"friction_loss_J", a->friction_loss},
        {"impact_loss_J", a->impact_loss},
        {"energy_residual_J", a->energy_residual},
        {"largest_gap_error_m", a->largest_gap_error},
    };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        printf("    %-28s %.15g\n", lines[i].label, lines[i].value);
    }
}
