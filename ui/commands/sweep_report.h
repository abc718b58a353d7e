// The results that impactlab sweep writes and prints.
#pragma once

#include "src/study/sweep_run.h"
#include "ui/commands/command.h"

// The options of the command line, checked.
typedef struct sweep_order {
    const arguments *arguments;
    const char *quantity; // key of the quantity that is drawn and summarised
    int jobs;             // runs at a time
    sweep_share share;    // of all runs
    sweep_request request;
    scenario scenario;
    sweep sweep;
} sweep_order;

// Writes the requested files from the store and prints the summary. If one file fails, the others
// are still written. Returns the exit status.
int report_sweep(const sweep_order *o, sweep_store *store, const sweep_progress *p);
