// The runs beside the present one: pinned ones, those of a sweep, the difference to the
// baseline.
#pragma once

#include "src/run/run.h"
#include "src/session/run_origin.h"
#include "src/study/sweep_axis.h"
#include "ui/explorer/state/command_list.h"

// --- pinned runs -----------------------------------------------------------------------
// Stored with names and changes, and shown together with the present run.

enum { PINNED_RUNS = LESSON_PINNED_RUNS, RUN_NAME = LINE_TEXT };

#define AS_OPENED "as opened" // the name of a run without changes

typedef struct pinned_run {
    char name[RUN_NAME];
    run_result run;   // its rows are shared with the session's
    run_origin from;  // also of another scenario than the present one
    unsigned long id; // unique among all runs ever pinned in the list
    bool hidden;
} pinned_run;

typedef struct run_list {
    pinned_run runs[PINNED_RUNS];
    int count;
    int baseline;         // the run with which the present one is compared; -1 for none
    int selected;         // index in the list
    unsigned long pinned; // number of runs ever pinned
} run_list;

// Pins the present run of a session under the given name, or one that describes the last
// change, and makes it the baseline. A run of the same changes is not pinned twice.
// STATUS_BAD_ARGUMENT if the list is full, STATUS_NO_MEMORY.
status run_list_pin(run_list *list, const session *s, const char *name, fault *f);

// What tells the present run of a session from that of its scenario: its last change.
void run_list_describe(const session *s, char *text, size_t size);

// Names the runs that are not of the session's scenario, and were "as opened", after
// their own.
void run_list_name_strangers(run_list *list, const session *s);

// The value of an input as it is shown: a number without the digits of its rounding.
void input_value_text(const session_input *in, char text[SESSION_INPUT_TEXT]);

// The last part of a scenario's name.
const char *scenario_leaf(const char *name);

// Removes a run from the list.
void run_list_drop(run_list *list, int index);

// The number of runs of the list that are of the session's scenario.
int run_list_of_scenario(const run_list *list, const session *s);

// The difference between a run of the list and the present one as a line of text: changes
// that only the former has, then, in brackets, those that only the latter has. Of another
// scenario its name.
void run_list_differences(const pinned_run *p, const session *s, char *text, size_t size);

// --- a sweep ---------------------------------------------------------------------------
// The present run with several values of one parameter from the start, each as a run of
// its own; or a map: all pairs of values of two parameters, of which the summaries are
// kept.

enum { SWEPT_RUNS = 32, MAP_CELLS = 1024 };

typedef struct swept_run {
    double value; // of the parameter
    run_result run;
    unsigned long id;
} swept_run;

typedef struct lab_sweep {
    sweep_axis axis;            // axis.text NULL: no sweep
    sweep_axis second;          // of a map; second.text NULL: none
    swept_run runs[SWEPT_RUNS]; // of a sweep
    summary *summaries;     // of all, the first parameter's values one after the other
    int count;              // computed so far
    int selected;           // index of the selected one
    int metric;             // index in summary_table
    unsigned long computed; // number of runs ever computed
} lab_sweep;

// Whether there is a sweep, of two parameters, and whether it is complete.
bool lab_sweep_is_on(const lab_sweep *sweep);
bool lab_sweep_is_map(const lab_sweep *sweep);
bool lab_sweep_is_done(const lab_sweep *sweep);

// How many runs it has when it is complete, and how many of them have curves.
int lab_sweep_total(const lab_sweep *sweep);
int lab_sweep_curves(const lab_sweep *sweep);

// The metric of a run that was computed.
double lab_sweep_metric(const lab_sweep *sweep, int index, int metric);

// A run's values of both parameters; the second is NaN without a map.
void lab_sweep_values(const lab_sweep *sweep, int index, double values[2]);

// Begins a sweep given as "PATH=a:b:n", "PATH=a:b:n:log" or "PATH=v1,v2,...", of one
// parameter or of two with a blank between them; nothing is computed yet. On
// STATUS_BAD_ARGUMENT, with the reason in f, the previous sweep is kept.
status lab_sweep_begin(lab_sweep *sweep, const char *definition, fault *f);

// Computes the next run of a sweep from the scenario of the present run. A value that
// cannot be run ends the sweep, with the reason in f.
status lab_sweep_compute_next(lab_sweep *sweep, const scenario *base, fault *f);

void lab_sweep_end(lab_sweep *sweep);

// --- a limit ---------------------------------------------------------------------------

// The condition that was asked for last, drawn in the panes of its signal.
typedef struct solved_limit {
    int signal; // index in signal_table, -1: none to draw it at
    double bound;
    int quantity; // of the summary that it bounds, -1: none
} solved_limit;

// --- notes -----------------------------------------------------------------------------

enum { NOTES = 32 };

// What the user has to say at an instant.
typedef struct note {
    double time; // [s]
    char text[LINE_TEXT];
} note;

// --- the difference --------------------------------------------------------------------
// Of one trace from another, row by row of the first: of the present run from the
// baseline, of measured data from the present run. Contact, sticking and the controller's
// mode stay the first's.

typedef struct run_difference {
    bool on;             // panes show it in the place of the runs
    double tolerance;    // of the first signal of the pane in focus, 0 for none
    trace trace;         // the differences; empty if there is none
    unsigned long built; // counts the traces begun
    unsigned long run;   // what it was computed from
    size_t rows;         // of that
} run_difference;

// Brings the differences of a trace from another one up to the rows there are, if they
// are wanted. `run` identifies both.
void difference_update(run_difference *d, unsigned long run, const trace *of,
                       const trace *from);

// The first instant at which a signal differs by more than a tolerance [s]; negative if
// it never does.
double difference_first_beyond(const run_difference *d, int signal, double tolerance);

void difference_finish(run_difference *d);
