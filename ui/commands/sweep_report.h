// What impactlab sweep writes and prints of its runs.
#pragma once

#include "src/study/sweep_run.h"
#include "ui/commands/command.h"

// What the command line asks for, read.
typedef struct sweep_order {
    const arguments *arguments;
    const char *quantity; // key of what is drawn and summed up
    int jobs;             // runs at a time
    sweep_share share;    // of all runs
    sweep_request request;
    scenario scenario;
    sweep sweep;
} sweep_order;

// Writes what was asked for, from the store, and prints the summary. One file that fails does not
// keep back the other. Returns the exit status.
int report_sweep(const sweep_order *o, sweep_store *store, const sweep_progress *p);
