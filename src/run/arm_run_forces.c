// The steps of the corrected model in pieces that are short enough for its force to be a
// parabola: for the means of the force, and for sensors that follow it.
#include <math.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/base/sincos.h"
#include "src/run/arm_run.h"
#include "src/run/recording.h"

#define SHORTEST_MEAN 1e-9 // a step shorter than this has the mean of its ends [s]

// By how much a mean force may leave the range of the force it is the mean of: by a share
// of that range, and by the rounding of the integral, a share of its value.
#define BEYOND_RANGE    1e-6
#define INTEGRAL_DIGITS 1e-14

// The longest piece of a step, as its duration times the fastest rate of the arm [rad].
// Over a piece of FORCE_REACH a parabola is exact to 1e-4 of the fastest mode's force,
// over one of SENSOR_REACH the readings of sensors with a lag are exact to 1e-6.
#define FORCE_REACH  0.25
#define SENSOR_REACH 0.05

// If the slope at the start of a piece predicts this many times the change of the force
// that is found over the piece, the force begins with a fast decay.
#define FALLS_AT_ONCE 4

enum { MOST_PIECES = 320 }; // that sensors follow a step in

// Adds what sensors see of the beam's shape q: the tip's distance from the tangent to the
// hub, and the curvature at the root, the bend of the first joint of the beam over the
// length that it stands for.
static void add_shape(const arm *a, const double *q, sensed_motion *at)
{
    for (int k = 0; k < a->links; k++) {
        at->tip_deflection +=
            arm_link_of(a, k).length * inline_sin(q[a->first + k] - q[0]);
    }
    if (a->root_bends) {
        at->root_curvature = (q[1] - q[0]) / (arm_link_of(a, 0).length / 2);
    } else if (a->links > 1) {
        at->root_curvature = (q[a->first + 1] - q[a->first]) /
                             ((arm_link_of(a, 0).length + arm_link_of(a, 1).length) / 2);
    }
}

sensed_motion arm_run_sensed_motion(const arm_run *run, double *state)
{
    const motion *m = run->motion;
    const double *q = state_angles(m, state), *w = state_velocities(m, state);
    int first = run->arm.first, last = run->arm.dof - 1;
    const feature_set shape = HAS(TIP_DEFLECTION) | HAS(ROOT_STRAIN);
    sensed_motion at = {.time = state[SLOT_TIME],
                        .angle = q[0],
                        .velocity = w[0],
                        .acceleration = state_accelerations(m, state)[0],
                        .bending = q[last] - q[first],
                        .bending_rate = w[last] - w[first],
                        .force = state[SLOT_FORCE]};
    if ((run->arm.features & shape) != 0) {
        add_shape(&run->arm, q, &at);
    }
    return at;
}

// The force over every step so far.
static shared_array *forces_of(const arm_run *run)
{
    return &run->recording->result->history.forces;
}

// The force over the step just made: at both ends, and its mean, which is the difference
// of the motion's force integral over the length of the step.
static force_step force_over_step(const motion *m)
{
    const double *start = m->trial; // the state at the beginning of the step
    force_step whole = {.start = start[SLOT_TIME],
                        .end = m->state[SLOT_TIME],
                        .first = start[SLOT_FORCE],
                        .last = m->state[SLOT_FORCE]};

    // over a step between two stops that differ by rounding only, the difference of the
    // integral is rounding as well, and the mean of the ends is better
    const double length = whole.end - whole.start;
    if (length > SHORTEST_MEAN) {
        const double integral = state_quadratures(m, m->state)[QUADRATURE_FORCE] -
                                state_quadratures(m, m->trial)[QUADRATURE_FORCE];
        whole.mean = integral / length;
    } else {
        whole.mean = (whole.first + whole.last) / 2;
    }
    return whole;
}

// Whether the mean over the step just made lies between zero and the largest force within
// the step, of which a dense engine knows a bound.
static bool mean_is_possible(const motion *m, const force_step *force)
{
    if (!engine_is_dense(m->engine)) {
        return true;
    }
    const double total = state_quadratures(m, m->state)[QUADRATURE_FORCE];
    const double most = larger(larger(force->first, force->last), m->most_force);
    const double slack =
        BEYOND_RANGE * (1 + most) +
        INTEGRAL_DIGITS * total / larger(force->end - force->start, SHORTEST_MEAN);
    return force->mean >= -slack && force->mean <= most + slack;
}

// The largest number of pieces of a reach that a step is cut into: MOST_PIECES of the
// shortest, those for sensors.
static int most_pieces(double reach)
{
    return (int)(MOST_PIECES * SENSOR_REACH / reach);
}

// The number of equal pieces that a step of this length [s] is cut into, so that none
// goes beyond `reach`, its duration times the rate of the fastest vibration. Only dense
// engines make steps that need more than one.
static int pieces_of_step(const arm_run *run, double length, double reach)
{
    motion *m = run->motion;
    if (!engine_is_dense(m->engine)) {
        return 1;
    }

    // by the fastest vibration, but no more pieces than the parabolas that the engine
    // itself needs for its whole step, in proportion to the length
    double pieces = length * motion_vibration(&run->arm, m, m->trial) / reach;
    const double whole = state_kept(m, m->trial)[KEPT_LENGTH];
    if (m->engine->parabolas > 0 && whole > 0) {
        pieces = smaller(pieces,
                         m->engine->parabolas * FORCE_REACH / reach * (length / whole));
    }
    if (!(pieces > 1) || motion_held_still(m)) {
        return 1;
    }
    return (int)ceil(smaller(pieces, most_pieces(reach)));
}

// Whether the arm has decays that are faster than its fastest vibration; events excite
// them.
static bool decays_outrun(const arm *a)
{
    return a->fastest_decay > a->highest_frequency;
}

// Finds where the next piece ends [s] of a step that has been followed to `time` and ends
// at `end` [s], while the decay that the last event excited is faster than the arm's
// vibrations. The pieces grow as the decay dies away. False where equal pieces are enough
// for the rest of the step.
static bool next_decay_piece(const arm_run *run, double time, double end, double reach,
                             double *next)
{
    const arm *a = &run->arm;
    if (!decays_outrun(a) || !engine_is_dense(run->motion->engine) ||
        motion_held_still(run->motion)) {
        return false;
    }

    // the piece that the decay allows, and an equal piece of the rest
    const double since = time - run->recording->state.force.last_jump;
    const double length =
        larger(motion_decay_length(a, reach, since), instant_tolerance(time));
    const double vibration = motion_vibration(a, run->motion, run->motion->trial);
    const double equal = larger(reach / vibration, (end - time) / most_pieces(reach));
    *next = time + length;
    return length < equal && *next < end;
}

int arm_run_force_pieces(const arm_run *run, double length)
{
    const double now = run->motion->state[SLOT_TIME];
    double next;
    if (next_decay_piece(run, now, now + length, FORCE_REACH, &next)) {
        return 0;
    }
    return pieces_of_step(run, length, FORCE_REACH);
}

sample_point arm_run_sample_point(const arm_run *run, double *state)
{
    return (sample_point){state[SLOT_TIME], arm_run_sensed_motion(run, state),
                          state_quadratures(run->motion, state)[QUADRATURE_FORCE]};
}

// Moves the point to an instant [s] within the step. False if the state there cannot be
// computed.
static bool move_to(const arm_run *run, sample_point *point, double time)
{
    double *state = motion_between(&run->arm, run->motion, time, STATE_SENSED);
    if (state == NULL) {
        return false;
    }
    *point = arm_run_sample_point(run, state);
    return true;
}

// What is done with each piece of a step: it is recorded, or the sensors follow it.
// `mean` is the mean force over the piece [N].
typedef status (*piece_taker)(arm_run *run, const sample_point *from,
                              const sample_point *to, double mean);

// Moves the point to an instant `time` within the step and hands the piece between, which
// is `length` long [s], over to `take`.
static status take_piece(arm_run *run, sample_point *point, double time, double length,
                         piece_taker take)
{
    const sample_point from = *point;
    if (!move_to(run, point, time)) {
        return STATUS_NOT_FINITE;
    }
    return take(run, &from, point, (point->integral - from.integral) / length);
}

// Follows, piece by piece, the fast decay that an event has excited, up to where equal
// pieces are enough for the rest of the step, which ends at `end` [s].
static status follow_decay(arm_run *run, sample_point *point, double end, double reach,
                           piece_taker take)
{
    double next;
    while (next_decay_piece(run, point->time, end, reach, &next)) {
        TRY(take_piece(run, point, next, next - point->time, take));
    }
    return STATUS_OK;
}

// Whether a force begins with a decay that is over long before the end of a piece. The
// decay then shows in the slope at the start alone, which predicts a far larger change
// over the piece than the rest of the piece has; such a slope says nothing about the
// mean.
static bool falls_at_once(value_and_slope first, value_and_slope last, double width)
{
    const double predicted_change = fabs(first.slope) * width;
    const double found_change = fabs(last.value - first.value) + fabs(last.slope) * width;
    return predicted_change > FALLS_AT_ONCE * found_change;
}

// Cuts the force over `rest`, the part of the step just made that is still to be
// recorded, into `count` equal pieces. Each gets the mean of the cubic that has the
// values and slopes of the force at its ends: (f0 + f1) / 2 + (f0' - f1') width / 12.
// That mean is wrong where the step begins with a decay that is over at once; the first
// piece then gets its mean from the motion's own integral, which is `integral_before` [N
// s] at its start.
static status cut_equally(const arm_run *run, const force_step *rest,
                          double integral_before, int count, force_step *pieces)
{
    motion *m = run->motion;
    value_and_slope at[MOST_PIECES + 1];

    // the force at the start and at the ends of all pieces
    const double since = rest->start - m->trial[SLOT_TIME],
                 width = (m->step.last - since) / count;
    m->engine->dense_output(&run->arm, m, OUTPUT_FORCE, since, m->step.last, count, at);

    // each piece with the mean of its cubic
    const double slope_share = width / 12;
    double start = rest->start;
    value_and_slope first = at[0];
    for (int i = 0; i < count; i++) {
        const value_and_slope last = at[i + 1];
        const double end = rest->start + (i + 1) * width;
        const double mean =
            (first.value + last.value) / 2 + slope_share * (first.slope - last.slope);
        pieces[i] = (force_step){start, end, first.value, last.value, mean};
        start = end;
        first = last;
    }
    pieces[count - 1].end = rest->end;

    // the first one by the motion's integral, if it begins with a decay
    if (falls_at_once(at[0], at[1], width)) {
        sample_point end;
        if (!move_to(run, &end, pieces[0].end)) {
            return STATUS_NOT_FINITE;
        }
        pieces[0].mean = (end.integral - integral_before) / width;
    }
    return STATUS_OK;
}

// Adds the force over `count` equal pieces of the rest of the step just made to the
// history of forces.
static status record_equal_pieces(arm_run *run, const force_step *rest,
                                  double integral_before, int count)
{
    force_step *pieces = force_history_extend(forces_of(run), (size_t)count);
    if (pieces == NULL) {
        return STATUS_NO_MEMORY;
    }
    return cut_equally(run, rest, integral_before, count, pieces);
}

// Adds the force over a piece of the step to the history of forces.
static status record_piece(arm_run *run, const sample_point *from, const sample_point *to,
                           double mean)
{
    const force_step piece = {from->time, to->time, from->at.force, to->at.force, mean};
    return force_history_add(forces_of(run), piece);
}

// Adds the force over the step just made to the history of forces, in pieces over which
// it is nearly a parabola: `pieces` equal ones, but short ones first where a fast decay
// is under way.
static status record_force(arm_run *run, const force_step *whole, int pieces)
{
    const motion *m = run->motion;
    if (m->trial[SLOT_CONTACT] == 0) {
        return force_history_add(forces_of(run), *whole);
    }

    // the short pieces of a fast decay, and what is then left of the step
    force_step rest = *whole;
    double integral_before = state_quadratures(m, m->trial)[QUADRATURE_FORCE];
    if (decays_outrun(&run->arm)) {
        sample_point point = arm_run_sample_point(run, m->trial);
        TRY(follow_decay(run, &point, whole->end, FORCE_REACH, record_piece));
        rest.start = point.time;
        rest.first = point.at.force;
        integral_before = point.integral;
    }

    // the rest in equal pieces
    if (rest.start > whole->start) {
        const double length = whole->end - rest.start;
        pieces = pieces_of_step(run, length, FORCE_REACH);
        const double integral = state_quadratures(m, m->state)[QUADRATURE_FORCE];
        rest.mean = (integral - integral_before) / length;
    }
    if (pieces > 1) {
        return record_equal_pieces(run, &rest, integral_before, pieces);
    }
    return force_history_add(forces_of(run), rest);
}

// --- sensors ---------------------------------------------------------------------------

// Lets the sensors follow the arm over a piece of the step.
static status sense(arm_run *run, const sample_point *from, const sample_point *to,
                    double mean)
{
    sensors_follow(&run->recording->rig->sensors, to->time - from->time, &from->at,
                   &to->at, mean);
    return STATUS_OK;
}

// Lets sensors that read nothing but the force follow it in `count` equal pieces from a
// point to `last`. The pieces come from the engine's force alone, without a state at
// each, which is faster.
static status follow_force(arm_run *run, const sample_point *from,
                           const sample_point *last, int count)
{
    const force_step rest = {from->time, last->time, from->at.force, last->at.force, 0};
    force_step pieces[MOST_PIECES];
    TRY(cut_equally(run, &rest, from->integral, count, pieces));
    for (int i = 0; i < count; i++) {
        const force_step *piece = &pieces[i];
        const sensed_motion first = {.force = piece->first}, end = {.force = piece->last};
        sensors_follow(&run->recording->rig->sensors, piece->end - piece->start, &first,
                       &end, piece->mean);
    }
    return STATUS_OK;
}

// Lets the sensors follow the arm from a point to `last`, between which the force has
// that mean [N], in pieces that are short enough for them.
static status follow_to(arm_run *run, sample_point point, const sample_point *last,
                        double mean)
{
    // sensors of the force alone have nothing to follow in flight
    const sensor_parameters *fitted = &run->recording->rig->sensors.p;
    const bool force_only = !fitted->film && !fitted->accelerometer;
    if (force_only && run->motion->trial[SLOT_CONTACT] == 0) {
        return sense(run, &point, last, mean);
    }

    // the short pieces of a fast decay
    const double begin = point.time;
    TRY(follow_decay(run, &point, last->time, SENSOR_REACH, sense));

    // all but the last of the equal pieces of the rest
    const double start = point.time, length = last->time - start;
    const int pieces = pieces_of_step(run, length, SENSOR_REACH);
    if (force_only && pieces > 1) {
        return follow_force(run, &point, last, pieces);
    }
    for (int i = 1; i < pieces; i++) {
        TRY(take_piece(run, &point, start + length * i / pieces, length / pieces, sense));
    }

    // the last piece, which has the given mean if it is the only one
    if (point.time > begin) {
        mean = (last->integral - point.integral) / (length / pieces);
    }
    return sense(run, &point, last, mean);
}

status arm_run_follow_flight(arm_run *run, const sample_point *to)
{
    if (sensors_at_rest(&run->recording->rig->sensors)) {
        return STATUS_OK;
    }
    return follow_to(run, run->under_way.followed, to, 0);
}

// Lets the sensors follow the arm over the step just made, `whole` being its force. In
// flight, sensors at rest stay at rest.
static status follow_with_sensors(arm_run *run, const force_step *whole)
{
    const motion *m = run->motion;
    const bool pressed = whole->first != 0 || whole->last != 0 || whole->mean != 0;
    if (!pressed && sensors_at_rest(&run->recording->rig->sensors)) {
        return STATUS_OK;
    }

    // a step in flight that outlasts samples has been followed up to the last one
    const sample_point last = arm_run_sample_point(run, m->state);
    if (run->under_way.exists && run->under_way.followed.time > whole->start) {
        return follow_to(run, run->under_way.followed, &last, 0);
    }
    return follow_to(run, arm_run_sample_point(run, m->trial), &last, whole->mean);
}

// --- bounds of a force that is not determined ------------------------------------------

// The weight of point i of Simpson's rule over an even number of intervals, in thirds of
// an interval's length: 1, 4, 2, 4, ..., 2, 4, 1.
static int simpson_weight(int i, int intervals)
{
    if (i == 0 || i == intervals) {
        return 1;
    }
    if (i % 2 != 0) {
        return 4;
    }
    return 2;
}

// The state at the end of interval i of the step just made, which is cut into equal
// intervals; i = 0 is the start of the step. NULL if the state cannot be computed.
static double *state_at(const arm_run *run, int i, int intervals)
{
    motion *m = run->motion;
    if (i == 0) {
        return m->trial;
    }
    if (i == intervals) {
        return m->state;
    }
    const double start = m->trial[SLOT_TIME], length = m->state[SLOT_TIME] - start;
    return motion_between(&run->arm, m, start + i * length / intervals, STATE_WHOLE);
}

// Integrates the bounds of the force over the step just made by Simpson's rule, and notes
// the largest, where the force is not determined: where friction and a rigid wall
// together hold a single link.
static status follow_bounds(arm_run *run, const force_step *whole)
{
    motion *m = run->motion;
    force_record *record = &run->recording->state.force;
    const bool single = m->dof == 1 && motion_wall_is_rigid(m);
    if (!single || motion_force_bounds(&run->arm, m, m->trial).high == 0) {
        return STATUS_OK;
    }

    // the rule's points, at pieces that are four times as fine as those of the force
    const double length = whole->end - whole->start;
    const int intervals = 2 * pieces_of_step(run, length, FORCE_REACH / 4);
    for (int i = 0; i <= intervals; i++) {
        double *state = state_at(run, i, intervals);
        if (state == NULL) {
            return STATUS_NOT_FINITE;
        }

        // the integrals, and the largest so far
        const double share = simpson_weight(i, intervals) * length / (3 * intervals);
        const force_bounds at = motion_force_bounds(&run->arm, m, state);
        record->in_window.low += share * at.low;
        record->in_window.high += share * at.high;
        record->largest.low = larger(at.low, record->largest.low);
        record->largest.high = larger(at.high, record->largest.high);
    }
    return STATUS_OK;
}

void arm_run_begin_window(arm_run *run)
{
    const motion *m = run->motion;
    force_record *record = &run->recording->state.force;
    record->integral_at_window = state_quadratures(m, m->state)[QUADRATURE_FORCE];
    record->in_window = (force_bounds){0};
}

void arm_run_begin_bounds(arm_run *run)
{
    run->recording->state.force.largest = (force_bounds){0};
}

void arm_run_write_bounds(force_bounds bounds, double *low, double *high)
{
    if (bounds.high > bounds.low) {
        *low = bounds.low;
        *high = bounds.high;
    }
}

// --- a step ----------------------------------------------------------------------------

void arm_run_note_jump(arm_run *run)
{
    run->recording->state.force.last_jump = run->motion->state[SLOT_TIME];
}

status arm_run_record_forces(arm_run *run)
{
    const motion *m = run->motion;
    const force_step force = force_over_step(m);
    if (!mean_is_possible(m, &force)) {
        return STATUS_IMPOSSIBLE_MEAN;
    }

    // a force that acts is kept in pieces
    int pieces = 0;
    if (m->trial[SLOT_CONTACT] != 0) {
        pieces = pieces_of_step(run, m->step.last, FORCE_REACH);
    }
    const bool one_piece = pieces == 1 && !decays_outrun(&run->arm);

    // sensors, bounds and the record
    if (run->recording->rig != NULL) {
        TRY(follow_with_sensors(run, &force));
    }
    if (!(force.end > force.start)) {
        return STATUS_OK;
    }
    TRY(follow_bounds(run, &force));
    if (one_piece) {
        return force_history_add(forces_of(run), force);
    }
    return record_force(run, &force, pieces);
}
