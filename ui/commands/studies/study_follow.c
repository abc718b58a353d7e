// impactlab study follow: force error and phase of control laws over frequency, beside what delay
// and arm allow.
#include <stdio.h>

#include "src/base/json.h"
#include "src/study/follow.h"
#include "ui/commands/pictures.h"
#include "ui/commands/progress.h"

static json_t *points_array(const follow_point *points)
{
    json_t *array = json_array();
    for (int i = 0; i < FOLLOW_FREQUENCIES; i++) {
        const follow_point *p = &points[i];
        json_add(array,
                 json_members(json_object(),
                              "frequency_Hz:n gain:n phase_deg:n error:n wall_N_per_m:n",
                              follow_frequencies[i], p->gain, p->phase, p->error, p->shaken));
    }
    return array;
}

static json_t *follow_object(const scenario *s, const void *found)
{
    const follow_study *study = found;
    json_t *laws = json_object();
    for (int k = 0; k < FOLLOW_LAWS; k++) {
        json_put(laws, follow_laws[k], points_array(study->points[k]));
    }
    return json_members(json_object(), "scenario:t follow:o bound:o later_s:n zero_per_s:n",
                        s->name, laws, points_array(study->bound), study->later, study->zero);
}

// A number of every point, over the frequencies.
static void print_table(const char *what, const follow_study *study, size_t offset, double scale)
{
    printf("\n%-28s", what);
    for (int i = 0; i < FOLLOW_FREQUENCIES; i++) {
        printf(" %6g Hz", follow_frequencies[i]);
    }
    for (int k = 0; k <= FOLLOW_LAWS; k++) {
        printf("\n%-28s", k < FOLLOW_LAWS ? follow_laws[k] : "bound");
        for (int i = 0; i < FOLLOW_FREQUENCIES; i++) {
            const follow_point *p = k < FOLLOW_LAWS ? &study->points[k][i] : &study->bound[i];
            print_cell(9, "%.3g", scale * *(const double *)((const char *)p + offset));
        }
    }
    printf("\n");
}

static void print_follow(const scenario *s, const void *found)
{
    const follow_study *study = found;
    char changes[SCENARIO_CHANGES];
    say("%s%s: a set-point and a wall that move\ncommands act %g ms late, the force's zero is at "
        "%.3g 1/s\n",
        s->name, scenario_changes(s, changes), 1e3 * study->later, study->zero);
    print_table("error of the set-point [%]", study, offsetof(follow_point, error), 100);
    print_table("phase [deg]", study, offsetof(follow_point, phase), 1);
    print_table("wall that moves [N/mm]", study, offsetof(follow_point, shaken), 1e-3);
}

static int plot_follow(const arguments *a, const scenario *s, const void *found)
{
    const follow_study *study = found;
    static const int colours[FOLLOW_LAWS] = {0, 3, 2, 1, 6, 5};
    static const marker_kind markers[FOLLOW_LAWS] = {MARKER_CIRCLE,   MARKER_SQUARE, MARKER_DIAMOND,
                                                     MARKER_TRIANGLE, MARKER_CROSS,  MARKER_CIRCLE};
    static const struct {
        figure_axis axis;
        size_t offset;
    } drawn[] = {
        {{.name = "error", .label = "Error over the wave", .scale = SCALE_LOGARITHMIC},
         offsetof(follow_point, error)},
        {{.name = "phase", .label = "Phase of the force", .unit = "°"},
         offsetof(follow_point, phase)},
        {{.name = "wall",
          .label = "Force over a wall’s motion",
          .unit = "N/m",
          .scale = SCALE_LOGARITHMIC},
         offsetof(follow_point, shaken)},
    };
    enum { PANELS = sizeof drawn / sizeof *drawn };
    figure_series series[PANELS][FOLLOW_LAWS + 1];
    figure_panel panels[PANELS];
    for (int n = 0; n < PANELS; n++) {
        for (int k = 0; k <= FOLLOW_LAWS; k++) {
            const bool law = k < FOLLOW_LAWS;
            const follow_point *p = law ? study->points[k] : study->bound;
            series[n][k] = (figure_series){.name = law ? follow_laws[k] : "bound",
                                           .label = law ? follow_laws[k] : "knowing nothing ahead",
                                           .x = &p->frequency,
                                           .y = (const double *)((const char *)p + drawn[n].offset),
                                           .count = FOLLOW_FREQUENCIES,
                                           .stride = sizeof(follow_point),
                                           .colour = law ? colours[k] : 7,
                                           .marker = law ? markers[k] : MARKER_NONE,
                                           .secondary = !law};
        }
        panels[n] = (figure_panel){.y = drawn[n].axis,
                                   .series = series[n],
                                   .series_count = FOLLOW_LAWS + 1,
                                   .weight = 1.8};
    }

    char caption[400];
    snprintf(
        caption, sizeof caption,
        "Set-point: %g %% of the commanded force; wall: %g mm, against which friction holds the "
        "hub up to %.2g N. Dashed: the best of a law that takes both to stay; commands act "
        "%.3g ms late, and a force turned up falls first, by the zero at %.3g 1/s. Laws that "
        "go on with a rate are better while it lasts.",
        100 * FOLLOW_WAVE, 1e3 * FOLLOW_WALL,
        s->parameters.motor.stiction / s->parameters.arm.length, 1e3 * study->later, study->zero);
    const figure fig = {.caption = caption,
                        .x = {.name = "frequency", .label = "Frequency", .unit = "Hz"},
                        .panels = panels,
                        .panel_count = PANELS};
    return publish_study(a, s, "a set-point and a wall that move", &fig);
}

int study_of_follow(const arguments *a, scenario *s)
{
    static const command_results r = {follow_object, print_follow, plot_follow,
                                      .kept = "the tables hold these"};
    follow_study study;
    fault f = {0};
    run_monitor *monitor = work_begin(a, "runs", FOLLOW_RUNS);
    const status code = follow_study_compute(s, monitor, &study, &f);
    return work_finish(a, code, &f, &r, s, &study);
}
