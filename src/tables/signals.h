// Every recorded quantity, and the one table that describes them: it feeds CSV headers,
// JSON, the terminal's traces, figures and the manual.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/base/fault.h"
#include "src/tables/feature_bits.h"

typedef enum line_style {
    LINE_SOLID,
    LINE_DASHED,
    LINE_DOTTED,
    LINE_DASH_DOT
} line_style;

// The body whose motion a signal is.
typedef enum signal_body {
    BODY_NONE,
    BODY_HUB,
    BODY_FIRST_LINK,
    BODY_LAST_LINK
} signal_body;

// Every recorded quantity: name, symbol as Pango markup and in ASCII, unit, description,
// label of its axis, colour and line, and what else there is to say of it.
//
// From `encoder` on they are those of the rig as of its last sample, NaN without one;
// from `wall_energy` to `face_depth` those of walls and weight, NaN where these are not;
// of `predicted_force` the rig has a limit on the force. Places and the gap are those of
// the contact point, at rest; the friction torque is as it acts.
#define SIGNALS(SIGNAL)                                                                  \
    SIGNAL(time, "t", "t", "s", "simulated time", "Time", 0, LINE_SOLID)                 \
    SIGNAL(hub_angle, "θ<sub>1</sub>", "th1", "rad", "angle of the hub", "Angle", 0,     \
           LINE_SOLID, .body = BODY_HUB)                                                 \
    SIGNAL(first_angle, "θ<sub>2</sub>", "th2", "rad", "angle of the first link",        \
           "Angle", 1, LINE_DASHED, .body = BODY_FIRST_LINK)                             \
    SIGNAL(last_angle, "θ<sub>3</sub>", "th3", "rad", "angle of the last link", "Angle", \
           2, LINE_SOLID, .body = BODY_LAST_LINK)                                        \
    SIGNAL(hub_velocity, "θ̇<sub>1</sub>", "w1", "rad/s", "angular velocity of the hub",  \
           "Angular velocity", 0, LINE_SOLID, .body = BODY_HUB)                          \
    SIGNAL(first_velocity, "θ̇<sub>2</sub>", "w2", "rad/s",                               \
           "angular velocity of the first link", "Angular velocity", 1, LINE_DASHED,     \
           .body = BODY_FIRST_LINK)                                                      \
    SIGNAL(last_velocity, "θ̇<sub>3</sub>", "w3", "rad/s",                                \
           "angular velocity of the last link", "Angular velocity", 2, LINE_SOLID,       \
           .body = BODY_LAST_LINK)                                                       \
    SIGNAL(hub_acceleration, "θ̈<sub>1</sub>", "a1", "rad/s2",                            \
           "angular acceleration of the hub", "Angular acceleration", 0, LINE_SOLID,     \
           .body = BODY_HUB)                                                             \
    SIGNAL(first_acceleration, "θ̈<sub>2</sub>", "a2", "rad/s2",                          \
           "angular acceleration of the first link", "Angular acceleration", 1,          \
           LINE_DASHED, .body = BODY_FIRST_LINK)                                         \
    SIGNAL(last_acceleration, "θ̈<sub>3</sub>", "a3", "rad/s2",                           \
           "angular acceleration of the last link", "Angular acceleration", 2,           \
           LINE_SOLID, .body = BODY_LAST_LINK)                                           \
    SIGNAL(gap, "g", "gap", "m", "distance of the arm from the contact point", "Gap", 3, \
           LINE_SOLID)                                                                   \
    SIGNAL(gap_velocity, "ġ", "vgap", "m/s", "rate of the gap", "Rate of the gap", 3,    \
           LINE_DASHED)                                                                  \
    SIGNAL(force, "f", "f", "N", "contact force, impulses excluded", "Contact force", 5, \
           LINE_SOLID)                                                                   \
    SIGNAL(impulse, "p", "p", "N s", "impulse of an impact at this very instant",        \
           "Impulse", 4, LINE_SOLID)                                                     \
    SIGNAL(contact, "contact", "contact", "", "1 while in contact", "In contact", 3,     \
           LINE_SOLID)                                                                   \
    SIGNAL(sticking, "stick", "stick", "", "1 while the hub sticks", "Sticking", 6,      \
           LINE_DOTTED)                                                                  \
    SIGNAL(voltage, "v", "v", "V", "voltage commanded to the amplifier", "Voltage", 6,   \
           LINE_SOLID)                                                                   \
    SIGNAL(motor_torque, "τ<sub>m</sub>", "tau", "N m", "motor torque before back EMF",  \
           "Motor torque", 6, LINE_DASHED)                                               \
    SIGNAL(friction_torque, "τ<sub>c</sub>", "tauc", "N m",                              \
           "Coulomb friction torque at the hub", "Friction torque", 4, LINE_DASHED)      \
    SIGNAL(kinetic_energy, "T", "T", "J", "kinetic energy", "Kinetic energy", 0,         \
           LINE_SOLID)                                                                   \
    SIGNAL(strain_energy, "V", "V", "J", "strain energy of the springs",                 \
           "Strain energy", 1, LINE_DASHED)                                              \
    SIGNAL(motor_work, "W<sub>m</sub>", "Wm", "J", "work done by the motor torque",      \
           "Work", 2, LINE_SOLID)                                                        \
    SIGNAL(external_work, "W<sub>e</sub>", "We", "J", "work done by pushes", "Work", 2,  \
           LINE_DOTTED)                                                                  \
    SIGNAL(viscous_loss, "D<sub>v</sub>", "Dv", "J",                                     \
           "lost to back EMF and viscous friction", "Energy lost", 3, LINE_DASHED)       \
    SIGNAL(friction_loss, "D<sub>c</sub>", "Dc", "J", "lost to Coulomb friction",        \
           "Energy lost", 4, LINE_DOTTED)                                                \
    SIGNAL(damping_loss, "D<sub>s</sub>", "Ds", "J", "lost to structural damping",       \
           "Energy lost", 6, LINE_DASH_DOT)                                              \
    SIGNAL(impact_loss, "D<sub>i</sub>", "Di", "J", "lost in impacts", "Energy lost", 5, \
           LINE_DASHED)                                                                  \
    SIGNAL(energy_residual, "r", "res", "J", "energy the ledger does not account for",   \
           "Energy unaccounted for", 7, LINE_SOLID)                                      \
    SIGNAL(encoder, "θ<sub>enc</sub>", "enc", "rad",                                     \
           "hub angle as the encoder reads it", "Hub angle", 0, LINE_SOLID)              \
    SIGNAL(tachometer, "θ̇<sub>tach</sub>", "tach", "rad/s",                              \
           "hub velocity as the tachometer reads it", "Hub velocity", 0, LINE_SOLID)     \
    SIGNAL(force_reading, "f<sub>FSR</sub>", "fsr", "N",                                 \
           "contact force as the FSR reads it", "Contact force", 5, LINE_SOLID)          \
    SIGNAL(piezo_force, "f<sub>piezo</sub>", "fpz", "N",                                 \
           "contact force as the piezoelectric sensor reads it", "Contact force", 2,     \
           LINE_SOLID, .needs = HAS(PIEZO))                                              \
    SIGNAL(film, "δ<sub>film</sub>", "film", "rad",                                      \
           "bending of the beam, last link's angle minus the first's, as the piezo "     \
           "film reads it",                                                              \
           "Bending", 4, LINE_SOLID, .needs = HAS(FILM))                                 \
    SIGNAL(accelerometer, "θ̈<sub>acc</sub>", "acc", "rad/s2",                            \
           "hub acceleration as the accelerometer reads it", "Hub acceleration", 0,      \
           LINE_SOLID, .needs = HAS(ACCELEROMETER))                                      \
    SIGNAL(tip_deflection, "y<sub>tip</sub>", "ytip", "m",                               \
           "deflection of the tip from the tangent to the hub, as its sensor reads it",  \
           "Deflection", 2, LINE_SOLID, .needs = HAS(TIP_DEFLECTION))                    \
    SIGNAL(root_strain, "ε<sub>root</sub>", "strain", "",                                \
           "strain at the root of the beam, as a gauge reads it", "Strain", 4,           \
           LINE_SOLID, .needs = HAS(ROOT_STRAIN))                                        \
    SIGNAL(command, "u", "u", "V", "command of the controller", "Command", 6,            \
           LINE_SOLID)                                                                   \
    SIGNAL(controller_mode, "mode", "mode", "",                                          \
           "mode of the controller, counted from 0", "Mode", 3, LINE_SOLID)              \
    SIGNAL(desired_angle, "θ<sub>d</sub>", "thd", "rad",                                 \
           "hub angle that the controller wants", "Hub angle", 1, LINE_DASHED)           \
    SIGNAL(desired_velocity, "θ̇<sub>d</sub>", "wd", "rad/s",                             \
           "hub velocity that the controller wants", "Hub velocity", 1, LINE_DASHED)     \
    SIGNAL(calculated_force, "f<sub>calc</sub>", "fcalc", "N",                           \
           "contact force that the controller calculates", "Contact force", 2,           \
           LINE_DASHED)                                                                  \
    SIGNAL(wall_energy, "V<sub>w</sub>", "Vw", "J",                                      \
           "energy that a wall that gives holds", "Strain energy", 5, LINE_DASHED,       \
           .needs = HAS(GIVES))                                                          \
    SIGNAL(wall_loss, "D<sub>w</sub>", "Dw", "J", "lost in a wall that gives",           \
           "Energy lost", 5, LINE_DASH_DOT, .needs = HAS(GIVES))                         \
    SIGNAL(wall_place, "s<sub>w</sub>", "sw", "m",                                       \
           "where a wall that moves is, along its normal towards the arm",               \
           "Place of the wall", 3, LINE_SOLID, .needs = HAS(MOVES))                      \
    SIGNAL(wall_work, "W<sub>w</sub>", "Ww", "J", "work done by a wall that moves",      \
           "Work", 5, LINE_DOTTED, .needs = HAS(MOVES))                                  \
    SIGNAL(weight_energy, "V<sub>g</sub>", "Vg", "J",                                    \
           "potential energy of the weight in a tilted plane, from the hub's axis on",   \
           "Strain energy", 6, LINE_DASHED, .needs = HAS(TILTED))                        \
    SIGNAL(face_depth, "x<sub>w</sub>", "xw", "m",                                       \
           "how far the face of a wall that gives is pushed in",                         \
           "Depth of the wall's face", 2, LINE_DASHED, .needs = HAS(GIVES))              \
    SIGNAL(predicted_force, "f<sub>pred</sub>", "fpred", "N",                            \
           "largest contact force if the tip struck now, as the rig predicts it",        \
           "Contact force", 4, LINE_DOTTED, .needs = HAS(FORCE_LIMIT))

// One recorded row: the state at an instant and the quantities that belong to exactly
// that state.
typedef struct sample {
#define SIGNAL_FIELD(name, ...) double name;
    SIGNALS(SIGNAL_FIELD)
#undef SIGNAL_FIELD
} sample;

typedef struct signal_info {
    const char *name;   // as in CSV headers and --plot, "contact_force"
    const char *symbol; // Pango markup, for figures
    const char *ascii;  // the same in ASCII
    const char *unit;   // "N", "rad/s2" is written "rad/s²" in figures by the plotter
    const char *description; // one sentence without a full stop
    const char
        *quantity; // label of its axis, the same for every body: "Angular velocity"
    int colour;    // slot in the palette, 0-7
    line_style style;
    signal_body body;  // BODY_NONE where the description says all
    feature_set needs; // what a run must have for it to have a value, one of these; 0:
                       // nothing, it has a column in every table
    size_t offset;     // in struct sample
} signal_info;

// The recorded ones, and behind them those that are derived from them.
extern const signal_info *const signal_table;
extern const int signal_count; // of the recorded ones
enum { SIGNALS_AT_MOST = sizeof(sample) / sizeof(double), DERIVED_SIGNALS = 16 };

// Index of the signal of a field, SIGNAL_INDEX(force): rows and table have one order. A
// constant, and a misspelt one does not compile.
#define SIGNAL_INDEX(field) ((int)(offsetof(sample, field) / sizeof(double)))

// Makes the derived signal in one of the DERIVED_SIGNALS places an expression of recorded
// ones, such as "force - force_reading"; its name is the expression without blanks, its
// unit that of its terms where they have one. Returns its index, -1 with a sentence if
// the expression cannot be read. Not for use beside a thread that reads signals.
int signal_derive(int place, const char *text, fault *f);
bool signal_is_derived(int index);
// The index of a recorded signal or of an expression, which is derived in a place that
// none has had unless it is there already; -1 with a sentence. Threads may call it.
int signal_of_text(const char *text, fault *f);

// Index of a recorded signal by name, or -1; and of derived ones, too.
int signal_find(const char *name);
int signal_find_any(const char *name);

// Index of a signal that the program itself names: an unknown one fails an assertion.
int signal_index(const char *name);

// "hub", "first link", "last link"; "" for BODY_NONE.
const char *signal_body_name(signal_body body);

// Whether a signal is a state, such as contact or a mode: a number that names it and is
// no amount, so that nothing can be subtracted from it.
bool signal_is_state(int index);

// The signal's value in a row.
double signal_value(const sample *row, int index);
