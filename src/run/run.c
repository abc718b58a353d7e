#include "src/run/run.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "src/base/numbers.h"
#include "src/run/corrected.h"
#include "src/run/printed.h"
#include "src/run/rig_recording.h"

// What a run counts and adds up begins with nothing.
static void summary_start(summary *s)
{
    summary_init(s);
    s->impacts = s->separations = s->steps = s->max_penetration_m = 0;
    s->motor_work_J = s->energy_residual_J = 0;
}

static double seconds_of(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

status run_scenario(const scenario *s, bool keep_trace, run_result *result)
{
    const run_options options = {.keep_trace = keep_trace};
    return run_scenario_with(s, &options, result);
}

status run_scenario_with(const scenario *s, const run_options *options, run_result *result)
{
    assert(s != NULL && options != NULL && result != NULL);
    recording r = {.scenario = s, .result = result, .options = options, .now = s->parameters};
    fault f = {.text = "", .path = ""};
    const double start = seconds_of(CLOCK_MONOTONIC);
    const double start_cpu = seconds_of(CLOCK_THREAD_CPUTIME_ID);
    if (!options->resume) {
        memset(result, 0, sizeof *result);
        summary_start(&result->summary);
    }

    // the model's run, with the rig if a law is chosen
    status code = recording_start_rig(&r, &f);
    if (code == STATUS_OK) {
        code = s->parameters.arm.model == ARM_PRINTED ? run_printed(&r, &f) : run_corrected(&r, &f);
    }
    rig_destroy(r.rig);

    // what stopped it
    result->summary.status = code;
    if (code != STATUS_OK) {
        const char *why = f.code != STATUS_OK ? f.text : status_text(code);
        snprintf(result->summary.message, sizeof result->summary.message, "%s", why);
        result->summary.path = f.path;
    }

    result->summary.cpu_time_s = seconds_of(CLOCK_THREAD_CPUTIME_ID) - start_cpu;
    result->summary.wall_time_s = seconds_of(CLOCK_MONOTONIC) - start;
    if (result->history.forces.array.reserved == 0) {
        force_history_finish(&result->history.forces); // needed until here only
    }
    return code;
}

int run_check_expectations(const scenario *s, const run_result *result, fault_handler report,
                           void *context)
{
    assert(s != NULL && result != NULL && (report != NULL || s->expectation_count == 0));
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
