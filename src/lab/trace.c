#include "src/lab/trace.h"

#include <stdlib.h>
#include <string.h>

const char *event_name(event_kind kind)
{
    static const char *const names[] = {"impact",   "contact", "release", "stick",
                                        "reversal", "slip",    "change",  "push"};
    return names[kind];
}

void trace_init(trace *t, int angle_count)
{
    memset(t, 0, sizeof *t);
    t->angle_count = angle_count;
}

void trace_finish(trace *t)
{
    free(t->rows);
    free(t->angles);
    free(t->events);
    memset(t, 0, sizeof *t);
}

status trace_add_row(trace *t, const sample *row, const double *angles)
{
    size_t n = (size_t)t->angle_count;
    if (t->row_count == t->row_capacity) {
        size_t capacity = t->row_capacity ? 2 * t->row_capacity : 1024;
        sample *rows = realloc(t->rows, capacity * sizeof *rows);
        if (rows == NULL) {
            return STATUS_NO_MEMORY;
        }
        t->rows = rows;
        double *more = realloc(t->angles, (capacity * n + 1) * sizeof *more);
        if (more == NULL) {
            return STATUS_NO_MEMORY;
        }
        t->angles = more;
        t->row_capacity = capacity;
    }
    t->rows[t->row_count] = *row;
    memcpy(t->angles + t->row_count * n, angles, n * sizeof *angles);
    t->row_count++;
    return STATUS_OK;
}

status trace_add_event(trace *t, event e)
{
    if (t->event_count == t->event_capacity) {
        size_t capacity = t->event_capacity ? 2 * t->event_capacity : 64;
        event *events = realloc(t->events, capacity * sizeof *events);
        if (events == NULL) {
            return STATUS_NO_MEMORY;
        }
        t->events = events;
        t->event_capacity = capacity;
    }
    t->events[t->event_count++] = e;
    return STATUS_OK;
}
