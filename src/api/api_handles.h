// What the handles of libimpactlab hold, and how its functions say what was wrong.
#pragma once

#include "src/api/impactlab/impactlab.h"
#include "src/base/text_stream.h"
#include "src/run/run_loop.h"
#include "src/run/run.h"
#include "src/study/sweep_axis.h"
#include "src/tables/settings.h"

struct impactlab_scenario {
    scenario scenario;
    impactlab_stop_question ask; // of its runs, loops and batches; NULL: nobody is asked
    void *ask_context;
    char title[SCENARIO_TITLED]; // with what was changed since it was read
};

struct impactlab_run {
    scenario scenario; // as it was run
    run_result result;
};

struct impactlab_loop {
    run_loop *loop;
    bool commanded;
};

// Writes a fault into the caller's error (may be NULL). Returns its code.
int api_error(impactlab_error *error, const fault *f);

// The same with a sentence; "no error" clears it.
int api_fail(impactlab_error *error, status code, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
int api_done(impactlab_error *error);

// A call without something that it cannot do without: `argument`, the i-th of these
// names. A handle of a scenario is called that.
int api_missing(impactlab_error *error, const char *names, size_t i);
#define API_NEEDS(error, ...)                                                            \
    do {                                                                                 \
        const void *const given_[] = {__VA_ARGS__};                                      \
        for (size_t i_ = 0; i_ < sizeof given_ / sizeof *given_; i_++) {                 \
            if (given_[i_] == NULL) {                                                    \
                return api_missing(error, #__VA_ARGS__, i_);                             \
            }                                                                            \
        }                                                                                \
    } while (0)

// Writes the first fault of a scenario that was refused (keep_first_fault) with its place
// and code, which it returns.
int api_refused(impactlab_error *error, fault *first, const fault_place *at, status code);

// Index of a parameter as people write it, -1 with an error that names the nearest;
// *text, what is to give it a value, becomes ".NAME=TEXT" in `room` for one number of
// control.settings.
int api_parameter(const char *path, const char **text, char room[PARAMETER_TEXT_SIZE],
                  impactlab_error *error);

// The same for a number that is read or set: an axis without values, of one parameter.
int api_axis(const char *path, sweep_axis *axis, impactlab_error *error);

// Index of a signal, likewise.
int api_signal(const char *name, impactlab_error *error);

// Says that there is no such thing of that kind ("signal"), and the name that is `near`
// (NULL: none is). Returns the code.
int api_fail_unknown(impactlab_error *error, const char *kind, const char *name,
                     const char *near);

// A run of a copy of the scenario, of which nothing is computed yet; NULL, with an error,
// without memory.
impactlab_run *api_new_run(const scenario *s, impactlab_error *error);

// A text that is handed to the caller, if all of what `write` writes is there.
// IMPACTLAB_NO_MEMORY if not.
int api_text(char **text, void (*write)(FILE *stream, const void *what), const void *what,
             impactlab_error *error);
