// impactlab bench: how long runs and studies take, beside times measured before.
#include "ui/commands/progress.h"

#include <string.h>

#include "src/study/bench.h"
#include "src/base/words.h"

// A line of the table, beside the median measured before if that is known (not 0).
static void print_result(const benchmark *b, const bench_result *r, double before)
{
    printf("%-28s %10.4g %10.4g %10.4g  %-8s %8.2f", b->name, r->median, r->min, r->max,
           b->unit, r->wall);
    if (before > 0) {
        printf(" %10.4g %8.2f%s", before, bench_slowdown(b, r->median, before),
               bench_is_slower(b, r, before) ? "  slower" : "");
    }
    printf("\n");
    fflush(stdout); // the next one takes a while
}

static int complain_only(const char *name)
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

RESULT_GIVEN(json_t *, results_json, bench_result, return bench_export(found))

// Measures all benchmarks, or the one asked for.
static int bench(const arguments *a)
{
    bench_result results[BENCHMARKS] = {{0}};
    double before[BENCHMARKS] = {0};
    int count = 0;
    fault f = {0};
    interrupts_catch();
    status code = STATUS_OK;
    if (a->baseline != NULL) {
        code = bench_read(a->baseline, before, &f);
    }
    for (int i = 0; i < BENCHMARKS && code == STATUS_OK; i++) {
        const benchmark *b = &bench_table[i];
        if (a->only != NULL && strcmp(a->only, b->name) != 0) {
            continue;
        }
        code = bench_run(b, &results[i], &f);
        if (interrupted != 0) {
            results[i] = (bench_result){.median = 0}; // of work that was cut off
            code = STATUS_STOPPED;
        }
        if (code == STATUS_OK && summary_wanted(a)) {
            if (count == 0) {
                printf("%-28s %10s %10s %10s  %-8s %8s%s\n", "", "median", "min", "max",
                       "unit", "wall/cpu",
                       a->baseline != NULL ? "   baseline    times" : "");
            }
            print_result(b, &results[i], before[i]);
        }
        count++;
    }
    const bool stopped = code == STATUS_STOPPED;
    if (code != STATUS_OK && !stopped) {
        return complain_fault(&f);
    }
    if (count == 0) {
        return complain_only(a->only);
    }
    static const command_results r = {results_json};
    const int result = write_results(a, &r, NULL, results, !stopped);
    if (!stopped) {
        return result;
    }
    complain("stopped: the results are those of the benchmarks that were measured");
    return worse(result, EXIT_FAILED);
}

static const option_row rows[] = {
    OPTION(TEXT, "only", "NAME", "measure this one alone", PLACE(only)),
    OPTION(FILE, "baseline", "FILE", "compare with what --json wrote before",
           PLACE(baseline)),
};

const command bench_command = {
    CALLED("bench", PROGRAM, "How fast the lab computes on this machine"),
    NO_OPERANDS,
    .help =
        "Medians of repeated measurements, in computing time of one processor\n(of the "
        "batch: by "
        "the clock).\n\n"
        "  arm_n2_us_per_ms            two links, 1 s of 1 V into the wall, nothing "
        "recorded\n"
        "  arm_n2_rows_us_per_ms       the same with a row kept for each millisecond\n"
        "  spring_hub_us_per_ms        the same with a hub on a stiff spring of its own\n"
        "  rig_n2_us_per_ms            the same under the hybrid law with its noisy "
        "sensors, 200 "
        "Hz\n"
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
        "marks as "
        "slower\nwhat takes 15 % longer than before and did so in every measurement.\n",
    .options = {&json_options, OWN_OPTIONS(rows), &quiet_options},
    .run = bench,
};
