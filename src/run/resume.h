// Runs that reuse the beginning of another run, and runs that share equal rows in memory.
#pragma once

#include "src/run/recording.h"
#include "src/run/run_result.h"
#include "src/scenario/scenario.h"
#include "src/contact/motion.h"

// Checkpoints of a run of the corrected arm: what is needed to continue from an instant
// as if the run had never stopped, kept every few hundred rows.

// An element of run_history.checkpoints; its size there includes the motion's state.
typedef struct checkpoint {
    double time;                      // [s]
    size_t rows, events, force_steps; // recorded until then
    recording_state recording;
    summary summary;
    // of the motion
    double motion[]; // motion_saved_size bytes
} checkpoint;

// Prepares the history of a run that keeps one (options.rows_expected, and no rig), or
// else one of the forces alone. STATUS_NO_MEMORY, with a sentence in f.
status checkpoint_open_history(recording *r, const motion *m, fault *f);

// Keeps the state at the beginning of a step, if the last checkpoint is some rows ago.
// Does nothing right after an event (the last one was at last_event [s]), because a
// checkpoint does not contain the count of simultaneous events. False without memory.
bool checkpoint_keep(recording *r, const motion *m, double last_event);

// Goes back to the last checkpoint of a result that run_resume has prepared.
void checkpoint_restore(recording *r, arm *a, motion *m);

// --- runs that begin with the rows of another ------------------------------------------

// Lets `result` begin with what `from`, a run of the scenario `old`, has in common with a
// run of `s`, up to the last checkpoint before they differ: without a copy and to the
// last bit. False if there is nothing in common or no memory; then `result` is empty and
// the run begins at the start. Only runs of the corrected model without a controller have
// checkpoints.
bool run_resume(const run_result *from, const scenario *old, const scenario *s,
                size_t rows_expected, run_result *result);

// A second result of the same run that shares all rows. STATUS_NO_MEMORY if there is no
// room.
status run_share(const run_result *from, run_result *result);
