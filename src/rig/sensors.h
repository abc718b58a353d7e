// The sensors and converters of the rig, each imperfection one number that can be zero.
//
// Hub encoder and tachometer are collocated with the motor. The force sensing resistor (FSR) at the
// tip lags the force by a first-order rise, its resistance falls with the force by a power law, and
// a voltage divider and an amplifier (Fig. 2.1) turn that into volts.
#pragma once

#include "src/lab/random.h"
#include "src/parameters.h"

typedef struct sensors {
    sensor_parameters p; // with sensor.ideal carried out
    random_generator random;
    double felt_force;        // what has arrived in the force sensor [N]
    double fsr_time_constant; // [s]
    double spare;             // second number of a pair of normal ones, NaN if there is none
} sensors;

// What a controller gets: volts read back through the sensors' nominal curves.
typedef struct sensor_reading {
    double angle;    // encoder [rad]
    double velocity; // tachometer [rad/s]
    double force;    // FSR [N]
} sensor_reading;

void sensors_init(sensors *s, const sensor_parameters *p, int seed);

// Lets the force sensor follow the contact force over a time h [s], taken as the parabola that has
// the values `first` and `last` at its ends and the given mean [N]. Exact.
void sensors_follow(sensors *s, double h, double first, double last, double mean);

// The force sensor under an impulse [N s] of the wall.
void sensors_strike(sensors *s, double impulse);

// Reads all sensors at once with the hub at `angle` [rad] and `velocity` [rad/s] and the given
// contact force [N] (which an instant force sensor shows).
sensor_reading sensors_read(sensors *s, double angle, double velocity, double force);

// Volts at the A/D under a constant force [N], without noise and converter: divider and gain stage.
double fsr_volts(const sensor_parameters *p, double force);

// The force [N] that gives these volts; 0 below, the saturation force above the sensor's range.
double fsr_force(const sensor_parameters *p, double volts);

// The nearest value that a converter of the given bits has in its range -range to range; 0 bits:
// the value itself within the range.
double converter_value(double value, int bits, double range);
