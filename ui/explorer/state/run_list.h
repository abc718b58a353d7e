// Pinned runs: stored with names and changes, and shown together with the present run.
#pragma once

#include "src/session/session.h"
#include "ui/explorer/state/prompt.h"

enum { PINNED_RUNS = LESSON_PINNED_RUNS, RUN_NAME = LINE_TEXT };

typedef struct pinned_run {
    char name[RUN_NAME];
    run_result run;        // its rows are shared with the session's
    session_input *inputs; // the changes from the scenario to this run
    int input_count;
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

// Pins the present run of a session under the given name, or one that describes the last change,
// and makes it the baseline. A run of the same changes is not pinned twice. STATUS_BAD_ARGUMENT if
// the list is full, STATUS_NO_MEMORY.
status run_list_pin(run_list *list, const session *s, const char *name, fault *f);

// Removes a run from the list.
void run_list_drop(run_list *list, int index);
void run_list_clear(run_list *list);

// Whether two runs have the same changes.
bool run_list_is_present(const pinned_run *p, const session *s);

// The difference between a run of the list and the present one as a line of text: changes that only
// the former has, then, in brackets, those that only the latter has.
void run_list_differences(const pinned_run *p, const session *s, char *text, size_t size);
