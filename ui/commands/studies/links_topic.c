// How the numbers of a chain of links tend to those of a beam.
#include "ui/commands/studies/study_topics.h"

#include <math.h>
#include <stdio.h>

#include "src/base/json.h"
#include "src/study/links.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

typedef struct links_result {
    const scenario *scenario;
    links_study study;
} links_result;

// --- numbers ---------------------------------------------------------------------------

// The quantities of one number of links.
static json_t *links_json_of(const links_study *study, int i)
{
    json_t *object = json_of("links:i", links_numbers[i]);
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        json_put(object, study->rows[k].key, json_number(study->rows[k].value[i]));
    }
    return object;
}

// What a quantity tends to.
static json_t *tendency_json(const links_row *row)
{
    json_t *enough;
    if (row->enough > 0) {
        enough = json_integer(row->enough);
    } else {
        enough = json_null();
    }
    return json_of("quantity:t order:n limit:n error:n beam:n aim:n off:n enough_links:o",
                   row->key, row->order, row->limit, row->error, row->beam, row->aim,
                   row->off, enough);
}

// The quantities by number of links, and what they tend to.
static json_t *links_json(const void *found)
{
    const links_result *result = found;
    const links_study *study = &result->study;
    json_t *links = json_array(), *limits = json_array();
    for (int i = 0; i < study->count; i++) {
        json_add(links, links_json_of(study, i));
    }
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        json_add(limits, tendency_json(&study->rows[k]));
    }
    return json_of("scenario:t links:o limits:o", result->scenario->name, links, limits);
}

// The heading of the table: the numbers of links, and what else stands there.
static void print_links_heading(const links_result *result)
{
    char changes[SCENARIO_CHANGES];
    say("%s%s: from links to a beam\n\n%-26s", result->scenario->name,
        scenario_changes(result->scenario, changes), "links");
    for (int i = 0; i < result->study.count; i++) {
        printf(" %9d", links_numbers[i]);
    }
    printf(" %10s %9s %9s %6s\n", "limit", "+-", "beam", "order");
}

// A quantity by number of links, and what it tends to.
static void print_links_row(const links_row *row, int count)
{
    char name[64];
    snprintf(name, sizeof name, "%s [%s]", row->label, row->unit);
    printf("%-26s", name);
    for (int i = 0; i < count; i++) {
        print_cell(9, "%.4g", row->value[i]);
    }
    print_cell(10, "%.5g", row->limit);
    print_cell(9, "%.1g", row->error);
    print_cell(9, "%.5g", row->beam);
    print_cell(6, "%.2f", row->order);
    printf("\n");
}

// What a quantity comes to with more and more links, in words.
static void print_tendency(const links_row *row)
{
    const double *last = &row->value[LINKS_LENGTHS - 3];
    const double ratio = last[2] / last[1], before = last[1] / last[0];
    printf("%s: ", row->label);

    // a limit that is reached, growth or decay, or none of these
    if (!(fabs(last[2]) > 0)) {
        printf("does not occur with 64 links\n");
    } else if (row->enough > 0) {
        const char *whose = isnan(row->beam) ? "" : "the beam's ";
        printf("%s%.4g %s, within %.2g %% from %d links on\n", whose, row->aim, row->unit,
               100 * row->off, row->enough);
    } else if (fmin(ratio, before) > LINKS_GROWS) {
        printf("grows, %.3g times with twice the links: it has no limit\n", ratio);
    } else if (fmax(ratio, before) < 1 / LINKS_GROWS) {
        printf("falls, %.3g times with twice the links: its limit is zero\n", ratio);
    } else {
        printf("still changes by %.2g %% from 32 to 64 links\n", 100 * fabs(ratio - 1));
    }
}

// The table, and what it says in words.
static void print_links(const void *found)
{
    const links_result *result = found;
    const links_study *study = &result->study;
    if (study->count == 0) {
        return;
    }
    print_links_heading(result);
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        print_links_row(&study->rows[k], study->count);
    }

    // the answer in words, once all numbers of links are there
    if (study->count < LINKS_LENGTHS) {
        return;
    }
    printf("\n");
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        print_tendency(&study->rows[k]);
    }
}

// --- the picture -----------------------------------------------------------------------

static const struct {
    int colour;
    marker_kind marker;
} curves[LINKS_QUANTITIES] = {
    {7, MARKER_CIRCLE},   {7, MARKER_SQUARE},  {0, MARKER_CIRCLE},   {3, MARKER_TRIANGLE},
    {3, MARKER_SQUARE},   {3, MARKER_DIAMOND}, {5, MARKER_TRIANGLE}, {2, MARKER_DIAMOND},
    {1, MARKER_TRIANGLE}, {6, MARKER_SQUARE},  {4, MARKER_CROSS},
};

static const figure_tick link_ticks[LINKS_LENGTHS] = {{2, "2"},   {4, "4"},   {8, "8"},
                                                      {16, "16"}, {32, "32"}, {64, "64"}};

// How far a quantity is from what it tends to [%], by number of links; NaN where nothing
// is left, which a logarithmic axis cannot show.
static void compute_shares(const links_row *row, double aim, double shares[LINKS_LENGTHS])
{
    for (int i = 0; i < LINKS_LENGTHS; i++) {
        shares[i] = 100 * fabs(row->value[i] / aim - 1);
        if (!(shares[i] > 0)) {
            shares[i] = (double)NAN;
        }
    }
}

// What each quantity lacks of the beam's, or of its limit, over the number of links.
static int plot_links(const arguments *a, const void *found)
{
    const links_result *result = found;
    const links_study *study = &result->study;

    // a curve for each quantity that tends to something
    double shares[LINKS_QUANTITIES][LINKS_LENGTHS];
    figure_series series[LINKS_QUANTITIES];
    int drawn = 0;
    for (int k = 0; k < LINKS_QUANTITIES; k++) {
        const links_row *row = &study->rows[k];
        const double aim = isnan(row->beam) ? row->limit : row->beam;
        if (isnan(aim)) {
            continue;
        }
        compute_shares(row, aim, shares[k]);
        series[drawn] = curve_of(row->key, row->label, study->links, shares[k],
                                 LINKS_LENGTHS, curves[k].colour);
        series[drawn].marker = curves[k].marker;
        drawn++;
    }

    // all in one panel
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
              .ticks = link_ticks,
              .tick_count = LINKS_LENGTHS},
        .panels = &panel,
        .panel_count = 1};
    return publish_study(a, result->scenario, "from links to a beam", &fig);
}

// --- the study -------------------------------------------------------------------------

// Makes the study and writes what is asked for. Returns the exit status.
static int study_links(const arguments *a, scenario *s)
{
    static const command_results results = {.json = links_json,
                                            .text = print_links,
                                            .plot = plot_links,
                                            .kept = "the table is that of these",
                                            .none = "there is nothing to show"};
    links_result found = {.scenario = s};
    fault f = {0};
    run_monitor *monitor = work_begin(a, "numbers of links", LINKS_LENGTHS);
    const status code = links_study_compute(s, monitor, &found.study, &f);
    return work_finish(a, code, &f, &results, &found);
}

const study_topic links_topic = {"links", "corrected/damped-beam", study_links};
