#include "src/run/run_result.h"

#include <stdlib.h>

void run_finish(run_result *result)
{
    trace_finish(&result->trace);
    force_history_finish(&result->history.forces);
    shared_array_finish(&result->history.checkpoints);
    free(result->before_impact);
    result->before_impact = NULL;
}

void run_monitor_count(run_monitor *monitor)
{
    if (monitor != NULL) {
        atomic_fetch_add_explicit(&monitor->pieces, 1, memory_order_relaxed);
    }
}
