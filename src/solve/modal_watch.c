#include "src/solve/modal_watch.h"

#include <math.h>
#include <string.h>

#include "src/base/sincos.h"
#include "src/solve/locate.h"
#include "src/solve/modal_state.h"

#define SLOW_TURN    1     // of a mode in the stride, or its decay, that the series takes [rad]
#define SLACK_GAP    1e-10 // [m]
#define SLACK_SHARE  1e-3  // of what all modes can do to any other function
#define SLACK_OTHER  1e-9  // and at least so much, in its unit
#define GAP_ROUNDING 4e-15 // [m]

enum { SAMPLES_A_BLOCK = 4, MOST_HALVINGS = 40, MOST_ROOT_STEPS = 60, MOST_POLISHING = 12 };

// How far beyond its edge a function is where it has left its admissible side.
static const double far_side[] = {[WATCH_GAP] = 1e-14,
                                  [WATCH_FORCE] = FORCE_TOLERANCE,
                                  [WATCH_HUB] = 1e-13,
                                  [WATCH_STICTION] = 1e-11};
#define ON_EDGE 1e3 // times that: a start so near is one on the edge

// --- the functional ---------------------------------------------------------------------------

// Gradient of the penetration by the angles.
static void contact_gradient(const arm *a, const double *q, double *gradient)
{
    const double l = a->link_length;
    const int last = a->first + a->links - 1;

    // where the last link begins, and the wall as met from there
    double x = 0, y = 0, c = 1, s = 0;
    for (int k = a->first; k < last; k++) {
        inline_sincos(q[k], &s, &c);
        x += l * c;
        y += l * s;
    }
    inline_sincos(q[last], &s, &c);
    wall_contact at = wall_contact_at(&a->wall, l, x, y, 0, 0, c, s, 0);

    // the last link turns about that place, the others move it
    gradient[0] = 0;
    gradient[last] = wall_last_lever(&at, l, c, s);
    for (int k = a->first; k < last; k++) {
        inline_sincos(q[k], &s, &c);
        gradient[k] = l * (c * at.ey - s * at.ex);
    }
}

// Coordinates V' K direction and, with structural damping, the same of the velocities.
static void through_springs(modal_function *f, modal_stride *s, const arm *a, double *direction,
                            double hub)
{
    double *springs = s->columns;
    modal_stiffness_times(a, direction, springs);
    modal_from_angles(s->modes, s->dof, 1, springs, f->place, s->dof);
    for (int k = 0; k < s->count; k++) {
        f->speed[k] = s->per_stiffness * f->place[k] + hub * s->modes->by_dof[k];
    }
}

static void fit_functional(modal_function *f, modal_stride *s, const arm *a, motion *m)
{
    const int n = s->dof;
    const double *q = state_angles(m, m->state);
    double *direction = s->angles, compliance, impulse;
    const bool stuck = s->mode.friction == HUB_STICK;

    // weights of the modes' angles and speeds; most kinds need no speeds
    memset(f->speed, 0, (size_t)n * sizeof(double));
    if (f->kind == WATCH_GAP) {
        // the gap shrinks as the penetration grows
        contact_gradient(a, q, direction);
        for (int i = 0; i < n; i++) {
            direction[i] = -direction[i];
        }
        modal_from_angles(s->modes, n, 1, direction, f->place, n);
    } else if (f->kind == WATCH_FORCE) {
        // the force: springs at work along the contact's response
        chain_contact_response(a, m->links, q, stuck, direction, &compliance);
        for (int i = 0; i < n; i++) {
            direction[i] /= compliance;
        }
        through_springs(f, s, a, direction, stuck ? 0 : a->motor.damping * direction[0]);
    } else if (f->kind == WATCH_HUB) {
        // the hub's speed in the direction that its friction is for
        memset(f->place, 0, (size_t)n * sizeof(double));
        for (int k = 0; k < s->count; k++) {
            f->speed[k] = s->mode.friction * s->modes->by_dof[k];
        }
    } else {
        // the friction torque on a stuck hub: springs at work along what a free hub would do
        const contact_state free_hub = {s->mode.contact, HUB_FORWARD};
        memset(direction, 0, (size_t)n * sizeof(double));
        if (a->hub_spring) {
            direction[0] = 1;
        } else {
            double *unit = s->columns + n, *rates = unit + n;
            memset(unit, 0, (size_t)n * sizeof(double));
            unit[0] = 1;
            chain_from_momentum(a, m->links, free_hub, q, unit, direction, rates, &impulse);
            for (int i = n - 1; i >= 0; i--) {
                direction[i] /= direction[0];
            }
        }
        through_springs(f, s, a, direction, 0);
    }
}

// --- values -------------------------------------------------------------------------------------

static double exact_at(watch kind, const arm *a, motion *m, contact_state mode, const double *q,
                       const double *w, double *accelerations)
{
    chain_reaction r;
    if (kind == WATCH_HUB) {
        return mode.friction * w[0];
    }
    chain_accelerations(a, m->links, q, w, mode, accelerations, &r);
    return kind == WATCH_GAP ? r.gap : kind == WATCH_FORCE ? r.force : r.friction;
}

// The functional without what it is at the start.
static double functional(const modal_function *f, const modal_stride *s, const double *x,
                         const double *y, const double *drift, const double *drift0)
{
    double sum = 0;
    for (int k = 0; k < s->count; k++) {
        const double change = y[k] + drift[k] - (s->start[k] + drift0[k]);
        const double speed = k == s->modes->across ? drift[k] - drift0[k] : change;
        sum += f->place[k] * x[k] + f->speed[k] * speed;
    }
    return sum;
}

// Derivatives at the start of a mode that turns little in the stride, g_j of x = sum g_j t^j / j!,
// under n(t) = sum n_j t^j / j!; x = 0 at the start.
static void slow_mode(double damping, double rate, double speed, const double *n, double *g)
{
    g[0] = 0;
    g[1] = speed;
    for (int j = 0; j + 2 <= MODAL_SERIES; j++) {
        g[j + 2] = (j < MODAL_NODES ? n[j] : 0) - 2 * damping * g[j + 1] - rate * rate * g[j];
    }
}

// The same of what a mode does under n(t) without vibrating.
static void followed(double damping, double rate, const double *n, double *g)
{
    memset(g, 0, (MODAL_SERIES + 1) * sizeof *g);
    for (int j = MODAL_NODES - 1; j >= 0; j--) {
        g[j] = (n[j] - 2 * damping * g[j + 1] - g[j + 2]) / (rate * rate);
    }
}

// The vibration that takes a mode from `place` and `speed` [of x], into the function's amplitudes.
static void add_vibration(modal_function *f, const modal_vibrations *v, int mode, double place,
                          double speed)
{
    const int e = v->entry[mode];
    const double p = f->place[mode], s = f->speed[mode];
    double *cosine = f->sum.cosine, *sine = f->sum.sine;
    if (e < v->vibrating) {
        const double a = v->decay[e], turn = v->turn[e], b = (speed + a * place) / turn;
        cosine[e] = p * place + s * (turn * b - a * place);
        sine[e] = p * b - s * (a * b + turn * place);
        return;
    }

    // two decays
    const int other = e + v->overdamped;
    const double slow = v->decay[e], fast = v->decay[other], per = 1 / (fast - slow);
    cosine[e] = per * (fast * place + speed) * (p - s * slow);
    cosine[other] = -per * (slow * place + speed) * (p - s * fast);
}

// The function on the whole stride from its value, functional and rest.
static void fit_sum(modal_function *f, const modal_stride *s)
{
    const modal_vibrations *v = s->now;
    modal_sum *sum = &f->sum;
    const double h = s->length;
    double total[MODAL_SERIES + 1] = {f->value}, g[MODAL_SERIES + 1];
    sum->vibrations = s->now;
    sum->length = h;
    sum->first = 0;
    sum->last = v->count;
    memset(sum->cosine, 0, (size_t)v->count * sizeof(double));
    memset(sum->sine, 0, (size_t)v->count * sizeof(double));
    for (int j = 0; j < MODAL_NODES; j++) {
        total[j] += f->rest[j];
    }

    // mode by mode
    for (int k = 0; k < s->count; k++) {
        const double rate = s->modes->rate[k], damping = s->damping[k];
        const double speed =
            k == s->modes->across ? s->drifts[0][k] : s->start[k] + s->drifts[0][k];
        double n[MODAL_NODES];
        for (int j = 0; j < MODAL_NODES; j++) {
            const double turn = j + 1 < MODAL_NODES ? s->drift[j + 1][k] : 0;
            n[j] = s->force[j][k] + 2 * damping * s->drift[j][k] + turn;
        }
        if (k == s->modes->across) {
            memset(g, 0, sizeof g);
            for (int j = 0; j < MODAL_NODES; j++) {
                g[j + 1] = s->drift[j][k];
            }
        } else if (v->entry[k] < 0 || (rate * h <= SLOW_TURN && 2 * damping * h <= SLOW_TURN)) {
            slow_mode(damping, rate, speed, n, g);
            sum->first =
                v->entry[k] >= 0 && v->entry[k] == sum->first ? sum->first + 1 : sum->first;
        } else {
            followed(damping, rate, n, g);
            add_vibration(f, v, k, -g[0], speed - g[1]);
        }
        total[0] -= f->speed[k] * speed;
        for (int j = 0; j < MODAL_SERIES; j++) {
            total[j] += f->place[k] * g[j] + f->speed[k] * g[j + 1];
        }
    }

    // in powers of the share of the stride
    double scale = 1, most = 0;
    sum->terms = 1;
    for (int j = 0; j < MODAL_SERIES; j++) {
        sum->series[j] = total[j] * scale;
        most = fmax(most, fabs(sum->series[j]));
        sum->terms = fabs(sum->series[j]) > 1e-19 * most ? j + 1 : sum->terms;
        scale *= h / (j + 1);
    }
}

size_t modal_function_size(int n)
{
    return 10 * (size_t)n;
}

void modal_function_place(modal_function *f, int n, double *storage)
{
    f->place = storage;
    f->speed = storage + n;
    f->sum.cosine = storage + 2 * n;
    f->sum.sine = storage + 4 * n;
    f->sum.a = storage + 6 * n;
    f->sum.b = storage + 8 * n;
}

void modal_function_fit(modal_function *f, watch kind, modal_stride *s, const arm *a, motion *m)
{
    f->kind = kind;
    fit_functional(f, s, a, m);
    f->value = exact_at(kind, a, m, s->mode, state_angles(m, m->state),
                        state_velocities(m, m->state), s->columns);

    // what the modes leave over at the points of collocation
    double values[MODAL_NODES] = {0};
    for (int i = 1; i < MODAL_NODES; i++) {
        const double *x = s->modal + (size_t)(2 * i) * (size_t)s->dof;
        double exact =
            exact_at(kind, a, m, s->mode, s->point_angles[i], s->point_velocities[i], s->columns);
        values[i] = exact - f->value - functional(f, s, x, x + s->dof, s->drifts[i], s->drifts[0]);
    }

    // both parts as functions of time
    modal_polynomial(values, s->length, f->rest);
    fit_sum(f, s);
}

// Friction counts by its size: what is left of it.
static glance as_watched(const modal_function *f, const arm *a, glance g)
{
    if (f->kind == WATCH_STICTION) {
        g = (glance){a->motor.stiction - fabs(g.value), g.value > 0 ? -g.slope : g.slope};
    }
    return (glance){g.value - f->edge, g.slope};
}

// Value and slope where the walk is.
static glance walked(const modal_function *f, const arm *a)
{
    return as_watched(f, a, f->sum.now);
}

glance modal_function_at(const modal_function *f, const arm *a, double t)
{
    return as_watched(f, a, modal_sum_at(&f->sum, t));
}

// --- events -------------------------------------------------------------------------------------

typedef struct look_at {
    double time;
    glance at;
} look_at;

static look_at look_of(const modal_function *f, const arm *a, double time)
{
    return (look_at){time, modal_function_at(f, a, time)};
}

// Where in (0, 1) the cubic through two samples is least, or -1.
static double dip_of(look_at lo, look_at hi)
{
    const double h = hi.time - lo.time, d0 = lo.at.slope * h, d1 = hi.at.slope * h;
    if (!(d0 < 0 && d1 > 0)) {
        return -1;
    }
    const double rise = hi.at.value - lo.at.value;
    const double c = d0 + d1 - 2 * rise, b = 3 * rise - 2 * d0 - d1;
    const double root = sqrt(fmax(b * b - 3 * c * d0, 0));
    return b + root != 0 ? -d0 / (b + root) : -1;
}

// Narrows [lo, hi] with the function's slope rising through zero to its least value.
static look_at least_of(const modal_function *f, const arm *a, look_at lo, look_at hi)
{
    const double resolution = fmax(1e-3 * (hi.time - lo.time), 1e-14);
    look_at best = lo.at.value < hi.at.value ? lo : hi;

    // false position, by halves every third time; a value below zero is enough
    for (int i = 0; i < 12 && best.at.value > 0 && hi.time - lo.time > resolution; i++) {
        double share = lo.at.slope / (lo.at.slope - hi.at.slope);
        share = i % 3 == 2 ? 0.5 : fmin(fmax(share, 1e-3), 1 - 1e-3);
        look_at now = look_of(f, a, lo.time + share * (hi.time - lo.time));
        best = now.at.value < best.at.value ? now : best;
        if (now.at.slope < 0) {
            lo = now;
        } else {
            hi = now;
        }
    }
    return best;
}

// The exact function at t, of the state that a stride to there ends in.
static double exact_value(const modal_function *f, modal_stride *s, const arm *a, motion *m,
                          double t)
{
    double *state = m->between;
    if (f->kind == WATCH_GAP) {
        return modal_gap_at(s, a, m, t) - f->edge;
    }
    memcpy(state, m->state, SLOT_COUNT * sizeof *state);
    (void)modal_state_at(s, a, m, t, state);
    glance g = {f->kind == WATCH_FORCE ? state[SLOT_FORCE]
                : f->kind == WATCH_HUB ? s->mode.friction * state_velocities(m, state)[0]
                                       : state[SLOT_FRICTION_TORQUE],
                0};
    return as_watched(f, a, g).value;
}

// The root of the exact function in [lo, hi], on its far side by a little.
static double root_of(const modal_function *f, modal_stride *s, const arm *a, motion *m, look_at lo,
                      look_at hi)
{
    double from = lo.time, to = hi.time, t = to, slope = hi.at.slope;
    for (int i = 0; i < MOST_ROOT_STEPS && to - from > 1e-16 + 1e-16 * to; i++) {
        glance g = modal_function_at(f, a, t);
        slope = g.slope;
        if (g.value > 0) {
            from = t;
        } else {
            to = t;
        }
        double next = t - g.value / g.slope;
        bool useful = next > from && next < to && i % 4 != 3;
        next = useful ? next : 0.5 * (from + to);
        if (fabs(next - t) < 1e-15) {
            break;
        }
        t = next;
    }

    // what the functional leaves out moves the root by little
    double target = far_side[f->kind];
    for (int i = 0; i < MOST_POLISHING && slope < 0; i++) {
        double value = exact_value(f, s, a, m, t);
        double next = t - (value + target) / slope;
        if ((value <= 0 && value >= -2 * target) || !(next > lo.time) || !(next <= s->length)) {
            break;
        }
        next = next == t ? nextafter(t, value > 0 ? HUGE_VAL : 0) : next;
        t = next;
        target *= 2;
    }
    return t;
}

// A function that starts at its edge and is below it at `hi`: where it leaves it. If it is nowhere
// above in between, a gap has left its edge where that is beyond rounding.
static double root_from_edge(modal_function *f, modal_stride *s, const arm *a, motion *m,
                             look_at hi)
{
    look_at now = hi;
    for (int i = 0; i < MOST_HALVINGS && !(now.at.value > 0); i++) {
        now = look_of(f, a, now.time / 2);
    }

    // above in between: an ordinary root
    if (now.at.value > 0) {
        return root_of(f, s, a, m, now, hi);
    }

    // nowhere above: only a gap has still to pass its rounding
    if (f->kind != WATCH_GAP) {
        return now.time;
    }
    f->edge -= GAP_ROUNDING;
    hi.at.value += GAP_ROUNDING;
    return hi.at.value < 0 ? root_of(f, s, a, m, look_of(f, a, 0), hi) : hi.time;
}

// Looks at one piece of the walk between two samples.
static bool falls_between(const modal_function *f, modal_stride *s, const arm *a, motion *m,
                          look_at lo, look_at hi, double *h)
{
    if (hi.at.value < 0) {
        *h = root_of(f, s, a, m, lo, hi);
        return true;
    }

    // a dip between them
    const double dip = dip_of(lo, hi);
    if (dip < 0 || dip > 1) {
        return false;
    }
    const double scale = fmax(fabs(lo.at.slope), fabs(hi.at.slope)) * (hi.time - lo.time);
    if (fmin(lo.at.value, hi.at.value) > scale + f->slack) {
        return false;
    }
    look_at least = least_of(f, a, lo, hi);
    if (least.at.value >= 0 && least.at.value < f->slack) {
        least.at.value = exact_value(f, s, a, m, least.time);
    }
    if (least.at.value >= 0) {
        return false;
    }
    *h = root_of(f, s, a, m, lo, least);
    return true;
}

// How far the walk may leap, and how finely it has to go where it may not.
static int leap(const modal_function *f, const arm *a, int *fine)
{
    if (f->kind != WATCH_STICTION) {
        return modal_sum_leap(&f->sum, 1, f->edge, f->slack, fine);
    }
    const double most = a->motor.stiction - f->edge;
    const int up = modal_sum_leap(&f->sum, -1, most, f->slack, fine);
    const int down = modal_sum_leap(&f->sum, 1, -most, f->slack, fine);
    return up > down ? up : down;
}

bool modal_function_falls(modal_function *f, modal_stride *s, const arm *a, motion *m, double *h)
{
    modal_sum_begin(&f->sum);
    f->edge = 0;
    look_at lo = {0, walked(f, a)};
    bool armed = fabs(lo.at.value) > far_side[f->kind] * ON_EDGE;
    if (!armed) {
        f->edge = lo.at.value;
        lo.at.value = 0;
    }
    f->slack = f->kind == WATCH_GAP ? SLACK_GAP
                                    : fmax(SLACK_OTHER, SLACK_SHARE * modal_sum_reach(&f->sum));

    // leaps where no event is certain, else a few samples as fine as the modes ask for
    const double length = *h;
    while (lo.time < length) {
        int fine, far = leap(f, a, &fine);
        if (armed && far < fine) {
            modal_sum_step(&f->sum, far);
            lo = (look_at){f->sum.time, walked(f, a)};
            continue;
        }
        for (int i = 0; i < SAMPLES_A_BLOCK && lo.time < length; i++) {
            modal_sum_step(&f->sum, fine);
            look_at hi = {f->sum.time, walked(f, a)};
            bool falls = false;
            if (armed) {
                falls = falls_between(f, s, a, m, lo, hi, h);
            } else if (hi.at.value < 0) {
                *h = root_from_edge(f, s, a, m, hi);
                falls = true;
            }
            if (falls && *h <= length) {
                return true;
            }
            if (falls) { // beyond the stride
                *h = length;
                return false;
            }
            armed = true;
            lo = hi;
        }
    }
    return false;
}

// --- peaks
// ----------------------------------------------------------------------------------------

// Narrows [lo, hi], the slope falling through zero, to the greatest value.
static look_at summit_of(const modal_function *f, const arm *a, look_at lo, look_at hi)
{
    look_at best = lo.at.value > hi.at.value ? lo : hi;
    const double resolution = 1e-6 * (hi.time - lo.time);

    // false position, by halves every fourth time
    for (int i = 0; i < 12 && hi.time - lo.time > resolution; i++) {
        double share = lo.at.slope / (lo.at.slope - hi.at.slope);
        share = i % 4 == 3 ? 0.5 : fmin(fmax(share, 1e-4), 1 - 1e-4);
        look_at now = look_of(f, a, lo.time + share * (hi.time - lo.time));
        best = now.at.value > best.at.value ? now : best;
        if (now.at.slope > 0) {
            lo = now;
        } else {
            hi = now;
        }
    }
    return best;
}

static void note_force(motion *m, look_at p)
{
    if (p.at.value > m->pulse_peak) {
        m->pulse_peak = p.at.value;
        m->pulse_peak_time = m->state[SLOT_TIME] + p.time;
    }
}

void modal_function_peak(modal_function *f, const arm *a, motion *m, double h)
{
    f->edge = 0;
    look_at end = look_of(f, a, h);
    modal_sum_begin(&f->sum);
    look_at lo = {0, walked(f, a)};
    note_force(m, lo);
    note_force(m, end);

    // leaps over what cannot reach the peak there is, every summit else
    const double slack = SLACK_SHARE * SLACK_SHARE * modal_sum_reach(&f->sum);
    while (lo.time < h) {
        int fine, far = modal_sum_leap(&f->sum, -1, m->pulse_peak, slack, &fine);
        if (far < fine) {
            modal_sum_step(&f->sum, far);
            lo = (look_at){f->sum.time, walked(f, a)};
            continue;
        }
        for (int i = 0; i < SAMPLES_A_BLOCK && lo.time < h; i++) {
            modal_sum_step(&f->sum, fine);
            look_at hi = {f->sum.time, walked(f, a)};
            hi = hi.time < h ? hi : end;
            double reach = fmax(fabs(lo.at.slope), fabs(hi.at.slope)) * (hi.time - lo.time);
            note_force(m, hi);
            if (lo.at.slope > 0 && hi.at.slope < 0 &&
                fmax(lo.at.value, hi.at.value) + 0.3 * reach > m->pulse_peak) {
                note_force(m, summit_of(f, a, lo, hi));
            }
            lo = hi;
        }
    }
}
