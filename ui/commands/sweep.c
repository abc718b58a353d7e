// impactlab sweep: a run for each of many parameter values.
#include "src/study/store/sweep_store.h"
#include "ui/commands/command.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/plot/study_plot.h"
#include "ui/commands/many_runs.h"
#include "ui/commands/pictures.h"
#include "ui/commands/sweep_report.h"

// --- the request ----------------------------------------------------------------------------

static sweep_sampling sampling_of(const char *name)
{
    for (int i = SWEEP_GRID; name != NULL && i <= SWEEP_LATIN; i++) {
        if (strcmp(name, sweep_sampling_name((sweep_sampling)i)) == 0) {
            return (sweep_sampling)i;
        }
    }
    return SWEEP_GRID;
}

static sweep_order order_of(const arguments *a)
{
    return (sweep_order){.arguments = a,
                         .quantity = a->quantity != NULL ? a->quantity : "peak_force_N",
                         .jobs = many_runs_jobs(a),
                         .request = {.vary = a->varies.items,
                                     .vary_count = a->varies.count,
                                     .sampling = sampling_of(a->sampling),
                                     .runs = (size_t)a->runs,
                                     .seed = a->seed}};
}

// Reads --part K/N, which needs a database: what a part computes is good for being merged.
static int read_share(const arguments *a, sweep_share *share)
{
    char rest;
    *share = (sweep_share){0, 0};

    // the whole sweep
    if (a->part == NULL) {
        return EXIT_DONE;
    }

    // which part of how many
    if (sscanf(a->part, "%6d/%6d%c", &share->part, &share->parts, &rest) != 2 || share->part < 1 ||
        share->parts < share->part) {
        return complain("--part '%.40s' is no part, expected K/N with K from 1 to N", a->part);
    }

    // a part alone can only be kept
    if (a->db == NULL) {
        return complain("--part %s keeps its runs in a database, expected --db FILE.sqlite",
                        a->part);
    }
    if (a->csv != NULL || a->json != NULL || a->plot != NULL) {
        return complain("--part %s is not the whole sweep: --csv, --json and --plot come after "
                        "impactlab merge",
                        a->part);
    }
    return EXIT_DONE;
}

// Reads the scenario and the varied parameters, and checks everything that can be wrong in advance.
static int prepare(sweep_order *o, const arguments *a)
{
    fault f = {0};

    *o = order_of(a);
    int code = read_share(a, &o->share);
    code = code == EXIT_DONE ? open_scenario(&o->scenario, a->operands[0], a) : code;
    if (code != EXIT_DONE) {
        return code;
    }

    // a sweep that cannot be, or that could not be drawn, is refused before it computes
    if (sweep_init(&o->sweep, &o->scenario, &o->request, &f) != STATUS_OK) {
        code = complain_fault(&f);
    } else if (a->plot != NULL && sweep_plot_check(&o->sweep, a->plot, &f) != STATUS_OK) {
        code = complain_fault(&f);
        sweep_finish(&o->sweep);
    }

    if (code != EXIT_DONE) {
        scenario_finish(&o->scenario);
    }
    return code;
}

// --- the runs -------------------------------------------------------------------------------

static int compute(const sweep_order *o, sweep_store *store)
{
    fault f = {0};
    sweep_progress progress;
    bool bar = many_runs_shows_progress(o->arguments);
    sweep_options options = {.share = o->share,
                             .jobs = o->jobs,
                             .ranks = o->arguments->ranks,
                             .report = bar ? many_runs_progress : NULL};
    many_runs_catch_signals(&options);
    status code = sweep_run(&o->sweep, store, &options, &progress, &f);

    if (bar) {
        many_runs_clear_progress();
    }

    // what it came to: an error, a stop, the whole sweep or a part of it
    if (code != STATUS_OK) {
        return complain_fault(&f);
    }
    if (many_runs_only_computes(o->arguments)) {
        return EXIT_DONE;
    }
    if (progress.done < progress.total) {
        return many_runs_stopped(o->arguments->db, progress.done, progress.total);
    }
    if (o->share.parts == 0) {
        return report_sweep(o, store, &progress);
    }
    if (!o->arguments->quiet) {
        say("%s: part %d of %d, %zu of %zu runs in '%s'\n", o->scenario.name, o->share.part,
            o->share.parts, progress.done, o->sweep.run_count, o->arguments->db);
    }
    return progress.failed > 0 && progress.failed == progress.total ? EXIT_FAILED : EXIT_DONE;
}

static int sweep_command_run(const arguments *a)
{
    sweep_order o;
    fault f = {0};
    sweep_store *store;

    int code = prepare(&o, a);
    if (code != EXIT_DONE) {
        return code;
    }

    // the rows, in the file or in memory
    const char *path = many_runs_only_computes(a) ? NULL : a->db;
    if (sweep_store_open(&store, path, &o.sweep, &f) == STATUS_OK) {
        code = compute(&o, store);
        sweep_store_close(store);
    } else {
        code = complain_fault(&f);
    }

    sweep_finish(&o.sweep);
    scenario_finish(&o.scenario);
    return code;
}

static const option_row rows[] = {
    {.name = "sample",
     .type = OPTION_CHOICE,
     .value = "grid|random|latin",
     .help = "how the values are combined (grid)",
     PLACE(sampling)},
    RUNS_OPTION("number of runs at random or of a Latin hypercube"),
    SEED_OPTION,
    JOBS_OPTION,
    DB_OPTION("keep every run in a database; go on where it ends"),
    {.name = "part",
     .type = OPTION_TEXT,
     .value = "K/N",
     .help = "compute every N-th run from the K-th on; impactlab merge joins the parts",
     PLACE(part)},
    {.name = "csv",
     .type = OPTION_RESULT,
     .value = "FILE|-",
     .help = "write a row for each run",
     PLACE(csv)},
    PLOT_OPTION("draw the quantity over one or two parameters"),
    {.name = "quantity",
     .type = OPTION_QUANTITY,
     .value = "KEY",
     .help = "what to draw and to sum up (peak_force_N)",
     PLACE(quantity)},
};
static const option_table options = OPTION_TABLE("Options", rows);

const command sweep_command = {
    .name = "sweep",
    .group = GROUP_MANY_RUNS,
    .operands = "SCENARIO",
    .summary = "A run for each of many parameter values",
    .help =
        "--vary PATH=a:b:n takes n values from a to b, PATH=a:b:n:log spaces them evenly in the "
        "logarithm,\nPATH=v1,v2,v3 takes those (words too: method.name=event,newmark). Several "
        "--vary give every\ncombination, the last one changing fastest. With --sample random or "
        "latin, --runs N values are drawn\nfrom each PATH=a:b or list. LIST[k]=... varies the k-th "
        "number of a list, counted from 1.\n\n"
        "With --db a sweep that was interrupted goes on where it stopped when the same command "
        "is given again.\nCtrl-C finishes the runs in hand, within five seconds, and keeps them "
        "(exit status 130). "
        "Runs that fail are rows too; the\nexit status is 1 if all of them failed.\n",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &vary_options, &json_options, &options, &quiet_options,
                &page_options},
    .on_ranks = true,
    .run = sweep_command_run,
};
