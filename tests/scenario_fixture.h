// Shared by the tests of scenarios: reading a text and keeping the sentences about it.
#pragma once

#include "tests/shipped_scenario.h"

// All sentences of one reading, a line each.
typedef struct sentences {
    int count;
    size_t used;
    char text[16384];
} sentences;

static inline void keep_sentence(void *context, const char *sentence)
{
    sentences *all = context;
    assert_null(strchr(sentence, '\n'));
    int length =
        snprintf(all->text + all->used, sizeof all->text - all->used, "%s\n", sentence);
    all->used += (size_t)length < sizeof all->text - all->used ? (size_t)length : 0;
    all->count++;
}

static inline status parse(scenario *s, const char *text, sentences *all)
{
    // a text of so many bytes, behind which there is none: a sanitizer sees who looks
    // there
    const size_t size = strlen(text);
    KEPT_TEXT(bytes) = malloc(size + (size == 0));
    assert_non_null(bytes);
    memcpy(bytes, text, size);
    *all = (sentences){0};
    return scenario_parse(s, bytes, size, "f.yaml", NULL, keep_sentence, all);
}

// The text is read without a fault.
static inline scenario good(const char *text)
{
    scenario s;
    sentences all;
    fail_if(parse(&s, text, &all) != STATUS_OK || all.count != 0, "refused:\n%s",
            all.text);
    return s;
}

// A run of it that does not fail.
static inline run_result run_told(const char *text)
{
    KEPT_SCENARIO(s) = good(text);
    return run_done(&s, true);
}

// The text has exactly one fault, at line:column, whose sentence mentions `what`.
static inline void check_fault(const char *text, int line, int column, const char *what)
{
    scenario s;
    sentences all;
    assert_int_equal(parse(&s, text, &all), STATUS_BAD_SCENARIO);
    const char *place = formatted("f.yaml:%d:%d: ", line, column);
    bool there = strncmp(all.text, place, strlen(place)) == 0;
    fail_if(all.count != 1 || !there || strstr(all.text, what) == NULL,
            "%d faults, expected one at %d:%d about '%s':\n%s", all.count, line, column,
            what, all.text);
}

// The text has exactly `count` faults, and each of the sentences' beginnings is among
// them.
static inline void check_faults(const char *text, int count,
                                const char *const *beginnings)
{
    scenario s;
    sentences all;
    status result = parse(&s, text, &all);
    assert_int_equal(result, STATUS_BAD_SCENARIO);
    fail_if(all.count != count, "%d faults, expected %d:\n%s", all.count, count,
            all.text);
    for (int i = 0; i < count; i++) {
        bool first = strncmp(all.text, beginnings[i], strlen(beginnings[i])) == 0;
        fail_if(!first && strstr(all.text, formatted("\n%s", beginnings[i])) == NULL,
                "no '%s' in:\n%s", beginnings[i], all.text);
    }
}
