// The contact force of a stride: that of a rigid wall, which the constraint d2g/dt2 = 0 says; of a
// wall that gives, which depth and rate say, known before the accelerations are; of a face with a
// mass, which moves with the arm.
//
// With the depth x and its rate v as series, Kelvin-Voigt's force k x + c v is one at once. Hunt
// and Crossley's is p (k + c v) with p = x^e, whose coefficients follow from x p' = e x' p,
//
//     n x_0 p_n = sum over i = 1..n of (e i - (n - i)) x_i p_(n-i).
//
// It is not analytic at the touch: strides are limited to a share of the time to or from it, x/|v|;
// and next to it, where the force changes the motion by rounding only, strides leave it out. Where
// its effect is small, few orders of it are enough. A face with the mass M has f = M d2g/dt2 + k x
// + c v, where d2g/dt2 is its value without the force plus the response to the force.
#include <math.h>

#include "src/base/extremes.h"
#include "src/base/plain_math.h"
#include "src/engines/series/chain_series_parts.h"

#define NEXT_TO_TOUCH  1e-3  // at most, in (fastest rate) x (time)
#define NO_FORCE       1e-15 // share of the velocity that a force may do and be none
#define DEPTH_ROUNDING 1e-16 // of the arm's length
#define LAST_ORDER     1e-13 // the same of its orders that are left out
#define ORDERLESS_COST 200   // of a stride, in those of which its order squared are the rest

#define FARTHEST       10 // in times from a turn to the touch, beyond which series overflow

enum { LEAST_GRADED = 8 };

// The n-th coefficient of a product of two series, its factors' first `from` terms left out.
static double product_term(const double *x, const double *y, int n, int from)
{
    double sum = 0;
    for (int i = from; i <= n; i++) {
        sum += x[i] * y[n - i];
    }
    return sum;
}

double chain_series_earlier_force(const chain_series *s, int n, double push[2])
{
    const chain_rows *r = &s->rows;
    push[0] = push[1] = 0;
    for (int i = 1; i <= n; i++) {
        push[0] -= s->force.term[n - i] * last_of(s, r->sine, i);
        push[1] += s->force.term[n - i] * last_of(s, r->cosine, i);
    }
    const double across = r->start_c[s->last_place] * push[1] - r->start_s[s->last_place] * push[0];
    return r->half[s->last_place] * across + product_term(s->along.term, s->force.term, n, 1);
}

// The n-th coefficient of d2g/dt2 in x, from the accelerations without that of the force.
static double free_term(const chain_series *s, const arm *a, int n)
{
    const chain_rows *r = &s->rows;
    const size_t end = s->last_place;
    const double ax = r->base_x[end], ay = r->base_y[end];
    const double turn = r->free[end] - (r->ux[end] * ax + r->uy[end] * ay) * r->inv_d[end];
    if (a->wall.kind != WALL_POINT) {
        const double l = r->length[end];
        const double x = ax + r->vx[end] * turn + l * r->rho_x[end];
        const double y = ay + r->vy[end] * turn + l * r->rho_y[end];
        return a->wall.cosine * y - a->wall.sine * x;
    }

    // d2g/dt2 = t'A + D a and what the products' earlier coefficients give
    double rest = s->reach_x.term[0] * r->rho_y[end] - s->reach_y.term[0] * r->rho_x[end];
    for (int i = 1; i <= n + 1; i++) {
        rest += (n + 1) * (n + 2) *
                (last_of(s, r->sine, i) * s->reach_x.term[n + 2 - i] -
                 last_of(s, r->cosine, i) * s->reach_y.term[n + 2 - i]);
    }
    const double across = r->start_c[end] * ay - r->start_s[end] * ax;
    return across + s->along.term[0] * turn + rest;
}

void chain_series_gap_term(chain_series *s, const arm *a, int n)
{
    const chain_rows *r = &s->rows;
    chain_series_reach_point(s, a, n);
    double gap = a->wall.sine * s->tip_x.term[n] - a->wall.cosine * s->tip_y.term[n];
    if (a->wall.kind == WALL_POINT) {
        gap = 0;
        for (int i = 0; i <= n; i++) {
            gap += last_of(s, r->cosine, i) * s->reach_y.term[n - i] -
                   last_of(s, r->sine, i) * s->reach_x.term[n - i];
        }
    }
    s->gap.term[n] = gap;
}

// Coefficient n of v in x.
static double depth_rate(const chain_series *s, int n)
{
    return -(n + 1) * s->gap.term[n + 1];
}

// Coefficients of p = x^e, and of what the spring and the damper of the wall's law give, times L^2;
// returns both together.
static double law_term(chain_series *s, const arm *a, int n)
{
    const wall_model *w = &a->wall;
    const double k = s->length * s->length * w->stiffness, c = s->length * w->damping;
    const double *gap = s->gap.term;
    double *p = s->power.term, *damper = s->damper.term;
    if (w->law == WALL_KELVIN_VOIGT) {
        damper[n] = c * depth_rate(s, n);
        return k * -gap[n] + damper[n];
    }

    // the power, and its product with the rate
    if (s->at_touch) {
        p[n] = 0;
    } else if (w->exponent == 1) {
        p[n] = -gap[n];
    } else if (n == 0) {
        p[0] = wall_power(w, -gap[0]);
    } else {
        double sum = 0;
        for (int i = 1; i <= n; i++) {
            sum += (w->exponent * i - (n - i)) * gap[i] * p[n - i];
        }
        p[n] = sum / (n * gap[0]);
    }
    damper[n] = 0;
    for (int i = 0; i <= n; i++) {
        damper[n] += c * p[n - i] * depth_rate(s, i);
    }
    return k * p[n] + damper[n];
}

double chain_series_force_term(chain_series *s, const arm *a, int n)
{
    if (!s->gives) {
        return -free_term(s, a, n) / s->response;
    }
    const double law = law_term(s, a, n), mass = a->wall.face_mass;
    return mass > 0 ? (mass * free_term(s, a, n) + law) / (1 - mass * s->response) : law;
}

// x'' = -(c x' + k x)/M of a face that nothing touches; one without a mass, or that creeps back,
// has x'' = -rate x', and of the fast decay, which would outgrow all else in its series, nothing is
// left.
double chain_series_add_face(chain_series *s, const arm *a, wall_face face)
{
    const wall_model *w = &a->wall;
    const double t = s->length, k = t * t * w->stiffness / w->face_mass;
    const double c = t * w->damping / w->face_mass, rate = wall_face_rate(w, face);
    const bool creeps = t * rate * t * rate < 0.999 * k; // k of no mass is beyond all numbers
    const bool lacks = creeps && wall_has_face(w);
    const double lost = lacks ? face.velocity + rate * face.position : 0;
    double now = face.position, next = t * (face.velocity - lost);
    for (int n = 0; n <= s->order + 1; n++) {
        s->gap.term[n] += now;
        const double after = creeps ? -rate * t * next / (n + 2)
                                    : -(c * (n + 1) * next + k * now) / ((n + 1) * (n + 2));
        now = next;
        next = after;
    }
    return fabs(lost);
}

// Bound on the relative change of velocity by the wall's force within a time from here, from the
// greatest depth and speed that the arm can have then.
static double share_of_force(const wall_model *w, const wall_approach *at, double time)
{
    const double speed = fabs(at->speed) + fabs(at->acceleration) * time;
    const double depth = at->depth + speed * time;
    return at->compliance * wall_power(w, depth) * (w->stiffness + w->damping * speed) * time /
           speed;
}

// How far the arm may go within a time, into the wall or out of it [m].
static double way_within(const wall_approach *at, double time)
{
    return (fabs(at->speed) + fabs(at->acceleration) * time / 2) * time;
}

// The time from here in which the wall's force changes the velocity by rounding only, or the arm
// moves by no more than that [m].
static double forceless_time(const wall_model *w, const wall_approach *at, double longest,
                             double rounding)
{
    double time = longest;
    while (time > 0 && share_of_force(w, at, time) > NO_FORCE && way_within(at, time) > rounding) {
        time /= 2;
    }
    return time;
}

// How far from a touch, or towards it, a stride goes as a share of the time to there: so that the
// way is made in as few operations as may be. The power's coefficients shrink with that share's
// powers, and with the square of their number at least, the velocity's with its cube; *order is
// that from which on they are rounding of the velocity.
static double choose_grading(const wall_model *w, const wall_approach *at, int *order)
{
    static const double shares[] = {0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
    const double time = at->depth / fabs(at->speed);
    double best = shares[0], least = HUGE_VAL;
    *order = SERIES_MOST;
    for (size_t i = 0; i < sizeof shares / sizeof *shares; i++) {
        double term = share_of_force(w, at, shares[i] * time);
        int n = 0;
        while (n < SERIES_MOST &&
               (n < LEAST_GRADED || term > LAST_ORDER * (1 - shares[i]) * n * n * n)) {
            term *= shares[i] * shares[i];
            n += 2;
        }
        const double way = at->speed > 0 ? plain_log(1 + shares[i]) : -plain_log(1 - shares[i]);
        const double cost = n == SERIES_MOST ? HUGE_VAL : (ORDERLESS_COST + n * n) / way;
        if (cost < least) {
            least = cost;
            best = shares[i];
            *order = n;
        }
    }
    return best * time;
}

double chain_series_wall_reach(chain_series *s, const arm *a, const wall_approach *at)
{
    const wall_model *w = &a->wall;
    const bool within = s->gives && s->mode.contact;
    const double rate = sqrt(at->own_rate * at->own_rate + at->wall_rate * at->wall_rate);
    const double speed = fabs(at->speed);
    double reach = SERIES_REACH / rate;
    s->turning = rate;
    s->at_touch = false;
    s->graded = within && w->law == WALL_HUNT_CROSSLEY && w->exponent != 1;
    s->graded_order = SERIES_MOST;
    if (!s->graded) {
        return reach;
    }

    // next to the touch, or so far from it
    const double longest = NEXT_TO_TOUCH / rate;
    const double rounding = DEPTH_ROUNDING * a->links * a->link_length;
    if (at->depth <= larger(0.5 * way_within(at, longest), rounding)) {
        const double forceless = forceless_time(w, at, longest, rounding);
        s->at_touch = at->depth <= larger(0.5 * way_within(at, forceless), rounding);
        reach = s->at_touch ? fmin(reach, forceless) : reach;
    }
    if (s->at_touch) {
        s->graded_order = LEAST_GRADED;
        return reach;
    }
    reach = fmin(reach, FARTHEST * sqrt(2 * at->depth / fabs(at->acceleration)));
    return speed > 0 ? fmin(reach, choose_grading(w, at, &s->graded_order)) : reach;
}
