// A program in any language as a controller: control.law = process, control.command.
//
// The program is started by a shell and answers each line on its standard input by one line on its
// standard output, both JSON objects, in lock step with simulated time (docs/library.md). Nothing
// waits longer for it than control.answer_time, and nothing of it outlives the rig.
#pragma once

#include "src/quantities/parameters.h"
#include "src/rig/controller.h"

typedef struct process process;

// The controller that asks the program; it is given with a process as its context.
extern const controller process_law;

// A process that is yet to be started; NULL without memory.
process *process_create(const control_parameters *control);

// Ends the program and everything it started, however it goes about it; p may be NULL.
void process_destroy(process *p);

// What the program is told of control.* from the next sample on.
void process_tell(process *p, const control_parameters *control);

// Why the program can no longer be asked, a sentence; NULL as long as it can.
const char *process_failure(const process *p);
