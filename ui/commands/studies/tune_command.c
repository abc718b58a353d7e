// impactlab tune: values of parameters that make an expression of results smallest.
#include "ui/commands/command.h"

#include <math.h>
#include <string.h>

#include "render/plot/study_plot.h"
#include "src/base/json.h"
#include "src/study/store/sweep_store.h"
#include "src/study/linear/linear.h"
#include "src/study/tune.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"

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
    bool kept; // the best so far, in the file of --output
} tuner;

static void write_best(FILE *stream, const scenario *s, const void *found)
{
    const tuning *t = &((const tuner *)found)->tuning;
    scenario best;
    if (tune_apply(t, t->found, &best, NULL) == STATUS_OK) {
        scenario_write(stream, &best);
    }
}

// Writes the best so far; the standard output gets it once, at the end.
static status keep_best(void *context, const tuning *best, fault *f)
{
    tuner *t = context;
    const char *path = t->arguments->output;
    whole_file file;
    if (path == NULL || strcmp(path, "-") == 0) {
        return STATUS_OK;
    }
    TRY(whole_file_open(&file, path, f));
    t->kept = true;
    write_best(file.stream, t->scenario, t);
    return whole_file_commit(&file, f);
}

static double given_value(const tuner *t, int axis)
{
    return sweep_axis_get(&t->tuning.plan.axes[axis], &t->scenario->parameters);
}

static status judge_rows(tuner *t, const sweep_options *options, fault *f)
{
    const int varied = t->tuning.asked.vary_count, rows = CHANGED + 2 * varied;
    SCOPED(tune_finish) tuning unseen = {.done = 0};
    SCOPED(sweep_store_close_kept) sweep_store *store = NULL;
    for (int i = 0; i < rows; i++) {
        t->rows[i].value = (double)NAN;
    }
    TRY(tune_unseen(&unseen, &t->tuning, (size_t)rows, f));
    TRY(sweep_store_open(&store, NULL, &unseen.plan, f));
    while (t->count < rows) {
        const int i = t->count++;
        double values[SWEEP_MOST_AXES];
        for (int k = 0; k < varied; k++) {
            if (i == GIVEN) {
                values[k] = given_value(t, k);
            } else {
                values[k] = t->tuning.found[k];
            }
        }
        if (i >= CHANGED) {
            const int k = (i - CHANGED) / 2;
            const bool lower = i % 2 == CHANGED % 2;
            const bool whole =
                sweep_axis_parameter(&unseen.plan.axes[k])->type == PARAMETER_INTEGER;
            if (lower) {
                values[k] *= 0.9;
            } else {
                values[k] *= 1.1;
            }
            if (whole) {
                if (lower) {
                    values[k] = floor(values[k]);
                } else {
                    values[k] = ceil(values[k]);
                }
            }
        }
        const status code =
            tune_evaluate(&unseen, (size_t)i, values, i == GIVEN ? "given" : "tuned",
                          store, options, &t->rows[i], f);
        if (code == STATUS_STOPPED || code == STATUS_NO_MEMORY) {
            return code;
        }
    }
    return STATUS_OK;
}

// Given and tuned as laws, side by side.
static robust_table compared(const tuner *t, robust_law *laws)
{
    laws[GIVEN] = t->rows[GIVEN].law;
    laws[TUNED] = t->rows[TUNED].law;
    const bool judged = t->rows[TUNED].law.runs > 0;
    return (robust_table){.scenario = t->scenario->name,
                          .laws = laws,
                          .count = judged ? CHANGED : 0};
}

static json_t *answer(const scenario *s, const void *found_by)
{
    const tuner *t = found_by;
    const tuning *found = &t->tuning;
    robust_law laws[CHANGED];
    const robust_table table = compared(t, laws);
    json_t *object = found->asked.over != NULL ? robust_json(&table) : json_object(),
           *numbers = json_array();
    for (int i = 0; i < found->asked.vary_count; i++) {
        const tune_result *changed = &t->rows[CHANGED + 2 * i];
        json_add(numbers, json_of("path:t given:n value:n tenth_lower:n tenth_higher:n",
                                  found->plan.axes[i].name, given_value(t, i),
                                  found->found[i], changed[0].value, changed[1].value));
    }
    return json_members(object,
                        "scenario:t minimise:t evaluations:i runs_each:i least:n "
                        "unseen_given:n unseen_tuned:n tune:o",
                        s->name, found->asked.minimise, (int)found->done,
                        (int)found->each, found->best.value, t->rows[GIVEN].value,
                        t->rows[TUNED].value, numbers);
}

static void print_answer(const scenario *s, const void *found_by)
{
    const tuner *t = found_by;
    const tuning *found = &t->tuning;
    robust_law laws[CHANGED];
    say_title(s);
    say("%s\n%.6g in %zu evaluations of %zu run%s\n\n  %-34s%13s%13s%13s%13s\n",
        found->asked.minimise, found->best.value, found->done, found->each,
        found->each == 1 ? "" : "s", "", "given", "tuned", "-10 % gives", "+10 % gives");
    for (int i = 0; i < found->asked.vary_count; i++) {
        say("  %-34s", found->plan.axes[i].name);
        print_cell(12, "%.6g", given_value(t, i));
        print_cell(12, "%.6g", found->found[i]);
        print_cell(12, "%.5g", t->rows[CHANGED + 2 * i].value);
        print_cell(12, "%.5g", t->rows[CHANGED + 2 * i + 1].value);
        say("\n");
    }
    say("  %-34s", "on draws that it did not see");
    print_cell(12, "%.5g", t->rows[GIVEN].value);
    print_cell(12, "%.5g", t->rows[TUNED].value);
    say("\n");
    if (t->rows[TUNED].law.runs > 0) {
        const robust_table table = compared(t, laws);
        say("\n");
        robust_text(stdout, &table, false);
    }
}

static int plot(const arguments *a, const scenario *s, const void *found)
{
    char changes[SCENARIO_CHANGES];
    return publish_owned(a, tune_figure_create(&((const tuner *)found)->tuning,
                                               scenario_changes(s, changes)));
}

static int report(const tuner *t, bool whole)
{
    static const command_results r = {answer, print_answer, plot, .output = write_best,
                                      .draws_part = true};
    const tuning *found = &t->tuning;
    const int code = write_results(t->arguments, &r, t->scenario, t, whole);
    if (found->best.rank < TUNE_REFUSED) {
        return code;
    }
    complain("none of the %zu evaluations %s", found->done,
             isfinite(found->best.value)
                 ? "meets --subject"
                 : "can be judged: in each, runs fail or never settle");
    return worse(code, EXIT_FAILED);
}

static int search(tuner *t)
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

    status code = sweep_store_open(&store, a->db, &t->tuning.plan, &f);
    if (code == STATUS_OK) {
        code = tune_run(&t->tuning, store, &options, &f);
    }
    status judged;
    if (code == STATUS_OK) {
        judged = judge_rows(t, &options, &f);
    } else {
        judged = code;
    }
    many_runs_end(&options);

    // what was found is told whatever the judging came to
    const bool any = t->tuning.done > 0 && (code == STATUS_OK || code == STATUS_STOPPED);
    const int result = any ? report(t, judged != STATUS_STOPPED) : EXIT_DONE;
    if (judged != STATUS_STOPPED) {
        if (judged == STATUS_OK) {
            return result;
        }
        return worse(result, complain_fault(&f));
    }
    return many_runs_stopped(
        a->db, t->tuning.done * t->tuning.each, t->tuning.plan.run_count,
        any ? "the values are the best of these, not judged on other draws"
            : "none is shown");
}

static void finish(tuner *t)
{
    for (int i = 0; i < t->count; i++) {
        robust_law_finish(&t->rows[i].law);
    }
    tune_finish(&t->tuning);
}

static int tune(const arguments *a, scenario *s)
{
    SCOPED(robust_set_finish) robust_set set = {0};
    SCOPED(finish) tuner t = {.arguments = a, .scenario = s};
    if (a->varies.count == 0 || a->minimise == NULL) {
        return complain("tune: expected --vary PATH=a:b and --minimise EXPR");
    }
    const size_t usual = a->over != NULL ? TUNE_RUNS : TUNE_RUNS_ALONE;
    const tune_request asked = {.base = s,
                                .vary = a->varies.items,
                                .vary_count = a->varies.count,
                                .minimise = a->minimise,
                                .subject = a->subject,
                                .over = a->over != NULL ? &set : NULL,
                                .runs = a->runs > 0 ? (size_t)a->runs : usual,
                                .seed = a->seed,
                                .growth = linear_growth};
    fault f = {0};
    if (a->over != NULL) {
        if (robust_set_read(&set, a->over, &f) != STATUS_OK) {
            return complain_fault(&f);
        }
    }
    if (tune_init(&t.tuning, &asked, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return search(&t);
}

static const option_row rows[] = {
    OPTION(TEXT, "minimise", "EXPR", "what is to be small", PLACE(minimise)),
    OPTION(TEXT, "subject", "EXPR<=X", "what has to hold; or >=", PLACE(subject)),
    OPTION(FILE, "over", "SET",
           "file of what is drawn for each run, a line PATH=a:b each", PLACE(over)),
    OPTION(WHOLE, "runs", "N", "number of runs in all (4000 over a set, else 200)",
           PLACE(runs), .low = 1, .high = TUNE_MOST_RUNS),
    SEED_OPTION,
    JOBS_OPTION,
    DB_OPTION("keep every run in a database; go on where it ends"),
    OUTPUT_OPTION(RESULT, "FILE|-", "write the scenario with the best values so far",
                  .replaces = scenario_is),
    PLOT_OPTION("draw what each evaluation came to, and the least so far"),
};

const command tune_command = {
    CALLED("tune", CONTROL,
           "Values of parameters that make an expression of results smallest"),
    ONE_SCENARIO,
    .help = "EXPR is made of numbers, + - * / ( ), max(a, b) and keys: with --over "
            "those of robust --json, else those of\nrun --json; growth_per_s is that "
            "of linear --vary. --vary PATH=a:b (or a:b:log) says what may be changed "
            "within which range. Over a set an\nevaluation is a batch of runs with the "
            "same draws each time, as many runs as there are evaluations.\nWhat is not "
            "allowed or fails ranks last.\n\nThe result is judged on 200 draws that "
            "the search did not see, also with each number a tenth lower and\nhigher "
            "(a whole one by one at least). The file of -o is whole at every instant; "
            "with --db the same command goes on where a search\nwas stopped. The exit "
            "status is 1 if no values meet --subject.\n",
    .options = {&set_options, &vary_options, &json_options, OWN_OPTIONS(rows),
                &quiet_options, &page_options},
    .use = tune,
};
