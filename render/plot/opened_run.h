// Scenarios run for figures.
#pragma once

#include "src/run/run.h"

// A run with its scenario, finished by run_end.
typedef struct opened_run {
    scenario scenario;
    run_result result; // with its trace
} opened_run;

// Opens and runs a scenario, with one parameter changed if `change` ("arm.model=corrected") is not
// NULL. On failure nothing has to be finished.
status run_begin(opened_run *r, const char *name, const char *change, fault *f);
void run_end(opened_run *r);

// The scenario's title, and what was changed of what it speaks of. Free with g_free.
char *scenario_title(const scenario *s);

// The scenario's name and every parameter in one line, for a file's metadata. Free with g_free.
char *parameters_line(const scenario *s);

// The same with several changes, each "PATH=VALUE". STATUS_STOPPED if `monitor` (may be NULL)
// requested it.
status run_begin_changed(opened_run *r, const char *name, const char *const *changes, int count,
                         run_monitor *monitor, fault *f);
