// How well control laws follow a set-point and a wall that move, over frequency: the
// force of runs in contact at the frequency of a sine of either.
#pragma once

#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

enum {
    FOLLOW_FREQUENCIES = 8,
    FOLLOW_LAWS = 6,
    FOLLOW_RUNS = 2 * FOLLOW_LAWS * FOLLOW_FREQUENCIES
};
extern const double follow_frequencies[FOLLOW_FREQUENCIES]; // [Hz]
extern const char *const follow_laws[FOLLOW_LAWS];

#define FOLLOW_WAVE 0.1  // amplitude of the set-point, a share of control.force
#define FOLLOW_WALL 5e-4 // of the wall [m]

// What became of one sine. NaN where the run was not made or ended early.
typedef struct follow_point {
    double frequency;   // [Hz]
    double gain, phase; // of the force over the set-point [-], [degrees]
    double error;       // |1 - gain exp(i phase)|: of the set-point's amplitude
    double shaken;      // amplitude of the force over that of the wall [N/m]
} follow_point;

typedef struct follow_study {
    int done; // runs, the first ones
    follow_point points[FOLLOW_LAWS][FOLLOW_FREQUENCIES];
    double later; // from a reading to the middle of its command's effect: half a period,
                  // the delay [s]
} follow_study;

// Runs the scenario under each law with a set-point of 1 + FOLLOW_WAVE sin(2 pi f t)
// times control.force, and with a wall that moves by FOLLOW_WALL sin(2 pi f t). A run
// that fails leaves NaN; STATUS_STOPPED if `monitor` (NULL: nobody looks on) asked for
// it, STATUS_BAD_SCENARIO for a scenario without a law, a force or a wall.
status follow_study_compute(const scenario *s, run_monitor *monitor, follow_study *study,
                            fault *f);
