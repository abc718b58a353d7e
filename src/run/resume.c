// Runs that begin with what another run has computed already.
#include <stdlib.h>
#include <string.h>

#include "src/run/checkpoint.h"

#define MARGIN 1e-3 // of a step: how much before a difference a stride must have begun

static bool same_parameter(const parameters *a, const parameters *b, int i)
{
    if (parameter_table[i].type == PARAMETER_TEXT) {
        size_t at = parameter_table[i].offset;
        return strcmp((const char *)a + at, (const char *)b + at) == 0;
    }
    return parameter_get(a, i) == parameter_get(b, i);
}

// Until when two scenarios ask for the same: -1 if they differ from the start, HUGE_VAL if not at
// all [s].
static double same_until(const scenario *a, const scenario *b)
{
    const int duration = parameter_find("run.duration");
    double until = HUGE_VAL;
    for (int i = 0; i < parameter_count; i++) {
        if (same_parameter(&a->parameters, &b->parameters, i)) {
            continue;
        }
        if (i != duration) {
            return -1;
        }
        // strides are cut where the steady force's window begins
        double shorter = fmin(a->parameters.run.duration, b->parameters.run.duration);
        until = fmax(0, shorter - STEADY_WINDOW);
    }
    for (int i = 0; i < a->action_count || i < b->action_count; i++) {
        const action *x = i < a->action_count ? &a->actions[i] : NULL;
        const action *y = i < b->action_count ? &b->actions[i] : NULL;
        bool same = x != NULL && y != NULL && x->time == y->time && x->kind == y->kind &&
                    x->parameter == y->parameter && x->value == y->value &&
                    strcmp(x->text, y->text) == 0;
        if (!same) {
            until = fmin(until, x != NULL ? x->time : HUGE_VAL);
            until = fmin(until, y != NULL ? y->time : HUGE_VAL);
            break;
        }
    }
    return until;
}

// Shares the first rows, events, strides and snapshots.
static bool share(const run_result *from, size_t rows, size_t events, size_t strides,
                  size_t snapshots, size_t rows_expected, run_result *result)
{
    const run_history *old = &from->history;
    run_history *own = &result->history;
    size_t most = rows_at_most(rows_expected);
    bool shared =
        trace_reserve(&result->trace, from->trace.angle_count, rows_expected, most) == STATUS_OK &&
        trace_share(&result->trace, &from->trace, rows, events) == STATUS_OK;
    if (shared && old->strides.reserved > 0) {
        shared =
            shared_array_reserve(&own->strides, old->strides.size, rows_expected, most) &&
            shared_array_share(&own->strides, &old->strides, strides) &&
            shared_array_reserve(&own->snapshots, old->snapshots.size, rows_expected / 64, most) &&
            shared_array_share(&own->snapshots, &old->snapshots, snapshots);
        own->stride_count = strides;
        own->snapshot_count = snapshots;
    }
    return shared;
}

static bool copy_touch(const run_result *from, run_result *result)
{
    result->touch = malloc(from->touch_size + 1);
    if (result->touch != NULL) {
        memcpy(result->touch, from->touch, from->touch_size);
        result->touch_size = from->touch_size;
    }
    return result->touch != NULL;
}

bool run_take_up(const run_result *from, const scenario *old, const scenario *s,
                 size_t rows_expected, run_result *result)
{
    memset(result, 0, sizeof *result);
    const run_history *h = &from->history;
    if (h->snapshot_count == 0) {
        return false;
    }
    double until = same_until(old, s) - MARGIN * s->parameters.method.step;
    size_t count = 0;
    while (count < h->snapshot_count && run_snapshot_at(h, count)->time < until) {
        count++;
    }
    if (count == 0) {
        return false;
    }
    const run_snapshot *last = run_snapshot_at(h, count - 1);
    bool taken =
        share(from, last->rows, last->events, last->strides, count, rows_expected, result) &&
        (!last->touched || copy_touch(from, result));
    if (!taken) {
        run_finish(result);
        return false;
    }
    result->summary = last->summary;
    return true;
}

status run_share(const run_result *from, size_t rows_expected, run_result *result)
{
    memset(result, 0, sizeof *result);
    const trace *t = &from->trace;
    bool done = share(from, t->row_count, t->event_count, from->history.stride_count,
                      from->history.snapshot_count, rows_expected, result) &&
                (from->touch == NULL || copy_touch(from, result));
    result->summary = from->summary;
    if (!done) {
        run_finish(result);
    }
    return done ? STATUS_OK : STATUS_NO_MEMORY;
}

static size_t fewer(size_t a, size_t b)
{
    return a < b ? a : b;
}

run_likeness run_compare_rows(const run_result *result, const run_result *like)
{
    const trace *a = &result->trace, *b = &like->trace;
    const run_history *h = &result->history, *k = &like->history;
    size_t rows = fewer(a->row_count, b->row_count);
    size_t events = fewer(a->event_count, b->event_count);
    size_t strides = fewer(h->stride_count, k->stride_count);
    return (run_likeness){
        .rows = shared_array_same_chunks(&a->row_array, &b->row_array, rows),
        .angles = shared_array_same_chunks(&a->angle_array, &b->angle_array, rows),
        .velocities = shared_array_same_chunks(&a->velocity_array, &b->velocity_array, rows),
        .events = shared_array_same_chunks(&a->event_array, &b->event_array, events),
        .strides = shared_array_same_chunks(&h->strides, &k->strides, strides)};
}

void run_merge(run_result *result, const run_result *like, const run_likeness *same)
{
    shared_array_merge(&result->trace.row_array, &like->trace.row_array, same->rows);
    shared_array_merge(&result->trace.angle_array, &like->trace.angle_array, same->angles);
    shared_array_merge(&result->trace.velocity_array, &like->trace.velocity_array,
                       same->velocities);
    shared_array_merge(&result->trace.event_array, &like->trace.event_array, same->events);
    shared_array_merge(&result->history.strides, &like->history.strides, same->strides);
}
