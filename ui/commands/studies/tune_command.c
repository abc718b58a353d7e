// impactlab tune: values of parameters that make an expression of results smallest.
#include "ui/commands/command.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "src/base/json.h"
#include "src/base/whole_file.h"
#include "src/study/linear/linear.h"
#include "src/study/store/sweep_store.h"
#include "src/study/robust/law_exam.h"
#include "src/study/robust/tune.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"
#include "ui/commands/studies/tune_exam.h"

// What is judged on draws that the search did not see: the values as given, those found,
// and these with one number a tenth lower and higher, a whole one by one at least. What a
// parameter does not take has no result.
enum { GIVEN, TUNED, CHANGED, ROWS = CHANGED + 2 * SWEEP_MOST_AXES };

typedef struct tuner {
    const arguments *arguments;
    const scenario *scenario;
    tuning tuning;
    tune_result rows[ROWS];
    int count; // of rows
} tuner;

static void tuner_finish(tuner *t)
{
    for (int i = 0; i < t->count; i++) {
        robust_law_finish(&t->rows[i].law);
    }
    tune_finish(&t->tuning);
}

// --- results ---------------------------------------------------------------------------

// The value of a varied parameter in the scenario.
static double given_value(const tuner *t, int axis)
{
    return sweep_axis_get(&t->tuning.plan.axes[axis], &t->scenario->parameters);
}

// What came of the values with one parameter a tenth lower, and a tenth higher.
static const tune_result *changed_rows(const tuner *t, int axis)
{
    return &t->rows[CHANGED + 2 * axis];
}

// Given and tuned as laws, side by side; `laws` has room for both.
static robust_table table_of_laws(const tuner *t, robust_law laws[CHANGED])
{
    laws[GIVEN] = t->rows[GIVEN].law;
    laws[TUNED] = t->rows[TUNED].law;
    robust_table table = {.scenario = t->scenario->name, .laws = laws};
    if (t->rows[TUNED].law.runs > 0) {
        table.count = CHANGED;
    }
    return table;
}

// What was found; over a set, beside the keys of robust.
static json_t *tuning_json(const void *found)
{
    const tuner *t = found;
    const tuning *tuned = &t->tuning;

    // over a set the laws are judged as robust judges them
    json_t *object, *numbers = json_array();
    if (tuned->asked.over != NULL) {
        robust_law laws[CHANGED];
        const robust_table table = table_of_laws(t, laws);
        object = robust_json(&table);
    } else {
        object = json_object();
    }

    // each varied parameter
    for (int i = 0; i < tuned->asked.vary_count; i++) {
        const tune_result *changed = changed_rows(t, i);
        json_add(numbers, json_of("path:t given:n value:n tenth_lower:n tenth_higher:n",
                                  tuned->plan.axes[i].name, given_value(t, i),
                                  tuned->found[i], changed[0].value, changed[1].value));
    }
    return json_members(object,
                        "scenario:t minimise:t evaluations:i runs_each:i least:n "
                        "unseen_given:n unseen_tuned:n tune:o",
                        t->scenario->name, tuned->asked.minimise, (int)tuned->done,
                        (int)tuned->each, tuned->best.value, t->rows[GIVEN].value,
                        t->rows[TUNED].value, numbers);
}

// A parameter as given and as tuned, and what a tenth less or more of it gives.
static void print_tuned_parameter(const tuner *t, int axis)
{
    const tune_result *changed = changed_rows(t, axis);
    say("  %-34s", t->tuning.plan.axes[axis].name);
    print_cell(12, "%.6g", given_value(t, axis));
    print_cell(12, "%.6g", t->tuning.found[axis]);
    print_cell(12, "%.5g", changed[0].value);
    print_cell(12, "%.5g", changed[1].value);
    say("\n");
}

// The values that were found, and how they do on other draws.
static void print_tuning(const void *found)
{
    const tuner *t = found;
    const tuning *tuned = &t->tuning;
    say_title(t->scenario);
    say("%s\n%.6g in %zu evaluations of %zu run%s\n\n", tuned->asked.minimise,
        tuned->best.value, tuned->done, tuned->each, plural_ending(tuned->each));

    // what was found, and what a tenth more or less gives
    say("  %-34s%13s%13s%13s%13s\n", "", "given", "tuned", "-10 % gives", "+10 % gives");
    for (int i = 0; i < tuned->asked.vary_count; i++) {
        print_tuned_parameter(t, i);
    }
    say("  %-34s", "on draws that it did not see");
    print_cell(12, "%.5g", t->rows[GIVEN].value);
    print_cell(12, "%.5g", t->rows[TUNED].value);
    say("\n");

    // both as laws
    if (t->rows[TUNED].law.runs > 0) {
        robust_law laws[CHANGED];
        const robust_table table = table_of_laws(t, laws);
        say("\n");
        robust_text(stdout, &table, false);
    }
}

static void write_best_scenario(FILE *stream, const void *found)
{
    const tuning *tuned = &((const tuner *)found)->tuning;
    scenario best;
    if (tune_apply(tuned, tuned->found, &best, NULL) == STATUS_OK) {
        scenario_write(stream, &best);
    }
}

static int plot_tuning(const arguments *a, const void *found)
{
    const tuner *t = found;
    char changes[SCENARIO_CHANGES];
    scenario_changes(t->scenario, changes);
    return publish_owned(a, drawing()->tune_figure_create(&t->tuning, changes));
}

// Writes what was found. Returns the exit status.
static int report_tuning(const tuner *t, bool whole)
{
    static const command_results results = {.json = tuning_json,
                                            .text = print_tuning,
                                            .plot = plot_tuning,
                                            .output = write_best_scenario,
                                            .draws_part = true};
    const tuning *tuned = &t->tuning;
    const int result = write_results(t->arguments, &results, t, whole);
    if (tuned->best.rank < TUNE_REFUSED) {
        return result;
    }

    // values that nobody may use are a failure
    const char *why = "can be judged: in each, runs fail or never settle";
    if (isfinite(tuned->best.value)) {
        why = "meets --subject";
    }
    complain("none of the %zu evaluations %s", tuned->done, why);
    return worse(result, EXIT_FAILED);
}

// --- the search ------------------------------------------------------------------------

// Writes the best so far; the standard output gets it once, at the end.
static status keep_best(void *context, const tuning *best, fault *f)
{
    (void)best;
    const tuner *t = context;
    const char *path = t->arguments->output;
    if (path == NULL || strcmp(path, "-") == 0) {
        return STATUS_OK;
    }
    whole_file file;
    TRY(whole_file_open(&file, path, f));
    write_best_scenario(file.stream, t);
    return whole_file_commit(&file, f);
}

// A value a tenth lower or higher, a whole one by one at least.
static double changed_value(const sweep_axis *axis, double value, bool lower)
{
    const double factor = lower ? 0.9 : 1.1;
    const double changed = factor * value;
    if (sweep_axis_parameter(axis)->type != PARAMETER_INTEGER) {
        return changed;
    }
    return lower ? floor(changed) : ceil(changed);
}

// The values that a row judges.
static void values_of_row(const tuner *t, int row, double values[SWEEP_MOST_AXES])
{
    for (int k = 0; k < t->tuning.asked.vary_count; k++) {
        values[k] = t->tuning.found[k];
        if (row == GIVEN) {
            values[k] = given_value(t, k);
        }
    }
    if (row >= CHANGED) {
        const int axis = (row - CHANGED) / 2;
        const bool lower = (row - CHANGED) % 2 == 0;
        values[axis] = changed_value(&t->tuning.plan.axes[axis], values[axis], lower);
    }
}

// Judges all rows on draws that the search did not see.
static status judge_rows(tuner *t, const sweep_options *options, fault *f)
{
    const int rows = CHANGED + 2 * t->tuning.asked.vary_count;
    SCOPED(tune_finish) tuning unseen = {.done = 0};
    SCOPED(sweep_store_close_kept) sweep_store *store = NULL;

    // draws of their own, the same for every row
    TRY(tune_unseen(&unseen, &t->tuning, (size_t)rows, f));
    TRY(sweep_store_open(&store, NULL, &unseen.plan, f));

    // row by row; what a parameter does not take leaves its row empty
    while (t->count < rows) {
        const int row = t->count++;
        double values[SWEEP_MOST_AXES];
        values_of_row(t, row, values);
        const char *name = row == GIVEN ? "given" : "tuned";
        const status code = tune_evaluate(&unseen, (size_t)row, values, name, store,
                                          options, &t->rows[row], f);
        if (code == STATUS_STOPPED || code == STATUS_NO_MEMORY) {
            return code;
        }
    }
    return STATUS_OK;
}

// Says what became of a search that was stopped. Returns the exit status.
static int report_stopped_search(const tuner *t, bool any)
{
    const char *what_became = "none is shown";
    if (any) {
        what_became = "the values are the best of these, not judged on other draws";
    }
    return many_runs_stopped(t->arguments->db, t->tuning.done * t->tuning.each,
                             t->tuning.plan.run_count, what_became);
}

// Searches for the best values, judges them and reports both. Returns the exit status.
static int search_and_report(tuner *t)
{
    const arguments *a = t->arguments;
    fault f = {0};
    SCOPED(sweep_store_close_kept) sweep_store *store = NULL;
    const sweep_options options = many_runs_begin(a, NULL);
    for (int i = 0; i < ROWS; i++) {
        t->rows[i].value = (double)NAN;
    }
    t->tuning.improved = keep_best;
    t->tuning.context = t;

    status searched = sweep_store_open(&store, a->db, &t->tuning.plan, &f);
    if (searched == STATUS_OK) {
        searched = tune_run(&t->tuning, store, &options, &f);
    }
    status judged = searched;
    if (searched == STATUS_OK) {
        judged = judge_rows(t, &options, &f);
    }
    many_runs_end(&options);

    // what was found is reported whatever the judging came to
    const bool any =
        t->tuning.done > 0 && (searched == STATUS_OK || searched == STATUS_STOPPED);
    int result = EXIT_DONE;
    if (any) {
        result = report_tuning(t, judged != STATUS_STOPPED);
    }
    if (judged == STATUS_STOPPED) {
        return report_stopped_search(t, any);
    }
    if (judged != STATUS_OK) {
        result = worse(result, complain_fault(&f));
    }
    return result;
}

// --- the command -----------------------------------------------------------------------

// What is asked for; `set` is that of --over.
static tune_request request_of_tuning(const arguments *a, const scenario *s,
                                      const robust_set *set)
{
    tune_request asked = {.base = s,
                          .vary = a->varies.items,
                          .vary_count = a->varies.count,
                          .minimise = a->minimise,
                          .subject = a->subject,
                          .runs = TUNE_RUNS_ALONE,
                          .seed = a->seed,
                          .growth = linear_growth};

    // over a set each evaluation is a batch of runs
    if (a->over != NULL) {
        asked.over = set;
        asked.runs = TUNE_RUNS;
    }
    if (a->runs > 0) {
        asked.runs = (size_t)a->runs;
    }
    return asked;
}

// The command: reads what is asked for, and searches.
static int tune_and_report(const arguments *a, scenario *s)
{
    if (a->varies.count > 0 && a->draw > 0) {
        return tune_over_exam(a, s);
    }
    if (a->varies.count == 0 || a->minimise == NULL) {
        return complain(
            "tune: expected --vary PATH=a:b, and --minimise EXPR or --draw N");
    }
    if (a->forces.count > 0) {
        return complain("--force goes with --draw only");
    }

    SCOPED(robust_set_finish) robust_set set = {0};
    SCOPED(tuner_finish) tuner t = {.arguments = a, .scenario = s};
    fault f = {0};
    if (a->over != NULL && robust_set_read(&set, a->over, &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    // the search
    const tune_request asked = request_of_tuning(a, s, &set);
    if (tune_init(&t.tuning, &asked, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return search_and_report(&t);
}

static const option_row rows[] = {
    OPTION(TEXT, "minimise", "EXPR", "what is to be small", PLACE(minimise)),
    OPTION(TEXT, "subject", "EXPR<=X", "what has to hold; or >=", PLACE(subject)),
    OPTION(FILE, "over", "SET",
           "file of what is drawn for each run, a line PATH=a:b each", PLACE(over)),
    OPTION(WHOLE, "draw", "N",
           "instead: cases of an exam as of robust, whose bounds the law shall keep",
           PLACE(draw), .low = 1, .high = EXAM_MOST_CASES),
    OPTION(NUMBERS, "force", "F",
           "with --draw: a commanded force, may be repeated (the scenario's)",
           PLACE(forces), .low = 0, .high = 1e6, .unit = "N"),
    OPTION(
        WHOLE, "runs", "N",
        "number of runs in all (4000 over a set, else 200); with --draw of exams (400)",
        PLACE(runs), .low = 1, .high = TUNE_MOST_RUNS),
    SEED_OPTION,
    JOBS_OPTION,
    DB_OPTION("keep every run in a database; go on where it ends"),
    OUTPUT_OPTION(RESULT, "FILE|-", "write the scenario with the best values so far",
                  .replaces = scenario_is),
    PLOT_OPTION("draw what each evaluation came to, and the least so far"),
};

const command tune_command = {
    .name = "tune",
    .group = GROUP_CONTROL,
    .summary = "Values of parameters that make an expression of results smallest",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help =
        "EXPR is made of numbers, + - * / ( ), max(a, b) and keys: with --over those of "
        "robust --json, else those of\n"
        "run --json; growth_per_s is that of linear --vary. --vary PATH=a:b (or a:b:log) "
        "says what may be changed within which range. Over a set an\n"
        "evaluation is a batch of runs with the same draws each time, as many runs as "
        "there are evaluations.\n"
        "What is not allowed or fails ranks last.\n\n"
        "The result is judged on 200 draws that the search did not see, also with each "
        "number a tenth lower and\n"
        "higher (a whole one by one at least). The file of -o is whole at every instant; "
        "with --db the same command goes on where a search\n"
        "was stopped. The exit status is 1 if no values meet --subject.\n\n"
        "With --draw N the numbers of the law are found on an exam (robust --draw): an "
        "evolution strategy\nlooks for those with which the fewest runs of N cases miss "
        "its bounds, and both are judged on 480\ncases that the search did not see. "
        "Nothing is kept but -o.\n",
    .options = {&set_options, &vary_options, &json_options, OWN_OPTIONS(rows),
                &quiet_options, &page_options},
    .use = tune_and_report,
};
