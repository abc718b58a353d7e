// How fast the cursor moves over the run while it plays.
#pragma once

#include <stdbool.h>

#include "src/run/trace.h"

#define USUAL_SLOW 8.0 // as films have it

typedef struct playback {
    bool playing;
    double speed;    // wanted: simulated seconds per second
    double measured; // what came out of it lately; 0 if nothing is known
    double slow;     // how much slower it is round impacts; 1: no slower
    double slowed;   // how much slower it is now
} playback;

// Takes note that `simulated` seconds passed in `seconds` of the clock (above 0).
void playback_measure(playback *p, double simulated, double seconds);

// How many times slower the run is to be shown at an instant [s], 1 to p->slow: round the impacts
// that come after a while without any, as films have it. `duration` [s] is that of the whole run.
double playback_slowness(const playback *p, const trace *t, double duration, double time);

// The next faster (direction 1) or slower (-1) of the usual speeds; the present one at an end.
double playback_next_speed(const playback *p, int direction);
