// impactlab compare: the numbers and curves of several runs side by side.
#include "ui/commands/command.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "render/page/text.h"
#include "src/scenario/effect.h"
#include "src/study/compare.h"
#include "src/study/sweep.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

enum { MOST_SCENARIOS = 1000, MOST_ROWS = 100000 };
_Static_assert((int)SWEEP_MOST_AXES <= (int)COMPARE_MOST_VARIED,
               "a row has room for every axis");

// The scenarios named on the command line, and then the one that they are held against.
// Each runs once for each combination of varied values; rows lie by combination, in it by
// scenario.
typedef struct comparison {
    scenario *scenarios;
    int opened, operands;
    sweep varied; // of the first scenario, its grid is that of all; no axes: nothing is
                  // varied
    int combinations;
    compare_row *rows;    // operands of each combination
    compare_row *against; // one of each combination
    compare_table table;  // of the rows that are computed, the first ones
    bool failed;
    bool drawn; // each scenario's run is kept, for --plot
    run_result kept[TRACE_RUNS];
} comparison;

static void comparison_finish(comparison *c)
{
    sweep_finish(&c->varied);
    for (int i = 0; i < c->opened; i++) {
        scenario_finish(&c->scenarios[i]);
    }
    for (int i = 0; i < TRACE_RUNS; i++) {
        run_finish(&c->kept[i]);
    }
    g_free(c->scenarios);
    g_free(c->rows);
    g_free(c->against);
}

// --- what is compared ------------------------------------------------------------------

// Checks that the varied values go with a scenario; the grid of the first one is that of
// all. Returns the exit status.
static int open_combinations(comparison *c, const arguments *a, const scenario *s)
{
    sweep own;
    const sweep_request request = {.vary = a->varies.items,
                                   .vary_count = a->varies.count};
    fault f = {0};
    if (sweep_init(&own, s, &request, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    if (c->varied.axis_count == 0) {
        c->varied = own;
    } else {
        sweep_finish(&own);
    }

    // a table of more is refused before anything runs
    const size_t rows = c->varied.run_count * (size_t)c->operands;
    if (rows > MOST_ROWS) {
        return complain("%zu rows are too many for a table, expected at most %d", rows,
                        MOST_ROWS);
    }
    c->combinations = (int)c->varied.run_count;
    return EXIT_DONE;
}

// Opens one more scenario. Returns the exit status.
static int open_compared(comparison *c, const arguments *a, const char *name)
{
    scenario *s = &c->scenarios[c->opened];
    const int ended = command_scenario_open(s, name, a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    c->opened++;
    if (a->varies.count > 0) {
        return open_combinations(c, a, s);
    }
    return EXIT_DONE;
}

// Whether a parameter that is varied acts in some run of some scenario.
static status check_effect(const comparison *c, int axis, fault *f)
{
    status code = STATUS_BAD_ARGUMENT;
    for (int i = 0; i < c->opened && code != STATUS_OK; i++) {
        sweep own = c->varied;
        own.base = &c->scenarios[i];
        code = sweep_check_effect(&own, axis, f);
    }
    return code;
}

// Opens all that is compared, and makes room for the rows. Returns the exit status.
static int open_comparison(comparison *c, const arguments *a)
{
    c->operands = a->operand_count;
    c->combinations = 1;

    // what is compared, and what it is held against
    c->scenarios = g_new0(scenario, (size_t)c->operands + 1);
    for (int i = 0; i < c->operands; i++) {
        const int ended = open_compared(c, a, a->operands[i]);
        if (ended != EXIT_DONE) {
            return ended;
        }
    }
    if (a->against != NULL) {
        const int ended = open_compared(c, a, a->against);
        if (ended != EXIT_DONE) {
            return ended;
        }
    }

    // a parameter that no run takes is refused
    for (int k = 0; k < c->varied.axis_count; k++) {
        fault f = {0};
        if (check_effect(c, k, &f) != STATUS_OK) {
            return complain_fault(&f);
        }
    }

    // room for the rows
    c->rows = g_new0(compare_row, (size_t)c->combinations * (size_t)c->operands);
    c->against = g_new0(compare_row, (size_t)c->combinations);
    return EXIT_DONE;
}

// --- runs ------------------------------------------------------------------------------

// Scenario i with the values of a combination, which borrows from it; the values go into
// the row.
static scenario vary_scenario(comparison *c, int i, int combination, compare_row *row)
{
    scenario s = c->scenarios[i];
    const int varied = c->varied.axis_count;
    for (int k = 0; k < varied; k++) {
        row->varied[k] = sweep_value(&c->varied, (size_t)combination, k);
    }

    fault f = {0};
    if (varied > 0 && sweep_axes_scenario(c->varied.axes, varied, row->varied,
                                          &c->scenarios[i], &s, &f) != STATUS_OK) {
        complain_fault(&f); // values that do not go together were refused before
        c->failed = true;
    }
    return s;
}

// Fills the row of scenario i under a combination. A run that fails keeps its row and is
// complained about; one that is stopped has none, and then false is returned.
static bool run_compared(comparison *c, int i, int combination, run_monitor *monitor,
                         compare_row *row)
{
    const run_options options = {.keep_trace = c->drawn, .monitor = monitor};
    compare_row values = {0};
    const scenario s = vary_scenario(c, i, combination, &values);
    run_result result;
    const status code = run_scenario_with(&s, &options, &result);
    if (code == STATUS_STOPPED) {
        run_finish(&result);
        return false;
    }
    if (code != STATUS_OK) {
        complain("%s failed: %s", s.name, result.summary.message);
        c->failed = true;
    }

    // its numbers beside the varied values
    *row = compare_row_of(&s, &result);
    memcpy(row->varied, values.varied, sizeof row->varied);
    for (int k = 0; k < c->varied.axis_count; k++) {
        row->idle[k] = effect_none_from(&s, c->varied.axes[k].parameter, -1);
    }

    if (c->drawn) {
        c->kept[i] = result;
    } else {
        run_finish(&result);
    }
    run_monitor_count(monitor);
    return true;
}

// Combination by combination, what the rows are held against first. Once it was stopped
// the table is that of the rows before.
static status run_comparison(comparison *c, run_monitor *monitor)
{
    const bool has_against = c->opened > c->operands;

    // every combination
    for (int k = 0; k < c->combinations; k++) {
        if (has_against && !run_compared(c, c->operands, k, monitor, &c->against[k])) {
            return STATUS_STOPPED;
        }
        for (int i = 0; i < c->operands; i++) {
            if (!run_compared(c, i, k, monitor, &c->rows[c->table.count])) {
                return STATUS_STOPPED;
            }
            c->table.count++;
        }
    }
    return STATUS_OK;
}

// --- the table -------------------------------------------------------------------------

static json_t *comparison_json(const void *found)
{
    const comparison *c = found;
    return compare_json(&c->table);
}

static void write_comparison_csv(FILE *stream, const void *found)
{
    const comparison *c = found;
    compare_csv(stream, &c->table);
}

static void write_comparison_markdown(FILE *stream, const void *found)
{
    const comparison *c = found;
    compare_text(stream, &c->table, true);
}

// The table, with a note on what its marks mean.
static void print_comparison(const void *found)
{
    const comparison *c = found;
    const compare_table *t = &c->table;
    if (t->count == 0) {
        return;
    }
    compare_text(stdout, t, false);
    if (t->against != NULL) {
        say("\n* differs from %s by more than %g %%\n", t->against->scenario,
            100 * t->tolerance);
    }
}

// --- the picture -----------------------------------------------------------------------

// Whether all scenarios have the same changes; if so, these are in `changes`.
static bool have_same_changes(const comparison *c, char changes[SCENARIO_CHANGES])
{
    scenario_changes(&c->scenarios[0], changes);
    for (int i = 1; i < c->opened; i++) {
        char others[SCENARIO_CHANGES];
        if (strcmp(scenario_changes(&c->scenarios[i], others), changes) != 0) {
            return false;
        }
    }
    return true;
}

// The recorded signals of all scenarios in one figure, a colour and a dash each.
static int plot_comparison(const arguments *a, const void *found)
{
    const comparison *c = found;
    if (c->varied.axis_count > 0) {
        return complain(
            "--plot shows the scenarios themselves, not --vary's combinations");
    }
    if (!c->drawn) {
        return complain("--plot shows at most %d runs, %d were given", TRACE_RUNS,
                        c->opened);
    }

    // changes that all have stand in the title, else beside the scenario's name
    char common[SCENARIO_CHANGES];
    const bool same = have_same_changes(c, common);
    if (!same) {
        common[0] = '\0';
    }
    g_autofree char *title = text_printf("Comparison of %d runs%s", c->opened, common);
    g_auto(GStrv) names = g_new0(char *, TRACE_RUNS + 1);
    for (int i = 0; i < c->opened; i++) {
        char changes[SCENARIO_CHANGES] = "";
        if (!same) {
            scenario_changes(&c->scenarios[i], changes);
        }
        names[i] = g_strconcat(c->scenarios[i].name, changes, NULL);
    }

    // one that failed shows what it has, one that was not begun nothing
    trace_run shown[TRACE_RUNS];
    int count = 0;
    for (int i = 0; i < c->opened; i++) {
        if (c->kept[i].summary.steps > 0) {
            shown[count] = (trace_run){&c->scenarios[i], &c->kept[i], .name = names[i],
                                       .rank = count + 1};
            count++;
        }
    }
    return publish_runs(a, title, shown, count);
}

// --- the command -----------------------------------------------------------------------

// The command: runs all scenarios and writes them side by side.
static int compare_and_report(const arguments *a)
{
    SCOPED(comparison_finish)
    comparison c = {.table.tolerance = a->tolerance / 100};
    fault f = {0};
    if (a->columns != NULL && compare_choose(&c.table, a->columns, &f) != STATUS_OK) {
        return complain("--columns %s: %s", a->columns, f.text);
    }

    // all scenarios, each of which every combination must go with
    const int ended = open_comparison(&c, a);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // the table, which grows row by row
    c.table.rows = c.rows;
    c.table.group = c.operands;
    c.table.varied = c.varied.axes;
    c.table.varied_count = a->varies.count;
    if (a->against != NULL) {
        c.table.against = c.against;
    }
    c.drawn = a->plot != NULL && c.varied.axis_count == 0 && c.opened <= TRACE_RUNS;

    // the runs, and what comes of them
    static const command_results results = {.json = comparison_json,
                                            .text = print_comparison,
                                            .plot = plot_comparison,
                                            .csv = write_comparison_csv,
                                            .markdown = write_comparison_markdown,
                                            .draws_part = true,
                                            .kept = "the results are those of these",
                                            .none = "there is nothing to show"};
    run_monitor *monitor = work_begin(a, "runs", c.combinations * c.opened);
    const status code = run_comparison(&c, monitor);
    int result = work_finish(a, code, &f, &results, &c);
    if (c.failed) {
        result = worse(result, EXIT_FAILED);
    }
    return result;
}

static const option_row rows[] = {
    PLOT_OPTION("draw the recorded signals of all scenarios"),
    OPTION(RESULT, "csv", "FILE|-", "write a row for each run", PLACE(csv)),
    OPTION(SCENARIO, "against", "SCENARIO", "a run to hold the others against",
           PLACE(against)),
    OPTION(NUMBER, "tolerance", "PERCENT", "differences beyond it are marked (5)",
           PLACE(tolerance), .high = HUGE_VAL, .initial = 5, .unit = "percent"),
    OPTION(RESULT, "markdown", "FILE|-", "write the table as one of a Markdown page",
           PLACE(markdown)),
    OPTION(TEXT, "columns", "KEY,KEY...",
           "show only these quantities, by their keys of --json", PLACE(columns)),
};

const command compare_command = {
    .name = "compare",
    .group = GROUP_MANY_RUNS,
    .summary = "Several scenarios in one table",
    .operands = "SCENARIO...",
    .least = 1,
    .most = MOST_SCENARIOS,
    .takes_scenarios = true,
    .help =
        "One row a run: peak force, its overshoot over the commanded force, settling "
        "time, impacts, separations, steady error, largest command and electrical "
        "energy. Best peak and best time are what a controller could have made of the "
        "first impact if it knew the whole state, pressing no harder than the run "
        "did; from start is when it has settled, and least time what no controller "
        "takes less than for that. --set holds for all of them; --vary, as sweep "
        "takes it, runs each of them for every combination of values. --plot gives "
        "each signal a panel and each run a colour and a dash; more than four runs "
        "have a row of panels each. ^C ends it with the rows that are done (exit "
        "status 130).\n",
    .options = {&set_options, &vary_options, &json_options, OWN_OPTIONS(rows),
                &quiet_options, &page_options, &signal_options},
    .run = compare_and_report,
};
