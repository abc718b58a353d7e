// A program in any language as a controller: control.law = process, control.command.
//
// The program is started by a shell and answers each line on its standard input by one
// line on its standard output, both JSON objects, in lock step with simulated time
// (docs/howto/controller.md). No answer is waited for longer than control.answer_time,
// nor after the run was asked to end, and no process of the program's group outlives the
// rig.
//
// With a transcript of recorded answers, the program is started only at the first
// question that the transcript does not hold, and all questions before it are repeated:
// the program must answer them as recorded, or the run fails with a sentence.
#pragma once

#include "src/tables/parameters.h"
#include "src/rig/controller.h"
#include "src/rig/external/process_lines.h"
#include "src/base/fault.h"
#include "src/base/stop.h"

typedef struct process process;

// The controller that asks the program; it is given with a process as its context.
extern const controller process_law;

// A process that is yet to be started, with a transcript of somebody else's or NULL.
// `stop` says where its run is to end; it may be NULL. NULL without memory.
process *process_create(const control_parameters *control, process_transcript *transcript,
                        stop_request *stop);

// Ends the program and everything it started that stays in its process group; p may be
// NULL.
void process_destroy(process *p);

// What the program is told of control.* from the next sample on; `memory` is the
// controller's.
void process_tell(void *memory, const control_parameters *control);

// STATUS_OK as long as the program can be asked. STATUS_STOPPED where the run was asked
// to end before the program answered. Else STATUS_CONTROLLER_FAILED, or STATUS_NO_MEMORY
// where that is not the program's doing, and *why is a sentence that begins with "the
// process".
status process_failure(const process *p, const char **why);

// A controller of one's own, from a shared object.

typedef struct plugin {
    void *library; // from dlopen; NULL if nothing is open
    const controller *law;
} plugin;

// Opens control.plugin = `file` and asks it for its controller. On failure f says why,
// nothing stays open and *p is empty: STATUS_CANNOT_READ where the file cannot be loaded,
// STATUS_BAD_SCENARIO where it exports no controller, or one of another interface.
status plugin_open(plugin *p, const char *file, fault *f);

// Closes it; its controller is gone. Nothing happens to an empty one.
void plugin_close(plugin *p);

// A recorded command as a controller: control.law = playback.
//
// The command at t is what the column of the file has at t - control.playback_shift: that
// of the last row not later (hold), or straight between rows (linear). Before the first
// row it is that of the first, after the last row that of the last. Like any command it
// is sampled at control.rate, goes through the D/A converter and takes effect after the
// delay.

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
status playback_open(played_command *p, const control_parameters *control, fault *f);
void playback_close(played_command *p); // one of zeroes is allowed
