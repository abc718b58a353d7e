#include "src/run/run.h"

#include <assert.h>
#include <math.h>

#include "src/base/numbers.h"
#include "src/run/run_driver.h"
#include "src/run/run_result.h"

status run_scenario(const scenario *s, bool keep_trace, run_result *result)
{
    const run_options options = {.keep_trace = keep_trace};
    return run_scenario_with(s, &options, result);
}

status run_scenario_with(const scenario *s, const run_options *options,
                         run_result *result)
{
    run_driver d;
    fault f;
    bool ended = false;
    status code = driver_open(&d, s, options, result, &f);
    if (code == STATUS_OK) {
        code = driver_advance(&d, HUGE_VAL, &ended, &f);
    }
    driver_close(&d, code, &f);
    return code;
}

int run_check_expectations(const scenario *s, const run_result *result,
                           fault_handler report, void *context)
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

        // file, line and column, as editors read them, then the value and what was
        // expected
        char sentence[512], found[64] = "nothing (null)";
        if (!isnan(value)) {
            decimal_print(found, sizeof found, "%.9g", value);
        }
        if (e->is_null) {
            snprintf(sentence, sizeof sentence, "%s:%d:%d: %s is %s, expected null",
                     s->file, e->line, e->column, key, found);
        } else {
            decimal_print(sentence, sizeof sentence,
                          "%s:%d:%d: %s is %s, expected %.9g within %g", s->file, e->line,
                          e->column, key, found, e->value, e->tolerance);
        }
        report(context, sentence);
        missed++;
    }
    return missed;
}

// --- before the first contact ---

const sample *row_before_landing(const run_result *result)
{
    const trace *t = &result->trace;
    const double from = result->landing.time;
    for (size_t i = 1; from > 0 && i < t->row_count; i++) {
        const sample *row = &t->rows[i];
        if (row->time >= from && (row->contact != 0 || row->impulse != 0)) {
            return &t->rows[i - 1];
        }
    }
    return NULL;
}

three_body_state row_bodies(const sample *row)
{
    return (three_body_state){
        .angle = {row->hub_angle, row->first_angle, row->last_angle},
        .velocity = {row->hub_velocity, row->first_velocity, row->last_velocity},
    };
}

double row_current(const motor_parameters *motor, const sample *row)
{
    if (motor->torque_constant > 0) {
        return row->motor_torque / motor->torque_constant;
    }
    return 0;
}

const sample *predict_first_contact(const scenario *s, const run_result *result,
                                    const voltage_profile *then,
                                    prediction_answer answers[PREDICTOR_COUNT])
{
    const sample *row = row_before_landing(result);
    if (row == NULL) {
        return NULL;
    }

    // the parameters at that instant, with the voltage that was in force
    parameters now = scenario_parameters_at(s, row->time);
    now.motor.voltage = row->voltage;

    // angles and velocities of all links, which only the corrected model has
    const bool known = now.arm.model == ARM_CORRECTED;
    const size_t at =
        (size_t)(row - result->trace.rows) * (size_t)result->trace.angle_count;
    prediction_question question = {.parameters = &now,
                                    .bodies = row_bodies(row),
                                    .angles = known ? result->trace.angles + at : NULL,
                                    .velocities =
                                        known ? result->trace.velocities + at : NULL,
                                    .command =
                                        then != NULL ? *then : (voltage_profile){0},
                                    .whole_pulse = true,
                                    .current = row_current(&now.motor, row)};
    predict_all(&question, answers);
    return row;
}
