#include "ui/commands/command.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/plot/figure_file.h"
#include "src/study/convergence.h"
#include "src/study/sensor_view.h"
#include "src/base/json.h"
#include "src/base/version.h"

// A page of panels side by side over one logarithmic axis, with the data beside it.
static status write_figure(figure *fig, const scenario *s, const char *what, const char *path,
                           fault *f)
{
    char software[64], command_line[256];
    snprintf(software, sizeof software, "impactlab %s", lab_version());
    snprintf(command_line, sizeof command_line, "impactlab study %s %s --plot", what, s->name);
    fig->x.scale = SCALE_LOGARITHMIC;
    fig->x.room = 0.04;
    fig->columns = fig->panel_count;
    fig->common_legend = true;
    fig->height = 88;
    fig->software = software;
    fig->parameters = command_line;
    return figure_write_with_csv(fig, path, f);
}

// --- methods --------------------------------------------------------------------------------

static json_t *methods_object(const scenario *s, const method_study *study)
{
    json_t *object = json_object(), *reference = json_object(), *points = json_array();
    json_object_set_new(object, "scenario", json_text(s->name));
    json_object_set_new(reference, "method", json_string("event"));
    json_object_set_new(reference, "step_s", json_number(study->reference_step));
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        json_object_set_new(reference, study_keys[k], json_number(study->reference[k]));
    }
    json_object_set_new(object, "reference", reference);
    for (int m = 0; m < STUDY_METHODS; m++) {
        for (int i = 0; i < STUDY_STEPS; i++) {
            const study_point *point = &study->points[m][i];
            json_t *line = json_object(), *errors = json_object();
            json_object_set_new(line, "method", json_string(study_methods[m]));
            json_object_set_new(line, "step_s", json_number(point->step));
            json_object_set_new(line, "computing_time_s", json_number(point->cost));
            for (int k = 0; k < STUDY_QUANTITIES; k++) {
                json_object_set_new(errors, study_keys[k], json_number(point->error[k]));
            }
            json_object_set_new(line, "errors", errors);
            json_array_append_new(points, line);
        }
    }
    json_object_set_new(object, "methods", points);
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
    printf("%s: error against cost\nreference: event method at %g s; first contact %.12g s, first "
           "pulse peak %.12g N,\nsteady force %.12g N\n",
           s->name, study->reference_step, study->reference[0], study->reference[1],
           study->reference[2]);
    for (int m = 0; m < STUDY_METHODS; m++) {
        printf("\n%-18s %10s %12s %12s %12s\n", study_methods[m], "cost", "contact", "peak",
               "steady");
        printf("%-18s %10s %12s %12s %12s\n", "step [s]", "[ms]", "[s]", "[N]", "[N]");
        for (int i = 0; i < STUDY_STEPS; i++) {
            const study_point *point = &study->points[m][i];
            printf("%-18g", point->step);
            print_cell(10, 1e3 * point->cost);
            for (int k = 0; k < STUDY_QUANTITIES; k++) {
                print_cell(12, point->error[k]);
            }
            printf("\n");
        }
    }
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

static status plot_methods(const scenario *s, const method_study *study, const char *path, fault *f)
{
    static const char *const labels[STUDY_METHODS] = {"Newmark", "generalised-alpha",
                                                      "event method"};
    static const marker_kind markers[STUDY_METHODS] = {MARKER_SQUARE, MARKER_TRIANGLE,
                                                       MARKER_CIRCLE};
    static const int colours[STUDY_METHODS] = {1, 2, 0};
    static const char *const names[STUDY_QUANTITIES] = {
        "error of first contact", "error of first pulse\u2019s peak", "error of steady force"};
    static const char *const plain[STUDY_QUANTITIES] = {"first_contact", "first_pulse_peak",
                                                        "steady_force"};
    static const char *const units[STUDY_QUANTITIES] = {"s", "N", "N"};
    figure_series series[STUDY_QUANTITIES][STUDY_METHODS];
    figure_panel panels[STUDY_QUANTITIES];
    char title[256];
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        for (int m = 0; m < STUDY_METHODS; m++) {
            series[k][m] = (figure_series){.name = study_methods[m],
                                           .label = labels[m],
                                           .x = &study->points[m][0].cost,
                                           .y = &study->points[m][0].error[k],
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
                                   .series_count = STUDY_METHODS};
    }
    snprintf(title, sizeof title, "%s: error against cost", s->name);
    figure fig = {.title = title,
                  .caption =
                      "Steps 10 ms, 5 ms, 2 ms ... 1 µs from left to right (the event "
                      "method strides over several where it can). Left and low is better. "
                      "What lies below 10<sup>−13</sup> is rounding; the gap is the reference.",
                  .x = {.name = "computing time", .label = "computing time", .unit = "s"},
                  .panels = panels,
                  .panel_count = STUDY_QUANTITIES};
    return write_figure(&fig, s, "methods", path, f);
}

static int study_of_methods(const arguments *a, scenario *s)
{
    method_study study;
    fault f = {0};
    if (method_study_compute(s, &study, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    if (summary_wanted(a)) {
        print_methods(s, &study);
    }
    int result = a->json != NULL ? write_json(a->json, methods_object(s, &study)) : EXIT_DONE;
    if (result == EXIT_DONE && a->plot != NULL &&
        plot_methods(s, &study, a->plot, &f) != STATUS_OK) {
        result = complain_fault(&f);
    }
    return result;
}

// --- sensor ---------------------------------------------------------------------------------

static const int lengths[] = {2, 3, 5, 8, 12, 16, 24, 32};
enum { LENGTHS = sizeof lengths / sizeof lengths[0] };

// What is computed, and what theory says of a beam that touches with the same speed.
typedef struct sensor_study {
    sensor_view views[LENGTHS];
    double links[LENGTHS], impulse[LENGTHS], peak[LENGTHS], momentum[LENGTHS]; // columns of views
    double sensed[SENSOR_CONSTANTS][LENGTHS];
    double beam_momentum[LENGTHS];
    double beam_peak[SENSOR_CONSTANTS][LENGTHS];
} sensor_study;

static status compute_sensor(const scenario *s, sensor_study *study, fault *f)
{
    for (int i = 0; i < LENGTHS; i++) {
        sensor_view *view = &study->views[i];
        status code = sensor_view_compute(s, lengths[i], view, f);
        if (code != STATUS_OK) {
            return code;
        }
        study->links[i] = lengths[i];
        study->impulse[i] = view->impulse;
        study->peak[i] = view->peak;
        study->momentum[i] = view->momentum;
        study->beam_momentum[i] =
            sensor_beam_momentum(&s->parameters, view->speed, MOMENTUM_WINDOW);
        for (int k = 0; k < SENSOR_CONSTANTS; k++) {
            study->sensed[k][i] = view->sensed[k];
            study->beam_peak[k][i] =
                sensor_beam_peak(&s->parameters, view->speed, sensor_constants[k]);
        }
    }
    return STATUS_OK;
}

static json_t *sensor_object(const scenario *s, const sensor_study *study)
{
    json_t *object = json_object(), *rows = json_array();
    json_object_set_new(object, "scenario", json_text(s->name));
    for (int i = 0; i < LENGTHS; i++) {
        const sensor_view *view = &study->views[i];
        json_t *line = json_object(), *sensors = json_array();
        json_object_set_new(line, "links", json_integer(view->links));
        json_object_set_new(line, "approach_speed_m_s", json_number(view->speed));
        json_object_set_new(line, "contact_impulse_Ns", json_number(view->impulse));
        json_object_set_new(line, "peak_N", json_number(view->peak));
        json_object_set_new(line, "impacts", json_number(view->impacts));
        json_object_set_new(line, "momentum_2ms_Ns", json_number(view->momentum));
        json_object_set_new(line, "beam_momentum_2ms_Ns", json_number(study->beam_momentum[i]));
        for (int k = 0; k < SENSOR_CONSTANTS; k++) {
            json_t *sensor = json_object();
            json_object_set_new(sensor, "time_constant_s", json_number(sensor_constants[k]));
            json_object_set_new(sensor, "peak_N", json_number(view->sensed[k]));
            json_object_set_new(sensor, "time_to_peak_s", json_number(view->delay[k]));
            json_object_set_new(sensor, "beam_peak_N", json_number(study->beam_peak[k][i]));
            json_array_append_new(sensors, sensor);
        }
        json_object_set_new(line, "sensors", sensors);
        json_array_append_new(rows, line);
    }
    json_object_set_new(object, "sensor", rows);
    return object;
}

static void print_sensor(const scenario *s, const sensor_study *study)
{
    printf("%s: the first %g ms after first contact\n\n", s->name, 1e3 * SENSOR_WINDOW);
    printf(
        "        ideal point contact           momentum   peak of a sensor with time constant\n");
    printf("links   impulse    peak      impacts  in %g ms  ", 1e3 * MOMENTUM_WINDOW);
    for (int k = 0; k < SENSOR_CONSTANTS; k++) {
        printf("%7g ms", 1e3 * sensor_constants[k]);
    }
    printf("\n        [N s]      [N]                [N s]     ");
    for (int k = 0; k < SENSOR_CONSTANTS; k++) {
        printf("%10s", "[N]");
    }
    printf("\n");
    for (int i = 0; i < LENGTHS; i++) {
        const sensor_view *view = &study->views[i];
        printf("%-6d  %-9.5f  %-8.4g  %-7g  %-9.5f ", view->links, view->impulse, view->peak,
               view->impacts, view->momentum);
        for (int k = 0; k < SENSOR_CONSTANTS; k++) {
            printf(" %9.4g", view->sensed[k]);
        }
        printf("\n");
    }
    printf("%-6s  %-9s  %-8s  %-7s  %-9.5f ", "beam", "0", "infinite", "",
           study->beam_momentum[LENGTHS - 1]);
    for (int k = 0; k < SENSOR_CONSTANTS; k++) {
        printf(" %9.4g", study->beam_peak[k][LENGTHS - 1]);
    }
    printf("\n\nbeam: a long Euler-Bernoulli beam whose tip is stopped from the same speed, %.4g "
           "m/s\n",
           study->views[LENGTHS - 1].speed);
}

static status plot_sensor(const scenario *s, const sensor_study *study, const char *path, fault *f)
{
#define CURVE(what) .x = study->links, .y = (what), .count = LENGTHS
    const figure_series force[] = {
        {.name = "ideal",
         .label = "ideal point contact",
         CURVE(study->peak),
         .colour = 5,
         .marker = MARKER_SQUARE},
        {.name = "sensor 0.5 ms",
         .label = "sensor of 0.5 ms",
         CURVE(study->sensed[0]),
         .colour = 3,
         .marker = MARKER_CIRCLE},
        {.name = "sensor 1 ms",
         .label = "1 ms",
         CURVE(study->sensed[1]),
         .colour = 0,
         .marker = MARKER_CIRCLE},
        {.name = "sensor 2 ms",
         .label = "2 ms",
         CURVE(study->sensed[2]),
         .colour = 2,
         .marker = MARKER_CIRCLE},
        {.name = "beam 0.5 ms",
         .label = "a beam\u2019s limit",
         CURVE(study->beam_peak[0]),
         .colour = 7,
         .secondary = true},
        {.name = "beam 1 ms", CURVE(study->beam_peak[1]), .colour = 7, .secondary = true},
        {.name = "beam 2 ms", CURVE(study->beam_peak[2]), .colour = 7, .secondary = true},
    };
    const figure_series momentum[] = {
        {.name = "first impact", CURVE(study->impulse), .colour = 5, .marker = MARKER_SQUARE},
        {.name = "2 ms", CURVE(study->momentum), .colour = 0, .marker = MARKER_CIRCLE},
        {.name = "beam 2 ms", CURVE(study->beam_momentum), .colour = 7, .secondary = true},
    };
#undef CURVE
    const figure_panel panels[] = {
        {.y = {.name = "peak", .label = "largest force", .unit = "N", .scale = SCALE_LOGARITHMIC},
         .series = force,
         .series_count = 7},
        {.y = {.name = "momentum",
               .label = "first impulse, and momentum of 2 ms",
               .unit = "N s",
               .scale = SCALE_LOGARITHMIC},
         .series = momentum,
         .series_count = 3},
    };
    char title[256];
    snprintf(title, sizeof title, "%s: what a force sensor would see", s->name);
    figure fig = {.title = title,
                  .caption =
                      "Squares: force and first impulse of the rigid point contact. Circles: "
                      "largest reading of a sensor, and all momentum of the first 2 ms.",
                  .x = {.name = "links", .label = "links"},
                  .panels = panels,
                  .panel_count = 2};
    return write_figure(&fig, s, "sensor", path, f);
}

static int study_of_sensor(const arguments *a, scenario *s)
{
    sensor_study study;
    fault f = {0};
    if (compute_sensor(s, &study, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    if (summary_wanted(a)) {
        print_sensor(s, &study);
    }
    int result = a->json != NULL ? write_json(a->json, sensor_object(s, &study)) : EXIT_DONE;
    if (result == EXIT_DONE && a->plot != NULL &&
        plot_sensor(s, &study, a->plot, &f) != STATUS_OK) {
        result = complain_fault(&f);
    }
    return result;
}

// --- the command ----------------------------------------------------------------------------

typedef struct topic {
    const char *name, *scenario; // the scenario if none is given
    int (*study)(const arguments *a, scenario *s);
} topic;

static const topic topics[] = {
    {"methods", "corrected/first-impact", study_of_methods},
    {"sensor", "corrected/plane-wall-fast", study_of_sensor},
};
enum { TOPICS = sizeof topics / sizeof topics[0] };

static const topic *find_topic(const char *name)
{
    for (int i = 0; i < TOPICS; i++) {
        if (strcmp(topics[i].name, name) == 0) {
            return &topics[i];
        }
    }
    return NULL;
}

static const char *topic_word(int i)
{
    return i < TOPICS ? topics[i].name : NULL;
}

static int study(const arguments *a)
{
    const topic *t = find_topic(a->operands[0]);
    if (t == NULL) {
        return complain("there is no study '%s', expected methods or sensor", a->operands[0]);
    }
    return with_scenario(a->operand_count > 1 ? a->operands[1] : t->scenario, a, t->study);
}

static const option_row rows[] = {
    {.name = "plot",
     .type = OPTION_PICTURE,
     .value = "FILE.{png,pdf,svg}",
     .help = "draw the study; a CSV of what is drawn beside it",
     PLACE(plot)},
};
static const option_table options = OPTION_TABLE("Options", rows);

const command study_command = {
    .name = "study",
    .group = GROUP_MANY_RUNS,
    .operands = "methods|sensor [SCENARIO]",
    .summary = "Error against cost of the methods; what a force sensor would see",
    .help = "methods: the scenario (corrected/first-impact) by every method of time integration at "
            "steps from 1e-2\ndown to 1e-6 s, with the error of first contact, first pulse's peak "
            "and steady force.\nsensor: the scenario (corrected/plane-wall-fast) with 2 to 32 "
            "links; the force itself has no limit,\nwhat a first-order sensor of 0.5, 1 or 2 ms "
            "reads has one. See docs/methods.md and\ndocs/what-a-sensor-sees.md.\n",
    .least = 1,
    .most = 2,
    .takes_scenarios = true,
    .operand_word = topic_word,
    .options = {&set_options, &json_options, &options, &quiet_options},
    .run = study,
};
