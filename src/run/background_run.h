// A run that is being computed by a thread of its own, and can be looked at meanwhile.
#pragma once

#include <signal.h>

#include "src/run/run.h"

typedef struct background_run background_run;

typedef struct background_options {
    size_t rows_expected;
    bool at_once; // the run is over when background_run_start returns
} background_options;

// Starts the run of a scenario, whose actions and texts must outlive it; its rows never
// move in memory. *begun is a result prepared by run_resume, which this takes over; NULL:
// from the start. If no thread can be started, the run is complete when this returns.
// NULL without memory; then
// *begun remains the caller's.
background_run *background_run_start(const scenario *s, const background_options *how,
                                     run_result *begun);

// Waits until the run is over, but not longer than `seconds`; true if it is over.
bool background_run_wait(background_run *c, double seconds);

// Points *view at the rows and events computed so far, without a copy; its summary is
// left alone. Returns how many rows there are. The view owns nothing and is good until
// background_run_finish.
size_t background_run_look(background_run *c, run_result *view);

// Asks the run to end; it is over as soon as it sees that.
void background_run_stop(background_run *c);

// Waits for the run's end, gives its result away and frees the rest.
run_result background_run_finish(background_run *c);

// Signals and the threads that work for another one: those for the program as a whole go
// to the thread that waits for them, those that a crash raises stay where it happens.

// Blocks all signals for the calling thread, and for threads that it starts from now on,
// but those that a crash raises: blocked, these would end the program without its
// handlers. *before takes the mask of before for pthread_sigmask(SIG_SETMASK, before,
// NULL); NULL where it is not wanted.
void worker_signals_block(sigset_t *before);
