// impactlab compare: the numbers and curves of several runs side by side.
#include "ui/commands/command.h"

#include "ui/commands/command_pictures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/scenario/effect.h"
#include "src/study/compare.h"
#include "src/study/sweep.h"
#include "ui/commands/progress.h"

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
    compare_row *against; // one of each combination, in the same block
    compare_table table;  // of the rows that are computed, the first ones
    bool failed;
    bool drawn; // each scenario's run is kept, for --plot
    run_result kept[TRACE_RUNS];
} comparison;

static void finish(comparison *c)
{
    sweep_finish(&c->varied);
    for (int i = 0; i < c->opened; i++) {
        scenario_finish(&c->scenarios[i]);
    }
    for (int i = 0; i < TRACE_RUNS; i++) {
        run_finish(&c->kept[i]);
    }
    free(c->scenarios);
    free(c->rows);
}

// The grid of a scenario's combinations, each of which must go with it.
static int open_sweep(comparison *c, const arguments *a, const scenario *s)
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

    // too many rows are refused before anything runs
    const size_t rows = c->varied.run_count * (size_t)c->operands;
    if (rows > MOST_ROWS) {
        return complain("%zu rows are too many for a table, expected at most %d", rows,
                        MOST_ROWS);
    }
    c->combinations = (int)c->varied.run_count;
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

static int open_all(comparison *c, const arguments *a)
{
    const int count = a->operand_count + (a->against != NULL);
    c->operands = a->operand_count;
    c->combinations = 1;
    c->scenarios = calloc((size_t)count, sizeof *c->scenarios);
    if (c->scenarios == NULL) {
        return worse(EXIT_FAILED, complain("out of memory"));
    }

    // the operands, then what they are compared against
    for (int i = 0; i < count; i++) {
        const char *name = i < a->operand_count ? a->operands[i] : a->against;
        int ended = open_scenario(&c->scenarios[i], name, a);
        if (ended != EXIT_DONE) {
            return ended;
        }
        c->opened++;
        ended = a->varies.count > 0 ? open_sweep(c, a, &c->scenarios[i]) : EXIT_DONE;
        if (ended != EXIT_DONE) {
            return ended;
        }
    }

    for (int k = 0; k < c->varied.axis_count; k++) {
        fault f = {0};
        if (check_effect(c, k, &f) != STATUS_OK) {
            return complain_fault(&f);
        }
    }
    c->rows =
        calloc((size_t)c->combinations * (size_t)(c->operands + 1), sizeof *c->rows);
    c->against = c->rows + c->combinations * c->operands;
    if (c->rows != NULL) {
        return EXIT_DONE;
    }
    return worse(EXIT_FAILED, complain("out of memory"));
}

// The row of scenario i under one combination. A run that fails keeps its row and is
// complained about; one that is stopped has none, and then false is returned.
static bool run_one(comparison *c, int i, int combination, run_monitor *monitor,
                    compare_row *row)
{
    const run_options options = {.keep_trace = c->drawn, .monitor = monitor};
    run_result result;
    fault f = {0};
    scenario s = c->scenarios[i];
    double values[COMPARE_MOST_VARIED];
    const int varied = c->varied.axis_count;
    for (int k = 0; k < varied; k++) {
        values[k] = sweep_value(&c->varied, (size_t)combination, k);
    }
    if (varied > 0 && sweep_axes_scenario(c->varied.axes, varied, values,
                                          &c->scenarios[i], &s, &f) != STATUS_OK) {
        complain_fault(&f); // values that do not go together were refused before
        c->failed = true;
    }

    status code = run_scenario_with(&s, &options, &result);
    if (code == STATUS_STOPPED) {
        run_finish(&result);
        return false;
    }
    if (code != STATUS_OK) {
        complain("%s failed: %s", s.name, result.summary.message);
        c->failed = true;
    }

    *row = compare_row_of(&s, &result);
    memcpy(row->varied, values, (size_t)varied * sizeof *values);
    for (int k = 0; k < varied; k++) {
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
static status run_all(comparison *c, run_monitor *monitor)
{
    for (int k = 0; k < c->combinations; k++) {
        if (c->opened > c->operands &&
            !run_one(c, c->operands, k, monitor, &c->against[k])) {
            return STATUS_STOPPED;
        }
        for (int i = 0; i < c->operands; i++) {
            if (!run_one(c, i, k, monitor, &c->rows[c->table.count])) {
                return STATUS_STOPPED;
            }
            c->table.count++;
        }
    }
    return STATUS_OK;
}

RESULT_WRITER(write_csv, comparison, compare_csv(stream, &found->table))
RESULT_WRITER(write_markdown, comparison, compare_text(stream, &found->table, true))
RESULT_GIVEN(json_t *, table_json, comparison, return compare_json(&found->table))

static void print_table(const scenario *s, const void *found)
{
    const compare_table *t = &((const comparison *)found)->table;
    if (t->count > 0) {
        compare_text(stdout, t, false);
    }
    if (t->count > 0 && t->against != NULL) {
        say("\n* differs from %s by more than %g %%\n", t->against->scenario,
            100 * t->tolerance);
    }
}

// What the runs are called: changes that all have stand in the title, else beside the
// scenario's name. Each name is on the heap. False without memory.
static bool name_runs(const comparison *c, char *names[TRACE_RUNS], char *title,
                      size_t size)
{
    char all[SCENARIO_CHANGES], own[SCENARIO_CHANGES];
    bool same = true, named = true;
    scenario_changes(&c->scenarios[0], all);
    for (int i = 1; i < c->opened; i++) {
        same = same && strcmp(scenario_changes(&c->scenarios[i], own), all) == 0;
    }

    for (int i = 0; i < c->opened; i++) {
        const char *changes = same ? "" : scenario_changes(&c->scenarios[i], own);
        if (asprintf(&names[i], "%s%s", c->scenarios[i].name, changes) < 0) {
            names[i] = NULL;
            named = false;
        }
    }
    snprintf(title, size, "Runs compared%s", same ? all : "");
    return named;
}

// The recorded signals of all scenarios in one figure, a colour each.
static int plot_runs(const arguments *a, const scenario *s, const void *found)
{
    const comparison *c = found;
    trace_run shown[TRACE_RUNS];
    int count = 0;
    char *names[TRACE_RUNS], title[64 + SCENARIO_CHANGES];
    if (c->varied.axis_count > 0) {
        return complain(
            "--plot shows the scenarios themselves, not --vary's combinations");
    }
    if (!c->drawn) {
        return complain("--plot shows at most %d runs, %d were given", TRACE_RUNS,
                        c->opened);
    }

    // one that failed shows what it has, one that was not begun nothing
    const bool named = name_runs(c, names, title, sizeof title);
    for (int i = 0; i < c->opened; i++) {
        if (c->kept[i].summary.steps > 0) {
            shown[count++] = (trace_run){&c->scenarios[i], &c->kept[i], .name = names[i],
                                         .rank = i + 1};
        }
    }
    const int code = named ? publish_runs(a, title, shown, count)
                           : worse(EXIT_FAILED, complain("out of memory"));
    for (int i = 0; i < c->opened; i++) {
        free(names[i]);
    }
    return code;
}

static int compare(const arguments *a)
{
    static const command_results r = {table_json,
                                      print_table,
                                      plot_runs,
                                      write_csv,
                                      .markdown = write_markdown,
                                      .draws_part = true,
                                      .kept = "the results are those of these",
                                      .none = "there is nothing to show"};
    SCOPED(finish) comparison c = {.table.tolerance = a->tolerance / 100};
    fault f = {0};
    if (a->columns != NULL && compare_choose(&c.table, a->columns, &f) != STATUS_OK) {
        return complain("--columns %s: %s", a->columns, f.text);
    }

    int ended = open_all(&c, a);
    if (ended != EXIT_DONE) {
        return ended;
    }
    c.table.rows = c.rows;
    c.table.group = c.operands;
    c.table.varied = c.varied.axes;
    c.table.varied_count = a->varies.count;
    if (a->against != NULL) {
        c.table.against = c.against;
    } else {
        c.table.against = NULL;
    }
    c.drawn = a->plot != NULL && c.varied.axis_count == 0 && c.opened <= TRACE_RUNS;
    run_monitor *monitor = work_begin(a, "runs", c.combinations * c.opened);
    const status code = run_all(&c, monitor);
    const int result = work_finish(a, code, &f, &r, NULL, &c);
    if (c.failed) {
        return worse(result, EXIT_FAILED);
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
    CALLED("compare", MANY_RUNS, "Several scenarios in one table"),
    SCENARIOS("SCENARIO...", 1, MOST_SCENARIOS),
    .help = "One row a run: peak force, its overshoot over the commanded force, "
            "settling time, impacts,\nseparations, steady error, largest command and "
            "electrical energy. Best peak and best time are\nwhat a controller could "
            "have made of the first impact if it knew the whole state, pressing "
            "no\nharder than the run did; from start is when it has settled, and least "
            "time what no controller\ntakes less than for that. --set holds for all of "
            "them; --vary, as sweep takes it, runs each of\nthem for every combination "
            "of values. ^C ends it with the rows that are done (exit status 130).\n",
    .options = {&set_options, &vary_options, &json_options, OWN_OPTIONS(rows),
                &quiet_options, &page_options},
    .run = compare,
};
