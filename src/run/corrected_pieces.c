// The steps of the corrected model in pieces that are short enough for its force to be a
// parabola: for the means of the force, and for sensors that follow it.
#include <math.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/run/corrected.h"
#include "src/run/recording.h"

#define SHORTEST_MEAN 1e-9 // a step shorter than this has the mean of its ends [s]

// By how much a mean may leave the range of its force: a share of it, and of the integral
// so far.
#define BEYOND_RANGE    1e-6
#define INTEGRAL_DIGITS 1e-14

// Largest (fastest rate) x (time) of a piece: over it a parabola is exact to 1e-4 of the
// fastest mode's force, and to 1e-6 for sensors with a lag.
#define FORCE_REACH  0.25
#define SENSOR_REACH 0.05

// A slope at the start that predicts this many times the change found over a piece
// belongs to a decay.
#define FALLS_AT_ONCE 4

enum { MOST_PIECES = 320 }; // that sensors follow a step in

sensed_motion corrected_sensed_motion(const corrected_run *c, double *state)
{
    const motion *m = c->motion;
    const double *q = state_angles(m, state), *w = state_velocities(m, state);
    int first = c->arm.first, last = c->arm.dof - 1;
    return (sensed_motion){.angle = q[0],
                           .velocity = w[0],
                           .acceleration = state_accelerations(m, state)[0],
                           .bending = q[last] - q[first],
                           .bending_rate = w[last] - w[first],
                           .force = state[SLOT_FORCE]};
}

static shared_array *forces_of(const corrected_run *c)
{
    return &c->recording->result->history.forces;
}

// The force over the step just made.
static force_step force_over_step(const motion *m)
{
    const double *start = m->trial; // where the step left its beginning
    double length = m->state[SLOT_TIME] - start[SLOT_TIME];
    double integral = state_quadratures(m, m->state)[QUADRATURE_FORCE] -
                      state_quadratures(m, m->trial)[QUADRATURE_FORCE];

    // between stops that differ by rounding only, the integral's difference is all
    // rounding
    double ends = (start[SLOT_FORCE] + m->state[SLOT_FORCE]) / 2;
    return (force_step){start[SLOT_TIME], m->state[SLOT_TIME], start[SLOT_FORCE],
                        m->state[SLOT_FORCE],
                        length > SHORTEST_MEAN ? integral / length : ends};
}

// Whether the mean over the step just made lies within what the force is in it: from zero
// to the bound that a dense engine has of it.
static bool mean_is_possible(const motion *m, const force_step *force)
{
    const double total = state_quadratures(m, m->state)[QUADRATURE_FORCE];
    const double most = larger(larger(force->first, force->last), m->most_force);
    const double slack =
        BEYOND_RANGE * (1 + most) +
        INTEGRAL_DIGITS * total / larger(force->end - force->start, SHORTEST_MEAN);
    return !engine_is_dense(m->engine) ||
           (force->mean >= -slack && force->mean <= most + slack);
}

// How many pieces of that reach a step has at most.
static int most_pieces(double reach)
{
    return (int)(MOST_PIECES * SENSOR_REACH / reach);
}

// Number of pieces for a step of large (fastest rate) x (length), so that a parabola is
// accurate in each. Only dense engines make such steps.
static int pieces_of_step(const corrected_run *c, double length, double reach)
{
    motion *m = c->motion;
    if (!engine_is_dense(m->engine)) {
        return 1;
    }
    double pieces = length * motion_vibration(&c->arm, m, m->trial) / reach;
    const double whole = state_kept(m, m->trial)[KEPT_LENGTH];
    if (m->engine->parabolas > 0 && whole > 0) { // it follows nothing that is faster
        pieces = smaller(pieces,
                         m->engine->parabolas * FORCE_REACH / reach * (length / whole));
    }
    if (!(pieces > 1) || motion_held_still(m)) {
        return 1;
    }
    return (int)ceil(smaller(pieces, most_pieces(reach)));
}

// Whether the decays that an event excites are faster than the arm's vibrations.
static bool decays_outrun(const arm *a)
{
    return a->fastest_decay > a->highest_frequency;
}

// Where the next piece of a step ends that goes from `time` to `end` and is taken in
// parabolas [s], as long as what the last event set going decays faster than the arm
// vibrates. False where equal pieces do for the rest.
static bool next_decay_piece(const corrected_run *c, double time, double end,
                             double reach, double *next)
{
    const arm *a = &c->arm;
    if (!decays_outrun(a) || !engine_is_dense(c->motion->engine) ||
        motion_held_still(c->motion)) {
        return false;
    }
    const double since = time - c->recording->state.last_jump;
    const double length =
        larger(motion_decay_length(a, reach, since), instant_tolerance(time));
    const double vibration = motion_vibration(a, c->motion, c->motion->trial);
    const double equal = larger(reach / vibration, (end - time) / most_pieces(reach));
    *next = time + length;
    return length < equal && *next < end;
}

int corrected_force_pieces(const corrected_run *c, double length)
{
    const double now = c->motion->state[SLOT_TIME];
    double next;
    if (next_decay_piece(c, now, now + length, FORCE_REACH, &next)) {
        return 0;
    }
    return pieces_of_step(c, length, FORCE_REACH);
}

sample_point corrected_sample_point_at(const corrected_run *c, double *state)
{
    return (sample_point){state[SLOT_TIME], corrected_sensed_motion(c, state),
                          state_quadratures(c->motion, state)[QUADRATURE_FORCE]};
}

// Continues to an instant within the step. False if the state there cannot be had.
static bool go_to(const corrected_run *c, sample_point *w, double time)
{
    motion *m = c->motion;
    double *state = motion_between(&c->arm, m, time, STATE_SENSED);
    if (state != NULL) {
        *w = corrected_sample_point_at(c, state);
    }
    return state != NULL;
}

// Takes a piece of the step just made, over which the force has that mean [N].
typedef status (*piece_taker)(corrected_run *c, const sample_point *from,
                              const sample_point *to, double mean);

// Continues to an instant within the step, a stretch of this length [s], and hands it
// over.
static status take_piece(corrected_run *c, sample_point *w, double time, double length,
                         piece_taker take)
{
    const sample_point from = *w;
    if (go_to(c, w, time)) {
        return take(c, &from, w, (w->integral - from.integral) / length);
    }
    return STATUS_NOT_FINITE;
}

// Follows, piece by piece, the fast decay that an event has excited, up to where equal
// pieces are enough for the rest of the step, which ends at `end` [s].
static status follow_decay(corrected_run *c, sample_point *w, double end, double reach,
                           piece_taker take)
{
    double next;
    while (next_decay_piece(c, w->time, end, reach, &next)) {
        TRY(take_piece(c, w, next, next - w->time, take));
    }
    return STATUS_OK;
}

// Whether a force begins with a decay that is over at once: it shows in the slope at the
// start only, which then says nothing about the mean.
static bool falls_at_once(value_and_slope first, value_and_slope last, double width)
{
    const double shown = fabs(last.value - first.value) + fabs(last.slope) * width;
    return fabs(first.slope) * width > FALLS_AT_ONCE * shown;
}

// Cuts the force over the rest of the step just made into equal pieces, `before` being
// its integral up to there: each has the mean of the cubic through both ends' values and
// slopes. A step may begin with a decay that is over at once, which only the motion's own
// integral knows.
static status cut_equally(const corrected_run *c, const force_step *rest, double before,
                          int count, force_step *kept)
{
    motion *m = c->motion;
    value_and_slope at[MOST_PIECES + 1];

    // the force at the start and at the ends of all pieces
    const double since = rest->start - m->trial[SLOT_TIME],
                 width = (m->step.last - since) / count;
    m->engine->dense_output(&c->arm, m, OUTPUT_FORCE, since, m->step.last, count, at);

    const double slope_share = width / 12;
    double start = rest->start;
    value_and_slope first = at[0];
    for (int i = 0; i < count; i++) {
        const value_and_slope last = at[i + 1];
        const double end = rest->start + (i + 1) * width;
        const double mean =
            (first.value + last.value) / 2 + slope_share * (first.slope - last.slope);
        kept[i] = (force_step){start, end, first.value, last.value, mean};
        start = end;
        first = last;
    }
    kept[count - 1].end = rest->end;

    if (falls_at_once(at[0], at[1], width)) {
        sample_point w;
        if (!go_to(c, &w, kept[0].end)) {
            return STATUS_NOT_FINITE;
        }
        kept[0].mean = (w.integral - before) / width;
    }
    return STATUS_OK;
}

// Keeps the force over equal pieces of the rest of the step just made.
static status record_equal_pieces(corrected_run *c, const force_step *rest, double before,
                                  int count)
{
    force_step *kept = force_history_extend(forces_of(c), (size_t)count);
    if (kept == NULL) {
        return STATUS_NO_MEMORY;
    }
    return cut_equally(c, rest, before, count, kept);
}

// Keeps the force over a piece of the step.
static status keep_force(corrected_run *c, const sample_point *from,
                         const sample_point *to, double mean)
{
    const force_step piece = {from->time, to->time, from->at.force, to->at.force, mean};
    return force_history_add(forces_of(c), piece);
}

// Keeps the force over the step just made, in pieces over which it is nearly a parabola:
// so many where nothing decays.
static status record_force(corrected_run *c, const force_step *whole, int pieces)
{
    const motion *m = c->motion;
    if (m->trial[SLOT_CONTACT] == 0) {
        return force_history_add(forces_of(c), *whole);
    }

    // what an event set going and decays at once, its integral being that of the motion
    force_step rest = *whole;
    double before = state_quadratures(m, m->trial)[QUADRATURE_FORCE];
    if (decays_outrun(&c->arm)) {
        sample_point w = corrected_sample_point_at(c, m->trial);
        TRY(follow_decay(c, &w, whole->end, FORCE_REACH, keep_force));
        rest.start = w.time;
        rest.first = w.at.force;
        before = w.integral;
    }

    // what vibrates
    if (rest.start > whole->start) {
        const double length = whole->end - rest.start;
        pieces = pieces_of_step(c, length, FORCE_REACH);
        rest.mean = (state_quadratures(m, m->state)[QUADRATURE_FORCE] - before) / length;
    }
    if (pieces > 1) {
        return record_equal_pieces(c, &rest, before, pieces);
    }
    return force_history_add(forces_of(c), rest);
}

// Lets the sensors follow the arm over a piece of the step.
static status sense(corrected_run *c, const sample_point *from, const sample_point *to,
                    double mean)
{
    sensors_follow(&c->recording->rig->sensors, to->time - from->time, &from->at, &to->at,
                   mean);
    return STATUS_OK;
}

// Lets sensors of nothing but the force follow it over equal pieces of the rest of the
// step.
static status follow_force(corrected_run *c, const sample_point *w,
                           const sample_point *last, int count)
{
    const force_step rest = {w->time, last->time, w->at.force, last->at.force, 0};
    force_step cut[MOST_PIECES];
    TRY(cut_equally(c, &rest, w->integral, count, cut));
    for (int i = 0; i < count; i++) {
        const sensed_motion first = {.force = cut[i].first}, end = {.force = cut[i].last};
        sensors_follow(&c->recording->rig->sensors, cut[i].end - cut[i].start, &first,
                       &end, cut[i].mean);
    }
    return STATUS_OK;
}

// Lets the sensors follow the arm from where w is to `last`, the force having that mean
// [N].
static status follow_to(corrected_run *c, sample_point w, const sample_point *last,
                        double mean)
{
    const sensor_parameters *fitted = &c->recording->rig->sensors.p;
    const bool force_only = !fitted->film && !fitted->accelerometer;
    if (force_only && c->motion->trial[SLOT_CONTACT] == 0) {
        return sense(c, &w, last, mean);
    }

    // what an event set going
    const double begin = w.time;
    TRY(follow_decay(c, &w, last->time, SENSOR_REACH, sense));

    // the rest from piece to piece
    const double start = w.time, length = last->time - start;
    const int pieces = pieces_of_step(c, length, SENSOR_REACH);
    if (force_only && pieces > 1) {
        return follow_force(c, &w, last, pieces);
    }
    for (int i = 1; i < pieces; i++) {
        TRY(take_piece(c, &w, start + length * i / pieces, length / pieces, sense));
    }

    // the last piece ends where the way does
    const bool part = w.time > begin;
    return sense(c, &w, last,
                 part ? (last->integral - w.integral) / (length / pieces) : mean);
}

status corrected_follow_flight(corrected_run *c, const sample_point *to)
{
    sample_point *sensed = &c->stretch.open.sensed;
    const bool rest = sensors_at_rest(&c->recording->rig->sensors);
    status s = STATUS_OK;
    if (!rest) {
        s = follow_to(c, *sensed, to, 0);
    }
    *sensed = *to;
    return s;
}

// Lets the sensors follow the arm over the step just made, or over what is left of it.
static status follow_with_sensors(corrected_run *c, const force_step *whole)
{
    const motion *m = c->motion;
    sensors *felt = &c->recording->rig->sensors;
    const open_step *on = &c->stretch.open;
    const bool rest = on->goes_on && on->sensed.time > whole->start;
    const bool pressed = whole->first != 0 || whole->last != 0 || whole->mean != 0;
    if (!pressed && sensors_at_rest(felt)) {
        return STATUS_OK;
    }
    const sample_point first = rest ? on->sensed : corrected_sample_point_at(c, m->trial);
    const sample_point last = corrected_sample_point_at(c, m->state);
    return follow_to(c, first, &last, rest ? 0 : whole->mean);
}

// Follows the bounds of a force that is not determined, over the step just made:
// Simpson's rule over its pieces.
static status follow_bounds(corrected_run *c, const force_step *whole)
{
    motion *m = c->motion;
    recording_state *r = &c->recording->state;
    const bool single = m->dof == 1 && motion_wall_is_rigid(m);
    if (!single || motion_force_bounds(&c->arm, m, m->trial).high == 0) {
        return STATUS_OK;
    }
    const double length = whole->end - whole->start;
    const int halves = 2 * pieces_of_step(c, length, FORCE_REACH / 4);
    for (int i = 0; i <= halves; i++) {
        const bool inner = i > 0 && i < halves;
        const double share = (inner ? i % 2 != 0 ? 4 : 2 : 1) * length / (3 * halves);
        double *state;
        if (inner) {
            state = motion_between(&c->arm, m, whole->start + i * length / halves,
                                   STATE_WHOLE);
        } else if (i == 0) {
            state = m->trial;
        } else {
            state = m->state;
        }
        if (state == NULL) {
            return STATUS_NOT_FINITE;
        }
        const force_bounds at = motion_force_bounds(&c->arm, m, state);
        r->in_window.low += share * at.low;
        r->in_window.high += share * at.high;
        r->largest.low = larger(at.low, r->largest.low);
        r->largest.high = larger(at.high, r->largest.high);
    }
    return STATUS_OK;
}

status corrected_record_forces(corrected_run *c)
{
    const force_step force = force_over_step(c->motion);
    if (!mean_is_possible(c->motion, &force)) {
        return STATUS_IMPOSSIBLE_MEAN;
    }

    const bool touches = c->motion->trial[SLOT_CONTACT] != 0;
    const int pieces = touches ? pieces_of_step(c, c->motion->step.last, FORCE_REACH) : 0;
    const bool one_piece = pieces == 1 && !decays_outrun(&c->arm);
    if (c->recording->rig != NULL) {
        TRY(follow_with_sensors(c, &force));
    }
    if (!(force.end > force.start)) {
        return STATUS_OK;
    }
    TRY(follow_bounds(c, &force));
    if (one_piece) {
        return force_history_add(forces_of(c), force);
    }
    return record_force(c, &force, pieces);
}
