// A recorded command as a controller: control.law = playback.
//
// A row's command, at the row's time + control.playback_shift, goes to the nearest
// sample, of rows closer together than samples the nearest to each; it holds until the
// next one, or goes straight to that (linear). Before the first row the command is that
// of the first, after the last row that of the last. Where the recording's samples came
// at the rig's rate, or whole numbers of them to a sample, its clock's error of up to 0.1
// % is corrected: the rows are the samples. Like any command it is sampled at
// control.rate, goes through the D/A converter and takes effect after the delay.
#pragma once

#include "src/base/csv_table.h"
#include "src/base/fault.h"
#include "src/rig/controller.h"
#include "src/tables/parameters.h"

typedef struct played_command {
    double *times;   // of the rows [s]; NULL if nothing is recorded
    double *command; // [V]
    size_t rows;
    double shift; // by which it comes later than recorded [s]
    double ahead; // how far behind a sample a row may lie that goes to it [s]
    bool linear;
    char told[CSV_TOLD]; // what a person should know of the file, "" if nothing
} played_command;

// The controller that plays it; it is given with a recorded command as its context.
extern const controller playback_law;

// Reads the file of control.playback_file. STATUS_BAD_SCENARIO, with a sentence that says
// where in the file, or STATUS_NO_MEMORY; there is nothing to be closed then.
status played_command_open(played_command *p, const parameters *known, fault *f);
void played_command_close(played_command *p); // one of zeroes is allowed
