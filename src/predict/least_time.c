#include "src/predict/least_time.h"

#include <assert.h>
#include <math.h>

#include "src/base/plain_math.h"

enum { MOST_STEPS = 4000, SUBSTEPS = 8, HALVINGS = 60 };

// The arm in flight, q = (theta2, theta3) - theta_imp: M q'' + D e2 q2' + k2 B q = T e2.
typedef struct flight {
    double inverse[2][2]; // of M [1/(kg m2)]
    double damping;       // D [N m s/rad]
    double k2;            // [N m/rad]
    double length;        // l of a link [m]
    double torque;        // the largest one, with the largest friction added [N m]
    double start;         // both angles q at the start [rad]
    double jump[2];       // of the impact: x' after it = jump[0] q2' + jump[1] q3'

    // K xi = angle_gain x + rate_gain x': K [N/rad], and K/s [N s/rad]
    double angle_gain, rate_gain;
} flight;

typedef struct flight_state {
    double q[2], w[2];
} flight_state;

// The arm in flight. False where there is no such model, the arm starts at or behind the
// wall, or the motor has no torque.
static bool flight_of(const parameters *p, flight *f)
{
    pressed_arm_model m;
    if (!pressed_arm_model_of(p, &m)) {
        return false;
    }

    // masses as in (2.16), (2.17), hub and first link one body
    const double l = p->arm.length / 2, mass = p->arm.mass / 2;
    const double quarter = mass * l * l / 4, inertia = p->arm.link_inertia;
    const double m11 = p->arm.hub_inertia + inertia + 5 * quarter, m12 = 2 * quarter,
                 m22 = inertia + quarter, determinant = m11 * m22 - m12 * m12;
    *f = (flight){.inverse = {{m22 / determinant, -m12 / determinant},
                              {-m12 / determinant, m11 / determinant}},
                  .damping = m.damping,
                  .k2 = p->arm.k2,
                  .length = l,
                  .torque = m.torque_limit + m.stiction,
                  .start = p->initial.angle - p->wall.angle,
                  .jump = {(m11 - m12) / m.inertia, (m12 - m22) / m.inertia},
                  .angle_gain = m.spring_force,
                  .rate_gain = sqrt(m.spring_force * m.mass_force)};
    return f->start < 0 && f->torque > 0;
}

// The rates of angles and velocities under a torque at the hub: q'' = M^-1 (torques of
// the motor, of damping and of the joint).
static flight_state flight_rate(const flight *f, const flight_state *s, double torque)
{
    const double bend = f->k2 * (s->q[0] - s->q[1]);
    const double hub = torque - f->damping * s->w[0] - bend;
    return (flight_state){{s->w[0], s->w[1]},
                          {f->inverse[0][0] * hub + f->inverse[0][1] * bend,
                           f->inverse[1][0] * hub + f->inverse[1][1] * bend}};
}

static flight_state flight_ahead(const flight_state *s, const flight_state *r, double h)
{
    return (flight_state){{s->q[0] + h * r->q[0], s->q[1] + h * r->q[1]},
                          {s->w[0] + h * r->w[0], s->w[1] + h * r->w[1]}};
}

// The state after LEAST_TIME_STEP under a constant torque, by the classical Runge-Kutta
// method.
static flight_state flight_advance(const flight *f, flight_state s, double torque)
{
    const double h = LEAST_TIME_STEP / SUBSTEPS;

    // four slopes: at the start, twice half way and at the end
    for (int i = 0; i < SUBSTEPS; i++) {
        flight_state a = flight_rate(f, &s, torque);
        flight_state ahead = flight_ahead(&s, &a, h / 2);
        flight_state b = flight_rate(f, &ahead, torque);
        ahead = flight_ahead(&s, &b, h / 2);
        flight_state c = flight_rate(f, &ahead, torque);
        ahead = flight_ahead(&s, &c, h);
        flight_state d = flight_rate(f, &ahead, torque);

        // their weighted mean
        for (int k = 0; k < 2; k++) {
            s.q[k] += h / 6 * (a.q[k] + 2 * b.q[k] + 2 * c.q[k] + d.q[k]);
            s.w[k] += h / 6 * (a.w[k] + 2 * b.w[k] + 2 * c.w[k] + d.w[k]);
        }
    }
    return s;
}

static double flight_tip(const flight *f, const flight_state *s)
{
    return f->length * (s->q[0] + s->q[1]);
}

// K xi [N] just after the impact if the arm touched the wall in this state.
static double press_of(const flight *f, const flight_state *s)
{
    const double velocity = f->jump[0] * s->w[0] + f->jump[1] * s->w[1];
    return f->angle_gain * s->q[0] + f->rate_gain * velocity;
}

// The responses of the tip's place [1/N] and of K xi [1/m] to a unit torque that acts for
// one step, k steps after that step began, k from 1.
typedef struct responses {
    double tip[MOST_STEPS + 1], press[MOST_STEPS + 1];
} responses;

// One end of the interval of the K xi that are attainable with a touch after n steps: K
// xi, the multiplier, and the part of the way that the tip misses.
typedef struct edge {
    double press, weight, slack;
} edge;

// The tip's place and K xi after n steps under the bang-bang torque U sign(sense (press -
// weight tip)), U the largest torque: sums over the steps of torque times response.
static void follow_sign(const flight *f, const responses *r, int n, double weight,
                        double sense, double *tip, double *press)
{
    *tip = *press = 0;
    for (int k = 1; k <= n; k++) {
        const bool forward = (r->press[k] > weight * r->tip[k]) == (sense > 0);
        const double torque = forward ? f->torque : -f->torque;
        *tip += torque * r->tip[k];
        *press += torque * r->press[k];
    }
}

// Finds the largest K xi (sense 1) or the least one (-1) with a touch after n steps. A
// larger weight moves the tip away from the wall (sense 1) or on (-1), as one step's
// torque after the other changes its sign: bisection finds the weight with the tip at the
// wall. False if no torque brings the tip there.
static bool find_edge(const flight *f, const responses *r, int n, double sense, edge *e)
{
    // the farthest that any torque moves the tip has to reach the wall
    double farthest = 0, tip, press;
    for (int k = 1; k <= n; k++) {
        farthest += f->torque * fabs(r->tip[k]);
    }
    const double start = flight_tip(f, &(flight_state){{f->start, f->start}, {0, 0}});
    if (farthest < -start) {
        return false;
    }

    // bisect between weights so large that the tip's response alone decides the signs
    double high = 1;
    for (int k = 1; k <= n; k++) {
        const double ratio = 2 * fabs(r->press[k]) / fmax(fabs(r->tip[k]), 1e-12);
        high = fmax(high, ratio);
    }
    double low = -high;
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = (low + high) / 2;
        follow_sign(f, r, n, middle, sense, &tip, &press);
        const bool beyond = start + tip > 0;
        if (beyond == (sense > 0)) {
            low = middle;
        } else {
            high = middle;
        }
    }

    // At the weights left the signs differ in one step. A torque between both signs there
    // brings the tip to the wall: interpolate linearly.
    double tip_low, press_low;
    follow_sign(f, r, n, low, sense, &tip_low, &press_low);
    follow_sign(f, r, n, high, sense, &tip, &press);
    const double across = tip_low - tip;
    double share = across != 0 ? (-start - tip) / across : 0;
    share = fmax(0, fmin(1, share));
    e->press = f->angle_gain * f->start + press + share * (press_low - press);
    e->slack = fabs(start + tip + share * across) / -start;
    e->weight = (low + high) / 2;
    return true;
}

// The least time [s] in contact until K xi is in the band [a, b] under forces from 0 to
// `most`, as best_stop.c derives it; NaN if K xi never gets there.
static double time_to_band(double xi, double a, double b, double most, double s)
{
    if (xi > b) {
        if (xi < most) {
            return plain_log((most - b) / (most - xi)) / s;
        }
        return (double)NAN;
    }
    if (xi >= a) {
        return 0;
    }
    if (xi > 0) {
        return plain_log(a / xi) / s;
    }
    return (double)NAN;
}

least_time least_time_of(const parameters *p, double force, double band, double peak)
{
    assert(band > 0);
    const least_time none = {.total = (double)NAN};
    least_time best = {.total = HUGE_VAL};
    flight f;
    responses r; // filled in up to the step that is tried
    if (!(force > 0) || !flight_of(p, &f)) {
        return none;
    }
    const double a = force * (1 - band), b = force * (1 + band), most = fmax(peak, b);
    const double s = f.angle_gain / f.rate_gain;

    // try later and later touches, until the touch alone takes longer than the best total
    flight_state response = {{0, 0}, {0, 0}};
    for (int n = 1; n <= MOST_STEPS && n * LEAST_TIME_STEP < best.total; n++) {
        edge least, most_edge;
        const double torque = n == 1 ? 1 : 0;
        response = flight_advance(&f, response, torque);
        r.tip[n] = flight_tip(&f, &response);
        r.press[n] = press_of(&f, &response);
        if (!find_edge(&f, &r, n, -1, &least) || !find_edge(&f, &r, n, 1, &most_edge)) {
            continue;
        }

        // the attainable K xi that is nearest to the band
        const bool largest = most_edge.press < a;
        const edge *e = &least;
        double press = fmax(e->press, a);
        if (largest) {
            e = &most_edge;
            press = e->press;
        }
        const double total = n * LEAST_TIME_STEP + time_to_band(press, a, b, most, s);
        if (total < best.total) {
            best = (least_time){.total = total,
                                .touch = n * LEAST_TIME_STEP,
                                .press = e->press,
                                .weight = e->weight,
                                .largest = largest,
                                .slack = e->slack};
        }
    }
    if (isfinite(best.total)) {
        return best;
    }
    return none;
}

void least_time_follow(const parameters *p, const double *torque, int steps, double *tip,
                       double *press)
{
    assert(steps >= 0);
    flight f;
    bool known = flight_of(p, &f);
    flight_state s = {{f.start, f.start}, {0, 0}};
    assert(known);
    for (int k = 0; k < steps && known; k++) {
        s = flight_advance(&f, s, torque[k]);
    }
    *tip = flight_tip(&f, &s);
    *press = press_of(&f, &s);
}
