// Programs that are started and leave nothing behind.
//
// Between the lab and the program stands a supervisor, a process of its own that adopts what the
// program leaves orphaned. When the lab hangs up, or is gone, the supervisor kills everything it
// has.
#pragma once

#include <sys/types.h>

typedef struct supervised_program {
    pid_t supervisor; // 0: nothing runs
    int death_pipe;   // closing it ends the program
    int input;        // a socket to its standard input
    int output;       // its standard output, read without blocking
    int errors;       // its standard error, likewise
} supervised_program;

// Starts `command` by /bin/sh in a session of its own. 0, or what went wrong (errno).
int supervised_program_start(supervised_program *program, const char *command);

// Closes the death pipe, kills all processes that are left and waits until they have ended. Returns
// the exit status of the program itself if it had ended before (128 + the signal's number where one
// ended it), -1 if it had to be killed.
int supervised_program_end(supervised_program *program);
