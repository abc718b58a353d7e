#include "src/run/run_result.h"

#include <stdlib.h>
#include <string.h>

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

void run_finish(run_result *result)
{
    trace_finish(&result->trace);
    force_history_finish(&result->history.forces);
    shared_array_finish(&result->history.checkpoints);
    free(result->before_impact);
    result->before_impact = NULL;
}
