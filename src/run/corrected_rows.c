// The rows of a run of the corrected arm, and the residual of its energy balance.
#include <math.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/run/corrected.h"
#include "src/run/recording.h"

// --- rows ------------------------------------------------------------------------------

#define TINY_ENERGY 1e-9 // below it nothing is called unstable [J]
#define TINY_TURN   1e-2 // nor below what the motor does in this turn [rad]
// share of the energy turned over that may not be unaccounted for
#define WRONG_ENERGY 0.1
// of a step: a row of the grid so near a step's end lies at it
#define GRID_TOLERANCE 1e-9

// corrected_audit for a state that holds that energy.
static inline status audit(corrected_run *c, state_energy has)
{
    const motion *m = c->motion;
    summary *s = &c->recording->result->summary;
    const double held = motion_held_energy(&c->arm, m, m->state);
    double residual = motion_unaccounted(m, m->state, has.kinetic + has.strain + held);
    s->energy_residual_J = larger(fabs(residual), s->energy_residual_J);

    const double torque = c->arm.motor.torque + m->state[SLOT_MOTOR_TORQUE];
    double turned_over = fabs(motion_motor_work(m, m->state)) +
                         fabs(m->state[SLOT_EXTERNAL_WORK]) + fabs(held) +
                         fabs(state_quadratures(m, m->state)[QUADRATURE_PUSHED]) +
                         m->record.start_energy + fabs(torque) * TINY_TURN + TINY_ENERGY;
    // steps that do not resolve the fastest modes damp them: there energy may vanish, not
    // appear
    double wrong = motion_unresolved(&c->arm, m) ? residual : fabs(residual);
    if (!isfinite(residual) || !isfinite(turned_over)) {
        return STATUS_NOT_FINITE;
    }
    if (wrong > WRONG_ENERGY * turned_over) {
        return STATUS_UNSTABLE;
    }
    return STATUS_OK;
}

status corrected_audit(corrected_run *c)
{
    return audit(c, motion_energy(&c->arm, c->motion, c->motion->state));
}

// The row of a state that holds that energy.
static sample row_of(const corrected_run *c, double *state, state_energy has,
                     double impulse)
{
    const arm *a = &c->arm;
    const motion *m = c->motion;

    // the state's parts, and the links that the signals name
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    double *al = state_accelerations(m, state), *quadrature = state_quadratures(m, state);
    const bool rigid = motion_wall_is_rigid(m);
    const value_and_slope gap = state_rest_gap(state);
    const double held = motion_held_energy(a, m, state);
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
        .gap = gap.value,
        .gap_velocity = gap.slope,
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
        .wall_energy = rigid ? (double)NAN : motion_wall_energy(a, m, state),
        .wall_loss = rigid ? (double)NAN : quadrature[QUADRATURE_WALL],
        .wall_place = wall_moves(&a->wall)
                          ? wall_motion_at(&a->wall.motion, state[SLOT_TIME]).place
                          : (double)NAN,
        .wall_work = wall_moves(&a->wall) ? quadrature[QUADRATURE_PUSHED] : (double)NAN,
        .weight_energy = a->gravity != 0 ? chain_weight_energy(a, q) : (double)NAN,
        .face_depth = rigid ? (double)NAN : state[SLOT_FACE],
    };

    recording_add_rig_signals(c->recording, &row);
    return row;
}

double *corrected_present(const corrected_run *c)
{
    motion *m = c->motion;
    double *within = NULL;
    if (c->stretch.open.goes_on) {
        within = motion_between(&c->arm, m, c->stretch.open.now, STATE_WHOLE);
    }
    return within != NULL ? within : m->state;
}

sample corrected_row(const corrected_run *c, double *state)
{
    return row_of(c, state, motion_energy(&c->arm, c->motion, state), 0);
}

static status record_row_of(corrected_run *c, double *state, state_energy has,
                            double impulse)
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

// Records rows within the step just made or under way, stepped to again from its start:
// side by side if the engine can do that.
static status record_within(corrected_run *c, const double *times, int count)
{
    motion *m = c->motion;
    state_energy has[MOTION_TOGETHER];
    const bool together = count > 1 && motion_between_all(&c->arm, m, times, count, has);
    for (int i = 0; i < count; i++) {
        if (together) {
            TRY(record_row_of(c, m->between + i * m->size, has[i], 0));
        } else {
            double *state = motion_between(&c->arm, m, times[i], STATE_WHOLE);
            if (state) {
                TRY(corrected_record_row(c, state, 0));
            } else {
                TRY(STATUS_NOT_FINITE);
            }
        }
        if (recording_asked_to_stop(c->recording)) {
            return STATUS_STOPPED;
        }
    }
    return STATUS_OK;
}

// Records the rows of the grid before an instant [s], which lie within the step just made
// or under way.
static status record_rows_before(corrected_run *c, double instant)
{
    recording *r = c->recording;
    const double interval = r->scenario->parameters.method.step;
    double time = (double)r->state.grid_row * interval;

    // some at a time
    while (time < instant) {
        double times[MOTION_TOGETHER];
        int count = 0;
        for (; count < MOTION_TOGETHER && time < instant; count++) {
            times[count] = time;
            time = (double)++r->state.grid_row * interval;
        }
        TRY(record_within(c, times, count));
    }
    return STATUS_OK;
}

status corrected_record_rows_to(corrected_run *c, double time)
{
    const double interval = c->recording->scenario->parameters.method.step;
    const bool keeps = c->recording->options->keep_trace;
    if (keeps) {
        return record_rows_before(c, time + GRID_TOLERANCE * interval);
    }
    return STATUS_OK;
}

// Records the rows of the grid that lie within the step just made, and passes over one at
// its end if an event is there.
static status record_grid(corrected_run *c, bool at_event)
{
    recording *r = c->recording;
    motion *m = c->motion;
    const double interval = r->scenario->parameters.method.step,
                 now = m->state[SLOT_TIME];
    const double end = GRID_TOLERANCE * interval;

    // those within it, then one at its end; an event records its own rows
    TRY(record_rows_before(c, now - end));
    if ((double)r->state.grid_row * interval > now + end) {
        return STATUS_OK;
    }
    r->state.grid_row++;
    if (!at_event) {
        TRY(corrected_record_row(c, m->state, 0));
    }
    if (recording_asked_to_stop(r)) {
        return STATUS_STOPPED;
    }
    return STATUS_OK;
}

// --- flight ----------------------------------------------------------------------------

// The fastest mode turns by no more in a piece of a step, in which the tip's speed then
// has one extreme at most but for little [rad].
#define RATE_REACH 0.5

enum { SEPARATION_BISECTIONS = 30, FASTEST_THIRDS = 24, MOST_FLIGHT_PIECES = 16 };

// The gap at an instant [s] within the step just made, a step in free flight; false, and
// none, if that fails.
static bool gap_within(const arm *a, motion *m, double time, value_and_slope *gap)
{
    *gap = (value_and_slope){0, 0};
    if (engine_is_dense(m->engine) && !state_is_held_still(m, m->trial)) {
        *gap = motion_output(a, m, OUTPUT_GAP, time - m->trial[SLOT_TIME]);
        return true;
    }
    const double *state = motion_between(a, m, time, STATE_WHOLE);
    if (state != NULL) {
        *gap = (value_and_slope){state[SLOT_GAP], state[SLOT_GAP_VELOCITY]};
    }
    return state != NULL;
}

// Whether the gap was a separation, above SEPARATION_GAP, at any instant of the step just
// made. A whole flight may lie within it, so its end says little: look where the gap
// stops growing.
static bool flight_separated(const arm *a, motion *m)
{
    double from = m->trial[SLOT_TIME], to = m->state[SLOT_TIME];

    // the ends of the step decide nearly always; in contact the gap is that to the wall
    // at rest, beyond which a face with a mass may swing
    if (m->state[SLOT_CONTACT] != 0) {
        return false;
    }
    if (m->state[SLOT_GAP] > SEPARATION_GAP) {
        return true;
    }
    if (m->state[SLOT_GAP_VELOCITY] >= 0) {
        return false;
    }

    // the gap closes at the step's end: bisect for the instant at which it was the
    // largest
    for (int i = 0; i < SEPARATION_BISECTIONS; i++) {
        const double middle = 0.5 * (from + to);
        value_and_slope gap;
        if (!gap_within(a, m, middle, &gap) || gap.value > SEPARATION_GAP) {
            return gap.value > SEPARATION_GAP;
        }
        if (gap.slope > 0) {
            from = middle;
        } else {
            to = middle;
        }
    }
    return false;
}

// The rate of the gap at the ends of equal pieces of the step just made: `count` of them
// from its start on. What cannot be had is HUGE_VAL.
static void rates_of(const arm *a, motion *m, int count, double *rate)
{
    const double from = m->trial[SLOT_TIME], width = (m->state[SLOT_TIME] - from) / count;
    rate[0] = m->trial[SLOT_GAP_VELOCITY];
    rate[count] = m->state[SLOT_GAP_VELOCITY];
    for (int i = 1; i < count; i++) {
        value_and_slope gap;
        if (gap_within(a, m, from + i * width, &gap)) {
            rate[i] = gap.slope;
        } else {
            rate[i] = HUGE_VAL;
        }
    }
}

// The least rate of the gap between two instants [s], where it falls and then grows, of
// which one that is known is `least`.
static double least_rate(const arm *a, motion *m, double from, double to, double least)
{
    // thirds of what is left, of which the better two stay
    for (int i = 0; i < FASTEST_THIRDS; i++) {
        const double early = from + (to - from) / 3, late = to - (to - from) / 3;
        value_and_slope first, second;
        if (!gap_within(a, m, early, &first) || !gap_within(a, m, late, &second)) {
            break;
        }
        if (!(first.slope <= second.slope)) {
            from = early;
        }
        if (first.slope <= second.slope) {
            to = late;
        }
        least = smaller(least, smaller(first.slope, second.slope));
    }
    return least;
}

// How fast the tip came towards the wall at most in the step just made [m/s]: at its ends
// or, where it was faster and then slower, in between. Negative if it only went away; 0
// without a wall.
static double flight_closing_speed(const arm *a, motion *m)
{
    double rate[MOST_FLIGHT_PIECES + 1];
    const double from = m->trial[SLOT_TIME], length = m->state[SLOT_TIME] - from;
    if (!wall_stands(&a->wall)) {
        return 0;
    }

    // the piece of the step at whose end the tip is fastest
    const double pieces =
        engine_is_dense(m->engine) ? length * a->highest_frequency / RATE_REACH : 1;
    const int count =
        pieces < MOST_FLIGHT_PIECES ? (int)larger(ceil(pieces), 1) : MOST_FLIGHT_PIECES;
    int fastest = 0;
    rates_of(a, m, count, rate);
    for (int i = 1; i <= count; i++) {
        if (rate[i] < rate[fastest]) {
            fastest = i;
        }
    }

    // it may be faster to either side of there, but not before the step and after it
    const bool falls = fastest > 0 || m->trial[SLOT_GAP_ACCELERATION] < 0;
    const bool grows = fastest < count || m->state[SLOT_GAP_ACCELERATION] > 0;
    if (!falls || !grows) {
        return -rate[fastest];
    }
    const double before = from + length * (fastest > 0 ? fastest - 1 : 0) / count;
    const double after = from + length * (fastest < count ? fastest + 1 : count) / count;
    return -least_rate(a, m, before, after, rate[fastest]);
}

// --- a step ----------------------------------------------------------------------------

status corrected_record_step(corrected_run *c, bool at_event)
{
    recording *r = c->recording;
    motion *m = c->motion;

    // how far the arm has gone from the wall
    if (!isnan(r->result->summary.first_contact_s) && !r->state.separated) {
        r->state.separated = flight_separated(&c->arm, m);
    }
    const arm *a = &c->arm;
    r->state.energy_put_in +=
        fabs(motion_motor_work(m, m->state) - motion_motor_work(m, m->trial)) +
        fabs(state_quadratures(m, m->state)[QUADRATURE_PUSHED] -
             state_quadratures(m, m->trial)[QUADRATURE_PUSHED]) +
        fabs(chain_weight_energy(a, state_angles(m, m->state)) -
             chain_weight_energy(a, state_angles(m, m->trial)));

    // an arm held still has the energy it had
    const bool known = m->step.energy.kinetic >= 0;
    status s = STATUS_OK;
    if (!motion_held_still(m)) {
        if (known) {
            s = audit(c, m->step.energy);
        } else {
            s = corrected_audit(c);
        }
    }

    // how fast the tip came towards the wall on its own
    if (r->rig != NULL && m->trial[SLOT_CONTACT] == 0) {
        summary *all = &r->result->summary;
        double *most = isnan(all->first_contact_s) ? &all->approach_speed_m_s
                                                   : &all->return_speed_m_s;
        *most = larger(flight_closing_speed(&c->arm, m), *most);
    }

    TRY(s);
    TRY(corrected_record_forces(c));
    if (r->options->keep_trace) {
        return record_grid(c, at_event);
    }
    return STATUS_OK;
}
