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
#include "src/study/batch.h"

#define PATIENCE      1.0  // computing time after which three repetitions are enough [s]
#define LONG_PATIENCE 20.0 // and after which one is [s]
#define SLOWER        1.15 // ratio of the medians above which a benchmark is slower

// Computing time so far of the process and of those it has started and waited for [s].
static double computing_time(void)
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
    const double start = computing_time();
    double elapsed = 0;
    long calls = 0;
    *failed = STATUS_OK;

    // rounds that double: looking at the clock costs as much as a short call
    for (long round = 1; elapsed < least && *failed == STATUS_OK; round *= 2) {
        for (long i = 0; i < round && *failed == STATUS_OK; i++, calls++) {
            *failed = work(context);
        }
        elapsed = computing_time() - start;
    }
    if (*failed == STATUS_OK) {
        return elapsed / (double)calls;
    }
    return (double)NAN;
}

status bench_run(const benchmark *b, bench_result *result, fault *f)
{
    double values[BENCH_REPETITIONS], start = computing_time(), value, elapsed = 0;
    const double start_wall = clock_seconds(CLOCK_MONOTONIC);
    int count = 0;

    // as many times as patience allows
    for (int i = 0; count < BENCH_REPETITIONS; i++) {
        TRY(b->measure(b, &value, f));
        elapsed = computing_time() - start;

        // the first one only warms the caches, but where it is long that makes no
        // difference
        if (i > 0 || elapsed > PATIENCE) {
            values[count++] = value;
        }
        if ((count >= 3 && elapsed > PATIENCE) ||
            (count >= 1 && elapsed > LONG_PATIENCE)) {
            break;
        }
    }

    // median and extremes
    qsort(values, (size_t)count, sizeof values[0], compare_numbers);
    *result = (bench_result){0.5 * (values[(count - 1) / 2] + values[count / 2]),
                             values[0], values[count - 1],
                             (clock_seconds(CLOCK_MONOTONIC) - start_wall) / elapsed};
    return STATUS_OK;
}

double bench_slowdown(const benchmark *b, double now, double before)
{
    if (b->more_is_better) {
        return before / now;
    }
    return now / before;
}

bool bench_is_slower(const benchmark *b, const bench_result *now, double before)
{
    const double best = b->more_is_better ? now->max : now->min;
    return bench_slowdown(b, best, before) > 1 &&
           bench_slowdown(b, now->median, before) > SLOWER;
}

// --- files -----------------------------------------------------------------------------

json_t *bench_export(const bench_result results[BENCHMARKS])
{
    json_t *array = json_array();
    for (int i = 0; i < BENCHMARKS; i++) {
        const bench_result *r = &results[i];
        if (r->median > 0) {
            // with extremes, as one number says little about a machine
            json_add(array, json_of("name:t unit:t median:n min:n max:n wall_per_cpu:n",
                                    bench_table[i].name, bench_table[i].unit, r->median,
                                    r->min, r->max, r->wall));
        }
    }
    return json_of("bench:o", array);
}

status bench_read(const char *path, double medians[BENCHMARKS], fault *f)
{
    json_error_t error;
    json_t *root = json_load_file(path, 0, &error),
           *array = json_object_get(root, "bench"), *entry;
    size_t i;
    status code = STATUS_OK;
    memset(medians, 0, BENCHMARKS * sizeof *medians);
    if (root == NULL) {
        code = fault_set(f, STATUS_CANNOT_READ,
                         "%s:%d:%d: %s, expected what bench --json writes", path,
                         error.line > 0 ? error.line : 1,
                         error.column > 0 ? error.column : 1, error.text);
    } else if (!json_is_array(array)) {
        code =
            fault_set(f, STATUS_CANNOT_READ,
                      "%s: there is no list \"bench\", expected what bench --json writes",
                      path);
    }

    // its entries
    json_array_foreach(array, i, entry)
    {
        const char *name = "", *unit;
        const bool named =
            json_unpack(entry, "{s:s, s:s}", "name", &name, "unit", &unit) == 0;
        const double median = json_number_value(json_object_get(entry, "median"));
        if (code == STATUS_OK && !(named && median > 0)) {
            code = fault_set(
                f, STATUS_CANNOT_READ,
                "%s: entry %zu of \"bench\" has no name, unit and positive median", path,
                i + 1);
        }
        for (int k = 0; k < BENCHMARKS; k++) {
            if (strcmp(bench_table[k].name, name) == 0) {
                medians[k] = median;
            }
        }
    }
    json_decref(root);
    return code;
}

// --- what is measured: runs and batches by the library, the rest by the program itself
// --------

double bench_window = 0.5;

// Work whose time is measured: a scenario's run, or a batch of them.
typedef struct timed_work {
    scenario scenario;
    bool rows;    // the rows of the run are kept
    int threads;  // of the batch
    double steps; // of all runs of the batch

    double duration; // of the run [s]
    double seconds;  // computing time of a call [s]
    double wall;     // time of all calls by the clock [s]
} timed_work;

// Measures the time of work with the benchmark's scenario, which is called again and
// again until `least` seconds have passed.
static status measure_work(const benchmark *b, status (*work)(void *context),
                           timed_work *t, double least, fault *f)
{
    fault ignored = {0};
    status code = scenario_parse(&t->scenario, b->of, strlen(b->of), "bench", "bench",
                                 keep_first_fault, &ignored);
    if (code == STATUS_OK) {
        const double start = clock_seconds(CLOCK_MONOTONIC);
        t->duration = t->scenario.parameters.run.duration;
        t->seconds = bench_seconds_per_call(work, t, least, &code);
        t->wall = clock_seconds(CLOCK_MONOTONIC) - start;
        scenario_finish(&t->scenario);
    }
    if (code == STATUS_OK) {
        return code;
    }
    return fault_set(f, code, "%s: %s", b->name, status_text(code));
}

static status run_bench_once(void *context)
{
    const timed_work *t = context;
    run_result result;
    status code = run_scenario(&t->scenario, t->rows, &result);
    run_finish(&result);
    return code;
}

// Computing time of a run for each simulated millisecond [us]; number: 1 where a row is
// kept for each of them.
static status measure_run(const benchmark *b, double *value, fault *f)
{
    timed_work t = {.rows = b->number == 1};
    const status code = measure_work(b, run_bench_once, &t, bench_window, f);
    *value = 1e3 * t.seconds / t.duration;
    return code;
}

// Runs of the batch: 1 s of two links into the wall with voltages from 0.5 to 1.5 V.
enum { BATCH_RUNS = 256 };

static status make_batch_run(void *context, size_t i, scenario *made, fault *f)
{
    (void)f;
    *made = ((const timed_work *)context)->scenario;
    made->parameters.motor.voltage = 0.5 + (double)i / BATCH_RUNS;
    return STATUS_OK;
}

static status take_batch_run(void *context, size_t i, const summary *s, fault *f)
{
    (void)i, (void)f;
    ((timed_work *)context)->steps += s->steps;
    return s->status;
}

static status run_batch(void *context)
{
    const batch runs = {context, BATCH_RUNS, make_batch_run, take_batch_run};
    return batch_run(&runs, ((const timed_work *)context)->threads, NULL);
}

// Measures the batch. With the number 0: time steps of all runs in a second by the clock,
// on as many threads as processors [1/s]. Else computing time of a run on one thread, in
// vectors of at most that number of arms [us].
static status measure_batch(const benchmark *b, double *value, fault *f)
{
    const bool all_processors = b->number == 0;
    timed_work t = {.threads = 1};
    double window = bench_window;
    if (all_processors) {
        t.threads = (int)sysconf(_SC_NPROCESSORS_ONLN);
        window = 1e-9; // once is enough
    }
    taylor_limit_width(b->number);
    const status code = measure_work(b, run_batch, &t, window, f);
    taylor_limit_width(0);
    if (all_processors) {
        *value = t.steps / t.wall;
    } else {
        *value = 1e6 * t.seconds / BATCH_RUNS;
    }
    return code;
}

// --- the program -----------------------------------------------------------------------

// Runs the program with these arguments in a folder, its output thrown away, and waits
// for its end. False if it fails.
static bool run_example(const char *program, const char *folder, const char *words)
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

static int remove_entry(const char *path, const struct stat *about, int kind,
                        struct FTW *place)
{
    (void)about;
    (void)kind;
    (void)place;
    return remove(path);
}

// Measures the computing time of the program with the benchmark's arguments, in a folder
// of its own that is removed, divided by the benchmark's number, in its unit: s, ms or
// us.
static status measure_program(const benchmark *b, double *value, fault *f)
{
    const char *place = getenv("TMPDIR");
    char folder[4000], *program = shipped_path(SHIPPED_PROGRAM);
    if (place == NULL || place[0] == '\0') {
        place = "/tmp";
    }
    snprintf(folder, sizeof folder, "%s/impactlab-bench-XXXXXX", place);
    if (program == NULL || mkdtemp(folder) == NULL) {
        free(program);
        return fault_set(f, STATUS_CANNOT_WRITE, "no folder '%s' can be made", folder);
    }

    double unit = 1;
    if (*b->unit != 's') {
        if (*b->unit == 'm') {
            unit = 1e-3;
        } else {
            unit = 1e-6;
        }
    }
    const double start = computing_time();
    const bool done = run_example(program, folder, b->of);
    *value = (computing_time() - start) / (unit * b->number);
    nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
    free(program);
    if (!done) {
        return fault_set(f, STATUS_CANNOT_READ,
                         "impactlab %s: it cannot be run once more", b->of);
    }
    return STATUS_OK;
}

// Two links for 1 s at 1 V into the wall; chains that strike it at 1 rad/s after 5 ms,
// and what comes of it up to 50 ms.
#define INTO_WALL "motor: {voltage: 1}\n"
#define STRUCK(links)                                                                    \
    {                                                                                    \
        "struck_n" #links "_us_per_ms", "us/ms", false, measure_run,                     \
            "arm: {links: " #links                                                       \
            ", hub_joint: beam}\ninitial: {angle: 0.095, velocity: 1}\n"                 \
            "run: {duration: 0.05}\n",                                                   \
            0                                                                            \
    }
#define WIDTH(width)                                                                     \
    {                                                                                    \
        "batch_width_" #width "_us_per_run", "us", false, measure_batch, INTO_WALL,      \
            width                                                                        \
    }

const benchmark bench_table[] = {
    // one run; the law samples its noisy sensors 200 times a second and hardly ever gives
    // the same command twice
    {"arm_n2_us_per_ms", "us/ms", false, measure_run, INTO_WALL, 0},
    {"arm_n2_rows_us_per_ms", "us/ms", false, measure_run, INTO_WALL, 1},
    {"spring_hub_us_per_ms", "us/ms", false, measure_run,
     INTO_WALL "arm: {hub_joint: spring}", 0},
    {"rig_n2_us_per_ms", "us/ms", false, measure_run, INTO_WALL "control: {law: hybrid}",
     0},

    // many links
    STRUCK(8),
    STRUCK(20),
    STRUCK(42),
    STRUCK(64),
    STRUCK(128),

    // many runs
    {"batch_n2_steps_per_s", "1/s", true, measure_batch, INTO_WALL, 0},
    WIDTH(1),
    WIDTH(2),
    WIDTH(4),
    WIDTH(8),

    // the program: a sweep of voltages into a database, all tables and figures of the
    // thesis, and a start that only says its version
    {"sweep_us_per_run", "us", false, measure_program,
     "sweep corrected/first-impact --vary motor.voltage=0.5:1.5:2000 --jobs 1 --db "
     "runs.db --quiet",
     2000},
    {"tables_s", "s", false, measure_program, "tables", 1},
    {"start_ms", "ms", false, measure_program, "--version", 1},
    {"figures_s", "s", false, measure_program, "figures -o .", 1},
};
