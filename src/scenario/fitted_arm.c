#include "src/scenario/fitted_arm.h"

#include <math.h>
#include <string.h>

#include "src/base/dense.h"
#include "src/tables/parameters.h"

#define ROUNDING 1e-9 // of correlations that leave some combinations certain

bool fitted_arm_factor(const scenario_fit *fit,
                       double factor[SCENARIO_FIT * SCENARIO_FIT])
{
    memcpy(factor, fit->correlation, sizeof fit->correlation);
    for (int i = 0; i < fit->count; i++) {
        factor[i * fit->count + i] += ROUNDING;
    }
    return symmetric_factor(fit->count, factor);
}

void fitted_arm_draw(const scenario *around, random_generator *chance, double *values)
{
    const scenario_fit *fit = around->fit;
    double factor[SCENARIO_FIT * SCENARIO_FIT];
    fitted_arm_factor(fit, factor);

    double normal[SCENARIO_FIT];
    for (int i = 0; i < fit->count; i++) {
        normal[i] = random_about_normal(chance);
    }

    // each parameter with those before it
    for (int i = 0; i < fit->count; i++) {
        double deviations = 0;
        for (int k = 0; k <= i; k++) {
            deviations += factor[i * fit->count + k] * normal[k];
        }
        const int parameter = fit->parameters[i];
        const parameter_info *info = &parameter_table[parameter];
        const double fitted = parameter_get(&around->parameters, parameter);
        values[i] = fmin(fmax(fitted + deviations * fit->errors[i], info->minimum),
                         info->maximum);
    }
}

int fitted_arm_belief(int parameter)
{
    const struct {
        int parameter, belief;
    } beliefs[] = {
        {PARAMETER_INDEX(arm.k2), PARAMETER_INDEX(belief.k2_factor)},
        {PARAMETER_INDEX(arm.mass), PARAMETER_INDEX(belief.mass_factor)},
        {PARAMETER_INDEX(arm.hub_inertia), PARAMETER_INDEX(belief.inertia_factor)},
        {PARAMETER_INDEX(motor.torque_constant), PARAMETER_INDEX(belief.torque_factor)},
        {PARAMETER_INDEX(motor.stiction), PARAMETER_INDEX(belief.friction_factor)}};
    for (size_t i = 0; i < sizeof beliefs / sizeof beliefs[0]; i++) {
        if (beliefs[i].parameter == parameter) {
            return beliefs[i].belief;
        }
    }
    return -1;
}

double fitted_arm_believed(const scenario *around, int parameter, double value)
{
    const double belief =
        parameter_get(&around->parameters, fitted_arm_belief(parameter));
    if (value == 0) {
        return belief;
    }
    const double fitted = parameter_get(&around->parameters, parameter);
    return fmin(fmax(belief * fitted / value, 0.01), 100);
}
