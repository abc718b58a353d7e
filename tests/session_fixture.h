// Sessions for tests: opened on a scenario that ships, and saved and run again.
#pragma once

#include "src/run/run.h"
#include "src/session/session.h"
#include "tests/check.h"

static inline void fail_on_fault(void *context, const char *sentence)
{
    (void)context;
    fail_msg("%s", sentence);
}

static inline void open_session(session *s, const char *name)
{
    scenario base;
    assert_int_equal(scenario_open(&base, name, fail_on_fault, NULL), STATUS_OK);
    DONE(session_open(s, &base, HUGE_VAL, &f));
}

// The same for as long as its block.
#define OPEN_SESSION(s, name)                                                                      \
    SCOPED(session_finish) session s;                                                              \
    open_session(&s, name)

static inline void assert_same_trace(const trace *a, const trace *b)
{
    assert_int_equal(a->row_count, b->row_count);
    assert_int_equal(a->event_count, b->event_count);
    assert_memory_equal(a->rows, b->rows, a->row_count * sizeof *a->rows);
    assert_memory_equal(a->angles, b->angles,
                        a->row_count * (size_t)a->angle_count * sizeof *a->angles);
}

// What was done is saved as a scenario, which gives the same run. Returns its text, to be freed.
static inline char *save_and_compare(const session *s)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    scenario_write(stream, &s->effective);
    fclose(stream);
    SCOPED(scenario_finish) scenario saved;
    SCOPED(run_finish) run_result again;
    assert_int_equal(scenario_parse(&saved, text, size, "saved", NULL, fail_on_fault, NULL),
                     STATUS_OK);
    run_scenario(&saved, true, &again);
    assert_same_trace(&s->run.trace, &again.trace);
    return text;
}

// Moves the cursor to the next event after it. False, and nothing done, if there is none.
static inline bool seek_next_event(session *s)
{
    const trace *t = &s->run.trace;
    for (size_t i = 0; i < t->event_count; i++) {
        if (t->events[i].time > s->now) {
            session_seek(s, t->events[i].time);
            return true;
        }
    }
    return false;
}
