// The peak force by the dynamics of the impact: velocities jump at the touch, then the
// springs swing about the point of contact, section 4.2 of the thesis.
#include "src/predict/predict.h"

#include <math.h>
#include <string.h>

#include "src/predict/two_link.h"
#include "src/base/dense.h"

// Range of delays that are looked at [s].
#define SHORTEST_DELAY 1e-9
#define LONGEST_DELAY  100.0

static two_link_form form_of(const parameters *p)
{
    if (p->arm.model == ARM_PRINTED) {
        return FORM_LISTED_IMPACT;
    }
    return FORM_CORRECTED;
}

status predict_velocity_jump(const parameters *p, const three_body_state *s,
                             double after[3], double *impulse, fault *f)
{
    two_link t;
    TRY(three_body_state_check(s, f));
    two_link_at(&t, p, form_of(p), s->angle[1], s->angle[2]);
    return two_link_velocity_jump(&t, s, after, impulse, f);
}

// The coefficients of (4.20)-(4.22). All velocities are taken to fall linearly to zero
// during the delay T, so that momentum falls to zero, an angle's integral is T theta0 +
// T^2 w / 4 (the trapezoid of its two ends), and the force, rising linearly, has the
// impulse T f / 2. With x = (T, f, w1), w1 the hub's velocity just after the impact:
//
//     E1 = -I1 w1 - k1 T D1 - k1 T^2 (w2 - w1)/4 - S T + kv T w1/2                (4.20)
//     E2 = k1 T D1 + k1 T^2 (w2 - w1)/4 - B [k2 T D2 + k2 T^2 (w3 - w2)/4]
//          - P2 + both T f/2                                                       (4.21)
//     E3 = k2 T D2 + k2 T^2 (w3 - w2)/4 - P3 + last T f/2                          (4.22)
//
// D1, D2 are the bends theta2 - theta1, theta3 - theta2 at contact, S the motor torque
// less Coulomb friction, P2 = m22 w2 + m23 w3 and P3 = m32 w2 + m33 w3 the momenta after
// the impact. B = 1 is the spring counted twice, 0 the corrected form.
//
// For a half oscillation that starts without bend, momentum M v against a stiffness k,
// these approximations give T = 2 sqrt(M/k) and f = v sqrt(M k): the peak is right, the
// delay 4/pi times too long.
typedef struct integrated_motion {
    double hub_inertia, hub_damping, k1, k2, twice; // twice: B
    double hub_bend, bend;                          // D1, D2 [rad]
    double w2, w3;                                  // just after the impact [rad/s]
    double drive;                                   // S [N m]
    double momentum2, momentum3;                    // P2, P3 [N m s]
    double both, last;                              // levers of f [m]
} integrated_motion;

// Fills in the coefficients from the state before the impact and the velocities after it.
static void integrate_motion(integrated_motion *g, const parameters *p, const two_link *t,
                             const three_body_state *s, const double after[3])
{
    const bool printed = p->arm.model == ARM_PRINTED;

    // the hub's direction; the listing takes it to turn forwards
    double turning = 1;
    if (!printed) {
        const double speed = t->rigid_hub ? s->velocity[1] : s->velocity[0];
        turning = sign_of(speed);
    }

    // the coefficients of (4.20)-(4.22)
    *g = (integrated_motion){
        .hub_inertia = p->arm.hub_inertia,
        .hub_damping = t->hub_damping,
        .k1 = p->arm.k1,
        .k2 = p->arm.k2,
        .twice = printed && p->printed.spring_counted_twice ? 1 : 0,
        .hub_bend = s->angle[1] - s->angle[0],
        .bend = s->angle[2] - s->angle[1],
        .w2 = after[1],
        .w3 = after[2],
        .drive = t->motor_torque - p->motor.stiction * turning,
        .momentum2 = t->m22 * after[1] + t->m23 * after[2],
        .momentum3 = t->m32 * after[1] + t->m33 * after[2],
        .both = t->both,
        .last = t->last,
    };
}

// Evaluates E1, E2, E3 at x = (T, f, w1), and their Jacobian row by row.
static void equations(const integrated_motion *g, const double x[3], double e[3],
                      double jacobian[9])
{
    const double T = x[0], f = x[1], w1 = x[2];

    // the springs' impulses k T D + k T^2 (change of w)/4, and their slopes by T
    const double hub_rate = g->k1 * (g->w2 - w1), rate = g->k2 * (g->w3 - g->w2);
    const double hub_spring = T * g->k1 * g->hub_bend + T * T * hub_rate / 4;
    const double spring = T * g->k2 * g->bend + T * T * rate / 4;
    const double hub_slope = g->k1 * g->hub_bend + T * hub_rate / 2;
    const double slope = g->k2 * g->bend + T * rate / 2;

    e[0] = -g->hub_inertia * w1 - hub_spring - g->drive * T + g->hub_damping * T * w1 / 2;
    e[1] = hub_spring - g->twice * spring - g->momentum2 + g->both * T * f / 2;
    e[2] = spring - g->momentum3 + g->last * T * f / 2;

    // by T, f and w1
    jacobian[0] = -hub_slope - g->drive + g->hub_damping * w1 / 2;
    jacobian[1] = 0;
    jacobian[2] = -g->hub_inertia + g->k1 * T * T / 4 + g->hub_damping * T / 2;
    jacobian[3] = hub_slope - g->twice * slope + g->both * f / 2;
    jacobian[4] = g->both * T / 2;
    jacobian[5] = -g->k1 * T * T / 4;
    jacobian[6] = slope + g->last * f / 2;
    jacobian[7] = g->last * T / 2;
    jacobian[8] = 0;
}

// c[0] + c[1] x + ... + c[degree] x^degree, by Horner's rule.
static double polynomial(const double *c, int degree, double x)
{
    double sum = c[degree];
    for (int i = degree - 1; i >= 0; i--) {
        sum = sum * x + c[i];
    }
    return sum;
}

// The root of a polynomial that is monotonic and changes sign between low and high, by
// bisection.
static double bisect(const double *c, int degree, double low, double high)
{
    bool rising = polynomial(c, degree, high) > 0;

    // until no number lies in between
    for (int i = 0; i < 200; i++) {
        double middle = low + (high - low) / 2;
        if (middle <= low || middle >= high) {
            break;
        }
        if ((polynomial(c, degree, middle) > 0) == rising) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return low + (high - low) / 2;
}

// Simple roots of c[0] + c[1] x + ... + c[degree] x^degree, degree <= 4, within the range
// of delays, in rising order: between two roots of its derivative a polynomial is
// monotonic. Returns how many.
static int positive_roots(const double *c, int degree, double *roots)
{
    double slope[4], turns[6];
    if (degree == 0) {
        return 0;
    }

    for (int i = 0; i < degree; i++) {
        slope[i] = (i + 1) * c[i + 1];
    }

    // from end to end by way of the turning points
    int turn_count = positive_roots(slope, degree - 1, turns + 1) + 2, count = 0;
    turns[0] = SHORTEST_DELAY;
    turns[turn_count - 1] = LONGEST_DELAY;
    for (int i = 0; i + 1 < turn_count; i++) {
        double before = polynomial(c, degree, turns[i]);
        double after = polynomial(c, degree, turns[i + 1]);
        if ((before > 0) != (after > 0)) {
            roots[count++] = bisect(c, degree, turns[i], turns[i + 1]);
        }
    }
    return count;
}

// Force that goes with a delay, from E3 = 0.
static double force_of_delay(const integrated_motion *g, double T)
{
    double spring = T * g->k2 * g->bend + T * T * g->k2 * (g->w3 - g->w2) / 4;
    return 2 * (g->momentum3 - spring) / (g->last * T);
}

// Hub velocity that goes with a delay, from E1 = 0.
static double hub_velocity_of_delay(const integrated_motion *g, double T)
{
    double drive = T * (g->k1 * g->hub_bend + g->drive) + T * T * g->k1 * g->w2 / 4;
    return drive / (g->k1 * T * T / 4 + g->hub_damping * T / 2 - g->hub_inertia);
}

// The coefficients of E2 - (both/last) E3 = c[0] + c[1] T + c[2] T^2, in which the force
// f cancels. The terms with k1 are left out: the caller adds them.
static void force_free_terms(const integrated_motion *g, double c[3])
{
    double lever = g->both / g->last, springs = g->twice + lever;
    c[0] = lever * g->momentum3 - g->momentum2;
    c[1] = -springs * g->k2 * g->bend;
    c[2] = -springs * g->k2 * (g->w3 - g->w2) / 4;
}

static double norm_of(const double x[3])
{
    return sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
}

// Newton's method (3.8) on E1..E3 from a guess. The step is halved while it makes the
// residual worse. False if that does not lead to a root.
static bool newton(const integrated_motion *g, double x[3])
{
    enum { ITERATIONS = 50 };
    // size of the terms that have to cancel
    double scale = fabs(g->momentum2) + fabs(g->momentum3) + fabs(g->hub_inertia * x[2]) +
                   fabs(g->k1 * x[0] * g->hub_bend) +
                   g->k1 * x[0] * x[0] * (fabs(g->w2) + fabs(x[2])) / 4;

    // the residual to begin with
    double e[3], jacobian[9], error;
    equations(g, x, e, jacobian);
    error = norm_of(e);
    for (int i = 0; i < ITERATIONS && error > 1e-13 * scale; i++) {
        // the whole step, or as much of it as lowers the residual
        double damping = 1, trial[3], next;
        if (!dense_solve(3, jacobian, e)) {
            return false;
        }

        do {
            double trial_e[3];
            for (int j = 0; j < 3; j++) {
                trial[j] = x[j] - damping * e[j];
            }
            equations(g, trial, trial_e, jacobian);
            next = norm_of(trial_e);
            damping /= 2;
        } while (!(next < error) && damping > 1e-6);
        if (!(next < error)) {
            break;
        }

        memcpy(x, trial, 3 * sizeof(double));
        equations(g, x, e, jacobian);
        error = next;
    }
    return error <= 1e-9 * scale;
}

// Solves E1..E3. With w1 from E1 and f from E3, E2 becomes a polynomial of fourth degree
// in T; of its positive roots the one is meant whose hub velocity stays nearest to that
// before the impact, as (4.10) wants it (Newton's method from the listing's guess T = 5
// s, f = 5 N, w1 = 1 rad/s ends at the same one in all cells of Tables 4.1-4.3). Newton's
// method then solves the three together. STATUS_OK with *delay NaN if no root is positive
// with a positive force.
static status solve_with_hub_spring(const integrated_motion *g, double hub_velocity,
                                    double *delay, double *force, fault *f)
{
    double c[3], roots[4], best = (double)INFINITY, x[3];
    force_free_terms(g, c);

    // E1 gives w1 = N(T)/D(T) with D = d0 + d1 T + d2 T^2. Put into c[0] + c[1] T + c[2]
    // T^2
    // + k1 T D1 + k1 T^2 (w2 - w1)/4 = 0 and multiplied by D, that is a polynomial of
    // fourth degree, in which the terms with the square of k1 cancel.
    double d0 = -g->hub_inertia, d1 = g->hub_damping / 2, d2 = g->k1 / 4;
    double hub1 = c[1] + g->k1 * g->hub_bend, hub2 = c[2] + g->k1 * g->w2 / 4;
    double quartic[5] = {c[0] * d0, c[0] * d1 + hub1 * d0,
                         c[0] * d2 + hub1 * d1 + hub2 * d0,
                         c[1] * d2 + hub2 * d1 - g->drive * d2, c[2] * d2};

    // the root whose hub velocity is the nearest
    int count = positive_roots(quartic, 4, roots);
    *delay = *force = (double)NAN;
    for (int i = 0; i < count; i++) {
        double peak = force_of_delay(g, roots[i]),
               w1 = hub_velocity_of_delay(g, roots[i]);
        if (peak > 0 && fabs(w1 - hub_velocity) < best) {
            best = fabs(w1 - hub_velocity);
            memcpy(x, (double[3]){roots[i], peak, w1}, sizeof x);
        }
    }

    if (!isfinite(best)) {
        return STATUS_OK;
    }
    FAULT_IF(!newton(g, x) || !(x[0] > 0), f, STATUS_NEWTON_FAILED,
             "Newton's method found no solution of (4.20)-(4.22) near a delay of %g s",
             x[0]);

    *delay = x[0];
    *force = x[1];
    return STATUS_OK;
}

// The earliest positive root of c0 + c1 T + c2 T^2, NaN if there is none.
static double earliest_delay(const double c[3])
{
    double discriminant = c[1] * c[1] - 4 * c[2] * c[0], earliest = (double)NAN;
    if (discriminant < 0) {
        return earliest;
    }

    // the root without cancellation, and the other one from the product of both, c0/c2
    double sum = -(c[1] + copysign(sqrt(discriminant), c[1])) / 2;
    double roots[2] = {sum / c[2], c[0] / sum};
    for (int i = 0; i < 2; i++) {
        if (isfinite(roots[i]) && roots[i] > 0) {
            earliest = fmin(roots[i], earliest);
        }
    }
    return earliest;
}

// Without a hub spring E1 and E2 are one equation, the balance of the whole arm with w1 =
// w2,
//
//     -S T + kv T w2/2 - P2 + both T f/2 = 0
//
// and the system is quadratic in T. So is the printed closed form of an arm with one,
// whose velocity w1 after the impact is known.
static void solve_quadratic(const integrated_motion *g, bool rigid_hub, double w1,
                            prediction *out)
{
    double c[3];
    force_free_terms(g, c);
    if (rigid_hub) {
        c[1] += g->hub_damping * g->w2 / 2 - g->drive;
    } else {
        c[1] += g->k1 * g->hub_bend;
        c[2] += g->k1 * (g->w2 - w1) / 4;
    }
    out->delay = earliest_delay(c);
    out->force = force_of_delay(g, out->delay);
}

// Predicts by (4.10)-(4.22): the velocity jump, then delay and force from the integrated
// equations, or with `closed_form` from their quadratic form.
static status predict_by_momentum(const parameters *p, const three_body_state *s,
                                  bool closed_form, prediction *out, fault *f)
{
    two_link t;
    integrated_motion g;
    double after[3];
    *out = prediction_none();
    TRY(three_body_state_check(s, f));

    // the jump, and the motion that begins with it
    two_link_at(&t, p, form_of(p), s->angle[1], s->angle[2]);
    TRY(two_link_velocity_jump(&t, s, after, &out->impulse, f));

    // an elastic impact throws the arm back: there is no pulse
    const double e = two_link_restitution(&t, p, s);
    if (e > 0) {
        out->impulse *= 1 + e;
        return STATUS_OK;
    }

    // delay and force of the motion that follows; in the closed form the hub jumps as the
    // first link does
    integrate_motion(&g, p, &t, s, after);
    if (t.rigid_hub || closed_form) {
        const double hub_after = s->velocity[0] + after[1] - s->velocity[1];
        solve_quadratic(&g, t.rigid_hub, hub_after, out);
    } else {
        TRY(solve_with_hub_spring(&g, s->velocity[0], &out->delay, &out->force, f));
    }

    // it holds where there is a pulse and the touch lasts
    out->holds = out->impulse >= 0 && out->force > 0 && out->delay > 0;
    if (p->arm.model != ARM_PRINTED) {
        out->holds = out->holds && two_link_first_force(&t, p, s, after) >= 0;
    }
    return STATUS_OK;
}

status predict_impact_dynamics(const parameters *p, const three_body_state *s,
                               prediction *out, fault *f)
{
    const bool closed_form = false;
    return predict_by_momentum(p, s, closed_form, out, f);
}

// Hub and first link jump alike. Printed: w1 = w1(before) + Dw2 is then known, E1 and
// with it the motor torque drop out, and E2 is quadratic in T. Corrected: what jumps
// alike is one body, so that this is the form of a rigid hub whatever the hub's joint is,
// and the motor torque stays.
status predict_impact_quadratic(const parameters *p, const three_body_state *s,
                                prediction *out, fault *f)
{
    parameters rigid = *p;
    if (p->arm.model != ARM_PRINTED) {
        rigid.arm.hub_joint = HUB_RIGID;
    }
    const bool closed_form = true;
    return predict_by_momentum(&rigid, s, closed_form, out, f);
}
