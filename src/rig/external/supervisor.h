// Programs that are started and leave nothing behind.
//
// Between the lab and the program stands a supervisor, a process of its own. When the lab
// closes its end of the program's input, or is gone, the supervisor kills the program's
// process group and waits for all of it. A process that leaves the group (setsid) is no
// longer the program's.
#pragma once

#include <sys/types.h>

typedef struct supervised_program {
    pid_t supervisor; // 0: nothing runs
    int input;        // a socket to its standard input, whose closing ends the program
    int output;       // its standard output, whose reading does not block
    int errors;       // its standard error, a file in memory that grows with it
} supervised_program;

// Starts `command` by /bin/sh in a process group of its own, without a terminal. 0, or
// what went wrong (errno).
int supervised_program_start(supervised_program *program, const char *command);

// Closes its streams and waits until all processes of the program have ended. Returns the
// exit status of the program itself if it had ended before (128 + the signal's number
// where one ended it), -1 if it had to be killed.
int supervised_program_end(supervised_program *program);
