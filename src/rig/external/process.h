// A program in any language as a controller: control.law = process, control.command.
//
// The program is started by a shell at the first sample and answers each line on its
// standard input by one line on its standard output, both JSON objects, in lock step with
// simulated time (docs/howto/controller.md). No answer is waited for longer than
// control.answer_time, nor after the run was asked to end, and no process of the
// program's group outlives the rig. A program cannot be taken back to an earlier sample:
// each run starts its own and asks it from the beginning.
#pragma once

#include "src/rig/controller.h"
#include "src/base/fault.h"
#include "src/base/stop.h"
#include "src/tables/parameters.h"

typedef struct process process;

// The controller that asks the program; it is given with a process as its context.
extern const controller process_law;

// A process that is yet to be started. `stop` says where its run is to end; it may be
// NULL. NULL without memory.
process *process_create(const control_parameters *control, stop_request *stop);

// Ends the program and everything it started that stays in its process group; p may be
// NULL.
void process_destroy(process *p);

// What the program is told of control.* from the next sample on.
void process_tell(process *p, const control_parameters *control);

// STATUS_OK as long as the program can be asked. STATUS_STOPPED where the run was asked
// to end before the program answered. Else STATUS_CONTROLLER_FAILED, or STATUS_NO_MEMORY
// where that is not the program's doing, and *why is a sentence that begins with "the
// process".
status process_failure(const process *p, const char **why);
