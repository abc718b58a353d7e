// A step of a run of the corrected arm, from where it is begun to what comes of its end. In flight
// under a rig it continues beyond samples that change nothing and beyond instants at which a
// program stops: both read the state within the step, so the run is the same wherever it is
// stopped.
#pragma once

#include "src/run/corrected_run.h"

// Looks how far the next step goes (motion_look_ahead), in flight beyond the instants of samples:
// it is under way then. Of an arm that a dense engine moves and nothing holds still.
void corrected_begin_step(corrected_run *c);

// Goes on by one stride, recorded with the event at its end: to the end of the stretch or, cut
// there, to `until` [s] at the most. What fails is explained in f.
status corrected_stride(corrected_run *c, double until, fault *f)
    __attribute__((warn_unused_result));

// Ends the step under way, if there is one, at the instant that the run has come to.
status corrected_end_step(corrected_run *c, fault *f) __attribute__((warn_unused_result));

// The present state, as good as the next call of any function here or of the motion.
double *corrected_present(const corrected_run *c);

// What the sensors are fixed to at present.
sensed_motion corrected_sensed_now(const corrected_run *c);

// Advice to the user where the energy balance does not close: dense engines choose their strides
// themselves.
const char *corrected_advice(const motion *m);
