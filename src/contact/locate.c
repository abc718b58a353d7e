#include "src/contact/locate.h"

#include <math.h>
#include <string.h>

#define TOUCH_TOLERANCE  1e-12 // penetration that counts as crossing the wall [m]
#define GAP_ROUNDING     4e-15 // penetration that may be rounding [m]
#define TORQUE_TOLERANCE 1e-12 // excess that counts as breaking away [N m]
// share of a step that an impact takes where steps do not resolve it
#define UNRESOLVED_IMPACT 0.1
#define LOCATION_TIME     1e-15 // width to which the bracket of an event is narrowed [s]

// Whether the arm is in contact with a wall that gives. No constraint then keeps the gap
// closed: it is negative, and the event function is the depth.
static bool within_wall(const motion *m, const double *state)
{
    return m->wall_gives && state[SLOT_CONTACT] != 0;
}

// The value of an event function in a state: gap (or depth), contact force, the hub's
// velocity in its sliding direction, or the torque that friction has in reserve. It is
// positive on the admissible side.
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

// Where in (0, 1) the cubic with end values v0, v1 and end slopes d0, d1 is least, if it
// falls at the start and rises at the end; else -1. The derivative of Hermite's cubic is
// d0 + 2 b s + 3 c s^2; the root at which it rises is written without cancellation.
static double cubic_dip(double v0, double v1, double d0, double d1)
{
    if (!(d0 < 0 && d1 > 0)) {
        return -1;
    }
    double c = d0 + d1 - 2 * (v1 - v0), b = 3 * (v1 - v0) - 2 * d0 - d1;
    double root = sqrt(fmax(b * b - 3 * c * d0, 0));
    if (b + root != 0) {
        return -d0 / (b + root);
    }
    return -1;
}

// Mean contact force over the step of length h from m->state to m->trial, by its
// integral.
static double mean_force(const motion *m, double h)
{
    const double after = state_quadratures(m, m->trial)[QUADRATURE_FORCE];
    const double before = state_quadratures(m, m->state)[QUADRATURE_FORCE];
    return (after - before) / h;
}

// Slopes of an event function at both ends of the step from m->state to m->trial, per
// step. False for stiction, whose slopes are not known.
static bool event_slopes(const motion *m, double h, event_function w, double *d0,
                         double *d1)
{
    const double *state = m->state, *trial = m->trial;

    // gap and hub: states contain their rates
    if (w == EVENT_OF_GAP) {
        double sign = within_wall(m, state) ? -1 : 1;
        *d0 = sign * state[SLOT_GAP_VELOCITY] * h;
        *d1 = sign * trial[SLOT_GAP_VELOCITY] * h;
    } else if (w == EVENT_OF_HUB) {
        *d0 = state[SLOT_FRICTION] * state_accelerations(m, m->state)[0] * h;
        *d1 = state[SLOT_FRICTION] * state_accelerations(m, m->trial)[0] * h;
    } else if (w == EVENT_OF_FORCE) {
        // the force: that of the parabola through both ends that has the mean force
        double rise = trial[SLOT_FORCE] - state[SLOT_FORCE];
        double curve = 3 * (state[SLOT_FORCE] + trial[SLOT_FORCE]) - 6 * mean_force(m, h);
        *d0 = rise - curve;
        *d1 = rise + curve;
    }
    return w != EVENT_OF_STICTION;
}

// Hermite's cubic with end values v0, v1 and end slopes d0, d1, at s in (0, 1).
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
    // without slopes: near the limit of friction the middle of the step is checked
    double d0, d1;
    if (!event_slopes(m, h, w, &d0, &d1)) {
        if (fmin(v0, v1) < 0.2 * a->motor.stiction) {
            return 0.5;
        }
        return -1;
    }

    // the least value of the cubic, if it comes near zero; a dip right at the start is
    // the zero that the function starts from
    double s = cubic_dip(v0, v1, d0, d1);
    if (s <= 1e-6 || s >= 1) {
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
    // the root of the straight line, which is all that can be said without slopes
    double d0, d1, lo = 0, hi = 1, s = v0 / (v0 - v1), v_lo = v0, v_hi = v1;
    if (!event_slopes(m, h, w, &d0, &d1)) {
        return s;
    }

    // false position; the value at the end that stays is halved, so that it moves too
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

// An instant of a step [s] and an event function's value there.
typedef struct located_value {
    double time, value;
} located_value;

// Puts the function's value at an instant within the bracket in the place of the end that
// lies on the same side of zero, and returns that end.
static located_value replace_end(bracket *b, located_value at)
{
    located_value replaced;
    if (at.value > 0) {
        replaced = (located_value){b->lo, b->v_lo};
        b->lo = at.time, b->v_lo = at.value;
    } else {
        replaced = (located_value){b->hi, b->v_hi};
        b->hi = at.time, b->v_hi = at.value;
    }
    return replaced;
}

// Where Chandrupatla's method expects the zero, as a fraction of the way from `at`, the
// bracket's end evaluated last, to its `other` end: by inverse quadratic interpolation
// through these two and the end just replaced, if that is sure to stay inside, else in
// the middle.
static double expected_zero(located_value at, located_value other, located_value replaced)
{
    const double v = at.value, v_other = other.value, v_old = replaced.value;
    const double s = at.time;
    const double xi = (s - other.time) / (replaced.time - other.time);
    const double phi = (v - v_other) / (v_old - v_other);
    if (phi * phi < xi && (1 - phi) * (1 - phi) < 1 - xi) {
        return v / (v_other - v) * v_old / (v_other - v_old) +
               (replaced.time - s) / (other.time - s) * v / (v_old - v) * v_other /
                   (v_old - v_other);
    }
    return 0.5;
}

// Narrows a bracket until it is as narrow as LOCATION_TIME; m->trial ends as the state at
// its far side. Starts at `s` and continues by Chandrupatla's method.
static status narrow_bracket(const arm *a, motion *m, event_function w, double s,
                             bracket *b)
{
    // an implicit step must not be tiny: its velocities are differences of angles,
    // divided by its length
    const double least = motion_unresolved(a, m) ? 1e-6 * m->nominal_step : LOCATION_TIME;
    const double resolution = fmax(least, LOCATION_TIME * m->state[SLOT_TIME]);

    double evaluated = -1;
    for (int i = 0; i < 200 && b->hi - b->lo > resolution; i++) {
        // the function at s, but not at an end
        s = fmin(fmax(s, b->lo + 0.5 * resolution), b->hi - 0.5 * resolution);
        TRY(motion_try_step(a, m, s, STATE_WHOLE));
        evaluated = s;

        // that is the bracket's new end
        const located_value at = {s, event_value(a, m, m->trial, w) - b->edge};
        const located_value replaced = replace_end(b, at);
        located_value other = {b->lo, b->v_lo};
        if (at.value > 0) {
            other = (located_value){b->hi, b->v_hi};
        }

        // an estimate that has settled is stepped past, so that the bracket closes on it
        const double next = s + expected_zero(at, other, replaced) * (other.time - s);
        if (fabs(next - s) < 0.5 * resolution) {
            s = s + copysign(resolution, other.time - s);
        } else {
            s = next;
        }
    }

    // the state at the far side, if it was not the last one evaluated
    if (evaluated == b->hi) {
        return STATUS_OK;
    }
    return motion_try_step(a, m, b->hi, STATE_WHOLE);
}

// Two instants of a step between which an event function may cross zero, its values there
// (v_lo, v_hi), and a guess of where it does.
typedef struct crossing_search {
    double lo, v_lo, hi, v_hi; // [s], and in the function's unit
    double guess;              // [s]
} crossing_search;

// Looks for a dip below zero of a function that is admissible at both ends of the step.
// If there is one, *crosses is true and the search ends at it; else m->trial is the
// step's end.
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

// Finds where a function that starts at zero (at a release, at a break-away) is clearly
// admissible: halves the step until it is. *closed and *v_closed get the earliest instant
// among those tried at which the function is less than `beyond`, and its value there.
static status search_admissible(const arm *a, motion *m, event_function w, double beyond,
                                crossing_search *in, double *closed, double *v_closed)
{
    double s = in->hi;
    for (int i = 0; i < 20; i++) {
        s /= 2;
        TRY(motion_try_step(a, m, s, STATE_WHOLE));
        const double v = event_value(a, m, m->trial, w);

        // the search begins here, or ends here and goes on with half of the step
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

// Where steps do not resolve an impact, it takes the first part of the step after it. An
// event found within that part is put off to the part's end: *found and m->trial move
// there.
static status put_off_to_impact_end(const arm *a, motion *m, double h, double *found)
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
    // the whole step, in which a change of sign is guessed by the slopes at its ends
    const double h = end->length, tolerance = event_tolerance(w);
    crossing_search in = {.hi = h,
                          .v_lo = event_value(a, m, m->state, w),
                          .v_hi = event_value(a, m, m->trial, w),
                          .guess = 0.5 * h};
    if (in.v_lo > 0 && in.v_hi < 0) {
        in.guess = h * guess_crossing(m, h, w, in.v_lo, in.v_hi);
    }

    // without a change of sign, to a dip if there is one
    if (in.v_hi >= -tolerance) {
        bool crosses;
        TRY(search_dip(a, m, w, &in, &crosses));
        if (!crosses) {
            return STATUS_OK;
        }
    }

    // a function that starts at zero, from where it is admissible
    const double beyond = fmin(in.v_lo, 0) - GAP_ROUNDING;
    double closed = in.hi, v_closed = in.v_hi;
    if (in.v_lo <= tolerance) {
        TRY(search_admissible(a, m, w, beyond, &in, &closed, &v_closed));
    }

    // A gap that was found open nowhere counts as closed where it is negative by more
    // than rounding. This ends flights so low that they cannot be told from rounding, as
    // after an impact that leaves hardly any force.
    double edge = 0;
    if (w == EVENT_OF_GAP && !(in.v_lo > 0) && !m->wall_gives) {
        edge = beyond;
        in.hi = closed;
        in.v_hi = v_closed;
        in.guess = 0.5 * closed;
    }

    // the crossing itself, narrowed to the width that time resolves
    end->any = true;
    end->first = w;
    bracket between = {in.lo, in.v_lo - edge, in.hi, in.v_hi - edge, edge};
    status s = narrow_bracket(a, m, w, in.guess, &between);
    end->length = between.hi;
    if (s == STATUS_OK) {
        s = put_off_to_impact_end(a, m, h, &end->length);
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
    // false position on the rate; the value at the end that stays is halved
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

// Records the forces around an instant s of the step of length h at which the force is
// about to peak: at s and at two steps beside it, again and again at the summit of the
// parabola through these three, with less and less width between them. Leaves another
// state in m->trial.
static status refine_peak(const arm *a, motion *m, double h, double s)
{
    for (double width = h / 8; width > h / 1000; width /= 16) {
        double f[3];
        s = fmin(fmax(s, width), h - width);
        for (int i = 0; i < 3; i++) {
            TRY(motion_try_step(a, m, s + (i - 1) * width, STATE_WHOLE));
            f[i] = m->trial[SLOT_FORCE];
            motion_note_force(m, m->trial[SLOT_TIME], f[i]);
        }

        // the parabola has no summit unless it bends downwards
        double second = f[0] - 2 * f[1] + f[2];
        if (second >= 0) {
            break;
        }
        double move = 0.5 * (f[0] - f[2]) / second;
        s += fmin(fmax(move, -1), 1) * width;
    }
    return STATUS_OK;
}

status locate_peak(const arm *a, motion *m, double h)
{
    // the largest depth; m->between keeps the step's end meanwhile
    memcpy(m->between, m->trial, (size_t)m->size * sizeof(double));
    if (!motion_wall_is_rigid(m)) {
        const step_point lo = {0, state_rest_gap(m->state)},
                         hi = {h, state_rest_gap(m->trial)};
        locate_deepest(a, m, lo, hi, 1e-9 * h, stepped_gap);
        memcpy(m->trial, m->between, (size_t)m->size * sizeof(double));
    }

    // the forces at both ends
    double f0 = m->state[SLOT_FORCE], f1 = m->trial[SLOT_FORCE], t0 = m->state[SLOT_TIME];
    motion_note_force(m, t0, f0);
    motion_note_force(m, t0 + h, f1);

    // the summit of the parabola through both ends that has the mean force, if it lies
    // within the step: the slope falls from `slope` to slope + 2 curve, through zero
    double curve = 3 * (f0 + f1) - 6 * mean_force(m, h), slope = f1 - f0 - curve;
    if (!(slope > 0 && slope + 2 * curve < 0)) {
        return STATUS_OK;
    }
    double s = -slope / (2 * curve) * h, top = f0 + slope * (s / h) / 2;
    if (top <= m->record.pulse_peak * (1 + 1e-12)) {
        return STATUS_OK;
    }

    // a summit higher than all forces so far is looked at closely
    TRY(refine_peak(a, m, h, s));
    memcpy(m->trial, m->between, (size_t)m->size * sizeof(double));
    return STATUS_OK;
}
