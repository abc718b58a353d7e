// A run of the printed arm, whose rows are the ends of its steps.
#pragma once

#include "src/run/recording.h"
#include "src/run/run_model.h"
#include "src/thesis/printed_algorithm.h"

// A run of the printed arm in progress; src/run/printed_run.c alone writes it.
typedef struct printed_run {
    recording *recording;
    printed_motion motion; // with the command in force
    sensed_motion sensed;  // what the sensors were fixed to at the last row
    bool begun;            // there is a row
    bool ready;            // script and rig have acted at the last row
    bool in_contact;       // at the last row
    bool separated;        // gap above SEPARATION_GAP since the last contact
    force_step last;       // the force over the step to the last row
    double steady_sum;     // of the forces in the window of the steady force [N]
    double steady_rows;    // number of rows in that sum
} printed_run;

// The printed model as the driver knows it. It takes no pushes, and a script with one is
// refused with STATUS_BAD_SCENARIO.
extern const run_model printed_model;
