#include "src/solve/modal_watch.h"

#include <math.h>
#include <string.h>

#include "src/base/sincos.h"
#include "src/solve/locate.h"

#define PHASE_A_SAMPLE 0.6   // of the fastest mode that matters, from sample to sample [rad]
#define SLACK_GAP      1e-10 // [m]
#define SLACK_SHARE    1e-3  // of what all modes can do to any other function
#define SLACK_OTHER    1e-9  // and at least so much, in its unit
#define FAR_FROM_EDGE  4     // times what the modes that are passed over can do

enum { SAMPLES_A_BLOCK = 16, MOST_HALVINGS = 40, MOST_ROOT_STEPS = 60, MOST_POLISHING = 12 };

// How far beyond its edge a function is where it has left its admissible side.
static const double far_side[] = {[WATCH_GAP] = 1e-13,
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
    double x = 0, y = 0, c = 1, s = 0;
    for (int k = a->first; k < last; k++) {
        inline_sincos(q[k], &s, &c);
        x += l * c;
        y += l * s;
    }
    inline_sincos(q[last], &s, &c);
    wall_contact at = wall_contact_at(&a->wall, l, x, y, 0, 0, c, s, 0);
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
    memset(f->speed, 0, (size_t)n * sizeof(double));
    if (f->kind == WATCH_GAP) {
        contact_gradient(a, q, direction);
        for (int i = 0; i < n; i++) {
            direction[i] = -direction[i];
        }
        modal_from_angles(s->modes, n, 1, direction, f->place, n);
    } else if (f->kind == WATCH_FORCE) {
        chain_contact_response(a, m->links, q, stuck, direction, &compliance);
        for (int i = 0; i < n; i++) {
            direction[i] /= compliance;
        }
        through_springs(f, s, a, direction, stuck ? 0 : a->motor.damping * direction[0]);
    } else if (f->kind == WATCH_HUB) {
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

void modal_function_fit(modal_function *f, watch kind, modal_stride *s, const arm *a, motion *m)
{
    f->kind = kind;
    fit_functional(f, s, a, m);
    f->value = exact_at(kind, a, m, s->mode, state_angles(m, m->state),
                        state_velocities(m, m->state), s->columns);
    double values[MODAL_NODES] = {0};
    for (int i = 1; i < MODAL_NODES; i++) {
        const double *x = s->modal + (size_t)(2 * (i - 1)) * (size_t)s->dof;
        double exact =
            exact_at(kind, a, m, s->mode, s->point_angles[i], s->point_velocities[i], s->columns);
        values[i] = exact - f->value - functional(f, s, x, x + s->dof, s->drifts[i], s->drifts[0]);
    }
    modal_polynomial(values, s->length, f->rest);
}

static glance rest_at(const modal_function *f, double t)
{
    const double *r = f->rest;
    return (glance){r[0] + t * (r[1] + t / 2 * (r[2] + t / 3 * r[3])),
                    r[1] + t * (r[2] + t / 2 * r[3])};
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
static glance walked(const modal_function *f, const modal_stride *s, const arm *a)
{
    const modal_walk *w = &s->walk;
    const int e = s->modes->across;
    const double *drift0 = s->drifts[0], *rates = s->modes->rate;
    glance rest = rest_at(f, w->time);
    double value = f->value + rest.value, slope = rest.slope;
    for (int k = 0; k < w->count; k++) {
        const double start = k == e ? drift0[k] : s->start[k] + drift0[k];
        const double v = w->y[k] + w->drift[0][k];
        const double rate = w->force[0][k] + w->drift[1][k] - rates[k] * rates[k] * w->x[k] -
                            2 * s->damping[k] * w->y[k];
        value += f->place[k] * w->x[k] + f->speed[k] * (v - start);
        slope += f->place[k] * v + f->speed[k] * rate;
    }
    return as_watched(f, a, (glance){value, slope});
}

glance modal_function_at(const modal_function *f, modal_stride *s, const arm *a, double t)
{
    const int e = s->modes->across;
    const double *drift0 = s->drifts[0], *rates = s->modes->rate, *x = s->place, *y = s->momenta;
    const double t2 = t * t / 2, t3 = t * t2 / 3;
    double *const *r = s->drift, *const *force = s->force;
    modal_stride_modes(s, t);
    glance rest = rest_at(f, t);
    double value = f->value + rest.value, slope = rest.slope;
    for (int k = 0; k < s->count; k++) {
        const double drift = r[0][k] + t * r[1][k] + t2 * r[2][k] + t3 * r[3][k];
        const double turn = r[1][k] + t * r[2][k] + t2 * r[3][k];
        const double pushed = force[0][k] + t * force[1][k] + t2 * force[2][k] + t3 * force[3][k];
        const double v = k == e ? drift : y[k] + drift;
        const double start = k == e ? drift0[k] : s->start[k] + drift0[k];
        const double rate =
            k == e ? turn : pushed + turn - rates[k] * rates[k] * x[k] - 2 * s->damping[k] * y[k];
        value += f->place[k] * x[k] + f->speed[k] * (v - start);
        slope += f->place[k] * v + f->speed[k] * rate;
    }
    return as_watched(f, a, (glance){value, slope});
}

// --- how finely to look -----------------------------------------------------------------------

// What the modes can do to the function from where the walk is, sorted by how finely one would have
// to look at them: by_halvings[i] is of those that need i halvings of `length`.
static double sort_modes(const modal_function *f, const modal_stride *s, double length,
                         double by_halvings[MOST_HALVINGS + 1])
{
    const modal_walk *w = &s->walk;
    double all = 0;
    memset(by_halvings, 0, (MOST_HALVINGS + 1) * sizeof(double));
    for (int k = 0; k < w->count; k++) {
        const double rate = s->modes->rate[k], damping = s->damping[k];
        if (rate == 0) {
            continue;
        }
        // deviation from the slow answer to the forces
        double x = w->x[k] - (w->force[0][k] + 2 * damping * w->drift[0][k]) / (rate * rate);
        double v = w->y[k] + w->drift[0][k] - w->force[1][k] / (rate * rate);
        double parts[2], rates[2] = {rate, rate};
        if (damping < rate) {
            parts[0] = sqrt(x * x + v * v / (rate * rate));
            parts[1] = 0;
        } else {
            const double root = sqrt(damping * damping - rate * rate);
            rates[0] = rate * rate / (damping + root);
            rates[1] = damping + root;
            parts[0] = root > 0 ? fabs((v + rates[1] * x) / (2 * root)) : fabs(x);
            parts[1] = root > 0 ? fabs((v + rates[0] * x) / (2 * root)) : fabs(x);
        }
        for (int i = 0; i < 2; i++) {
            double part = parts[i] * (fabs(f->place[k]) + fabs(f->speed[k]) * rates[i]);
            int halvings = 0;
            if (rates[i] * length > PHASE_A_SAMPLE) {
                (void)frexp(rates[i] * length / PHASE_A_SAMPLE, &halvings);
            }
            by_halvings[halvings < MOST_HALVINGS ? halvings : MOST_HALVINGS] += part;
            all += part;
        }
    }
    return all;
}

// Halvings of the length so that what they pass over stays below `slack`; *passed is what that is.
static int halvings_for(const double *by_halvings, double slack, double *passed)
{
    int i = MOST_HALVINGS;
    *passed = 0;
    while (i > 0 && *passed + by_halvings[i] <= slack) {
        *passed += by_halvings[i--];
    }
    return i;
}

// --- events -------------------------------------------------------------------------------------

typedef struct look_at {
    double time;
    glance at;
} look_at;

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
static look_at least_of(const modal_function *f, modal_stride *s, const arm *a, look_at lo,
                        look_at hi)
{
    look_at best = lo.at.value < hi.at.value ? lo : hi;
    for (int i = 0; i < 12 && best.at.value > 0; i++) {
        double share = lo.at.slope / (lo.at.slope - hi.at.slope);
        share = i % 3 == 2 ? 0.5 : fmin(fmax(share, 1e-3), 1 - 1e-3);
        look_at now = {lo.time + share * (hi.time - lo.time), {0}};
        now.at = modal_function_at(f, s, a, now.time);
        best = now.at.value < best.at.value ? now : best;
        if (now.at.slope < 0) {
            lo = now;
        } else {
            hi = now;
        }
        if (hi.time - lo.time < 1e-3 * s->walk.step || hi.time - lo.time < 1e-14) {
            break;
        }
    }
    return best;
}

// The exact function at t, of the state that a stride to there ends in.
static double exact_value(const modal_function *f, const arm *a, motion *m, double t)
{
    if (motion_try_step(a, m, t) != STATUS_OK) {
        return 0;
    }
    const double *state = m->trial;
    glance g = {f->kind == WATCH_GAP     ? state[SLOT_GAP]
                : f->kind == WATCH_FORCE ? state[SLOT_FORCE]
                : f->kind == WATCH_HUB   ? state[SLOT_FRICTION] * state_velocities(m, m->trial)[0]
                                         : state[SLOT_FRICTION_TORQUE],
                0};
    return as_watched(f, a, g).value;
}

// The root of the exact function in [lo, hi], on its far side by a little.
static double root_of(const modal_function *f, modal_stride *s, const arm *a, motion *m, look_at lo,
                      look_at hi)
{
    double from = lo.time, to = hi.time, t = to, slope = -1;
    for (int i = 0; i < MOST_ROOT_STEPS && to - from > 1e-16 + 1e-16 * to; i++) {
        glance g = modal_function_at(f, s, a, t);
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
        double value = exact_value(f, a, m, t);
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

// A function that starts at its edge and is below it at `hi`: where it is above it in between, if
// it is anywhere.
static look_at risen_between(const modal_function *f, modal_stride *s, const arm *a, look_at hi)
{
    look_at now = hi;
    for (int i = 0; i < MOST_HALVINGS && !(now.at.value > 0); i++) {
        now.time /= 2;
        now.at = modal_function_at(f, s, a, now.time);
    }
    return now;
}

// Looks at one piece of the walk between two samples.
static bool falls_between(const modal_function *f, modal_stride *s, const arm *a, motion *m,
                          look_at lo, look_at hi, bool armed, double *h)
{
    if (hi.at.value < 0 && armed) {
        *h = root_of(f, s, a, m, lo, hi);
        return true;
    }
    const double dip = armed ? dip_of(lo, hi) : -1;
    if (dip < 0 || dip > 1) {
        return false;
    }
    const double scale = fmax(fabs(lo.at.slope), fabs(hi.at.slope)) * (hi.time - lo.time);
    if (fmin(lo.at.value, hi.at.value) > scale + f->slack) {
        return false;
    }
    look_at least = least_of(f, s, a, lo, hi);
    if (least.at.value >= 0 && least.at.value < f->slack) {
        least.at.value = exact_value(f, a, m, least.time);
    }
    if (least.at.value >= 0) {
        return false;
    }
    *h = root_of(f, s, a, m, lo, least);
    return true;
}

bool modal_function_falls(modal_function *f, modal_stride *s, const arm *a, motion *m, double *h)
{
    const double length = *h;
    double by_halvings[MOST_HALVINGS + 1], passed = 0;
    modal_walk_begin(s, s->count);
    f->edge = 0;
    glance first = walked(f, s, a);
    bool armed = fabs(first.value) > far_side[f->kind] * ON_EDGE;
    if (!armed) {
        f->edge = first.value;
    }
    double all = sort_modes(f, s, length, by_halvings);
    f->slack = f->kind == WATCH_GAP ? SLACK_GAP : fmax(SLACK_OTHER, SLACK_SHARE * all);
    look_at start = {0, walked(f, s, a)};

    // a look at the slow modes alone, where the others cannot reach the edge
    int fine = halvings_for(by_halvings, f->slack, &passed);
    int coarse = halvings_for(by_halvings, start.at.value / (2 * FAR_FROM_EDGE), &passed);
    coarse = coarse < 3 ? 3 : coarse;
    if (coarse < fine) {
        modal_walk_set_step(s, ldexp(length, -coarse));
        bool clear = true;
        for (int i = 0; i < 1 << coarse && clear; i++) {
            look_at before = {s->walk.time, walked(f, s, a)};
            modal_walk_on(s);
            look_at now = {s->walk.time, walked(f, s, a)};
            double dip = dip_of(before, now), least = fmin(before.at.value, now.at.value);
            if (dip > 0 && dip < 1) {
                least -= 0.2 * fmax(fabs(before.at.slope), fabs(now.at.slope)) * s->walk.step;
            }
            clear = least > FAR_FROM_EDGE * passed;
        }
        if (clear) {
            return false;
        }
        modal_walk_begin(s, s->count);
    }

    // all modes that matter, as finely as they ask for it at the time
    look_at lo = start;
    while (lo.time < length * (1 - 1e-12)) {
        sort_modes(f, s, length, by_halvings);
        int halvings = halvings_for(by_halvings, f->slack, &passed);
        double step = ldexp(length, -(halvings < 3 ? 3 : halvings));
        modal_walk_set_step(s, step);
        for (int i = 0; i < SAMPLES_A_BLOCK && lo.time < length * (1 - 1e-12); i++) {
            if (lo.time + step > length) {
                modal_walk_set_step(s, length - lo.time);
            }
            modal_walk_on(s);
            look_at hi = {s->walk.time, walked(f, s, a)};
            if (falls_between(f, s, a, m, lo, hi, armed, h)) {
                return true;
            }
            if (!armed && hi.at.value < 0) {
                look_at risen = risen_between(f, s, a, hi);
                *h = risen.at.value > 0 ? root_of(f, s, a, m, risen, hi) : risen.time;
                return true;
            }
            armed = true;
            lo = hi;
        }
    }
    return false;
}

// Narrows [lo, hi], the slope falling through zero, to the greatest value.
static look_at summit_of(const modal_function *f, modal_stride *s, const arm *a, look_at lo,
                         look_at hi)
{
    look_at best = lo.at.value > hi.at.value ? lo : hi;
    const double resolution = 1e-6 * (hi.time - lo.time);
    for (int i = 0; i < 12 && hi.time - lo.time > resolution; i++) {
        double share = lo.at.slope / (lo.at.slope - hi.at.slope);
        share = i % 4 == 3 ? 0.5 : fmin(fmax(share, 1e-4), 1 - 1e-4);
        look_at now = {lo.time + share * (hi.time - lo.time), {0}};
        now.at = modal_function_at(f, s, a, now.time);
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

void modal_function_peak(modal_function *f, modal_stride *s, const arm *a, motion *m, double h)
{
    double by_halvings[MOST_HALVINGS + 1], passed = 0;
    modal_walk_begin(s, s->count);
    double all = sort_modes(f, s, h, by_halvings);
    look_at lo = {0, walked(f, s, a)};
    note_force(m, lo);

    // can the modes together reach the peak there is?
    int coarse = halvings_for(by_halvings, m->pulse_peak / FAR_FROM_EDGE, &passed);
    coarse = coarse < 3 ? 3 : coarse;
    modal_walk_set_step(s, ldexp(h, -coarse));
    double most = lo.at.value;
    for (int i = 0; i < 1 << coarse; i++) {
        modal_walk_on(s);
        glance now = walked(f, s, a);
        most = fmax(most, now.value + 0.1 * fabs(now.slope) * s->walk.step);
    }
    if (most + 2 * passed <= m->pulse_peak) {
        return;
    }

    // every summit
    int fine = halvings_for(by_halvings, SLACK_SHARE * SLACK_SHARE * all, &passed);
    fine = fine < 3 ? 3 : fine;
    modal_walk_begin(s, s->count);
    modal_walk_set_step(s, ldexp(h, -fine));
    for (int i = 0; i < 1 << fine; i++) {
        modal_walk_on(s);
        look_at hi = {s->walk.time, walked(f, s, a)};
        double reach = fmax(fabs(lo.at.slope), fabs(hi.at.slope)) * s->walk.step;
        note_force(m, hi);
        if (lo.at.slope > 0 && hi.at.slope < 0 &&
            fmax(lo.at.value, hi.at.value) + 0.3 * reach > m->pulse_peak) {
            note_force(m, summit_of(f, s, a, lo, hi));
        }
        lo = hi;
    }
}
