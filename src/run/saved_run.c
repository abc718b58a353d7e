#include "src/run/saved_run.h"

#include <string.h>

#include "src/run/saved_block.h"

static const block_kind run_block = {"armrun\0", 1, "run"};

// What stands behind the head; rows, angles, velocities and events follow.
typedef struct saved_counts {
    uint64_t rows, events, angle_count;
    summary summary;
    landing landing;
} saved_counts;

// The arrays of a trace; an empty one may have no address.
#define ARRAYS_OF(t)                                                                     \
    {                                                                                    \
        [TRACE_ROWS] = (t)->rows, [TRACE_ANGLES] = (t)->angles,                          \
        [TRACE_VELOCITIES] = (t)->velocities, [TRACE_EVENTS] = (t)->events               \
    }

// Their sizes [bytes].
static void array_sizes(const trace *t, size_t sizes[TRACE_ARRAYS])
{
    const size_t angles = t->row_count * (size_t)t->angle_count * sizeof(double);
    sizes[TRACE_ROWS] = t->row_count * sizeof(sample);
    sizes[TRACE_ANGLES] = angles;
    sizes[TRACE_VELOCITIES] = angles;
    sizes[TRACE_EVENTS] = t->event_count * sizeof(event);
}

size_t run_saved_size(const run_result *result)
{
    size_t sizes[TRACE_ARRAYS], size = sizeof(block_head) + sizeof(saved_counts);
    array_sizes(&result->trace, sizes);
    for (int i = 0; i < TRACE_ARRAYS; i++) {
        size += sizes[i];
    }
    return size;
}

void run_save(const run_result *result, const scenario *s, void *bytes)
{
    const trace *t = &result->trace;
    saved_counts counts;
    memset(&counts, 0, sizeof counts);
    counts.rows = t->row_count;
    counts.events = t->event_count;
    counts.angle_count = (uint64_t)t->angle_count;
    counts.summary = result->summary;
    counts.summary.path = NULL; // an address is no part of a run
    counts.landing = result->landing;
    char *at = (char *)bytes + sizeof(block_head);
    memcpy(at, &counts, sizeof counts);
    at += sizeof counts;

    // the arrays one after the other
    size_t sizes[TRACE_ARRAYS];
    array_sizes(t, sizes);
    const void *const arrays[TRACE_ARRAYS] = ARRAYS_OF(t);
    for (int i = 0; i < TRACE_ARRAYS; i++) {
        if (sizes[i] > 0) {
            memcpy(at, arrays[i], sizes[i]);
        }
        at += sizes[i];
    }
    block_seal(bytes, run_saved_size(result), &run_block, block_origin(s));
}

status run_restore(run_result *result, const scenario *s, const void *bytes, size_t size,
                   fault *f)
{
    TRY(block_check(bytes, size, &run_block, block_origin(s), f));
    saved_counts counts;
    const char *at = (const char *)bytes + sizeof(block_head);
    memcpy(&counts, at, sizeof counts);
    at += sizeof counts;

    // room for its rows and events
    trace *t = &result->trace;
    trace_init(t, (int)counts.angle_count);
    bool whole = trace_expect(t, counts.rows);
    for (size_t i = 0; i < counts.events && whole; i++) {
        whole = trace_add_event(t, (event){.index = -1}) == STATUS_OK;
    }
    if (!whole) {
        return fault_no_memory(f);
    }
    t->row_count = counts.rows;

    // the arrays as they were
    size_t sizes[TRACE_ARRAYS];
    array_sizes(t, sizes);
    void *const arrays[TRACE_ARRAYS] = ARRAYS_OF(t);
    for (int i = 0; i < TRACE_ARRAYS; i++) {
        if (sizes[i] > 0) {
            memcpy(arrays[i], at, sizes[i]);
        }
        at += sizes[i];
    }

    // then the caller may see what it came to
    result->summary = counts.summary;
    result->summary.path = "";
    result->landing = counts.landing;
    return STATUS_OK;
}
