// Where a loop is stable: of one scenario, and over all combinations of varied values.
#include <math.h>
#include <stdlib.h>

#include "src/base/plain_math.h"
#include "src/run/run.h"
#include "src/study/linear/linear.h"

// Halvings of the interval between two values of an axis in which stability changes: of
// the linear form, and of runs, which take longer.
enum { BISECTIONS = 40, RUN_BISECTIONS = 12 };

// How fast the slowest part of the closed linear loop grows [1/s]: log|z| over the
// period, z being the largest pole of the sampled loop.
static status growth_of(const scenario *s, linear_place place, double *growth, fault *f)
{
    SCOPED(linear_arm_finish) linear_arm arm = {{0}};
    SCOPED(linear_system_finish) linear_system loop = {0};
    TRY(linear_arm_init(&arm, &s->parameters, place, f));
    TRY(linear_loop(&loop, &arm, &s->parameters, f));
    linear_close(&loop);
    SCOPED(free_kept)
    double complex *poles = calloc((size_t)loop.states + 1, sizeof *poles);
    if (poles == NULL) {
        return fault_no_memory(f);
    }
    TRY(linear_poles(&loop, poles, f));
    *growth = plain_log(cabs(poles[loop.states - 1])) * s->parameters.control.rate;
    return STATUS_OK;
}

status linear_stability(const scenario *s, linear_place place, bool by_runs,
                        double *number, fault *f)
{
    *number = (double)NAN;
    if (!by_runs) {
        return growth_of(s, place, number, f);
    }
    SCOPED(run_finish) run_result result;
    const status code = run_scenario(s, false, &result);
    *number = result.summary.settling_time_s;
    if (code == STATUS_NO_MEMORY || code == STATUS_NOT_ALLOWED ||
        code == STATUS_STOPPED) {
        return summary_fault(&result.summary, f);
    }
    return STATUS_OK;
}

status linear_growth(const scenario *s, double *growth, fault *f)
{
    const bool by_runs = false;
    return linear_stability(s, LINEAR_CONTACT, by_runs, growth, f);
}

// Where stability changes between the i-th value of a single axis and the one before.
static status find_limit(const linear_survey *y, size_t i, linear_place place,
                         bool by_runs, double *limit, fault *f)
{
    const sweep_axis *axis = &y->sweep.axes[0];
    double from = sweep_axis_value(axis, i - 1), to = sweep_axis_value(axis, i);
    const bool stable_at_from = linear_is_stable(by_runs, y->numbers[by_runs][i - 1]);
    const int halvings = by_runs ? RUN_BISECTIONS : BISECTIONS;
    for (int n = 0; n < halvings; n++) {
        const double value = (from + to) / 2;
        scenario derived;
        double number;
        TRY(sweep_axes_scenario(y->sweep.axes, 1, &value, y->sweep.base, &derived, f));
        TRY(linear_stability(&derived, place, by_runs, &number, f));
        if (linear_is_stable(by_runs, number) == stable_at_from) {
            from = value;
        } else {
            to = value;
        }
    }
    *limit = (from + to) / 2;
    return STATUS_OK;
}

// Finds both numbers of combination i, of the linear form and by a run, and of a single
// axis the limit between it and the combination before if one is stable and one is not.
static status survey_one(linear_survey *y, size_t i, linear_place place, fault *f)
{
    scenario derived;
    TRY(sweep_scenario(&y->sweep, i, &derived, f));
    for (int by_runs = 0; by_runs <= 1; by_runs++) {
        double *numbers = y->numbers[by_runs];
        TRY(linear_stability(&derived, place, by_runs, &numbers[i], f));
        if (y->sweep.axis_count != 1 || i == 0 || y->limit_count == LINEAR_MOST_LIMITS) {
            continue;
        }
        const bool stable_before = linear_is_stable(by_runs, numbers[i - 1]);
        if (linear_is_stable(by_runs, numbers[i]) != stable_before) {
            y->limits[y->limit_count].by_runs = by_runs;
            TRY(find_limit(y, i, place, by_runs, &y->limits[y->limit_count].value, f));
            y->limit_count++;
        }
    }
    return STATUS_OK;
}

status linear_survey_begin(linear_survey *y, const scenario *s,
                           const sweep_request *request, fault *f)
{
    *y = (linear_survey){.limit_count = 0};
    TRY(sweep_init(&y->sweep, s, request, f));
    const size_t count = y->sweep.run_count;
    y->numbers[0] = calloc(2 * count, sizeof *y->numbers[0]);
    if (y->numbers[0] == NULL) {
        sweep_finish(&y->sweep);
        return fault_no_memory(f);
    }
    y->numbers[1] = y->numbers[0] + count;
    for (size_t i = 0; i < 2 * count; i++) {
        y->numbers[0][i] = (double)NAN;
    }
    return STATUS_OK;
}

status linear_survey_make(linear_survey *y, linear_place place, run_monitor *monitor,
                          fault *f)
{
    // what the monitor has counted is done, even where it stops the survey then
    while (y->done < y->sweep.run_count) {
        TRY(survey_one(y, y->done, place, f));
        y->done++;
        run_monitor_count(monitor);
        FAULT_IF(run_monitor_stops(monitor), f, STATUS_STOPPED, "%s",
                 status_text(STATUS_STOPPED));
    }
    return STATUS_OK;
}

void linear_survey_finish(linear_survey *y)
{
    free(y->numbers[0]);
    sweep_finish(&y->sweep);
}
