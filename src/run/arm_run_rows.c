// The rows of a run of the corrected arm, and its ledger of energy.
#include <math.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/run/arm_run.h"
#include "src/run/recording.h"

// --- the ledger ------------------------------------------------------------------------

#define TINY_ENERGY 1e-9 // below it nothing is called unstable [J]
#define TINY_TURN   1e-2 // nor below what the motor does in this turn [rad]
// share of the energy turned over that may not be unaccounted for
#define WRONG_ENERGY 0.1

// arm_run_audit for a state that holds that energy.
static inline status audit(arm_run *run, state_energy has)
{
    const motion *m = run->motion;
    summary *s = &run->recording->result->summary;
    const double held = motion_held_energy(&run->arm, m, m->state);
    const double residual =
        motion_unaccounted(m, m->state, has.kinetic + has.strain + held);
    s->energy_residual_J = larger(fabs(residual), s->energy_residual_J);

    // what it is measured by
    const double torque = run->arm.motor.torque + m->state[SLOT_MOTOR_TORQUE];
    const double turned_over =
        fabs(motion_motor_work(m, m->state)) + fabs(m->state[SLOT_EXTERNAL_WORK]) +
        fabs(held) + fabs(state_quadratures(m, m->state)[QUADRATURE_PUSHED]) +
        m->record.start_energy + fabs(torque) * TINY_TURN + TINY_ENERGY;
    if (!isfinite(residual) || !isfinite(turned_over)) {
        return STATUS_NOT_FINITE;
    }

    // steps that do not resolve the fastest modes damp them: there energy may vanish, not
    // appear
    const double wrong = motion_unresolved(&run->arm, m) ? residual : fabs(residual);
    if (wrong > WRONG_ENERGY * turned_over) {
        return STATUS_UNSTABLE;
    }
    return STATUS_OK;
}

status arm_run_audit(arm_run *run)
{
    return audit(run, motion_energy(&run->arm, run->motion, run->motion->state));
}

// What the step just made put into the arm, or took from it [J].
static double work_of_step(const arm_run *run)
{
    const motion *m = run->motion;
    const arm *a = &run->arm;
    return fabs(motion_motor_work(m, m->state) - motion_motor_work(m, m->trial)) +
           fabs(state_quadratures(m, m->state)[QUADRATURE_PUSHED] -
                state_quadratures(m, m->trial)[QUADRATURE_PUSHED]) +
           fabs(chain_weight_energy(a, state_angles(m, m->state)) -
                chain_weight_energy(a, state_angles(m, m->trial)));
}

void arm_run_note_work(arm_run *run, double work)
{
    run->recording->state.rows.energy_put_in += fabs(work);
}

// --- rows ------------------------------------------------------------------------------

// Of a step: a row of the grid so near a step's end lies at it.
#define GRID_TOLERANCE 1e-9

// The row of a state that holds that energy.
static sample row_of(const arm_run *run, double *state, state_energy has, double impulse)
{
    const arm *a = &run->arm;
    const motion *m = run->motion;
    const double none = (double)NAN;

    // the state's parts, and the links that the signals name
    double *q = state_angles(m, state), *w = state_velocities(m, state);
    double *al = state_accelerations(m, state), *quadrature = state_quadratures(m, state);
    const int first = a->first, last = a->dof - 1;

    // every signal of the table that the corrected model has
    const value_and_slope gap = state_rest_gap(state);
    const double held = motion_held_energy(a, m, state);
    sample row = {
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
        .wall_energy = none,
        .wall_loss = none,
        .wall_place = none,
        .wall_work = none,
        .weight_energy = none,
        .face_depth = none,
    };

    // those of walls and weight, where there are such
    if (!motion_wall_is_rigid(m)) {
        row.wall_energy = motion_wall_energy(a, m, state);
        row.wall_loss = quadrature[QUADRATURE_WALL];
        row.face_depth = state[SLOT_FACE];
    }
    if (wall_moves(&a->wall)) {
        row.wall_place = wall_motion_at(&a->wall.motion, state[SLOT_TIME]).place;
        row.wall_work = quadrature[QUADRATURE_PUSHED];
    }
    if (a->amount.gravity != 0) {
        row.weight_energy = chain_weight_energy(a, q);
    }
    recording_add_rig_signals(run->recording, &row);
    return row;
}

double *arm_run_present_state(const arm_run *run)
{
    motion *m = run->motion;
    if (run->under_way.exists) {
        double *within = motion_between(&run->arm, m, run->under_way.time, STATE_WHOLE);
        if (within != NULL) {
            return within;
        }
    }
    return m->state;
}

sample arm_run_row(const arm_run *run, double *state)
{
    return row_of(run, state, motion_energy(&run->arm, run->motion, state), 0);
}

static status record_row_of(arm_run *run, double *state, state_energy has, double impulse)
{
    const motion *m = run->motion;
    const sample row = row_of(run, state, has, impulse);
    return recording_add_row(run->recording, &row, state_angles(m, state),
                             state_velocities(m, state));
}

status arm_run_record_row(arm_run *run, double *state, double impulse)
{
    if (!run->recording->options->keep_trace) {
        return STATUS_OK;
    }
    const state_energy has = motion_energy(&run->arm, run->motion, state);
    return record_row_of(run, state, has, impulse);
}

// Records rows within the step just made or under way, stepped to again from its start:
// side by side if the engine can do that.
static status record_within(arm_run *run, const double *times, int count)
{
    motion *m = run->motion;
    state_energy has[MOTION_TOGETHER];
    const bool together =
        count > 1 && motion_between_all(&run->arm, m, times, count, has);
    for (int i = 0; i < count; i++) {
        if (together) {
            TRY(record_row_of(run, m->between + i * m->size, has[i], 0));
        } else {
            double *state = motion_between(&run->arm, m, times[i], STATE_WHOLE);
            if (state == NULL) {
                return STATUS_NOT_FINITE;
            }
            TRY(arm_run_record_row(run, state, 0));
        }
        if (recording_asked_to_stop(run->recording)) {
            return STATUS_STOPPED;
        }
    }
    return STATUS_OK;
}

status arm_run_record_first_row(arm_run *run)
{
    run->recording->state.rows.next = 1;
    return arm_run_record_row(run, run->motion->state, 0);
}

// The distance between two rows of the grid [s].
static double grid_interval(const arm_run *run)
{
    return run->recording->scenario->parameters.method.step;
}

status arm_run_record_last_row(arm_run *run, double time)
{
    const double interval = grid_interval(run);
    const double last_row = (double)(run->recording->state.rows.next - 1) * interval;
    if (last_row < time - GRID_TOLERANCE * interval) {
        return arm_run_record_row(run, run->motion->state, 0);
    }
    return STATUS_OK;
}

// Records the rows of the grid before an instant [s], which lie within the step just made
// or under way.
static status record_rows_before(arm_run *run, double instant)
{
    row_record *rows = &run->recording->state.rows;
    const double interval = grid_interval(run);
    double time = (double)rows->next * interval;

    // some at a time
    while (time < instant) {
        double times[MOTION_TOGETHER];
        int count = 0;
        for (; count < MOTION_TOGETHER && time < instant; count++) {
            times[count] = time;
            rows->next++;
            time = (double)rows->next * interval;
        }
        TRY(record_within(run, times, count));
    }
    return STATUS_OK;
}

status arm_run_record_rows_to(arm_run *run, double time)
{
    if (!run->recording->options->keep_trace) {
        return STATUS_OK;
    }
    return record_rows_before(run, time + GRID_TOLERANCE * grid_interval(run));
}

// Records the rows of the grid that lie within the step just made, and passes over one at
// its end if an event is there.
static status record_grid(arm_run *run, bool at_event)
{
    row_record *rows = &run->recording->state.rows;
    motion *m = run->motion;
    const double interval = grid_interval(run), now = m->state[SLOT_TIME];
    const double tolerance = GRID_TOLERANCE * interval;

    // those within it
    TRY(record_rows_before(run, now - tolerance));
    if ((double)rows->next * interval > now + tolerance) {
        return STATUS_OK;
    }

    // then one at its end; an event records its own rows
    rows->next++;
    if (!at_event) {
        TRY(arm_run_record_row(run, m->state, 0));
    }
    if (recording_asked_to_stop(run->recording)) {
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
        if (first.slope <= second.slope) {
            to = late;
        } else {
            from = early;
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
    int count = 1, fastest = 0;
    if (engine_is_dense(m->engine)) {
        const double pieces = length * a->highest_frequency / RATE_REACH;
        count = (int)smaller(larger(ceil(pieces), 1), MOST_FLIGHT_PIECES);
    }
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
    const int before = fastest > 0 ? fastest - 1 : 0;
    const int after = fastest < count ? fastest + 1 : count;
    return -least_rate(a, m, from + length * before / count,
                       from + length * after / count, rate[fastest]);
}

bool arm_run_end_flight(arm_run *run)
{
    row_record *rows = &run->recording->state.rows;
    const bool separated = rows->separated;
    rows->separated = false;
    return separated;
}

// --- a step ----------------------------------------------------------------------------

status arm_run_record_step(arm_run *run, bool at_event)
{
    recording *r = run->recording;
    motion *m = run->motion;
    summary *s = &r->result->summary;

    // how far the arm has gone from the wall, and what was put into it
    if (!isnan(s->first_contact_s) && !r->state.rows.separated &&
        flight_separated(&run->arm, m)) {
        r->state.rows.separated = true;
    }
    arm_run_note_work(run, work_of_step(run));

    // an arm held still has the energy it had
    status balance = STATUS_OK;
    if (!motion_held_still(m) && m->step.energy.kinetic >= 0) {
        balance = audit(run, m->step.energy);
    } else if (!motion_held_still(m)) {
        balance = arm_run_audit(run);
    }

    // how fast the tip came towards the wall on its own
    if (r->rig != NULL && m->trial[SLOT_CONTACT] == 0) {
        double *most = &s->return_speed_m_s;
        if (isnan(s->first_contact_s)) {
            most = &s->approach_speed_m_s;
        }
        *most = larger(flight_closing_speed(&run->arm, m), *most);
    }

    TRY(balance);
    TRY(arm_run_record_forces(run));
    if (!r->options->keep_trace) {
        return STATUS_OK;
    }
    return record_grid(run, at_event);
}
