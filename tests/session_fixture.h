// Sessions for tests: opened on a scenario that ships, and saved and run again.
#pragma once

#include "src/session/session.h"
#include "tests/shipped_scenario.h"

static inline void open_session(session *s, const char *name)
{
    scenario base = shipped(name);
    DONE(session_open(s, &base, HUGE_VAL, &f));
}

// The same for as long as its block.
#define OPEN_SESSION(s, name)                                                            \
    KEPT_SESSION(s);                                                                     \
    open_session(&s, name)

// A change that the session takes, and whose run ends well.
static inline void change(session *s, const char *path, const char *value)
{
    fault f = {0};
    fail_if(session_change(s, parameter_find(path), value, &f) != STATUS_OK, "%s: %s",
            path, f.text);
    fail_if(s->computing == NULL && s->run.summary.status != STATUS_OK, "%s: %s", path,
            s->run.summary.message);
}

static inline void assert_same_trace(const trace *a, const trace *b)
{
    assert_int_equal(a->row_count, b->row_count);
    assert_int_equal(a->event_count, b->event_count);
    assert_memory_equal(a->rows, b->rows, a->row_count * sizeof *a->rows);
    assert_memory_equal(a->angles, b->angles,
                        a->row_count * (size_t)a->angle_count * sizeof *a->angles);
}

// What was done is saved as a scenario, which gives the same run. Returns its text, to be
// freed.
static inline char *save_and_compare(const session *s)
{
    WRITTEN(text, scenario_write(stream, &s->effective));
    KEPT_SCENARIO(saved) = read_again(&s->effective);
    KEPT_RUN(again);
    run_scenario(&saved, true, &again);
    assert_same_trace(&s->run.trace, &again.trace);
    return text;
}

// Moves the cursor to the next event after it. False, and nothing done, if there is none.
static inline bool seek_next_event(session *s)
{
    const trace *t = &s->run.trace;
    for (EACH_EVENT(e, t)) {
        if (e->time > s->now) {
            session_seek(s, e->time);
            return true;
        }
    }
    return false;
}
