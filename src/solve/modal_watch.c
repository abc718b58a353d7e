#include "src/solve/modal_watch.h"

#include <math.h>
#include <string.h>

#include "src/solve/locate.h"
#include "src/solve/modal_state.h"

#define SLACK_GAP    1e-10 // [m]
#define SLACK_SHARE  1e-3  // of what all modes can do to any other function
#define SLACK_OTHER  1e-9  // and at least so much, in its unit
#define GAP_ROUNDING 4e-15 // [m]
#define SHARE_BEYOND 1e-9  // of a flight's height or a force, by which an event is beyond its edge
#define TIME_BEYOND  1e-12 // by which the end of a flight is late at most, however slow it is [s]

enum { SAMPLES_A_BLOCK = 4, MOST_HALVINGS = 40, MOST_ROOT_STEPS = 60, MOST_POLISHING = 12 };

// How far beyond its edge a function is where it has left its admissible side.
static const double far_side[] = {[WATCH_GAP] = 1e-14,
                                  [WATCH_FORCE] = FORCE_TOLERANCE,
                                  [WATCH_HUB] = 1e-13,
                                  [WATCH_STICTION] = 1e-11};
#define ON_EDGE 1e3 // times that: a start so little beyond the edge is one on it

// --- events -------------------------------------------------------------------------------------

// Value and slope where the walk is.
static glance walked(const modal_function *f, const arm *a)
{
    return modal_function_watched(f, a, f->sum.now);
}

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

double modal_function_of(const modal_function *f, const modal_stride *s, const arm *a,
                         const motion *m, double *state)
{
    const double hub = state_velocities(m, state)[0];
    const glance g = {f->kind == WATCH_GAP     ? state[SLOT_GAP]
                      : f->kind == WATCH_FORCE ? state[SLOT_FORCE]
                      : f->kind == WATCH_HUB   ? s->mode.friction * hub
                                               : state[SLOT_FRICTION_TORQUE],
                      0};
    return modal_function_watched(f, a, g).value;
}

double modal_function_exact(const modal_function *f, modal_stride *s, const arm *a, motion *m,
                            double t)
{
    double *state = m->between;
    if (f->kind == WATCH_GAP) {
        return f->value - f->edge + modal_gap_change(s, a, m, t);
    }
    memcpy(state, m->state, SLOT_COUNT * sizeof *state);
    (void)modal_state_at(s, a, m, t, state);
    return modal_function_of(f, s, a, m, state);
}

// The root of the exact function in [lo, hi], on its far side by a little.
static double root_of(const modal_function *f, modal_stride *s, const arm *a, motion *m, look_at lo,
                      look_at hi)
{
    const bool brief = f->kind == WATCH_GAP && fabs(f->value) <= MODAL_ON_WALL;
    const double rounding = brief ? 0 : 1e-16; // [s]
    double from = lo.time, to = hi.time, t = to, slope = hi.at.slope;
    for (int i = 0; i < MOST_ROOT_STEPS && to - from > rounding + 1e-16 * to; i++) {
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
        if (fabs(next - t) < 10 * rounding + 1e-15 * t) {
            break;
        }
        t = next;
    }

    // the functional's error moves the root only a little; a slope that steepens, as from the top
    // of a flight of some 1e-14 m, would take Newton's step far beyond
    double target = far_side[f->kind], above = -1, below = HUGE_VAL;
    target = brief ? fmin(target, SHARE_BEYOND * fabs(slope) * t) : target;
    target = fmin(target, f->kind == WATCH_GAP ? TIME_BEYOND * fabs(slope) : f->most_beyond);
    for (int i = 0; i < MOST_POLISHING && slope < 0; i++) {
        const double value = modal_function_exact(f, s, a, m, t);
        if (value <= 0 && value >= -2 * target) {
            break;
        }
        above = value > 0 ? t : above;
        below = value > 0 ? below : t;
        double next = t - (value + target) / slope;
        const bool enclosed = above >= 0 && below < HUGE_VAL;
        if (enclosed && !(next > above && next < below)) {
            t = 0.5 * (above + below);
            continue;
        }
        if (!(next > lo.time) || !(next <= s->length)) {
            break;
        }
        next = next == t ? nextafter(t, value > 0 ? HUGE_VAL : 0) : next;
        t = next;
        target *= 2;
    }
    return t;
}

// The root of a function that starts at zero and is below zero at `hi`. If it is nowhere above zero
// in between, a gap counts as closed where it is below zero by more than rounding.
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
        least.at.value = modal_function_exact(f, s, a, m, least.time);
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

// A bound on the function's magnitude within its stride.
static double most_of(const modal_sum *f)
{
    double most = modal_sum_reach(f);
    for (int i = 0; i < f->terms; i++) {
        most += fabs(f->series[i]);
    }
    return most;
}

bool modal_function_falls(modal_function *f, modal_stride *s, const arm *a, motion *m, double *h)
{
    modal_sum_begin(&f->sum);
    f->edge = 0;
    look_at lo = {0, walked(f, a)};

    // it starts on its edge or a little beyond, or is still to come there, however little is left;
    // just after an event a gap so small is one of an arm that leaves the wall, unless it closes
    const bool gap = f->kind == WATCH_GAP, leaves = m->state[SLOT_JUMPED] != 0 && lo.at.slope >= 0;
    const double edge = gap ? MODAL_ON_WALL : far_side[f->kind] * ON_EDGE;
    const double within = !gap ? 0 : leaves ? MODAL_ON_WALL : GAP_ROUNDING;
    bool armed = lo.at.value > within || lo.at.value < -edge;
    if (!armed) {
        f->edge = lo.at.value;
        lo.at.value = 0;
    }
    f->slack = gap ? SLACK_GAP : fmax(SLACK_OTHER, SLACK_SHARE * modal_sum_reach(&f->sum));
    f->most_beyond = SHARE_BEYOND * most_of(&f->sum);

    // leaps where an event is excluded, else a few samples as close as the modes require
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

// --- peaks --------------------------------------------------------------------------------------

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
