// How ^C ends a command; tests/test_interrupts.sh tries it on each.
//
// From where long work begins, or results are written, until the command is over, ^C (or
// SIGTERM) ends no more than the work: what was computed is written (write_results), a
// sentence says what that is, and then the program ends by the signal, so that whoever
// called it sees it (a shell: status 130). Another ^C, a third of a second or more later,
// ends the program at once; one that follows sooner is the same again: timeout and some
// shells send it to the program and its group.
#pragma once

#include <signal.h>

#include "src/run/run_result.h"

// The signal that came, 0: none.
extern volatile sig_atomic_t interrupted;

// The monitor of the work in hand, which a signal stops.
extern run_monitor interrupts_monitor;

// Becomes true five seconds after the signal, for what may finish the runs in hand.
extern atomic_bool interrupts_abandon;

// Signals are caught from here on; where they are ignored they stay so.
void interrupts_catch(void);

// At the end of a command that came to `result` (its exit status): returns it, or ends
// the program by the signal that came. One that came too late to stop anything is said.
int interrupts_end(int result);
