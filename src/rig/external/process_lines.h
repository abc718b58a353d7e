// The lines that a controller in a program of its own is asked by and answers with: JSON
// objects, as docs/howto/controller.md has them.
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "src/rig/controller.h"
#include "src/tables/parameters.h"

// The line that asks for a command at a sample, with its end, to be freed; NULL without
// memory. The first one tells the setup, control.* and control.settings, too; `setup` is
// NULL in the others.
char *process_question(const controller_setup *setup, const control_parameters *control,
                       const controller_input *in);

// What a line of so many bytes, its end left out, answers; what it leaves out of *out is
// NaN. STATUS_CONTROLLER_FAILED if it is no answer with a command, STATUS_NO_MEMORY if
// that cannot be known.
status process_read_answer(const char *line, size_t length, controller_output *out);

// Whether two answers are the same to the last bit; NaN is what was not answered.
bool process_same_answer(const controller_output *a, const controller_output *b);

// --- transcripts -----------------------------------------------------------------------

// What a process was asked and what it answered: a run that asks the same again needs no
// process.
//
// The transcript is a tree, because runs branch: each node is a question with its answer,
// and a child of the question before it. A session or a loop keeps one for all runs of a
// scenario; it is used by one run at a time.

typedef struct transcript_node {
    struct transcript_node *before, *first_after,
        *next_beside;                // NULL where there is none
    struct transcript_node *towards; // the child on the way that is gone once more
    struct transcript_node
        *made_before; // of all nodes the one that was added before this one
    controller_output answer;
    char question[];
} transcript_node;

// What became of the programs of the last runs.
typedef struct process_replay {
    bool restarted; // one was started anew and went through recorded questions again
    int samples;    // how many
    double time;    // from where on it was then asked what is new [s]
} process_replay;

typedef struct process_transcript {
    transcript_node *begin; // before the first question
    transcript_node *last;  // that was added
    size_t size;            // of all questions [bytes]
    process_replay replay;  // until somebody takes it
} process_transcript;

// An empty transcript; NULL without memory. t may be NULL for process_transcript_destroy.
process_transcript *process_transcript_create(void);
void process_transcript_destroy(process_transcript *t);

// The node of a question that was asked right after another one; NULL if it was not, or
// without one before.
transcript_node *process_transcript_find(const transcript_node *before,
                                         const char *question);

// Adds a question after another one with its answer. NULL where it has no place: `before`
// is NULL, no memory, or the transcript holds its most, 64 MiB of questions.
transcript_node *process_transcript_add(process_transcript *t, transcript_node *before,
                                        const char *question,
                                        const controller_output *answer);
