#include "src/run/run.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/run/driver.h"
#include "src/run/run_result.h"

void run_finish(run_result *result)
{
    trace_finish(&result->trace);
    shared_array_finish(&result->history.forces);
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

status run_scenario(const scenario *s, bool keep_trace, run_result *result)
{
    const run_options options = {.keep_trace = keep_trace};
    return run_scenario_with(s, &options, result);
}

status run_scenario_with(const scenario *s, const run_options *options, run_result *result)
{
    const time_used start = time_now();
    recording r;
    fault f;
    status code = recording_begin(&r, s, options, result, &f);
    if (code == STATUS_OK) {
        run_driver d;
        bool ended = false;
        code = driver_open(&d, &r, &f);
        code = code == STATUS_OK ? driver_advance(&d, HUGE_VAL, &ended, &f) : code;
        driver_close(&d, code);
    }
    recording_end(&r, code, &f, time_since(start));
    return code;
}

int run_check_expectations(const scenario *s, const run_result *result, fault_handler report,
                           void *context)
{
    assert(report != NULL || s->expectation_count == 0);
    int missed = 0;
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        const char *key = summary_table[e->quantity].key;
        double value = summary_value(&result->summary, e->quantity);
        if (expectation_is_met(e, value)) {
            continue;
        }

        // as the editor that opens the file wants it: place, what is and what was expected
        char sentence[512], found[64] = "nothing (null)";
        if (!isnan(value)) {
            decimal_print(found, sizeof found, "%.9g", value);
        }
        if (e->is_null) {
            snprintf(sentence, sizeof sentence, "%s:%d:%d: %s is %s, expected null", s->file,
                     e->line, e->column, key, found);
        } else {
            decimal_print(sentence, sizeof sentence, "%s:%d:%d: %s is %s, expected %.9g within %g",
                          s->file, e->line, e->column, key, found, e->value, e->tolerance);
        }
        report(context, sentence);
        missed++;
    }
    return missed;
}
