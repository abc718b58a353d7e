#include "src/run/run.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "src/run/recording.h"

#define AT(field) offsetof(summary, field)

const summary_info summary_table[] = {
    {"first_contact_s", AT(first_contact_s), false},
    {"contact_impulse_Ns", AT(contact_impulse_Ns), false},
    {"first_pulse_peak_N", AT(first_pulse_peak_N), false},
    {"first_pulse_time_to_peak_s", AT(first_pulse_time_to_peak_s), false},
    {"first_pulse_s", AT(first_pulse_s), false},
    {"peak_force_N", AT(peak_force_N), false},
    {"time_to_peak_s", AT(time_to_peak_s), false},
    {"impacts", AT(impacts), false},
    {"separations", AT(separations), false},
    {"steady_force_N", AT(steady_force_N), false},
    {"force_overshoot_percent", AT(force_overshoot_percent), false},
    {"settling_time_s", AT(settling_time_s), false},
    {"max_penetration_m", AT(max_penetration_m), false},
    {"motor_work_J", AT(motor_work_J), false},
    {"energy_residual_J", AT(energy_residual_J), false},
    {"force_command_N", AT(force_command_N), false},
    {"force_over_command_N", AT(force_over_command_N), false},
    {"steady_error_N", AT(steady_error_N), false},
    {"largest_command_V", AT(largest_command_V), false},
    {"electrical_energy_J", AT(electrical_energy_J), false},
    {"steps", AT(steps), false},
    {"wall_time_s", AT(wall_time_s), true},
};
const int summary_count = (int)(sizeof summary_table / sizeof summary_table[0]);

bool summary_get(const summary *s, const char *key, double *value)
{
    for (int i = 0; i < summary_count; i++) {
        if (strcmp(summary_table[i].key, key) == 0) {
            memcpy(value, (const char *)s + summary_table[i].offset, sizeof *value);
            return true;
        }
    }
    return false;
}

static void summary_clear(summary *s)
{
    memset(s, 0, sizeof *s);
    for (int i = 0; i < summary_count; i++) {
        double none = (double)NAN;
        memcpy((char *)s + summary_table[i].offset, &none, sizeof none);
    }
    s->impacts = s->separations = s->steps = s->max_penetration_m = 0;
    s->motor_work_J = s->energy_residual_J = 0;
}

static double computing_time(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

status run_scenario(const scenario *s, bool keep_trace, run_result *result)
{
    const run_options options = {.keep_trace = keep_trace};
    return run_scenario_with(s, &options, result);
}

status run_scenario_with(const scenario *s, const run_options *options, run_result *result)
{
    recording r = {.scenario = s,
                   .result = result,
                   .options = *options,
                   .keep_trace = options->keep_trace,
                   .now = s->parameters};
    fault f = {STATUS_OK, ""};
    double start = computing_time();
    shared_array_init(&r.own_steps, sizeof(force_step));
    if (!options->resume) {
        memset(result, 0, sizeof *result);
        summary_clear(&result->summary);
    }
    status code = recording_start_rig(&r, &f);
    if (code == STATUS_OK) {
        code = s->parameters.arm.model == ARM_PRINTED ? run_printed(&r, &f) : run_corrected(&r, &f);
    }
    rig_destroy(r.rig);
    if (code != STATUS_OK && f.code == STATUS_OK) {
        fault_set(&f, code, "%s", status_text(code));
    }
    result->summary.status = code;
    if (code != STATUS_OK) {
        snprintf(result->summary.message, sizeof result->summary.message, "%s", f.text);
    }
    result->summary.wall_time_s = computing_time() - start;
    shared_array_finish(&r.own_steps);
    return code;
}

void run_finish(run_result *result)
{
    trace_finish(&result->trace);
    shared_array_finish(&result->history.steps);
    shared_array_finish(&result->history.checkpoints);
    free(result->before_impact);
    result->before_impact = NULL;
}

int run_check_expectations(const scenario *s, const run_result *result, fault_handler report,
                           void *context)
{
    int missed = 0;
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        char sentence[512], found[64] = "nothing (null)";
        double value = (double)NAN;
        summary_get(&result->summary, e->quantity, &value);
        bool met = e->is_null ? isnan(value) : fabs(value - e->value) <= e->tolerance;
        if (met) {
            continue;
        }
        if (!isnan(value)) {
            snprintf(found, sizeof found, "%.9g", value);
        }
        if (e->is_null) {
            snprintf(sentence, sizeof sentence, "%s:%d:%d: %s is %s, expected null", s->file,
                     e->line, e->column, e->quantity, found);
        } else {
            snprintf(sentence, sizeof sentence, "%s:%d:%d: %s is %s, expected %.9g within %g",
                     s->file, e->line, e->column, e->quantity, found, e->value, e->tolerance);
        }
        report(context, sentence);
        missed++;
    }
    return missed;
}
