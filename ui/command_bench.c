#include "ui/command.h"

#include <stdlib.h>
#include <time.h>

enum { REPETITIONS = 15 };

static double now_s(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

typedef struct measurement {
    double median, min, max;
} measurement;

// Computing time per simulated millisecond [us], over REPETITIONS runs after a first one.
static status measure(const scenario *s, measurement *m, fault *f)
{
    double times[REPETITIONS];
    for (int i = -1; i < REPETITIONS; i++) {
        run_result result;
        double start = now_s();
        status code = run_scenario(s, false, &result);
        double elapsed = now_s() - start;
        if (code != STATUS_OK) {
            fault_set(f, code, "the benchmark's run failed: %s", result.summary.message);
        }
        run_finish(&result);
        if (code != STATUS_OK) {
            return code;
        }
        // the first run only warms the caches
        if (i >= 0) {
            times[i] = 1e6 * elapsed / (1e3 * s->parameters.run.duration);
        }
    }
    qsort(times, REPETITIONS, sizeof times[0], compare);
    *m = (measurement){times[REPETITIONS / 2], times[0], times[REPETITIONS - 1]};
    return STATUS_OK;
}

static json_t *bench_object(const char *name, const char *unit, const measurement *m)
{
    json_t *object = json_object(), *array = json_array(), *entry = json_object();
    json_object_set_new(entry, "name", json_string(name));
    json_object_set_new(entry, "unit", json_string(unit));
    json_object_set_new(entry, "median", json_number(m->median));
    json_object_set_new(entry, "min", json_number(m->min));
    json_object_set_new(entry, "max", json_number(m->max));
    json_array_append_new(array, entry);
    json_object_set_new(object, "bench", array);
    return object;
}

static int bench(const arguments *a)
{
    char name[] = "bench", none[] = "";
    scenario s = {.name = name, .file = none, .title = none, .description = none};
    measurement m;
    fault f = {0};
    int result = check_output(a->json);
    if (result != EXIT_DONE) {
        return result;
    }
    // two links, 1 s of 1 V into the wall: the defaults
    parameters_defaults(&s.parameters, ARM_CORRECTED);
    if (parameters_resolve(&s.parameters, &f) != STATUS_OK || measure(&s, &m, &f) != STATUS_OK) {
        return complain_fault(&f);
    }
    if (a->json != NULL) {
        result = write_json(a->json, bench_object("arm_n2_us_per_ms", "us/ms", &m));
    }
    if (summary_wanted(a)) {
        printf("%-20s  %10s %10s %10s\n", "computing time", "median", "min", "max");
        printf("%-20s  %10.3g %10.3g %10.3g  us per simulated ms\n", "arm_n2_us_per_ms", m.median,
               m.min, m.max);
    }
    return result;
}

const command bench_command = {
    .name = "bench",
    .operands = "",
    .options = "jq",
    .summary = "How fast the lab computes on this machine",
    .help = "arm_n2_us_per_ms: corrected model, two links, 1 s of 1 V into the wall, nothing "
            "recorded; microseconds\nof computing per simulated millisecond.\n",
    .run = bench,
};
