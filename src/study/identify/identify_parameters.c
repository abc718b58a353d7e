// The parameters that are fitted: which, from where, and the scenario's with their
// values.
#include <math.h>
#include <string.h>

#include "src/study/identify/identify.h"

double identify_within_range(const fitted_parameter *fit, double value)
{
    return fmin(fmax(value, fit->low_most), fit->high_most);
}

status identify_add_path(identification *id, const char *text, fault *f)
{
    FAULT_IF(id->count == IDENTIFY_PATHS, f, STATUS_BAD_ARGUMENT,
             "more than %d parameters to fit", IDENTIFY_PATHS);
    fitted_parameter *p = &id->fit[id->count++];
    *p = (fitted_parameter){.value = (double)NAN};
    sweep_axis *axis = &p->axis;
    const char *range = strchr(text, '=');
    TRY(sweep_axis_find(axis, text, f));
    const parameter_info *info = sweep_axis_parameter(axis);
    if (info->type != PARAMETER_REAL && axis->element == 0) {
        return fault_set_at(f, STATUS_BAD_ARGUMENT, info->path,
                            "%s has no real value that could be fitted", axis->name);
    }
    for (const fitted_parameter *other = id->fit; other < p; other++) {
        if (strcmp(other->axis.name, axis->name) == 0) {
            return fault_set_at(f, STATUS_BAD_ARGUMENT, info->path, "%s is fitted twice",
                                axis->name);
        }
    }

    // the scenario's value and the range to search
    p->start = sweep_axis_get(axis, &id->base->parameters);
    if (isnan(p->start) && axis->element > 0) {
        return fault_set_at(f, STATUS_BAD_ARGUMENT, info->path,
                            "%s: the scenario's list is shorter", axis->name);
    }
    p->low_most = info->minimum;
    p->high_most = info->maximum;
    if (range != NULL) {
        TRY(sweep_axis_parse_range(axis, range + 1, f));
        p->low_most = fmin(axis->low, axis->high);
        p->high_most = fmax(axis->low, axis->high);
    } else if (!(fabs(p->start) > 0)) {
        return fault_set_at(f, STATUS_BAD_ARGUMENT, info->path,
                            "%s is 0 in the scenario, expected a range to search: %s=a:b",
                            axis->name, axis->name);
    }
    p->value = identify_within_range(p, p->start);
    if (fabs(p->value) > 0) {
        p->scale = fabs(p->value);
    } else {
        p->scale = fabs(p->high_most - p->low_most);
    }
    return STATUS_OK;
}

scenario_fit identify_left_open(const identification *id)
{
    scenario_fit open = {.count = 0};
    int of[SCENARIO_FIT]; // the fit's parameter of each
    for (int i = 0; i < id->count; i++) {
        const fitted_parameter *fit = &id->fit[i];
        const bool is_real = fit->axis.element == 0 &&
                             parameter_table[fit->axis.parameter].type == PARAMETER_REAL;
        if (fit->determined && fit->standard_error > 0 && is_real) {
            of[open.count] = i;
            open.errors[open.count] = fit->standard_error;
            open.parameters[open.count++] = fit->axis.parameter;
        }
    }
    for (int i = 0; i < open.count; i++) {
        for (int k = 0; k < open.count; k++) {
            const double *covariance = id->covariance;
            const double variances =
                covariance[of[i] * (id->count + 1)] * covariance[of[k] * (id->count + 1)];
            double correlation = covariance[of[i] * id->count + of[k]] / sqrt(variances);
            if (i == k) {
                correlation = 1;
            }
            open.correlation[i * open.count + k] = fmin(fmax(correlation, -1), 1);
        }
    }
    return open;
}

bool identify_at_end(const fitted_parameter *fit)
{
    return fit->value == fit->low_most || fit->value == fit->high_most;
}

status identify_parameters(const identification *id, bool determined, parameters *p,
                           fault *f)
{
    *p = id->base->parameters;
    for (int i = 0; i < id->count; i++) {
        const fitted_parameter *fit = &id->fit[i];
        if (!determined || fit->determined) {
            TRY(sweep_axis_apply(&fit->axis, fit->value, p, f));
        }
    }
    return STATUS_OK;
}
