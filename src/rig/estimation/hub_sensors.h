// What the readings of the hub show of its own sensors: the encoder's count, and the
// tachometer's offset and noise. One for all observers that follow the same readings.
#pragma once

#include "src/rig/controller.h"

// Standard deviation of the encoder, and of angles that no mode shows [rad].
#define HUB_ANGLE_NOISE 4.5e-4

typedef struct hub_sensors {
    double count, angle;    // smallest step of the encoder so far, its last reading [rad]
    double turned;          // angle by the tachometer [rad],
    double observed;        // over this time [s]
    double rates[3];        // its last readings, the latest first [rad/s],
    double noise;           // and the variance of its noise [rad2/s2]
    double angle_deviation; // standard deviation of the present angle [rad],
    double rate_variance;   // and variance of the present velocity [rad2/s2]
    bool moves;             // the hub, so that it tells what arm it is on
} hub_sensors;

// Starts with a first sample.
void hub_sensors_start(hub_sensors *s, const controller_input *in);

// The next sample, a period [s] later; returns it without the tachometer's offset.
controller_input hub_sensors_read(hub_sensors *s, const controller_input *in,
                                  double period);
