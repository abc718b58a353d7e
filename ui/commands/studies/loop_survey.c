#include "ui/commands/studies/loop_survey.h"

#include <stdio.h>

#include "src/base/csv.h"
#include "src/base/json.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

typedef struct stability_survey {
    const scenario *scenario;
    const char *place_name;
    linear_survey found;
} stability_survey;

// The number of each combination that judges it: by poles, and by a run.
enum { BY_POLES, BY_RUNS, JUDGEMENTS };

static const summary_info judgements[JUDGEMENTS] = {
    [BY_POLES] = {.key = "growth_per_s",
                  .name = "growth",
                  .label = "growth without friction",
                  .unit = "1/s"},
    [BY_RUNS] = {.key = "settling_time_s",
                 .name = "settling_time",
                 .label = "settling time",
                 .unit = "s"},
};

// --- files -----------------------------------------------------------------------------

// A combination by its number, with its judgements.
static json_t *combination_json(const linear_survey *y, size_t i)
{
    json_t *values = json_object();
    for (int axis = 0; axis < y->sweep.axis_count; axis++) {
        json_put(values, y->sweep.axes[axis].name,
                 json_number(sweep_value(&y->sweep, i, axis)));
    }
    const double growth = y->numbers[BY_POLES][i];
    return json_of("values:o growth_per_s:n stable:b settling_time_s:n", values, growth,
                   linear_is_stable(false, growth), y->numbers[BY_RUNS][i]);
}

// All combinations with their judgements, and where stability changes.
static json_t *survey_json(const void *found)
{
    const stability_survey *survey = found;
    const linear_survey *y = &survey->found;
    json_t *combinations = json_array(), *limits = json_array();
    for (size_t i = 0; i < y->done; i++) {
        json_add(combinations, combination_json(y, i));
    }
    for (int i = 0; i < y->limit_count; i++) {
        const char *judged_by = y->limits[i].by_runs ? "runs" : "poles";
        json_add(limits, json_of("path:t value:n of:t", y->sweep.axes[0].name,
                                 y->limits[i].value, judged_by));
    }
    return json_of("scenario:t at:t varied:o limits:o", survey->scenario->name,
                   survey->place_name, combinations, limits);
}

// A row for each combination, with its judgements.
static void write_survey_csv(FILE *stream, const void *found)
{
    const linear_survey *y = &((const stability_survey *)found)->found;
    const sweep *s = &y->sweep;

    // headings
    csv_writer w = csv_begin(stream);
    for (int axis = 0; axis < s->axis_count; axis++) {
        csv_heading(&w, s->axes[axis].name, sweep_axis_parameter(&s->axes[axis])->unit);
    }
    for (int k = 0; k < JUDGEMENTS; k++) {
        csv_heading(&w, judgements[k].name, judgements[k].unit);
    }
    csv_end_row(&w);

    // a row for each combination
    for (size_t i = 0; i < y->done; i++) {
        for (int axis = 0; axis < s->axis_count; axis++) {
            csv_number(&w, sweep_value(s, i, axis));
        }
        for (int k = 0; k < JUDGEMENTS; k++) {
            csv_number(&w, y->numbers[k][i]);
        }
        csv_end_row(&w);
    }
}

// --- text and picture ------------------------------------------------------------------

// How many combinations are stable by one of the judgements.
static size_t count_stable(const linear_survey *y, int judgement)
{
    size_t count = 0;
    for (size_t i = 0; i < y->done; i++) {
        if (linear_is_stable(judgement == BY_RUNS, y->numbers[judgement][i])) {
            count++;
        }
    }
    return count;
}

// How many loops are stable, and up to where.
static void print_survey(const void *found)
{
    const stability_survey *survey = found;
    const linear_survey *y = &survey->found;
    say_title(survey->scenario);
    printf("%zu of %zu loops are stable without friction, %zu of the runs settle\n",
           count_stable(y, BY_POLES), y->done, count_stable(y, BY_RUNS));

    // where stability changes
    for (int i = 0; i < y->limit_count; i++) {
        const sweep_axis *axis = &y->sweep.axes[0];
        const char *judged_by = "poles, without friction";
        if (y->limits[i].by_runs) {
            judged_by = "runs, with friction";
        }
        say("  limit %s = %.6g %s, of %s\n", axis->name, y->limits[i].value,
            sweep_axis_parameter(axis)->unit, judged_by);
    }
}

// Growth and settling time, one picture above the other.
static int plot_survey(const arguments *a, const void *found)
{
    const stability_survey *survey = found;
    const linear_survey *y = &survey->found;
    static const figure_level limit = {0};
    owned_figure *drawn[JUDGEMENTS];
    for (int k = 0; k < JUDGEMENTS; k++) {
        const sweep_picture shown = {&y->sweep, judgements[k].key, &judgements[k],
                                     y->numbers[k]};
        drawn[k] = drawing()->sweep_figure_create(&shown);
    }

    // both as panels of the first one, in which the limit is all that counts
    owned_figure *both = drawn[BY_POLES];
    both->panels[1] = drawn[BY_RUNS]->panels[0];
    both->panels[0].heading = "without friction: unstable above 0";
    figure_map with_limit;
    if (both->panels[0].map != NULL) {
        with_limit = *both->panels[0].map;
        with_limit.contours = false;
        with_limit.zero = true;
        both->panels[0].map = &with_limit;
        both->panels[0].heading = "linear, no friction: unstable beyond the thick line";
    } else if (y->sweep.axis_count == 1) {
        both->panels[0].y.with_zero = true;
        both->panels[0].levels = &limit;
        both->panels[0].level_count = 1;
    }
    both->panels[1].heading = "with friction: of runs that settle";
    both->figure.panel_count = JUDGEMENTS;

    const int result =
        publish_titled(a, survey->scenario, "stability of the loop", &both->figure);
    for (int k = 0; k < JUDGEMENTS; k++) {
        drawing()->owned_figure_destroy(drawn[k]);
    }
    return result;
}

// --- the command -----------------------------------------------------------------------

int survey_and_report(const arguments *a, const scenario *s, linear_place place,
                      const char *place_name)
{
    static const command_results results = {.json = survey_json,
                                            .text = print_survey,
                                            .plot = plot_survey,
                                            .csv = write_survey_csv,
                                            .draws_part = true,
                                            .kept = "the results are those of these",
                                            .none = "there is nothing to show"};
    if (a->plot != NULL && a->varies.count > 2) {
        return complain("--plot shows one or two varied parameters, but %d are varied",
                        a->varies.count);
    }

    stability_survey survey = {.scenario = s, .place_name = place_name};
    const sweep_request request = {.vary = a->varies.items,
                                   .vary_count = a->varies.count};
    fault f = {0};
    if (linear_survey_begin(&survey.found, s, &request, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // each combination in its turn
    run_monitor *monitor =
        work_begin(a, "combinations", (int)survey.found.sweep.run_count);
    const status code = linear_survey_make(&survey.found, place, monitor, &f);
    const int result = work_finish(a, code, &f, &results, &survey);
    linear_survey_finish(&survey.found);
    return result;
}
