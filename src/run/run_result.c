// What a run leaves, and what others are told of its work.
#include "src/run/run_result.h"

void run_finish(run_result *result)
{
    trace_finish(&result->trace);
    shared_array_finish(&result->history.forces);
    shared_array_finish(&result->history.checkpoints);
}

void run_monitor_count(run_monitor *monitor)
{
    if (monitor != NULL) {
        atomic_fetch_add_explicit(&monitor->pieces, 1, memory_order_relaxed);
    }
}
