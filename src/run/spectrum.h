// The amplitudes of a signal over frequency, in a stretch of a run.
#pragma once

#include "src/run/trace.h"

enum { SPECTRUM_LINES = 512 };

typedef struct trace_spectrum {
    double amplitude[SPECTRUM_LINES]; // of line k, the frequency k times `step`
    double step;                      // [Hz]
    int lines;     // from 1 on, that hold nearly all there is, and a few more
    int highest;   // the line with the highest amplitude, 0 if all are 0
    bool constant; // but for rounding: there are no amplitudes to show
} trace_spectrum;

// Takes the spectrum of a signal, recorded or derived, between two instants of a run [s],
// of which the first comes before the second: straight between rows, what has no value
// counts as 0, by fourier_amplitudes.
void trace_spectrum_take(const trace *t, int signal, double from, double to,
                         trace_spectrum *out);
