// What a controller is: the one header that a controller is written against, built in or
// one's own.
//
// A controller sees what the sensors give it and what it was told at the start, nothing
// else. It keeps what it remembers in `memory`, which the rig allocates, clears and
// frees: no allocation in `sample`, no variables of its own outside.
// docs/examples/soft_push.c is a complete one.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

// Version of this interface; a controller carries the one it was compiled with.
enum { CONTROLLER_INTERFACE = 5 };

// A number that a user may give a controller. One that is called like a control.NAME of
// the scenario takes the scenario's value; given by its name alone, as {.name = "force"},
// it takes unit, range and default from there too. The controller's own further ones are
// given in control.settings as NAME=VALUE.
typedef struct controller_parameter {
    const char *name;
    const char *unit;        // "" for a pure number
    double initial;          // where the scenario does not give it
    double minimum, maximum; // both included
    const char *description; // one sentence without a full stop
} controller_parameter;

// What a controller is told about the rig it runs on: nominal values, not necessarily
// true ones (belief.* in a scenario). The arm is given as two links, whatever `links` is:
// a model of N links has 1/N of the mass and the length 2 link_mass and 2 link_length
// each, and k2 N/2 in each joint.
typedef struct controller_setup {
    double period;          // between samples [s]
    double delay;           // from a sample to the effect of its command [s]
    double voltage_limit;   // largest command either way [V]
    double torque_per_volt; // of command, gain kT / Ra [N m/V]
    double hub_damping;     // k_fr + kT kB / Ra [N m s/rad]
    double stiction;        // k_st [N m]
    double hub_inertia;     // I1 [kg m2]
    double link_mass;       // m of each of two links [kg]
    double link_length;     // l of each of two links [m]
    double link_inertia;    // I2 = I3 about the centre of mass [kg m2]
    double k2;              // stiffness of the beam's joint, nominal [N m/rad]
    double wall_angle;      // theta_imp, nominal [rad]
    int links;              // of the beam in a model that can have several
    double hub_spring; // k1 between hub and beam, HUGE_VAL if they are one body [N m/rad]
    double damping_ratio;     // of the beam's first clamped-free mode
    const double *parameters; // values in the order of controller.parameters
} controller_setup;

// What the sensors read at a sample, under the names of the recorded signals. Numbers are
// in physical units, through the nominal curves of the sensors; noise, quantisation, lag
// and saturation are in them.
typedef struct controller_input {
    double time;       // since the start [s]
    double encoder;    // hub angle [rad]
    double tachometer; // hub velocity [rad/s]
    double force;      // contact force, by the sensor that sensor.force names [N]
    double voltage;    // command at present in effect, after the D/A [V]
    // sensors that need not be there; NaN where they are not fitted
    double piezo_force; // contact force, by the piezoelectric sensor [N]
    double film; // bending, last link's angle minus the first's, by the piezo film [rad]
    double accelerometer; // hub acceleration [rad/s2]
    int wanted_mode; // index in controller.modes it is to be in; -1: it chooses itself
    // largest force [N] if the tip struck the wall now and the command in effect stayed,
    // by (4.20)- (4.22); 0 if it would not strike, NaN in contact and without
    // control.force_limit
    double predicted_force;
} controller_input;

// What a controller answers. The last three are recorded under their names, the others as
// the signals `command` and `controller_mode`.
typedef struct controller_output {
    double command; // [V], NaN before the call; beyond the limit it saturates, not finite
                    // (as one that nobody fills in) it ends the run
    int mode;       // index in controller.modes
    double desired_angle;    // of the hub, NaN if it has none [rad]
    double desired_velocity; // of the hub, NaN if it has none [rad/s]
    double
        calculated_force; // what it takes the contact force to be, NaN if it does not [N]
} controller_output;

typedef struct controller {
    int interface; // CONTROLLER_INTERFACE
    const char *name;
    const char *const *modes; // names, ended by NULL
    bool lockable;            // it obeys controller_input.wanted_mode
    const controller_parameter *parameters;
    int parameter_count;
    size_t memory_size; // bytes of memory
    // Called once before the first sample with cleared memory. Returns NULL, or a
    // sentence that says why the controller cannot run.
    const char *(*start)(void *memory, const controller_setup *setup);
    // Called at every sampling instant.
    void (*sample)(void *memory, const controller_input *input,
                   controller_output *output);
    // Called before a sample when what it was told has changed; what it remembers stays.
    // As `start` otherwise. NULL: its parameters cannot change during a run.
    const char *(*tune)(void *memory, const controller_setup *setup);
} controller;

// A shared object named in control.plugin exports this function under this name.
#define CONTROLLER_ENTRY "impactlab_controller"
typedef const controller *(*controller_entry)(void);

#ifdef __cplusplus
}
#endif
