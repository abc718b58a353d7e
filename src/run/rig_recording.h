// The rig in a run: set up at its start, in every row, and in the summary.
#pragma once

#include "src/run/recording.h"

// Sets up the rig, if the scenario has a control law; until its first command the motor rests.
status recording_start_rig(recording *r, fault *f);

// Copies what the rig knows into a row; NaN without a rig or before its first sample.
void recording_add_rig_signals(const recording *r, sample *row);

// The rig's present command takes effect at `time` [s], with the hub at hub_angle [rad]: what the
// amplifier fed in under the one before is booked.
void recording_change_command(recording *r, double time, double hub_angle);

// A parameter is about to change at `time` [s], with the hub at hub_angle [rad]: what the amplifier
// fed in under another limit is booked.
void recording_before_change(recording *r, const action *todo, double time, double hub_angle);

// The tip moves in the air towards the wall, at most with closing_speed [m/s] since the last call.
void recording_follow_flight(recording *r, double closing_speed);

// Fills in what the summary says of the rig; the hub is at the given angle at the end [rad].
void recording_finish_rig_summary(recording *r, double hub_angle);
