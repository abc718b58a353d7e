// What the two kinds of run share while they are in progress: the rows, the forces of all steps,
// the rig, and the summary that comes of them.
#pragma once

#include "src/run/checkpoint.h"
#include "src/rig/rig.h"
#include "src/solve/motion.h"

#define SEPARATION_GAP 1e-6 // a smaller gap is no separation [m]

// What a run in progress remembers besides the rows.
typedef struct recording {
    const scenario *scenario;
    run_result *result;
    run_options options;
    bool keep_trace;
    bool keeps_history; // and not only what is needed until the end
    parameters now;     // parameters as changed by the script so far
    int next_action;
    shared_array own_steps; // where the next lies unless it is in the history
    force_step *steps;      // the force all along
    size_t count, capacity;
    double integral_at_window; // of the force, where the steady force's window begins [N s]
    long grid_row;             // number of the next row of the grid
    bool separated;            // gap above SEPARATION_GAP in the present flight
    bool pulse_open;           // the first pulse has not ended
    rig *rig;                  // NULL for the bare arm
    double command_time, command_angle; // when and where the present command took effect [s], [rad]
    sensed_motion after_step;           // printed model: what the sensors see
    fault *rig_fault;                   // printed model: where the rig's fault goes
    status rig_status;
} recording;

// Keeps the force over a step. STATUS_NO_MEMORY.
status recording_add_step(recording *r, force_step step);

// Whether whoever watches the run wants it to stop.
bool recording_asked_to_stop(const recording *r);

// Tells those who look on how far the run is: what they count is complete.
void recording_publish(const recording *r, double time);

// Adds a row with all angles [rad] and velocities [rad/s] and lets it be seen. STATUS_NO_MEMORY.
status recording_add_row(recording *r, const sample *row, const double *angles,
                         const double *velocities);

// Sets up an empty trace of the kind that is asked for. STATUS_NO_MEMORY, with a sentence in f.
status recording_open_trace(recording *r, int angle_count, fault *f);

// Copies what the rig knows into a row.
void recording_add_rig_signals(const recording *r, sample *row);

// Books what the amplifier fed in since the present command took effect: the integral of
// V (V - kB w) / Ra with the motor's voltage V constant.
void recording_book_electrical_energy(recording *r, double time, double hub_angle);

// Sets up the rig, if the scenario has a control law; until its first command the motor rests.
status recording_start_rig(recording *r, fault *f);

// Fills in what the summary says of the rig; the hub is at the given angle at the end [rad].
void recording_finish_rig_summary(recording *r, double hub_angle);

// Fills in steady force, overshoot and settling time; force_integral is that of the force over the
// last STEADY_WINDOW of the run [N s].
void recording_finish_summary(recording *r, double force_integral);

// --- checkpoints: checkpoint.c

// Prepares the history of a run that keeps one. STATUS_NO_MEMORY, with a sentence in f.
status recording_open_history(recording *r, const motion *m, fault *f);

// Keeps the state at the beginning of a step, if the last time is some rows ago. Not right after
// an event: how many come at once is not part of a checkpoint. False without memory.
bool recording_checkpoint(recording *r, const motion *m, double last_event);

// Goes back to the last checkpoint of a result that run_resume has prepared.
void recording_resume(recording *r, arm *a, motion *m);

// --- the two kinds of run: run_corrected.c, run_printed.c

// Run to the end, or as far as possible; f says why it ended early.
status run_corrected(recording *r, fault *f);
status run_printed(recording *r, fault *f);
