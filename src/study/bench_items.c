// What `impactlab bench` measures.
#include "src/study/bench.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "src/base/clock.h"
#include "src/predict/linearised.h"
#include "src/run/export.h"
#include "src/run/run.h"
#include "src/contact/contact_machine.h"
#include "src/engines/pair/taylor_lanes.h"
#include "src/study/batch.h"
#include "src/study/thesis_tables.h"

#define CHAIN_STEP 1e-3 // [s]

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

// --- one run ----------------------------------------------------------------------------------

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

typedef struct written_trace {
    const trace *trace;
    FILE *stream;
} written_trace;

static status write_once(void *context)
{
    const written_trace *w = context;
    rewind(w->stream);
    export_csv(w->stream, w->trace, 2);
    return ferror(w->stream) ? STATUS_CANNOT_WRITE : STATUS_OK;
}

// The rows of that run as CSV into a file that is written over and over, each of them [us].
static status measure_csv(const benchmark *b, double *value, fault *f)
{
    const scenario s = timed_scenario(b->settings);
    FILE *stream = tmpfile();
    if (stream == NULL) {
        return fault_set(f, STATUS_CANNOT_WRITE, "no file for CSV can be made");
    }

    run_result result;
    status code = run_scenario(&s, true, &result);
    written_trace w = {&result.trace, stream};
    if (code == STATUS_OK) {
        const double seconds = bench_seconds_per_call(write_once, &w, bench_window, &code);
        *value = 1e6 * seconds / (double)result.trace.row_count;
    }
    fclose(stream);
    run_finish(&result);
    return ended(b, code, f);
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

// The predictor at the instant before the first contact of two links at 1 V [us].
static status measure_predict(const benchmark *b, double *value, fault *f)
{
    const scenario s = timed_scenario(b->settings);

    // a run tells the state before its first impact
    run_result result;
    status code = run_scenario(&s, false, &result);
    touching t = {.q = result.before_impact,
                  .w = result.before_impact ? result.before_impact + 2 : NULL};

    // the prediction there
    arm_init(&t.arm, &s.parameters);
    t.motion = motion_create(&t.arm, &s.parameters.method);
    if (t.motion == NULL || result.before_impact == NULL) {
        code = STATUS_NO_MEMORY;
    }
    if (code == STATUS_OK) {
        *value = 1e6 * bench_seconds_per_call(predict_once, &t, bench_window, &code);
    }
    motion_destroy(t.motion);
    run_finish(&result);
    return ended(b, code, f);
}

// --- steps of long chains ---------------------------------------------------------------------

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

// Computing time of an implicit step of 1 ms [us]. In free flight the chain has left its start
// behind; it touches at about 0.3 s. After 0.7 s a long chain stays on the wall; two links then are
// held by friction, which costs nothing, so their first contact is taken, before the hub sticks.
static status time_chain(int links, bool contact, double *value, fault *f)
{
    char settings[96];
    snprintf(settings, sizeof settings,
             "arm.links=%d wall.kind=plane method.name=generalized-alpha", links);
    const scenario of = timed_scenario(settings);
    const parameters *p = &of.parameters;
    const double from = !contact ? 0.05 : links == 2 ? 0.30 : 0.7;
    stretch s = {.to = !contact ? 0.25 : links == 2 ? 0.36 : 0.9};
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
            const double seconds = bench_seconds_per_call(pass_stretch, &s, bench_window, &code);
            *value = 1e6 * seconds / ((s.to - from) / CHAIN_STEP);
        }
    }
    free(s.start);
    motion_destroy(s.motion);
    return code == STATUS_OK ? code
                             : fault_set(f, code, "a chain of %d links between %g and %g s: %s",
                                         links, from, s.to, status_text(code));
}

status bench_step_cost(int links, double *free_us, double *contact_us, fault *f)
{
    assert(links > 0 && free_us != NULL && contact_us != NULL);
    double *const costs[] = {free_us, contact_us};
    for (int contact = 0; contact < 2; contact++) {
        *costs[contact] = (double)INFINITY;

        // the best of three: what a passing disturbance adds is no cost of the step
        for (int i = 0; i < 3; i++) {
            double one;
            status code = time_chain(links, contact, &one, f);
            if (code != STATUS_OK) {
                return code;
            }
            *costs[contact] = fmin(*costs[contact], one);
        }
    }
    return STATUS_OK;
}

// Number: 1 in contact, 0 in flight.
static status measure_chain_of_128(const benchmark *b, double *value, fault *f)
{
    return time_chain(128, b->number == 1, value, f);
}

// --- many runs --------------------------------------------------------------------------------

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
    if (summaries == NULL) {
        return fault_no_memory(f);
    }

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

static status measure_tables(const benchmark *b, double *value, fault *f)
{
    thesis_tables t;
    const double start = bench_computing_time();
    const status code = tables_compute(&t, f);
    (void)b;
    *value = bench_computing_time() - start;
    return code;
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
    {"csv_us_per_row", "us", false, measure_csv, "", 0},

    // many links
    STRUCK(8),
    STRUCK(20),
    STRUCK(42),
    STRUCK(64),
    STRUCK(128),
    {"arm_n128_free_us_per_ms", "us/ms", false, measure_chain_of_128, "", 0},
    {"arm_n128_contact_us_per_ms", "us/ms", false, measure_chain_of_128, "", 1},

    // many runs
    {"batch_n2_steps_per_s", "1/s", true, measure_batch, "", 0},
    WIDTH(1),
    WIDTH(2),
    WIDTH(4),
    WIDTH(8),

    // what is made of runs
    {"predict_us", "us", false, measure_predict, "", 0},
    {"tables_s", "s", false, measure_tables, "", 0},
};
const int bench_count = (int)(sizeof bench_table / sizeof bench_table[0]);
