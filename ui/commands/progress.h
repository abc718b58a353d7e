// Long work: its progress on the terminal, its orderly end by an interrupt; the options
// of many runs.
#pragma once

#include <math.h>

#include "src/run/run.h"
#include "src/study/sweep_run.h"
#include "ui/commands/interrupts.h"
#include "ui/commands/messages.h"
#include "ui/commands/results.h"

// --- runs and pieces -------------------------------------------------------------------

// Work of `total` pieces ("runs", "presses") begins. The returned monitor is passed to
// the runs and counts the pieces that are done (run_monitor_count). If standard error is
// a terminal and --quiet was not given, work of more than a second shows its progress
// there. An interrupt (^C) sets `stop`. To be ended with work_end or work_finish; only
// one work at a time.
run_monitor *work_begin(const arguments *a, const char *pieces, int total);
void work_end(void);

// Ends the work that came to `code`, with f if it failed, and writes the results of what
// it found: those of a whole one, or, after an interrupt, those of what was done, and
// says what these are. Returns the exit status.
int work_finish(const arguments *a, status code, const fault *f, const command_results *r,
                const void *found);

// As run_scenario_with, with progress shown; the options have no monitor yet. An
// interrupt ends the run: STATUS_STOPPED, with what was computed until then.
status run_with_progress(const arguments *a, const scenario *s, run_options options,
                         run_result *result);

// Says how far a run came that was stopped, and what became of it. Returns the exit
// status.
int run_stopped(const scenario *s, const char *what_became);

// --- many runs -------------------------------------------------------------------------
// Shared by the commands that make them: options, ^C and the progress line.

// The number of threads: --jobs, or the number of processors.
int many_runs_jobs(const arguments *a);

// The options of many runs that begin: --jobs of them at a time; an interrupt stops them:
// the runs under way are finished, or abandoned after five seconds. On a terminal,
// without --quiet, a bar shows their progress, behind `word` (may be NULL). To be ended
// with many_runs_end.
sweep_options many_runs_begin(const arguments *a, const char *word);
void many_runs_end(const sweep_options *o);

// Prints how many of the newly computed runs failed, and why the first one did.
void many_runs_report_failure(const sweep_progress *p);

// After an interrupt: says how many runs there are, what became of them, and how to
// continue. `db`: file in which they are stored, or NULL. Returns the exit status.
int many_runs_stopped(const char *db, size_t done, size_t total, const char *what_became);

// Their common options, each with the command's own help text.
#define RUNS_OPTION(what)                                                                \
    OPTION(WHOLE, "runs", "N", what, PLACE(runs), .low = 1, .high = SWEEP_MOST_RUNS)
#define SEED_OPTION                                                                      \
    OPTION(WHOLE, "seed", "S", "start of the random numbers (0)", PLACE(seed),           \
           .high = HUGE_VAL)
#define JOBS_OPTION                                                                      \
    OPTION(WHOLE, "jobs", "J", "number of runs at a time (as many as processors)",       \
           PLACE(jobs), .low = 1, .high = SWEEP_MOST_JOBS)
#define DB_OPTION(what) OPTION(PLACE, "db", "FILE.sqlite", what, PLACE(db))
