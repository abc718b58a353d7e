// What a run leaves behind: summary, rows and history; and what may be asked of it.
#pragma once

#include <math.h>
#include <stdatomic.h>

#include "src/run/force_history.h"
#include "src/run/trace.h"

// The result of a run. A quantity that did not occur is NaN (null in JSON).
typedef struct summary {
    status status;
    char message[1024]; // what stopped the run, or a remark; "" if there is none
    char method[32];    // the method in fact used, "Runge-Kutta 8"
    double first_contact_s;
    double contact_impulse_Ns; // impulse of the first impact
    double first_pulse_peak_N; // largest force from first contact to first release
    double first_pulse_time_to_peak_s;
    double first_pulse_s;  // length of the first pulse; NaN if it never ends
    double peak_force_N;   // largest force of the whole run
    double time_to_peak_s; // after first contact
    double impacts;
    double separations;             // episodes after first contact with a gap above 1 um
    double steady_force_N;          // mean over the last 0.1 s
    double force_overshoot_percent; // of peak_force_N over steady_force_N
    double settling_time_s; // from first contact until within 5 % of steady_force_N for good
    double max_penetration_m;
    double motor_work_J;
    double energy_residual_J; // largest absolute value over the run
    // on the rig only, else NaN
    double force_command_N;      // control.force
    double force_over_command_N; // peak_force_N - force_command_N
    double steady_error_N;       // steady_force_N - force_command_N
    double largest_command_V;    // in magnitude, as the D/A put it out
    double electrical_energy_J;  // that the amplifier fed into the motor
    double steps;                // time steps taken
    double wall_time_s;          // computing time
} summary;

// Keys of the summary in the order of `run --json`, with the offset of each number.
typedef struct summary_info {
    const char *key;
    size_t offset;
    bool timing; // depends on the machine, not on the scenario
} summary_info;
extern const summary_info summary_table[];
extern const int summary_count;

// A summary's number by key; false if there is no such key.
bool summary_get(const summary *s, const char *key, double *value);

// What a run that can be resumed (src/run/resume.h) keeps besides its rows.
typedef struct run_history {
    force_history forces;
    shared_array checkpoints; // of the run, every few hundred rows (src/run/checkpoint.h)
    size_t checkpoint_count;
} run_history;

typedef struct run_result {
    summary summary;
    trace trace; // rows at every step and on both sides of every event; empty if not asked for
    double *before_impact;     // corrected model: angles[dof], then velocities[dof], at the instant
                               // before the first impact [rad], [rad/s]; NULL if there was none
    size_t before_impact_size; // [bytes]
    run_history history;       // empty unless asked for
} run_result;

// What another thread may know about a run, and tell it. All zero at the start.
typedef struct run_monitor {
    atomic_bool stop;     // set from outside: the run ends as soon as it sees that
    atomic_size_t rows;   // of the trace that can be read
    atomic_size_t events; // the same
    _Atomic double time;  // how far the run has come [s]
} run_monitor;

typedef struct run_options {
    bool keep_trace;      // false keeps no rows (events and summary only)
    run_monitor *monitor; // NULL: nobody looks on
    size_t rows_expected; // if not 0, rows and events stay where they are and can be shared, and
                          // the result has a history; needs keep_trace
    bool resume;          // *result was prepared by run_resume: go on from there
} run_options;

// Frees what the result holds; one of zeroes is allowed.
void run_finish(run_result *result);
