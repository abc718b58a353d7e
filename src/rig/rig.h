// The rig: sensors, a controller that samples them, and the command it sends to the
// amplifier.
//
// The run's motion is the plant. It stops at rig_next_time or, in flight, is observed
// there without stopping (src/run/arm_run.h); at the time of a sample sensors are read
// and the controller is called, and `delay` later its command takes effect and holds
// (zero-order hold) until the next one does.
#pragma once

#include "src/rig/controller.h"
#include "src/rig/external/played_command.h"
#include "src/rig/external/plugin.h"
#include "src/rig/external/process.h"
#include "src/rig/sensors.h"
#include "src/rig/estimation/touch_forecast.h"
#include "src/base/fault.h"

// A controller that a program gives in the place of control.law. The rig leaves `context`
// at the beginning of the controller's memory, before its start.
typedef struct given_law {
    const controller *law;
    void *context;
} given_law;

// What a run gives its rig besides parameters; all zero for none.
typedef struct rig_options {
    const given_law *law; // in the place of control.law
    stop_request *stop;   // where a process is not waited for any more; NULL: it is
} rig_options;

typedef struct rig {
    const controller *law;
    given_law given;  // with the context that the law's memory begins with, if it has one
    bool withheld;    // the law may not be loaded or started: the first sample fails
    plugin plugin;    // the law comes from, else empty
    process *process; // that the law asks, else NULL
    played_command played; // that the law plays, else empty
    void *memory;          // the controller's
    double *values;        // of the controller's parameters
    sensors sensors;
    double period, delay, jitter; // [s]
    double voltage_limit;         // [V]
    converter dac;                // within that limit [V]
    double sample_time;           // of the next sample [s]
    // commands under way, after the D/A, the next one first: what they are [V], when they
    // take effect [s], and how many of them wait at most when the next sample is taken
    double pending[CONTROL_MOST_DELAY + 1], effect_time[CONTROL_MOST_DELAY + 1];
    int pending_count, pending_most;
    parameters known;    // that sensors and controller have now
    double clock_start;  // nominal instant of sample clock_samples [s]
    long clock_samples;  // the sample from which the clock of the present rate counts
    double ramp;         // commanded force at present, on its ramp to control.force [N]
    double ramp_time;    // when it was there [s]
    double wanted_force; // that the controller was told last [N]
    long samples;        // taken so far
    random_generator clock;   // of the jitter
    double voltage;           // command in effect [V]
    sensor_reading reading;   // of the last sample
    touch_forecast forecast;  // kept up with control.force_limit
    double predicted_force;   // of the last sample, NaN without a limit or in contact [N]
    double read_time;         // when it was taken, -1 before the first [s]
    controller_output output; // of the last sample
    double largest_command;   // in magnitude, of those that took effect [V]
    int lock;                 // mode that the controller is to be in, -1 if it chooses
} rig;

// Sets up the rig of resolved parameters with control.law other than none, or with the
// law of the options; o may be NULL. On failure (a plug-in that cannot be loaded, a
// setting that is not known, a controller that refuses) f says why and nothing is to be
// freed. A plug-in or program that the user has not allowed (code_allowed) is withheld:
// the rig is there, and its first sample fails with STATUS_NOT_ALLOWED.
status rig_create(rig **created, const parameters *p, const rig_options *o, fault *f);
void rig_destroy(rig *r); // r may be NULL

// The index of the mode that a value of control.lock names, -1 for "none".
// STATUS_BAD_SCENARIO, with a sentence in f, if the controller has no such mode or cannot
// be held in one.
status rig_find_mode(const controller *law, const char *lock, int *mode, fault *f);
// From the next sample on the controller is held in the mode of that name, or chooses
// itself again. On failure, as above, nothing changes.
status rig_lock(rig *r, const char *lock, fault *f);

// The names of the modes of the law, at most `most` of them, cut to fit; a plug-in is
// opened for them. Returns how many; 0 if there is no law or the plug-in cannot be
// opened.
enum { MODE_NAME_SIZE = 32 };
int rig_mode_names(const parameters *p, char names[][MODE_NAME_SIZE], int most,
                   bool *lockable);

// Whether the controller can be told these parameters during the run.
// STATUS_BAD_SCENARIO, with a sentence in f, if its law takes them at the start only and
// they are others now.
status rig_takes(const rig *r, const parameters *p, fault *f);

// Adopts changes of control.*, belief.*, sensor.* and motor.voltage_limit made at `time`
// [s]; they hold from the next sample on. What the controller was told of the arm stays
// as at the start. STATUS_BAD_SCENARIO, with a sentence in f, if the law takes its
// parameters at the start only.
status rig_retune(rig *r, const parameters *p, double time, fault *f);
// Whether a parameter may change during a run of these parameters, rather than from the
// start.
bool rig_can_change(const parameters *p, int parameter);

// --- for the parts of the rig

// The nominal model, which is what the controller is told: arm and rig as they are,
// changed by belief.*.
controller_setup rig_nominal_setup(const rig *r, const parameters *p);
// Takes the delay of commands from the parameters, at the present period.
void rig_take_delay(rig *r, const parameters *p);
// Takes the commanded force along its ramp and its wave to `time` [s], before a sample.
status rig_follow_setpoint(rig *r, double time, fault *f);

// The next instant at which the rig has something to do [s].
double rig_next_time(const rig *r);

// What is due at `time` [s], with the sensors seeing `now`. *changed: another command
// took effect, r->voltage, or the controller went into another mode. STATUS_NOT_FINITE,
// with a sentence in f, if the controller answers with a command that is not finite;
// STATUS_STOPPED, without one, where the run was asked to end while a process was to
// answer.
status rig_act(rig *r, double time, const sensed_motion *now, bool *changed, fault *f);

// Takes the sensors' reading of the sample that is due at `time` [s] ahead of the sample
// itself, which then uses it. Does nothing if no sample is due.
void rig_read(rig *r, double time, const sensed_motion *now);

// The built-in controller of a law; NULL for LAW_NONE, LAW_PLUGIN and LAW_PROCESS.
const controller *controller_of(int law);
