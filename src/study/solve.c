#include "src/study/solve.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/study/batch.h"
#include "src/study/sweep.h"
#include "src/tables/settings.h"

// --- the condition ---------------------------------------------------------------------

// Copies the part of a text between two places, without the blanks at its ends.
static void copy_trimmed(const char *start, const char *end, char *copy, size_t size)
{
    while (start < end && is_blank(*start)) {
        start++;
    }
    while (end > start && is_blank(end[-1])) {
        end--;
    }
    snprintf(copy, size, "%.*s", (int)(end - start), start);
}

status solve_condition_read(const char *text, solve_condition *c, fault *f)
{
    const char *sign = strpbrk(text, "<>"), *rest;
    char key[128];
    FAULT_IF(sign == NULL, f, STATUS_BAD_ARGUMENT,
             "'%.100s' is no condition, expected KEY<VALUE or KEY>VALUE, such as "
             "'peak_force_N<2'",
             text);

    // the quantity
    copy_trimmed(text, sign, key, sizeof key);
    *c = (solve_condition){.quantity = summary_find_begun(key), .below = *sign == '<'};
    if (c->quantity < 0) {
        const char *near = summary_suggest(key);
        FAULT_IF(near != NULL, f, STATUS_BAD_ARGUMENT,
                 "there is no quantity '%s', did you mean '%s'?", key, near);
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "there is no quantity '%s'; expected a key of run --json", key);
    }
    FAULT_IF(
        summary_table[c->quantity].timing, f, STATUS_BAD_ARGUMENT,
        "%s depends on the machine, not on the scenario: no parameter has a limit for it",
        key);

    // and its bound
    c->equal = sign[1] == '=';
    char bound[128];
    copy_trimmed(sign + 1 + c->equal, text + strlen(text), bound, sizeof bound);
    const char *unit = summary_table[c->quantity].unit;
    FAULT_IF(!decimal_read(bound, &c->bound, &rest) || *rest != '\0', f,
             STATUS_BAD_ARGUMENT, "'%.100s' is no bound of %s, expected a number%s%s",
             sign + 1 + c->equal, key, unit[0] != '\0' ? " in " : "", unit);
    return STATUS_OK;
}

bool solve_condition_holds(const solve_condition *c, double value)
{
    assert(!isnan(value));
    if (c->equal && value == c->bound) {
        return true;
    }
    if (c->below) {
        return value < c->bound;
    }
    return value > c->bound;
}

status solve_usual_range(sweep_axis *axis, const scenario *s, fault *f)
{
    double value = sweep_axis_get(axis, &s->parameters);
    FAULT_IF(sweep_axis_parameter(axis) == &setting_info || axis->element > 0 ||
                 !parameter_usual_range(axis->parameter, value, &axis->low, &axis->high,
                                        &axis->logarithmic),
             f, STATUS_BAD_ARGUMENT, "%s needs a range, %s=a:b", axis->name, axis->name);
    axis->is_range = true;
    return STATUS_OK;
}

status solve_axis_read(sweep_axis *axis, const char *text, const scenario *s, fault *f)
{
    const char *range = strchr(text, '=');
    TRY(sweep_axis_find(axis, text, f));
    if (range != NULL) {
        TRY(sweep_axis_parse_range(axis, range + 1, f));
    } else {
        TRY(solve_usual_range(axis, s, f));
    }

    // a study of one run with any value of the range
    double any = (double)NAN;
    const sweep study = {s, {*axis}, 1, SWEEP_RANDOM, .run_count = 1, .chosen = &any};
    return sweep_check_effect(&study, 0, f);
}

// --- one run ---------------------------------------------------------------------------

// What one value of the parameter gives.
typedef struct trial {
    double value;
    double quantity; // NaN: missing, or unknown
    bool known;      // the run came to its end and is to be relied on
    bool done;       // it was run
} trial;

typedef struct search {
    const scenario *base;
    const sweep_axis *axis;
    const solve_condition *condition;
    run_monitor *monitor;
    solution *found;
    trial *trials;        // of the range
    size_t first_unknown; // of them
} search;

// What a run with the value came to.
static trial trial_of(const search *s, double value, const summary *m)
{
    const bool known = m->status == STATUS_OK && !m->inaccurate;
    const double quantity =
        known ? summary_value(m, s->condition->quantity) : (double)NAN;
    return (trial){value, quantity, known, true};
}

// The status of a run that ends the search, STATUS_STOPPED or STATUS_NO_MEMORY; STATUS_OK
// of all others, which only leave a value unknown.
static status ending(status code, fault *f)
{
    if (code == STATUS_STOPPED || code == STATUS_NO_MEMORY) {
        return fault_set(f, code, "%s", status_text(code));
    }
    return STATUS_OK;
}

// Runs the scenario with one value of the parameter. A value that does not go with the
// scenario's others counts as a run that fails. STATUS_STOPPED or STATUS_NO_MEMORY.
static status run_trial(const search *s, double value, trial *t, fault *f)
{
    scenario derived;
    *t = (trial){.value = value, .quantity = (double)NAN};
    status code = sweep_axes_scenario(s->axis, 1, &value, s->base, &derived, NULL);
    if (code == STATUS_OK) {
        SCOPED(run_finish) run_result result;
        const run_options options = {.monitor = s->monitor};
        code = run_scenario_with(&derived, &options, &result);
        *t = trial_of(s, value, &result.summary);
    }
    return ending(code, f);
}

static bool holds(const search *s, const trial *t)
{
    return !isnan(t->quantity) && solve_condition_holds(s->condition, t->quantity);
}

// --- the range -------------------------------------------------------------------------

static bool is_whole(const search *s)
{
    return sweep_axis_parameter(s->axis)->type == PARAMETER_INTEGER &&
           s->axis->element == 0;
}

// Value i of the points in the range, from its low to its high end, both included. Those
// of a parameter of whole numbers are rounded.
static double point_value(const search *s, size_t i)
{
    const size_t points = (size_t)s->found->points;
    sweep_axis rising = *s->axis;
    rising.low = fmin(s->axis->low, s->axis->high);
    rising.high = fmax(s->axis->low, s->axis->high);
    const double value = sweep_axis_point(&rising, i, points);
    if (is_whole(s) && i > 0 && i + 1 < points) {
        return round(value);
    }
    return value;
}

static status make_point(void *context, size_t i, scenario *made, fault *f)
{
    const search *s = context;
    const double value = point_value(s, i);
    return sweep_axes_scenario(s->axis, 1, &value, s->base, made, f);
}

// Counts the result at point i of the range, and keeps why the first unknown one is
// unknown.
static status take_point(void *context, size_t i, const summary *m, fault *f)
{
    search *s = context;
    solution *found = s->found;
    TRY(ending(m->status, f));
    const trial t = s->trials[i] = trial_of(s, point_value(s, i), m);
    if (!t.known) {
        if (found->unknown == 0 || i < s->first_unknown) {
            s->first_unknown = i;
            snprintf(found->reason, sizeof found->reason, "%.500s", m->message);
        }
        found->unknown++;
    } else if (isnan(t.quantity)) {
        found->missing++;
    } else if (holds(s, &t)) {
        found->holding++;
    } else {
        found->failing++;
    }
    found->done++;
    run_monitor_count(s->monitor);
    return STATUS_OK;
}

// --- between two values ----------------------------------------------------------------

// Whether two values are so near that no value between them is worth trying.
static bool neighbours(const search *s, double a, double b)
{
    const double width = fabs(s->axis->high - s->axis->low);
    const double least = is_whole(s) ? 1 : 1e-13 * width;
    return fabs(a - b) <= least || nextafter(a, b) == b;
}

// The next value to try between `in`, where the condition holds, and `out`: by the
// secant, kept a thousandth of the interval off its ends so that both come near the
// limit, or in the middle.
static double next_value(const search *s, const trial *in, const trial *out, bool secant)
{
    const double width = out->value - in->value;
    double share = 0.5;
    if (secant && !isnan(out->quantity)) {
        share = (s->condition->bound - in->quantity) / (out->quantity - in->quantity);
        share = fmin(fmax(share, 1e-3), 1 - 1e-3);
    }

    // the nearest whole number, at least 1 from either end
    const double value = in->value + share * width;
    if (is_whole(s)) {
        const double distance = round(fabs(value - in->value));
        return in->value + copysign(fmin(fmax(distance, 1), fabs(width) - 1), width);
    }
    return value;
}

// Locates the limit between a trial at which the condition holds, `in`, and one at which
// it does not, `out`: both move together. After a secant step that did not halve the
// interval the next step does.
static status locate(const search *s, trial *in, trial *out, fault *f)
{
    // a jump is halved down to a part in 1e13, forty times; the secant takes fewer
    enum { MOST_RUNS = 200 };
    bool secant = true;
    for (int i = 0; i < MOST_RUNS && !neighbours(s, in->value, out->value); i++) {
        trial t;
        const double width = fabs(in->value - out->value);
        TRY(run_trial(s, next_value(s, in, out, secant), &t, f));
        if (holds(s, &t)) {
            *in = t;
        } else {
            *out = t;
        }
        secant = fabs(in->value - out->value) <= width / 2 || !secant;
    }
    return STATUS_OK;
}

// Locates a limit between any two neighbouring points of the range of which one holds.
static status locate_limits(search *s, fault *f)
{
    solution *found = s->found;
    for (int i = 0; i + 1 < found->points; i++) {
        trial a = s->trials[i], b = s->trials[i + 1];
        const bool holds_below = holds(s, &a);
        if (!a.done || !b.done || holds_below == holds(s, &b)) {
            continue;
        }
        trial *in = &b, *out = &a;
        if (holds_below) {
            in = &a;
            out = &b;
        }
        if (!found->stopped) {
            const status code = locate(s, in, out, f);
            if (code == STATUS_NO_MEMORY) {
                return code;
            }
            found->stopped = code == STATUS_STOPPED;
        }

        // a place beyond which the quantity is missing is no limit of its value
        if (isnan(out->quantity)) {
            continue;
        }
        found->more = found->count == SOLVE_MOST_LIMITS;
        if (!found->more) {
            // a jump of the quantity: the values at both sides differ
            const double size = fmax(fabs(s->condition->bound), fabs(in->quantity));
            const bool jumps =
                is_whole(s) || fabs(in->quantity - out->quantity) > 1e-6 * size;
            found->limits[found->count++] =
                (solve_limit){in->value, in->quantity, holds_below, jumps, out->value};
        }
    }
    if (found->stopped) {
        return STATUS_STOPPED;
    }
    return STATUS_OK;
}

status solve(const scenario *s, const sweep_axis *axis, const solve_condition *condition,
             int points, int jobs, run_monitor *monitor, solution *found, fault *f)
{
    assert(axis->is_range);
    assert(points >= 2 && points <= SOLVE_MOST_POINTS);
    search here = {.base = s,
                   .axis = axis,
                   .condition = condition,
                   .monitor = monitor,
                   .found = found};

    // no whole number twice
    *found = (solution){.points = points};
    if (is_whole(&here)) {
        found->points = (int)fmin(points, fabs(axis->high - axis->low) + 1);
    }
    SCOPED(free_kept) trial *trials = calloc((size_t)found->points, sizeof *trials);
    if (trials == NULL) {
        return fault_no_memory(f);
    }
    here.trials = trials;

    // one by one: none waits for others when it is stopped
    const batch range = {.context = &here,
                         .count = (size_t)found->points,
                         .make = make_point,
                         .take = take_point,
                         .together = 1,
                         .abandon = monitor != NULL ? &monitor->stop : NULL};
    const status code = batch_run(&range, jobs, f);
    if (code != STATUS_OK && code != STATUS_STOPPED) {
        return code;
    }
    found->stopped = code == STATUS_STOPPED;
    return locate_limits(&here, f);
}
