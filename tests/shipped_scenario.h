// Scenarios for tests: those that ship, with changes, and read again from what they write.
#pragma once

#include "src/scenario/scenario.h"
#include "tests/check.h"

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
    char copy[512], *items[32], *rest = NULL;
    int count = 0;
    scenario s = shipped(name);
    assert_in_range(snprintf(copy, sizeof copy, "%s", changes), 0, sizeof copy - 1);
    for (char *item = strtok_r(copy, " ", &rest); item != NULL; item = strtok_r(NULL, " ", &rest)) {
        items[count++] = item;
    }
    assert_int_equal(scenario_override_all(&s, items, count, fail_on_fault, NULL), STATUS_OK);
    return s;
}

// What is read from what a scenario writes.
static inline scenario read_again(const scenario *s)
{
    scenario again;
    SCOPED(free_kept) WRITTEN(text, scenario_write(stream, s));
    assert_int_equal(scenario_parse(&again, text, strlen(text), "saved", NULL, fail_on_fault, NULL),
                     STATUS_OK);
    return again;
}
