#include "src/study/convergence.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "src/study/bench.h"
#include "src/run/run.h"
#include "src/scenario/effect.h"
#include "src/base/plain_math.h"

#define ROUNDING       1e-13 // differences below this share of a value tell nothing
#define REFERENCE_STEP 2e-5  // [s]
#define LEAST_TIME     0.01  // for which a run's cost is measured [s]

// --- the convergence panel -------------------------------------------------------------

double observed_order(double coarse, double middle, double fine)
{
    double first = coarse - middle, second = middle - fine;
    double rounding = ROUNDING * fmax(fabs(coarse), fabs(fine));
    bool known = fabs(first) > rounding && fabs(second) > rounding &&
                 first * second > 0 && fabs(first) > fabs(second);
    if (known) {
        return plain_log(first / second) / M_LN2;
    }
    return (double)NAN;
}

double shared_digits(double a, double b)
{
    const double apart = fabs(a - b), larger = fmax(fabs(a), fabs(b));
    if (isnan(apart)) {
        return (double)NAN;
    }
    if (apart <= larger * DBL_EPSILON) {
        return DBL_DIG;
    }
    return fmin(fmax(0, plain_log(larger / apart) / M_LN10), DBL_DIG);
}

static const char *const panel_keys[] = {
    "first_contact_s",    "contact_impulse_Ns",
    "first_pulse_peak_N", "first_pulse_time_to_peak_s",
    "first_pulse_s",      "peak_force_N",
    "steady_force_N",     "motor_work_J",
};
enum { PANEL_KEYS = sizeof panel_keys / sizeof panel_keys[0] };

// A run of a scenario whose parameters were changed; all else in it is borrowed.
typedef struct one_run {
    scenario scenario;
    run_options options;
    run_result *kept; // NULL: its summary is enough
    summary summary;
    fault *fault;
} one_run;

// Runs r->scenario and keeps its summary, or all of it.
static status run_once(void *context)
{
    one_run *r = context;
    run_result run;
    const status code = run_scenario_with(&r->scenario, &r->options, &run);
    r->summary = run.summary;
    if (r->kept != NULL) {
        *r->kept = run;
    } else {
        run_finish(&run);
    }
    return code;
}

// The same at a step; a failure names it.
static status run_with_step(void *context)
{
    one_run *r = context;
    const status code = run_once(r);
    if (code == STATUS_OK) {
        return code;
    }
    return fault_set_at(r->fault, code, r->summary.path, "with a step of %g s: %s",
                        r->scenario.parameters.method.step, r->summary.message);
}

// The same at a tolerance.
static status run_with_tolerance(one_run *r)
{
    const status code = run_once(r);
    if (code == STATUS_OK) {
        return code;
    }
    return fault_set_at(r->fault, code, r->summary.path, "with a tolerance of %g: %s",
                        r->scenario.parameters.method.tolerance, r->summary.message);
}

// Chooses what the panel varies, and its values. Fails where the tolerance has no
// hundredth.
static status choose_settings(const scenario *s, convergence_panel *panel, fault *f)
{
    const int path = PARAMETER_INDEX(method.tolerance);
    const method_parameters *method = &s->parameters.method;
    panel->of_tolerance = effect_none(s, path) == NULL;
    if (!panel->of_tolerance) {
        for (int i = 0; i < PANEL_STEPS; i++) {
            panel->setting[i] = ldexp(method->step, -i);
        }
        return STATUS_OK;
    }

    // tenths, down to the least that there is
    double share = 1;
    for (int i = 0; i < PANEL_STEPS; i++) {
        panel->setting[i] = method->tolerance / share;
        share *= 10;
    }
    const double least = parameter_table[path].minimum;
    if (panel->setting[PANEL_STEPS - 1] < least * (1 - ROUNDING)) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "method.tolerance = %g has no hundredth to compare with, "
                         "expected %g at least",
                         method->tolerance, 100 * least);
    }
    return STATUS_OK;
}

status convergence_compute(const scenario *s, run_monitor *monitor, run_result *kept,
                           convergence_panel *panel, fault *f)
{
    summary results[PANEL_STEPS];
    one_run r = {*s, {.keep_trace = kept != NULL, .monitor = monitor}, .fault = f};
    panel->done = panel->row_count = 0;
    status code = choose_settings(s, panel, f);

    // three runs, each with half the step or a tenth of the tolerance of the one before
    for (int i = 0; i < PANEL_STEPS; i++) {
        if (kept != NULL) {
            r.kept = &kept[i];
        } else {
            r.kept = NULL;
        }
        if (code == STATUS_OK && panel->of_tolerance) {
            r.scenario.parameters.method.tolerance = panel->setting[i];
            code = run_with_tolerance(&r);
        } else if (code == STATUS_OK) {
            r.scenario.parameters.method.step = panel->setting[i];
            code = run_with_step(&r);
        }
        if (code == STATUS_OK) {
            results[panel->done++] = r.summary;
            run_monitor_count(monitor);
        }
    }

    // and the orders or digits that their results show
    panel->row_count = PANEL_KEYS;
    for (int k = 0; k < PANEL_KEYS; k++) {
        convergence_row *row = &panel->rows[k];
        row->key = panel_keys[k];
        for (int i = 0; i < PANEL_STEPS; i++) {
            if (i < panel->done) {
                row->value[i] = summary_value(&results[i], summary_index(row->key));
            } else {
                row->value[i] = (double)NAN;
            }
        }
        row->order = row->digits = (double)NAN;
        if (panel->of_tolerance) {
            row->digits = shared_digits(row->value[0], row->value[PANEL_STEPS - 1]);
        } else {
            row->order = observed_order(row->value[0], row->value[1], row->value[2]);
        }
    }
    return code;
}

size_t convergence_difference(const trace *coarse, const trace *fine, double *x,
                              double *y)
{
    size_t count = 0, j = 0;

    // both ascend, so each is gone through once; equal instants are equal to the last
    // bit, since halving a step is exact
    for (size_t i = 0; i < coarse->row_count; i++) {
        double time = coarse->rows[i].time;
        while (j < fine->row_count && fine->rows[j].time < time) {
            j++;
        }
        if (j < fine->row_count && fine->rows[j].time == time) {
            x[count] = time;
            y[count++] = coarse->rows[i].force - fine->rows[j++].force;
        }
    }
    return count;
}

// --- error against cost ----------------------------------------------------------------

const char *const study_methods[STUDY_METHODS] = {"newmark", "generalized-alpha",
                                                  "event"};
const char *const study_keys[STUDY_QUANTITIES] = {"first_contact_s", "first_pulse_peak_N",
                                                  "steady_force_N"};
static const method_kind method_kinds[STUDY_METHODS] = {METHOD_NEWMARK,
                                                        METHOD_GENERALIZED_ALPHA,
                                                        METHOD_EVENT};

static void values_of(const summary *s, double values[STUDY_QUANTITIES])
{
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        values[k] = summary_value(s, summary_index(study_keys[k]));
    }
}

// Runs a method at the step of the point, and finds its errors against the reference and
// its cost. A method that fails at a step has errors of NaN there.
static status study_one(const scenario *s, method_kind method, const double *reference,
                        run_monitor *monitor, study_point *point)
{
    one_run r = {*s, {.monitor = monitor}};
    double values[STUDY_QUANTITIES];
    status code;

    r.scenario.parameters.method.name = (int)method;
    r.scenario.parameters.method.step = point->step;
    point->cost = bench_seconds_per_call(run_with_step, &r, LEAST_TIME, &code);

    values_of(&r.summary, values);
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        if (code == STATUS_OK) {
            point->error[k] = fabs(values[k] - reference[k]);
        } else {
            point->error[k] = (double)NAN;
        }
    }
    return code;
}

// The steps 10 ms, 5 ms, 2 ms and so on, nothing measured yet.
static void prepare_points(method_study *study)
{
    static const double mantissas[] = {10, 5, 2};
    const double unknown = (double)NAN;
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        study->resolved[k] = unknown;
    }
    for (int m = 0; m < STUDY_METHODS; m++) {
        double per_second = 1000; // the decade's unit of time: 1 ms, 0.1 ms and so on
        for (int i = 0; i < STUDY_STEPS; i++) {
            if (i > 0 && i % 3 == 0) {
                per_second *= 10;
            }
            study->points[m][i] = (study_point){.step = mantissas[i % 3] / per_second,
                                                .cost = unknown,
                                                .error = {unknown, unknown, unknown}};
        }
    }
}

status method_study_compute(const scenario *s, run_monitor *monitor, method_study *study,
                            fault *f)
{
    _Static_assert(STUDY_QUANTITIES == 3, "an error each");
    one_run r = {*s, {.monitor = monitor}, .fault = f};
    prepare_points(study);

    // the reference against which errors are measured
    r.scenario.parameters.method.name = METHOD_EVENT;
    r.scenario.parameters.method.step = study->reference_step = REFERENCE_STEP;
    status code = run_with_step(&r);
    values_of(&r.summary, study->reference);
    TRY(code);
    run_monitor_count(monitor);

    // every method at every step
    for (int m = 0; m < STUDY_METHODS; m++) {
        for (int i = 0; i < STUDY_STEPS; i++) {
            study_point *point = &study->points[m][i];
            code = study_one(s, method_kinds[m], study->reference, monitor, point);
            if (code == STATUS_STOPPED || code == STATUS_NO_MEMORY) {
                point->cost = (double)NAN;
                return fault_set(f, code, "%s", status_text(code));
            }
            run_monitor_count(monitor);
            for (int k = 0; k < STUDY_QUANTITIES && method_kinds[m] != METHOD_EVENT;
                 k++) {
                study->resolved[k] = fmin(study->resolved[k], point->error[k]);
            }
        }
    }
    return STATUS_OK;
}

double method_study_cost(const method_study *study, int method, int k, double error,
                         double *step)
{
    assert(method >= 0 && method < STUDY_METHODS);
    assert(k >= 0 && k < STUDY_QUANTITIES);
    double least = (double)NAN;

    // from the shortest step up, as long as the error stays below
    for (int i = STUDY_STEPS - 1; i >= 0; i--) {
        const study_point *point = &study->points[method][i];
        if (!(point->error[k] <= error)) {
            break;
        }
        if (!(least <= point->cost)) {
            least = point->cost;
            *step = point->step;
        }
    }
    return least;
}
