// Signals and the threads that work for another one: those for the program as a whole go to the
// thread that waits for them, those that a crash raises stay where it happens.
#pragma once

#include <signal.h>

// Blocks all signals for the calling thread, and for threads that it starts from now on, but those
// that a crash raises: blocked, these would end the program without its handlers. *before takes the
// mask of before for pthread_sigmask(SIG_SETMASK, before, NULL); NULL where it is not wanted.
void worker_signals_block(sigset_t *before);
