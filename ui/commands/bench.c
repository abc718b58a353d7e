#include "ui/commands/command.h"

#include <fcntl.h>
#include <ftw.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "src/base/shipped.h"
#include "src/study/bench.h"
#include "src/study/store/sweep_store.h"
#include "src/base/words.h"
#include "ui/commands/pictures.h"

// --- what the programs add to the library's benchmarks --------------------------------------

static int remove_entry(const char *path, const struct stat *about, int kind, struct FTW *place)
{
    (void)about;
    (void)kind;
    (void)place;
    return remove(path);
}

// Runs the program once more, without its words, and waits for its end.
static status run_program(char *const *words, fault *f)
{
    char *program = shipped_path(SHIPPED_PROGRAM);
    const pid_t child = program != NULL ? fork() : -1;
    if (child == 0) {
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        execv(program, words);
        _exit(1);
    }

    int how = 0;
    status code = STATUS_OK;
    if (child < 0 || waitpid(child, &how, 0) != child || how != 0) {
        code = fault_set(f, STATUS_CANNOT_READ, "%s %s: the program cannot be run once more",
                         program != NULL ? program : "impactlab", words[1]);
    }
    free(program);
    return code;
}

// All figures of the thesis as `impactlab figures` draws them, into a folder that is then removed.
static status measure_figures(const benchmark *b, double *value, fault *f)
{
    (void)b;
    const char *place = getenv("TMPDIR");
    char folder[4000];
    snprintf(folder, sizeof folder, "%s/impactlab-bench-XXXXXX",
             place && place[0] ? place : "/tmp");
    if (mkdtemp(folder) == NULL) {
        return fault_set(f, STATUS_CANNOT_WRITE, "no folder for the figures can be made as '%s'",
                         folder);
    }

    const double start = bench_computing_time();
    const status code = run_program((char *[]){"impactlab", "figures", "-o", folder, NULL}, f);
    *value = bench_computing_time() - start;
    nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
    return code;
}

// A start of the program that does nothing but say its version: computing time of the process [ms].
static status measure_start(const benchmark *b, double *value, fault *f)
{
    (void)b;
    enum { STARTS = 40 };
    const double start = bench_computing_time();
    status code = STATUS_OK;
    for (int i = 0; i < STARTS && code == STATUS_OK; i++) {
        code = run_program((char *[]){"impactlab", "--version", NULL}, f);
    }
    *value = 1e3 * (bench_computing_time() - start) / STARTS;
    return code;
}

// A run of a sweep of voltages, on one thread into a database that is removed afterwards.
static status measure_sweep(const benchmark *b, double *value, fault *f)
{
    (void)b;
    char vary[] = "motor.voltage=0.5:1.5:2000", *varied[] = {vary};
    char path[] = "/tmp/impactlab-bench-XXXXXX";
    static char name[] = "bench", none[] = "";
    scenario s = {.name = name, .file = none, .title = none, .description = none};
    const sweep_request request = {.vary = varied, .vary_count = 1};
    const sweep_options options = {.jobs = 1};
    const int file = mkstemp(path);
    parameters_defaults(&s.parameters, ARM_CORRECTED);
    parameters_resolve(&s.parameters, NULL); // defaults go together
    if (file < 0) {
        return fault_set(f, STATUS_CANNOT_WRITE, "no database can be made as '%s'", path);
    }

    // from the request to the last commit
    const double start = bench_computing_time();
    sweep of;
    sweep_store *store = NULL;
    sweep_progress progress = {0};
    status code = sweep_init(&of, &s, &request, f);
    if (code == STATUS_OK) {
        code = sweep_store_open(&store, path, &of, f);
        code = code == STATUS_OK ? sweep_run(&of, store, &options, &progress, f) : code;
        sweep_store_close(store);
        sweep_finish(&of);
        *value = 1e6 * (bench_computing_time() - start) / (double)progress.total;
    }
    close(file);
    unlink(path);
    return code;
}

static const benchmark own_table[] = {
    {"sweep_us_per_run", "us", false, measure_sweep, "", 0},
    {"start_ms", "ms", false, measure_start, "", 0},
    {"figures_s", "s", false, measure_figures, "", 0},
};
enum { OWN = sizeof own_table / sizeof own_table[0], MOST = 32 };

static int benchmark_count(void)
{
    return bench_count + OWN;
}

static const benchmark *benchmark_at(int i)
{
    return i < bench_count ? &bench_table[i] : &own_table[i - bench_count];
}

// --- results --------------------------------------------------------------------------------

typedef struct baseline {
    bench_result *results;
    int count;
} baseline;

static const bench_result *find_result(const baseline *before, const char *name)
{
    for (int i = 0; i < before->count; i++) {
        if (strcmp(before->results[i].name, name) == 0) {
            return &before->results[i];
        }
    }
    return NULL;
}

static void print_head(const baseline *before)
{
    printf("%-28s %10s %10s %10s  %-8s %8s", "", "median", "min", "max", "unit", "wall/cpu");
    if (before->results != NULL) {
        printf(" %10s %8s", "baseline", "times");
    }
    printf("\n");
}

static void print_result(const benchmark *b, const bench_result *r, const baseline *before)
{
    printf("%-28s %10.4g %10.4g %10.4g  %-8s %8.2f", r->name, r->median, r->min, r->max, r->unit,
           r->wall);
    const bench_result *then = find_result(before, r->name);
    if (then != NULL) {
        printf(" %10.4g %8.2f%s", then->median, bench_slowdown(b, r, then),
               bench_is_slower(b, r, then) ? "  slower" : "");
    }
    printf("\n");
    fflush(stdout); // the next one takes a while
}

static int complain_only(const char *name)
{
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < benchmark_count(); i++) {
        nearest_try(&near, benchmark_at(i)->name);
    }
    if (near.best != NULL) {
        return complain("there is no benchmark '%s', did you mean '%s'?", name, near.best);
    }
    return complain("there is no benchmark '%s' (see impactlab bench --help)", name);
}

// Measures all benchmarks, or the one asked for.
static int measure_all(const arguments *a, const baseline *before)
{
    bench_result results[MOST];
    int count = 0;
    bool aloud = summary_wanted(a);

    for (int i = 0; i < benchmark_count() && count < MOST; i++) {
        const benchmark *b = benchmark_at(i);
        fault f = {0};
        if (a->only != NULL && strcmp(a->only, b->name) != 0) {
            continue;
        }

        if (bench_run(b, &results[count], &f) != STATUS_OK) {
            return complain_fault(&f);
        }

        if (aloud && count == 0) {
            print_head(before);
        }
        if (aloud) {
            print_result(b, &results[count], before);
        }
        count++;
    }

    if (count == 0) {
        return complain_only(a->only);
    }
    return a->json != NULL ? write_json(a->json, bench_export(results, count)) : EXIT_DONE;
}

// --- the cost of a step over the number of links --------------------------------------------

enum { LENGTHS = 10 }; // 2, 4, 8 ... 1024 links

typedef struct scaling {
    double links[LENGTHS], free_us[LENGTHS], contact_us[LENGTHS], target_us[LENGTHS];
} scaling;

#define TARGET_PER_LINK 0.25 // [us]

static status measure_scaling(scaling *s, bool aloud, fault *f)
{
    if (aloud) {
        printf("\n%-8s %16s %16s   us for an implicit step of 1 ms\n", "links", "free flight",
               "contact");
    }

    for (int i = 0; i < LENGTHS; i++) {
        int links = 2 << i;
        s->links[i] = links;
        s->target_us[i] = TARGET_PER_LINK * links;
        status code = bench_step_cost(links, &s->free_us[i], &s->contact_us[i], f);
        if (code != STATUS_OK) {
            return code;
        }

        if (aloud) {
            printf("%-8d %16.4g %16.4g   (%.3f and %.3f a link)\n", links, s->free_us[i],
                   s->contact_us[i], s->free_us[i] / links, s->contact_us[i] / links);
            fflush(stdout);
        }
    }
    return STATUS_OK;
}

static int plot_scaling(const arguments *a)
{
    scaling s;
    fault f = {0};
    char software[64];
    if (measure_scaling(&s, summary_wanted(a), &f) != STATUS_OK) {
        return complain_fault(&f);
    }

    const figure_series series[] = {
        {.name = "free",
         .label = "free flight",
         .x = s.links,
         .y = s.free_us,
         .count = LENGTHS,
         .colour = 0,
         .marker = MARKER_CIRCLE},
        {.name = "contact",
         .label = "contact",
         .x = s.links,
         .y = s.contact_us,
         .count = LENGTHS,
         .colour = 5,
         .marker = MARKER_SQUARE},
        {.name = "target",
         .label = "0.25 µs a link",
         .x = s.links,
         .y = s.target_us,
         .count = LENGTHS,
         .colour = 7,
         .secondary = true},
    };

    const figure_panel panel = {.y = {.name = "step",
                                      .label = "Time for a step of 1\u2009ms",
                                      .unit = "µs",
                                      .scale = SCALE_LOGARITHMIC},
                                .series = series,
                                .series_count = 3,
                                .weight = 2.4};

    snprintf(software, sizeof software, "impactlab %s", lab_version());
    const figure fig = {.title = "Cost of an implicit step over the number of links",
                        .x = {.name = "links",
                              .label = "Number of links <i>N</i>",
                              .scale = SCALE_LOGARITHMIC,
                              .room = 0.04},
                        .panels = &panel,
                        .panel_count = 1,
                        .software = software,
                        .parameters = "impactlab bench --plot"};
    return publish_figure(a, &fig);
}

static int bench(const arguments *a)
{
    baseline before = {NULL, 0};
    fault f = {0};
    int result = EXIT_DONE;

    if (a->baseline != NULL &&
        bench_read(a->baseline, &before.results, &before.count, &f) != STATUS_OK) {
        result = complain_fault(&f);
    }

    if (result == EXIT_DONE) {
        result = measure_all(a, &before);
    }
    if (result == EXIT_DONE && a->plot != NULL) {
        result = plot_scaling(a);
    }
    free(before.results);
    return result;
}

static const option_row rows[] = {
    OPTION(TEXT, "only", "NAME", "measure this one alone", PLACE(only)),
    OPTION(FILE, "baseline", "FILE", "compare with what --json wrote before", PLACE(baseline)),
};
static const option_table options = OPTION_TABLE("Options", rows);

const command bench_command = {
    .name = "bench",
    .group = GROUP_PROGRAM,
    .operands = "",
    .summary = "How fast the lab computes on this machine",
    .help =
        "Medians of repeated measurements, in computing time of one processor\n(of the batch: by "
        "the clock).\n\n"
        "  arm_n2_us_per_ms            two links, 1 s of 1 V into the wall, nothing recorded\n"
        "  arm_n2_rows_us_per_ms       the same with a row kept for each millisecond\n"
        "  spring_hub_us_per_ms        the same with a hub on a stiff spring of its own\n"
        "  rig_n2_us_per_ms            the same under the hybrid law with its noisy sensors, 200 "
        "Hz\n"
        "  csv_us_per_row              a row of those as CSV\n"
        "  struck_n8_us_per_ms         chains that strike the wall and bounce, to 50 ms; also of\n"
        "                              20, 42, 64 and 128 links\n"
        "  arm_n128_free_us_per_ms     128 links in free flight, implicit steps of 1 ms\n"
        "  arm_n128_contact_us_per_ms  128 links pressing on the wall, the same steps\n"
        "  batch_n2_steps_per_s        steps of many runs of two links, on all processors\n"
        "  batch_width_8_us_per_run    a run of them in vectors of eight arms; also of 1, 2, 4\n"
        "  sweep_us_per_run            a run of a sweep with its row in the database\n"
        "  predict_us                  one prediction of the peak force, two links\n"
        "  tables_s                    Tables 4.1 to 4.3 of the thesis\n"
        "  start_ms                    a start of the program that says its version\n"
        "  figures_s                   the figures of the thesis as PNG\n\n"
        "us_per_ms is microseconds of computing per simulated millisecond. --baseline marks as "
        "slower\nwhat takes 15 % longer than before and did so in every measurement. --plot "
        "then draws the time of a\nstep over the number of links, 2 to 1024.\n",
    .options = {&json_options, &options, &drawn_options, &quiet_options, &page_options},
    .run = bench,
};
