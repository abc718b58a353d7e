// A run in progress that stops between its strides, whichever model it is of.
//
//     open -> (approach -> stride) until it has ended or fails -> close
#pragma once

#include "src/run/corrected.h"
#include "src/run/printed.h"

typedef struct stepped_run stepped_run;

// What the models do differently.
typedef struct stepped_model {
    bool stops_anywhere; // a stride can be cut at any instant; else it ends at a row's own time
    bool takes_pushes;

    // Begins a run. Whatever it returns, close is due.
    status (*open)(stepped_run *run, recording *r, fault *f);
    // Sums up what has been recorded (`failed` is what ended it) and frees the run; one that is all
    // zero but for its model was never opened.
    void (*close)(stepped_run *run, status failed);
    // The summary as if the run ended here; `failed` says why it did not come to its end.
    void (*sum_up)(stepped_run *run, status failed);

    double (*time)(const stepped_run *run); // where it is [s]
    bool (*at_end)(const stepped_run *run); // whether there is no stride left
    // Carries out what is due of script and rig; *ended is true if the run is complete instead.
    status (*approach)(stepped_run *run, bool *ended, fault *f);
    // One stride, recorded, up to an instant [s] where it can be cut.
    status (*stride)(stepped_run *run, double until, fault *f);
    // Carries out now an action that belongs to no script.
    status (*act)(stepped_run *run, const action *todo, fault *f);

    sensed_motion (*sensed)(stepped_run *run); // what the sensors are fixed to
    sample (*row)(stepped_run *run);           // the present state
    // Angles of all degrees of freedom [rad], then their velocities [rad/s], in place.
    const double *(*state)(const stepped_run *run, int *angle_count);

    // Everything except recording and rig as bytes; and back, after recording and rig were
    // restored.
    size_t (*saved_size)(const stepped_run *run);
    void (*save)(const stepped_run *run, void *bytes);
    void (*restore)(stepped_run *run, const void *bytes);
} stepped_model;

struct stepped_run {
    const stepped_model *model;
    union {
        corrected_run corrected;
        printed_run printed;
    };
};

// The one of a scenario's arm.model.
const stepped_model *stepped_model_of(const parameters *p);

// Runs to the end, or as far as possible, and sums up; f says why it ended early.
status stepped_run_whole(recording *r, fault *f);
