#include "src/study/bench.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "src/base/numbers.h"
#include "src/base/clock.h"
#include "src/base/json.h"

#define PATIENCE      1.0  // after so long three repetitions have to do [s]
#define LONG_PATIENCE 20.0 // and then one [s]
#define SLOWER        1.15 // by the medians

double bench_computing_time(void)
{
    struct rusage started;
    getrusage(RUSAGE_CHILDREN, &started);
    const double seconds = (double)(started.ru_utime.tv_sec + started.ru_stime.tv_sec);
    const double micro = (double)(started.ru_utime.tv_usec + started.ru_stime.tv_usec);
    return clock_seconds(CLOCK_PROCESS_CPUTIME_ID) + seconds + 1e-6 * micro;
}

double bench_seconds_per_call(status (*work)(void *context), void *context, double least,
                              status *failed)
{
    assert(work != NULL && least > 0 && failed != NULL);
    double start = bench_computing_time(), elapsed = 0;
    long calls = 0, batch = 1;
    *failed = STATUS_OK;

    // batches that double: looking at the clock costs as much as a short call
    for (; elapsed < least; batch *= 2) {
        for (long i = 0; i < batch && *failed == STATUS_OK; i++) {
            *failed = work(context);
        }
        if (*failed != STATUS_OK) {
            return (double)NAN;
        }
        calls += batch;
        elapsed = bench_computing_time() - start;
    }
    return elapsed / (double)calls;
}

status bench_run(const benchmark *b, bench_result *result, fault *f)
{
    assert(b != NULL && result != NULL);
    double values[BENCH_REPETITIONS], start = bench_computing_time(), value, elapsed = 0;
    const double start_wall = clock_seconds(CLOCK_MONOTONIC);
    int count = 0;

    // as many times as patience allows
    for (int i = 0; count < BENCH_REPETITIONS; i++) {
        status code = b->measure(b, &value, f);
        if (code != STATUS_OK) {
            return code;
        }
        elapsed = bench_computing_time() - start;

        // the first one only warms the caches, but where it is long that makes no difference
        if (i > 0 || elapsed > PATIENCE) {
            values[count++] = value;
        }
        if ((count >= 3 && elapsed > PATIENCE) || (count >= 1 && elapsed > LONG_PATIENCE)) {
            break;
        }
    }

    // median and extremes
    qsort(values, (size_t)count, sizeof values[0], compare_numbers);
    snprintf(result->name, sizeof result->name, "%s", b->name);
    snprintf(result->unit, sizeof result->unit, "%s", b->unit);
    result->median = 0.5 * (values[(count - 1) / 2] + values[count / 2]);
    result->min = values[0];
    result->max = values[count - 1];
    result->wall = (clock_seconds(CLOCK_MONOTONIC) - start_wall) / elapsed;
    return STATUS_OK;
}

double bench_slowdown(const benchmark *b, const bench_result *now, const bench_result *before)
{
    assert(b != NULL && now != NULL && before != NULL);
    return b->more_is_better ? before->median / now->median : now->median / before->median;
}

bool bench_is_slower(const benchmark *b, const bench_result *now, const bench_result *before)
{
    bool every_one = b->more_is_better ? now->max < before->median : now->min > before->median;
    return every_one && bench_slowdown(b, now, before) > SLOWER;
}

// --- files ----------------------------------------------------------------------------------

json_t *bench_export(const bench_result *results, int count)
{
    assert(results != NULL || count == 0);
    json_t *object = json_object(), *array = json_array();

    // with its extremes, as one number says little about a machine
    for (int i = 0; i < count; i++) {
        json_t *entry = json_object();
        json_put(entry, "name", json_string(results[i].name));
        json_put(entry, "unit", json_string(results[i].unit));
        json_put(entry, "median", json_number(results[i].median));
        json_put(entry, "min", json_number(results[i].min));
        json_put(entry, "max", json_number(results[i].max));
        json_put(entry, "wall_per_cpu", json_number(results[i].wall));
        json_add(array, entry);
    }
    json_put(object, "bench", array);
    return object;
}

static bool read_entry(json_t *entry, bench_result *result)
{
    const char *name = json_string_value(json_object_get(entry, "name"));
    const char *unit = json_string_value(json_object_get(entry, "unit"));
    if (name == NULL || unit == NULL) {
        return false;
    }
    snprintf(result->name, sizeof result->name, "%s", name);
    snprintf(result->unit, sizeof result->unit, "%s", unit);
    result->median = json_number_value(json_object_get(entry, "median"));
    result->min = json_number_value(json_object_get(entry, "min"));
    result->max = json_number_value(json_object_get(entry, "max"));
    return result->median > 0;
}

status bench_read(const char *path, bench_result **results, int *count, fault *f)
{
    assert(path != NULL && results != NULL && count != NULL);
    json_error_t error;
    json_t *root = json_load_file(path, 0, &error), *array = json_object_get(root, "bench");
    *results = NULL;
    *count = (int)json_array_size(array);

    if (root == NULL) {
        return fault_set(f, STATUS_CANNOT_READ, "%s:%d:%d: %s, expected what bench --json writes",
                         path, error.line > 0 ? error.line : 1, error.column > 0 ? error.column : 1,
                         error.text);
    }

    // its entries
    bench_result *read = calloc((size_t)*count + 1, sizeof *read);
    status code = read == NULL ? STATUS_NO_MEMORY : STATUS_OK;
    if (read == NULL) {
        fault_set(f, code, "%s", status_text(code));
    } else if (!json_is_array(array)) {
        code = fault_set(f, STATUS_CANNOT_READ,
                         "%s: there is no list \"bench\", expected what bench --json writes", path);
    }

    for (int i = 0; i < *count && code == STATUS_OK; i++) {
        if (!read_entry(json_array_get(array, (size_t)i), &read[i])) {
            code = fault_set(f, STATUS_CANNOT_READ,
                             "%s: entry %d of \"bench\" has no name, unit and positive median",
                             path, i + 1);
        }
    }

    json_decref(root);
    if (code != STATUS_OK) {
        free(read);
        return code;
    }
    *results = read;
    return STATUS_OK;
}
