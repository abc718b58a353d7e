#include "src/run/corrected_rows.h"

#include <math.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/run/flight.h"
#include "src/run/rig_recording.h"

#define SHORTEST_MEAN  1e-9 // a step shorter than this has the mean of its ends [s]
#define TINY_ENERGY    1e-9 // below it nothing is called unstable [J]
#define TINY_TURN      1e-2 // nor below what the motor does in this turn [rad]
#define WRONG_ENERGY   0.1  // share of the energy turned over that may not be unaccounted for
#define GRID_TOLERANCE 1e-9 // of a step: a row of the grid so near a step's end lies at it

// A parabola is right to 1e-4 of the fastest mode's force, and of what sensors with a lag see of it
// to 1e-5, over so much of (fastest rate) x (time).
#define FORCE_REACH  0.25
#define SENSOR_REACH 0.5

// A slope that promises so many times what a piece shows otherwise is that of a decay.
#define FALLS_AT_ONCE 4

enum { MOST_PIECES = 64 };

// corrected_audit for a state that holds that energy.
static inline status audit(corrected_run *c, state_energy has)
{
    const motion *m = c->motion;
    summary *s = &c->recording->result->summary;
    const double held = motion_wall_energy(&c->arm, m, m->state);
    double residual = motion_unaccounted(m, m->state, has.kinetic + has.strain + held);
    s->energy_residual_J = larger(fabs(residual), s->energy_residual_J);

    double turned_over = fabs(motion_motor_work(m, m->state)) + fabs(m->state[SLOT_EXTERNAL_WORK]) +
                         m->start_energy + fabs(c->arm.motor.torque) * TINY_TURN + TINY_ENERGY;
    // steps that do not resolve the fastest modes damp them: there energy may vanish, not appear
    double wrong = motion_unresolved(&c->arm, m) ? residual : fabs(residual);
    if (!isfinite(residual) || !isfinite(turned_over)) {
        return STATUS_NOT_FINITE;
    }
    return wrong > WRONG_ENERGY * turned_over ? STATUS_UNSTABLE : STATUS_OK;
}

status corrected_audit(corrected_run *c)
{
    return audit(c, motion_energy(&c->arm, c->motion, c->motion->state));
}

// The row of a state that holds that energy.
static sample row_of(const corrected_run *c, double *state, state_energy has, double impulse)
{
    const arm *a = &c->arm;
    const motion *m = c->motion;

    // the state's parts, and the links that the signals name
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    double *al = state_accelerations(m, state), *quadrature = state_quadratures(m, state);
    const bool rigid = motion_wall_is_rigid(m);
    const double held = motion_wall_energy(a, m, state);
    int first = a->first, last = a->dof - 1;
    sample row = {
        // every signal of the table that the corrected model has
        .time = state[SLOT_TIME],
        .hub_angle = q[0],
        .first_angle = q[first],
        .last_angle = q[last],
        .hub_velocity = w[0],
        .first_velocity = w[first],
        .last_velocity = w[last],
        .hub_acceleration = al[0],
        .first_acceleration = al[first],
        .last_acceleration = al[last],
        .gap = state_rest_gap(state),
        .gap_velocity = state_rest_gap_velocity(state),
        .force = state[SLOT_FORCE],
        .impulse = impulse,
        .contact = state[SLOT_CONTACT],
        .sticking = state[SLOT_FRICTION] == HUB_STICK,
        .voltage = a->motor.voltage,
        .motor_torque = a->motor.torque + state[SLOT_MOTOR_TORQUE],
        .friction_torque = state[SLOT_FRICTION_TORQUE],
        .kinetic_energy = has.kinetic,
        .strain_energy = has.strain,
        .motor_work = motion_motor_work(m, state),
        .external_work = state[SLOT_EXTERNAL_WORK],
        .viscous_loss = quadrature[QUADRATURE_VISCOUS],
        .friction_loss = state[SLOT_FRICTION_LOSS],
        .damping_loss = quadrature[QUADRATURE_DAMPING],
        .impact_loss = state[SLOT_IMPACT_LOSS],
        .energy_residual = motion_unaccounted(m, state, has.kinetic + has.strain + held),
        .wall_energy = rigid ? (double)NAN : held,
        .wall_loss = rigid ? (double)NAN : quadrature[QUADRATURE_WALL],
        .face_depth = m->wall_has_face ? state[SLOT_FACE] : (double)NAN,
    };

    recording_add_rig_signals(c->recording, &row);
    return row;
}

sample corrected_row(const corrected_run *c, double *state, double impulse)
{
    return row_of(c, state, motion_energy(&c->arm, c->motion, state), impulse);
}

static status record_row_of(corrected_run *c, double *state, state_energy has, double impulse)
{
    const motion *m = c->motion;
    const sample row = row_of(c, state, has, impulse);
    return recording_add_row(c->recording, &row, state_angles(m, state),
                             state_velocities(m, state));
}

status corrected_record_row(corrected_run *c, double *state, double impulse)
{
    if (!c->recording->options->keep_trace) {
        return STATUS_OK;
    }
    const state_energy has = motion_energy(&c->arm, c->motion, state);
    return record_row_of(c, state, has, impulse);
}

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

// Records rows within the step just made, stepped to again from its start: side by side if the
// engine can do that.
static status record_within(corrected_run *c, const double *times, int count)
{
    recording *r = c->recording;
    motion *m = c->motion;
    state_energy has[MOTION_TOGETHER];
    const bool together = count > 1 && motion_between_all(&c->arm, m, times, count, has);
    status failed = STATUS_OK;
    for (int i = 0; i < count && failed == STATUS_OK; i++) {
        if (together) {
            failed = record_row_of(c, m->between + i * m->size, has[i], 0);
        } else {
            double *state = motion_between(&c->arm, m, times[i]);
            failed = state ? corrected_record_row(c, state, 0) : STATUS_NOT_FINITE;
        }
        failed = failed == STATUS_OK && recording_asked_to_stop(r) ? STATUS_STOPPED : failed;
    }
    return failed;
}

// Records the rows of the grid that lie within the step just made, and passes over one at its end
// if an event is there.
static status record_grid(corrected_run *c, bool at_event)
{
    recording *r = c->recording;
    motion *m = c->motion;
    const double interval = r->scenario->parameters.method.step, now = m->state[SLOT_TIME];
    const double end = GRID_TOLERANCE * interval;
    status failed = STATUS_OK;

    // those within it, some at a time
    double time = (double)r->state.grid_row * interval;
    while (failed == STATUS_OK && time < now - end) {
        double times[MOTION_TOGETHER];
        int count = 0;
        for (; count < MOTION_TOGETHER && time < now - end; count++) {
            times[count] = time;
            time = (double)++r->state.grid_row * interval;
        }
        failed = record_within(c, times, count);
    }

    // one at its end; an event records its own rows
    if (failed == STATUS_OK && time <= now + end) {
        r->state.grid_row++;
        failed = at_event ? STATUS_OK : corrected_record_row(c, m->state, 0);
        failed = failed == STATUS_OK && recording_asked_to_stop(r) ? STATUS_STOPPED : failed;
    }
    return failed;
}

// The force over the step just made.
static force_step force_over_step(const motion *m)
{
    const double *start = m->trial; // where the step left its beginning
    double length = m->state[SLOT_TIME] - start[SLOT_TIME];
    double integral = state_quadratures(m, m->state)[QUADRATURE_FORCE] -
                      state_quadratures(m, m->trial)[QUADRATURE_FORCE];

    // between stops that differ by rounding only, the integral's difference is all rounding
    double ends = (start[SLOT_FORCE] + m->state[SLOT_FORCE]) / 2;
    return (force_step){.start = start[SLOT_TIME],
                        .end = m->state[SLOT_TIME],
                        .first = start[SLOT_FORCE],
                        .last = m->state[SLOT_FORCE],
                        .mean = length > SHORTEST_MEAN ? integral / length : ends};
}

// In how many pieces a step that goes far in (fastest rate) x (length) is taken where parabolas
// have to do for what happens within it. Only a dense engine goes so far.
static int pieces_of_step(const corrected_run *c, double length, double reach)
{
    motion *m = c->motion;
    if (!engine_is_dense(m->engine) || motion_held_still(m)) {
        return 1;
    }
    const double pieces = length * motion_vibration(&c->arm, m, m->trial) / reach;
    if (!(pieces > 1)) {
        return 1;
    }
    const int whole = pieces < MOST_PIECES ? (int)pieces : MOST_PIECES;
    return whole < MOST_PIECES ? whole + (whole < pieces) : MOST_PIECES;
}

// Whether what an event sets going decays faster than the arm vibrates.
static bool decays_outrun(const arm *a)
{
    return a->fastest_decay > a->highest_frequency;
}

// Where the next piece of a step ends that goes from `time` to `end` and is taken in parabolas [s],
// as long as what the last event set going decays faster than the arm vibrates. False where equal
// pieces do for the rest.
static bool next_decay_piece(const corrected_run *c, double time, double end, double reach,
                             double *next)
{
    const arm *a = &c->arm;
    if (!decays_outrun(a) || !engine_is_dense(c->motion->engine) || motion_held_still(c->motion)) {
        return false;
    }
    const double since = time - c->recording->state.last_jump;
    const double length = larger(motion_decay_length(a, reach, since), instant_tolerance(time));
    const double equal = larger(reach / a->highest_frequency, (end - time) / MOST_PIECES);
    *next = time + length;
    return length < equal && *next < end;
}

int corrected_force_pieces(const corrected_run *c, double length)
{
    const double now = c->motion->state[SLOT_TIME];
    double next;
    return next_decay_piece(c, now, now + length, FORCE_REACH, &next)
               ? 0
               : pieces_of_step(c, length, FORCE_REACH);
}

// A way along the step just made: where it has come, and what it has met there.
typedef struct way {
    double time; // [s]
    sensed_motion at;
    double integral; // of the force [N s]
} way;

static way way_at(const corrected_run *c, double time, double *state)
{
    return (way){time, corrected_sensed_motion(c, state),
                 state_quadratures(c->motion, state)[QUADRATURE_FORCE]};
}

// Goes on to an instant within the step. False if the state there cannot be had.
static bool go_to(const corrected_run *c, way *w, double time)
{
    double *state = motion_between(&c->arm, c->motion, time);
    if (state == NULL) {
        return false;
    }
    *w = way_at(c, time, state);
    return true;
}

// Takes a piece of the step just made, over which the force has that mean [N].
typedef status (*piece_taker)(corrected_run *c, const way *from, const way *to, double mean);

// Goes on to an instant within the step, a stretch of this length [s], and hands it over.
static status take_piece(corrected_run *c, way *w, double time, double length, piece_taker take)
{
    const way from = *w;
    return go_to(c, w, time) ? take(c, &from, w, (w->integral - from.integral) / length)
                             : STATUS_NOT_FINITE;
}

// Goes along what an event set going and decays at once, piece by piece, up to where equal pieces
// do for the rest of the step, which ends at `end` [s].
static status follow_decay(corrected_run *c, way *w, double end, double reach, piece_taker take)
{
    status s = STATUS_OK;
    double next;
    while (s == STATUS_OK && next_decay_piece(c, w->time, end, reach, &next)) {
        s = take_piece(c, w, next, next - w->time, take);
    }
    return s;
}

// Whether a force falls at once from where it begins: what is left of it shows in its slope there
// alone, which then says nothing of its mean.
static bool falls_at_once(glance first, glance last, double width)
{
    const double shown = fabs(last.value - first.value) + fabs(last.slope) * width;
    return fabs(first.slope) * width > FALLS_AT_ONCE * shown;
}

// Keeps the force over equal pieces of the rest of the step just made, `before` being its integral
// up to there: each has the mean of the cubic through both ends' values and slopes. A stride of the
// modes may begin with a decay that is over at once, which only the motion's own integral knows.
static status record_equal_pieces(corrected_run *c, const force_step *rest, double before,
                                  int count)
{
    const motion *m = c->motion;
    glance at[MOST_PIECES + 1];
    force_step *kept = recording_add_steps(c->recording, count);
    if (kept == NULL) {
        return STATUS_NO_MEMORY;
    }

    // the force at the start and at the ends of all pieces
    const double since = rest->start - m->trial[SLOT_TIME], width = (m->made - since) / count;
    if (m->engine->forces_at != NULL && since == 0) {
        m->engine->forces_at(&c->arm, m, m->made, count, at);
    } else {
        for (int i = 0; i <= count; i++) {
            at[i] = m->engine->force_at(&c->arm, m, since + i * width);
        }
    }

    const double slope_share = width / 12;
    double start = rest->start;
    glance first = at[0];
    for (int i = 0; i < count; i++) {
        const glance last = at[i + 1];
        const double end = rest->start + (i + 1) * width;
        const double mean =
            (first.value + last.value) / 2 + slope_share * (first.slope - last.slope);
        kept[i] = (force_step){
            .start = start, .end = end, .first = first.value, .last = last.value, .mean = mean};
        start = end;
        first = last;
    }
    kept[count - 1].end = rest->end;

    if (falls_at_once(at[0], at[1], width)) {
        way w;
        if (!go_to(c, &w, kept[0].end)) {
            return STATUS_NOT_FINITE;
        }
        kept[0].mean = (w.integral - before) / width;
    }
    return STATUS_OK;
}

// Keeps the force over a piece of the step.
static status keep_force(corrected_run *c, const way *from, const way *to, double mean)
{
    return recording_add_step(c->recording, (force_step){.start = from->time,
                                                         .end = to->time,
                                                         .first = from->at.force,
                                                         .last = to->at.force,
                                                         .mean = mean});
}

// Keeps the force over the step just made, in pieces that are parabolas to sight.
static status record_force(corrected_run *c, const force_step *whole)
{
    recording *r = c->recording;
    const motion *m = c->motion;
    if (m->trial[SLOT_CONTACT] == 0) {
        return recording_add_step(r, *whole);
    }

    // what an event set going and decays at once, its integral being that of the motion
    force_step rest = *whole;
    double before = state_quadratures(m, m->trial)[QUADRATURE_FORCE];
    if (decays_outrun(&c->arm)) {
        way w = way_at(c, whole->start, m->trial);
        const status s = follow_decay(c, &w, whole->end, FORCE_REACH, keep_force);
        if (s != STATUS_OK) {
            return s;
        }
        rest.start = w.time;
        rest.first = w.at.force;
        before = w.integral;
    }

    // what vibrates
    double length = m->made;
    if (rest.start > whole->start) {
        length = whole->end - rest.start;
        rest.mean = (state_quadratures(m, m->state)[QUADRATURE_FORCE] - before) / length;
    }
    const int pieces = pieces_of_step(c, length, FORCE_REACH);
    return pieces > 1 ? record_equal_pieces(c, &rest, before, pieces) : recording_add_step(r, rest);
}

// Lets the sensors follow the arm over a piece of the step.
static status sense(corrected_run *c, const way *from, const way *to, double mean)
{
    sensors_follow(&c->recording->rig->sensors, to->time - from->time, &from->at, &to->at, mean);
    return STATUS_OK;
}

// Lets the sensors follow the arm over the step just made.
static status follow_with_sensors(corrected_run *c, const force_step *whole)
{
    motion *m = c->motion;
    way w = way_at(c, whole->start, m->trial);
    status s = follow_decay(c, &w, whole->end, SENSOR_REACH, sense);

    // the rest from piece to piece
    const double start = w.time, length = whole->end - start;
    const int pieces = pieces_of_step(c, length, SENSOR_REACH);
    for (int i = 1; i < pieces && s == STATUS_OK; i++) {
        s = take_piece(c, &w, start + length * i / pieces, length / pieces, sense);
    }
    if (s != STATUS_OK) {
        return s;
    }

    // the last piece ends where the step does
    const way last = way_at(c, whole->end, m->state);
    const double mean =
        w.time > whole->start ? (last.integral - w.integral) / (length / pieces) : whole->mean;
    return sense(c, &w, &last, mean);
}

status corrected_record_step(corrected_run *c, bool at_event)
{
    recording *r = c->recording;
    motion *m = c->motion;
    const force_step force = force_over_step(m);
    const double length = force.end - force.start;

    // how far the arm has gone from the wall
    if (!isnan(r->result->summary.first_contact_s) && !r->state.separated) {
        r->state.separated = flight_separated(&c->arm, m);
    }
    r->state.energy_put_in += fabs(motion_motor_work(m, m->state) - motion_motor_work(m, m->trial));

    // an arm held still has the energy it had
    const bool known = m->reached.kinetic >= 0;
    status s = motion_held_still(m) ? STATUS_OK : known ? audit(c, m->reached) : corrected_audit(c);

    // the sensors lag behind what they are fixed to
    if (s == STATUS_OK && r->rig != NULL) {
        s = follow_with_sensors(c, &force);
    }

    // how fast the tip came towards the wall on its own
    if (r->rig != NULL && m->trial[SLOT_CONTACT] == 0) {
        recording_follow_flight(r, flight_closing_speed(&c->arm, m));
    }

    if (s == STATUS_OK && length > 0) {
        s = record_force(c, &force);
    }
    return s == STATUS_OK && r->options->keep_trace ? record_grid(c, at_event) : s;
}
