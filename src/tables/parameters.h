// Every parameter of a run, and the one table that describes them.
//
// The table feeds scenario files, --set, sweeps, `show`, validation messages, the terminal's
// sliders and the manual. A parameter is added here and nowhere else.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "src/base/fault.h"
#include "src/tables/control_laws.h"

typedef enum arm_model_kind { ARM_CORRECTED, ARM_PRINTED } arm_model_kind;
typedef enum hub_joint_kind { HUB_RIGID, HUB_SPRING, HUB_BEAM } hub_joint_kind;
typedef enum wall_kind { WALL_POINT, WALL_PLANE, WALL_NONE } wall_kind;
typedef enum wall_law { WALL_RIGID, WALL_KELVIN_VOIGT, WALL_HUNT_CROSSLEY } wall_law;
typedef enum wall_motion_kind {
    MOTION_NONE,
    MOTION_SINE,
    MOTION_STEP,
    MOTION_FILE
} wall_motion_kind;
typedef enum motor_drive { DRIVE_VOLTAGE, DRIVE_CURRENT } motor_drive;
typedef enum method_kind { METHOD_EVENT, METHOD_NEWMARK, METHOD_GENERALIZED_ALPHA } method_kind;
typedef enum engine_kind { ENGINE_AUTO, ENGINE_PAIR, ENGINE_STIFF } engine_kind;
typedef enum listing_reevaluation {
    REEVALUATE_RHS,
    REEVALUATE_LISTING,
    REEVALUATE_NONE
} listing_reevaluation;

enum {
    PARAMETER_TEXT_SIZE = 128,   // room for a parameter that is a text, its end included
    PARAMETER_LINKS_MOST = 1024, // largest arm.links
    PARAMETER_LIST_MOST = 32,    // numbers of a parameter that is a list
    PARAMETER_MODES_MOST = 16    // of arm.modal_ratios
};

typedef enum playback_hold { PLAYBACK_HOLD, PLAYBACK_LINEAR } playback_hold;

typedef struct arm_parameters {
    int model;            // arm_model_kind
    int links;            // number of links of the beam, N
    int hub_joint;        // hub_joint_kind
    double length;        // beam length, N links together [m]
    double mass;          // beam mass, N links together [kg]
    double hub_inertia;   // I1 [kg m2]
    double link_inertia;  // I2 = I3 about the centre of mass, N = 2 only [kg m2]
    double k1;            // hub joint spring; of a beam k2 N [N m/rad]
    double k2;            // joint spring of the two-link beam [N m/rad]; N links: k2 N/2 each
    double EI;            // bending stiffness of the beam, k2 length/2 [N m2]
    double damping_ratio; // structural damping ratio of the first clamped-free mode [-]
    double tilt;          // of the plane to the level [rad]
    double tip_mass;      // of what the tip carries, a sensor [kg]
    double stiffening;    // share by which k2 grows with the square of its bend [1/rad2]
    double air_drag;      // force per length and velocity of the beam [N s/m2]
    char modal_ratios[PARAMETER_TEXT_SIZE];    // list: damping ratios of the first modes [-]
    char joint_stiffness[PARAMETER_TEXT_SIZE]; // list: each inner joint, of a beam the root too,
                                               // from the hub outwards [N m/rad]
    char link_lengths[PARAMETER_TEXT_SIZE];    // list: of each link, from the hub outwards [m]
} arm_parameters;

typedef struct motor_parameters {
    int drive;               // motor_drive: what the amplifier gives for a command
    double voltage;          // command before the amplifier [V]
    double voltage_limit;    // largest command the D/A gives [V]
    double amplifier_gain;   // [-]
    double transconductance; // of a current drive, amperes per volt of command [A/V]
    double current_limit;    // of the amplifier, 0: none [A]
    double torque_constant;  // kT [N m/A]
    double back_emf;         // kB [V s/rad]
    double resistance;       // Ra [ohm]
    double inductance;       // of the armature, 0: its current follows at once [H]
    double viscous_friction; // kfr [N m s/rad]
    double stiction;         // kst, Coulomb friction torque [N m]
} motor_parameters;

typedef struct wall_parameters {
    int kind;                // wall_kind
    double angle;            // direction of the contact point (or the flat wall) from the hub [rad]
    double restitution;      // coefficient of restitution e of rigid wall or face [-]
    int contact;             // wall_law
    double stiffness;        // k of the wall that gives [N/m], Hunt-Crossley [N/m^n]
    double damping;          // its c [N s/m], Hunt-Crossley [N s/m^(n+1)]
    double exponent;         // n, Hunt-Crossley [-]
    double mass;             // of the face of a Kelvin-Voigt wall, 0: none [kg]
    int motion;              // wall_motion_kind
    double motion_amplitude; // towards the arm [m]
    double motion_frequency; // [Hz]
    double motion_time;      // [s]
    char motion_file[PARAMETER_TEXT_SIZE]; // CSV with time [s] and place [m]
} wall_parameters;

typedef struct method_parameters {
    int name;               // method_kind
    double step;            // h [s]
    double beta;            // Newmark's beta [-]
    double gamma;           // Newmark's gamma [-]
    double spectral_radius; // generalised-alpha's rho at infinite frequency [-]
    double rest_speed;      // approach speed below which an impact is plastic (rest rule) [m/s]
    double residual_bound;  // largest residual of the energy balance, as a share of the energy put
                            // in [-]
    int engine;             // engine_kind, of the event method
    double tolerance;       // of the stiff engine's steps, as a share of the momentum [-]
} method_parameters;

typedef struct printed_parameters {
    bool spring_counted_twice;      // (2.16) carries k2 (errata B1)
    bool force_at_link_end;         // contact force acts at l, not at the contact point (B5)
    bool sign_dead_band;            // sign() uses -1e-2 where it means -1e-5 (C1)
    bool energy_cross_term;         // energy predictor uses E2 w2 w3 for 2 l e w2 w3 (C2)
    int reevaluation;               // listing_reevaluation: where C3's term stands, or none at all
    bool clamp_force;               // a re-evaluated force below zero becomes zero
    bool force_after_release;       // re-evaluates the force after release (C4)
    bool feed_newmark_acceleration; // next step starts from Newmark's own acceleration (C5)
    int newton_iterations;          // Newton solves per step
} printed_parameters;

typedef struct initial_parameters {
    double angle;    // all bodies [rad]
    double velocity; // all bodies [rad/s]
} initial_parameters;

typedef struct run_parameters {
    double duration; // [s]
} run_parameters;

typedef struct control_parameters {
    int law;                                   // control_law
    char plugin[PARAMETER_TEXT_SIZE];          // file of a shared object
    char command[PARAMETER_TEXT_SIZE];         // of a program, as a shell takes it
    double answer_time;                        // that the program has for each answer [s]
    char playback_file[PARAMETER_TEXT_SIZE];   // CSV with the command to play back
    char playback_column[PARAMETER_TEXT_SIZE]; // heading of its column
    double playback_shift;                     // by which it comes later than recorded [s]
    int playback_hold;                         // playback_hold: between rows
    char settings[PARAMETER_TEXT_SIZE]; // "name=value name=value", a plug-in's own parameters
    char lock[PARAMETER_TEXT_SIZE];     // mode in which the law is held, "none" if free
    double rate;                        // samples a second [Hz]
    double delay;                       // from sampling to the command's effect [s]
    double delay_periods;               // the same in sampling periods, on top of it
    double jitter;                      // of the sampling instants, whole width [s]
    int seed;                           // of every random number of the rig
    double force;                       // commanded force [N]
    double force_rate;                  // ramp when `force` changes, 0: a jump [N/s]
    double force_amplitude;             // amplitude of a sine added to the commanded force [N]
    double force_frequency;             // of that sine [Hz]
    double approach_voltage;            // [V]
    double kp, kv;                      // gains of (5.24), (5.25), in N m/rad or V/rad, and s
    int gains;                          // 0 torque, 1 volts, 2 printed (errata B7)
    int coefficients;                   // 0 corrected, 1 printed (errata B2)
    double transition_time;             // t_f [s]
    double contact_threshold;           // force reading that means contact [N]
    char k2_table[PARAMETER_TEXT_SIZE]; // "FORCE:K2 ...", takes the place of the arm's k2 there
    double force_gain;                  // of force errors [V/N]
    double integral_gain;               // of their integral [V/(N s)]
    double speed_limit;                 // hub velocity of a limited approach [rad/s]
    double reverse_time;                // how long reverse-torque brakes [s]
    double force_limit;                 // that a predictive approach keeps to [N]
    double switch_share;                // where bang-bang switches, share of the way to the wall
    double travel_time;                 // of the tip to the wall under inverse-dynamics [s]
    double arrival_speed;               // of the tip at the wall under inverse-dynamics [m/s]
    int impact_angle;                   // impact_angle_source: where hybrid has theta_imp from
} control_parameters;

// In the order of the choices of control.impact_angle.
typedef enum impact_angle_source {
    IMPACT_ANGLE_TOLD,
    IMPACT_ANGLE_BY_FILM,
    IMPACT_ANGLE_BY_ACCELEROMETER
} impact_angle_source;

// The nominal model that a controller is told of the arm on the rig (belief.*), as factors of the
// truth and differences from it.
typedef struct nominal_model_parameters {
    int links;                // number of links its model of the beam has
    double mass_factor;       // of the beam's mass and its moments of inertia
    double inertia_factor;    // of the hub's moment of inertia
    double friction_factor;   // of Coulomb and viscous friction
    double torque_factor;     // of kT
    double k2_factor;         // of k2 (of that of control.k2_table)
    double hub_spring_factor; // of k1, where the hub has a spring
    double wall_error;        // nominal wall angle minus the wall's [rad]
    double delay_error;       // nominal delay of commands minus the true one [s]
} nominal_model_parameters;

// In the order of the choices of sensor.force.
typedef enum force_sensor { FORCE_BY_FSR, FORCE_BY_PIEZO } force_sensor;

enum { CONTROL_MOST_DELAY = 5 }; // from a sample to its command [periods]

typedef struct sensor_parameters {
    bool ideal;                     // all imperfections of sensors and converters are off
    int force;                      // force_sensor: whose reading a controller gets as the force
    int encoder_counts;             // per revolution, 0: continuous
    double encoder_gain_error;      // share by which it shows more than there is
    double encoder_offset;          // [rad]
    double tachometer_gain;         // [V s/rad]
    double tachometer_ripple;       // amplitude as a share of the reading
    int tachometer_ripple_count;    // ripples a revolution
    double tachometer_noise;        // standard deviation [V]
    double tachometer_gain_error;   // share by which it shows more than there is
    double tachometer_offset;       // [rad/s]
    double fsr_rise_time;           // 10 % to 90 % [s]
    double fsr_resistance;          // at 1 N [ohm]
    double fsr_exponent;            // of the power law
    double fsr_divider;             // measuring resistor [ohm]
    double fsr_supply;              // across the divider [V]
    double fsr_gain;                // of the stage behind it
    double fsr_saturation;          // force beyond which the resistance falls no further [N]
    double fsr_noise;               // standard deviation [V]
    double fsr_gain_error;          // share by which it shows more than there is
    double fsr_offset;              // [N]
    double fsr_hysteresis;          // share by which it lags behind a force that turns
    bool piezo;                     // piezoelectric force sensor fitted
    double piezo_gain;              // [V/N]
    double piezo_rise_time;         // 10 % to 90 % [s]
    double piezo_leak_time;         // time constant with which its charge leaks, 0: it stays [s]
    double piezo_range;             // largest force it shows either way, 0: any [N]
    double piezo_noise;             // standard deviation [V]
    double piezo_gain_error;        // share by which it shows more than there is
    double piezo_offset;            // [N]
    bool film;                      // piezo film along the beam fitted
    double film_gain;               // [V/rad]
    double film_leak_time;          // time constant with which its charge leaks, 0: it stays [s]
    double film_noise;              // standard deviation [V]
    bool accelerometer;             // on the hub, fitted
    double accelerometer_gain;      // [V s2/rad]
    double accelerometer_rise_time; // 10 % to 90 % [s]
    double accelerometer_range;     // largest acceleration it shows either way, 0: any [rad/s2]
    double accelerometer_noise;     // standard deviation [V]
    int adc_bits, dac_bits;         // 0: continuous
    double adc_range;               // either way [V]
} sensor_parameters;

typedef struct parameters {
    arm_parameters arm;
    motor_parameters motor;
    wall_parameters wall;
    method_parameters method;
    printed_parameters printed;
    initial_parameters initial;
    run_parameters run;
    control_parameters control;
    nominal_model_parameters belief;
    sensor_parameters sensor;
    bool code_allowed; // the user allows the scenario to start a program or load a plug-in; no file
                       // can allow it
    unsigned char set[160]; // set[i] is 1 if parameter i was given, 0 if it is a default
} parameters;

typedef enum parameter_type {
    PARAMETER_REAL,
    PARAMETER_INTEGER,
    PARAMETER_BOOLEAN,
    PARAMETER_CHOICE,
    PARAMETER_TEXT, // of at most PARAMETER_TEXT_SIZE - 1 bytes; has no number, no range
    PARAMETER_LIST  // of numbers, kept as such a text "10, 12, 9"; unit and range are each number's
} parameter_type;

typedef struct parameter_info {
    const char *path; // "arm.k2"
    size_t offset;    // in struct parameters
    parameter_type type;
    const char *unit; // "N m/rad", "" for a pure number
    double default_corrected;
    double default_printed;
    double minimum, maximum; // both included
    const char *choices;     // "rigid|spring" in the order of the enumeration; of a text what it is
                             // where nothing gives it; else NULL
    bool timed;              // may be changed during a run
    const char *description; // one sentence without a full stop
} parameter_info;

// The table and its length.
extern const parameter_info parameter_table[];
extern const int parameter_count;

// Whether its value is kept as a text and has no number.
static inline bool parameter_is_text(const parameter_info *info)
{
    return info->type == PARAMETER_TEXT || info->type == PARAMETER_LIST;
}

// The numbers of a list as it is kept; returns how many there are, 0 for the empty list, which is
// the default.
int parameter_list_numbers(const char *list, double numbers[PARAMETER_LIST_MOST]);

// Length of each link [m], lengths[links], of resolved parameters.
void parameters_link_lengths(const arm_parameters *a, double *lengths);

// Stiffness of the joint before each link [N m/rad], stiffness[links], of resolved parameters: that
// of the hub's spring or the beam's root (0 with a rigid hub), then of the inner joints.
void parameters_joint_stiffness(const arm_parameters *a, double *stiffness);

// Whether all links have one length and all joints the stiffness of one beam, as they do without
// lists; a hub spring of its own does not count.
bool parameters_even_links(const arm_parameters *a);

// How far behind the wall an arm may start, by rounding, as a share of its length.
#define START_ROUNDING 1e-15

// The range in which a value of a parameter is usually tried [its unit], that of a slider: all that
// it may be, or where that is much wider than its default what lies about the default and the
// value; logarithmic where it spans decades. False if the parameter is not a number.
bool parameter_usual_range(int parameter, double value, double *low, double *high,
                           bool *logarithmic);

// Index of a path in the table, or -1.
int parameter_find(const char *path);

// Index of the parameter of a field, PARAMETER_INDEX(arm.k2); a misspelt one does not compile.
#define PARAMETER_INDEX(field) parameter_at(offsetof(parameters, field))

// Index of the parameter that starts at an offset of struct parameters.
int parameter_at(size_t offset);

// Index of a path that the program itself names: an unknown one fails an assertion.
int parameter_index(const char *path);

// Index of a path as people write it; -1, with a sentence in f that names the nearest, if there is
// no such parameter.
int parameter_look_up(const char *path, fault *f);

// The path of that name in another group, or the nearest to a misspelt one (for "did you mean");
// NULL if there is none.
const char *parameter_suggest(const char *path);

// All defaults of the given model (arm_model_kind), nothing marked as set.
void parameters_defaults(parameters *p, arm_model_kind model);

// Gives all parameters that are not marked as set, except arm.model itself, their defaults for
// p->arm.model.
void parameters_restore_defaults(parameters *p);

// Parses text as a value of parameter `index` and stores it, marked as set. A trailing unit equal
// to the parameter's own is accepted ("0.1 rad"); the numbers of a list stand between commas, in
// brackets or not ("[10, 12 N m/rad]"). ".NAME=VALUE" gives one number of control.settings a value
// (src/tables/settings.h). On a wrong type, a value that is not finite or
// one out of range nothing is stored and f says what was wrong and what was expected.
status parameter_set_text(parameters *p, int index, const char *text, fault *f);

// Stores a number (an enumeration's index for a choice, 0 or 1 for a boolean), checked as above. A
// text takes no number.
status parameter_set_number(parameters *p, int index, double value, fault *f);

// The value as a number; NaN where an optional parameter has none, 0 for a text.
double parameter_get(const parameters *p, int index);

// The value as text, as a scenario file would give it, without its unit.
void parameter_format(const parameters *p, int index, char *text, size_t size);

// Fills what depends on other parameters: defaults that follow arm.model for everything not set,
// arm.link_inertia of a uniform link, arm.EI or arm.k2 from the one that was given, and arm.k1 of a
// beam's root. Checks combinations (arm.link_inertia with N != 2, arm.EI beside arm.k2, the printed
// model with N != 2 ...). Call after the last parameter was set.
status parameters_resolve(parameters *p, fault *f);

// Whether a parameter of resolved parameters may be given another value. False, with the reason in
// f, for one that follows from others there: arm.k1 of a beam's root, arm.k2 and arm.EI beside
// arm.joint_stiffness.
status parameter_may_change(const parameters *p, int index, fault *f);

// Lets what depends on parameter `index` follow it in resolved parameters, as a change during a run
// asks for it: arm.k2, arm.EI and the root of a beam.
void parameters_follow(parameters *p, int index);
