// Many runs at once, summaries only: what Monte Carlo studies and tuning are made of.
#pragma once

#include "src/run/run.h"

// Makes scenario number i; called from several threads, each with its own `made` (filled with the
// scenario of the call before by the same thread, at first with zeros), so that it may change no
// more than what differs.
typedef void (*batch_maker)(void *context, size_t i, scenario *made);

// Runs scenarios 0 ... count - 1 on `jobs` threads (as many as can be started, of 1 to
// POOL_MOST_THREADS) and writes summaries[count]. Each summary is the same to the last bit as that
// of a single run_scenario, whatever the number of threads; a run that fails says so in its own
// summary. STATUS_NO_MEMORY if there is no room for the threads' results.
status batch_run(batch_maker make, void *context, size_t count, int jobs, summary *summaries);
