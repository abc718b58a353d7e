// How fast the cursor moves over the run while it plays.
#pragma once

#include <stdbool.h>

typedef struct playback {
    bool playing;
    double speed;    // wanted: simulated seconds per second
    double measured; // what came out of it lately; 0 if nothing is known
} playback;

// Takes note that `simulated` seconds passed in `seconds` of the clock (above 0).
void playback_measure(playback *p, double simulated, double seconds);

// The next faster (direction 1) or slower (-1) of the usual speeds; the present one at an end.
double playback_next_speed(const playback *p, int direction);
