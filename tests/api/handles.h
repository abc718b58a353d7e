// Shared by tests of the library: handles of each kind, and checks of the sentences of calls.
#pragma once

#include "../check.h"

#include <impactlab/controller.h>
#include <impactlab/impactlab.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

// Handles of each kind, and what calls write to.
typedef struct handles {
    impactlab_error error;
    impactlab_scenario *scenario;
    impactlab_run *run;
    impactlab_loop *loop; // commanded
} handles;

// A call that must have been done.
void check_done(int status, const impactlab_error *error);

// Set-up and tear-down of a test: *state is the handles of corrected/first-impact.
int make_handles(void **state);
int free_handles(void **state);

// A call that must be refused with a sentence that has the words.
void check_refused(const handles *h, int status, const char *words);

// A case whose *state is the handles.
#define TEST_OF_HANDLES(name) TEST_BETWEEN(name, make_handles, free_handles)
