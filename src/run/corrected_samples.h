// Samples of the rig that find the arm in flight: they are taken while its step goes on, which ends
// at one only where the controller changes something. Most of them change nothing.
#pragma once

#include "src/run/corrected_rows.h"

// Looks how far the next step goes (motion_look_ahead), in flight beyond the instants of samples.
// Of an arm that a dense engine moves and nothing holds still.
void corrected_look_ahead(corrected_run *c);

// What the last of a step's samples came to.
typedef struct flight_samples {
    bool changed;  // another command or mode
    status failed; // as rig_act says
} flight_samples;

// Takes the samples within the step that is to be made next, and records the rows up to them; where
// one changes something or fails, the step is to end there. c->stop becomes the next instant to
// stop at, or that one. What else fails has a code only: a row that cannot be had or kept,
// STATUS_STOPPED.
status corrected_sample_flight(corrected_run *c, flight_samples *met, fault *f);
