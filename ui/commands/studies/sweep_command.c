// impactlab sweep: a run for each of many parameter values.
#include "ui/commands/command.h"

#include <math.h>
#include <stdlib.h>

#include "render/plot/study_plot.h"
#include "src/base/json.h"
#include "src/study/store/sweep_store.h"
#include "src/study/sweep_run.h"
#include "ui/commands/progress.h"
#include "ui/commands/command_pictures.h"

// The options of the command line, checked.
typedef struct sweep_order {
    const arguments *arguments;
    const char *quantity; // key of the quantity that is drawn and summarised
    sweep_share share;    // of all runs
    const scenario *scenario;
    const sweep *sweep;
} sweep_order;

// --- results ---------------------------------------------------------------------------

enum { ROWS_SHOWN = 40 };

// Writes all rows to a file, as JSON or CSV; path NULL: nothing is asked for.
static int write_rows(sweep_store *store, const char *path, bool json)
{
    whole_file file;
    fault f = {0};
    if (path == NULL) {
        return EXIT_DONE;
    }
    if (whole_file_open(&file, path, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    const status written = sweep_store_write(store, file.stream, json, &f);
    if (whole_file_close(&file, written, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return EXIT_DONE;
}

// "motor.voltage = 2 V, method.name = event" of a run.
static void print_values(const sweep *s, size_t run)
{
    for (int i = 0; i < s->axis_count; i++) {
        const parameter_info *info = sweep_axis_parameter(&s->axes[i]);
        char text[128];
        sweep_value_text(s, run, i, text, sizeof text);
        if (i > 0) {
            say(", ");
        }
        say("%s = %s%s%s", s->axes[i].name, text, blank_before(info->unit), info->unit);
        if (sweep_idle(s, run, i) != NULL) {
            say(" (no effect)");
        }
    }
}

// One line for the smallest or largest value.
static void print_extreme(const sweep *s, const char *word, const double *values,
                          size_t run, const char *unit)
{
    printf("  %-9s %.6g%s%s  in run %zu: ", word, values[run], blank_before(unit), unit,
           run + 1);
    print_values(s, run);
    printf("\n");
}

static void print_summary(const sweep_order *o, const sweep_store *store,
                          const double *values, size_t failed, const sweep_progress *p)
{
    const sweep *s = o->sweep;
    const arguments *a = o->arguments;
    const summary_info *quantity = &summary_table[summary_index(o->quantity)];
    const char *unit = quantity->unit;

    // how many runs there were
    char changes[SCENARIO_CHANGES];
    say("%s%s: %zu run%s (%s), %zu failed", o->scenario->name,
        scenario_changes(o->scenario, changes), p->done, plural_ending(p->done),
        sweep_sampling_name(s->sampling), failed);
    if (p->done_now < p->done) {
        printf(", %zu were there already", p->done - p->done_now);
    }
    printf("\n%s", quantity->label);
    if (unit[0] != '\0') {
        printf(" [%s]", unit);
    }
    printf("\n");

    // each value, where no file has them
    const bool listed =
        a->csv == NULL && a->json == NULL && a->db == NULL && a->plot == NULL;
    size_t shown = 0;
    if (listed) {
        if (s->run_count < ROWS_SHOWN) {
            shown = s->run_count;
        } else {
            shown = ROWS_SHOWN;
        }
    }
    for (size_t run = 0; run < shown; run++) {
        if (store->present[run]) {
            printf("  %10.5g  ", values[run]);
            print_values(s, run);
            printf("\n");
        }
    }
    if (listed && shown < s->run_count) {
        printf("  ... and %zu more (--csv writes all)\n", s->run_count - shown);
    }

    // the smallest and the largest of those that occurred
    size_t low = s->run_count, high = s->run_count;
    for (size_t run = 0; run < s->run_count; run++) {
        if (isfinite(values[run])) {
            if (low == s->run_count || values[run] < values[low]) {
                low = run;
            }
            if (high == s->run_count || values[run] > values[high]) {
                high = run;
            }
        }
    }
    if (low == s->run_count) {
        printf("  did not occur in any run\n");
        return;
    }
    print_extreme(s, "smallest", values, low, unit);
    print_extreme(s, "largest", values, high, unit);
}

// Writes the files asked for and prints the summary, of the runs that are done. If one
// fails, the others are still written.
static int report_sweep(const sweep_order *o, sweep_store *store, const sweep_progress *p)
{
    const arguments *a = o->arguments;
    size_t failed = 0;
    SCOPED(free_kept) double *values = malloc(o->sweep->run_count * sizeof *values);
    fault f = {0};
    if (values == NULL) {
        if (fault_no_memory(&f) != STATUS_OK) {
            return complain_fault(&f);
        }
    } else {
        if (sweep_store_quantity(store, o->share, o->quantity, values, &failed, &f) !=
            STATUS_OK) {
            return complain_fault(&f);
        }
    }

    // files first: what is printed may be cut off
    int code = worse(write_rows(store, a->csv, false), write_rows(store, a->json, true));
    if (a->plot != NULL) {
        const sweep_picture shown = {.sweep = o->sweep,
                                     .key = o->quantity,
                                     .values = values};
        code = worse(code, publish_owned(a, sweep_figure_create(&shown)));
    }
    if (summary_wanted(a)) {
        print_summary(o, store, values, failed, p);
    }
    if (p->failed > 0 && (!a->quiet || failed == p->done)) {
        many_runs_report_failure(p);
    } else if (failed == p->done) {
        complain("all %zu runs failed; the message of each is in its row", failed);
    }
    if (failed == p->done) {
        return worse(code, EXIT_FAILED);
    }
    return code;
}

// --- the request -----------------------------------------------------------------------

// Reads --part K/N, which needs a database: what a part computes is good for being
// merged.
static int read_share(const arguments *a, sweep_share *share)
{
    char rest;
    if (a->part == NULL) {
        return EXIT_DONE; // the whole sweep
    }

    // which part of how many
    if (sscanf(a->part, "%6d/%6d%c", &share->part, &share->parts, &rest) != 2 ||
        share->part < 1 || share->parts < share->part) {
        return complain("--part '%.40s' is no part, expected K/N with K from 1 to N",
                        a->part);
    }

    // a part alone can only be kept
    if (a->db == NULL) {
        return complain(
            "--part %s keeps its runs in a database, expected --db FILE.sqlite", a->part);
    }
    if (a->csv != NULL || a->json != NULL || a->plot != NULL) {
        return complain("--part %s is not the whole sweep: --csv, --json and --plot come "
                        "after impactlab merge",
                        a->part);
    }
    return EXIT_DONE;
}

// --- the runs --------------------------------------------------------------------------

static int compute(const sweep_order *o, sweep_store *store)
{
    fault f = {0};
    sweep_progress progress;
    sweep_options options = many_runs_begin(o->arguments, NULL);
    options.share = o->share;
    status code = sweep_run(o->sweep, store, &options, &progress, &f);
    many_runs_end(&options);

    // what it came to: an error, a stop, the whole sweep or a part of it
    if (code != STATUS_OK) {
        return complain_fault(&f);
    }
    const bool stopped = progress.done < progress.total,
               shown = o->share.parts == 0 && progress.done > 0;
    const int result = shown ? report_sweep(o, store, &progress) : EXIT_DONE;
    if (stopped) {
        return many_runs_stopped(o->arguments->db, progress.done, progress.total,
                                 shown ? "the results are those of these"
                                       : "none is shown");
    }
    if (o->share.parts == 0) {
        return result;
    }
    if (!o->arguments->quiet) {
        say("%s: part %d of %d, %zu of %zu runs in '%s'\n", o->scenario->name,
            o->share.part, o->share.parts, progress.done, o->sweep->run_count,
            o->arguments->db);
    }
    if (progress.failed > 0 && progress.failed == progress.total) {
        return EXIT_FAILED;
    }
    return EXIT_DONE;
}

// A sweep that cannot be, or that could not be drawn, is refused before it computes.
static int sweep_and_report(const arguments *a, scenario *base)
{
    sweep_order o = {.arguments = a,
                     .scenario = base,
                     .quantity = a->quantity != NULL ? a->quantity : "peak_force_N"};
    const sweep_request request = {.vary = a->varies.items,
                                   .vary_count = a->varies.count,
                                   .sampling = (sweep_sampling)sweep_sampling_find(
                                       a->sampling ? a->sampling : "grid"),
                                   .runs = (size_t)a->runs,
                                   .seed = a->seed};
    int ended = read_share(a, &o.share);
    if (ended != EXIT_DONE) {
        return ended;
    }
    SCOPED(sweep_finish) sweep s = {0};
    SCOPED(sweep_store_close_kept) sweep_store *store = NULL;
    o.sweep = &s;

    // the rows, in the file or in memory
    fault f = {0};
    if (sweep_init(&s, base, &request, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    for (int i = 0; i < s.axis_count; i++) {
        if (sweep_check_effect(&s, i, &f) != STATUS_OK) {
            return complain_fault(&f);
        }
    }
    if (a->plot != NULL) {
        if (sweep_plot_check(&s, a->plot, &f) != STATUS_OK) {
            return complain_fault(&f);
        }
    }
    if (sweep_store_open(&store, a->db, &s, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    return compute(&o, store);
}

static const option_row rows[] = {
    OPTION(CHOICE, "sample", "grid|random|latin", "how the values are combined (grid)",
           PLACE(sampling)),
    RUNS_OPTION("number of runs at random or of a Latin hypercube"),
    SEED_OPTION,
    JOBS_OPTION,
    DB_OPTION("keep every run in a database; go on where it ends"),
    OPTION(TEXT, "part", "K/N",
           "compute every N-th run from the K-th on; impactlab merge joins the parts",
           PLACE(part)),
    OPTION(RESULT, "csv", "FILE|-", "write a row for each run", PLACE(csv)),
    PLOT_OPTION("draw the quantity over one or two parameters"),
    OPTION(QUANTITY, "quantity", "KEY", "what to draw and to sum up (peak_force_N)",
           PLACE(quantity)),
};

const command sweep_command = {
    CALLED("sweep", MANY_RUNS, "A run for each of many parameter values"),
    ONE_SCENARIO,
    .help = "--vary PATH=a:b:n takes n values from a to b, PATH=a:b:n:log spaces them "
            "evenly in the "
            "logarithm,\nPATH=v1,v2,v3 takes those (words too: "
            "method.name=event,newmark). Several "
            "--vary give every\ncombination, the last one changing fastest. With "
            "--sample random or "
            "latin, --runs N values are drawn\nfrom each PATH=a:b or list. LIST[k]=... "
            "varies the k-th "
            "number of a list, counted from 1.\n\n"
            "With --db a sweep that was interrupted goes on where it stopped when the "
            "same command is "
            "given again.\n^C finishes the runs in hand, within five seconds, and writes "
            "the rows "
            "there "
            "are (exit status 130). Runs that fail are rows too; the\nexit status is 1 "
            "if all of them "
            "failed.\n",
    .options = {&set_options, &vary_options, &json_options, OWN_OPTIONS(rows),
                &quiet_options, &page_options},
    .use = sweep_and_report,
};
