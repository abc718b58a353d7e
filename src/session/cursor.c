#include "src/session/cursor.h"

#include <assert.h>
#include <math.h>

#include "src/base/instant.h"

// The cursor has been here.
static void note_seen(session *s)
{
    s->seen = fmax(s->seen, s->now);
}

const sample *session_sample(const session *s)
{
    assert(s != NULL && s->row < s->run.trace.row_count);
    return &s->run.trace.rows[s->row];
}

double session_end(const session *s)
{
    assert(s != NULL && s->run.trace.row_count > 0);
    return s->run.trace.rows[s->run.trace.row_count - 1].time;
}

void session_seek(session *s, double time)
{
    double end = session_end(s);

    // rows to come may be waited for at an instant the cursor is at already
    end = s->computing != NULL && s->now > end ? s->now : end;
    s->now = time > end ? end : time > 0 ? time : 0;
    s->row = trace_row_at(&s->run.trace, s->now);

    // an instant beside a row's by rounding is the row's: a change there cuts no step anew
    double near = s->run.trace.rows[s->row + (s->row + 1 < s->run.trace.row_count)].time;
    if (near > s->now && same_instant(near, s->now)) {
        session_seek(s, near);
    }
    note_seen(s);
}

bool session_step(session *s, long rows)
{
    long last = (long)s->run.trace.row_count - 1, to = (long)s->row + rows;
    to = to < 0 ? 0 : to > last ? last : to;
    bool moved = to != (long)s->row;
    s->row = (size_t)to;
    s->now = session_sample(s)->time;
    note_seen(s);
    return moved;
}

const event *session_event(const session *s)
{
    assert(s != NULL);
    for (size_t i = 0; i < s->run.trace.event_count; i++) {
        if (s->run.trace.events[i].time == s->now) {
            return &s->run.trace.events[i];
        }
    }
    return NULL;
}
