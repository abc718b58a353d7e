// impactlab study methods: error against cost of the methods of time integration.
#include "ui/commands/study_topics.h"

#include <float.h>
#include <math.h>

#include "src/base/json.h"
#include "src/study/convergence.h"
#include "ui/commands/run_progress.h"

static json_t *methods_object(const scenario *s, const method_study *study)
{
    json_t *object = json_object(), *reference = json_object(), *points = json_array();
    json_put(object, "scenario", json_text(s->name));

    // what errors are measured against
    json_put(reference, "method", json_string("event"));
    json_put(reference, "step_s", json_number(study->reference_step));
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        json_put(reference, study_keys[k], json_number(study->reference[k]));
    }
    json_put(object, "reference", reference);

    for (int m = 0; m < STUDY_METHODS; m++) {
        for (int i = 0; i < STUDY_STEPS; i++) {
            const study_point *p = &study->points[m][i];
            json_t *line = json_object(), *errors = json_object();

            json_put(line, "method", json_string(study_methods[m]));
            json_put(line, "step_s", json_number(p->step));
            json_put(line, "computing_time_s", json_number(p->cost));

            for (int k = 0; k < STUDY_QUANTITIES; k++) {
                json_put(errors, study_keys[k], json_number(p->error[k]));
            }

            json_put(line, "errors", errors);
            json_add(points, line);
        }
    }

    json_put(object, "methods", points);
    return object;
}

// A number in a column of the given width, "-" where there is none.
static void print_cell(int width, double value)
{
    char text[32] = "-";
    if (!isnan(value)) {
        snprintf(text, sizeof text, "%.3g", value);
    }
    printf(" %*s", width, text);
}

static void print_methods(const scenario *s, const method_study *study)
{
    char changes[SCENARIO_CHANGES];
    say("%s%s: error against cost\nreference: event method at %g s; first contact %.12g s, first "
        "pulse peak %.12g N,\nsteady force %.12g N\n",
        s->name, scenario_changes(s, changes), study->reference_step, study->reference[0],
        study->reference[1], study->reference[2]);

    // a table for each method
    for (int m = 0; m < STUDY_METHODS; m++) {
        printf("\n%-18s %10s %12s %12s %12s\n", study_methods[m], "cost", "contact", "peak",
               "steady");
        printf("%-18s %10s %12s %12s %12s\n", "step [s]", "[ms]", "[s]", "[N]", "[N]");
        for (int i = 0; i < STUDY_STEPS; i++) {
            const study_point *p = &study->points[m][i];
            printf("%-18g", p->step);
            print_cell(10, 1e3 * p->cost);
            for (int k = 0; k < STUDY_QUANTITIES; k++) {
                print_cell(12, p->error[k]);
            }
            printf("\n");
        }
    }

    // and the question that decides between them
    printf("\nLeast cost for an error of the first pulse's peak of at most\n");
    for (double error = 1e-2; error > 0.9e-8; error /= 100) {
        printf("  %7.0e N:", error);
        for (int m = 0; m < STUDY_METHODS; m++) {
            double step = 0, cost = method_study_cost(study, m, 1, error, &step);
            if (isnan(cost)) {
                printf("   %s: none", study_methods[m]);
            } else {
                printf("   %s: %.3g ms at %g s", study_methods[m], 1e3 * cost, step);
            }
        }
        printf("\n");
    }
}

// Makes the errors fit for a logarithmic axis, which has no zero: what agrees to the last digit
// stands at half of one.
static void raise_zeros(method_study *study)
{
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        const double least = DBL_EPSILON / 2 * fabs(study->reference[k]);
        for (int m = 0; m < STUDY_METHODS; m++) {
            for (int i = 0; i < STUDY_STEPS; i++) {
                double *error = &study->points[m][i].error[k];
                *error = isnan(*error) ? *error : fmax(*error, least);
            }
        }
    }
}

static int plot_methods(const arguments *a, const scenario *s, const method_study *drawn)
{
    static const char *const labels[STUDY_METHODS] = {"Newmark", "generalised α", "event method"};
    static const marker_kind markers[STUDY_METHODS] = {MARKER_SQUARE, MARKER_TRIANGLE,
                                                       MARKER_CIRCLE};
    static const int colours[STUDY_METHODS] = {1, 2, 0};
    static const char *const names[STUDY_QUANTITIES] = {
        "Error of first contact", "Error of first pulse\u2019s peak", "Error of steady force"};
    static const char *const plain[STUDY_QUANTITIES] = {"first_contact", "first_pulse_peak",
                                                        "steady_force"};
    static const char *const units[STUDY_QUANTITIES] = {"s", "N", "N"};
    figure_series series[STUDY_QUANTITIES][STUDY_METHODS];
    figure_panel panels[STUDY_QUANTITIES];
    char title[256 + SCENARIO_CHANGES], changes[SCENARIO_CHANGES];

    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        for (int m = 0; m < STUDY_METHODS; m++) {
            series[k][m] = (figure_series){.name = study_methods[m],
                                           .label = labels[m],
                                           .x = &drawn->points[m][0].cost,
                                           .y = &drawn->points[m][0].error[k],
                                           .count = STUDY_STEPS,
                                           .stride = sizeof(study_point),
                                           .colour = colours[m],
                                           .marker = markers[m]};
        }

        panels[k] = (figure_panel){.y = {.name = plain[k],
                                         .label = names[k],
                                         .unit = units[k],
                                         .scale = SCALE_LOGARITHMIC},
                                   .series = series[k],
                                   .series_count = STUDY_METHODS,
                                   .weight = 1.8};
    }

    snprintf(title, sizeof title, "%s: error against cost%s", s->name,
             scenario_changes(s, changes));

    figure fig = {
        .title = title,
        .caption =
            "Steps 10\u2009ms, 5\u2009ms, 2\u2009ms ... 1\u2009µs from left to right; the event "
            "method needs none of them and costs about the same whichever is asked for. Left and "
            "low is better. Reference: the event method at 20\u2009µs. What agrees with it to the "
            "last digit stands at half of one.",
        .x = {.name = "computing time", .label = "Computing time", .unit = "s"},
        .panels = panels,
        .panel_count = STUDY_QUANTITIES};
    return publish_study(a, &fig);
}

int study_of_methods(const arguments *a, scenario *s)
{
    method_study study;
    fault f = {0};
    run_monitor *monitor = work_begin(a, "runs", STUDY_RUNS);
    status code = method_study_compute(s, monitor, &study, &f);
    work_end();

    // without the reference there is nothing to show
    const int done = monitor->pieces;
    if (code == STATUS_STOPPED && done == 0) {
        work_leave(0, STUDY_RUNS, "runs", "there is nothing to show");
    }
    if (code != STATUS_OK && code != STATUS_STOPPED) {
        return complain_fault(&f);
    }

    if (summary_wanted(a)) {
        print_methods(s, &study);
    }

    int result = a->json != NULL ? write_json(a->json, methods_object(s, &study)) : EXIT_DONE;
    if (code == STATUS_STOPPED) {
        work_leave(done, STUDY_RUNS, "runs", "the tables hold these");
    }
    if (result == EXIT_DONE && a->plot != NULL) {
        raise_zeros(&study);
        result = plot_methods(a, s, &study);
    }
    return result;
}
