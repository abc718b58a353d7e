// Progress of long work on the terminal, and its orderly end by an interrupt.
#pragma once

#include "src/run/run.h"
#include "ui/commands/command.h"

// Work of `total` pieces ("runs", "presses") begins. The returned monitor is passed to the runs and
// counts the pieces that are done (run_monitor_count). If standard error is a terminal and --quiet
// was not given, work of more than a second shows its progress there. An interrupt (^C) sets
// `stop`; a second one ends the program. To be ended with work_end; only one work at a time.
run_monitor *work_begin(const arguments *a, const char *pieces, int total);
void work_end(void);

// As run_scenario_with, with progress shown. An interrupt ends the run: STATUS_STOPPED, with what
// was computed until then.
status run_with_progress(const arguments *a, const scenario *s, bool keep_trace,
                         run_result *result);

// Reports that `done` of `total` pieces were done when the work was stopped, and what happened to
// them. Then ends the program by the signal itself, after all output is written, so that the
// calling program sees it (a shell: status 130).
_Noreturn void work_leave(int done, int total, const char *pieces, const char *what_became);

// Ends the program by the interrupt.
_Noreturn void leave_interrupted(void);
