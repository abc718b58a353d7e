// Statistics of a signal between two instants of a run.
#pragma once

#include "src/run/trace.h"

typedef struct signal_statistics {
    double minimum, maximum; // in the signal's unit
    double mean;             // over time
    double rms;              // square root of the mean square over time
    double integral;         // over time [unit s]; a force's is its momentum, impulses excluded
    double duration;         // for which it had a value [s]
} signal_statistics;

// Of a signal from one instant to a later one [s], straight between rows, both kept within the run.
// All NaN where it never has a value.
signal_statistics trace_statistics(const trace *t, int signal, double from, double to);
