// Random rigs: the parts of the program random_rigs, and what they share.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <impactlab/impactlab.h>

#include "src/base/random.h"

#define INSTANT 1e-9 // two instants nearer than this are one [s]

// Errors that are allowed, as shares of the largest value: of rounding, of a lag in the
// rig's sensors, and of the slow lag behind sensor_1ms_peak_N.
#define ROUNDING      1e-9
#define FOLLOWED      1e-6
#define FOLLOWED_PEAK 1e-4

// A first-order lag with the time constant T rises from 10 % to 90 % in T log(90 / 10).
#define RISE_RATIO 9.0

extern double spacing; // between two rows of a run [s]
extern char **given;   // settings from the command line; they replace those drawn
extern int given_count;

enum { MOST_SETTINGS = 96, LONGEST_SETTING = 96, MOST_SAMPLES = 8192, MOST_CHANGES = 3 };

typedef struct rig {
    uint64_t number;
    random_generator chance;
    impactlab_scenario *scenario;
    char settings[MOST_SETTINGS][LONGEST_SETTING]; // "path=value"
    int count;                                     // of settings
    long wrong;                                    // values not as expected
    struct change {
        double at, value; // the instant [s], and the new value or the push [N s]
        char path[48];    // of the parameter; "" stands for a push
    } changes[MOST_CHANGES];
    int change_count;
} rig;

enum column {
    TIME,
    HUB_ANGLE,
    FIRST_ANGLE,
    LAST_ANGLE,
    HUB_VELOCITY,
    FIRST_VELOCITY,
    LAST_VELOCITY,
    HUB_ACCELERATION,
    GAP,
    GAP_VELOCITY,
    FORCE,
    IMPULSE,
    CONTACT,
    STICKING,
    VOLTAGE,
    MOTOR_TORQUE,
    KINETIC,
    STRAIN,
    MOTOR_WORK,
    EXTERNAL_WORK,
    VISCOUS_LOSS,
    FRICTION_LOSS,
    DAMPING_LOSS,
    IMPACT_LOSS,
    RESIDUAL,
    WALL_ENERGY,
    WALL_LOSS,
    WALL_WORK,
    WEIGHT_ENERGY,
    FACE_DEPTH,
    COMMAND,
    ENCODER,
    TACHOMETER,
    FORCE_READING,
    PIEZO_FORCE,
    FILM,
    ACCELEROMETER,
    COLUMNS
};

// An instant at which the rig's controller samples.
typedef struct sample {
    double time, applied; // of the readings; when the command takes effect [s]
    double reading[6];    // in the order of the columns from ENCODER on
    double command;       // of the law [V]
    double voltage;       // that the motor gets for it, limited and converted [V]
} sample;

// A run: its rows by columns, its samples, and when it ends.
typedef struct motion {
    size_t count; // of rows
    double *of[COLUMNS];
    impactlab_run *run;
    sample samples[MOST_SAMPLES];
    int sample_count;
    double ends; // [s]
} motion;

// A straight line from (from, begin) to (to, end) that stands for a function between two
// instants, and by how much the function may differ from it.
typedef struct piece {
    double from, to, begin, end, error;
    bool drawn; // an end lies on a neighbouring line drawn on, not on a row
} piece;

typedef struct pieces {
    piece *of;
    size_t count;
} pieces;

// What acts in an instant: the impulse of an impact, or a change of the hub's velocity.
typedef struct blow {
    double time, size;
} blow;

typedef struct blows {
    blow *of;
    size_t count;
} blow_list;

// A sensor that follows a function f with a first-order lag, T y' + y = f, and loses
// charge through a leak, S w' + w = y. It shows y - w.
typedef struct lag {
    double T, S;             // time constants [s]; T = 0: y = f, S = 0: w = 0
    double y, w;             // at this instant
    double y_error, w_error; // by how much they may be wrong
} lag;

// A filter on its way in time through the pieces of a function and the blows upon it.
typedef struct follower {
    lag state;
    const pieces *of;
    const blow_list *blows;
    size_t piece, blow; // the next of each
    double now;         // [s]
    double rounding;    // by which the function may be off

    // a hysteresis: half its width as a share of the value, and bounds of what it holds
    double share, play_low, play_high;
} follower;

// rig_draw.c: Draws a rig: arm, motor, wall, law, sensors and what changes in the run.

// Adds a setting, "path=value".
__attribute__((format(printf, 2, 3))) void set(rig *r, const char *format, ...);
// A random number whose logarithm is spread evenly.
double between(rig *r, double from, double to);
// True with the probability `share`.
bool happens(rig *r, double share);

// Prints an error of the library and ends the program.
void fail(const char *what, const impactlab_error *error);

// The value of a parameter at the start of the run.
double number(const rig *r, const char *path);
// Whether the parameter's value is this word.
bool is(const rig *r, const char *path, const char *word);
// A parameter at an instant of the run.
double number_at(const rig *r, const char *path, double t);

// Draws a rig; false if its parts do not go together.
bool draw(rig *r, uint64_t which);

// rig_expect.c: What is expected of a value, and what was found wrong, by kind.

// A value that is to lie between two others; `at` [s] says where it belongs.
void expect(rig *r, const char *what, double at, double got, double low, double high);

void expect_near(rig *r, const char *what, double at, double got, double wanted,
                 double error);

// Prints each kind of value that was found wrong: how often, by how much, in which rig.
void print_what_was_wrong(void);

// How many values have been compared with what was expected.
long values_checked(void);

// rig_motion.c: The motion of a rig: rows of the run, and readings at samples.

// 0 in place of a NaN.
double or_zero(double x);
// A number of the run's summary; NaN if it is none or not known.
double quantity(const motion *m, const char *key);
bool has_quantity(const motion *m, const char *key);
void read_rows(motion *m);
// The sampling instants, and the readings there, of the same rig stepped by hand.
void read_samples(const rig *r, motion *m);

void forget(motion *m);

// rig_commands.c: Commands of the samples and what rows say of them and of readings.

// Commands of the samples, from the rows after them, and what the motor gets for them.
void follow_commands(const rig *r, motion *m);

// What the rows say of commands, and of readings between samples.
void check_rows(rig *r, motion *m);

// The sampling instants are a period apart, to within the jitter.
void check_instants(rig *r, const motion *m);

// rig_between_rows.c: What a quantity is between two rows, and within which bounds.

// The first derivative.
double slope(const piece *p);
// The second derivative, from two pieces that are not separated by a jump.
double bend(const piece *p, const piece *q);

// The pieces of a column, one between every two rows. Where the voltage changes between
// two rows the column may jump: there are two pieces then, which the lines on both sides,
// drawn on to the instant of the jump, give.
pieces pieces_of(const motion *m, const double *column);

double value_within(const piece *p, double t);
// The integral over an interval, and how far it may be from the function's.
double integral(const pieces *f, double from, double to, double *error);

// The impulses of the run's impacts.
blow_list impulses_of(const motion *m);
// The jumps of a column: two rows of one instant with different values.
blow_list jumps_of(const motion *m, const double *column);

// rig_filters.c: Filters of the sensors, written from the manual: lag, leak, play.

// Adds a blow, the integral of the function over an instant: the lag jumps by size / T.
void lag_take_blow(lag *l, double size);
// By how much a lag's output may exceed the straight line between its values at the ends
// of an interval of the length h, if it has a maximum there.
double turning(const lag *l, const piece *p, double h);

// Goes on to the instant t. A blow at t itself is not yet in the state.
void follower_reach(follower *f, double t);

// A follower at the start of a function, with the rise time and the leak time of a
// sensor.
follower follower_of(const pieces *of, const blow_list *blows, double rise, double leak);

// rig_sensors.c: Readings of the sensors, computed again from the motion.

// A value as a converter of so many bits has it: whole steps, the largest one below its
// range.
double converted(double value, double bits, double range);

// What the FSR's gain stage gives for a force above zero [V].
double expected_fsr_volts(const rig *r, double x);

void check_angles(rig *r, const motion *m);
void check_fsr(rig *r, const motion *m, const pieces *force, const blow_list *impulses);
void check_optional(rig *r, const motion *m, const pieces *force,
                    const blow_list *impulses);

// rig_summary.c: Numbers of the summary, computed again from rows and events.

// The largest value of a column times `sign`.
double largest_of(const motion *m, const double *column, double sign);
// The force of an elastic wall without a mass, which follows from the depth and its rate.
void check_contact_law(rig *r, const motion *m);

void check_summary(rig *r, const motion *m, const pieces *force,
                   const blow_list *impulses);

// rig_energy.c: The ledger of energy, computed again from powers.

void check_energy(rig *r, const motion *m);

// rig_noise.c: The noise of the sensors, by its mean and variance.

// The noise [V] of each sensor at its converter: by what the readings of two equal runs
// with and without noise differ. The law is an open loop, so that no reading changes the
// motion.
void check_noise(rig *r);
