// impactlab study sensor: what a force sensor would read of the contact.
#include "ui/commands/study_topics.h"

#include "src/base/json.h"
#include "src/study/sensor_view.h"
#include "ui/commands/run_progress.h"

#define PIECES "numbers of links"

static json_t *sensor_object(const scenario *s, const sensor_study *study)
{
    json_t *object = json_object(), *rows = json_array();
    json_put(object, "scenario", json_text(s->name));

    for (int i = 0; i < study->count; i++) {
        const sensor_view *view = &study->views[i];
        json_t *line = json_object(), *sensors = json_array();

        // what the contact gives, of the links and of the beam
        json_put(line, "links", json_integer(view->links));
        json_put(line, "approach_speed_m_s", json_number(view->speed));
        json_put(line, "contact_impulse_Ns", json_number(view->impulse));
        json_put(line, "peak_N", json_number(view->peak));
        json_put(line, "impacts", json_number(view->impacts));
        json_put(line, "momentum_2ms_Ns", json_number(view->momentum));
        json_put(line, "beam_momentum_2ms_Ns", json_number(study->beam_momentum[i]));

        // what sensors make of it
        for (int k = 0; k < SENSOR_CONSTANTS; k++) {
            json_t *sensor = json_object();
            json_put(sensor, "time_constant_s", json_number(sensor_constants[k]));
            json_put(sensor, "peak_N", json_number(view->sensed[k]));
            json_put(sensor, "time_to_peak_s", json_number(view->delay[k]));
            json_put(sensor, "beam_peak_N", json_number(study->beam_peak[k][i]));
            json_add(sensors, sensor);
        }

        json_put(line, "sensors", sensors);
        json_add(rows, line);
    }

    json_put(object, "sensor", rows);
    return object;
}

static void print_sensor(const scenario *s, const sensor_study *study)
{
    char changes[SCENARIO_CHANGES];
    say("%s%s: the first %g ms after first contact\n\n", s->name, scenario_changes(s, changes),
        1e3 * SENSOR_WINDOW);
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

    for (int i = 0; i < study->count; i++) {
        const sensor_view *view = &study->views[i];
        printf("%-6d  %-9.5f  %-8.4g  %-7g  %-9.5f ", view->links, view->impulse, view->peak,
               view->impacts, view->momentum);

        for (int k = 0; k < SENSOR_CONSTANTS; k++) {
            printf(" %9.4g", view->sensed[k]);
        }
        printf("\n");
    }

    // the beam's limit below the links, from the speed of the longest
    if (study->count < SENSOR_LENGTHS) {
        return;
    }
    printf("%-6s  %-9s  %-8s  %-7s  %-9.5f ", "beam", "0", "infinite", "",
           study->beam_momentum[SENSOR_LENGTHS - 1]);
    for (int k = 0; k < SENSOR_CONSTANTS; k++) {
        printf(" %9.4g", study->beam_peak[k][SENSOR_LENGTHS - 1]);
    }

    printf("\n\nbeam: a long Euler-Bernoulli beam whose tip is stopped from the same speed, %.4g "
           "m/s\n",
           study->views[SENSOR_LENGTHS - 1].speed);
}

static int plot_sensor(const arguments *a, const scenario *s, const sensor_study *study)
{
#define CURVE(what) .x = study->links, .y = (what), .count = SENSOR_LENGTHS

    // largest force: ideal, by sensors, and the beam's limits
    const figure_series force[] = {
        {.name = "ideal",
         .label = "ideal point contact",
         CURVE(study->peak),
         .colour = 5,
         .marker = MARKER_SQUARE},
        {.name = "sensor 0.5 ms",
         .label = "sensor of 0.5\u2009ms",
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
        {.y = {.name = "peak", .label = "Largest force", .unit = "N", .scale = SCALE_LOGARITHMIC},
         .series = force,
         .series_count = 7,
         .weight = 1.8},
        {.y = {.name = "momentum",
               .label = "First impulse, momentum of 2\u2009ms",
               .unit = "N s",
               .scale = SCALE_LOGARITHMIC},
         .series = momentum,
         .series_count = 3,
         .weight = 1.8},
    };

    char title[256 + SCENARIO_CHANGES], changes[SCENARIO_CHANGES];
    snprintf(title, sizeof title, "%s: what a force sensor would see%s", s->name,
             scenario_changes(s, changes));
    figure fig = {.title = title,
                  .caption =
                      "Squares: force and first impulse of the rigid point contact. Circles: "
                      "largest reading of a sensor, and all momentum of the first 2 ms.",
                  .x = {.name = "links", .label = "Number of links <i>N</i>"},
                  .panels = panels,
                  .panel_count = 2};
    return publish_study(a, &fig);
}

int study_of_sensor(const arguments *a, scenario *s)
{
    sensor_study study;
    fault f = {0};
    run_monitor *monitor = work_begin(a, PIECES, SENSOR_LENGTHS);
    status code = sensor_study_compute(s, monitor, &study, &f);
    work_end();
    if (code != STATUS_OK && code != STATUS_STOPPED) {
        return complain_fault(&f);
    }

    if (summary_wanted(a) && study.count > 0) {
        print_sensor(s, &study);
    }

    int result = a->json != NULL ? write_json(a->json, sensor_object(s, &study)) : EXIT_DONE;
    if (code == STATUS_STOPPED) {
        work_leave(study.count, SENSOR_LENGTHS, PIECES, "the table is that of these");
    }
    if (result == EXIT_DONE && a->plot != NULL) {
        result = plot_sensor(a, s, &study);
    }
    return result;
}
