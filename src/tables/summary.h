// The results of a run as numbers, and the one table that describes them. It feeds `run` and its
// JSON, expectations of scenario files, sweeps, comparisons and the terminal.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/base/fault.h"

// The results of a run. A quantity that did not occur is NaN (null in JSON).
typedef struct summary {
    status status;
    bool inaccurate;    // it came to its end, but not to be relied on: the message says why
    const char *path;   // of the parameter that stopped the run, a literal; "" if none did
    char message[1024]; // what stopped the run, or a remark; "" if there is none
    char method[32];    // the method in fact used, "pair"
    // numbers only from here on, see summary_value
    double first_contact_s;
    double contact_impulse_Ns; // impulse of the first impact
    double first_pulse_peak_N; // largest force from first contact to first release
    // the bounds of a force that is not determined, else NaN
    double first_pulse_peak_low_N, first_pulse_peak_high_N;
    double first_pulse_time_to_peak_s;
    double first_pulse_s; // length of the first pulse; NaN if it never ends
    double peak_force_N;  // largest force of the whole run
    double peak_force_low_N, peak_force_high_N;
    double time_to_peak_s; // after first contact
    double impacts;
    double separations;    // episodes after first contact with a gap above 1 um
    double steady_force_N; // mean over the last 0.1 s
    double steady_force_low_N, steady_force_high_N;
    double force_overshoot_percent; // of peak_force_N over steady_force_N
    double settling_time_s; // from first contact until within 5 % of steady_force_N for good
    double max_penetration_m;
    double motor_work_J;
    double energy_residual_J; // largest absolute value over the run
    double wall_loss_J;       // lost in a wall that gives, NaN at a rigid one
    // on the rig only, else NaN
    double force_command_N;         // control.force
    double force_over_command_N;    // peak_force_N - force_command_N
    double smoothed_over_command_N; // largest mean over 5 ms from 20 ms after contact on, less
                                    // force_command_N
    double steady_error_N;          // steady_force_N - force_command_N
    double largest_command_V;       // in magnitude, of those that took effect
    double electrical_energy_J;     // that the amplifier fed into the motor
    double approach_speed_m_s;      // largest of the tip towards the wall before first contact
    double return_speed_m_s; // the same in flights after first contact, 0 if contact is never lost
    double steps;            // time steps taken
    double cpu_time_s;       // processor time of the run's own thread
    double wall_time_s;      // time that passed meanwhile
} summary;

typedef struct summary_info {
    const char *key;         // in JSON, expectations and on the command line, "first_contact_s"
    const char *name;        // in headings of CSV files, "first_contact"
    const char *label;       // for people, "first contact"
    const char *unit;        // "s", "" for a count
    const char *description; // one sentence without a full stop
    bool timing;             // depends on the machine, not on the scenario
    bool special;            // present only in some runs: with a control law, a wall that gives
} summary_info;

// The table, in the order of the numbers of struct summary and of `run --json`.
extern const summary_info summary_table[];
extern const int summary_count;
enum { SUMMARY_NUMBERS = (sizeof(summary) - offsetof(summary, first_contact_s)) / sizeof(double) };

// Index in the table of a number of struct summary; a constant, and a misspelt one does not
// compile.
#define SUMMARY_INDEX(number)                                                                      \
    ((int)((offsetof(summary, number) - offsetof(summary, first_contact_s)) / sizeof(double)))

// Index of a key in the table, or -1.
int summary_find(const char *key);

// Index of a key that is known to be there: an unknown one fails an assertion.
int summary_index(const char *key);

// The key nearest to a misspelt one (for "did you mean"), or NULL if none is near.
const char *summary_suggest(const char *key);

// The number with that index.
double summary_value(const summary *s, int index);

// "ok", "inaccurate" or "failed", as JSON and databases have it.
const char *summary_status(const summary *s);

// The fault that ended a run: fills f (may be NULL) with its sentence and parameter. Returns the
// status.
status summary_fault(const summary *s, fault *f);

// The summary of a run of which nothing is known yet: STATUS_OK, no texts, every number NaN.
void summary_init(summary *s);
