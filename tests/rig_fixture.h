// Runs on the rig for tests: the impact of the thesis's 5.4 with settings as "path=value"
// strings.
#pragma once

#include "tests/arm_fixture.h"

// Resolved parameters: wall at 0, start at rest 0.1 rad before it, 1.5 s, then the
// settings.
static inline parameters rig_parameters(const char *const *settings)
{
    const char *all[32] = {"wall.angle=0", "initial.angle=-0.1", "run.duration=1.5"};
    int count = 3;
    for (; settings != NULL && *settings != NULL; settings++) {
        all[count++] = *settings;
    }
    parameters p = fixture_parameters(all);
    p.code_allowed = true;
    return p;
}

// Runs them; the caller calls run_finish.
static inline run_result rig_run(const char *const *settings, bool keep_trace)
{
    return run_arm(rig_parameters(settings), keep_trace);
}

// Runs them and keeps the summary only.
static inline summary rig_summary(const char *const *settings)
{
    KEPT_RUN(result) = rig_run(settings, false);
    return result.summary;
}

// The same of settings as given() takes them; the run is kept with its rows until its
// block is left.
#define RIG_RUN(r, ...)          KEPT_RUN(r) = rig_run(given(__VA_ARGS__), true)
#define rig_parameters_with(...) rig_parameters(given(__VA_ARGS__))
#define rig_summary_with(...)    rig_summary(given(__VA_ARGS__))

// The setup that a law gets of these parameters, the hybrid one's.
static inline controller_setup setup_of(const parameters *p)
{
    rig *r = NULL;
    parameters as_hybrid = *p;
    as_hybrid.control.law = LAW_HYBRID;
    DONE(rig_create(&r, &as_hybrid, NULL, &f));
    controller_setup setup = *(const controller_setup *)r->memory; // it stands first
    rig_destroy(r);
    return setup;
}

// The run under these settings cannot be made, and the sentence says why.
static inline void check_refused(const char *const *settings, const char *sentence)
{
    KEPT_RUN(r);
    scenario s = {.parameters = rig_parameters(settings)};
    assert_int_not_equal(run_scenario(&s, false, &r), STATUS_OK);
    fail_if(strstr(r.summary.message, sentence) == NULL, "'%s' does not say '%s'",
            r.summary.message, sentence);
}
