#include "src/study/robust.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

static const double robust_levels[ROBUST_QUANTILES] = {
    [ROBUST_MEDIAN] = 0.5, [ROBUST_NINE_TENTHS] = 0.9, [ROBUST_WORST] = 1};

// --- a law ------------------------------------------------------------------------------------

// Ascending, with NaN behind all numbers.
static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    if (isnan(x) || isnan(y)) {
        return isnan(x) - isnan(y);
    }
    return (x > y) - (x < y);
}

// Sorts the values; between two of them a quantile lies on a straight line.
static void find_quantiles(double *values, size_t count, double *quantiles)
{
    qsort(values, count, sizeof *values, compare_numbers);
    for (int i = 0; i < ROBUST_QUANTILES; i++) {
        double place = robust_levels[i] * (double)(count - 1), whole = floor(place);
        size_t at = (size_t)whole, next = at + 1 < count ? at + 1 : at;
        double part = place - whole;
        quantiles[i] = part > 0 ? (1 - part) * values[at] + part * values[next] : values[at];
    }
}

// Quantities of every run that a judgement takes.
enum {
    COMMAND,
    OVER,
    SMOOTHED,
    PEAK,
    CONTACT,
    SETTLING,
    ERROR,
    SEPARATIONS,
    APPROACH,
    BACK,
    QUANTITIES
};
static const char *const keys[QUANTITIES] = {
    [COMMAND] = "force_command_N",
    [OVER] = "force_over_command_N",
    [SMOOTHED] = "smoothed_over_command_N",
    [PEAK] = "peak_force_N",
    [CONTACT] = "first_contact_s",
    [SETTLING] = "settling_time_s",
    [ERROR] = "steady_error_N",
    [SEPARATIONS] = "separations",
    [APPROACH] = "approach_speed_m_s",
    [BACK] = "return_speed_m_s",
};

// Instant of the script's last push, 0 without one [s].
static double last_push(const scenario *s)
{
    double time = 0;
    for (int i = 0; i < s->action_count; i++) {
        time = s->actions[i].kind == ACTION_PUSH ? fmax(time, s->actions[i].time) : time;
    }
    return time;
}

// Judges the runs, whose quantities stand one behind the other; what is sorted is overwritten.
static void judge(robust_law *out, const sweep *s, double *values)
{
    const size_t n = s->run_count;
    double *of[QUANTITIES];
    size_t settled = 0, separated = 0, exceeded = 0;
    double pushed = last_push(s->base);
    for (int q = 0; q < QUANTITIES; q++) {
        of[q] = values + (size_t)q * n;
    }

    // each run
    for (size_t i = 0; i < n; i++) {
        scenario derived;
        bool known = sweep_scenario(s, i, &derived, NULL) == STATUS_OK;
        bool many = known && derived.parameters.arm.links > 2;
        double command = of[COMMAND][i];
        double allowed = known && derived.parameters.control.force_limit > 0
                             ? derived.parameters.control.force_limit
                             : ROBUST_EXCESS * command;

        settled += !isnan(of[SETTLING][i]);
        separated += of[SEPARATIONS][i] > 0;
        exceeded += (many ? of[SMOOTHED][i] + command : of[PEAK][i]) > allowed;
        of[OVER][i] *= 100 / command;
        of[SMOOTHED][i] *= 100 / command;
        out->overshoots[i] = of[many ? SMOOTHED : OVER][i];
        out->by_smoothed += many;
        of[ERROR][i] = 100 * fabs(of[ERROR][i]) / command;

        of[BACK][i] /= of[APPROACH][i];

        // a push begins anew
        double contact = of[CONTACT][i], at = contact + of[SETTLING][i];
        of[CONTACT][i] = pushed > 0 ? (double)NAN : at;
        of[SETTLING][i] = at > pushed ? at - fmax(contact, pushed) : isnan(at) ? at : 0;
    }

    // all of them
    out->settled = (double)settled / (double)n;
    out->separated = (double)separated / (double)n;
    out->exceeded = (double)exceeded / (double)n;
    find_quantiles(out->overshoots, n, out->overshoot);
    find_quantiles(of[OVER], n, out->raw);
    find_quantiles(of[SMOOTHED], n, out->smoothed);
    find_quantiles(of[SETTLING], n, out->settling);
    find_quantiles(of[CONTACT], n, out->from_start);
    find_quantiles(of[ERROR], n, out->error);
    find_quantiles(of[BACK], n, out->back);
}

status robust_law_of(robust_law *out, const char *law, const sweep *s, sweep_store *store, fault *f)
{
    assert(out != NULL && law != NULL && s != NULL && store != NULL && s->run_count > 0);
    *out = (robust_law){.law = law, .runs = s->run_count, .against = (double)NAN};

    // a column of the store for each quantity
    double *values = calloc(QUANTITIES * s->run_count, sizeof *values);
    out->overshoots = calloc(s->run_count, sizeof *out->overshoots);
    status code = values != NULL && out->overshoots != NULL ? STATUS_OK : fault_no_memory(f);
    for (int q = 0; q < QUANTITIES && code == STATUS_OK; q++) {
        code = store->quantity(store, keys[q], values + (size_t)q * s->run_count, &out->failed, f);
    }

    if (code == STATUS_OK) {
        judge(out, s, values);
    }
    free(values);
    return code;
}

const char *robust_overshoot_of(const robust_law *law)
{
    assert(law != NULL);
    return law->by_smoothed == 0           ? "peak"
           : law->by_smoothed == law->runs ? "smoothed"
                                           : "peak and smoothed";
}

void robust_law_finish(robust_law *law)
{
    if (law != NULL) {
        free(law->overshoots);
        law->overshoots = NULL;
    }
}
