// The sensors and converters of the rig, each imperfection one number that can be zero.
//
// Hub encoder and tachometer are collocated with the motor. The force sensing resistor
// (FSR) at the tip lags the force by a first-order rise, its resistance falls with the
// force by a power law, and a voltage divider and an amplifier (Fig. 2.1) turn that into
// volts. Its hysteresis is a play: the reading y follows a force f only as far as (1 - h)
// f <= y <= (1 + h) f asks for, f being what has arrived through the lag, with every
// extreme on its way from sample to sample. An impulse p is the limit of a force p/e over
// a time e -> 0, larger than any play: the lag T rises by p/T, to f, and takes the play
// to its lower edge, y >= (1 - h) f; without a lag f itself was without bounds and has
// fallen, so that y = (1 + h) f behind it. Readings of sensors that are calibrated
// wrongly are (1 + gain error) times the value plus an offset.
//
// Three more need not be there: the additional measurements that chapter 6 of the thesis
// wishes for. A piezoelectric force sensor rises fast, goes off scale in an impact, and
// its charge leaks away. A piezo film shows how much the beam bends and leaks too. An
// accelerometer on the hub has a bandwidth.
//
// Two are there for what is recorded, and no law is told of them: the deflection of the
// tip and the strain at the root of the beam, each of which may look less often than the
// rig and holds its reading in between.
#pragma once

#include <stdint.h>

#include "src/base/random.h"
#include "src/rig/first_order_lag.h"
#include "src/tables/parameters.h"

// What the sensors are fixed to, at one instant.
typedef struct sensed_motion {
    double angle, velocity, acceleration; // of the hub [rad], [rad/s], [rad/s2]
    double bending;      // last link's angle minus the first's: theta3 - theta2 [rad]
    double bending_rate; // [rad/s]
    double force;        // of contact, impulses excluded [N]
    double time;         // [s]
    // of the tip from the tangent to the hub [m], and of the beam at its root [1/m]; 0
    // where no sensor is fitted that looks at them
    double tip_deflection, root_curvature;
} sensed_motion;

// White noise of its own.
enum { NOISE_AHEAD = 16 };
typedef struct noise_source {
    random_generator random;
    double normal[NOISE_AHEAD]; // normal numbers, drawn so many at a time
    int taken;                  // of them
} noise_source;

// A sensor without a lag that may look less often than the rig.
typedef struct slow_sensor {
    noise_source noise;
    double due;  // when it looks next [s]
    double held; // what it read when it looked last
} slow_sensor;

// An A/D or D/A converter.
typedef struct converter {
    double range;  // either way [in the value's unit]
    double step;   // from code to code [in the value's unit], 0 of a continuous one
    double codes;  // in all of the range
    double a_unit; // codes in one unit
} converter;

// A point of the FSR's nominal curve.
typedef struct fsr_point {
    double force; // [N]
    double volts; // at the A/D [V]
} fsr_point;

enum { FSR_POINTS_READ = 32 };

typedef struct sensors {
    sensor_parameters p; // with sensor.ideal carried out
    converter adc;       // the range of an ideal one is not limited [V]
    double encoder_step; // of a count, 0: continuous [rad]
    noise_source noise;  // of tachometer and FSR
    noise_source
        piezo_noise; // the other sensors have their own: fitting one shifts nothing
    noise_source film_noise; //
    noise_source acceleration_noise;
    slow_sensor tip_deflection, root_strain;
    first_order_lag fsr;        // what has arrived in the FSR [N],
    double fsr_shown;           // and what its hysteresis makes of that [N]
    first_order_lag piezo_rise; // what has arrived in the piezoelectric sensor [N],
    first_order_lag piezo_leak; // and the part of it that has leaked [N]
    first_order_lag film_leak;  // the part of the bending that has leaked [rad]
    first_order_lag acceleration;
    double seen_velocity; // of the hub when the accelerometer last looked [rad/s], NaN
                          // before
    // points of the FSR's curve that are known already, each a power that need not be
    // raised again: cache for a constant force, and for the few codes of the A/D between
    // which noise moves the reading
    fsr_point felt;
    fsr_point read[FSR_POINTS_READ];
    // the hub's angle last read, and what follows from it
    double seen_angle; // [rad], NaN before
    double counted;    // by the encoder [rad]
    double ripple;     // of the tachometer, a factor
} sensors;

// What the sensors read, under the names of the recorded signals: volts read back through
// their nominal curves. NaN where one is not fitted.
typedef struct sensor_reading {
    double encoder;        // hub angle [rad]
    double tachometer;     // hub velocity [rad/s]
    double force_reading;  // contact force, FSR [N]
    double piezo_force;    // contact force, piezoelectric sensor [N]
    double film;           // bending, piezo film [rad]
    double accelerometer;  // hub acceleration [rad/s2]
    double tip_deflection; // from the tangent to the hub [m]
    double root_strain;    // of the beam at its root
} sensor_reading;

// Starts sensors at rest, their noise from the seed; sensor.ideal takes every
// imperfection away.
void sensors_init(sensors *s, const sensor_parameters *p, int seed);
// Gives the sensors other properties; the states of their lags and their noise continue.
void sensors_retune(sensors *s, const sensor_parameters *p);

// Whether sensors_follow over a flight, in which nothing presses, leaves the sensors as
// they are: none of the force's remembers any, and those that feel the arm itself are not
// there.
bool sensors_at_rest(const sensors *s);

// Lets the sensors with a lag or a leak follow the arm over a time h [s]. Force, bending
// and hub acceleration are each taken as the parabola that has the values of `first` and
// `last` at its ends and their mean: of the force as given [N], of the acceleration what
// the velocity gained, of the bending what the cubic through angles and rates has. Exact
// for such parabolas. A velocity that jumped before `first` is a pulse of acceleration.
void sensors_follow(sensors *s, double h, const sensed_motion *first,
                    const sensed_motion *last, double mean_force);

// Applies an impulse [N s] of the wall to the force sensors.
void sensors_strike(sensors *s, double impulse);

// Reads all sensors at once.
sensor_reading sensors_read(sensors *s, const sensed_motion *now);

// Volts at the A/D under a constant force [N], without noise and converter: divider and
// gain stage.
double fsr_volts(const sensor_parameters *p, double force);

// The force [N] that gives these volts; 0 below, the saturation force above the sensor's
// range.
double fsr_force(const sensor_parameters *p, double volts);

// A converter of the given bits with the range -range to range; 0 bits: a continuous one.
converter converter_of(int bits, double range);

// The nearest value that it has; of a continuous one the value itself within the range.
static inline double converter_value(const converter *c, double value)
{
    double within = c->range;
    if (value < -c->range) {
        within = -c->range;
    } else if (value < c->range) {
        within = value;
    }
    if (c->step == 0) {
        return within;
    }

    // whole steps from the lower end of the range: a conversion that rounds positive
    // numbers
    const double code = (double)(int64_t)((within + c->range) * c->a_unit + 0.5);
    return c->step * ((code < c->codes ? code : c->codes - 1) - c->codes / 2);
}
