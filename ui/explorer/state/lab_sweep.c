#include "ui/explorer/state/lab_sweep.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "src/base/loss.h"
#include "ui/explorer/state/parameter_list.h"

bool lab_sweep_is_on(const lab_sweep *sweep)
{
    assert(sweep != NULL);
    return sweep->axis.text != NULL;
}

bool lab_sweep_is_done(const lab_sweep *sweep)
{
    return !lab_sweep_is_on(sweep) || (size_t)sweep->count == sweep->axis.count;
}

void lab_sweep_end(lab_sweep *sweep)
{
    assert(sweep != NULL);
    for (int i = 0; i < sweep->count; i++) {
        run_finish(&sweep->runs[i].run);
    }
    sweep_axis_finish(&sweep->axis);
    sweep->axis = (sweep_axis){0};
    sweep->count = sweep->selected = 0;
}

status lab_sweep_begin(lab_sweep *sweep, const char *definition, fault *f)
{
    assert(sweep != NULL && definition != NULL);
    char text[256];
    sweep_axis axis = {0};
    snprintf(text, sizeof text, "%s", definition);
    char *values = strchr(text, '=');
    if (values == NULL) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "sweep takes PATH=FROM:TO:N or PATH=V1,V2,..., such as "
                         "control.rate=50:400:8");
    }

    // the parameter, then its values as --vary has them
    *values++ = '\0';
    axis.parameter = parameter_of_name(text);
    if (axis.parameter == -2) {
        return fault_set(f, STATUS_BAD_ARGUMENT, "several parameters begin with '%s'", text);
    }
    if (axis.parameter < 0) {
        parameter_look_up(text, f);
        return STATUS_BAD_ARGUMENT;
    }
    status code = sweep_axis_parse(&axis, values, false, f);
    if (code == STATUS_OK && axis.count > SWEPT_RUNS) {
        code = fault_set(f, STATUS_BAD_ARGUMENT,
                         "%zu runs are too many here, at most %d: 'impactlab sweep' takes any "
                         "number",
                         axis.count, SWEPT_RUNS);
    }
    if (code != STATUS_OK) {
        sweep_axis_finish(&axis);
        return code;
    }

    // it takes the place of the one before
    lab_sweep_end(sweep);
    sweep->axis = axis;
    return STATUS_OK;
}

status lab_sweep_compute_next(lab_sweep *sweep, const scenario *base, fault *f)
{
    assert(sweep != NULL && base != NULL && !lab_sweep_is_done(sweep));
    swept_run *next = &sweep->runs[sweep->count];
    *next = (swept_run){.value = sweep->axis.values[sweep->count], .id = ++sweep->computed};

    // everything but the parameters is the present run's
    scenario s = *base;
    status code = parameter_set_number(&s.parameters, sweep->axis.parameter, next->value, f);
    if (code == STATUS_OK) {
        code = parameters_resolve(&s.parameters, f);
    }
    if (code == STATUS_OK) {
        run_scenario(&s, true, &next->run);
        loss_unless(next->run.summary.status != STATUS_NO_MEMORY);
        code = next->run.trace.row_count > 0 ? STATUS_OK : summary_fault(&next->run.summary, f);
    }
    if (code != STATUS_OK) {
        run_finish(&next->run);
        lab_sweep_end(sweep);
        return code;
    }
    sweep->count++;
    return STATUS_OK;
}
