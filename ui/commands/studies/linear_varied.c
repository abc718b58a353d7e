// impactlab linear --vary: where the loop is stable.
#include <math.h>
#include <stdlib.h>

#include "src/base/csv.h"
#include "src/base/json.h"
#include "ui/commands/studies/linear_pictures.h"

enum { MOST_LIMITS = 32 };

// Where stability changes along the one parameter that is varied.
typedef struct limit {
    double value;
    bool by_runs;
} limit;

typedef struct survey {
    const char *place;
    linear_place at;
    sweep sweep;
    double *growth, *settling; // of each point, in one block
    limit limits[MOST_LIMITS];
    int limit_count;
} survey;

static status compute(survey *v, fault *f)
{
    const sweep *s = &v->sweep;
    status code = STATUS_OK;
    for (size_t i = 0; i < s->run_count && code == STATUS_OK; i++) {
        scenario derived;
        code = sweep_scenario(s, i, &derived, f);
        code = code == STATUS_OK ? linear_growth(&derived, v->at, &v->growth[i], f) : code;
        code = code == STATUS_OK ? linear_settling(&derived, &v->settling[i], f) : code;
    }

    // between neighbours of which one is stable
    for (size_t i = 0; s->axis_count == 1 && i + 1 < s->run_count && code == STATUS_OK; i++) {
        for (int by_runs = 0; by_runs < 2 && v->limit_count < MOST_LIMITS; by_runs++) {
            const bool changes = by_runs ? isfinite(v->settling[i]) != isfinite(v->settling[i + 1])
                                         : (v->growth[i] < 0) != (v->growth[i + 1] < 0);
            limit *found = &v->limits[v->limit_count];
            if (changes && code == STATUS_OK) {
                code = linear_limit(s, v->at, by_runs, s->axes[0].values[i],
                                    s->axes[0].values[i + 1], &found->value, f);
                found->by_runs = by_runs;
                v->limit_count++;
            }
        }
    }
    return code;
}

static json_t *as_json(const survey *v)
{
    const sweep *s = &v->sweep;
    json_t *object = json_object(), *points = json_array(), *limits = json_array();
    json_put(object, "scenario", json_text(s->base->name));
    json_put(object, "at", json_string(v->place));
    for (size_t i = 0; i < s->run_count; i++) {
        json_t *entry = json_object(), *values = json_object();
        for (int axis = 0; axis < s->axis_count; axis++) {
            json_put(values, s->axes[axis].name, json_number(sweep_value(s, i, axis)));
        }
        json_put(entry, "values", values);
        json_put(entry, "growth_per_s", json_number(v->growth[i]));
        json_put(entry, "stable", json_boolean(v->growth[i] < 0));
        json_put(entry, "settling_time_s", json_number(v->settling[i]));
        json_add(points, entry);
    }
    for (int i = 0; i < v->limit_count; i++) {
        json_t *line = json_object();
        json_put(line, "path", json_text(s->axes[0].name));
        json_put(line, "value", json_number(v->limits[i].value));
        json_put(line, "of", json_string(v->limits[i].by_runs ? "runs" : "poles"));
        json_add(limits, line);
    }
    json_put(object, "varied", points);
    json_put(object, "limits", limits);
    return object;
}

static void write_rows(FILE *stream, const void *what)
{
    const survey *v = what;
    const sweep *s = &v->sweep;
    csv_writer w = csv_begin(stream);
    for (int axis = 0; axis < s->axis_count; axis++) {
        csv_heading(&w, s->axes[axis].name, sweep_axis_parameter(&s->axes[axis])->unit);
    }
    csv_heading(&w, "growth", "1/s");
    csv_heading(&w, "settling_time", "s");
    csv_end_row(&w);
    for (size_t i = 0; i < s->run_count; i++) {
        for (int axis = 0; axis < s->axis_count; axis++) {
            csv_number(&w, sweep_value(s, i, axis));
        }
        csv_number(&w, v->growth[i]);
        csv_number(&w, v->settling[i]);
        csv_end_row(&w);
    }
}

static void print_survey(const survey *v)
{
    const sweep *s = &v->sweep;
    size_t stable = 0, settle = 0;
    for (size_t i = 0; i < s->run_count; i++) {
        stable += v->growth[i] < 0;
        settle += isfinite(v->settling[i]);
    }
    say_title(s->base);
    printf("%zu of %zu loops are stable without friction, %zu of the runs settle\n", stable,
           s->run_count, settle);
    for (int i = 0; i < v->limit_count; i++) {
        say("  limit %s = %.6g %s, %s\n", s->axes[0].name, v->limits[i].value,
            sweep_axis_parameter(&s->axes[0])->unit,
            v->limits[i].by_runs ? "of runs, with friction" : "of poles, without friction");
    }
}

static int compute_and_report(const arguments *a, survey *v)
{
    fault f = {.code = STATUS_OK};
    v->growth = calloc(2 * v->sweep.run_count, sizeof *v->growth);
    v->settling = v->growth + v->sweep.run_count;
    const status code = v->growth != NULL ? compute(v, &f) : fault_no_memory(&f);
    int result = code == STATUS_OK ? EXIT_DONE : complain_fault(&f);
    if (code == STATUS_OK && a->json != NULL) {
        result = worse(result, write_json(a->json, as_json(v)));
    }
    if (code == STATUS_OK) {
        result = worse(result, write_file(a->csv, write_rows, v));
    }
    if (code == STATUS_OK && a->plot != NULL) {
        result = worse(result, plot_stability(a, &v->sweep, v->growth, v->settling));
    }
    if (code == STATUS_OK && summary_wanted(a)) {
        print_survey(v);
    }
    free(v->growth);
    return result;
}

int survey_stability(const arguments *a, const scenario *s, linear_place place, const char *name)
{
    const sweep_request request = {.vary = a->varies.items, .vary_count = a->varies.count};
    survey v = {.place = name, .at = place};
    fault f = {.code = STATUS_OK};
    if (a->mat != NULL || a->nyquist != NULL || a->injects) {
        return complain("--mat, --nyquist and --inject are of one loop, not of --vary");
    }
    if (a->plot != NULL && a->varies.count > 2) {
        return complain("--plot shows one or two varied parameters, but %d are varied",
                        a->varies.count);
    }
    if (s->parameters.control.law == LAW_NONE) {
        return complain("--vary needs a control law, such as --set control.law=hybrid");
    }
    if (sweep_init(&v.sweep, s, &request, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    const int result = compute_and_report(a, &v);
    sweep_finish(&v.sweep);
    return result;
}
