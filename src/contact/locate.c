#include "src/contact/locate.h"

#include <math.h>
#include <string.h>

#define TOUCH_TOLERANCE  1e-12 // penetration that counts as crossing the wall [m]
#define GAP_ROUNDING     4e-15 // penetration that may be rounding [m]
#define TORQUE_TOLERANCE 1e-12 // excess that counts as breaking away [N m]
// share of a step that an impact takes where steps do not resolve it
#define UNRESOLVED_IMPACT 0.1
#define LOCATION_TIME     1e-15 // width to which the bracket of an event is narrowed [s]

// Whether the arm is in contact with a wall that gives, and no constraint holds it: the
// watched gap is then the depth.
static bool within_wall(const motion *m, const double *state)
{
    return m->wall_gives && state[SLOT_CONTACT] != 0;
}

// Positive on the admissible side.
static double event_value(const arm *a, const motion *m, const double *state,
                          event_function w)
{
    if (w == EVENT_OF_GAP) {
        if (within_wall(m, state)) {
            return -state[SLOT_GAP];
        }
        return state[SLOT_GAP];
    }
    if (w == EVENT_OF_FORCE) {
        return state[SLOT_FORCE];
    }
    if (w == EVENT_OF_HUB) {
        return state[SLOT_FRICTION] * state[SLOT_COUNT + m->dof];
    }
    return a->motor.stiction - fabs(state[SLOT_FRICTION_TORQUE]);
}

double event_tolerance(event_function w)
{
    if (w == EVENT_OF_GAP) {
        return TOUCH_TOLERANCE;
    }
    if (w == EVENT_OF_FORCE) {
        return FORCE_TOLERANCE;
    }
    if (w == EVENT_OF_STICTION) {
        return TORQUE_TOLERANCE;
    }
    return 0;
}

// Where in (0, 1) a cubic with the given end values and end slopes (per step) is least,
// if that lies inside and the cubic falls at the start and rises at the end; else -1.
static double cubic_dip(double v0, double v1, double d0, double d1)
{
    if (!(d0 < 0 && d1 > 0)) {
        return -1;
    }
    // derivative of the Hermite cubic: d0 + 2 b s + 3 c s^2

    double c = d0 + d1 - 2 * (v1 - v0), b = 3 * (v1 - v0) - 2 * d0 - d1;
    double root = sqrt(fmax(b * b - 3 * c * d0, 0));
    if (b + root != 0) {
        return -d0 / (b + root);
    }
    return -1;
}

// Slopes of an event function at both ends of the step from m->state to m->trial, per
// step. False where they are not known.
static bool event_slopes(const motion *m, double h, event_function w, double *d0,
                         double *d1)
{
    const double *state = m->state, *trial = m->trial;

    // states contain the slopes of gap and hub velocity
    if (w == EVENT_OF_GAP) {
        double sign = within_wall(m, state) ? -1 : 1;
        *d0 = sign * state[SLOT_GAP_VELOCITY] * h;
        *d1 = sign * trial[SLOT_GAP_VELOCITY] * h;
    } else if (w == EVENT_OF_HUB) {
        *d0 = state[SLOT_FRICTION] * state_accelerations(m, m->state)[0] * h;
        *d1 = state[SLOT_FRICTION] * state_accelerations(m, m->trial)[0] * h;
    } else if (w == EVENT_OF_FORCE) {
        // parabola through both ends with the mean the quadrature gives
        double mean = (state_quadratures(m, m->trial)[QUADRATURE_FORCE] -
                       state_quadratures(m, m->state)[QUADRATURE_FORCE]) /
                      h;
        double rise = trial[SLOT_FORCE] - state[SLOT_FORCE];
        double curve = 3 * (state[SLOT_FORCE] + trial[SLOT_FORCE]) - 6 * mean;
        *d0 = rise - curve;
        *d1 = rise + curve;
    }
    return w != EVENT_OF_STICTION;
}

// Hermite's cubic at s in (0, 1).
static double cubic(double s, double v0, double v1, double d0, double d1)
{
    double t = 1 - s;
    return t * t * (1 + 2 * s) * v0 + s * t * t * d0 + s * s * (3 - 2 * s) * v1 -
           s * s * t * d1;
}

// Fraction of the step at which a function that is admissible at both ends may dip below
// zero in between; -1 if there is no sign of a dip.
static double suspected_dip(const arm *a, const motion *m, double h, event_function w,
                            double v0, double v1)
{
    double d0, d1;

    if (!event_slopes(m, h, w, &d0, &d1)) {
        // near the limit of friction the middle of the step is checked
        if (fmin(v0, v1) < 0.2 * a->motor.stiction) {
            return 0.5;
        }
        return -1;
    }

    // the least value of the cubic, if it comes near zero
    double s = cubic_dip(v0, v1, d0, d1);
    if (s <= 1e-6 || s >= 1) { // a dip right at the start is the edge it starts from
        return -1;
    }
    if (cubic(s, v0, v1, d0, d1) < 1e-3 * fmax(v0, v1)) {
        return s;
    }
    return -1;
}

// A first guess of where the function crosses zero between v0 > 0 and v1 < 0: the root of
// Hermite's cubic by a few steps of false position, or of the straight line.
static double guess_crossing(const motion *m, double h, event_function w, double v0,
                             double v1)
{
    double d0, d1, lo = 0, hi = 1, s = v0 / (v0 - v1), v_lo = v0, v_hi = v1;

    if (!event_slopes(m, h, w, &d0, &d1)) {
        return s;
    }

    // false position, the end that stays halved
    for (int i = 0; i < 12; i++) {
        double v = cubic(s, v0, v1, d0, d1);
        if (v > 0) {
            lo = s, v_lo = v, v_hi /= 2;
        } else {
            hi = s, v_hi = v, v_lo /= 2;
        }
        s = lo + (hi - lo) * v_lo / (v_lo - v_hi);
    }
    return s;
}

// Where a function changes sign within a step, and its values there above its edge.
typedef struct bracket {
    double lo, v_lo, hi, v_hi;
    double edge; // in the function's unit, commonly zero
} bracket;

// Narrows a bracket until it is as narrow as LOCATION_TIME; m->trial ends as the state at
// its far side. Starts at `s` and continues by Chandrupatla's method: inverse quadratic
// interpolation where the last three values allow it, else bisection.
static status narrow_bracket(const arm *a, motion *m, event_function w, double s,
                             bracket *b)
{
    // the velocities of an implicit step are differences of angles over it: it must not
    // be tiny
    const double least = motion_unresolved(a, m) ? 1e-6 * m->nominal_step : LOCATION_TIME;
    const double resolution = fmax(least, LOCATION_TIME * m->state[SLOT_TIME]);

    double evaluated = -1;
    for (int i = 0; i < 200 && b->hi - b->lo > resolution; i++) {
        s = fmin(fmax(s, b->lo + 0.5 * resolution), b->hi - 0.5 * resolution);
        TRY(motion_try_step(a, m, s, STATE_WHOLE));
        evaluated = s;

        // the bracket, and the end that the new point replaces
        double v = event_value(a, m, m->trial, w) - b->edge, other, v_other, old, v_old;
        if (v > 0) {
            old = b->lo, v_old = b->v_lo, other = b->hi, v_other = b->v_hi;
            b->lo = s, b->v_lo = v;
        } else {
            old = b->hi, v_old = b->v_hi, other = b->lo, v_other = b->v_lo;
            b->hi = s, b->v_hi = v;
        }

        // where the three values let an inverse parabola go, else the middle
        double xi = (s - other) / (old - other), phi = (v - v_other) / (v_old - v_other);
        double t = 0.5;
        if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi) {
            t = v / (v_other - v) * v_old / (v_other - v_old) +
                (old - s) / (other - s) * v / (v_old - v) * v_other / (v_old - v_other);
        }
        // an estimate that has settled is stepped past, so that the bracket closes on it
        double next = s + t * (other - s);
        if (fabs(next - s) < 0.5 * resolution) {
            s = s + copysign(resolution, other - s);
        } else {
            s = next;
        }
    }
    if (evaluated == b->hi) {
        return STATUS_OK;
    }
    return motion_try_step(a, m, b->hi, STATE_WHOLE);
}

// An event function between two instants of a step, and where its crossing is guessed.
typedef struct crossing_search {
    double lo, v_lo, hi, v_hi; // [s], and in the function's unit
    double guess;              // [s]
} crossing_search;

// Where a function is admissible at both ends only a dip in between can leave its side:
// the search then ends at the dip, and *crosses is true. Else m->trial is the step's end.
static status search_dip(const arm *a, motion *m, event_function w, crossing_search *in,
                         bool *crosses)
{
    const double h = in->hi, tolerance = event_tolerance(w);
    double dip = -1;
    *crosses = false;
    if (in->v_lo > 0 && in->v_hi > 0) {
        dip = suspected_dip(a, m, h, w, in->v_lo, in->v_hi);
    }
    if (dip < 0) {
        return STATUS_OK;
    }

    // the value at the dip decides
    TRY(motion_try_step(a, m, dip * h, STATE_WHOLE));
    in->v_hi = event_value(a, m, m->trial, w);
    if (in->v_hi >= -tolerance) {
        return motion_try_step(a, m, h, STATE_WHOLE);
    }
    in->hi = dip * h;
    in->guess = 0.5 * in->hi;
    *crosses = true;
    return STATUS_OK;
}

// A function that starts at zero (a release, a break-away): halves the step until it is
// clearly admissible. *closed and *v_closed get the first instant on the way that has a
// gap closed beyond rounding.
static status search_admissible(const arm *a, motion *m, event_function w, double beyond,
                                crossing_search *in, double *closed, double *v_closed)
{
    double s = in->hi;
    for (int i = 0; i < 20; i++) {
        s /= 2;
        TRY(motion_try_step(a, m, s, STATE_WHOLE));
        const double v = event_value(a, m, m->trial, w);
        if (v > 0) {
            in->lo = s;
            in->v_lo = v;
            break;
        }

        in->hi = s;
        in->v_hi = v;
        if (v < beyond) {
            *closed = s;
            *v_closed = v;
        }
    }
    in->guess = 0.5 * (in->lo + in->hi);
    return STATUS_OK;
}

// An unresolved impact happens within its step: nothing is located inside its first part,
// so that an event found there is put off to its end.
static status leave_impact(const arm *a, motion *m, double h, double *found)
{
    const double least = fmin(h, UNRESOLVED_IMPACT * m->nominal_step);
    const bool within =
        m->state[SLOT_JUMPED] != 0 && m->state[SLOT_CONTACT] != 0 && *found < least;
    if (!within || !motion_unresolved(a, m)) {
        return STATUS_OK;
    }
    *found = least;
    return motion_try_step(a, m, least, STATE_WHOLE);
}

// Looks for the first instant in (0, end->length] at which `w` leaves its admissible
// side; if there is one, *end and m->trial move there.
static status search_interval(const arm *a, motion *m, event_function w, step_end *end)
{
    const double h = end->length, tolerance = event_tolerance(w);
    crossing_search in = {.hi = h,
                          .v_lo = event_value(a, m, m->state, w),
                          .v_hi = event_value(a, m, m->trial, w),
                          .guess = 0.5 * h};
    if (in.v_lo > 0 && in.v_hi < 0) {
        in.guess = h * guess_crossing(m, h, w, in.v_lo, in.v_hi);
    }
    if (in.v_hi >= -tolerance) {
        bool crosses;
        TRY(search_dip(a, m, w, &in, &crosses));
        if (!crosses) {
            return STATUS_OK;
        }
    }

    // from zero, to where it is admissible
    const double beyond = fmin(in.v_lo, 0) - GAP_ROUNDING;
    double closed = in.hi, v_closed = in.v_hi;
    if (in.v_lo <= tolerance) {
        TRY(search_admissible(a, m, w, beyond, &in, &closed, &v_closed));
    }

    // a gap that was nowhere found open closes where it exceeds its rounding: this ends
    // flights too low to be told from rounding (after an impact that leaves the arm with
    // hardly any force)
    double edge = 0;
    if (w == EVENT_OF_GAP && !(in.v_lo > 0) && !m->wall_gives) {
        edge = beyond;
        in.hi = closed;
        in.v_hi = v_closed;
        in.guess = 0.5 * closed;
    }

    // narrowed to the width that time resolves
    end->any = true;
    end->first = w;
    bracket between = {in.lo, in.v_lo - edge, in.hi, in.v_hi - edge, edge};
    status s = narrow_bracket(a, m, w, in.guess, &between);
    end->length = between.hi;
    if (s == STATUS_OK) {
        s = leave_impact(a, m, h, &end->length);
    }
    return s;
}

status locate_first_event(const arm *a, motion *m, step_end *end)
{
    *end = (step_end){.length = end->length};
    for (event_function w = EVENT_OF_GAP; w <= EVENT_OF_STICTION && !motion_held_still(m);
         w++) {
        if (event_function_active(a, m, w)) {
            TRY(search_interval(a, m, w, end));
        }
    }
    return STATUS_OK;
}

// --- the largest depth and force -------------------------------------------------------

void locate_deepest(const arm *a, motion *m, step_point lo, step_point hi,
                    double resolution, rest_gap_function at)
{
    // false position on the rate, the end that stays halved
    double from = lo.time, to = hi.time, v0 = lo.at.slope, v1 = hi.at.slope;
    for (int i = 0; i < 40 && v0 < 0 && v1 > 0 && to - from > resolution; i++) {
        const double t = from + (to - from) * v0 / (v0 - v1);
        const value_and_slope g = at(a, m, t);
        m->record.largest_penetration = fmax(m->record.largest_penetration, -g.value);
        if (g.slope < 0) {
            from = t, v0 = g.slope, v1 /= 2;
        } else {
            to = t, v1 = g.slope, v0 /= 2;
        }
    }
}

// The gap to the wall at rest and its rate after a step h; NaN where that fails.
static value_and_slope stepped_gap(const arm *a, motion *m, double h)
{
    const bool fails = motion_try_step(a, m, h, STATE_WHOLE) != STATUS_OK;
    if (fails) {
        return (value_and_slope){(double)NAN, (double)NAN};
    }
    return state_rest_gap(m->trial);
}

status locate_peak(const arm *a, motion *m, double h)
{
    memcpy(m->between, m->trial, (size_t)m->size * sizeof(double));
    if (!motion_wall_is_rigid(m)) {
        const step_point lo = {0, state_rest_gap(m->state)},
                         hi = {h, state_rest_gap(m->trial)};
        locate_deepest(a, m, lo, hi, 1e-9 * h, stepped_gap);
        memcpy(m->trial, m->between, (size_t)m->size * sizeof(double));
    }

    // the ends
    double f0 = m->state[SLOT_FORCE], f1 = m->trial[SLOT_FORCE], t0 = m->state[SLOT_TIME];
    motion_note_force(m, t0, f0);
    motion_note_force(m, t0 + h, f1);

    // the summit of the parabola through both ends and the mean, if there is one inside
    double mean = (state_quadratures(m, m->trial)[QUADRATURE_FORCE] -
                   state_quadratures(m, m->state)[QUADRATURE_FORCE]) /
                  h;
    double curve = 3 * (f0 + f1) - 6 * mean, slope = f1 - f0 - curve;
    if (!(slope > 0 && slope + 2 * curve < 0)) {
        return STATUS_OK;
    }
    double s = -slope / (2 * curve) * h, top = f0 + slope * (s / h) / 2;
    if (top <= m->record.pulse_peak * (1 + 1e-12)) {
        return STATUS_OK;
    }

    // closer and closer around it, the parabola through three steps
    for (double width = h / 8; width > h / 1000; width /= 16) {
        double f[3];
        s = fmin(fmax(s, width), h - width);
        for (int i = 0; i < 3; i++) {
            TRY(motion_try_step(a, m, s + (i - 1) * width, STATE_WHOLE));
            f[i] = m->trial[SLOT_FORCE];
            motion_note_force(m, m->trial[SLOT_TIME], f[i]);
        }
        double second = f[0] - 2 * f[1] + f[2];
        if (second >= 0) {
            break;
        }
        double move = 0.5 * (f[0] - f[2]) / second;
        s += fmin(fmax(move, -1), 1) * width;
    }

    memcpy(m->trial, m->between, (size_t)m->size * sizeof(double));
    return STATUS_OK;
}
