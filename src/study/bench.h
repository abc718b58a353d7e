// Benchmarks: medians of repeated measurements, and their comparison with stored ones.
//
// Times are computing times of this process, which bear a busy machine better than the
// clock on the wall; only work on several threads is timed by that clock.
#pragma once

#include <jansson.h>

#include <stdbool.h>

#include "src/base/fault.h"

enum { BENCHMARKS = 18, BENCH_REPETITIONS = 11 };

// Something that can be measured.
typedef struct benchmark benchmark;
struct benchmark {
    const char *name;    // "arm_n2_us_per_ms"
    const char *unit;    // "us/ms"
    bool more_is_better; // a rate instead of a time
    status (*measure)(const benchmark *b, double *value, fault *f); // once, in `unit`
    const char *of; // a scenario, or words of the program
    int number;     // and a number that tells it from its like
};
extern const benchmark bench_table[BENCHMARKS];

// What came out of it.
typedef struct bench_result {
    double median, min, max; // 0: not measured
    double
        wall; // time by the clock for each second of computing time: 1 on an idle machine
} bench_result;

// Computing time that one measurement of short work goes on for, 0.5 [s]; a test takes
// less.
extern double bench_window;

// Computing time of the process, and of those it has waited for, that one call of
// work(context) takes [s]: it is repeated until `least` seconds have passed. *failed is
// the first code that is not STATUS_OK, at which it stops.
double bench_seconds_per_call(status (*work)(void *context), void *context, double least,
                              status *failed);

// Measures BENCH_REPETITIONS times after a first time that only warms the caches. Long
// work is measured less often: three times in all if one second is exceeded, once if
// twenty are.
status bench_run(const benchmark *b, bench_result *result, fault *f);

// The object of `bench --json`, of what was measured: {"bench": [{"name", "unit",
// "median", "min", "max", "wall_per_cpu"}]}.
json_t *bench_export(const bench_result results[BENCHMARKS]);

// Reads the medians of such a file, 0 of what is not in it. STATUS_CANNOT_READ if it
// cannot be read or holds no benchmarks.
status bench_read(const char *path, double medians[BENCHMARKS], fault *f);

// How many times slower a value is than one of before; below 1: faster.
double bench_slowdown(const benchmark *b, double now, double before);

// Whether that is more than noise: by the medians 15 % slower, and every single
// measurement slower than the median before.
bool bench_is_slower(const benchmark *b, const bench_result *now, double before);
