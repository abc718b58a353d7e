// A step's force and what the sensors see of it, in pieces short enough for parabolas.
#pragma once

#include "src/run/corrected_run.h"

// What the sensors are fixed to, in a state of the motion.
sensed_motion corrected_sensed_motion(const corrected_run *c, double *state);

// The `way` for an instant [s], from the motion's state there.
way corrected_way_at(const corrected_run *c, double time, double *state);

// Into how many pieces the force over a step in contact of this length [s] is divided for
// recording.
int corrected_force_pieces(const corrected_run *c, double length);

// Lets the sensors follow the arm within the step under way, which is in flight, to where it has
// come to `to`. STATUS_NOT_FINITE if a state on the way cannot be computed.
status corrected_follow_flight(corrected_run *c, const way *to) __attribute__((warn_unused_result));

// Lets the sensors follow the arm over the step just made, or over what is left of it, and keeps
// its force. STATUS_NOT_FINITE as above, STATUS_NO_MEMORY.
status corrected_record_forces(corrected_run *c) __attribute__((warn_unused_result));
