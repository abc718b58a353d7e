// The results of a run as numbers, and the one table that describes them. It feeds `run`
// and its JSON, expectations of scenario files, sweeps, comparisons and the terminal.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/base/fault.h"

// The numbers of a run: field and key, name, label, unit, description, and what is
// special about it. Those of the rig, from `force_command_N` to `return_speed_m_s`, are
// NaN without one.
#define SUMMARY_NUMBERS_OF_A_RUN(NUMBER)                                                 \
    NUMBER(first_contact_s, "first_contact", "first contact", "s",                       \
           "the arm touches the wall for the first time")                                \
    NUMBER(contact_impulse_Ns, "contact_impulse", "contact impulse", "N s",              \
           "impulse of the first impact")                                                \
    NUMBER(first_pulse_peak_N, "first_pulse_peak", "first pulse peak", "N",              \
           "largest force from first contact to first release")                          \
    FORCE_BOUNDS(NUMBER, first_pulse_peak, "first pulse peak",                           \
                 "largest force from first contact to first release")                    \
    NUMBER(first_pulse_time_to_peak_s, "first_pulse_time_to_peak",                       \
           "first pulse time to peak", "s", "from first contact to that force")          \
    NUMBER(first_pulse_s, "first_pulse", "first pulse", "s",                             \
           "from first contact to first release")                                        \
    NUMBER(peak_force_N, "peak_force", "peak force", "N",                                \
           "largest force of the whole run")                                             \
    FORCE_BOUNDS(NUMBER, peak_force, "peak force", "largest force of the whole run")     \
    NUMBER(time_to_peak_s, "time_to_peak", "time to peak", "s",                          \
           "from first contact to that force")                                           \
    NUMBER(                                                                              \
        sensor_1ms_peak_N, "sensor_1ms_peak", "sensor 1ms peak", "N",                    \
        "largest force that a first-order sensor of 1 ms would read, impulses included") \
    NUMBER(impacts, "impacts", "impacts", "", "impacts of the whole run")                \
    NUMBER(separations, "separations", "separations", "",                                \
           "flights after first contact with a gap above 1 um, to the face of a wall "   \
           "that has one")                                                               \
    NUMBER(steady_force_N, "steady_force", "steady force", "N",                          \
           "mean force over the last 0.1 s")                                             \
    FORCE_BOUNDS(NUMBER, steady_force, "steady force", "mean force over the last 0.1 s") \
    NUMBER(force_overshoot_percent, "force_overshoot", "force overshoot", "%",           \
           "largest force over the steady one")                                          \
    NUMBER(settling_time_s, "settling_time", "settling time", "s",                       \
           "from first contact until the force is steady within 5 % for good")           \
    NUMBER(max_penetration_m, "max_penetration", "max penetration", "m",                 \
           "largest depth of the arm behind the wall")                                   \
    NUMBER(motor_work_J, "motor_work", "motor work", "J",                                \
           "work done by the motor torque")                                              \
    NUMBER(energy_residual_J, "energy_residual", "energy residual", "J",                 \
           "largest energy that the ledger does not account for")                        \
    NUMBER(wall_loss_J, "wall_loss", "wall loss", "J",                                   \
           "energy lost in a wall that gives", .special = true)                          \
    NUMBER(wall_work_J, "wall_work", "wall work", "J",                                   \
           "work of a moving wall on the arm", .special = true)                          \
    NUMBER(force_command_N, "force_command", "force command", "N",                       \
           "force that the controller is to hold at the end", .special = true)           \
    NUMBER(force_over_command_N, "force_over_command", "force over command", "N",        \
           "largest force minus the commanded one", .special = true)                     \
    NUMBER(smoothed_over_command_N, "smoothed_over_command", "smoothed over command",    \
           "N",                                                                          \
           "largest mean of the force over 5 ms, impulses included, from 20 ms after "   \
           "first "                                                                      \
           "contact on, minus the commanded force",                                      \
           .special = true)                                                              \
    NUMBER(steady_error_N, "steady_error", "steady error", "N",                          \
           "steady force minus the commanded one", .special = true)                      \
    NUMBER(largest_command_V, "largest_command", "largest command", "V",                 \
           "largest command to the amplifier either way", .special = true)               \
    NUMBER(electrical_energy_J, "electrical_energy", "electrical energy", "J",           \
           "energy that the amplifier fed into the motor", .special = true)              \
    NUMBER(approach_speed_m_s, "approach_speed", "approach speed", "m/s",                \
           "largest speed of the tip towards the wall before first contact",             \
           .special = true)                                                              \
    NUMBER(return_speed_m_s, "return_speed", "return speed", "m/s",                      \
           "largest speed of the tip towards the wall, or its face, in flights after "   \
           "first contact",                                                              \
           .special = true)                                                              \
    NUMBER(steps, "steps", "steps", "", "time steps taken")                              \
    NUMBER(cpu_time_s, "cpu_time", "cpu time", "s", "processor time of the run",         \
           .timing = true)                                                               \
    NUMBER(wall_time_s, "wall_time", "wall time", "s",                                   \
           "time that passed during the run", .timing = true)

// The bounds of a force that is not determined, else NaN.
#define FORCE_BOUNDS(NUMBER, number, label, what)                                        \
    NUMBER(number##_low_N, #number "_low", label " low", "N",                            \
           "least that the " what " may be where it is not determined", .special = true) \
    NUMBER(number##_high_N, #number "_high", label " high", "N",                         \
           "most that the " what " may be where it is not determined", .special = true)

// The results of a run. A quantity that did not occur is NaN (null in JSON).
typedef struct summary {
    status status;
    bool inaccurate;  // it came to its end, but not to be relied on: the message says why
    const char *path; // of the parameter that stopped the run, a literal; "" if none did
    char message[1024]; // what stopped the run, or a remark; "" if there is none
    char method[32];    // the method in fact used, "pair"
    // numbers only from here on, see summary_value
#define SUMMARY_FIELD(number, ...) double number;
    SUMMARY_NUMBERS_OF_A_RUN(SUMMARY_FIELD)
#undef SUMMARY_FIELD
} summary;

typedef struct summary_info {
    const char *key;   // in JSON, expectations and on the command line, "first_contact_s"
    const char *name;  // in headings of CSV files, "first_contact"
    const char *label; // for people, "first contact"
    const char *unit;  // "s", "" for a count
    const char *description; // one sentence without a full stop
    bool timing;             // depends on the machine, not on the scenario
    bool special; // present only in some runs: with a control law, a wall that gives
} summary_info;

// The table, in the order of the numbers of struct summary and of `run --json`.
extern const summary_info summary_table[];
extern const int summary_count;
enum {
    SUMMARY_NUMBERS =
        (sizeof(summary) - offsetof(summary, first_contact_s)) / sizeof(double)
};

// Index in the table of a number of struct summary; a constant, and a misspelt one does
// not compile.
#define SUMMARY_INDEX(number)                                                            \
    ((int)((offsetof(summary, number) - offsetof(summary, first_contact_s)) /            \
           sizeof(double)))

// Index of a key in the table, or -1.
int summary_find(const char *key);
// The same of a key's beginning up to a "_", as people type it ("peak"): the first.
int summary_find_begun(const char *text);

// Index of a key that is known to be there: an unknown one fails an assertion.
int summary_index(const char *key);

// The key nearest to a misspelt one (for "did you mean"), or NULL if none is near.
const char *summary_suggest(const char *key);

// The number with that index.
double summary_value(const summary *s, int index);

// "ok", "inaccurate" or "failed", as JSON and databases have it.
const char *summary_status(const summary *s);

// The fault that ended a run: fills f (may be NULL) with its sentence and parameter.
// Returns the status.
status summary_fault(const summary *s, fault *f);

// The summary of a run of which nothing is known yet: STATUS_OK, no texts, every number
// NaN.
void summary_init(summary *s);
