// How the methods of time integration trade error for cost.
#include "ui/commands/studies/study_topics.h"

#include <math.h>
#include <stdio.h>

#include "src/base/json.h"
#include "src/study/convergence.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

typedef struct methods_result {
    const scenario *scenario;
    method_study study;
} methods_result;

// --- numbers ---------------------------------------------------------------------------

// What errors are measured against.
static json_t *reference_json(const method_study *study)
{
    json_t *reference = json_of("method:t step_s:n", "event", study->reference_step);
    json_t *resolved = json_object();
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        json_put(reference, study_keys[k], json_number(study->reference[k]));
        json_put(resolved, study_keys[k], json_number(study->resolved[k]));
    }
    json_put(reference, "resolved", resolved);
    return reference;
}

static json_t *study_point_json(const char *method, const study_point *p)
{
    json_t *errors = json_object();
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        json_put(errors, study_keys[k], json_number(p->error[k]));
    }
    return json_of("method:t step_s:n computing_time_s:n errors:o", method, p->step,
                   p->cost, errors);
}

// All points with their errors, and the reference.
static json_t *methods_json(const void *found)
{
    const methods_result *result = found;
    const method_study *study = &result->study;
    json_t *points = json_array();
    for (int m = 0; m < STUDY_METHODS; m++) {
        for (int i = 0; i < STUDY_STEPS; i++) {
            json_add(points, study_point_json(study_methods[m], &study->points[m][i]));
        }
    }
    return json_of("scenario:t reference:o methods:o", result->scenario->name,
                   reference_json(study), points);
}

// The table of one method: cost and errors by step.
static void print_method(const method_study *study, int method)
{
    printf("\n%-18s %10s %12s %12s %12s\n", study_methods[method], "cost", "contact",
           "peak", "steady");
    printf("%-18s %10s %12s %12s %12s\n", "step [s]", "[ms]", "[s]", "[N]", "[N]");
    for (int i = 0; i < STUDY_STEPS; i++) {
        const study_point *p = &study->points[method][i];
        printf("%-18g", p->step);
        print_cell(10, "%.3g", 1e3 * p->cost);
        for (int k = 0; k < STUDY_QUANTITIES; k++) {
            if (p->error[k] < study->resolved[k]) {
                printf(" %12s", "not resolved");
            } else {
                print_cell(12, "%.3g", p->error[k]);
            }
        }
        printf("\n");
    }
}

// The question that decides between the methods: what an error of the first pulse's peak
// costs.
static void print_least_costs(const method_study *study)
{
    enum { PEAK = 1 }; // among the quantities

    // from 1e-2 N down to 1e-8 N
    printf("\nLeast cost for an error of the first pulse's peak of at most\n");
    for (double error = 1e-2; error > 0.9e-8; error /= 100) {
        printf("  %7.0e N:", error);
        for (int m = 0; m < STUDY_METHODS; m++) {
            double step = 0;
            const double cost = method_study_cost(study, m, PEAK, error, &step);
            if (isnan(cost)) {
                printf("   %s: none", study_methods[m]);
            } else {
                printf("   %s: %.3g ms at %g s", study_methods[m], 1e3 * cost, step);
            }
        }
        printf("\n");
    }
}

// Below what no other method confirms the reference.
static void print_resolved(const method_study *study)
{
    static const char *const units[STUDY_QUANTITIES] = {"s", "N", "N"};
    say("\nNot resolved is what no other method confirms:");
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        if (isfinite(study->resolved[k])) {
            say(" %s below %.0e %s;", study_keys[k], study->resolved[k], units[k]);
        }
    }
    say("\n");
}

// The reference, the tables of all methods, and what follows from them.
static void print_methods(const void *found)
{
    const methods_result *result = found;
    const method_study *study = &result->study;
    char changes[SCENARIO_CHANGES];
    say("%s%s: error against cost\nreference: event method at %g s; first "
        "contact %.12g s, first pulse peak %.12g N,\nsteady force %.12g N\n",
        result->scenario->name, scenario_changes(result->scenario, changes),
        study->reference_step, study->reference[0], study->reference[1],
        study->reference[2]);
    for (int m = 0; m < STUDY_METHODS; m++) {
        print_method(study, m);
    }
    print_resolved(study);
    print_least_costs(study);
}

// --- the picture -----------------------------------------------------------------------

// What no other method confirms stands at the least error that is resolved.
static void raise_unresolved(method_study *study)
{
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        for (int m = 0; m < STUDY_METHODS; m++) {
            for (int i = 0; i < STUDY_STEPS; i++) {
                double *error = &study->points[m][i].error[k];
                if (!isnan(*error)) {
                    *error = fmax(*error, study->resolved[k]);
                }
            }
        }
    }
}

static const struct {
    const char *label;
    marker_kind marker;
    int colour;
} drawn_methods[STUDY_METHODS] = {{"Newmark", MARKER_SQUARE, 1},
                                  {"generalised α", MARKER_TRIANGLE, 2},
                                  {"event method", MARKER_CIRCLE, 0}};

#define LIMIT_ROOM 0.12 // of an axis of errors, for the label below the limit

static const figure_axis error_axes[STUDY_QUANTITIES] = {
    {.name = "first_contact",
     .label = "Error of first contact",
     .unit = "s",
     .scale = SCALE_LOGARITHMIC,
     .room = LIMIT_ROOM},
    {.name = "first_pulse_peak",
     .label = "Error of first pulse\u2019s peak",
     .unit = "N",
     .scale = SCALE_LOGARITHMIC,
     .room = LIMIT_ROOM},
    {.name = "steady_force",
     .label = "Error of steady force",
     .unit = "N",
     .scale = SCALE_LOGARITHMIC,
     .room = LIMIT_ROOM}};

// A panel for each quantity, in it a curve for each method.
static int plot_methods(const arguments *a, const void *found)
{
    const methods_result *result = found;
    method_study drawn = result->study;
    raise_unresolved(&drawn);

    // the curves, by quantity and method
    figure_series series[STUDY_QUANTITIES][STUDY_METHODS];
    figure_panel panels[STUDY_QUANTITIES];
    figure_level limits[STUDY_QUANTITIES];
    char labels[STUDY_QUANTITIES][80];
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        g_autofree char *least = text_number(drawn.resolved[k], 1);
        snprintf(labels[k], sizeof labels[k], "not resolved below %s", least);
        limits[k] = (figure_level){drawn.resolved[k], labels[k]};
        for (int m = 0; m < STUDY_METHODS; m++) {
            const study_point *first = drawn.points[m];
            series[k][m] =
                curve_of(study_methods[m], drawn_methods[m].label, &first->cost,
                         &first->error[k], STUDY_STEPS, drawn_methods[m].colour);
            series[k][m].stride = sizeof *first;
            series[k][m].marker = drawn_methods[m].marker;
        }
        panels[k] = (figure_panel){.y = error_axes[k],
                                   .series = series[k],
                                   .series_count = STUDY_METHODS,
                                   .levels = &limits[k],
                                   .level_count = isfinite(drawn.resolved[k]),
                                   .weight = 1.8};
    }

    // the panels side by side
    const figure fig = {
        .caption = "Steps 10\u2009ms, 5\u2009ms, 2\u2009ms ... 1\u2009µs from left to "
                   "right; the event method needs none of them and costs about the same "
                   "whichever is asked for. Left and low is better. Reference: the "
                   "event method at 20\u2009µs, which no other method confirms below the "
                   "dashed line.",
        .x = {.name = "computing time", .label = "Computing time", .unit = "s"},
        .panels = panels,
        .panel_count = STUDY_QUANTITIES};
    return publish_study(a, result->scenario, "error against cost", &fig);
}

// --- the study -------------------------------------------------------------------------

// Makes the study and writes what is asked for. Returns the exit status.
static int study_methods_of_integration(const arguments *a, scenario *s)
{
    // where no run was done there is no reference either
    static const command_results results = {.json = methods_json,
                                            .text = print_methods,
                                            .plot = plot_methods,
                                            .draws_part = true,
                                            .kept = "the results are those of these",
                                            .none = "there is nothing to show"};
    methods_result found = {.scenario = s};
    fault f = {0};
    run_monitor *monitor = work_begin(a, "runs", STUDY_RUNS);
    const status code = method_study_compute(s, monitor, &found.study, &f);
    return work_finish(a, code, &f, &results, &found);
}

const study_topic methods_topic = {"methods", "corrected/first-impact",
                                   study_methods_of_integration};
