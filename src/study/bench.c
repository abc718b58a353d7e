#include "src/study/bench.h"

#include <assert.h>
#include <fcntl.h>
#include <ftw.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "src/base/clock.h"
#include "src/base/json.h"
#include "src/base/numbers.h"
#include "src/base/shipped.h"
#include "src/engines/pair/taylor_lanes.h"
#include "src/run/run.h"
#include "src/study/batch.h"

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
    assert(least > 0);
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
    double values[BENCH_REPETITIONS], start = bench_computing_time(), value, elapsed = 0;
    const double start_wall = clock_seconds(CLOCK_MONOTONIC);
    int count = 0;

    // as many times as patience allows
    for (int i = 0; count < BENCH_REPETITIONS; i++) {
        TRY(b->measure(b, &value, f));
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
    json_t *array = json_array();
    for (const bench_result *r = results; r < results + count; r++) {
        // with extremes, as one number says little about a machine
        json_add(array,
                 json_members(json_object(), "name:t unit:t median:n min:n max:n wall_per_cpu:n",
                              r->name, r->unit, r->median, r->min, r->max, r->wall));
    }
    return json_members(json_object(), "bench:o", array);
}

static bool read_entry(json_t *entry, bench_result *result)
{
    const char *name, *unit;
    if (json_unpack(entry, "{s:s, s:s}", "name", &name, "unit", &unit) != 0) {
        return false;
    }
    snprintf(result->name, sizeof result->name, "%s", name);
    snprintf(result->unit, sizeof result->unit, "%s", unit);
    result->median = json_number_value(json_object_get(entry, "median"));
    result->min = json_number_value(json_object_get(entry, "min"));
    result->max = json_number_value(json_object_get(entry, "max"));
    result->wall = json_number_value(json_object_get(entry, "wall_per_cpu"));
    return result->median > 0;
}

status bench_read(const char *path, bench_result **results, int *count, fault *f)
{
    json_error_t error;
    json_t *root = json_load_file(path, 0, &error), *array = json_object_get(root, "bench");
    *results = NULL;
    *count = (int)json_array_size(array);
    FAIL_IF(root == NULL,
            fault_set(f, STATUS_CANNOT_READ, "%s:%d:%d: %s, expected what bench --json writes",
                      path, error.line > 0 ? error.line : 1, error.column > 0 ? error.column : 1,
                      error.text));

    // its entries
    bench_result *read = calloc((size_t)*count + 1, sizeof *read);
    status code = read == NULL ? fault_no_memory(f) : STATUS_OK;
    if (read != NULL && !json_is_array(array)) {
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
    if (code == STATUS_OK) {
        *results = read;
    } else {
        free(read);
    }
    return code;
}

// --- what is measured: runs and batches by the library, the rest by the program itself --------

double bench_window = 0.5;

// A scenario of the corrected arm with settings "PATH=VALUE PATH=VALUE ...", which go together; it
// owns nothing.
static scenario timed_scenario(const char *settings)
{
    static char name[] = "bench", none[] = "";
    scenario s = {.name = name, .file = none, .title = none, .description = none};
    char path[64], value[64];
    status code = STATUS_OK;
    parameters_defaults(&s.parameters, ARM_CORRECTED);
    for (int length;
         code == STATUS_OK && sscanf(settings, " %63[^=]=%63s%n", path, value, &length) == 2;
         settings += length) {
        code = parameter_set_text(&s.parameters, parameter_index(path), value, NULL);
    }
    code = code == STATUS_OK ? parameters_resolve(&s.parameters, NULL) : code;
    assert(code == STATUS_OK);
    (void)code;
    return s;
}

// What became of a benchmark, as a sentence where it failed.
static status ended(const benchmark *b, status code, fault *f)
{
    return code == STATUS_OK ? code : fault_set(f, code, "%s: %s", b->name, status_text(code));
}

// --- runs -------------------------------------------------------------------------------------

typedef struct timed_run {
    scenario scenario;
    bool rows; // kept
} timed_run;

static status run_once(void *context)
{
    const timed_run *t = context;
    run_result result;
    status code = run_scenario(&t->scenario, t->rows, &result);
    run_finish(&result);
    return code;
}

// Computing time of a run with the settings for each simulated millisecond [us]; number: 1 where a
// row is kept for each of them.
static status measure_run(const benchmark *b, double *value, fault *f)
{
    timed_run t = {timed_scenario(b->settings), b->number == 1};
    status code;
    const double seconds = bench_seconds_per_call(run_once, &t, bench_window, &code);
    *value = 1e6 * seconds / (1e3 * t.scenario.parameters.run.duration);
    return ended(b, code, f);
}

// Runs of the batch: 1 s of two links into the wall with voltages from 0.5 to 1.5 V.
enum { BATCH_RUNS = 256 };

static void make_batch_run(void *context, size_t i, scenario *made)
{
    *made = *(const scenario *)context;
    made->parameters.motor.voltage = 0.5 + (double)i / BATCH_RUNS;
}

// Of the batch, number: 0: time steps of all runs together for a second by the clock, on as many
// threads as processors [1/s]. Else the computing time of a run on one thread, in vectors of at
// most so many arms [us].
static status measure_batch(const benchmark *b, double *value, fault *f)
{
    scenario s = timed_scenario(b->settings);
    summary *summaries = malloc(BATCH_RUNS * sizeof *summaries);
    TRY_MEMORY(summaries != NULL, f);

    // over and over on one thread, as one batch is short
    const bool all = b->number == 0;
    const int threads = all ? (int)sysconf(_SC_NPROCESSORS_ONLN) : 1;
    const double start = bench_computing_time(), start_wall = clock_seconds(CLOCK_MONOTONIC);
    double elapsed = 0, steps = 0;
    long batches = 0;
    status code = STATUS_OK;
    taylor_limit_width(b->number);
    for (; code == STATUS_OK && elapsed < bench_window && (!all || batches == 0); batches++) {
        code = batch_run(make_batch_run, &s, BATCH_RUNS, threads, summaries);
        elapsed = bench_computing_time() - start;
    }
    taylor_limit_width(0);
    const double wall = clock_seconds(CLOCK_MONOTONIC) - start_wall;

    // the steps that were made
    for (int i = 0; i < BATCH_RUNS && code == STATUS_OK; i++) {
        steps += summaries[i].steps;
        code = summaries[i].status;
    }
    free(summaries);
    *value = all ? steps / wall : 1e6 * elapsed / (double)(batches * BATCH_RUNS);
    return ended(b, code, f);
}

// --- the program ------------------------------------------------------------------------------

// Runs the program with the words in the current folder, without what it prints, and waits for it.
static bool run_program(const char *program, const char *folder, const char *words)
{
    const pid_t child = fork();
    if (child == 0) {
        char text[256], *argument[16] = {text}, *rest = text;
        snprintf(text, sizeof text, "impactlab %s", words);
        for (int i = 0; i < 15 && (argument[i] = strsep(&rest, " ")) != NULL; i++) {
        }
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        if (chdir(folder) == 0) {
            execv(program, argument);
        }
        _exit(1);
    }
    int how = 0;
    return child > 0 && waitpid(child, &how, 0) == child && how == 0;
}

static int remove_entry(const char *path, const struct stat *about, int kind, struct FTW *place)
{
    (void)about;
    (void)kind;
    (void)place;
    return remove(path);
}

// Computing time of the program with settings as its words, in a folder that is removed, divided
// by number, in the benchmark's unit: s, ms or us.
static status measure_program(const benchmark *b, double *value, fault *f)
{
    const char *place = getenv("TMPDIR");
    char folder[4000], *program = shipped_path(SHIPPED_PROGRAM);
    snprintf(folder, sizeof folder, "%s/impactlab-bench-XXXXXX", place && *place ? place : "/tmp");
    if (program == NULL || mkdtemp(folder) == NULL) {
        free(program);
        return fault_set(f, STATUS_CANNOT_WRITE, "no folder '%s' can be made", folder);
    }

    const double unit = *b->unit == 's' ? 1 : *b->unit == 'm' ? 1e-3 : 1e-6;
    const double start = bench_computing_time();
    const bool done = run_program(program, folder, b->settings);
    *value = (bench_computing_time() - start) / (unit * b->number);
    nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
    free(program);
    return done ? STATUS_OK
                : fault_set(f, STATUS_CANNOT_READ, "impactlab %s: it cannot be run once more",
                            b->settings);
}

// Chains that strike the wall at 1 rad/s after 5 ms, and what comes of it up to 50 ms.
#define STRUCK(links)                                                                              \
    {                                                                                              \
        "struck_n" #links "_us_per_ms", "us/ms", false, measure_run,                               \
            "arm.links=" #links " arm.hub_joint=beam initial.angle=0.095 initial.velocity=1"       \
            " run.duration=0.05",                                                                  \
            0                                                                                      \
    }
#define WIDTH(width)                                                                               \
    {                                                                                              \
        "batch_width_" #width "_us_per_run", "us", false, measure_batch, "", width                 \
    }

// Without settings 1 s of two links at 1 V into the wall.
const benchmark bench_table[] = {
    // one run; the law samples its noisy sensors 200 times a second and hardly ever gives the same
    // command twice
    {"arm_n2_us_per_ms", "us/ms", false, measure_run, "", 0},
    {"arm_n2_rows_us_per_ms", "us/ms", false, measure_run, "", 1},
    {"spring_hub_us_per_ms", "us/ms", false, measure_run, "arm.hub_joint=spring", 0},
    {"rig_n2_us_per_ms", "us/ms", false, measure_run, "control.law=hybrid", 0},

    // many links
    STRUCK(8),
    STRUCK(20),
    STRUCK(42),
    STRUCK(64),
    STRUCK(128),

    // many runs
    {"batch_n2_steps_per_s", "1/s", true, measure_batch, "", 0},
    WIDTH(1),
    WIDTH(2),
    WIDTH(4),
    WIDTH(8),

    // the program: a sweep of voltages into a database, all tables and figures of the thesis, and
    // a start that only says its version
    {"sweep_us_per_run", "us", false, measure_program,
     "sweep corrected/first-impact --vary motor.voltage=0.5:1.5:2000 --jobs 1 --db runs.db --quiet",
     2000},
    {"tables_s", "s", false, measure_program, "tables", 1},
    {"start_ms", "ms", false, measure_program, "--version", 1},
    {"figures_s", "s", false, measure_program, "figures -o .", 1},
};
const int bench_count = (int)(sizeof bench_table / sizeof bench_table[0]);
