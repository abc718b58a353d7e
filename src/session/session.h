// A session with one scenario: a run that is looked at from any instant, and changed on
// the way.
//
// The whole run is computed and kept as rows; "running" moves a cursor over them. What
// the user does (a changed parameter, a push) is an input with its instant, and the run
// is that of the scenario and all inputs. So a saved scenario gives the same run by
// construction, stepping back and forth changes nothing, undo is a shorter list of
// inputs, and a branch keeps the old run beside the new one; rows that the new one
// resumes from are kept once.
//
// A run that takes longer than the session's patience is computed by a thread of its own.
// Until it is over `run` shows the rows there are, session_follow brings more, and
// `computing` is not NULL. The cursor may then stand at an instant that has no row yet:
// `row` is the last one there is.
//
// Rows before a change are those of the unchanged run to the last bit: no step is chosen
// for an input, one that goes beyond it is cut.
//
// Everybody but its functions reads a session only.
#pragma once

#include "src/run/run.h"
#include "src/scenario/outside.h"
#include "src/run/run_result.h"
#include "src/scenario/scenario.h"

struct background_run;

enum { SESSION_INPUT_TEXT = PARAMETER_VALUE_SIZE };

typedef enum session_input_kind {
    SESSION_INPUT_START, // another value from the start
    SESSION_INPUT_TIMED, // another value from `time` on
    SESSION_INPUT_PUSH   // an impulse at the tip
} session_input_kind;

typedef struct session_input {
    session_input_kind kind;
    double time;                     // from which it takes effect [s]
    int parameter;                   // index in parameter_table; -1 for a push
    double value;                    // the new value; push: impulse [N s]
    char kept[PARAMETER_VALUE_SIZE]; // the new value of a text, as in an action
    char text[SESSION_INPUT_TEXT];   // how it was given, for files and people
    double before;    // the value until then; NaN for a text and for a push
    unsigned gesture; // undone together with its neighbours of this number; 0: alone
    double seen_at;   // where the cursor was when it was given [s]
    size_t seen_row;
} session_input;

typedef struct session {
    scenario base; // as opened
    session_input
        *inputs; // inputs[0 .. input_count) are in effect, the rest can be redone
    int input_count, input_total;
    scenario effective; // base with the inputs; owns its actions only
    run_result run;     // of `effective`
    run_result other;   // the run branched from
    bool has_other;
    double now;  // the cursor [s]
    size_t row;  // the last row whose time is not after `now`
    double seen; // the latest instant the cursor has been at since the last change [s]
    unsigned version;                 // counts the computed runs
    struct background_run *computing; // the run, if it is not complete
    double patience;                  // for how long a change waits for its run [s]
    char outside[SHA256_TEXT];        // stamp of what the runs could read from outside
    char digest[SHA256_TEXT];         // outside_digest_all of what the run read
    size_t surveyed; // rows whose force is in the summary of an incomplete run
} session;

// Takes over the scenario (also on failure) and computes its run; waits no longer than
// `patience` [s] for a run's end, then it is computed in the background. A run that fails
// numerically is kept as far as it went, session.run.summary says why.
// STATUS_BAD_ARGUMENT if the rows would not fit into the memory budget (512 MiB),
// STATUS_NO_MEMORY; then there is no session.
status session_open(session *s, scenario *base, double patience, fault *f);
void session_finish(session *s);

// --- its run ---

// Computes the run with the inputs in effect and puts the cursor into it. On failure the
// present run stays and f says why.
status session_compute(session *s, fault *f);

// Takes note of what has been computed since the last call. True if anything has.
bool session_follow(session *s);
// Ends a run that is being computed; its rows so far stay, its status is STATUS_STOPPED.
// False if there was none, or it was just over.
bool session_stop(session *s);
// Computes what is missing of a run that was stopped.
status session_go_on(session *s, fault *f);

// The parameters as script and inputs have set them at an instant.
parameters session_parameters_at(const session *s, double time);

// Keeps a run for comparison, in the place of the one that is kept: its rows are shared,
// not copied. STATUS_NO_MEMORY.
status session_keep_beside(session *s, const run_result *run, fault *f);
// Forgets the run kept for comparison.
void session_forget_other(session *s);
// Lets the scenario load its plug-in or start its program, and computes the run with it.
// On failure nothing changes and f says why.
status session_allow_code(session *s, fault *f);

// --- the cursor: the instant that is looked at ---

// The row at the cursor, never NULL.
const sample *session_sample(const session *s);
// The end of what has been computed [s].
double session_end(const session *s);

// Moves the cursor to an instant, kept within the run.
void session_seek(session *s, double time);
// Moves the cursor by rows, back if negative. False at an end.
bool session_step(session *s, long rows);
// The event at the cursor, or NULL.
const event *session_event(const session *s);

// --- inputs: what the user does, each with its instant, and their undoing ---

// Gives a parameter another value: from the row at the cursor on if it may change during
// a run (and the cursor is not at the start), else from the start. At the row before an
// event the change comes before the event, and the cursor stands at it. Records an input
// and computes the run anew; what could be redone is forgotten. On failure nothing
// changes and f says why.
status session_change(session *s, int parameter, const char *text, fault *f);
status session_change_number(session *s, int parameter, double value, fault *f);
// Gives a parameter the value that it has in p, from the start, wherever the cursor is,
// which stays.
status session_change_from_start(session *s, const parameters *p, int parameter,
                                 fault *f);
// The same as session_change, in the place of the last input if that gave this parameter
// a value at this very instant: small steps to a value are one input, and none once they
// have led back to where they began.
status session_adjust(session *s, int parameter, const char *text, fault *f);
status session_adjust_number(session *s, int parameter, double value, fault *f);
// The same as session_change for an impulse at the tip [N s].
status session_push(session *s, double impulse, fault *f);

// Pushes that are one gesture: undone and put in again together. A number that no input
// has, and a push of that gesture (as session_push).
unsigned session_new_gesture(const session *s);
status session_pull(session *s, double impulse, unsigned gesture, fault *f);

// Gives another value to what inputs[index] changed, at its instant; an input of its own,
// which undoing takes back. STATUS_BAD_ARGUMENT for a push.
status session_change_input(session *s, int index, const char *text, fault *f);
// Takes inputs[index] out; it is the next that session_redo puts in, at the end.
status session_drop_input(session *s, int index, fault *f);

// Makes the scenario of a base with inputs. It owns its list of actions, to be freed also
// on failure; all else is borrowed from the base.
status session_scenario(const scenario *base, const session_input *inputs, int count,
                        scenario *to, fault *f);

// The action that an input is, from its instant on; and what a text gave the input's
// parameter in p becomes its value.
action session_input_action(const session_input *in);
void session_input_take(session_input *in, const parameters *p);

// Puts other inputs in the place of all there are, and computes their run; nothing can be
// redone then. On failure nothing changes and f says why.
status session_take_inputs(session *s, const session_input *inputs, int count, fault *f);

// Takes back the last input, or puts it in again; the cursor goes to where it was, or to
// where the input takes effect. STATUS_BAD_ARGUMENT if there is none.
status session_undo(session *s, fault *f) __attribute__((warn_unused_result));
status session_redo(session *s, fault *f) __attribute__((warn_unused_result));

// Whether two inputs do the same; the instant matters unless they count from the start.
bool session_same_input(const session_input *a, const session_input *b);
