#include "src/study/bench.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "src/study/batch.h"
#include "src/run/run.h"
#include "src/study/thesis_tables.h"
#include "src/predict/linearised.h"
#include "src/solve/contact_machine.h"
#include "src/base/clock.h"
#include "src/base/json.h"

#define LEAST_TIME    0.01 // of one measurement [s]
#define PATIENCE      1.0  // after so long three repetitions have to do [s]
#define LONG_PATIENCE 20.0 // and then one [s]
#define SLOWER        1.15 // by the medians
#define CHAIN_STEP    1e-3 // [s]

double bench_computing_time(void)
{
    return clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
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

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

status bench_run(const benchmark *b, bench_result *result, fault *f)
{
    assert(b != NULL && result != NULL);
    double values[BENCH_REPETITIONS], start = bench_computing_time(), value, elapsed = 0;
    int count = 0;

    // as many times as patience allows
    for (int i = 0; count < BENCH_REPETITIONS; i++) {
        status code = b->measure(&value, f);
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
    qsort(values, (size_t)count, sizeof values[0], compare);
    snprintf(result->name, sizeof result->name, "%s", b->name);
    snprintf(result->unit, sizeof result->unit, "%s", b->unit);
    result->median = 0.5 * (values[(count - 1) / 2] + values[count / 2]);
    result->min = values[0];
    result->max = values[count - 1];
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
        json_object_set_new(entry, "name", json_string(results[i].name));
        json_object_set_new(entry, "unit", json_string(results[i].unit));
        json_object_set_new(entry, "median", json_number(results[i].median));
        json_object_set_new(entry, "min", json_number(results[i].min));
        json_object_set_new(entry, "max", json_number(results[i].max));
        json_array_append_new(array, entry);
    }
    json_object_set_new(object, "bench", array);
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

// --- the arms that are timed ----------------------------------------------------------------

// Resolved parameters of the corrected arm with the given settings, a list that ends with NULL.
static status timed_parameters(parameters *p, const char *const (*settings)[2], fault *f)
{
    parameters_defaults(p, ARM_CORRECTED);
    for (int i = 0; settings[i][0] != NULL; i++) {
        status code = parameter_set_text(p, parameter_index(settings[i][0]), settings[i][1], f);
        if (code != STATUS_OK) {
            return code;
        }
    }
    return parameters_resolve(p, f);
}

static status run_once(void *context)
{
    run_result result;
    status code = run_scenario(context, false, &result);
    run_finish(&result);
    return code;
}

// Computing time of a run with the given settings for each simulated millisecond [us].
static status time_run(const char *const (*settings)[2], double *value, fault *f)
{
    char name[] = "bench", none[] = "";
    scenario s = {.name = name, .file = none, .title = none, .description = none};
    status code = timed_parameters(&s.parameters, settings, f);
    if (code != STATUS_OK) {
        return code;
    }
    double seconds = bench_seconds_per_call(run_once, &s, LEAST_TIME, &code);
    *value = 1e6 * seconds / (1e3 * s.parameters.run.duration);
    return code == STATUS_OK ? code : fault_set(f, code, "the run failed: %s", status_text(code));
}

// 1 s of two links at 1 V into the wall: the defaults.
static status measure_arm_n2(double *value, fault *f)
{
    static const char *const settings[][2] = {{NULL, NULL}};
    return time_run(settings, value, f);
}

// The same arm on the rig, under a law that samples its noisy sensors 200 times a second and hardly
// ever gives the same command twice.
static status measure_rig_n2(double *value, fault *f)
{
    static const char *const settings[][2] = {{"control.law", "hybrid"}, {NULL, NULL}};
    return time_run(settings, value, f);
}

// A stretch of a motion that can be gone through again and again.
typedef struct stretch {
    arm arm;
    motion *motion;
    double *start; // the state at its beginning
    double to;     // its end [s]
} stretch;

static status go(const arm *a, motion *m, double until)
{
    status code = STATUS_OK;
    while (code == STATUS_OK && m->state[SLOT_TIME] < until) {
        motion_report report;
        code = motion_step(a, m, until, CHAIN_STEP, &report);
        if (code == STATUS_OK && report.event != MOTION_REACHED) {
            motion_apply(a, m, &report);
        }
    }
    return code;
}

static status pass_stretch(void *context)
{
    stretch *s = context;
    memcpy(s->motion->state, s->start, (size_t)s->motion->size * sizeof *s->start);
    return go(&s->arm, s->motion, s->to);
}

// Computing time of a step of 1 ms between two instants of the motion [s].
static status time_stretch(const parameters *p, double from, double to, double *seconds, fault *f)
{
    stretch s = {.to = to};
    arm_init(&s.arm, p);
    s.motion = motion_create(&s.arm, &p->method);
    s.start = s.motion != NULL ? malloc((size_t)s.motion->size * sizeof *s.start) : NULL;

    // to its beginning, and then through it again and again
    status code = STATUS_NO_MEMORY;
    if (s.start != NULL) {
        motion_start(&s.arm, s.motion, p->initial.angle, p->initial.velocity);
        code = go(&s.arm, s.motion, from);
        memcpy(s.start, s.motion->state, (size_t)s.motion->size * sizeof *s.start);
        if (code == STATUS_OK) {
            *seconds = bench_seconds_per_call(pass_stretch, &s, LEAST_TIME, &code);
            *seconds /= (to - from) / CHAIN_STEP;
        }
    }

    free(s.start);
    motion_destroy(s.motion);
    return code == STATUS_OK ? code
                             : fault_set(f, code, "a chain of %d links between %g and %g s: %s",
                                         p->arm.links, from, to, status_text(code));
}

// In free flight the chain has left its start behind; it touches at about 0.3 s. After 0.7 s a long
// chain stays on the wall; two links then are held by friction, which costs nothing, so their first
// contact is taken, before the hub sticks.
static status time_chain(int links, bool contact, double *seconds, fault *f)
{
    char count[16];
    const char *const settings[][2] = {{"arm.links", count},
                                       {"wall.kind", "plane"},
                                       {"method.name", "generalized-alpha"},
                                       {NULL, NULL}};
    parameters p;
    snprintf(count, sizeof count, "%d", links);
    status code = timed_parameters(&p, settings, f);
    double from = !contact ? 0.05 : links == 2 ? 0.30 : 0.7;
    double to = !contact ? 0.25 : links == 2 ? 0.36 : 0.9;
    return code == STATUS_OK ? time_stretch(&p, from, to, seconds, f) : code;
}

status bench_step_cost(int links, double *free_us, double *contact_us, fault *f)
{
    assert(links > 0 && free_us != NULL && contact_us != NULL);
    double seconds[2];
    for (int contact = 0; contact < 2; contact++) {
        seconds[contact] = (double)INFINITY;

        // the best of three: what a passing disturbance adds is no cost of the step
        for (int i = 0; i < 3; i++) {
            double one;
            status code = time_chain(links, contact, &one, f);
            if (code != STATUS_OK) {
                return code;
            }
            seconds[contact] = fmin(seconds[contact], one);
        }
    }

    *free_us = 1e6 * seconds[0];
    *contact_us = 1e6 * seconds[1];
    return STATUS_OK;
}

static status measure_arm_n128_free(double *value, fault *f)
{
    status code = time_chain(128, false, value, f);
    *value *= 1e6;
    return code;
}

static status measure_arm_n128_contact(double *value, fault *f)
{
    status code = time_chain(128, true, value, f);
    *value *= 1e6;
    return code;
}

typedef struct touching {
    arm arm;
    motion *motion;
    const double *q, *w;
} touching;

static status predict_once(void *context)
{
    touching *t = context;
    prediction p;
    return predict_linearised(&t->arm, t->motion, t->q, t->w, &p);
}

// The predictor at the instant before the first contact of two links at 1 V.
static status measure_predict(double *value, fault *f)
{
    char name[] = "bench", none[] = "";
    scenario s = {.name = name, .file = none, .title = none, .description = none};
    static const char *const settings[][2] = {{NULL, NULL}};
    status code = timed_parameters(&s.parameters, settings, f);
    if (code != STATUS_OK) {
        return code;
    }

    // a run tells the state before its first impact
    run_result result;
    code = run_scenario(&s, false, &result);
    touching t = {.q = result.before_impact,
                  .w = result.before_impact ? result.before_impact + 2 : NULL};

    // the prediction there
    arm_init(&t.arm, &s.parameters);
    t.motion = motion_create(&t.arm, &s.parameters.method);
    if (t.motion == NULL || result.before_impact == NULL) {
        code = STATUS_NO_MEMORY;
    }
    if (code == STATUS_OK) {
        *value = 1e6 * bench_seconds_per_call(predict_once, &t, LEAST_TIME, &code);
    }

    motion_destroy(t.motion);
    run_finish(&result);
    return code == STATUS_OK ? code
                             : fault_set(f, code, "the prediction failed: %s", status_text(code));
}

// Runs of the batch: 1 s of two links into the wall with voltages from 0.5 to 1.5 V.
enum { BATCH_RUNS = 256 };

static void make_batch_run(void *context, size_t i, scenario *made)
{
    *made = *(const scenario *)context;
    made->parameters.motor.voltage = 0.5 + (double)i / BATCH_RUNS;
}

// Time steps of all runs together for a second by the clock, on as many threads as processors.
static status measure_batch(double *value, fault *f)
{
    char name[] = "bench", none[] = "";
    scenario s = {.name = name, .file = none, .title = none, .description = none};
    static const char *const settings[][2] = {{NULL, NULL}};
    status code = timed_parameters(&s.parameters, settings, f);
    summary *summaries = malloc(BATCH_RUNS * sizeof *summaries);
    if (code != STATUS_OK || summaries == NULL) {
        free(summaries);
        return code != STATUS_OK ? code : fault_set(f, STATUS_NO_MEMORY, "no memory for a batch");
    }

    // all of it, by the clock
    double start = clock_seconds(CLOCK_MONOTONIC), steps = 0;
    int threads = (int)sysconf(_SC_NPROCESSORS_ONLN);
    code = batch_run(make_batch_run, &s, BATCH_RUNS, threads, summaries);
    double elapsed = clock_seconds(CLOCK_MONOTONIC) - start;

    // the steps that were made
    for (int i = 0; i < BATCH_RUNS && code == STATUS_OK; i++) {
        steps += summaries[i].steps;
        code = summaries[i].status;
    }
    free(summaries);
    *value = steps / elapsed;
    return code == STATUS_OK
               ? code
               : fault_set(f, code, "a run of the batch failed: %s", status_text(code));
}

static status measure_tables(double *value, fault *f)
{
    thesis_tables t;
    double start = bench_computing_time();
    status code = tables_compute(&t, f);
    *value = bench_computing_time() - start;
    return code;
}

const benchmark bench_table[] = {
    {"arm_n2_us_per_ms", "us/ms", false, measure_arm_n2},
    {"rig_n2_us_per_ms", "us/ms", false, measure_rig_n2},
    {"arm_n128_free_us_per_ms", "us/ms", false, measure_arm_n128_free},
    {"arm_n128_contact_us_per_ms", "us/ms", false, measure_arm_n128_contact},
    {"batch_n2_steps_per_s", "1/s", true, measure_batch},
    {"predict_us", "us", false, measure_predict},
    {"tables_s", "s", false, measure_tables},
};
const int bench_count = (int)(sizeof bench_table / sizeof bench_table[0]);
