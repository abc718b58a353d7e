// The rows of a run of the corrected arm, and its ledger of energy.
#include <math.h>

#include "src/base/extremes.h"
#include "src/base/instant.h"
#include "src/run/arm_run.h"
#include "src/run/recording.h"

// --- the ledger ------------------------------------------------------------------------

// A residual of the energy balance is judged as a share of the energy that the run has
// exchanged. That counts as this much at least, and as the motor's work over this turn,
// so that rounding at the start of a run is not called unstable.
#define TINY_ENERGY 1e-9 // [J]
#define TINY_TURN   1e-2 // [rad]

// The share of it that may be unaccounted for before the run is unstable.
#define WRONG_ENERGY 0.1

// arm_run_audit, given the energy of the present state: the residual is the energy that
// the arm and what it pushes on hold beyond what all work and losses account for.
static inline status audit(arm_run *run, state_energy energy)
{
    const motion *m = run->motion;
    summary *s = &run->recording->result->summary;
    const double held = motion_held_energy(&run->arm, m, m->state);
    const double residual =
        motion_unaccounted(m, m->state, energy.kinetic + energy.strain + held);
    s->energy_residual_J = larger(fabs(residual), s->energy_residual_J);

    // the energy exchanged so far, by which the residual is measured
    const double torque = run->arm.motor.torque + m->state[SLOT_MOTOR_TORQUE];
    const double exchanged =
        fabs(motion_motor_work(m, m->state)) + fabs(m->state[SLOT_EXTERNAL_WORK]) +
        fabs(held) + fabs(state_quadratures(m, m->state)[QUADRATURE_PUSHED]) +
        m->record.start_energy + fabs(torque) * TINY_TURN + TINY_ENERGY;
    if (!isfinite(residual) || !isfinite(exchanged)) {
        return STATUS_NOT_FINITE;
    }

    // steps that are too long for the fastest modes damp them: such a run may lose
    // energy, but not gain it
    const double wrong = motion_unresolved(&run->arm, m) ? residual : fabs(residual);
    if (wrong > WRONG_ENERGY * exchanged) {
        return STATUS_UNSTABLE;
    }
    return STATUS_OK;
}

status arm_run_audit(arm_run *run)
{
    return audit(run, motion_energy(&run->arm, run->motion, run->motion->state));
}

// The energy that the step just made moved into the arm or out of it [J]: the magnitudes
// of the motor's work, of the moving wall's and of the weight's, added up.
static double work_of_step(const arm_run *run)
{
    const motion *m = run->motion;
    const arm *a = &run->arm;
    const double moved =
        fabs(motion_motor_work(m, m->state) - motion_motor_work(m, m->trial)) +
        fabs(state_quadratures(m, m->state)[QUADRATURE_PUSHED] -
             state_quadratures(m, m->trial)[QUADRATURE_PUSHED]);
    if (a->amount.gravity == 0) {
        return moved;
    }
    return moved + fabs(chain_weight_energy(a, state_angles(m, m->state)) -
                        chain_weight_energy(a, state_angles(m, m->trial)));
}

void arm_run_note_work(arm_run *run, double work)
{
    run->recording->state.rows.energy_put_in += fabs(work);
}

// --- rows ------------------------------------------------------------------------------

// Rows lie on grids: multiples of method.step, and of what the run is asked for. One
// within this share of the grid's interval from the end of a step lies at that end, and
// so do rows of two grids.
#define GRID_TOLERANCE 1e-9

// Fills in the signals of the motion: angles and their derivatives, gap, force and
// torques.
static void add_motion_signals(const arm_run *run, double *state, sample *row)
{
    // of the angles, those of the bodies that the signals name
    const motion *m = run->motion;
    const double *angles = state_angles(m, state);
    const double *velocities = state_velocities(m, state);
    const double *accelerations = state_accelerations(m, state);
    const int first = run->arm.first, last = run->arm.dof - 1;
    row->time = state[SLOT_TIME];
    row->hub_angle = angles[0];
    row->first_angle = angles[first];
    row->last_angle = angles[last];
    row->hub_velocity = velocities[0];
    row->first_velocity = velocities[first];
    row->last_velocity = velocities[last];
    row->hub_acceleration = accelerations[0];
    row->first_acceleration = accelerations[first];
    row->last_acceleration = accelerations[last];

    // contact with the wall
    const value_and_slope gap = state_rest_gap(state);
    row->gap = gap.value;
    row->gap_velocity = gap.slope;
    row->force = state[SLOT_FORCE];
    row->contact = state[SLOT_CONTACT];

    // motor and friction at the hub
    const motor_model *motor = &run->arm.motor;
    row->sticking = state[SLOT_FRICTION] == HUB_STICK;
    row->voltage = motor->voltage;
    row->motor_torque = motor->torque + state[SLOT_MOTOR_TORQUE];
    row->friction_torque = state[SLOT_FRICTION_TORQUE];
}

// Fills in the signals of the energy ledger.
static void add_energy_signals(const arm_run *run, double *state, state_energy energy,
                               sample *row)
{
    const motion *m = run->motion;
    const double *quadratures = state_quadratures(m, state);
    const double held = motion_held_energy(&run->arm, m, state);
    row->kinetic_energy = energy.kinetic;
    row->strain_energy = energy.strain;
    row->motor_work = motion_motor_work(m, state);
    row->external_work = state[SLOT_EXTERNAL_WORK];
    row->viscous_loss = quadratures[QUADRATURE_VISCOUS];
    row->friction_loss = state[SLOT_FRICTION_LOSS];
    row->damping_loss = quadratures[QUADRATURE_DAMPING];
    row->impact_loss = state[SLOT_IMPACT_LOSS];
    row->energy_residual =
        motion_unaccounted(m, state, energy.kinetic + energy.strain + held);
}

// Fills in the signals of a wall that gives or moves, and of the weight; they are NaN for
// an arm without them.
static void add_wall_signals(const arm_run *run, double *state, sample *row)
{
    const arm *a = &run->arm;
    const motion *m = run->motion;
    const double *quadratures = state_quadratures(m, state);
    row->wall_energy = row->wall_loss = row->face_depth = (double)NAN;
    row->wall_place = row->wall_work = row->weight_energy = (double)NAN;

    // each where the scenario has it
    if (!motion_wall_is_rigid(m)) {
        row->wall_energy = motion_wall_energy(a, m, state);
        row->wall_loss = quadratures[QUADRATURE_WALL];
        row->face_depth = state[SLOT_FACE];
    }
    if (wall_moves(&a->wall)) {
        row->wall_place = wall_motion_at(&a->wall.motion, state[SLOT_TIME]).place;
        row->wall_work = quadratures[QUADRATURE_PUSHED];
    }
    if (a->amount.gravity != 0) {
        row->weight_energy = chain_weight_energy(a, state_angles(m, state));
    }
}

// Fills in the row of a state with that kinetic and strain energy, at which an impulse
// [N s] acts.
static void fill_row(const arm_run *run, double *state, state_energy energy,
                     double impulse, sample *row)
{
    *row = (sample){.impulse = impulse};
    add_motion_signals(run, state, row);
    add_energy_signals(run, state, energy, row);
    add_wall_signals(run, state, row);
    recording_add_rig_signals(run->recording, row);
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
    sample row;
    fill_row(run, state, motion_energy(&run->arm, run->motion, state), 0, &row);
    return row;
}

// Adds the row of a state with that energy to the trace.
static status record_state_row(arm_run *run, double *state, state_energy energy,
                               double impulse)
{
    const motion *m = run->motion;
    sample *row = trace_next_row(&run->recording->result->trace);
    if (row == NULL) {
        return STATUS_NO_MEMORY;
    }
    fill_row(run, state, energy, impulse, row);
    return recording_add_row(run->recording, row, state_angles(m, state),
                             state_velocities(m, state));
}

status arm_run_record_row(arm_run *run, double *state, double impulse)
{
    if (!recording_has_rows(run->recording)) {
        return STATUS_OK;
    }
    const state_energy energy = motion_energy(&run->arm, run->motion, state);
    return record_state_row(run, state, energy, impulse);
}

// Records rows at instants within the step just made or under way. The engine computes
// the states there from the start of the step, all at once if it can.
static status record_within(arm_run *run, const double *times, int count)
{
    // all states at once
    motion *m = run->motion;
    state_energy energies[MOTION_TOGETHER];
    const bool together =
        count > 1 && motion_between_all(&run->arm, m, times, count, energies);

    // a row for each, whose state is computed here where that was not possible
    for (int i = 0; i < count; i++) {
        if (together) {
            TRY(record_state_row(run, m->between + i * m->size, energies[i], 0));
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

void arm_run_lay_out_rows(arm_run *run)
{
    recording *r = run->recording;
    const bool is_asked = r->options->rows_every > 0;
    r->row_intervals[GRID_OF_STEPS] = r->row_intervals[GRID_ASKED_FOR] = HUGE_VAL;
    if (r->options->keep_trace || !is_asked) {
        r->row_intervals[GRID_OF_STEPS] = r->scenario->parameters.method.step;
    }
    if (is_asked) {
        r->row_intervals[GRID_ASKED_FOR] = r->options->rows_every;
    }
    r->row_tolerance = GRID_TOLERANCE * smaller(r->row_intervals[GRID_OF_STEPS],
                                                r->row_intervals[GRID_ASKED_FOR]);
}

status arm_run_record_first_row(arm_run *run)
{
    row_record *rows = &run->recording->state.rows;
    for (int g = 0; g < ROW_GRIDS; g++) {
        rows->next[g] = 1;
    }
    return arm_run_record_row(run, run->motion->state, 0);
}

// The instant of the next row of any grid [s]; of two that are one, that of the later
// grid.
static double next_row(const arm_run *run)
{
    const recording *r = run->recording;
    const row_record *rows = &r->state.rows;
    double time = HUGE_VAL;
    for (int g = 0; g < ROW_GRIDS; g++) {
        const double next = (double)rows->next[g] * r->row_intervals[g];
        if (next <= time + r->row_tolerance) {
            time = next;
        }
    }
    return time;
}

// Goes on to the row behind that of an instant [s] on each grid that has one there.
static void pass_row(arm_run *run, double time)
{
    recording *r = run->recording;
    row_record *rows = &r->state.rows;
    for (int g = 0; g < ROW_GRIDS; g++) {
        const double next = (double)rows->next[g] * r->row_intervals[g];
        if (next <= time + r->row_tolerance) {
            rows->next[g]++;
        }
    }
}

status arm_run_record_last_row(arm_run *run, double time)
{
    // a grid that has a row there has gone on behind it
    const recording *r = run->recording;
    const row_record *rows = &r->state.rows;
    for (int g = 0; g < ROW_GRIDS; g++) {
        const double interval = r->row_intervals[g];
        if (isfinite(interval) &&
            (double)(rows->next[g] - 1) * interval >= time - GRID_TOLERANCE * interval) {
            return STATUS_OK;
        }
    }
    return arm_run_record_row(run, run->motion->state, 0);
}

// Records the rows of the grids before an instant [s], which lie within the step just
// made or under way.
static status record_rows_before(arm_run *run, double instant)
{
    double time = next_row(run);

    // as many at a time as the engine computes together
    while (time < instant) {
        double times[MOTION_TOGETHER];
        int count = 0;
        for (; count < MOTION_TOGETHER && time < instant; count++) {
            times[count] = time;
            pass_row(run, time);
            time = next_row(run);
        }
        TRY(record_within(run, times, count));
    }
    return STATUS_OK;
}

status arm_run_record_rows_to(arm_run *run, double time)
{
    if (!recording_has_rows(run->recording)) {
        return STATUS_OK;
    }
    return record_rows_before(run, time + run->recording->row_tolerance);
}

// Records the rows of the grids that lie within the step just made. A row of a grid at
// the step's end is left to the event there, if there is one.
static status record_grid(arm_run *run, bool at_event)
{
    motion *m = run->motion;
    const double now = m->state[SLOT_TIME], tolerance = run->recording->row_tolerance;

    // those before its end
    TRY(record_rows_before(run, now - tolerance));
    if (next_row(run) > now + tolerance) {
        return STATUS_OK;
    }

    // one at its end; an event records its own rows
    pass_row(run, now);
    if (!at_event) {
        TRY(arm_run_record_row(run, m->state, 0));
    }
    if (recording_asked_to_stop(run->recording)) {
        return STATUS_STOPPED;
    }
    return STATUS_OK;
}

// --- flight ----------------------------------------------------------------------------

// A step in flight is cut into pieces in which the phase of the fastest mode advances by
// this much at most [rad]: nearly always the tip's speed then has one extreme at most in
// each.
#define RATE_REACH 0.5

enum { SEPARATION_BISECTIONS = 30, FASTEST_THIRDS = 24, MOST_FLIGHT_PIECES = 16 };

// Computes the gap and its rate at an instant [s] within the step just made, a step in
// free flight. False, with a gap of zero, if the state there cannot be computed.
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

// Whether the gap exceeded SEPARATION_GAP at any instant of the step just made. A whole
// flight may lie within one step, so that the gap is looked at where it is the largest:
// where its rate changes sign, which bisection finds.
static bool flight_separated(const arm *a, motion *m)
{
    // in contact there is no separation; the gap, which is that to the wall at rest, may
    // be large there where a face with a mass swings
    if (m->state[SLOT_CONTACT] != 0) {
        return false;
    }

    // nearly always the end of the step decides
    if (m->state[SLOT_GAP] > SEPARATION_GAP) {
        return true;
    }
    if (m->state[SLOT_GAP_VELOCITY] >= 0) {
        return false;
    }

    // the gap closes at the step's end: bisect for the instant at which it was the
    // largest
    double from = m->trial[SLOT_TIME], to = m->state[SLOT_TIME];
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

// Fills in the rate of the gap at the start of the step just made and at the ends of its
// `count` equal pieces. A rate that cannot be computed is HUGE_VAL.
static void gap_rates(const arm *a, motion *m, int count, double *rate)
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

// The smallest rate of the gap between two instants [s], between which the rate falls and
// then grows. `least` is one that is known there. Found by ternary search, which drops
// the outer third next to the larger of two rates.
static double least_rate(const arm *a, motion *m, double from, double to, double least)
{
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

// The largest speed at which the tip came towards the wall in the step just made [m/s].
// It is negative if the tip only went away, and 0 without a wall.
static double flight_closing_speed(const arm *a, motion *m)
{
    if (!wall_stands(&a->wall)) {
        return 0;
    }

    // enough pieces for one extreme in each
    const double from = m->trial[SLOT_TIME], length = m->state[SLOT_TIME] - from;
    int count = 1;
    if (engine_is_dense(m->engine)) {
        const double pieces = length * a->highest_frequency / RATE_REACH;
        count = (int)smaller(larger(ceil(pieces), 1), MOST_FLIGHT_PIECES);
    }

    // the piece at whose end the tip is fastest: where the rate of the gap is the least
    double rate[MOST_FLIGHT_PIECES + 1];
    int fastest = 0;
    gap_rates(a, m, count, rate);
    for (int i = 1; i <= count; i++) {
        if (rate[i] < rate[fastest]) {
            fastest = i;
        }
    }

    // the tip is faster near there, unless that is an end of the step towards which the
    // speed grows
    const bool falls = fastest > 0 || m->trial[SLOT_GAP_ACCELERATION] < 0;
    const bool grows = fastest < count || m->state[SLOT_GAP_ACCELERATION] > 0;
    if (!falls || !grows) {
        return -rate[fastest];
    }

    // between the pieces to both sides
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

    // whether the arm has separated from the wall, and the energy put into it
    if (!isnan(s->first_contact_s) && !r->state.rows.separated &&
        flight_separated(&run->arm, m)) {
        r->state.rows.separated = true;
    }
    arm_run_note_work(run, work_of_step(run));

    // the energy balance; an arm held still keeps the energy it had
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
    if (!recording_has_rows(r)) {
        return STATUS_OK;
    }
    return record_grid(run, at_event);
}
