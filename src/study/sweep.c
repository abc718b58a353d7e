#include "src/study/sweep.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/random.h"
#include "src/scenario/effect.h"

#define SOME_SHARE 0.37 // place in a range of a value that stands for all of them

static const char *const samplings[] = {"grid", "random", "latin"};

const char *sweep_sampling_name(sweep_sampling sampling)
{
    assert((unsigned)sampling <= SWEEP_LATIN);
    return samplings[sampling];
}

int sweep_sampling_find(const char *name)
{
    int i = SWEEP_LATIN;
    while (i >= 0 && strcmp(name, samplings[i]) != 0) {
        i--;
    }
    return i;
}

// --- what is varied --------------------------------------------------------------------

// Checks an axis whose values are drawn together with those of the axis before it: both
// are lists of one length.
static status check_together(const sweep *s, const sweep_axis *axis, fault *f)
{
    const sweep_axis *before = axis - 1;
    FAULT_IF(s->sampling == SWEEP_GRID || axis == s->axes, f, STATUS_BAD_ARGUMENT,
             "'with' goes with drawn values, behind those that they are drawn with");
    FAULT_IF(axis->is_range || before->is_range || axis->count != before->count, f,
             STATUS_BAD_ARGUMENT,
             "%s is drawn with %s, expected as many values: %zu, not %zu", axis->name,
             before->name, before->count, axis->count);
    return STATUS_OK;
}

// Reads one --vary into the next axis.
static status add_axis(sweep *s, const char *given, fault *f)
{
    static const char with[] = "with ";
    FAULT_IF(s->axis_count == SWEEP_MOST_AXES, f, STATUS_BAD_ARGUMENT,
             "at most %d parameters can be varied", SWEEP_MOST_AXES);
    const bool together = strncmp(given, with, strlen(with)) == 0;
    if (together) {
        given += strlen(with);
    }

    // the parameter before the equals sign, the values behind it
    sweep_axis *axis = &s->axes[s->axis_count];
    const char *values = strchr(given, '=');
    FAULT_IF(values == NULL, f, STATUS_BAD_ARGUMENT,
             "expected PATH=a:b:n or PATH=v1,v2,v3");
    s->axis_count++;
    TRY(sweep_axis_find(axis, given, f));
    for (const sweep_axis *other = s->axes; other < axis; other++) {
        FAULT_IF(strcmp(other->name, axis->name) == 0, f, STATUS_BAD_ARGUMENT,
                 "%s is varied twice", axis->name);
    }
    TRY(sweep_axis_parse(axis, values + 1, s->sampling != SWEEP_GRID, f));
    axis->together = together;
    if (together) {
        return check_together(s, axis, f);
    }
    return STATUS_OK;
}

// --- which values a run has ------------------------------------------------------------

// Sets the number of runs: as many as are asked for, or as the grid has points.
static status count_runs(sweep *s, size_t runs, fault *f)
{
    const bool grid = s->sampling == SWEEP_GRID;
    FAULT_IF(!grid && (runs < 1 || runs > SWEEP_MOST_RUNS), f, STATUS_BAD_ARGUMENT,
             "--sample %s needs --runs with a number from 1 to %zu",
             sweep_sampling_name(s->sampling), SWEEP_MOST_RUNS);

    // of a grid the product of its axes
    if (grid) {
        s->run_count = 1;
    } else {
        s->run_count = runs;
    }
    for (int i = 0; i < s->axis_count && grid; i++) {
        FAULT_IF(s->axes[i].count > SWEEP_MOST_RUNS / s->run_count, f,
                 STATUS_BAD_ARGUMENT, "the grid has more than %zu runs", SWEEP_MOST_RUNS);
        s->run_count *= s->axes[i].count;
    }
    if (grid && runs != 0) {
        return fault_set(f, STATUS_BAD_ARGUMENT,
                         "--runs goes with --sample random or latin; a grid is as "
                         "large as it is, here %zu",
                         s->run_count);
    }
    return STATUS_OK;
}

// Where in the range of an axis the value of a run is drawn, 0 <= share < 1: by the
// number of the run, so that no other run need be drawn. Of a Latin hypercube (McKay,
// Beckman and Conover 1979) each range falls into run_count parts of equal chance, which
// the runs take in random order, each at a random place.
static double drawn_share(const sweep *s, size_t run, int axis)
{
    // drawn together: at the share of the axis before
    while (s->axes[axis].together) {
        axis--;
    }

    const uint64_t of_shares = random_at(s->seed, 2 * (uint64_t)axis),
                   of_parts = random_at(s->seed, 2 * (uint64_t)axis + 1);
    const double share = random_share(random_at(of_shares, run));
    if (s->sampling == SWEEP_RANDOM) {
        return share;
    }

    // the sum may round up to the next part
    const double part = (double)random_place(of_parts, run, s->run_count);
    const double count = (double)s->run_count;
    return fmin((part + share) / count, nextafter((part + 1) / count, 0));
}

double sweep_value(const sweep *s, size_t run, int axis)
{
    assert(run < s->run_count && axis >= 0 && axis < s->axis_count);
    if (s->chosen != NULL) {
        return s->chosen[run * (size_t)s->axis_count + (size_t)axis];
    }
    if (s->sampling != SWEEP_GRID) {
        return sweep_axis_value_at(&s->axes[axis], drawn_share(s, run, axis));
    }

    // a grid's last axis changes fastest
    for (int i = s->axis_count - 1; i > axis; i--) {
        run /= s->axes[i].count;
    }
    return sweep_axis_value(&s->axes[axis], run % s->axes[axis].count);
}

void sweep_value_text(const sweep *s, size_t run, int axis, char *text, size_t size)
{
    assert(size > 0);
    sweep_axis_format(&s->axes[axis], sweep_value(s, run, axis), text, size);
}

status sweep_scenario(const sweep *s, size_t run, scenario *derived, fault *f)
{
    double values[SWEEP_MOST_AXES];
    for (int i = 0; i < s->axis_count; i++) {
        values[i] = sweep_value(s, run, i);
    }
    return sweep_axes_scenario(s->axes, s->axis_count, values, s->base, derived, f);
}

// That the values of a run do not go together, with the values.
static status combination_fault(const sweep *s, size_t run, const fault *why, fault *f)
{
    char values[512] = "";
    size_t length = 0;
    for (int i = 0; i < s->axis_count && length < sizeof values; i++) {
        char text[128];
        sweep_value_text(s, run, i, text, sizeof text);
        length += (size_t)snprintf(values + length, sizeof values - length, "%s%s = %s",
                                   i > 0 ? ", " : "", s->axes[i].name, text);
    }
    return fault_set_at(f, STATUS_BAD_ARGUMENT, why->path, "run %zu (%s): %.400s",
                        run + 1, values, why->text);
}

// Checks, before anything is computed, that the values of each run of a share go
// together: more links than two do not go with the printed model.
static status check_combinations(const sweep *s, sweep_share share, fault *f)
{
    // what a very large sweep has beyond these is told in the rows of the runs
    enum { CHECKED = 100000 };
    const size_t count = sweep_share_count(share, s->run_count);
    for (size_t i = 0; i < count && i < CHECKED; i++) {
        const size_t run = sweep_share_run(share, i);
        scenario derived;
        fault why = {.path = ""};
        if (sweep_scenario(s, run, &derived, &why) != STATUS_OK) {
            return combination_fault(s, run, &why, f);
        }
    }
    return STATUS_OK;
}

status sweep_plan(sweep *s, const sweep_request *request, fault *f)
{
    status code = STATUS_OK;
    memset(s, 0, sizeof *s);
    s->sampling = request->sampling;
    s->seed = request->seed;

    FAULT_IF(request->vary_count == 0, f, STATUS_BAD_ARGUMENT,
             "sweep needs at least one --vary PATH=a:b:n or --vary PATH=v1,v2,v3");

    // the axes
    for (int i = 0; i < request->vary_count && code == STATUS_OK; i++) {
        fault why = {.path = ""};
        code = add_axis(s, request->vary[i], &why);
        if (code != STATUS_OK) {
            if (code != STATUS_NO_MEMORY) {
                code = STATUS_BAD_ARGUMENT;
            }
            if (request->lines == NULL) {
                code = fault_set_at(f, code, why.path, "--vary %.200s: %.700s",
                                    request->vary[i], why.text);
            } else {
                code = fault_set_place(f, code, request->lines[i], 1, "%.200s:%d: %.700s",
                                       request->file, request->lines[i], why.text);
            }
        }
    }

    // the runs
    if (code == STATUS_OK) {
        code = count_runs(s, request->runs, f);
    }
    if (code != STATUS_OK) {
        sweep_finish(s);
    }
    return code;
}

status sweep_init(sweep *s, const scenario *base, const sweep_request *request, fault *f)
{
    TRY(sweep_plan(s, request, f));

    // whether each run can be begun
    s->base = base;
    const status code = check_combinations(s, request->share, f);
    if (code != STATUS_OK) {
        sweep_finish(s);
    }
    return code;
}

bool sweep_idle(const sweep *s, size_t run, const char *why[SWEEP_MOST_AXES])
{
    double values[SWEEP_MOST_AXES];
    scenario derived;
    for (int i = 0; i < s->axis_count; i++) {
        why[i] = NULL;
        values[i] = sweep_value(s, run, i);
        if (isnan(values[i])) {
            values[i] = sweep_axis_value_at(&s->axes[i], SOME_SHARE);
        }
    }
    if (sweep_axes_scenario(s->axes, s->axis_count, values, s->base, &derived, NULL) !=
        STATUS_OK) {
        return false;
    }

    bool some = false;
    for (int i = 0; i < s->axis_count; i++) {
        why[i] = effect_none_from(&derived, s->axes[i].parameter, -1);
        some = some || why[i] != NULL;
    }
    return some;
}

status sweep_check_effect(const sweep *s, int axis, fault *f)
{
    // steps of a large prime number reach every run once; of very many runs those that
    // are looked at are spread over all
    enum { LOOKED_AT = 10000 };
    const uint64_t step = 2654435761;
    const char *why[SWEEP_MOST_AXES];
    assert(s->run_count > 0);
    for (uint64_t i = 0; i < s->run_count && i < LOOKED_AT; i++) {
        sweep_idle(s, (size_t)(i * step % s->run_count), why);
        if (why[axis] == NULL) {
            return STATUS_OK;
        }
    }
    return fault_set_at(f, STATUS_BAD_ARGUMENT,
                        sweep_axis_parameter(&s->axes[axis])->path,
                        "%s has no effect in any run: %s", s->axes[axis].name, why[axis]);
}

void sweep_finish(sweep *s)
{
    for (int i = 0; i < s->axis_count; i++) {
        sweep_axis_finish(&s->axes[i]);
    }
    free(s->chosen);
    memset(s, 0, sizeof *s);
}
