// The approach that leaves no vibration behind: from rest to a cruising speed, and from that to the
// speed of the touch before a guarded angle, each change of speed a box of one free vibration's
// period as acceleration, convolved with one of the next vibration's.
#pragma once

#include "src/rig/laws/observer_design.h"

typedef struct smooth_approach {
    double period;                  // between samples [s]
    double guarded;                 // tip angle from which on the wall may be felt [rad]
    double state[ESTIMATOR_STATES]; // planned: free coordinates and rates
    double start_angle;             // [rad]
    double cruise_speed;            // between its two changes of speed [rad/s]
    double speed_before;            // the present change of speed [rad/s]
    double planned_change;          // of speed, the present one [rad/s]
    double changing;                // how long it has been under way [s]
    bool slows;                     // it has begun to slow down for the touch
} smooth_approach;

// Begins at rest at an angle [rad], period and guarded angle being set; the cruising speed leaves
// room to slow down in.
void smooth_approach_begin(smooth_approach *p, const observer_design *d, double angle);

// Goes on with the speed of the touch.
void smooth_approach_touch(smooth_approach *p, const observer_design *d);

// The plan as it would be, had the present change of speed been begun for the design of now.
void smooth_approach_again(smooth_approach *p, const observer_design *d);

// Begins to slow down where the tip [rad] comes near the guarded angle.
void smooth_approach_slow(smooth_approach *p, const observer_design *d, double tip);

// Planned speed of the rotation [rad/s].
double smooth_approach_speed(const smooth_approach *p, const observer_design *d);

// Moves the plan on by a period; returns the torque that its rotation takes [N m].
double smooth_approach_follow(smooth_approach *p, const observer_design *d);
