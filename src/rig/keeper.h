// Programs that are started and leave nothing behind.
//
// Between the lab and the program stands a keeper, a process of its own that adopts what the
// program leaves orphaned. When the lab hangs up, or is gone, the keeper kills everything it has.
#pragma once

#include <sys/types.h>

typedef struct kept_program {
    pid_t keeper; // 0: nothing runs
    int lifeline; // closing it ends the program
    int input;    // a socket to its standard input
    int output;   // its standard output, read without blocking
    int errors;   // its standard error, likewise
} kept_program;

// Starts `command` by /bin/sh in a session of its own. 0, or what went wrong (errno).
int kept_program_start(kept_program *program, const char *command);

// Closes the lifeline, kills all processes that are left and waits until they have ended. Returns
// the exit status of the program itself if it had ended before (128 + the signal's number where one
// ended it), -1 if it had to be killed.
int kept_program_end(kept_program *program);
