// A session with one scenario: a run that is looked at from any instant, and changed on the way.
//
// The whole run is computed and kept as rows; "running" moves a cursor over them. What the user
// does (a changed parameter, a push) is an input with its instant, and the run is that of the
// scenario and all inputs. So a saved scenario gives the same run by construction, stepping back
// and forth changes nothing, undo is a shorter list of inputs, and a branch keeps the old run
// beside the new one; rows that both have are kept once.
//
// A run that takes longer than the session's patience is computed by a thread of its own. Until it
// is over `run` shows the rows there are, session_follow brings more, and `computing` is not NULL.
// The cursor may then stand at an instant that has no row yet: `row` is the last one there is.
//
// Rows before a change are those of the unchanged run to the last bit: no step is chosen for an
// input, one that goes beyond it is cut.
#pragma once

#include "src/run/run.h"

struct background_run;

enum { SESSION_INPUT_TEXT = 160 };

typedef enum session_input_kind {
    SESSION_INPUT_START, // another value from the start
    SESSION_INPUT_TIMED, // another value from `time` on
    SESSION_INPUT_PUSH   // an impulse at the tip
} session_input_kind;

typedef struct session_input {
    session_input_kind kind;
    double time;                   // [s]
    int parameter;                 // index in parameter_table; -1 for a push
    double value;                  // timed: the new value; push: impulse [N s]
    char text[SESSION_INPUT_TEXT]; // the value as it was given
} session_input;

typedef struct session {
    scenario base;         // as opened
    session_input *inputs; // inputs[0 .. input_count) are in effect, the rest can be redone
    int input_count, input_total, input_capacity;
    scenario effective; // base with the inputs; owns its actions only
    run_result run;     // of `effective`
    run_result other;   // the run branched from
    bool has_other;
    double now;       // the cursor [s]
    size_t row;       // the last row whose time is not after `now`
    double seen;      // the latest instant the cursor has been at since the last change [s]
    unsigned version; // counts the computed runs
    struct background_run *computing; // the run, if it is not complete
    double patience;                  // for how long a change waits for its run [s]
    size_t surveyed;                  // rows whose force is in the summary of an incomplete run
} session;

// Takes over the scenario (also on failure) and computes its run. A run that fails numerically is
// kept as far as it went, session.run.summary says why. STATUS_BAD_ARGUMENT if the rows would not
// fit into the memory budget (512 MiB), STATUS_NO_MEMORY; then there is no session.
// session_init always waits for a run's end; session_open not longer than `patience` [s].
status session_init(session *s, scenario *base, fault *f);
status session_open(session *s, scenario *base, double patience, fault *f);
void session_finish(session *s);

// Takes note of what has been computed since the last call. True if anything has.
bool session_follow(session *s);
// Ends a run that is being computed; its rows so far stay, its status is STATUS_STOPPED. False if
// there was none, or it was just over.
bool session_stop(session *s);
// Computes what is missing of a run that was stopped.
status session_go_on(session *s, fault *f);

// The row at the cursor, never NULL.
const sample *session_sample(const session *s);
// The end of what has been computed [s].
double session_end(const session *s);

// Moves the cursor to an instant, kept within the run.
void session_seek(session *s, double time);
// Moves the cursor by rows, back if negative. False at an end.
bool session_step(session *s, long rows);
// Moves to the next event after the cursor (direction 1) or the one before it (-1): to the row just
// after the event. False if there is none. session_event tells the event at the cursor, or NULL.
bool session_step_event(session *s, int direction);
const event *session_event(const session *s);

// The parameters as script and inputs have set them at an instant.
parameters session_parameters_at(const session *s, double time);

// Gives a parameter another value: from the cursor's instant on if it may change during a run (and
// the cursor is not at the start), else from the start. Records an input and computes the run anew;
// what could be redone is forgotten. On failure nothing changes and f says why.
status session_change(session *s, int parameter, const char *text, fault *f);
// The same for an impulse at the tip [N s].
status session_push(session *s, double impulse, fault *f);

// Takes back the last input, or puts it in again. STATUS_BAD_ARGUMENT if there is none.
status session_undo(session *s, fault *f);
status session_redo(session *s, fault *f);

// Keeps the present run for comparison; changes then make another one beside it.
// STATUS_BAD_ARGUMENT while it is being computed.
status session_branch(session *s, fault *f);
// Forgets the run kept for comparison.
void session_forget_other(session *s);

// The last row of a trace whose time is not after `time`; 0 for an earlier time. The trace must
// have a row.
size_t trace_row_at(const trace *t, double time);
