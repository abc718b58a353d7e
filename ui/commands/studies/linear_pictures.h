// Pictures of linear: Bode, Nyquist and the map of stability.
#pragma once

#include "src/study/linear/linear.h"
#include "ui/commands/command.h"

// Gain and phase over frequency to --plot, of curves with names; each returns the exit status.
typedef struct linear_curve {
    const char *name;
    const linear_response *response;
} linear_curve;
int plot_bode(const arguments *a, const scenario *s, const linear_curve *curves, int count);

// linear --vary: poles and runs over parameters. Returns the exit status.
int survey_stability(const arguments *a, const scenario *s, linear_place place, const char *name);

// The loop gain in the plane, to --nyquist.
int plot_nyquist(const arguments *a, const scenario *s, const linear_response *loop);

// Growth of the linear loop and settling time of runs over one or two parameters, to --plot.
int plot_stability(const arguments *a, const sweep *s, const double *growth,
                   const double *settling);
