// How well control laws follow a set-point and a wall that swing.
#include "ui/commands/studies/study_topics.h"

#include <stdio.h>

#include "src/base/json.h"
#include "src/study/follow.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

typedef struct follow_result {
    const scenario *scenario;
    follow_study study;
} follow_result;

// The numbers of a point that are printed and drawn.
typedef enum follow_number {
    WAVE_ERROR,
    PHASE,
    WALL_FORCE,
    FOLLOW_NUMBERS
} follow_number;

// A number of a point; a pointer to it, so that curves can go over all points.
static const double *number_of_point(const follow_point *p, follow_number number)
{
    switch (number) {
    case WAVE_ERROR:
        return &p->error;
    case PHASE:
        return &p->phase;
    default:
        return &p->shaken;
    }
}

// --- numbers ---------------------------------------------------------------------------

// The points of one law.
static json_t *frequencies_json(const follow_point *points)
{
    json_t *array = json_array();
    for (int i = 0; i < FOLLOW_FREQUENCIES; i++) {
        const follow_point *p = &points[i];
        json_add(array,
                 json_of("frequency_Hz:n gain:n phase_deg:n error:n wall_N_per_m:n",
                         follow_frequencies[i], p->gain, p->phase, p->error, p->shaken));
    }
    return array;
}

// The points of all laws.
static json_t *follow_json(const void *found)
{
    const follow_result *result = found;
    json_t *laws = json_object();
    for (int k = 0; k < FOLLOW_LAWS; k++) {
        json_put(laws, follow_laws[k], frequencies_json(result->study.points[k]));
    }
    return json_of("scenario:t follow:o later_s:n", result->scenario->name, laws,
                   result->study.later);
}

// A number of every point, over the frequencies.
static void print_number(const follow_study *study, follow_number number,
                         const char *title, double scale)
{
    printf("\n%-28s", title);
    for (int i = 0; i < FOLLOW_FREQUENCIES; i++) {
        printf(" %6g Hz", follow_frequencies[i]);
    }
    for (int k = 0; k < FOLLOW_LAWS; k++) {
        printf("\n%-28s", follow_laws[k]);
        for (int i = 0; i < FOLLOW_FREQUENCIES; i++) {
            print_cell(9, "%.3g", scale * *number_of_point(&study->points[k][i], number));
        }
    }
    printf("\n");
}

// A table for each number.
static void print_follow(const void *found)
{
    const follow_result *result = found;
    const follow_study *study = &result->study;
    char changes[SCENARIO_CHANGES];
    say("%s%s: a set-point and a wall that move\ncommands act %g ms late\n",
        result->scenario->name, scenario_changes(result->scenario, changes),
        1e3 * study->later);
    print_number(study, WAVE_ERROR, "error of the set-point [%]", 100);
    print_number(study, PHASE, "phase [deg]", 1);
    print_number(study, WALL_FORCE, "wall that moves [N/mm]", 1e-3);
}

// --- the picture -----------------------------------------------------------------------

static const struct {
    int colour;
    marker_kind marker;
} law_curves[FOLLOW_LAWS] = {{0, MARKER_CIRCLE},  {3, MARKER_SQUARE},
                             {2, MARKER_DIAMOND}, {1, MARKER_TRIANGLE},
                             {6, MARKER_CROSS},   {5, MARKER_CIRCLE}};

static const figure_axis number_axes[FOLLOW_NUMBERS] = {
    [WAVE_ERROR] = {.name = "error",
                    .label = "Error over the wave",
                    .scale = SCALE_LOGARITHMIC},
    [PHASE] = {.name = "phase", .label = "Phase of the force", .unit = "°"},
    [WALL_FORCE] = {.name = "wall",
                    .label = "Force over a wall’s motion",
                    .unit = "N/m",
                    .scale = SCALE_LOGARITHMIC},
};

// A panel for each number, in it a curve for each law.
static int plot_follow(const arguments *a, const void *found)
{
    const follow_result *result = found;
    const follow_study *study = &result->study;

    // the curves, by number and law
    figure_series series[FOLLOW_NUMBERS][FOLLOW_LAWS];
    figure_panel panels[FOLLOW_NUMBERS];
    for (int n = 0; n < FOLLOW_NUMBERS; n++) {
        for (int k = 0; k < FOLLOW_LAWS; k++) {
            const follow_point *first = study->points[k];
            series[n][k] = curve_of(follow_laws[k], follow_laws[k], &first->frequency,
                                    number_of_point(first, (follow_number)n),
                                    FOLLOW_FREQUENCIES, law_curves[k].colour);
            series[n][k].stride = sizeof *first;
            series[n][k].marker = law_curves[k].marker;
        }
        panels[n] = (figure_panel){.y = number_axes[n],
                                   .series = series[n],
                                   .series_count = FOLLOW_LAWS,
                                   .weight = 1.8};
    }

    // the caption says how far set-point and wall move
    const parameters *p = &result->scenario->parameters;
    char caption[400];
    snprintf(caption, sizeof caption,
             "Set-point: %g %% of the commanded force; wall: %g mm, against which "
             "friction holds the hub up to %.2g N. Commands act %.3g ms late.",
             100 * FOLLOW_WAVE, 1e3 * FOLLOW_WALL, p->motor.stiction / p->arm.length,
             1e3 * study->later);
    const figure fig = {.caption = caption,
                        .x = {.name = "frequency", .label = "Frequency", .unit = "Hz"},
                        .panels = panels,
                        .panel_count = FOLLOW_NUMBERS};
    return publish_study(a, result->scenario, "a set-point and a wall that move", &fig);
}

// --- the study -------------------------------------------------------------------------

// Makes the study and writes what is asked for. Returns the exit status.
static int study_following(const arguments *a, scenario *s)
{
    static const command_results results = {.json = follow_json,
                                            .text = print_follow,
                                            .plot = plot_follow,
                                            .draws_part = true,
                                            .kept = "the results are those of these",
                                            .none = "there is nothing to show"};
    follow_result found = {.scenario = s};
    fault f = {0};
    run_monitor *monitor = work_begin(a, "runs", FOLLOW_RUNS);
    const status code = follow_study_compute(s, monitor, &found.study, &f);
    return work_finish(a, code, &f, &results, &found);
}

const study_topic follow_topic = {"follow", "compare/observer", study_following};
