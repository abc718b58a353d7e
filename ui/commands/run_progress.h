// A run that tells how far it is while one waits for it.
#pragma once

#include "src/run/run.h"

// As run_scenario. Where standard error is a terminal, a run of more than a second tells there how
// far it is, and an interrupt (^C) ends it with what it has until then: STATUS_STOPPED. A second
// one ends the program.
status run_with_progress(const scenario *s, bool keep_trace, run_result *result);

// Ends the program by the interrupt that stopped a run, after what it had was written: so that who
// called the program knows.
void run_progress_leave(void);
