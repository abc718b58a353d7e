// Shared by tests of the library: handles of each kind, and checks of the sentences of
// calls.
#pragma once

#include "../check.h"

#include <impactlab/controller.h>
#include <impactlab/impactlab.h>

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

// What calls report to.
extern impactlab_error told;

// Handles of each kind.
typedef struct handles {
    impactlab_scenario *scenario;
    impactlab_run *run;
    impactlab_loop *loop; // commanded
} handles;

GIVEN_BACK(impactlab_scenario, impactlab_scenario_destroy)
GIVEN_BACK(impactlab_run, impactlab_run_destroy)
GIVEN_BACK(impactlab_loop, impactlab_loop_destroy)

// Handles that are destroyed when their block is left: own_run *run;
#define own_scenario SCOPED(impactlab_scenario_destroy_kept) impactlab_scenario
#define own_run      SCOPED(impactlab_run_destroy_kept) impactlab_run
#define own_loop     SCOPED(impactlab_loop_destroy_kept) impactlab_loop

// A call that must have been done.
void check_done(int status);

// What calls that must be done give: handles, to be destroyed, and numbers.
impactlab_scenario *opened(const char *name);
impactlab_run *run_of(const impactlab_scenario *scenario, int flags);
impactlab_loop *loop_of(const impactlab_scenario *scenario, int flags);
double number_of(const impactlab_scenario *scenario, const char *path);
double quantity_of(const impactlab_run *run, const char *key);
double signal_of(impactlab_loop *loop, const char *name);

// Set-up and tear-down of a test: `h` is the handles of corrected/first-impact.
extern handles *h;
int make_handles(void **state);
int free_handles(void **state);

// A call that must be refused with a sentence that has the words.
void check_refused(int status, const char *words);

// A case with the handles.
#define TEST_OF_HANDLES(name) TEST_BETWEEN(name, make_handles, free_handles)
