#include "tests/reference/reference_bodies.h"

#include <string.h>

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

// --- the arm

// First frequency of the straight chain with its hub held, or with it the first link
// where that is fixed to it.
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

void body_chain_build(body_chain *arm, const reference_case *c)
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

double body_penetration(const body_chain *arm, const double *q, const double *w,
                        double *gradient, double *bias)
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

double body_gap_rate(const body_chain *arm, const double *q, const double *w)
{
    double gradient[BODIES_MAX], rate = 0.0;
    body_penetration(arm, q, w, gradient, NULL);
    for (int i = 0; i < arm->bodies; i++) {
        rate -= gradient[i] * w[i];
    }
    return rate;
}

double body_gap(const body_chain *arm, const double *q, const double *w)
{
    double gradient[BODIES_MAX];
    return -body_penetration(arm, q, w, gradient, NULL);
}

static void mass_matrix(const body_chain *arm, const double *q,
                        double m[BODIES_MAX][BODIES_MAX])
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

double body_energy(const body_chain *arm, const double *q, const double *w)
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

// --- dense systems

// By elimination with partial pivoting; false if singular.
static bool solve_dense(int n, double a[UNKNOWNS_MAX][UNKNOWNS_MAX], double *x)
{
    const size_t size = (size_t)n;
    size_t order[UNKNOWNS_MAX];
    int sign;
    gsl_permutation pivots = {size, order};
    gsl_matrix_view matrix =
        gsl_matrix_view_array_with_tda(a[0], size, size, UNKNOWNS_MAX);
    gsl_vector_view unknowns = gsl_vector_view_array(x, size);
    gsl_linalg_LU_decomp(&matrix.matrix, &pivots, &sign);
    for (int k = 0; k < n; k++) {
        if (!(fabs(a[k][k]) > 1e-14)) {
            return false;
        }
    }
    gsl_linalg_LU_svx(&matrix.matrix, &pivots, &unknowns.vector);
    return true;
}

bool balance_solve(const body_chain *arm, const double *q, const double *gradient,
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

bool balance_find(const body_chain *arm, const double *y, contact_mode mode, balance *out)
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
        double torque =
            arm->stiffness[i] * (q[i + 1] - q[i]) + arm->damping[i] * (w[i + 1] - w[i]);
        right[i] += torque;
        right[i + 1] -= torque;
    }
    right[0] += arm->motor_torque - arm->motor_drag * w[0] - mode.sliding * arm->coulomb;

    body_penetration(arm, q, w, gradient, &bias);
    bool done = balance_solve(arm, q, gradient, mode.touching, mode.sliding == 0, right,
                              -bias, out->acceleration, &out->force, &out->friction);
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
static double inadmissible(const body_chain *arm, contact_mode mode, bool may_touch,
                           bool at_rest, const balance *b)
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

bool mode_resolve(const body_chain *arm, const double *y, bool may_touch,
                  contact_mode *mode)
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
