// Runs that were pinned: kept with their names and what was changed for them, and shown beside the
// present one.
#pragma once

#include "src/session/session.h"
#include "ui/explorer/state/prompt.h"

enum { PINNED_RUNS = LESSON_PINNED_RUNS, RUN_NAME = LINE_TEXT };

typedef struct pinned_run {
    char name[RUN_NAME];
    run_result run;        // its rows are shared with the session's
    session_input *inputs; // that lead to it from the scenario
    int input_count;
    unsigned long id; // no other pinned run of the list has had it
    bool hidden;
} pinned_run;

typedef struct run_list {
    pinned_run runs[PINNED_RUNS];
    int count;
    int baseline;         // that the present run is compared with; -1 for none
    int selected;         // in the list
    unsigned long pinned; // counts those ever pinned
} run_list;

// Pins the present run of a session under a name, or one that says what was changed last, and makes
// it the baseline. A run of the same changes is not pinned twice. STATUS_BAD_ARGUMENT if the list
// is full, STATUS_NO_MEMORY.
status run_list_pin(run_list *list, const session *s, const char *name, fault *f);

// Takes a run off the list.
void run_list_drop(run_list *list, int index);
void run_list_clear(run_list *list);

// Whether two runs come from the same changes.
bool run_list_is_present(const pinned_run *p, const session *s);

// What differs between a run of the list and the present one, in a line: changes that only it has,
// then, in brackets, those that only the present one has.
void run_list_differences(const pinned_run *p, const session *s, char *text, size_t size);
