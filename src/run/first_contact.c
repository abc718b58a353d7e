#include "src/run/first_contact.h"

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
    return motor->torque_constant > 0 ? row->motor_torque / motor->torque_constant : 0;
}

const sample *predict_first_contact(const scenario *s, const run_result *result,
                                    const voltage_profile *then,
                                    prediction_answer answers[PREDICTOR_COUNT])
{
    const sample *row = row_before_landing(result);
    if (row == NULL) {
        return NULL;
    }

    // under a control law the voltage in force is the law's
    parameters now = scenario_parameters_at(s, row->time);
    now.motor.voltage = row->voltage;
    const double *all = result->before_impact;
    int half = (int)(result->before_impact_size / sizeof *all / 2);
    prediction_question question = {.parameters = &now,
                                    .bodies = row_bodies(row),
                                    .angles = all,
                                    .velocities = all != NULL ? all + half : NULL,
                                    .command = then != NULL ? *then : (voltage_profile){0},
                                    .whole_pulse = true,
                                    .current = row_current(&now.motor, row)};
    predict_all(&question, answers);
    return row;
}
