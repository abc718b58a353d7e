// Shared by tests of the library: handles of each kind, and checks of the sentences of calls.
#pragma once

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

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

#define TEST(test) cmocka_unit_test_setup_teardown(test, make_handles, free_handles)
