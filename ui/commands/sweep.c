// impactlab sweep: a run for each of many parameter values.
#include "ui/commands/command.h"

#include <math.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "render/plot/sweep_plot.h"
#include "ui/commands/sweep_report.h"

enum { BAR_LENGTH = 24 };

static volatile sig_atomic_t signal_caught;
static volatile time_t time_caught;

// The first signal lets the runs in hand finish; one that comes a second or more later ends the
// program. One that follows at once is the same again: timeout and some shells send it both to the
// program and to its group.
static void catch_signal(int number)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    if (signal_caught == 0) {
        signal_caught = number;
        time_caught = now.tv_sec;
    } else if (now.tv_sec > time_caught + 1) {
        signal(number, SIG_DFL);
        raise(number);
    }
}

static void catch_signals(void)
{
    struct sigaction caught = {.sa_handler = catch_signal};
    sigemptyset(&caught.sa_mask);
    sigaction(SIGINT, &caught, NULL);
    sigaction(SIGTERM, &caught, NULL);
}

// --- the request ----------------------------------------------------------------------------

static int processors(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > SWEEP_MOST_JOBS ? SWEEP_MOST_JOBS : (int)count;
}

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
                         .jobs = a->jobs > 0 ? (int)a->jobs : processors(),
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
    if (a->part == NULL) {
        return EXIT_DONE;
    }
    if (sscanf(a->part, "%6d/%6d%c", &share->part, &share->parts, &rest) != 2 || share->part < 1 ||
        share->parts < share->part) {
        return complain("--part '%.40s' is no part, expected K/N with K from 1 to N", a->part);
    }
    if (a->db == NULL) {
        return complain("--part %s keeps its runs in a database, expected --db FILE.sqlite",
                        a->part);
    }
    if (a->csv != NULL || a->plot != NULL) {
        return complain("--part %s is not the whole sweep: --csv and --plot come after impactlab "
                        "merge",
                        a->part);
    }
    return EXIT_DONE;
}

// Reads the scenario and what is varied, and looks at everything that can be wrong beforehand.
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

// --- progress -------------------------------------------------------------------------------

// "0:07", "3:20:00"
static void format_duration(char *text, size_t size, double seconds)
{
    long whole = seconds < 3.6e8 ? lround(seconds) : 359999999;
    if (whole < 3600) {
        snprintf(text, size, "%ld:%02ld", whole / 60, whole % 60);
    } else {
        snprintf(text, size, "%ld:%02ld:%02ld", whole / 3600, whole / 60 % 60, whole % 60);
    }
}

// The progress bar: a line on the terminal that is written over.
static void show_progress(void *context, const sweep_progress *p)
{
    char bar[BAR_LENGTH + 1], left[32] = "", failed[32] = "", line[160];
    (void)context;

    int filled = p->total > 0 ? (int)(BAR_LENGTH * p->done / p->total) : 0;
    for (int i = 0; i < BAR_LENGTH; i++) {
        bar[i] = i < filled ? '=' : ' ';
    }
    bar[BAR_LENGTH] = '\0';

    if (p->done_now > 0) {
        char time[24];
        double rate = (double)p->done_now / p->elapsed_s;
        format_duration(time, sizeof time, (double)(p->total - p->done) / rate);
        snprintf(left, sizeof left, ", %s left", time);
    }

    if (p->failed > 0) {
        snprintf(failed, sizeof failed, ", %zu failed", p->failed);
    }

    snprintf(line, sizeof line, "[%s] %3zu %%  %zu of %zu runs%s%s", bar, 100 * p->done / p->total,
             p->done, p->total, failed, left);
    fprintf(stderr, "\r%-78.78s", line);
}

static void clear_progress(void)
{
    fprintf(stderr, "\r%78s\r", "");
}

// --- the runs -------------------------------------------------------------------------------

// Ended by a signal: says what there is and how to go on.
static int report_stop(const sweep_order *o, const sweep_progress *p)
{
    const char *db = o->arguments->db;
    if (db != NULL) {
        complain("stopped: %zu of %zu runs are done and kept in '%s'; the same command goes on "
                 "from there",
                 p->done, p->total, db);
    } else {
        complain("stopped: %zu of %zu runs were done, nothing is kept; with --db FILE.sqlite a "
                 "sweep can be continued",
                 p->done, p->total);
    }
    return 128 + signal_caught;
}

static int compute(const sweep_order *o, sweep_store *store)
{
    fault f = {0};
    sweep_progress progress;
    bool bar = isatty(STDERR_FILENO) && !o->arguments->quiet;
    sweep_options options = {.share = o->share,
                             .jobs = o->jobs,
                             .stop = &signal_caught,
                             .report = bar ? show_progress : NULL};
    catch_signals();
    status code = sweep_run(&o->sweep, store, &options, &progress, &f);

    if (bar) {
        clear_progress();
    }

    if (code != STATUS_OK) {
        return complain_fault(&f);
    }
    if (progress.done < progress.total) {
        return report_stop(o, &progress);
    }
    if (o->share.parts == 0) {
        return report_sweep(o, store, &progress);
    }
    if (!o->arguments->quiet) {
        printf("%s: part %d of %d, %zu of %zu runs in '%s'\n", o->scenario.name, o->share.part,
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

    if (sweep_store_open(&store, a->db, &o.sweep, &f) == STATUS_OK) {
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
    {.name = "runs",
     .type = OPTION_WHOLE,
     .value = "N",
     .help = "number of runs at random or of a Latin hypercube",
     PLACE(runs),
     .low = 1,
     .high = SWEEP_MOST_RUNS},
    {.name = "seed",
     .type = OPTION_WHOLE,
     .value = "S",
     .help = "start of the random numbers (0)",
     PLACE(seed),
     .high = HUGE_VAL},
    {.name = "jobs",
     .type = OPTION_WHOLE,
     .value = "J",
     .help = "number of runs at a time (as many as processors)",
     PLACE(jobs),
     .low = 1,
     .high = SWEEP_MOST_JOBS},
    {.name = "db",
     .type = OPTION_PLACE,
     .value = "FILE.sqlite",
     .help = "keep every run in a database; go on where it ends",
     PLACE(db)},
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
    {.name = "plot",
     .type = OPTION_PICTURE,
     .value = "FILE.{png,pdf,svg}",
     .help = "draw the quantity over one or two parameters",
     PLACE(plot)},
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
        "latin, --runs N values are drawn\nfrom each PATH=a:b or list.\n\n"
        "With --db a sweep that was interrupted goes on where it stopped when the same command "
        "is given again.\nCtrl-C finishes the runs in hand and keeps them (exit status 130). "
        "Runs that fail are rows too; the\nexit status is 1 if all of them failed.\n",
    .least = 1,
    .most = 1,
    .takes_scenarios = true,
    .options = {&set_options, &vary_options, &options, &quiet_options, &page_options},
    .run = sweep_command_run,
};
