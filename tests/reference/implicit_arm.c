#include "tests/reference/implicit_arm.h"

#include <complex.h>
#include <math.h>
#include <string.h>

#undef I // of complex.h

#include "src/arm/arm.h"

// The state: angles q[n], velocities w[n], the motor's current, depth and velocity of the wall's
// face.
enum { MOST_BODIES = 26, MOST = 2 * MOST_BODIES + 3, STAGES = 3, SAMPLES = 8 };
enum { MOST_STEPS = 2000000, MOST_ITERATIONS = 12 };

#define SHORTEST   1e-14 // step [s]
#define TINY_GAP   1e-14 // of a gap that counts as none [m]
#define TINY_RATE  1e-13 // of a velocity of the hub [rad/s]
#define TINY_FORCE 1e-10 // [N]

// What holds between events.
typedef struct phase {
    bool contact, parted; // parted: a face without a mass is on its way back
    int friction;         // 0 stuck, 1, -1: sliding
    int limited;          // the current is at its limit, 1 or -1
} phase;

// What a state entails.
typedef struct answer {
    double force, friction;                 // of the wall [N], of the hub [N m]
    double gap, gap_rate, gap_acceleration; // to the wall's place at rest; -g
    double current, free_current;
    double viscous, damping, wall; // power lost [W]
    double work;                   // of the motor [W]
} answer;

// Quadratures along the motion.
enum { SUM_FORCE, SUM_VISCOUS, SUM_DAMPING, SUM_WALL, SUM_WORK, SUM_FRICTION, SUMS };

typedef struct simulation {
    const arm *a;
    int n, first;
    double coupling[MOST_BODIES][MOST_BODIES]; // of links: factor of cos(difference)
    double y[MOST], t, h;
    phase now;
    double sums[SUMS];
    double largest_rate, largest_angle;            // scales of what an iteration changes
    double start;                                  // angle of all bodies at the start [rad]
    double turned[MOST_BODIES], rate[MOST_BODIES]; // scales of errors, each body's largest
    double tolerance;
    double stage[STAGES][MOST]; // of the step tried: state at the stages
    double end[MOST];           // and at its end
    double added[SUMS];
    double impulses, impact_loss;
    double left; // the wall, at last [s]
    chain_outcome *o;
} simulation;

// --- dense linear algebra -----------------------------------------------------------------------

// Solves m x = b for `count` right-hand sides in place by elimination with pivots.
static void solve_dense(int n, double m[][MOST_BODIES + 1], double b[][MOST_BODIES + 1], int count)
{
    for (int p = 0; p < n; p++) {
        int best = p;
        for (int i = p + 1; i < n; i++) {
            best = fabs(m[i][p]) > fabs(m[best][p]) ? i : best;
        }
        for (int k = 0; k < n; k++) {
            const double swap = m[p][k];
            m[p][k] = m[best][k];
            m[best][k] = swap;
        }
        for (int r = 0; r < count; r++) {
            const double swap = b[r][p];
            b[r][p] = b[r][best];
            b[r][best] = swap;
        }
        for (int i = p + 1; i < n; i++) {
            const double f = m[i][p] / m[p][p];
            for (int k = p + 1; k < n && f != 0; k++) {
                m[i][k] -= f * m[p][k];
            }
            for (int r = 0; r < count && f != 0; r++) {
                b[r][i] -= f * b[r][p];
            }
        }
    }
    for (int r = 0; r < count; r++) {
        for (int i = n - 1; i >= 0; i--) {
            for (int k = i + 1; k < n; k++) {
                b[r][i] -= m[i][k] * b[r][k];
            }
            b[r][i] /= m[i][i];
        }
    }
}

typedef double complex number;

// Factors m = L U with pivots, and solves with it.
static void factor(int n, number m[][MOST], int *pivot)
{
    for (int p = 0; p < n; p++) {
        int best = p;
        for (int i = p + 1; i < n; i++) {
            best = cabs(m[i][p]) > cabs(m[best][p]) ? i : best;
        }
        pivot[p] = best;
        for (int k = 0; k < n; k++) {
            const number swap = m[p][k];
            m[p][k] = m[best][k];
            m[best][k] = swap;
        }
        for (int i = p + 1; i < n; i++) {
            m[i][p] /= m[p][p];
            for (int k = p + 1; k < n; k++) {
                m[i][k] -= m[i][p] * m[p][k];
            }
        }
    }
}
static void solve_factored(int n, number m[][MOST], const int *pivot, number *b)
{
    for (int p = 0; p < n; p++) {
        const number swap = b[p];
        b[p] = b[pivot[p]];
        b[pivot[p]] = swap;
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < i; k++) {
            b[i] -= m[i][k] * b[k];
        }
    }
    for (int i = n - 1; i >= 0; i--) {
        for (int k = i + 1; k < n; k++) {
            b[i] -= m[i][k] * b[k];
        }
        b[i] /= m[i][i];
    }
}

// --- equations of motion
// ---------------------------------------------------------------------------

static double length_of(const simulation *s, int k)
{
    return s->a->uneven ? s->a->each.length[k] : s->a->link_length;
}
static double mass_of(const simulation *s, int k)
{
    return s->a->uneven ? s->a->each.mass[k] : s->a->link_mass;
}

// Penetration g, its Jacobian and the part of its second derivative that velocities make.
typedef struct touch {
    double g, rate, velocity_terms;
    double j[MOST_BODIES];
} touch;

static touch touch_at(const simulation *s, const double *q, const double *w)
{
    const arm *a = s->a;
    const int N = a->links, f = s->first;
    touch t = {0};
    if (!wall_stands(&a->wall)) {
        t.g = -1;
        return t;
    }
    if (a->wall.kind == WALL_PLANE) { // the tip's distance from a line through the hub's axis
        const double direction = atan2(a->wall.sine, a->wall.cosine);
        for (int k = 0; k < N; k++) {
            const double l = length_of(s, k), z = q[f + k] - direction;
            t.g += l * sin(z);
            t.j[f + k] += l * cos(z);
            t.velocity_terms -= l * sin(z) * w[f + k] * w[f + k];
        }
    } else { // the distance of the point from the last link's line
        const double c = cos(q[f + N - 1]), si = sin(q[f + N - 1]), spin = w[f + N - 1];
        double x = a->wall.x, y = a->wall.y, vx = 0, vy = 0, ax = 0, ay = 0;
        for (int k = 0; k < N - 1; k++) {
            const double l = length_of(s, k), ck = cos(q[f + k]), sk = sin(q[f + k]), wk = w[f + k];
            x -= l * ck;
            y -= l * sk;
            vx -= l * sk * wk;
            vy += l * ck * wk;
            ax -= l * ck * wk * wk;
            ay -= l * sk * wk * wk;
            t.j[f + k] = l * (sk * si + ck * c);
        }
        t.g = si * x - c * y;
        t.j[f + N - 1] = c * x + si * y;
        t.velocity_terms = (c * ay - si * ax) - t.g * spin * spin - 2 * spin * (c * vx + si * vy);
    }
    for (int i = 0; i < s->n; i++) {
        t.rate += t.j[i] * w[i];
    }
    return t;
}

// Torques of the joints into Q, and the power that their dampers and the air take.
static double passive_torques(const simulation *s, const double *q, const double *w, double *Q)
{
    const arm *a = s->a;
    const int N = a->links, f = s->first;
    double power = 0;
    for (int k = f == 1 ? 0 : 1; k < N; k++) {
        const int i = f + k;
        const double bend = q[i] - q[i - 1], rate = w[i] - w[i - 1];
        const double stiffness = a->uneven ? a->each.stiffness[k]
                                 : k > 0   ? a->joint_stiffness
                                           : a->hub_stiffness;
        const double damping = a->uneven ? a->each.damping[k]
                               : k > 0   ? a->joint_damping
                                         : a->hub_joint_damping;
        // a joint stands for a whole link's bending, a beam's root for half a link's
        const double share = k > 0 ? a->stiffening : a->root_bends ? 4 * a->stiffening : 0;
        double torque = stiffness * bend * (1 + share * bend * bend) + damping * rate;
        power += damping * rate * rate;
        for (int row = 0; row < a->damped_modes; row++) {
            double sum = 0;
            for (int j = f == 1 ? 0 : 1; j < N; j++) {
                sum += a->modal_damping[row][j] * (w[f + j] - w[f + j - 1]);
            }
            torque += a->modal_damping[row][k] * sum;
            power += a->modal_damping[row][k] * sum * rate;
        }
        Q[i] -= torque;
        Q[i - 1] += torque;
    }
    // air: a force against the velocity of each piece of the beam
    double vx = 0, vy = 0, velocity_x[MOST_BODIES], velocity_y[MOST_BODIES];
    for (int k = 0; k < N && a->air_drag > 0; k++) {
        const double l = length_of(s, k), c = cos(q[f + k]), si = sin(q[f + k]), wk = w[f + k];
        velocity_x[k] = vx - l / 2 * si * wk;
        velocity_y[k] = vy + l / 2 * c * wk;
        vx -= l * si * wk;
        vy += l * c * wk;
        const double whole = a->air_drag * l, spin = a->air_drag * l * l * l / 12;
        power += whole * (velocity_x[k] * velocity_x[k] + velocity_y[k] * velocity_y[k]) +
                 spin * wk * wk;
        Q[f + k] -= spin * wk;
        for (int i = 0; i <= k; i++) {
            const double lever = i < k ? length_of(s, i) : l / 2;
            Q[f + i] -=
                whole * lever * (cos(q[f + i]) * velocity_y[k] - sin(q[f + i]) * velocity_x[k]);
        }
    }
    return power;
}

static void mass_matrix(const simulation *s, const double *q, double m[][MOST_BODIES + 1])
{
    const int f = s->first;
    for (int i = 0; i < s->n; i++) {
        for (int j = 0; j < s->n; j++) {
            m[i][j] = i >= f && j >= f ? s->coupling[i - f][j - f] * cos(q[i] - q[j]) : 0;
        }
        m[i][i] += i >= f ? (s->a->uneven ? s->a->each.inertia[i - f] : s->a->link_inertia) : 0;
    }
    m[0][0] += s->a->hub_inertia;
}

// Depth of a massless face that is on its way back moves by the law's own: no force on it.
static double face_return(const wall_model *w, double depth)
{
    if (depth <= 0) {
        return 0;
    }
    return w->law == WALL_KELVIN_VOIGT ? -w->stiffness / w->damping * depth
                                       : -w->stiffness / w->damping;
}

static double law_force(const wall_model *w, double depth, double rate)
{
    return w->law == WALL_KELVIN_VOIGT ? w->stiffness * depth + w->damping * rate
           : depth <= 0                ? 0
                        : pow(depth, w->exponent) * (w->stiffness + w->damping * rate);
}

// Derivative dy of a state in a phase, and what it entails.
static void rate_of(const simulation *s, const phase *p, const double *y, double *dy, answer *r)
{
    const arm *a = s->a;
    const wall_model *wall = &a->wall;
    const motor_model *motor = &a->motor;
    const int n = s->n, f = s->first;
    const double *q = y, *w = y + n, *other = y + 2 * n;
    double m[MOST_BODIES + 1][MOST_BODIES + 1] = {{0}}, b[1][MOST_BODIES + 1] = {{0}}, *Q = b[0];
    *r = (answer){0};
    mass_matrix(s, q, m);
    r->damping = passive_torques(s, q, w, Q);
    for (int i = f; i < n; i++) {
        for (int j = f; j < n; j++) {
            Q[i] -= s->coupling[i - f][j - f] * sin(q[i] - q[j]) * w[j] * w[j];
        }
    }

    // motor
    double torque = motor->torque - motor->damping * w[0], current_rate = 0;
    r->viscous = motor->damping * w[0] * w[0];
    r->work = motor->torque * w[0];
    if (motor->electric) {
        const double drive = motor->gain * motor->voltage - motor->back_emf * w[0];
        r->free_current = motor->inductance > 0 ? other[0] : drive / motor->resistance;
        r->current = p->limited != 0 ? p->limited * motor->current_limit : r->free_current;
        if (motor->inductance > 0) {
            current_rate = (drive - motor->resistance * r->current) / motor->inductance;
            r->free_current = r->current + (p->limited != 0 ? current_rate : 0);
            current_rate = p->limited != 0 ? 0 : current_rate;
        }
        torque += motor->torque_constant * r->current;
        r->work += motor->torque_constant * r->current * w[0];
    }
    const bool held = p->contact && !wall_gives(wall) && n == 1; // friction has no say
    r->friction = held ? 0 : p->friction * motor->stiction;
    Q[0] += torque - r->friction;

    // wall
    const touch t = touch_at(s, q, w);
    const bool gives = wall_gives(wall), face = wall_has_face(wall);
    const bool rigid = p->contact && !gives;
    double pressed = 0, face_rate = 0, face_acceleration = 0;
    if (p->contact && gives && !face) {
        pressed = law_force(wall, t.g, t.rate);
        r->wall = (pressed - wall->stiffness * pow(fmax(t.g, 0), wall->exponent)) * t.rate;
    } else if (p->contact && face) { // arm and face move as one
        const double pushed = wall->stiffness * t.g + wall->damping * t.rate;
        for (int i = 0; i < n; i++) {
            Q[i] -= t.j[i] * (wall->face_mass * t.velocity_terms + pushed);
            for (int j = 0; j < n; j++) {
                m[i][j] += wall->face_mass * t.j[i] * t.j[j];
            }
        }
        r->wall = wall->damping * t.rate * t.rate;
    } else if (!p->contact && face) {
        face_rate = other[2];
        face_acceleration =
            -(wall->stiffness * other[1] + wall->damping * other[2]) / wall->face_mass;
        r->wall = wall->damping * other[2] * other[2];
    } else if (p->parted) {
        face_rate = face_return(wall, other[1]);
        r->wall = -wall->stiffness * pow(fmax(other[1], 0), wall->exponent) * face_rate;
    }
    for (int i = 0; i < n; i++) {
        Q[i] -= t.j[i] * pressed;
    }

    // accelerations, with the force of a rigid wall as one more unknown
    const bool stuck = p->friction == 0 && motor->stiction > 0 && !held;
    const double hub_row = Q[0];
    double first_row[MOST_BODIES + 1];
    memcpy(first_row, m[0], sizeof first_row);
    int size = n;
    if (rigid) {
        size = n + 1;
        for (int i = 0; i < n; i++) {
            m[i][n] = m[n][i] = t.j[i];
        }
        m[n][n] = 0;
        Q[n] = -t.velocity_terms;
    }
    if (stuck) {
        for (int i = 0; i < size; i++) {
            m[0][i] = i == 0;
        }
        Q[0] = 0;
    }
    solve_dense(size, m, b, 1);
    r->force = rigid ? Q[n] : pressed;
    double g2 = t.velocity_terms;
    for (int i = 0; i < n; i++) {
        g2 += t.j[i] * Q[i];
    }
    if (p->contact && face) {
        r->force = wall->face_mass * g2 + wall->stiffness * t.g + wall->damping * t.rate;
    }
    if (stuck) {
        double needs = 0;
        for (int i = 0; i < n; i++) {
            needs += first_row[i] * Q[i];
        }
        r->friction = hub_row - needs - (rigid ? t.j[0] * Q[n] : 0);
    }
    r->gap = -t.g;
    r->gap_rate = -t.rate;
    r->gap_acceleration = -g2;

    for (int i = 0; i < n; i++) {
        dy[i] = w[i];
        dy[n + i] = Q[i];
    }
    dy[2 * n] = current_rate;
    dy[2 * n + 1] = face_rate;
    dy[2 * n + 2] = face_acceleration;
}

// --- a step
// ------------------------------------------------------------------------------------------

static double node[STAGES], weight[STAGES][STAGES];

// Butcher's matrix from the nodes (4 -+ sqrt 6)/10, 1: the integrals of Lagrange's polynomials.
static void find_coefficients(void)
{
    const double root = sqrt(6.0);
    node[0] = (4 - root) / 10;
    node[1] = (4 + root) / 10;
    node[2] = 1;
    for (int j = 0; j < STAGES; j++) {
        const double u = node[(j + 1) % 3], v = node[(j + 2) % 3];
        const double under = (node[j] - u) * (node[j] - v);
        for (int i = 0; i < STAGES; i++) {
            const double c = node[i];
            weight[i][j] = (c * c * c / 3 - (u + v) * c * c / 2 + u * v * c) / under;
        }
    }
}

// The eigenvalues of the inverse of Butcher's matrix are lambda and alpha +- i beta; the columns of
// `basis` its eigenvectors, `inverse` that matrix's inverse. Found once, by Newton's method.
static number eigenvalue[STAGES], basis[STAGES][STAGES], inverse[STAGES][STAGES];

static number determinant(number m[STAGES][STAGES])
{
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
           m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}
static void invert3(number m[STAGES][STAGES], number out[STAGES][STAGES])
{
    const number d = determinant(m);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const int r = (j + 1) % 3, t = (j + 2) % 3, u = (i + 1) % 3, v = (i + 2) % 3;
            out[i][j] = (m[r][u] * m[t][v] - m[r][v] * m[t][u]) / d;
        }
    }
}
static void find_eigenvalues(void)
{
    number a[3][3], of[3][3];
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            a[i][j] = weight[i][j];
        }
    }
    invert3(a, of);
    // x^3 - 9 x^2 + 36 x - 60, the denominator of the stability function turned round
    number x = 3.6;
    for (int i = 0; i < 50; i++) {
        x -= (((x - 9) * x + 36) * x - 60) / ((3 * x - 18) * x + 36);
    }
    const double real = creal(x), sum = 9 - real, product = 60 / real;
    eigenvalue[0] = real;
    eigenvalue[1] = sum / 2 + sqrt(product - sum * sum / 4) * (number)_Complex_I;
    eigenvalue[2] = conj(eigenvalue[1]);
    for (int j = 0; j < 3; j++) { // a null vector: the cross product of two rows
        number m[3][3];
        for (int i = 0; i < 3; i++) {
            for (int k = 0; k < 3; k++) {
                m[i][k] = of[i][k] - (i == k ? eigenvalue[j] : 0);
            }
        }
        for (int i = 0; i < 3; i++) {
            const int u = (i + 1) % 3, v = (i + 2) % 3;
            basis[i][j] = m[0][u] * m[1][v] - m[0][v] * m[1][u];
        }
    }
    invert3(basis, inverse);
}

// The derivative by differences at the step's start.
static void find_jacobian(const simulation *s, double jacobian[][MOST])
{
    const int d = 2 * s->n + 3;
    double base[MOST], moved[MOST], y[MOST];
    answer r;
    rate_of(s, &s->now, s->y, base, &r);
    memcpy(y, s->y, sizeof y);
    for (int k = 0; k < d; k++) {
        const double scale = k < s->n ? 1 : k < 2 * s->n ? s->largest_rate : fmax(fabs(y[k]), 1e-3);
        const double by = 1e-7 * scale;
        y[k] = s->y[k] + by;
        rate_of(s, &s->now, y, moved, &r);
        y[k] = s->y[k] - by;
        double back[MOST];
        rate_of(s, &s->now, y, back, &r);
        y[k] = s->y[k];
        for (int i = 0; i < d; i++) {
            jacobian[i][k] = (moved[i] - back[i]) / (2 * by);
        }
    }
}

// Of an error: a body on a stiff wall moves far less than the hub.
static double error_of(const simulation *s, const double *y)
{
    double most = 0;
    for (int i = 0; i < s->n; i++) {
        most = fmax(most, fabs(y[i]) / s->turned[i]);
        most = fmax(most, fabs(y[s->n + i]) / s->rate[i]);
    }
    for (int i = 2 * s->n; i < 2 * s->n + 3; i++) {
        most = fmax(most, fabs(y[i]) / fmax(fabs(s->y[i]), 1e-4));
    }
    return most;
}

static double size_of(const simulation *s, const double *y)
{
    double most = 0;
    for (int i = 0; i < s->n; i++) {
        most = fmax(most, fabs(y[i]) / s->largest_angle);
        most = fmax(most, fabs(y[s->n + i]) / s->largest_rate);
    }
    for (int i = 2 * s->n; i < 2 * s->n + 3; i++) {
        most = fmax(most, fabs(y[i]) / fmax(fabs(s->y[i]), 1e-4));
    }
    return most;
}

// What a step is computed with, kept as long as its length and phase stay.
typedef struct linear_systems {
    double jacobian[MOST][MOST];
    number real[MOST][MOST], complex_one[MOST][MOST];
    int real_pivot[MOST], complex_pivot[MOST];
} linear_systems;

static void factor_systems(const simulation *s, linear_systems *l, double h)
{
    const int d = 2 * s->n + 3;
    for (int i = 0; i < d; i++) {
        for (int k = 0; k < d; k++) {
            l->real[i][k] = (i == k ? eigenvalue[0] / h : 0) - l->jacobian[i][k];
            l->complex_one[i][k] = (i == k ? eigenvalue[1] / h : 0) - l->jacobian[i][k];
        }
    }
    factor(d, l->real, l->real_pivot);
    factor(d, l->complex_one, l->complex_pivot);
}

// A step of length h from s->y: stages, end and quadratures. Returns the error of the embedded
// formula relative to the tolerance, HUGE_VAL where Newton's iteration does not converge.
static double try_step(simulation *s, linear_systems *l, double h)
{
    const int d = 2 * s->n + 3;
    double z[STAGES][MOST] = {{0}}, rate[STAGES][MOST];
    answer r[STAGES];
    factor_systems(s, l, h);
    double last = HUGE_VAL;
    bool done = false;
    for (int it = 0; it < MOST_ITERATIONS && !done; it++) {
        for (int i = 0; i < STAGES; i++) {
            for (int k = 0; k < d; k++) {
                s->stage[i][k] = s->y[k] + z[i][k];
            }
            rate_of(s, &s->now, s->stage[i], rate[i], &r[i]);
        }
        // residual of (A^-1/h) z = rate, in the basis where A^-1 is diagonal
        number right[2][MOST];
        for (int k = 0; k < d; k++) {
            for (int c = 0; c < 2; c++) {
                number of_rate = 0, of_z = 0;
                for (int i = 0; i < STAGES; i++) {
                    of_rate += inverse[c][i] * rate[i][k];
                    of_z += inverse[c][i] * z[i][k];
                }
                right[c][k] = of_rate - eigenvalue[c] / h * of_z;
            }
        }
        solve_factored(d, l->real, l->real_pivot, right[0]);
        solve_factored(d, l->complex_one, l->complex_pivot, right[1]);
        double change[MOST], most = 0;
        for (int i = 0; i < STAGES; i++) {
            for (int k = 0; k < d; k++) {
                change[k] = creal(basis[i][0] * right[0][k]) + 2 * creal(basis[i][1] * right[1][k]);
                z[i][k] += change[k];
            }
            most = fmax(most, size_of(s, change));
        }
        if (!(most < 1e3) || (it > 2 && most > 2 * last)) {
            return most < 1e-11 ? 0 : HUGE_VAL;
        }
        done = most < 1e-14 || (it > 2 && most < 1e-12 && most > 0.5 * last);
        last = most;
    }
    if (!done && !(last < 1e-11)) {
        return HUGE_VAL;
    }
    for (int i = 0; i < STAGES; i++) {
        for (int k = 0; k < d; k++) {
            s->stage[i][k] = s->y[k] + z[i][k];
        }
        rate_of(s, &s->now, s->stage[i], rate[i], &r[i]);
    }
    memcpy(s->end, s->stage[STAGES - 1], sizeof s->end);
    memset(s->added, 0, sizeof s->added);
    for (int i = 0; i < STAGES; i++) {
        const double b = h * weight[STAGES - 1][i];
        const double hub = s->stage[i][s->n];
        s->added[SUM_FORCE] += b * r[i].force;
        s->added[SUM_VISCOUS] += b * r[i].viscous;
        s->added[SUM_DAMPING] += b * r[i].damping;
        s->added[SUM_WALL] += b * r[i].wall;
        s->added[SUM_WORK] += b * r[i].work;
        s->added[SUM_FRICTION] += s->now.friction != 0 ? b * r[i].friction * hub : 0;
    }

    // the embedded formula of order 3: weight gamma at the start, exact for quadratics
    const double gamma = 1 / creal(eigenvalue[0]), root = sqrt(6.0);
    const double e[] = {-(13 + 7 * root) / 3, (-13 + 7 * root) / 3, -1.0 / 3};
    double start[MOST], error[MOST];
    number right[MOST];
    answer unused;
    rate_of(s, &s->now, s->y, start, &unused);
    for (int k = 0; k < d; k++) {
        right[k] = start[k];
        for (int i = 0; i < STAGES; i++) {
            right[k] += e[i] / h * z[i][k];
        }
    }
    (void)gamma;
    solve_factored(d, l->real, l->real_pivot, right);
    for (int k = 0; k < d; k++) {
        error[k] = creal(right[k]);
    }
    return error_of(s, error) / s->tolerance;
}

// The collocation polynomial through start and stages at x of the step.
static void between_stages(const simulation *s, double x, double *y)
{
    const double at[] = {0, node[0], node[1], 1};
    for (int k = 0; k < 2 * s->n + 3; k++) {
        y[k] = 0;
        for (int i = 0; i < 4; i++) {
            double share = 1;
            for (int j = 0; j < 4; j++) {
                share *= j == i ? 1 : (x - at[j]) / (at[i] - at[j]);
            }
            y[k] += share * (i == 0 ? s->y[k] : s->stage[i - 1][k]);
        }
    }
}

// --- events
// ---------------------------------------------------------------------------------------

typedef enum event {
    TOUCHES,
    RELEASES,
    STICKS,
    SLIPS_FORWARD,
    SLIPS_BACKWARD,
    LIMIT,
    FACE_HOME,
    EVENTS
} event;

// The value whose fall below zero is the event; HUGE_VAL where it cannot come.
static double event_value(const simulation *s, const double *y, event e)
{
    const arm *a = s->a;
    const phase *p = &s->now;
    const int n = s->n;
    double dy[MOST];
    answer r;
    rate_of(s, p, y, dy, &r);
    const bool gives = wall_gives(&a->wall), face = wall_has_face(&a->wall);
    const double depth = face || p->parted ? y[2 * n + 1] : 0;
    switch (e) {
    case TOUCHES:
        return !p->contact && wall_stands(&a->wall) ? r.gap + depth : HUGE_VAL;
    case RELEASES:
        return !p->contact ? HUGE_VAL
               : gives && !face
                   ? (r.gap >= 0 && a->wall.law == WALL_HUNT_CROSSLEY ? -r.gap : r.force)
                   : r.force;
    case STICKS:
        return p->friction != 0 && a->motor.stiction > 0 ? p->friction * y[n] : HUGE_VAL;
    case SLIPS_FORWARD: // friction holds back a forward torque: positive
        return p->friction == 0 && a->motor.stiction > 0 ? a->motor.stiction - r.friction
                                                         : HUGE_VAL;
    case SLIPS_BACKWARD:
        return p->friction == 0 && a->motor.stiction > 0 ? a->motor.stiction + r.friction
                                                         : HUGE_VAL;
    case LIMIT:
        if (!a->motor.electric || a->motor.current_limit == HUGE_VAL) {
            return HUGE_VAL;
        }
        return p->limited == 0 ? a->motor.current_limit - fabs(r.free_current)
                               : p->limited * r.free_current - a->motor.current_limit;
    case FACE_HOME:
    case EVENTS:
        break;
    }
    return HUGE_VAL;
}
static double least_of(event e)
{
    return e == TOUCHES ? TINY_GAP : e == STICKS ? TINY_RATE : TINY_FORCE;
}

// Where an event's value vanishes between `from` and `to` of the step, by shorter steps.
static double locate(simulation *s, linear_systems *l, event e, double h, double from, double to)
{
    double y[MOST];
    between_stages(s, from, y);
    double fa = from > 0 ? event_value(s, y, e) : event_value(s, s->y, e), a = from * h, b = to * h;
    try_step(s, l, b);
    double fb = event_value(s, s->end, e);
    fa = fa > 0 ? fa : least_of(e);
    for (int i = 0, side = 0; i < 100 && b - a > 1e-15 && fb < 0; i++) {
        double x = i % 3 == 2 ? (a + b) / 2 : (fa * b - fb * a) / (fa - fb);
        x = fmin(fmax(x, a + 0.01 * (b - a)), b - 0.01 * (b - a));
        try_step(s, l, x);
        const double f = event_value(s, s->end, e);
        if (f < 0) {
            b = x;
            fb = f;
            fa = side == 1 ? fa / 2 : fa;
            side = 1;
        } else {
            a = x;
            fa = fmax(f, 1e-300);
            fb = side == -1 ? fb / 2 : fb;
            side = -1;
        }
    }
    return b;
}

// The first event of the step just tried; its instant in *at [s]. `short` asks for a shorter step.
static event first_event(simulation *s, linear_systems *l, double h, double *at, bool *too_long)
{
    double y[MOST], value[EVENTS][SAMPLES + 1];
    int first = SAMPLES + 1;
    *too_long = false;
    for (int e = 0; e < FACE_HOME; e++) {
        value[e][0] = event_value(s, s->y, (event)e);
        for (int i = 1; i <= SAMPLES && value[e][0] != HUGE_VAL; i++) {
            between_stages(s, (double)i / SAMPLES, y);
            value[e][i] = event_value(s, i == SAMPLES ? s->end : y, (event)e);
            if (value[e][i] < -least_of((event)e) && i < first) {
                first = i;
            }
        }
        // a dip between samples that may reach zero
        for (int i = 1; i < SAMPLES && value[e][0] != HUGE_VAL && first > SAMPLES; i++) {
            const double u = value[e][i - 1], v = value[e][i], w = value[e][i + 1];
            const double bend = u - 2 * v + w,
                         dip = bend > 0 ? v - (w - u) * (w - u) / (8 * bend) : v;
            if (v > 0 && v < u && v < w && dip < 0.05 * v) {
                *too_long = h > 1e-9;
            }
        }
    }
    if (first > SAMPLES || *too_long) {
        return EVENTS;
    }
    event found = EVENTS;
    *at = h;
    for (int e = 0; e < FACE_HOME; e++) {
        if (value[e][0] == HUGE_VAL || !(value[e][first] < -least_of((event)e))) {
            continue;
        }
        // began at zero: the root at the start must be left behind first
        if (first == 1 && value[e][0] < 10 * least_of((event)e) && h > 1e-11) {
            *too_long = true;
            return EVENTS;
        }
        if (try_step(s, l, h) == HUGE_VAL) {
            *too_long = true;
            return EVENTS;
        }
        const double x =
            locate(s, l, (event)e, h, (double)(first - 1) / SAMPLES, (double)first / SAMPLES);
        if (found == EVENTS || x < *at) {
            *at = x;
            found = (event)e;
        }
    }
    return found;
}

// The one combination of contact and friction that violates nothing, of two the one in contact;
// `left` was just left and is no candidate.
static void resolve(simulation *s, bool touching, event left)
{
    const arm *a = s->a;
    double dy[MOST], least = HUGE_VAL;
    answer r;
    phase best = s->now;
    const double hub = s->y[s->n], stiction = a->motor.stiction;
    const bool rests = hub == 0 && stiction > 0,
               choice = touching && (!wall_gives(&a->wall) || wall_has_face(&a->wall));
    for (int contact = 1; contact >= 0; contact--) {
        for (int friction = -1; friction <= 1; friction++) {
            phase p = s->now;
            if ((!choice && contact != p.contact) || (choice && left == RELEASES && contact) ||
                (rests && left == SLIPS_FORWARD && friction != 1) ||
                (rests && left == SLIPS_BACKWARD && friction != -1) ||
                (!rests && friction != (stiction == 0 ? 1
                                        : hub < 0     ? -1
                                                      : 1))) {
                continue;
            }
            p.contact = contact;
            p.friction = friction;
            rate_of(s, &p, s->y, dy, &r);
            double bad = 0;
            if (choice && contact) {
                bad = fmax(bad, -r.force);
            } else if (choice) {
                const double face = wall_has_face(&a->wall) ? dy[2 * s->n + 2] : 0;
                bad = fmax(bad, -(r.gap_acceleration + face));
            }
            if (rests && friction == 0) {
                bad = fmax(bad, fabs(r.friction) - stiction);
            } else if (rests) {
                bad = fmax(bad, -friction * dy[s->n]);
            }
            bad = bad < 1e-12 ? 0 : bad;
            if (bad < least) {
                least = bad;
                best = p;
            }
        }
    }
    s->now = best;
}

// The jump of an impact; returns the speed of approach [m/s].
static double impact(simulation *s)
{
    const arm *a = s->a;
    const int n = s->n;
    const touch t = touch_at(s, s->y, s->y + n);
    double m[MOST_BODIES + 1][MOST_BODIES + 1] = {{0}}, b[1][MOST_BODIES + 1] = {{0}}, yields = 0;
    mass_matrix(s, s->y, m);
    memcpy(b[0], t.j, (size_t)n * sizeof(double));
    solve_dense(n, m, b, 1);
    for (int i = 0; i < n; i++) {
        yields += t.j[i] * b[0][i];
    }
    const bool face = wall_has_face(&a->wall);
    yields += face ? 1 / a->wall.face_mass : 0;
    const double speed = t.rate - (face ? s->y[2 * n + 2] : 0);
    const double e = speed < a->wall.rest_speed ? 0 : a->wall.restitution;
    const double p = (1 + e) * speed / yields;
    for (int i = 0; i < n; i++) {
        s->y[n + i] -= p * b[0][i];
    }
    s->y[2 * n + 2] += face ? p / a->wall.face_mass : 0;
    s->impulses += p;
    s->impact_loss += 0.5 * p * (1 - e) * speed;
    s->now.contact = false;
    resolve(s, e == 0, EVENTS);
    return speed;
}

static void note_contact(simulation *s, double speed, double impulse)
{
    if (isnan(s->o->first_contact)) {
        s->o->first_impulse = impulse;
    }
    chain_outcome_note(s->o, s->t, speed, s->left);
}

static void happen(simulation *s, event e)
{
    const arm *a = s->a;
    const int n = s->n;
    const bool gives = wall_gives(&a->wall), face = wall_has_face(&a->wall);
    double dy[MOST];
    answer r;
    if (e == TOUCHES && (!gives || face)) {
        const double before = s->impulses;
        s->o->impacts++;
        const double speed = impact(s);
        note_contact(s, speed, s->impulses - before);
    } else if (e == TOUCHES) {
        const double face_rate = s->now.parted ? face_return(&a->wall, s->y[2 * n + 1]) : 0;
        s->now.contact = true;
        s->now.parted = false;
        note_contact(s, touch_at(s, s->y, s->y + n).rate - face_rate, 0);
        resolve(s, false, EVENTS);
    } else if (e == RELEASES && gives && !face) {
        const touch t = touch_at(s, s->y, s->y + n);
        s->now.contact = false;
        s->now.parted = t.g > 0 && a->wall.damping > 0;
        s->y[2 * n + 1] = fmax(t.g, 0);
        resolve(s, false, EVENTS);
    } else if (e == RELEASES) {
        const touch t = touch_at(s, s->y, s->y + n);
        if (face) {
            s->y[2 * n + 1] = t.g;
            s->y[2 * n + 2] = t.rate;
        }
        resolve(s, true, RELEASES);
    } else if (e == STICKS) {
        s->y[n] = 0;
        resolve(s, s->now.contact, EVENTS);
    } else if (e == SLIPS_FORWARD || e == SLIPS_BACKWARD) {
        s->y[n] = 0;
        resolve(s, s->now.contact, e);
    } else if (e == LIMIT) {
        rate_of(s, &s->now, s->y, dy, &r);
        s->now.limited = s->now.limited != 0 ? 0 : r.free_current > 0 ? 1 : -1;
        if (s->now.limited != 0 && a->motor.inductance > 0) {
            s->y[2 * n] = s->now.limited * a->motor.current_limit;
        }
        if (s->now.limited == 0 || a->motor.inductance > 0) {
            resolve(s, s->now.contact, EVENTS);
        }
    }
}

// --- a run
// --------------------------------------------------------------------------------------------

// Momentum at the instants of the outcome that lie within the step just tried, by shorter steps.
static void take_samples(simulation *s, linear_systems *l, double h)
{
    chain_outcome *o = s->o;
    while (!isnan(o->first_contact) && o->samples < REFERENCE_SAMPLES) {
        const double time = o->first_contact + o->samples * REFERENCE_INTERVAL;
        if (time > s->t + h) {
            return;
        }
        try_step(s, l, fmax(time - s->t, 1e-15));
        o->momentum[o->samples++] = s->impulses + s->sums[SUM_FORCE] + s->added[SUM_FORCE];
    }
}

static double force_at(simulation *s, const double *y)
{
    double dy[MOST];
    answer r;
    rate_of(s, &s->now, y, dy, &r);
    return r.force;
}

// The largest force of a step in contact: the best sample, refined by shorter steps.
static void note_peak(simulation *s, linear_systems *l, double h)
{
    double y[MOST], best = force_at(s, s->y), x = 0;
    for (int i = 1; i <= SAMPLES; i++) {
        between_stages(s, (double)i / SAMPLES, y);
        const double f = force_at(s, i == SAMPLES ? s->end : y);
        if (f > best) {
            best = f;
            x = (double)i / SAMPLES;
        }
    }
    if (!(best > s->o->peak * 0.99)) {
        return;
    }
    double a = fmax(x - 1.0 / SAMPLES, 0) * h, b = fmin(x + 1.0 / SAMPLES, 1) * h;
    best = force_at(s, s->y);
    double when = 0;
    try_step(s, l, h);
    if (force_at(s, s->end) > best) {
        best = force_at(s, s->end);
        when = h;
    }
    for (int i = 0; i < 34 && x > 0; i++) { // golden section
        const double u = b - 0.6180339887498949 * (b - a), v = a + 0.6180339887498949 * (b - a);
        try_step(s, l, u);
        const double fu = force_at(s, s->end);
        try_step(s, l, v);
        const double fv = force_at(s, s->end);
        if (fmax(fu, fv) > best) {
            best = fmax(fu, fv);
            when = fu > fv ? u : v;
        }
        *(fu > fv ? &b : &a) = fu > fv ? v : u;
    }
    if (best > s->o->peak) {
        s->o->peak = best;
        s->o->peak_time = s->t + when;
    }
}

static void project(simulation *s)
{
    if (!s->now.contact || wall_gives(&s->a->wall)) {
        return;
    }
    const int n = s->n;
    for (int pass = 0; pass < 2; pass++) {
        const touch t = touch_at(s, s->y, s->y + n);
        double m[MOST_BODIES + 1][MOST_BODIES + 1] = {{0}}, b[1][MOST_BODIES + 1] = {{0}},
                                                yields = 0;
        mass_matrix(s, s->y, m);
        for (int i = 0; i < n && s->now.friction == 0; i++) {
            m[0][i] = m[i][0] = i == 0;
        }
        memcpy(b[0], t.j, (size_t)n * sizeof(double));
        b[0][0] = s->now.friction == 0 ? 0 : b[0][0];
        solve_dense(n, m, b, 1);
        for (int i = 0; i < n; i++) {
            yields += t.j[i] * b[0][i];
        }
        for (int i = 0; i < n && yields > 0; i++) {
            s->y[i] -= b[0][i] * t.g / yields;
            s->y[n + i] -= b[0][i] * t.rate / yields;
        }
    }
}

static void follow_scales(simulation *s)
{
    for (int i = 0; i < s->n; i++) {
        s->largest_angle = fmax(s->largest_angle, fabs(s->y[i]));
        s->largest_rate = fmax(s->largest_rate, fabs(s->y[s->n + i]));
        s->turned[i] = fmax(s->turned[i], fabs(s->y[i] - s->start));
        s->rate[i] = fmax(s->rate[i], fabs(s->y[s->n + i]));
    }
}

static void begin(simulation *s, const chain_start *start)
{
    const arm *a = s->a;
    s->n = a->dof;
    s->first = a->first;
    for (int k = 0; k < a->links; k++) {
        for (int i = 0; i <= k; i++) {
            for (int j = 0; j <= k; j++) {
                const double li = length_of(s, i) * (i < k ? 1 : 0.5);
                const double lj = length_of(s, j) * (j < k ? 1 : 0.5);
                s->coupling[i][j] += mass_of(s, k) * li * lj;
            }
        }
        for (int j = 0; j < a->links; j++) {
            s->coupling[k][j] += a->tip_mass * length_of(s, k) * length_of(s, j);
        }
    }
    for (int i = 0; i < s->n; i++) {
        s->y[i] = start->angle;
        s->y[s->n + i] = start->velocity;
    }
    s->start = start->angle;
    for (int i = 0; i < s->n; i++) {
        s->turned[i] = 1e-6;
        s->rate[i] = 1e-4;
    }
    s->largest_angle = 1e-3;
    s->largest_rate = 1e-3;
    follow_scales(s);
    if (a->motor.electric) {
        double dy[MOST];
        answer r;
        rate_of(s, &s->now, s->y, dy, &r);
        s->now.limited =
            fabs(r.free_current) > a->motor.current_limit ? (r.free_current > 0 ? 1 : -1) : 0;
    }

    // at rest on the wall
    const touch t = touch_at(s, s->y, s->y + s->n);
    resolve(s, t.g >= -TINY_GAP && t.rate == 0, EVENTS);
    if (s->now.contact) {
        s->o->first_contact = 0;
        s->o->momentum[s->o->samples++] = 0;
    }
}

chain_outcome implicit_outcome_of(const chain_start *start, double tolerance)
{
    arm a;
    arm_init(&a, start->parameters);
    chain_outcome o = {.first_contact = (double)NAN, .status = STATUS_OK};
    static linear_systems l;
    simulation s = {.a = &a, .tolerance = tolerance, .o = &o};
    find_coefficients();
    find_eigenvalues();
    begin(&s, start);
    double end = isnan(o.first_contact) ? start->duration : start->after_contact, next = 1e-6;
    bool know = false;
    for (long steps = 0; s.t < end; steps++) {
        if (steps > MOST_STEPS || next < SHORTEST) {
            o.status = STATUS_NO_PROGRESS;
            break;
        }
        double h = fmin(next, end - s.t);
        if (!know) {
            find_jacobian(&s, l.jacobian);
            know = true;
        }
        const double error = try_step(&s, &l, h);
        if (!(error <= 1)) {
            next = h * (error < HUGE_VAL ? fmax(0.1, 0.8 * pow(error, -0.25)) : 0.25);
            continue;
        }
        bool too_long = false;
        double at = h;
        const event e = first_event(&s, &l, h, &at, &too_long);
        if (too_long) {
            next = h / 4;
            continue;
        }
        try_step(&s, &l, at);
        if (s.now.contact && s.n > 1) {
            note_peak(&s, &l, at);
        }
        take_samples(&s, &l, at);
        try_step(&s, &l, at);
        s.t += at;
        memcpy(s.y, s.end, sizeof s.y);
        for (int i = 0; i < SUMS; i++) {
            s.sums[i] += s.added[i];
        }
        project(&s);
        follow_scales(&s);
        know = false;
        next = h * fmin(3, 0.8 * pow(fmax(error, 1e-8), -0.25));
        if (e != EVENTS) {
            const bool had = !isnan(o.first_contact);
            const bool touched = s.now.contact || e == TOUCHES;
            happen(&s, e);
            if (touched && !s.now.contact) {
                s.left = s.t;
                chain_outcome_forget(&o, s.impulses + s.sums[SUM_FORCE]);
            }
            next = fmin(h, 1e-6);
            if (!had && !isnan(o.first_contact)) {
                o.momentum[o.samples++] = s.impulses;
            }
            end = isnan(o.first_contact)
                      ? start->duration
                      : fmin(start->duration, o.first_contact + start->after_contact);
        }
        if (start->most_contacts > 0 && o.contacts >= start->most_contacts) {
            break;
        }
    }
    const double lost[] = {s.sums[SUM_FRICTION], s.impact_loss, s.sums[SUM_VISCOUS],
                           s.sums[SUM_DAMPING], s.sums[SUM_WALL]};
    memcpy(o.lost, lost, sizeof lost);
    o.motor_work = s.sums[SUM_WORK];
    o.put_in = fabs(o.motor_work);
    o.ended = s.t;
    return o;
}
