// Every recorded quantity, and the one table that describes them: it feeds CSV headers, JSON, the
// terminal's traces, figures and the manual.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/base/fault.h"

// One recorded row: the state at an instant and the quantities that belong to exactly that state.
typedef struct sample {
    double time;               // t [s]
    double hub_angle;          // theta1 [rad]
    double first_angle;        // theta2, first link [rad]
    double last_angle;         // theta3, last link [rad]
    double hub_velocity;       // [rad/s]
    double first_velocity;     // [rad/s]
    double last_velocity;      // [rad/s]
    double hub_acceleration;   // [rad/s2]
    double first_acceleration; // [rad/s2]
    double last_acceleration;  // [rad/s2]
    double gap;                // distance of the contact point, at rest, from the arm [m]
    double gap_velocity;       // [m/s]
    double force;              // contact force, impulses excluded [N]
    double impulse;            // of the impact at this very instant [N s]
    double contact;            // 1 while in contact, else 0
    double sticking;           // 1 while the hub sticks, else 0
    double voltage;            // command to the amplifier [V]
    double motor_torque;       // kT/Ra times amplified command, before back EMF [N m]
    double friction_torque;    // Coulomb friction at the hub, as it acts [N m]
    double kinetic_energy;     // [J]
    double strain_energy;      // [J]
    double motor_work;         // done by motor_torque since the start [J]
    double external_work;      // done by pushes since the start [J]
    double viscous_loss;       // back EMF and viscous friction [J]
    double friction_loss;      // Coulomb friction [J]
    double damping_loss;       // structural damping [J]
    double impact_loss;        // [J]
    double energy_residual;    // residual of the energy balance [J]
    // on the rig, as of its last sample; NaN without one
    double encoder;          // hub angle as read [rad]
    double tachometer;       // hub velocity as read [rad/s]
    double force_reading;    // contact force as the FSR reads it [N]
    double piezo_force;      // contact force as the piezoelectric sensor reads it [N]
    double film;             // bending as the piezo film reads it [rad]
    double accelerometer;    // hub acceleration as read [rad/s2]
    double command;          // what the controller asked for [V]
    double controller_mode;  // index of the controller's mode
    double desired_angle;    // of the hub [rad]
    double desired_velocity; // of the hub [rad/s]
    double calculated_force; // what the controller takes the contact force to be [N]
    // of a wall that gives; NaN at a rigid one
    double wall_energy;   // that its spring and the motion of its face hold [J]
    double wall_loss;     // lost in it [J]
    double wall_place;    // of a wall that moves, towards the arm; else NaN [m]
    double wall_work;     // that it does; else NaN [J]
    double weight_energy; // from the hub's axis on, NaN in a level plane [J]
    double face_depth;    // how far its face is pushed in, NaN in a rigid one [m]
    // on the rig with a limit on the force
    double predicted_force; // largest force if the tip struck now, as of the last sample [N]
} sample;

typedef enum line_style { LINE_SOLID, LINE_DASHED, LINE_DOTTED, LINE_DASH_DOT } line_style;

// The body whose motion a signal is.
typedef enum signal_body { BODY_NONE, BODY_HUB, BODY_FIRST_LINK, BODY_LAST_LINK } signal_body;

typedef struct signal_info {
    const char *name;        // as in CSV headers and --plot, "contact_force"
    const char *symbol;      // Pango markup, for figures
    const char *ascii;       // the same in ASCII
    const char *unit;        // "N", "rad/s2" is written "rad/s²" in figures by the plotter
    const char *description; // one sentence without a full stop
    signal_body body;        // BODY_NONE where the description says all
    const char *quantity;    // label of its axis, the same for every body: "Angular velocity"
    int colour;              // slot in the palette, 0-7
    line_style style;
    size_t offset; // in struct sample
    bool optional; // of a sensor that need not be there: no column where nothing is recorded
} signal_info;

// The recorded ones, and behind them those that are derived from them.
extern const signal_info *const signal_table;
extern const int signal_count; // of the recorded ones
enum { SIGNALS_AT_MOST = sizeof(sample) / sizeof(double), DERIVED_SIGNALS = 16 };

// Index of the signal of a field, SIGNAL_INDEX(force): rows and table have one order. A constant,
// and a misspelt one does not compile.
#define SIGNAL_INDEX(field) ((int)(offsetof(sample, field) / sizeof(double)))

// Makes the derived signal in one of the DERIVED_SIGNALS places an expression of recorded ones,
// such as "force - force_reading"; its name is the expression without blanks, its unit that of its
// terms where they have one. Returns its index, -1 with a sentence if the expression cannot be
// read. Not for use beside a thread that reads signals.
int signal_derive(int place, const char *text, fault *f);
bool signal_is_derived(int index);

// Index of a recorded signal by name, or -1; and of derived ones, too.
int signal_find(const char *name);
int signal_find_any(const char *name);

// Index of a signal that the program itself names: an unknown one fails an assertion.
int signal_index(const char *name);

// "hub", "first link", "last link"; "" for BODY_NONE.
const char *signal_body_name(signal_body body);

// Whether a signal is a state, such as contact or a mode: a number that names it and is no amount,
// so that nothing can be subtracted from it.
bool signal_is_state(int index);

// The signal's value in a row.
double signal_value(const sample *row, int index);
