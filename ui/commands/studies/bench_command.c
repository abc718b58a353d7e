// impactlab bench: how long runs and studies take, beside times measured before.
#include "ui/commands/command.h"

#include <stdio.h>
#include <string.h>

#include "src/base/words.h"
#include "src/study/bench.h"
#include "ui/commands/interrupts.h"
#include "ui/commands/results.h"

static void print_headings(bool with_baseline)
{
    printf("%-28s %10s %10s %10s  %-8s %8s", "", "median", "min", "max", "unit",
           "wall/cpu");
    if (with_baseline) {
        printf("   baseline    times");
    }
    printf("\n");
}

// A line of the table, beside the median measured before if that is known (not 0).
static void print_benchmark(const benchmark *b, const bench_result *r, double before)
{
    printf("%-28s %10.4g %10.4g %10.4g  %-8s %8.2f", b->name, r->median, r->min, r->max,
           b->unit, r->wall);
    if (before > 0) {
        printf(" %10.4g %8.2f", before, bench_slowdown(b, r->median, before));
        if (bench_is_slower(b, r, before)) {
            printf("  slower");
        }
    }
    printf("\n");
    fflush(stdout); // the next one takes a while
}

// Reports that --only names no benchmark. Returns the exit status.
static int complain_benchmark(const char *name)
{
    nearest_word near = nearest_begin(name);
    for (int i = 0; i < BENCHMARKS; i++) {
        nearest_try(&near, bench_table[i].name);
    }
    if (near.best != NULL) {
        return complain("there is no benchmark '%s', did you mean '%s'?", name,
                        near.best);
    }
    return complain("there is no benchmark '%s' (see impactlab bench --help)", name);
}

static bool is_asked_for(const arguments *a, const benchmark *b)
{
    return a->only == NULL || strcmp(a->only, b->name) == 0;
}

// Measures the benchmarks that are asked for. STATUS_STOPPED after an interrupt, with the
// results of those that were measured.
static status measure_benchmarks(const arguments *a, bench_result results[BENCHMARKS],
                                 fault *f)
{
    double before[BENCHMARKS] = {0};
    if (a->baseline != NULL) {
        TRY(bench_read(a->baseline, before, f));
    }

    // one after the other, each with its line as soon as it is known
    bool any_printed = false;
    for (int i = 0; i < BENCHMARKS; i++) {
        const benchmark *b = &bench_table[i];
        if (!is_asked_for(a, b)) {
            continue;
        }
        const status code = bench_run(b, &results[i], f);
        if (interrupted != 0) {
            results[i] = (bench_result){.median = 0}; // of work that was cut off
            return STATUS_STOPPED;
        }
        TRY(code);

        if (summary_wanted(a)) {
            if (!any_printed) {
                print_headings(a->baseline != NULL);
            }
            print_benchmark(b, &results[i], before[i]);
            any_printed = true;
        }
    }
    return STATUS_OK;
}

static json_t *benchmarks_json(const void *found)
{
    return bench_export(found);
}

// The command: measures what is asked for, and writes the times.
static int measure_and_report(const arguments *a)
{
    bool any = false;
    for (int i = 0; i < BENCHMARKS; i++) {
        any = any || is_asked_for(a, &bench_table[i]);
    }
    if (!any) {
        return complain_benchmark(a->only);
    }

    // times, of which an interrupt leaves those that are known
    static const command_results written = {.json = benchmarks_json};
    bench_result results[BENCHMARKS] = {{0}};
    fault f = {0};
    interrupts_catch();
    const status code = measure_benchmarks(a, results, &f);
    if (code != STATUS_OK && code != STATUS_STOPPED) {
        return complain_fault(&f);
    }

    int result = write_results(a, &written, results, code == STATUS_OK);
    if (code == STATUS_STOPPED) {
        complain("stopped: the results are those of the benchmarks that were measured");
        result = worse(result, EXIT_FAILED);
    }
    return result;
}

static const option_row rows[] = {
    OPTION(TEXT, "only", "NAME", "measure this one alone", PLACE(only)),
    OPTION(FILE, "baseline", "FILE", "compare with what --json wrote before",
           PLACE(baseline)),
};

const command bench_command = {
    .name = "bench",
    .group = GROUP_PROGRAM,
    .summary = "How fast the lab computes on this machine",
    .operands = "",
    .help =
        "Medians of repeated measurements, in computing time of one processor (of the "
        "batch: by the clock).\n\n"
        "  arm_n2_us_per_ms            two links, 1 s of 1 V into the wall, nothing "
        "recorded\n"
        "  arm_n2_rows_us_per_ms       the same with a row kept for each millisecond\n"
        "  spring_hub_us_per_ms        the same with a hub on a stiff spring of its own\n"
        "  rig_n2_us_per_ms            the same under the hybrid law with its noisy "
        "sensors, 200 Hz\n"
        "  struck_n8_us_per_ms         chains that strike the wall and bounce, to 50 ms; "
        "also of\n"
        "                              20, 42, 64 and 128 links\n"
        "  batch_n2_steps_per_s        steps of many runs of two links, on all "
        "processors\n"
        "  batch_width_8_us_per_run    a run of them in vectors of eight arms; also of "
        "1, 2, 4\n"
        "  sweep_us_per_run            a run of a sweep with its row in the database\n"
        "  tables_s                    Tables 4.1 to 4.3 of the thesis\n"
        "  start_ms                    a start of the program that says its version\n"
        "  figures_s                   the figures of the thesis as PNG\n\n"
        "us_per_ms is microseconds of computing per simulated millisecond. --baseline "
        "marks as slower what takes 15 % longer than before and did so in every "
        "measurement.\n",
    .options = {&json_options, OWN_OPTIONS(rows), &quiet_options},
    .run = measure_and_report,
};
