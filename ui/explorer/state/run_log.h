// The log of a run: its events together with the controller's changes of mode, in the order of
// time.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/rig/rig.h"
#include "src/run/trace.h"

typedef struct log_entry {
    double time; // [s]
    int event;   // index in the trace, -1 for a change of mode
    double mode; // the mode entered
} log_entry;

typedef struct run_log {
    unsigned long run; // the run of the log; 0: none
    log_entry *entries;
    size_t count, capacity;
    size_t rows, events; // already included
    double mode;         // at the last row, NaN before the first
} run_log;

// Adds the entries of new rows and events since the last call. `complete`: the run has ended.
void run_log_update(run_log *log, unsigned long run, const trace *t, bool complete);

// The instant of the next entry after a time (direction 1) or the last one before it (-1) [s];
// negative if there is none.
double run_log_next(const run_log *log, double time, int direction);

void run_log_forget(run_log *log);

// --- modes of the control law -----------------------------------------------------------------

enum { LAW_MODES = 12 };

typedef struct law_modes {
    unsigned long run; // the run of the law; 0: none
    int count;
    bool lockable; // the law can be held in one of them
    char names[LAW_MODES][MODE_NAME_SIZE];
} law_modes;

// The name of a mode; "mode N" if the law gives none.
void law_mode_name(const law_modes *m, double mode, char *text, size_t size);
