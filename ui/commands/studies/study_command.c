// impactlab study: error against cost of the methods of time integration, how far a
// number of links is from a beam, and force error and phase of control laws over
// frequency.
#include "ui/commands/command.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "src/base/json.h"
#include "src/study/convergence.h"
#include "src/study/links.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"
#include "src/study/follow.h"

// --- methods ---------------------------------------------------------------------------

static json_t *methods_object(const scenario *s, const void *found)
{
    const method_study *study = found;
    json_t *points = json_array();

    // what errors are measured against
    json_t *reference = json_of("method:t step_s:n", "event", study->reference_step);
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        json_put(reference, study_keys[k], json_number(study->reference[k]));
    }

    for (int m = 0; m < STUDY_METHODS; m++) {
        for (int i = 0; i < STUDY_STEPS; i++) {
            const study_point *p = &study->points[m][i];
            json_t *errors = json_object();
            for (int k = 0; k < STUDY_QUANTITIES; k++) {
                json_put(errors, study_keys[k], json_number(p->error[k]));
            }
            json_add(points, json_of("method:t step_s:n computing_time_s:n errors:o",
                                     study_methods[m], p->step, p->cost, errors));
        }
    }
    return json_of("scenario:t reference:o methods:o", s->name, reference, points);
}

static void print_methods(const scenario *s, const void *found)
{
    const method_study *study = found;
    char changes[SCENARIO_CHANGES];
    say("%s%s: error against cost\nreference: event method at %g s; first "
        "contact %.12g s, first pulse peak %.12g N,\nsteady force %.12g N\n",
        s->name, scenario_changes(s, changes), study->reference_step, study->reference[0],
        study->reference[1], study->reference[2]);

    // a table for each method
    for (int m = 0; m < STUDY_METHODS; m++) {
        printf("\n%-18s %10s %12s %12s %12s\n", study_methods[m], "cost", "contact",
               "peak", "steady");
        printf("%-18s %10s %12s %12s %12s\n", "step [s]", "[ms]", "[s]", "[N]", "[N]");
        for (int i = 0; i < STUDY_STEPS; i++) {
            const study_point *p = &study->points[m][i];
            printf("%-18g", p->step);
            print_cell(10, "%.3g", 1e3 * p->cost);
            for (int k = 0; k < STUDY_QUANTITIES; k++) {
                print_cell(12, "%.3g", p->error[k]);
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

// Makes the errors fit for a logarithmic axis, which has no zero: what agrees to the last
// digit stands at half of one.
static void raise_zeros(method_study *study)
{
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        const double least = DBL_EPSILON / 2 * fabs(study->reference[k]);
        for (int m = 0; m < STUDY_METHODS; m++) {
            for (int i = 0; i < STUDY_STEPS; i++) {
                double *error = &study->points[m][i].error[k];
                if (!isnan(*error)) {
                    *error = fmax(*error, least);
                }
            }
        }
    }
}

static int plot_methods(const arguments *a, const scenario *s, const void *found)
{
    static const struct {
        const char *label;
        marker_kind marker;
        int colour;
    } methods[STUDY_METHODS] = {{"Newmark", MARKER_SQUARE, 1},
                                {"generalised α", MARKER_TRIANGLE, 2},
                                {"event method", MARKER_CIRCLE, 0}};
    static const figure_axis axes[STUDY_QUANTITIES] = {
        {.name = "first_contact", .label = "Error of first contact", .unit = "s"},
        {.name = "first_pulse_peak",
         .label = "Error of first pulse\u2019s peak",
         .unit = "N"},
        {.name = "steady_force", .label = "Error of steady force", .unit = "N"}};
    figure_series series[STUDY_QUANTITIES][STUDY_METHODS];
    figure_panel panels[STUDY_QUANTITIES];
    method_study drawn = *(const method_study *)found;

    raise_zeros(&drawn);
    for (int k = 0; k < STUDY_QUANTITIES; k++) {
        for (int m = 0; m < STUDY_METHODS; m++) {
            const study_point *first = drawn.points[m];
            series[k][m] = curve_of(study_methods[m], methods[m].label, &first->cost,
                                    &first->error[k], STUDY_STEPS, methods[m].colour);
            series[k][m].stride = sizeof *first;
            series[k][m].marker = methods[m].marker;
        }

        panels[k] = (figure_panel){.y = axes[k],
                                   .series = series[k],
                                   .series_count = STUDY_METHODS,
                                   .weight = 1.8};
        panels[k].y.scale = SCALE_LOGARITHMIC;
    }

    const figure fig = {
        .caption = "Steps 10\u2009ms, 5\u2009ms, 2\u2009ms ... 1\u2009µs from left to "
                   "right; the event method needs none of them and costs about the same "
                   "whichever is asked for. Left and low is better. Reference: the "
                   "event method at 20\u2009µs. What agrees with it to the last digit "
                   "stands at half of one.",
        .x = {.name = "computing time", .label = "Computing time", .unit = "s"},
        .panels = panels,
        .panel_count = STUDY_QUANTITIES};
    return publish_study(a, s, "error against cost", &fig);
}

static status compute_methods(const scenario *s, run_monitor *monitor, void *found,
                              fault *f)
{
    return method_study_compute(s, monitor, found, f);
}

// --- links -----------------------------------------------------------------------------

static json_t *links_object(const scenario *s, const void *found)
{
    const links_study *study = found;
    json_t *rows = json_array(), *quantities = json_array();
    for (int i = 0; i < study->count; i++) {
        json_t *line = json_of("links:i", links_numbers[i]);
        for (int k = 0; k < LINKS_QUANTITIES; k++) {
            json_put(line, study->rows[k].key, json_number(study->rows[k].value[i]));
        }
        json_add(rows, line);
    }

    // what they tend to
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        const links_row *row = &study->rows[k];
        json_add(
            quantities,
            json_of(
                "quantity:t order:n limit:n error:n beam:n aim:n off:n enough_links:o",
                row->key, row->order, row->limit, row->error, row->beam, row->aim,
                row->off, row->enough > 0 ? json_integer(row->enough) : json_null()));
    }
    return json_of("scenario:t links:o limits:o", s->name, rows, quantities);
}

// What a quantity comes to with more and more links, in words.
static void print_tendency(const links_row *row)
{
    const double *last = &row->value[LINKS_LENGTHS - 3];
    const double ratio = last[2] / last[1], before = last[1] / last[0];
    printf("%s: ", row->label);
    if (!(fabs(last[2]) > 0)) {
        printf("does not occur with 64 links\n");
    } else if (row->enough > 0) {
        printf("%s%.4g %s, within %.2g %% from %d links on\n",
               isnan(row->beam) ? "" : "the beam's ", row->aim, row->unit, 100 * row->off,
               row->enough);
    } else if (fmin(ratio, before) > LINKS_GROWS) {
        printf("grows, %.3g times with twice the links: it has no limit\n", ratio);
    } else if (fmax(ratio, before) < 1 / LINKS_GROWS) {
        printf("falls, %.3g times with twice the links: its limit is zero\n", ratio);
    } else {
        printf("still changes by %.2g %% from 32 to 64 links\n", 100 * fabs(ratio - 1));
    }
}

static void print_links(const scenario *s, const void *found)
{
    const links_study *study = found;
    if (study->count == 0) {
        return;
    }
    char changes[SCENARIO_CHANGES];
    say("%s%s: from links to a beam\n\n%-26s", s->name, scenario_changes(s, changes),
        "links");
    for (int i = 0; i < study->count; i++) {
        printf(" %9d", links_numbers[i]);
    }
    printf(" %10s %9s %9s %6s\n", "limit", "+-", "beam", "order");

    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        const links_row *row = &study->rows[k];
        char name[64];
        snprintf(name, sizeof name, "%s [%s]", row->label, row->unit);
        printf("%-26s", name);
        for (int i = 0; i < study->count; i++) {
            print_cell(9, "%.4g", row->value[i]);
        }
        print_cell(10, "%.5g", row->limit);
        print_cell(9, "%.1g", row->error);
        print_cell(9, "%.5g", row->beam);
        print_cell(6, "%.2f", row->order);
        printf("\n");
    }
    if (study->count < LINKS_LENGTHS) {
        return;
    }

    // the answer in words
    printf("\n");
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        print_tendency(&study->rows[k]);
    }
}

// What each quantity lacks of the beam's, or of its limit, over the number of links.
static int plot_links(const arguments *a, const scenario *s, const void *found)
{
    const links_study *study = found;
    static const int colours[LINKS_QUANTITIES] = {4, 4, 0, 3, 3, 3, 5, 2, 1, 6, 7};
    static const marker_kind markers[LINKS_QUANTITIES] = {
        MARKER_CIRCLE,   MARKER_SQUARE,  MARKER_CIRCLE,   MARKER_TRIANGLE,
        MARKER_SQUARE,   MARKER_DIAMOND, MARKER_TRIANGLE, MARKER_DIAMOND,
        MARKER_TRIANGLE, MARKER_SQUARE,  MARKER_CIRCLE};
    static const figure_tick ticks[LINKS_LENGTHS] = {{2, "2"},   {4, "4"},   {8, "8"},
                                                     {16, "16"}, {32, "32"}, {64, "64"}};
    double off[LINKS_QUANTITIES][LINKS_LENGTHS];
    figure_series series[LINKS_QUANTITIES];
    int drawn = 0;
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        const links_row *row = &study->rows[k];
        const double aim = isnan(row->beam) ? row->limit : row->beam;
        if (isnan(aim)) {
            continue;
        }
        for (int i = 0; i < LINKS_LENGTHS; i++) {
            const double share = 100 * fabs(row->value[i] / aim - 1);
            if (share > 0) {
                off[k][i] = share;
            } else {
                off[k][i] = (double)NAN;
            }
        }
        series[drawn] = curve_of(row->key, row->label, study->links, off[k],
                                 LINKS_LENGTHS, colours[k]);
        series[drawn++].marker = markers[k];
    }

    const figure_panel panel = {.y = {.name = "off",
                                      .label = "Off the beam",
                                      .unit = "%",
                                      .scale = SCALE_LOGARITHMIC},
                                .series = series,
                                .series_count = drawn,
                                .weight = 1.8};
    const figure fig = {
        .caption = "From the Euler-Bernoulli beam where it has a closed form, else "
                   "from Richardson\u2019s limit; what has neither is left out.",
        .x = {.name = "links",
              .label = "Number of links <i>N</i>",
              .ticks = ticks,
              .tick_count = LINKS_LENGTHS},
        .panels = &panel,
        .panel_count = 1};
    return publish_study(a, s, "from links to a beam", &fig);
}

static status compute_links(const scenario *s, run_monitor *monitor, void *found,
                            fault *f)
{
    return links_study_compute(s, monitor, found, f);
}

// --- follow ----------------------------------------------------------------------------

static json_t *points_array(const follow_point *points)
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

static json_t *follow_object(const scenario *s, const void *found)
{
    const follow_study *study = found;
    json_t *laws = json_object();
    for (int k = 0; k < FOLLOW_LAWS; k++) {
        json_put(laws, follow_laws[k], points_array(study->points[k]));
    }
    return json_of("scenario:t follow:o later_s:n", s->name, laws, study->later);
}

// A number of every point, over the frequencies.
static void print_table(const char *what, const follow_study *study, size_t offset,
                        double scale)
{
    printf("\n%-28s", what);
    for (int i = 0; i < FOLLOW_FREQUENCIES; i++) {
        printf(" %6g Hz", follow_frequencies[i]);
    }
    for (int k = 0; k < FOLLOW_LAWS; k++) {
        printf("\n%-28s", follow_laws[k]);
        for (int i = 0; i < FOLLOW_FREQUENCIES; i++) {
            const follow_point *p = &study->points[k][i];
            print_cell(9, "%.3g", scale * *(const double *)((const char *)p + offset));
        }
    }
    printf("\n");
}

static void print_follow(const scenario *s, const void *found)
{
    const follow_study *study = found;
    char changes[SCENARIO_CHANGES];
    say("%s%s: a set-point and a wall that move\ncommands act %g ms late\n", s->name,
        scenario_changes(s, changes), 1e3 * study->later);
    print_table("error of the set-point [%]", study, offsetof(follow_point, error), 100);
    print_table("phase [deg]", study, offsetof(follow_point, phase), 1);
    print_table("wall that moves [N/mm]", study, offsetof(follow_point, shaken), 1e-3);
}

static int plot_follow(const arguments *a, const scenario *s, const void *found)
{
    const follow_study *study = found;
    static const int colours[FOLLOW_LAWS] = {0, 3, 2, 1, 6, 5};
    static const marker_kind markers[FOLLOW_LAWS] = {MARKER_CIRCLE,  MARKER_SQUARE,
                                                     MARKER_DIAMOND, MARKER_TRIANGLE,
                                                     MARKER_CROSS,   MARKER_CIRCLE};
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
    figure_series series[PANELS][FOLLOW_LAWS];
    figure_panel panels[PANELS];
    for (int n = 0; n < PANELS; n++) {
        for (int k = 0; k < FOLLOW_LAWS; k++) {
            const follow_point *p = study->points[k];
            const double *y = (const double *)((const char *)p + drawn[n].offset);
            series[n][k] = curve_of(follow_laws[k], follow_laws[k], &p->frequency, y,
                                    FOLLOW_FREQUENCIES, colours[k]);
            series[n][k].stride = sizeof *p;
            series[n][k].marker = markers[k];
        }
        panels[n] = (figure_panel){.y = drawn[n].axis,
                                   .series = series[n],
                                   .series_count = FOLLOW_LAWS,
                                   .weight = 1.8};
    }

    char caption[400];
    snprintf(caption, sizeof caption,
             "Set-point: %g %% of the commanded force; wall: %g mm, against which "
             "friction holds the hub up to %.2g N. Commands act %.3g ms late.",
             100 * FOLLOW_WAVE, 1e3 * FOLLOW_WALL,
             s->parameters.motor.stiction / s->parameters.arm.length, 1e3 * study->later);
    const figure fig = {.caption = caption,
                        .x = {.name = "frequency", .label = "Frequency", .unit = "Hz"},
                        .panels = panels,
                        .panel_count = PANELS};
    return publish_study(a, s, "a set-point and a wall that move", &fig);
}

static status compute_follow(const scenario *s, run_monitor *monitor, void *found,
                             fault *f)
{
    return follow_study_compute(s, monitor, found, f);
}

// --- the command -----------------------------------------------------------------------

// What a study finds.
typedef union study_result {
    method_study methods;
    links_study links;
    follow_study follow;
} study_result;

// A study: its scenario if none is given, what computes it in pieces that are counted,
// and what becomes of the result.
typedef struct topic {
    const char *name, *scenario;
    status (*compute)(const scenario *s, run_monitor *monitor, void *found, fault *f);
    const char *pieces;
    int piece_count;
    command_results results;
} topic;

static const topic topics[] = {
    {.name = "methods",
     .scenario = "corrected/first-impact",
     .compute = compute_methods,
     .pieces = "runs",
     .piece_count = STUDY_RUNS,
     .results = {.json = methods_object,
                 .text = print_methods,
                 .plot = plot_methods,
                 .draws_part = true,
                 .kept = "the results are those of these",
                 .none = "there is nothing to show"}}, // without the reference
    {.name = "links",
     .scenario = "corrected/damped-beam",
     .compute = compute_links,
     .pieces = "numbers of links",
     .piece_count = LINKS_LENGTHS,
     .results = {.json = links_object,
                 .text = print_links,
                 .plot = plot_links,
                 .kept = "the table is that of these",
                 .none = "there is nothing to show"}},
    {.name = "follow",
     .scenario = "compare/observer",
     .compute = compute_follow,
     .pieces = "runs",
     .piece_count = FOLLOW_RUNS,
     .results = {.json = follow_object,
                 .text = print_follow,
                 .plot = plot_follow,
                 .draws_part = true,
                 .kept = "the results are those of these",
                 .none = "there is nothing to show"}},
};
enum { TOPICS = sizeof topics / sizeof topics[0] };

static const char *topic_word(const command_list *all, int i)
{
    if (i < TOPICS) {
        return topics[i].name;
    }
    return NULL;
}

// The study of that name, NULL if there is none.
static const topic *find_topic(const char *name)
{
    for (const topic *t = topics; t < topics + TOPICS; t++) {
        if (strcmp(t->name, name) == 0) {
            return t;
        }
    }
    return NULL;
}

// Makes the study that the first operand names, of the scenario.
static int make_study(const arguments *a, scenario *s)
{
    const topic *t = find_topic(a->operands[0]);
    study_result found;
    fault f = {0};
    run_monitor *monitor = work_begin(a, t->pieces, t->piece_count);
    const status code = t->compute(s, monitor, &found, &f);
    return work_finish(a, code, &f, &t->results, s, &found);
}

static int study(const arguments *a)
{
    const topic *t = find_topic(a->operands[0]);
    if (t == NULL) {
        return complain("there is no study '%s', expected methods, links or follow",
                        a->operands[0]);
    }
    const char *name = t->scenario;
    if (a->operand_count > 1) {
        name = a->operands[1];
    }
    return with_scenario(name, a, make_study);
}

const command study_command = {
    CALLED("study", MANY_RUNS,
           "Error against cost; links against a beam; laws over frequency"),
    SCENARIOS("methods|links|follow [SCENARIO]", 1, 2),
    .help = "methods: the scenario (corrected/first-impact) by every method of time "
            "integration at steps from 1e-2\ndown to 1e-6 s, with the error of first "
            "contact, first pulse's peak and steady force.\nlinks: the scenario "
            "(corrected/damped-beam) with 2 to 64 links: its blow and what a "
            "first-order sensor\nof 0.5, 1 or 2 ms reads of it, frequencies, statics; "
            "Richardson's limit and the Euler-Bernoulli\nbeam, and how many links are "
            "enough for which question.\nfollow: the scenario (compare/observer) under "
            "six laws with a set-point and a wall that swing, from\n0.2 to 25 Hz: "
            "error and phase of the force, beside what delay and arm allow. "
            "See\ndocs/explanation/methods.md and docs/explanation/trust.md. ^C ends "
            "any of them with what it has\nuntil then (exit status 130).\n",
    .operand_word = topic_word,
    .options = {&set_options, &json_options, &drawn_options, &quiet_options,
                &page_options},
    .run = study,
};
