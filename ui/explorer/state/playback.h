// How fast the cursor moves over the run while it plays.
#pragma once

#include <stdbool.h>

#include "src/run/trace.h"

#define USUAL_SLOW 8.0 // the same as in films

typedef struct playback {
    bool playing;
    double speed;    // set: simulated seconds per second
    double measured; // measured recently; 0 if not known
    double slow;     // factor by which it is slower near impacts, from 1
    double slowed;   // the present factor
} playback;

// Records that `simulated` seconds passed in `seconds` of the clock (above 0).
void playback_measure(playback *p, double simulated, double seconds);

// How many times slower the run is to be shown at an instant [s], 1 to p->slow: near impacts that
// follow an interval without any, as in films. `duration` [s] is that of the whole run.
double playback_slowness(const playback *p, const trace *t, double duration, double time);

// The next faster (direction 1) or slower (-1) of the usual speeds; the present one at an end.
double playback_next_speed(const playback *p, int direction);
