// A run of the printed arm, whose rows are the ends of its steps.
#pragma once

#include "src/run/recording.h"
#include "src/thesis/printed_algorithm.h"

// A run of the printed arm in progress.
typedef struct printed_run {
    recording *recording;
    printed_motion motion; // with the command in force
    sensed_motion sensed;  // what the sensors were fixed to at the last row
    bool begun;            // there is a row
    bool ready;            // script and rig have acted at the last row
    force_step last;       // the force over the step to the last row
    double steady_sum;     // of the forces in the window of the steady force [N]
    double steady_rows;    // number of rows in that sum
} printed_run;

// Step by step:
//
//     open -> (approach_step -> step) until it has ended or fails -> sum_up

// Begins a run and records its row of time 0. STATUS_NO_MEMORY, or STATUS_BAD_SCENARIO
// where the script pushes the arm, which the printed model does not know; f says why.
status printed_open(printed_run *p, recording *r, fault *f);

// Carries out what is due of script and rig, once for each row; *ended is true if the run
// is complete instead.
status printed_approach_step(printed_run *p, bool *ended, fault *f);

// One step, recorded.
status printed_step(printed_run *p, fault *f);

// Sets a parameter now and records that as action `index` of the script (-1: of no
// script); it takes effect with the coming step.
status printed_act(printed_run *p, const action *todo, int index, fault *f);

// The present state as a row.
sample printed_sample(const printed_run *p);

// Sums up what is known of the run, also of one that failed or has not come to its end
// (`failed` then says so). What it has recorded is then that of a run that ended here.
void printed_sum_up(printed_run *p, status failed);
