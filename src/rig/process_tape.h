// What a process was asked and what it answered: a run that asks the same again needs no process.
//
// The tape is a tree, because runs branch: each node (place) is a question with its answer, and a
// child of the question before it. A session or a loop keeps one for all runs of a scenario; it is
// used by one run at a time.
#pragma once

#include <stdbool.h>

#include "src/rig/controller.h"

enum {
    TAPE_BEGIN = 0, // the place before the first question
    TAPE_NONE = -1  // no place on a tape
};

typedef struct process_tape process_tape;

// An empty tape; NULL without memory. t may be NULL for process_tape_destroy.
process_tape *process_tape_create(void);
void process_tape_destroy(process_tape *t);

// The place of a question that was asked right after `place`, TAPE_NONE if it was not; t may be
// NULL.
int process_tape_find(const process_tape *t, int place, const char *question);

// Adds a question after `place` with its answer. Returns its place, TAPE_NONE where there is none
// (`place` is none, t is NULL, no memory, or the tape holds its most: 64 MiB of questions).
int process_tape_add(process_tape *t, int place, const char *question,
                     const controller_output *answer);

// The question and the answer of a place other than TAPE_BEGIN, and the place before it.
const char *process_tape_question(const process_tape *t, int place);
controller_output process_tape_answer(const process_tape *t, int place);
int process_tape_before(const process_tape *t, int place);

// What became of the programs of the last runs.
typedef struct process_replay {
    bool restarted; // one was started anew and went through recorded questions again
    int samples;    // how many
    double time;    // from where on it was then asked what is new [s]
} process_replay;

// Notes that; process_tape_take_replay gives it away, once (nothing where t is NULL).
void process_tape_note(process_tape *t, int samples, double time);
process_replay process_tape_take_replay(process_tape *t);
