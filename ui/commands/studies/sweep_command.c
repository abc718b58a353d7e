// impactlab sweep: a run for each of many parameter values.
#include "ui/commands/command.h"

#include <glib.h>
#include <math.h>
#include <stdio.h>

#include "src/base/whole_file.h"
#include "src/exchange/sweep_table.h"
#include "src/study/store/sweep_store.h"
#include "src/study/sweep_run.h"
#include "ui/commands/command_pictures.h"
#include "ui/commands/progress.h"
#include "ui/commands/results.h"

// The options of the command line, checked.
typedef struct sweep_order {
    const arguments *arguments;
    const char *quantity; // key of the quantity that is drawn and summarised
    sweep_share share;    // of all runs
    const scenario *scenario;
    const sweep *sweep;
} sweep_order;

// --- text ------------------------------------------------------------------------------

enum { ROWS_SHOWN = 40 };

// "motor.voltage = 2 V, method.name = event" of a run.
static void print_run_values(const sweep *s, size_t run)
{
    const char *why[SWEEP_MOST_AXES];
    sweep_idle(s, run, why);
    for (int i = 0; i < s->axis_count; i++) {
        const char *unit = sweep_axis_parameter(&s->axes[i])->unit;
        char text[128];
        sweep_value_text(s, run, i, text, sizeof text);
        if (i > 0) {
            say(", ");
        }
        say("%s = %s%s%s", s->axes[i].name, text, blank_before(unit), unit);
        if (why[i] != NULL) {
            say(" (no effect)");
        }
    }
}

// How many runs there were, and the quantity that is summarised.
static void print_counts(const sweep_order *o, size_t failed, const sweep_progress *p)
{
    char changes[SCENARIO_CHANGES];
    say("%s%s: %zu run%s (%s), %zu failed", o->scenario->name,
        scenario_changes(o->scenario, changes), p->done, plural_ending(p->done),
        sweep_sampling_name(o->sweep->sampling), failed);
    if (p->done_now < p->done) {
        printf(", %zu were there already", p->done - p->done_now);
    }

    // the quantity with its unit
    const summary_info *quantity = &summary_table[summary_index(o->quantity)];
    printf("\n%s", quantity->label);
    if (quantity->unit[0] != '\0') {
        printf(" [%s]", quantity->unit);
    }
    printf("\n");
}

// What is told of the runs that there are: those of the first numbers, and the extremes.
typedef struct told_runs {
    size_t run[ROWS_SHOWN];
    double value[ROWS_SHOWN];
    int count;
    size_t smallest, largest; // runs
    double least, most;       // their values
    bool occurred;            // in any run
} told_runs;

// A sweep_value_taker.
static bool take_told(void *context, size_t run, double value)
{
    told_runs *t = context;
    if (run < ROWS_SHOWN) {
        t->run[t->count] = run;
        t->value[t->count++] = value;
    }

    // runs in which the quantity did not occur have no value
    if (!isfinite(value)) {
        return true;
    }
    if (!t->occurred || value < t->least) {
        t->smallest = run;
        t->least = value;
    }
    if (!t->occurred || value > t->most) {
        t->largest = run;
        t->most = value;
    }
    t->occurred = true;
    return true;
}

// A line for each of the first runs.
static void print_run_list(const sweep *s, const told_runs *t)
{
    for (int i = 0; i < t->count; i++) {
        printf("  %10.5g  ", t->value[i]);
        print_run_values(s, t->run[i]);
        printf("\n");
    }
    if (s->run_count > ROWS_SHOWN) {
        printf("  ... and %zu more (--csv writes all)\n", s->run_count - ROWS_SHOWN);
    }
}

// One line for the smallest or largest value.
static void print_extreme(const sweep_order *o, const char *word, double value,
                          size_t run)
{
    const char *unit = summary_table[summary_index(o->quantity)].unit;
    printf("  %-9s %.6g%s%s  in run %zu: ", word, value, blank_before(unit), unit,
           run + 1);
    print_run_values(o->sweep, run);
    printf("\n");
}

// A sweep as text: how many runs, their values, and the extremes.
static void print_sweep(const sweep_order *o, const told_runs *t, size_t failed,
                        const sweep_progress *p)
{
    const arguments *a = o->arguments;
    print_counts(o, failed, p);

    // each value, where no file has them
    const bool in_file = a->csv != NULL || a->json != NULL || a->parquet != NULL ||
                         a->db != NULL || a->plot != NULL;
    if (!in_file) {
        print_run_list(o->sweep, t);
    }
    if (!t->occurred) {
        printf("  did not occur in any run\n");
        return;
    }
    print_extreme(o, "smallest", t->least, t->smallest);
    print_extreme(o, "largest", t->most, t->largest);
}

// --- files -----------------------------------------------------------------------------

// Writes the rows there are as Parquet; errors of the stream stay in it.
static status write_parquet(const sweep_order *o, sweep_store *store, FILE *stream,
                            fault *f)
{
    result_column columns[SWEEP_COLUMNS];
    const int count = sweep_store_columns(o->sweep, columns);
    sweep_table table;
    if (sweep_table_begin(&table, stream, columns, count) != STATUS_OK) {
        return fault_no_memory(f);
    }
    const status code =
        sweep_store_rows(store, o->share, columns, count, sweep_table_row, &table, f);
    sweep_table_end(&table, o->sweep->base);
    return code;
}

typedef enum rows_format { ROWS_CSV, ROWS_JSON, ROWS_PARQUET } rows_format;

// Writes the rows there are, of a part or of the whole sweep, to a file; path NULL:
// nothing is asked for. Returns the exit status.
static int write_sweep_rows(const sweep_order *o, sweep_store *store, const char *path,
                            rows_format format)
{
    whole_file file;
    fault f = {0};
    if (path == NULL) {
        return EXIT_DONE;
    }
    if (whole_file_open(&file, path, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    status written;
    if (format == ROWS_PARQUET) {
        written = write_parquet(o, store, file.stream, &f);
    } else {
        written = sweep_store_write(store, file.stream, format == ROWS_JSON, &f);
    }
    if (whole_file_close(&file, written, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

static int plot_sweep(const sweep_order *o, sweep_store *store)
{
    g_autofree double *values = g_new(double, o->sweep->run_count);
    fault f = {0};
    if (sweep_store_quantity(store, o->share, o->quantity, values, NULL, &f) !=
        STATUS_OK) {
        return complain_fault(&f);
    }
    const sweep_picture shown = {.sweep = o->sweep, .key = o->quantity, .values = values};
    return publish_owned(o->arguments, drawing()->sweep_figure_create(&shown));
}

// Writes the files asked for and prints the summary, of the runs that are done. If one
// fails, the others are still written. Returns the exit status.
static int report_sweep(const sweep_order *o, sweep_store *store, const sweep_progress *p)
{
    const arguments *a = o->arguments;
    told_runs told = {.count = 0};
    size_t failed = 0;
    fault f = {0};
    if (sweep_store_values(store, o->share, o->quantity, take_told, &told, &failed, &f) !=
        STATUS_OK) {
        return complain_fault(&f);
    }

    // files first: what is printed may be cut off
    int result = write_sweep_rows(o, store, a->csv, ROWS_CSV);
    result = worse(result, write_sweep_rows(o, store, a->json, ROWS_JSON));
    result = worse(result, write_sweep_rows(o, store, a->parquet, ROWS_PARQUET));
    if (a->plot != NULL) {
        result = worse(result, plot_sweep(o, store));
    }
    if (summary_wanted(a)) {
        print_sweep(o, &told, failed, p);
    }

    // runs that failed now, or before
    const bool all_failed = failed == p->done;
    if (p->failed > 0 && (!a->quiet || all_failed)) {
        many_runs_report_failure(p);
    } else if (all_failed) {
        complain("all %zu runs failed; the message of each is in its row", failed);
    }
    if (all_failed) {
        result = worse(result, EXIT_FAILED);
    }
    return result;
}

// --- the request -----------------------------------------------------------------------

// Reads --part K/N, which needs a database or a Parquet file: what a part computes is
// good for being put together with the others. Returns the exit status.
static int read_share(const arguments *a, sweep_share *share)
{
    char rest;
    if (a->part == NULL) {
        return EXIT_DONE; // the whole sweep
    }

    // which part of how many
    if (sscanf(a->part, "%9d/%9d%c", &share->part, &share->parts, &rest) != 2 ||
        share->part < 1 || share->parts < share->part) {
        return complain("--part '%.40s' is no part, expected K/N with K from 1 to N",
                        a->part);
    }

    // a part alone can only be kept
    if (a->db == NULL && a->parquet == NULL) {
        return complain("--part %s keeps its runs for others, expected --db FILE.sqlite "
                        "or --parquet FILE.parquet",
                        a->part);
    }
    if (a->csv != NULL || a->json != NULL || a->plot != NULL) {
        return complain("--part %s is not the whole sweep: --csv, --json and --plot come "
                        "after impactlab merge",
                        a->part);
    }
    return EXIT_DONE;
}

// Makes the sweep that the command line asks for. One that cannot be, or that could not
// be drawn, is refused before it computes.
static status plan_sweep(const arguments *a, const scenario *base, sweep_share share,
                         sweep *s, fault *f)
{
    const char *sampling = "grid";
    if (a->sampling != NULL) {
        sampling = a->sampling;
    }

    const sweep_request request = {.vary = a->varies.items,
                                   .vary_count = a->varies.count,
                                   .sampling =
                                       (sweep_sampling)sweep_sampling_find(sampling),
                                   .runs = (size_t)a->runs,
                                   .seed = a->seed,
                                   .share = share};
    TRY(sweep_init(s, base, &request, f));

    // a parameter that no run takes is refused
    for (int i = 0; i < s->axis_count; i++) {
        TRY(sweep_check_effect(s, i, f));
    }
    if (a->plot != NULL) {
        return drawing()->sweep_plot_check(s, a->plot, f);
    }
    return STATUS_OK;
}

// --- the runs --------------------------------------------------------------------------

// Says what there is of a part of a sweep, and where. Returns the exit status.
static int report_part(const sweep_order *o, const sweep_progress *p)
{
    const arguments *a = o->arguments;
    const char *place = a->db;
    if (place == NULL) {
        place = a->parquet;
    }
    if (summary_wanted(a)) {
        say("%s: part %d of %d, %zu of %zu runs in '%s'\n", o->scenario->name,
            o->share.part, o->share.parts, p->done, o->sweep->run_count, place);
    }
    if (p->failed > 0 && p->failed == p->total) {
        return EXIT_FAILED;
    }
    return EXIT_DONE;
}

// Runs what is not in the store yet, and reports the whole sweep or the part of it.
// Returns the exit status.
static int run_and_report_sweep(const sweep_order *o, sweep_store *store)
{
    // the runs
    fault f = {0};
    sweep_progress progress;
    sweep_options options = many_runs_begin(o->arguments, NULL);
    options.share = o->share;
    const status code = sweep_run(o->sweep, store, &options, &progress, &f);
    many_runs_end(&options);
    if (code != STATUS_OK) {
        return complain_fault(&f);
    }

    // results are those of the whole sweep, not of a part of it
    const bool is_part = o->share.parts > 0;
    const bool is_stopped = progress.done < progress.total;
    const char *what_became = "none is shown";
    int result = EXIT_DONE;
    if (!is_part && progress.done > 0) {
        result = report_sweep(o, store, &progress);
        what_became = "the results are those of these";
    } else if (is_part && progress.done > 0 && o->arguments->parquet != NULL) {
        result = write_sweep_rows(o, store, o->arguments->parquet, ROWS_PARQUET);
        what_became = "the results are those of these";
    }

    // what has to be said of runs that are missing
    if (is_stopped) {
        return worse(result, many_runs_stopped(o->arguments->db, progress.done,
                                               progress.total, what_became));
    }
    if (is_part) {
        result = worse(result, report_part(o, &progress));
    }
    return result;
}

// The command: plans the sweep, runs what is missing of it, and reports it.
static int sweep_and_report(const arguments *a, scenario *base)
{
    sweep_order o = {.arguments = a, .scenario = base, .quantity = "peak_force_N"};
    if (refuse_bytes_on_screen("parquet", a->parquet) != EXIT_DONE) {
        return EXIT_BAD_ARGUMENTS;
    }
    if (a->quantity != NULL) {
        o.quantity = a->quantity;
    }
    const int ended = read_share(a, &o.share);
    if (ended != EXIT_DONE) {
        return ended;
    }

    // the sweep, and where its runs are kept
    SCOPED(sweep_finish) sweep s = {0};
    SCOPED(sweep_store_close_kept) sweep_store *store = NULL;
    fault f = {0};
    if (plan_sweep(a, base, o.share, &s, &f) != STATUS_OK ||
        sweep_store_open(&store, a->db, &s, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    o.sweep = &s;
    return run_and_report_sweep(&o, store);
}

static const option_row rows[] = {
    OPTION(CHOICE, "sample", "grid|random|latin", "how the values are combined (grid)",
           PLACE(sampling)),
    RUNS_OPTION("number of runs at random or of a Latin hypercube"),
    SEED_OPTION,
    JOBS_OPTION,
    DB_OPTION("keep every run in a database; go on where it ends"),
    OPTION(
        TEXT, "part", "K/N",
        "compute every N-th run from the K-th on; impactlab merge joins databases, and "
        "Parquet files in one folder are one table",
        PLACE(part)),
    OPTION(RESULT, "csv", "FILE|-", "write a row for each run", PLACE(csv)),
    OPTION(RESULT, "parquet", "FILE.parquet",
           "write them for pandas, polars, DuckDB or Spark", PLACE(parquet)),
    PLOT_OPTION("draw the quantity over one or two parameters"),
    OPTION(QUANTITY, "quantity", "KEY", "what to draw and to sum up (peak_force_N)",
           PLACE(quantity)),
};

const command sweep_command = {
    .name = "sweep",
    .group = GROUP_MANY_RUNS,
    .summary = "A run for each of many parameter values",
    .operands = "SCENARIO",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .help =
        "--vary PATH=a:b:n takes n values from a to b, PATH=a:b:n:log spaces them evenly "
        "in the logarithm,\n"
        "PATH=v1,v2,v3 takes those (words too: method.name=event,newmark). Several "
        "--vary give every\n"
        "combination, the last one changing fastest. With --sample random or latin, "
        "--runs N values are drawn\n"
        "from each PATH=a:b or list. LIST[k]=... varies the k-th number of a list, "
        "counted from 1.\n\n"
        "With --db a sweep that was interrupted goes on where it stopped when the same "
        "command is given again.\n"
        "^C finishes the runs in hand, within five seconds, and writes the rows there "
        "are (exit status 130). Runs that fail are rows too; the\n"
        "exit status is 1 if all of them failed.\n",
    .options = {&set_options, &vary_options, &json_options, OWN_OPTIONS(rows),
                &quiet_options, &page_options},
    .use = sweep_and_report,
};
