// Scenarios for tests: those that ship, with changes, and read again from what they
// write.
#pragma once

#include "src/run/run_loop.h"
#include "src/run/run.h"
#include "src/study/store/sweep_store.h"
#include "tests/check.h"

GIVEN_BACK(run_loop, loop_destroy)

static inline void fail_on_fault(void *context, const char *sentence)
{
    (void)context;
    fail_msg("%s", sentence);
}

// A scenario by its name or file; it must be there and without a fault.
static inline scenario shipped(const char *name)
{
    scenario s;
    assert_int_equal(scenario_open(&s, name, fail_on_fault, NULL), STATUS_OK);
    return s;
}

// The same with changes, "PATH=VALUE ..." between blanks.
static inline scenario shipped_with(const char *name, const char *changes)
{
    char *const *all = (char *const *)words_of(changes);
    int count = 0;
    while (all[count] != NULL) {
        count++;
    }
    scenario s = shipped(name);
    assert_int_equal(scenario_override_all(&s, all, count, fail_on_fault, NULL),
                     STATUS_OK);
    return s;
}

// What is read from what a scenario writes.
static inline scenario read_again(const scenario *s)
{
    scenario again;
    SCOPED(free_kept) WRITTEN(text, scenario_write(stream, s));
    assert_int_equal(scenario_parse(&again, text, strlen(text), "saved", NULL,
                                    fail_on_fault, NULL),
                     STATUS_OK);
    return again;
}

// A run that ends well; the caller calls run_finish.
static inline run_result run_done(const scenario *s, bool rows)
{
    run_result r;
    fail_if(run_scenario(s, rows, &r) != STATUS_OK, "%s", r.summary.message);
    return r;
}

// All that two runs came to but their times of computing.
static inline void assert_same_summary(const summary *a, const summary *b)
{
    for (int i = 0; i < summary_count; i++) {
        const double x = summary_value(a, i), y = summary_value(b, i);
        assert_true(summary_table[i].timing || x == y || (isnan(x) && isnan(y)));
    }
}

// The event of a kind with this number, from 0 on; it must be there.
static inline const event *find_event(const run_result *r, event_kind kind, int number)
{
    for (EACH_EVENT(e, &r->trace)) {
        if (e->kind == kind && number-- == 0) {
            return e;
        }
    }
    fail_msg("event %s did not occur", event_name(kind));
    return NULL;
}

// What a script does at an instant, and a scenario of parameters and a script.
#define SETS(at, path, to)                                                               \
    ((action){.time = at,                                                                \
              .kind = ACTION_SET,                                                        \
              .parameter = PARAMETER_INDEX(path),                                        \
              .value = to})
#define PUSHES(at, by)                                                                   \
    ((action){.time = at, .kind = ACTION_PUSH, .parameter = -1, .value = by})
#define SCRIPTED(given, ...)                                                             \
    {                                                                                    \
        .parameters = given, .actions = (action[]){__VA_ARGS__},                         \
        .action_count = sizeof((action[]){__VA_ARGS__}) / sizeof(action)                 \
    }
