// A run in progress, whichever model it is of, and how it is driven:
//
//     driver_open -> driver_advance, to one instant after the other -> driver_close
#pragma once

#include "src/run/arm_run.h"
#include "src/run/printed_run.h"
#include "src/run/run_model.h"

typedef struct run_driver {
    recording recording;
    const run_model *model; // of its arm; NULL: it has not begun
    union {
        arm_run corrected;
        printed_run printed;
    } run; // the model's
} run_driver;

// Begins a run of the scenario into result. Whatever it returns, with f saying why,
// driver_close is due, where d, s, options and result still are.
status driver_open(run_driver *d, const scenario *s, const run_options *options,
                   run_result *result, fault *f);

// Sums up what has been recorded (`failed` and f are what ended it) and frees the run.
void driver_close(run_driver *d, status failed, const fault *f);

// Continues to an instant [s], by phases: what is due of script and rig, then one step of
// the motion with its rows and the event at its end. A step can be cut at any instant,
// but for the printed arm, which continues to the first row there or later.
// STATUS_STOPPED where it is to end; one that is stepped can go on from there. What is
// due at the instant itself happens when the run continues from it. *ended becomes true
// where the run is complete; HUGE_VAL: up to there.
status driver_advance(run_driver *d, double until, bool *ended, fault *f);

// The first of the phases alone: *ended is true if the run is complete.
status driver_prepare_step(run_driver *d, bool *ended, fault *f);

// Carries out now an action that belongs to no script; a push only of a model that takes
// them.
status driver_act(run_driver *d, const action *todo, fault *f);

// The summary as if the run ended here; `failed` and f say why it did not come to its
// end.
summary driver_summary(run_driver *d, status failed, const fault *f);

double driver_time(const run_driver *d);    // where it is [s]
sensed_motion driver_sensed(run_driver *d); // what the sensors are fixed to
sample driver_row(const run_driver *d);     // the present state

// Angles of all degrees of freedom [rad], then their velocities [rad/s], in place.
const double *driver_state(const run_driver *d, int *angle_count);

// The whole state as bytes, for drivers of the same scenario, program and machine: all
// but the rows themselves, of which those that are later than a state are dropped.
size_t driver_saved_size(const run_driver *d);
void driver_save(const run_driver *d, void *bytes);
void driver_restore(run_driver *d, const void *bytes);
