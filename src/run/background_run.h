// A run that is being computed by a thread of its own, and can be looked at meanwhile.
#pragma once

#include "src/run/run.h"

typedef struct computation computation;

// Starts the run of a scenario, whose actions and texts must outlive it, with rows that stay where
// they are. *begun: what run_take_up prepared if `take_up`, taken over; else not looked at. Rows at
// the beginning that are those of `like` (NULL: of no other run) are kept once in the end. With
// `at_once`, or where there is no thread to be had, the run is over when this returns. NULL without
// memory; then *begun is the caller's.
computation *computation_start(const scenario *s, size_t rows_expected, bool take_up,
                               run_result *begun, const run_result *like, bool at_once);

// Waits until the run is over, but not longer than `seconds`; true if it is over.
bool computation_wait(computation *c, double seconds);

// Lets *view have the rows and events computed so far, in their places; its summary is left alone.
// Returns how many rows there are. The view owns nothing and is good until computation_finish.
size_t computation_look(computation *c, run_result *view);

// How far the run has come [s].
double computation_time(computation *c);

// Asks the run to end; it is over as soon as it sees that.
void computation_stop(computation *c);

// Waits for the run's end, gives its result away and frees the rest.
run_result computation_finish(computation *c);
