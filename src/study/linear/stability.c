// Stability of a scenario's loop over parameters: by the closed poles, without friction, and by
// runs, with everything.
#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "src/base/plain_math.h"
#include "src/run/run.h"
#include "src/study/linear/linear.h"

enum { BISECTIONS = 40, RUN_BISECTIONS = 12 };

status linear_growth(const scenario *s, linear_place place, double *growth, fault *f)
{
    assert(s != NULL && growth != NULL);
    linear_arm arm;
    linear_system loop = {0};
    *growth = (double)NAN;
    status code = linear_arm_init(&arm, &s->parameters, place, f);
    code = code == STATUS_OK ? linear_loop(&loop, &arm, &s->parameters, f) : code;
    double complex *poles = calloc((size_t)loop.states + 1, sizeof *poles);
    if (code == STATUS_OK) {
        linear_close(&loop);
        code = poles != NULL ? linear_poles(&loop, poles, f) : fault_no_memory(f);
    }
    if (code == STATUS_OK && loop.states > 0) {
        *growth = plain_log(cabs(poles[loop.states - 1])) * s->parameters.control.rate;
    }
    free(poles);
    linear_system_finish(&loop);
    linear_system_finish(&arm.system);
    return code;
}

status linear_settling(const scenario *s, double *settling, fault *f)
{
    assert(s != NULL && settling != NULL);
    run_result result;
    const status code = run_scenario(s, false, &result);
    *settling = result.summary.settling_time_s;
    if (code == STATUS_NO_MEMORY || code == STATUS_NOT_ALLOWED) {
        summary_fault(&result.summary, f);
    }
    run_finish(&result);
    return code == STATUS_NO_MEMORY || code == STATUS_NOT_ALLOWED ? code : STATUS_OK;
}

// Whether the loop of the scenario with a value of the axis is stable.
static status stable_at(const sweep *s, linear_place place, bool by_runs, double value,
                        bool *stable, fault *f)
{
    parameters p = s->base->parameters;
    scenario derived = *s->base; // borrows all but its parameters
    double number = (double)NAN;
    status code = sweep_axis_apply(&s->axes[0], value, &p, f);
    code = code == STATUS_OK ? scenario_take_parameters(&derived, &p, f) : code;
    if (code == STATUS_OK) {
        code = by_runs ? linear_settling(&derived, &number, f)
                       : linear_growth(&derived, place, &number, f);
    }
    *stable = by_runs ? isfinite(number) : number < 0;
    return code;
}

status linear_limit(const sweep *s, linear_place place, bool by_runs, double from, double to,
                    double *limit, fault *f)
{
    assert(s != NULL && s->axis_count == 1 && limit != NULL);
    bool at_start, here;
    status code = stable_at(s, place, by_runs, from, &at_start, f);
    for (int i = 0; i < (by_runs ? RUN_BISECTIONS : BISECTIONS) && code == STATUS_OK; i++) {
        const double middle = (from + to) / 2;
        code = stable_at(s, place, by_runs, middle, &here, f);
        *(here == at_start ? &from : &to) = middle;
    }
    *limit = (from + to) / 2;
    return code;
}
