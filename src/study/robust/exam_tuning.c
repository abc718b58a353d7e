#include "src/study/robust/exam_tuning.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/rig/controller_values.h"
#include "src/rig/rig.h"

#define FIRST_STEP 0.07 // share of the ranges

// The value that the scenario gives; of a setting that it does not give, the law's own.
static double given_value(const scenario *s, const sweep_axis *axis)
{
    const double value = sweep_axis_get(axis, &s->parameters);
    const controller *law = controller_of(s->parameters.control.law);
    const char *dot = strrchr(axis->name, '.');
    if (!isnan(value) || law == NULL || dot == NULL) {
        return value;
    }
    const int index = controller_find_parameter(law, dot + 1);
    return index >= 0 ? controller_parameter_at(law, index).initial : value;
}

// Whether the law takes a value of an axis; f says why not, such as that it has no such
// setting.
static status try_value(const scenario *s, const sweep_axis *axis, double value, fault *f)
{
    scenario tried;
    rig *r;
    TRY(sweep_axes_scenario(axis, 1, &value, s, &tried, f));
    TRY(rig_create(&r, &tried.parameters, NULL, f));
    rig_destroy(r);
    return STATUS_OK;
}

// Reads one of what is varied.
static status read_axis(exam_tuning *t, const char *text, fault *f)
{
    sweep_axis *axis = &t->axes[t->axis_count++];
    const char *equals = strchr(text, '=');
    FAULT_IF(equals == NULL, f, STATUS_BAD_ARGUMENT,
             "--vary %.200s: expected a range, PATH=a:b", text);
    TRY(sweep_axis_find(axis, text, f));
    TRY(sweep_axis_parse_range(axis, equals + 1, f));
    TRY(try_value(t->asked.base, axis, axis->low, f));
    TRY(try_value(t->asked.base, axis, axis->high, f));
    const double given = given_value(t->asked.base, axis);
    FAULT_IF(!isfinite(given), f, STATUS_BAD_ARGUMENT,
             "--vary %.200s: the scenario gives it no value to begin with", text);
    t->given[t->axis_count - 1] = t->found[t->axis_count - 1] = given;
    return STATUS_OK;
}

status exam_tuning_init(exam_tuning *t, const exam_request *asked, char *const *vary,
                        int vary_count, size_t evaluations, fault *f)
{
    assert(asked->law_count == 1 && evaluations >= 1);
    *t = (exam_tuning){.asked = *asked,
                       .evaluations = evaluations,
                       .given_loss = (double)NAN,
                       .found_loss = (double)INFINITY};
    FAULT_IF(vary_count > EVOLUTION_MOST, f, STATUS_BAD_ARGUMENT,
             "at most %d parameters can be varied", EVOLUTION_MOST);
    for (int i = 0; i < vary_count; i++) {
        TRY(read_axis(t, vary[i], f));
    }
    scenario tried;
    return exam_tuning_apply(t, t->given, &tried, f);
}

void exam_tuning_finish(exam_tuning *t)
{
    for (int i = 0; i < t->axis_count; i++) {
        sweep_axis_finish(&t->axes[i]);
    }
    t->axis_count = 0;
}

status exam_tuning_apply(const exam_tuning *t, const double *values, scenario *s,
                         fault *f)
{
    return sweep_axes_scenario(t->axes, t->axis_count, values, t->asked.base, s, f);
}

status exam_tuning_exam(const exam_tuning *t, const double *values, size_t cases,
                        uint64_t seed, const exam_options *options, law_exam *e, fault *f)
{
    scenario changed;
    *e = (law_exam){.runs = 0};
    TRY(exam_tuning_apply(t, values, &changed, f));
    exam_request asked = t->asked;
    asked.base = &changed;
    asked.cases = cases;
    asked.seed = seed;
    const status code = law_exam_run(e, &asked, options, f);
    e->asked.base = t->asked.base; // the changed one goes with this call
    return code;
}

double exam_loss(const law_exam *e)
{
    const size_t runs = (size_t)e->asked.force_count * e->asked.cases;
    double sum = 0;
    for (size_t i = 0; i < runs; i++) {
        double power = e->verdicts[i].worst;
        for (int doubling = 0; doubling < 4; doubling++) {
            power *= power;
        }
        sum += isfinite(power) ? power / (1 + power) : 1;
    }
    return sum / (double)runs;
}

// --- the search ------------------------------------------------------------------------

// The share of its range at which an axis has a value.
static double share_of(const sweep_axis *axis, double value)
{
    double low = 0, high = 1;
    for (int k = 0; k < 50; k++) {
        const double middle = (low + high) / 2;
        const bool below = sweep_axis_value_at(axis, middle) < value;
        if (below == (axis->high > axis->low)) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return high;
}

// The values at shares of the ranges, to four digits: more are luck, and take room.
static void values_at(const exam_tuning *t, const double *shares, double *values)
{
    for (int i = 0; i < t->axis_count; i++) {
        const double share = fmin(shares[i], nextafter(1, 0));
        char text[NUMBER_TEXT];
        decimal_print(text, sizeof text, "%.4g", sweep_axis_value_at(&t->axes[i], share));
        values[i] = decimal_parse(text, NULL);
    }
}

// The loss with values; values that are refused have the largest one, and f says why.
static status evaluate(exam_tuning *t, const double *values, const exam_options *options,
                       double *loss, bool *refused, fault *f)
{
    SCOPED(law_exam_finish) law_exam e = {.runs = 0};
    const status code =
        exam_tuning_exam(t, values, t->asked.cases, t->asked.seed, options, &e, f);
    *loss = 1;
    t->done++;
    *refused = code == STATUS_BAD_ARGUMENT || code == STATUS_BAD_SCENARIO;
    if (*refused) {
        return STATUS_OK;
    }
    if (code == STATUS_OK) {
        *loss = exam_loss(&e);
    }
    if (code == STATUS_OK && *loss < t->found_loss) {
        t->found_loss = *loss;
        memcpy(t->found, values, (size_t)t->axis_count * sizeof *values);
    }
    return code;
}

// Evaluates the points of a generation. Where all are refused the last one's reason ends
// the search.
static status try_generation(exam_tuning *t, const evolution *e, const double *drawn,
                             const exam_options *options, double *losses, fault *f)
{
    int refusals = 0;
    for (int p = 0; p < e->points; p++) {
        double values[EVOLUTION_MOST];
        bool refused;
        values_at(t, drawn + p * e->n, values);
        TRY(evaluate(t, values, options, &losses[p], &refused, f));
        refusals += refused;
    }
    return refusals == e->points ? STATUS_BAD_ARGUMENT : STATUS_OK;
}

// Generations until the evaluations are spent.
static status evolve(exam_tuning *t, evolution *e, double *drawn,
                     const exam_options *options, fault *f)
{
    bool goes_on = true;
    const size_t needed = (size_t)e->points + 1; // of a generation, and its mean
    while (goes_on && (e->generation == 0 || t->done + needed <= t->evaluations)) {
        double losses[EVOLUTION_MOST];
        const double before = t->found_loss;
        evolution_draw(e, drawn);
        TRY(try_generation(t, e, drawn, options, losses, f));
        goes_on = evolution_take(e, drawn, losses);
        if (t->told != NULL) {
            TRY(t->told(t->context, t, t->found_loss < before, f));
        }
    }

    // the mean of the last generation has less of its draws' luck than any of them
    double values[EVOLUTION_MOST], unused;
    bool refused;
    values_at(t, e->mean, values);
    return evaluate(t, values, options, &unused, &refused, f);
}

status exam_tuning_run(exam_tuning *t, const exam_options *options, fault *f)
{
    bool refused;
    TRY(evaluate(t, t->given, options, &t->given_loss, &refused, f));
    if (refused) {
        return STATUS_BAD_ARGUMENT;
    }
    double start[EVOLUTION_MOST];
    for (int i = 0; i < t->axis_count; i++) {
        start[i] = share_of(&t->axes[i], t->given[i]);
    }

    SCOPED(evolution_finish) evolution e;
    TRY(evolution_init(&e, t->axis_count, start, FIRST_STEP, t->asked.seed, f));
    const size_t size = (size_t)e.points * (size_t)e.n;
    SCOPED(free_kept) double *drawn = calloc(size, sizeof *drawn);
    if (drawn == NULL) {
        return fault_no_memory(f);
    }
    return evolve(t, &e, drawn, options, f);
}
