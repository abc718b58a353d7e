// Random rigs: the parts of the program random_rigs, and what they share.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include <impactlab/impactlab.h>

#include "src/base/random.h"

#define INSTANT 1e-9 // two instants nearer than this are one [s]
// of a number or of a row within a step, as a share of the largest
#define ROUNDING      1e-9
#define FOLLOWED      1e-6 // how near the rig follows a lag, as a share of the largest
#define FOLLOWED_PEAK 1e-4 // the same of the slow lag of sensor_1ms_peak_N
// 90 % over 10 %, whose logarithm is a rise time over the constant of its lag
#define RISE_RATIO 9.0

extern double spacing; // of rows [s]
extern char **given;   // settings that replace those drawn
extern int given_count;

enum { MOST_SETTINGS = 96, LONGEST_SETTING = 96, MOST_SAMPLES = 8192, MOST_CHANGES = 3 };

typedef struct rig {
    uint64_t number;
    random_generator chance;
    impactlab_scenario *scenario;
    char settings[MOST_SETTINGS][LONGEST_SETTING];
    int count;
    long wrong;
    struct change {
        double at, value; // [s]
        char path[48];    // "" of a push
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

// An instant at which the rig samples, and what it reads there.
typedef struct sample {
    double time, applied;    // the command takes effect [s]
    double reading[6];       // in the order of the columns from ENCODER on
    double command, voltage; // [V], and what becomes of it
} sample;

typedef struct motion {
    size_t count;
    double *of[COLUMNS];
    impactlab_run *run;
    sample samples[MOST_SAMPLES];
    int sample_count;
    double ends; // [s]
} motion;

// A straight line between two instants, and by how much the function may differ from it.
typedef struct piece {
    double from, to, begin, end, error;
    bool drawn; // on from its neighbours
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

// A first-order lag, T y' + y = f, and behind it what a leak takes off, S w' + w = y.
typedef struct lag {
    double T, S; // [s]; T = 0: y = f, S = 0: w = 0
    double y, w;
    double y_error, w_error;
} lag;

// A filter that goes through the pieces of a function and the blows.
typedef struct follower {
    lag state;
    const pieces *of;
    const blow_list *blows;
    size_t piece, blow;
    double now;
    double rounding;                   // of the function
    double play_low, play_high, share; // of a hysteresis, its bounds
} follower;

// rig_draw.c: Draws a rig: arm, motor, wall, law, sensors and what changes in the run.

__attribute__((format(printf, 2, 3))) void set(rig *r, const char *format, ...);
// A number whose logarithm is spread evenly.
double between(rig *r, double from, double to);

bool happens(rig *r, double share);
void fail(const char *what, const impactlab_error *error);
double number(const rig *r, const char *path);
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

double or_zero(double x);
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

void check_instants(rig *r, const motion *m);

// rig_between_rows.c: What a quantity is between two rows, and within which bounds.

double slope(const piece *p);
// The second derivative, from two pieces that are not separated by a jump.
double bend(const piece *p, const piece *q);

// The pieces of a column. Where the voltage changes between two rows, which makes it
// jump, the lines beyond both are drawn on to that instant.
pieces pieces_of(const motion *m, const double *column);

double value_within(const piece *p, double t);
// The integral over an interval, and how far it may be from the function's.
double integral(const pieces *f, double from, double to, double *error);

blow_list impulses_of(const motion *m);
blow_list jumps_of(const motion *m, const double *column);

// rig_filters.c: Filters of the sensors, written from the manual: lag, leak, play.

void lag_take_blow(lag *l, double size);
// How far a lag's output is from a straight line within a stretch, if it turns there.
double turning(const lag *l, const piece *p, double h);

// Goes on to an instant: the state just before it, blows at the very instant left out.
void follower_reach(follower *f, double t);

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

double largest_of(const motion *m, const double *column, double sign);
// The force of a wall that gives, from its depth and rate; without a mass.
void check_contact_law(rig *r, const motion *m);

void check_summary(rig *r, const motion *m, const pieces *force,
                   const blow_list *impulses);

// rig_energy.c: The ledger of energy, computed again from powers.

void check_energy(rig *r, const motion *m);

// rig_noise.c: The noise of the sensors, by its mean and variance.

// Each sensor's noise [V] at its converter: what readings with it differ by from those
// without, on a motion that no reading changes.
void check_noise(rig *r);
