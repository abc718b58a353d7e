// The result of a run: summary, rows and history; the options of a run, and its forces.
#pragma once

#include <stdatomic.h>
#include <stdbool.h>

#include "src/base/extremes.h"
#include "src/base/stop.h"
#include "src/predict/predict.h"
#include "src/tables/summary.h"
#include "src/run/trace.h"

// What a run that can be resumed (src/run/resume.h) keeps besides its rows.
typedef struct run_history {
    shared_array forces;      // over every step, a force_step each
    shared_array checkpoints; // of the run, every few hundred rows (src/run/resume.h)
} run_history;

// The first contact that ends a free flight, and its pulse: it is the run's first
// contact, but of an arm that starts on the wall.
typedef struct landing {
    double time;             // [s]; 0: there was none
    double impulse;          // of its impact [N s]
    double peak;             // of its pulse [N], NaN if there was none
    double time_to_peak;     // after it [s]
    three_body_state before; // hub, first and last link at the instant before it; its
                             // first angle is NaN where they are not known: of the
                             // printed model, or where a change brought the contact
} landing;

typedef struct run_result {
    summary summary;
    trace trace; // rows at every step and on both sides of every event; empty if not
                 // asked for
    landing landing;
    run_history history; // empty unless asked for
} run_result;

// What another thread may know about a run, and tell it. All zero at the start.
typedef struct run_monitor {
    atomic_bool stop;     // set from outside: the run ends as soon as it sees that
    atomic_size_t rows;   // of the trace that can be read
    atomic_size_t events; // the same
    _Atomic double time;  // how far the run has come [s]
    atomic_int pieces;    // of work that consists of several runs, those that are over
} run_monitor;

// Whether somebody asked for the end; monitor may be NULL: nobody looks on.
static inline bool run_monitor_stops(const run_monitor *monitor)
{
    return monitor != NULL && atomic_load_explicit(&monitor->stop, memory_order_relaxed);
}

// A piece of the work is over; monitor may be NULL.
void run_monitor_count(run_monitor *monitor);

typedef struct run_options {
    bool keep_trace;     // false keeps no rows (events and summary only)
    row_taker *take_row; // gets each row as it is recorded, kept or not; NULL: nobody
    void *row_context;   // its first argument
    double rows_every;   // rows at multiples of this, too [s], of what is not kept in the
                         // place of those at multiples of method.step; 0: none
    run_monitor *monitor; // NULL: nobody looks on
    const atomic_bool
        *abandon; // without a monitor: becomes true where the run is to end at once
    int (*ask)(
        void *context); // asked whether the run is to end, of a stop_request; NULL: not
    void *ask_context;
    bool untimed; // no clock is read for it: it is one of many that are timed together
    bool stepped; // it can go on where it was stopped: it is asked between steps only
    size_t rows_expected; // if not 0, rows and events stay where they are and can be
                          // shared, and the result has a history; needs keep_trace
    const struct given_law
        *law;         // that a program gives in the place of control.law; NULL: none
    bool resume;      // *result was prepared by run_resume: continue from there
    bool keep_forces; // result->history has the force over every step, without more of a
                      // history
} run_options;

// Frees what the result holds; one of zeroes is allowed.
void run_finish(run_result *result);

// --- the contact force of a whole run, a shared array of force_step --------------------

#define SETTLED_BAND 0.05 // a force has settled within this share of its final value

// The force over one step: at its ends, and its mean.
typedef struct force_step {
    double start, end;        // [s]
    double first, last, mean; // [N]
} force_step;

// The force within a step as a parabola of its share s of the step: first + slope s +
// curve s^2.
typedef struct step_parabola {
    double first, slope, curve; // [N]
} step_parabola;

// The parabola through the ends of a step that has its mean.
static inline step_parabola step_parabola_of(const force_step *step)
{
    double curve = 3 * (step->first + step->last) - 6 * step->mean;
    return (step_parabola){step->first, step->last - step->first - curve, curve};
}

// The force goes no further than this beyond the larger, or below the smaller, of the
// ends of such a step [N]: a parabola bends by a quarter of its curve at most.
static inline double step_bulge(const force_step *step)
{
    return fabs(step_parabola_of(step).curve) / 4;
}

// A force that the step's does not exceed [N].
static inline double step_at_most(const force_step *step)
{
    return larger(step->first, step->last) + step_bulge(step);
}

// The steps, oldest first; good until the next one is added to a plain array.
static inline const force_step *force_steps(const shared_array *h)
{
    return h->base;
}

// Appends a step. STATUS_NO_MEMORY.
status force_history_add(shared_array *h, force_step step)
    __attribute__((warn_unused_result));

// Appends `count` steps that the caller fills in at once. NULL without memory.
force_step *force_history_extend(shared_array *h, size_t count);

// The instant [s] after which the force stays for good within SETTLED_BAND (a share) of
// `final` [N], each step taken as the parabola through its ends that has its mean; NaN if
// the run ends outside, or has no step.
double force_settled_since(const shared_array *h, double final);

// The largest mean [N] of the force over any window of the given length [s] that begins
// at `from` [s] or later and ends within the run; an impulse on a window's edge counts.
// Each step is the parabola through its ends that has its mean, so the extremes are found
// to rounding. NaN if no such window fits into the run.
double force_largest_mean(const run_result *result, double from, double window);

// The largest value [N] that a first-order lag of that time constant [s], a force sensor,
// reads of the force up to an instant [s], HUGE_VAL: to the end; an impulse is a jump by
// impulse over time constant. The lag is followed exactly through each step's parabola,
// and its turns are located. The summary has its peak_force_N already.
double force_largest_sensed(const run_result *result, double time_constant, double until);
