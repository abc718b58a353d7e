// What a process was asked and what it answered: a run that asks the same again needs no process.
//
// The transcript is a tree, because runs branch: each node (place) is a question with its answer,
// and a child of the question before it. A session or a loop keeps one for all runs of a scenario;
// it is used by one run at a time.
#pragma once

#include <stdbool.h>

#include "src/rig/controller.h"

enum {
    TRANSCRIPT_BEGIN = 0, // the place before the first question
    TRANSCRIPT_NONE = -1  // no place on a transcript
};

typedef struct process_transcript process_transcript;

// An empty transcript; NULL without memory. t may be NULL for process_transcript_destroy.
process_transcript *process_transcript_create(void);
void process_transcript_destroy(process_transcript *t);

// The place of a question that was asked right after `place`, TRANSCRIPT_NONE if it was not; t may
// be NULL.
int process_transcript_find(const process_transcript *t, int place, const char *question);

// Adds a question after `place` with its answer. Returns its place, TRANSCRIPT_NONE where there is
// none (`place` is none, t is NULL, no memory, or the transcript holds its most: 64 MiB of
// questions).
int process_transcript_add(process_transcript *t, int place, const char *question,
                           const controller_output *answer);

// The question and the answer of a place other than TRANSCRIPT_BEGIN, and the place before it.
const char *process_transcript_question(const process_transcript *t, int place);
controller_output process_transcript_answer(const process_transcript *t, int place);
int process_transcript_before(const process_transcript *t, int place);

// What became of the programs of the last runs.
typedef struct process_replay {
    bool restarted; // one was started anew and went through recorded questions again
    int samples;    // how many
    double time;    // from where on it was then asked what is new [s]
} process_replay;

// Notes that; process_transcript_take_replay gives it away, once (nothing where t is NULL).
void process_transcript_note(process_transcript *t, int samples, double time);
process_replay process_transcript_take_replay(process_transcript *t);
