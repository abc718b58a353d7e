// Shared by the commands that make many runs: options, ^C and the progress line.
#pragma once

#include <math.h>
#include <signal.h>

#include "src/study/sweep_run.h"
#include "ui/commands/command.h"

// The number of threads: --jobs, or the number of processors.
int many_runs_jobs(const arguments *a);

// Whether this process only computes runs for rank 0, which stores and reports them.
bool many_runs_only_computes(const arguments *a);

// From now on SIGINT and SIGTERM stop the sweeps of these options: the runs under way are finished,
// or abandoned after five seconds. A second signal, a second or more later, ends the program.
void many_runs_catch_signals(sweep_options *o);

// Whether to show progress: on a terminal, without --quiet.
bool many_runs_shows_progress(const arguments *a);

// A sweep_options.report: the progress bar, a line on the terminal that is overwritten. `context`
// is a word printed before it (const char *), or NULL.
void many_runs_progress(void *context, const sweep_progress *p);
void many_runs_clear_progress(void);

// Prints how many of the newly computed runs failed, and why the first one did.
void many_runs_tell_failure(const sweep_progress *p);

// After a signal: prints how many runs there are and how to continue. `db`: file in which they are
// stored, or NULL. Returns the exit status, 130 after ^C.
int many_runs_stopped(const char *db, size_t done, size_t total);

// Their common options, each with the command's own help text.
#define RUNS_OPTION(what)                                                                          \
    {                                                                                              \
        .name = "runs", .type = OPTION_WHOLE, .value = "N", .help = (what), PLACE(runs), .low = 1, \
        .high = SWEEP_MOST_RUNS                                                                    \
    }
#define SEED_OPTION                                                                                \
    {                                                                                              \
        .name = "seed", .type = OPTION_WHOLE, .value = "S",                                        \
        .help = "start of the random numbers (0)", PLACE(seed), .high = HUGE_VAL                   \
    }
#define JOBS_OPTION                                                                                \
    {                                                                                              \
        .name = "jobs", .type = OPTION_WHOLE, .value = "J",                                        \
        .help = "number of runs at a time (as many as processors)", PLACE(jobs), .low = 1,         \
        .high = SWEEP_MOST_JOBS                                                                    \
    }
#define DB_OPTION(what)                                                                            \
    {                                                                                              \
        .name = "db", .type = OPTION_PLACE, .value = "FILE.sqlite", .help = (what), PLACE(db)      \
    }
