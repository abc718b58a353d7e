// Work that tells how far it is while one waits for it, and that an interrupt ends in order.
#pragma once

#include "src/run/run.h"
#include "ui/commands/command.h"

// Work of `total` pieces ("runs", "presses") begins. What is returned is given to the runs and
// counts the pieces that are over (run_monitor_count). Where standard error is a terminal and
// --quiet was not given, work of more than a second tells there how far it is. An interrupt (^C)
// sets `stop`; a second one ends the program. Ends with work_end; one work at a time.
run_monitor *work_begin(const arguments *a, const char *pieces, int total);
void work_end(void);

// As run_scenario_with; tells how far the run is, and ends at an interrupt with what it has until
// then: STATUS_STOPPED.
status run_with_progress(const arguments *a, const scenario *s, bool keep_trace,
                         run_result *result);

// Complains that `done` of `total` pieces were done when the work was stopped, and what became of
// them; then ends the program by the interrupt, after all that was written: so that who called it
// knows (a shell sees status 130).
_Noreturn void work_leave(int done, int total, const char *pieces, const char *what_became);

// Ends the program by the interrupt.
_Noreturn void leave_interrupted(void);
