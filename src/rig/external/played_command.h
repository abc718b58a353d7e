// A recorded command as a controller: control.law = playback.
//
// The command at t is what the column of the file has at t - control.playback_shift: that
// of the last row not later (hold), or straight between rows (linear). Before the first
// row it is that of the first, after the last row that of the last. Like any command it
// is sampled at control.rate, goes through the D/A converter and takes effect after the
// delay.
#pragma once

#include "src/rig/controller.h"
#include "src/base/fault.h"
#include "src/tables/parameters.h"

typedef struct played_command {
    double *times;   // of the rows [s]; NULL if nothing is recorded
    double *command; // [V]
    size_t rows;
    double shift; // by which it comes later than recorded [s]
    bool linear;
} played_command;

// The controller that plays it; it is given with a recorded command as its context.
extern const controller playback_law;

// Reads the file, whose times [s] are the column `t` or `time`. STATUS_BAD_SCENARIO, with
// a sentence that says where in the file, or STATUS_NO_MEMORY; there is nothing to be
// closed then.
status played_command_open(played_command *p, const control_parameters *control,
                           fault *f);
void played_command_close(played_command *p); // one of zeroes is allowed
