#include "src/base/instant.h"
#include "src/session/cursor.h"

#include <assert.h>
#include <math.h>

size_t trace_row_at(const trace *t, double time)
{
    size_t low = 0, high = t->row_count; // the first row after `time` lies in [low, high]
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (t->rows[middle].time <= time) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low > 0 ? low - 1 : 0;
}

const sample *session_sample(const session *s)
{
    return &s->run.trace.rows[s->row];
}

double session_end(const session *s)
{
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
    s->seen = s->now > s->seen ? s->now : s->seen;
}

bool session_step(session *s, long rows)
{
    long last = (long)s->run.trace.row_count - 1, to = (long)s->row + rows;
    to = to < 0 ? 0 : to > last ? last : to;
    bool moved = to != (long)s->row;
    s->row = (size_t)to;
    s->now = session_sample(s)->time;
    s->seen = s->now > s->seen ? s->now : s->seen;
    return moved;
}

bool session_step_event(session *s, int direction)
{
    const trace *t = &s->run.trace;
    double found = -1;
    for (size_t i = 0; i < t->event_count; i++) {
        double time = t->events[i].time;
        if (direction > 0 && time > s->now) {
            found = time;
            break;
        }
        if (direction < 0 && time < s->now) {
            found = time;
        }
    }
    if (found >= 0) {
        session_seek(s, found);
    }
    return found >= 0;
}

const event *session_event(const session *s)
{
    for (size_t i = 0; i < s->run.trace.event_count; i++) {
        if (s->run.trace.events[i].time == s->now) {
            return &s->run.trace.events[i];
        }
    }
    return NULL;
}
