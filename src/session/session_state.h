// What a session is made of; its parts work on it, everybody else reads it.
#pragma once

#include "src/run/run.h"
#include "src/scenario/outside.h"

struct background_run;
struct process_transcript;

enum { SESSION_INPUT_TEXT = 160 };

typedef enum session_input_kind {
    SESSION_INPUT_START, // another value from the start
    SESSION_INPUT_TIMED, // another value from `time` on
    SESSION_INPUT_PUSH   // an impulse at the tip
} session_input_kind;

typedef struct session_input {
    session_input_kind kind;
    double time;                   // from which it takes effect [s]
    int parameter;                 // index in parameter_table; -1 for a push
    double value;                  // the new value; push: impulse [N s]
    char text[SESSION_INPUT_TEXT]; // the value as it was given
    double before;                 // the value until then; NaN for a text and for a push
    unsigned gesture;              // undone together with its neighbours of this number; 0: alone
    double seen_at;                // where the cursor was when it was given [s]
    size_t seen_row;
} session_input;

typedef struct session {
    scenario base;         // as opened
    session_input *inputs; // inputs[0 .. input_count) are in effect, the rest can be redone
    int input_count, input_total, input_capacity;
    scenario effective; // base with the inputs; owns its actions only
    run_result run;     // of `effective`
    run_result other;   // the run branched from
    bool has_other;
    run_result ghost; // the run before a value that is being adjusted
    bool has_ghost;
    double now;       // the cursor [s]
    size_t row;       // the last row whose time is not after `now`
    double seen;      // the latest instant the cursor has been at since the last change [s]
    unsigned version; // counts the computed runs
    struct background_run *computing; // the run, if it is not complete
    double patience;                  // for how long a change waits for its run [s]
    struct process_transcript
        *transcript;           // what a process was asked in all runs, NULL if there is none
    char outside[SHA256_TEXT]; // stamp of what the runs could read from outside
    size_t surveyed;           // rows whose force is in the summary of an incomplete run
} session;
