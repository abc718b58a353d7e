// What a run in progress records, whichever model it is of: rows, events, the force of
// every step, and the summary that comes of them.
#pragma once

#include "src/rig/rig.h"
#include "src/run/run_result.h"
#include "src/scenario/scenario.h"
#include "src/contact/motion.h"

#define STEADY_WINDOW  0.1  // steady force: mean over the last of the run [s]
#define SEPARATION_GAP 1e-6 // a smaller gap is no separation [m]

// Contact so far, of the corrected model.
typedef struct contact_history {
    bool pulse_open;     // the first pulse has not ended
    bool landing_open;   // nor that of the landing
    landing landing;     // as far as it is known
    double earlier_peak; // largest force before it, of an arm that starts on the wall;
                         // else -1 [N]
    double earlier_peak_time; // its instant [s]
    long chatters;            // sequences of bounces that ended plastically
    long touches_behind_link; // of a point by the line of the last link, behind its base
} contact_history;

// The contact force so far, of the corrected model.
typedef struct force_record {
    double last_jump;          // instant of the last event, action or start [s]
    double integral_at_window; // where the steady force's window begins [N s]
    force_bounds largest;      // of the largest force since first contact [N]
    force_bounds in_window;    // of its integral since that window began [N s]
} force_record;

// The grids that rows lie on: multiples of method.step, and those of rows_every.
enum { GRID_OF_STEPS, GRID_ASKED_FOR, ROW_GRIDS };

// Rows and ledger so far, of the corrected model.
typedef struct row_record {
    long next[ROW_GRIDS]; // number of the next row of each grid
    bool separated;       // gap above SEPARATION_GAP in the present flight
    double energy_put_in; // sum of what motor and actions did or took over each step [J]
} row_record;

// What a run remembers from step to step besides rows, forces and summary.
typedef struct recording_state {
    int next_action; // of the script
    contact_history contact;
    force_record force;
    row_record rows;
} recording_state;

// A controller's command in force.
typedef struct recorded_command {
    double volts;     // [V]
    double time;      // since when [s]
    double hub_angle; // where it began [rad]
} recorded_command;

// The sample that rows show, which may be the one before the rig's last.
typedef struct shown_sample {
    bool sampled; // there is one
    long samples; // up to it
    sensor_reading reading;
    controller_output output;
    double predicted_force; // [N]
} shown_sample;

typedef struct recording {
    const scenario *scenario;
    const run_options *options;
    run_result *result;
    recording_state state;
    double row_intervals[ROW_GRIDS]; // [s]; HUGE_VAL: no row after the first
    double row_tolerance; // how far apart instants of the grids may lie that are one [s]
    rig *rig;             // NULL for the bare arm
    recorded_command command;   // of the rig
    shown_sample shown;         // of the rig, in rows
    double begun_cpu, begun_at; // by the thread's clock and the machine's [s]
    stop_request stop;          // where the run is to end
    parameters now;             // as changed by the script so far
} recording;

// Most rows that a run of which `expected` are expected reserves address space for.
size_t recording_most_rows(size_t expected);

// Sets up an empty trace of the kind that is asked for. STATUS_NO_MEMORY, with a sentence
// in f.
status recording_open_trace(recording *r, int angle_count, fault *f)
    __attribute__((warn_unused_result));

// Whether the run is to end, within or after a step.
static inline bool recording_asked_to_stop(recording *r)
{
    return r->options->stepped ? stop_is_set(&r->stop) : stop_requested(&r->stop);
}

// Whether rows are recorded, to be kept or to be taken.
static inline bool recording_has_rows(const recording *r)
{
    return r->options->keep_trace || r->options->take_row != NULL;
}

// Whether the last row is one of this instant [s].
bool recording_has_row_at(const recording *r, double time);

// Publishes how far the run is to observers: all rows and events counted there are
// complete.
void recording_publish(const recording *r, double time);

// Sets a parameter at an instant [s], which the rig is told, too. On failure f says why:
// a lock that a law from outside does not know, a law that cannot be tuned.
status recording_set(recording *r, const action *todo, double time, fault *f)
    __attribute__((warn_unused_result));

// Adds a row, which may stand in its place of the trace already, with all angles [rad]
// and velocities [rad/s], lets it be seen and hands it to whoever takes rows. On the rig,
// whose clock and the grid round differently, rows of one instant have one time.
// STATUS_NO_MEMORY, or what the taker says.
status recording_add_row(recording *r, const sample *row, const double *angles,
                         const double *velocities) __attribute__((warn_unused_result));

// Fills in steady force, overshoot and settling time; force_integral is that of the force
// over the last STEADY_WINDOW of the run [N s].
void recording_finish_summary(recording *r, double force_integral);

// --- what begins and ends every run ----------------------------------------------------

// Begins to record a run of the scenario into result: an empty summary, and the rig if a
// law is chosen or given. f holds no fault or why it cannot begin; STATUS_STOPPED where
// it is to end already and no monitor looks on. recording_end is due in any case.
status recording_begin(recording *r, const scenario *s, const run_options *options,
                       run_result *result, fault *f);

// Ends it: the rig is gone, and the summary says what stopped the run and what time it
// took.
void recording_end(recording *r, status code, const fault *f);

// Writes into the summary what stopped the run.
void recording_tell_fault(summary *s, status code, const fault *f);

// --- the rig in a run, in every row and in the summary ---------------------------------

// Copies what rows show of the rig into a row; NaN without a rig or before its first
// sample.
void recording_add_rig_signals(const recording *r, sample *row);

// Whether the rig has taken a sample that rows do not show yet; and lets them show it
// from here on.
bool recording_has_new_sample(const recording *r);
void recording_show_sample(recording *r);

// The rig's present command takes effect at `time` [s], with the hub at hub_angle [rad].
// Adds to the summary the electrical energy that the amplifier supplied under the command
// before.
void recording_change_command(recording *r, double time, double hub_angle);

// A parameter is about to change at `time` [s], with the hub at hub_angle [rad]. If it is
// the voltage limit, adds to the summary the energy supplied under the limit before.
void recording_before_change(recording *r, const action *todo, double time,
                             double hub_angle);

// Fills in what the summary says of the rig; the hub is at the given angle at the end
// [rad].
void recording_finish_rig_summary(recording *r, double hub_angle);
