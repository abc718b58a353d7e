// A run of the corrected arm, stride by stride:
//
//     open -> (approach_stride -> corrected_stride) until it has ended or fails -> close
//
// so that several can go side by side (src/run/run.c), and programs step them (src/run/loop.h).
#pragma once

#include "src/run/corrected_step.h"

// Begins a run, or takes one up, in the storage of a motion that is over (`spare`, which may be
// NULL and is used up). Whatever it returns, corrected_close or corrected_finish is due.
status corrected_open(corrected_run *c, recording *r, motion *spare, fault *f);

// Carries out what is due of script and rig until the next thing to do is a stride, to c->stop at
// most; *ended is true if the run is complete instead.
status corrected_approach_stride(corrected_run *c, bool *ended, fault *f);

// Sums up what is known of a run that has not come to its end (`failed` says if it failed) and that
// afterwards continues unchanged; the caller has to save and restore rows, events and
// recording.state.
void corrected_sum_up(corrected_run *c, status failed);

// Sums the run up and frees it; `failed` is what ended it.
void corrected_close(corrected_run *c, status failed);

// The same, but for its motion's storage, which it returns: NULL if there is none.
motion *corrected_finish(corrected_run *c, status failed);
