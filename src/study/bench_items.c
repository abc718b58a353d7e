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
#include "src/solve/contact_machine.h"
#include "src/solve/taylor_lanes.h"
#include "src/study/batch.h"
#include "src/study/thesis_tables.h"

#define CHAIN_STEP 1e-3 // [s]

// --- the arms that are timed ----------------------------------------------------------------

double bench_window = 0.5;

// Resolved parameters of the corrected arm with the given settings, which go together; the list
// ends with NULL.
static parameters timed_parameters(const char *const (*settings)[2])
{
    parameters p;
    parameters_defaults(&p, ARM_CORRECTED);
    for (int i = 0; settings[i][0] != NULL; i++) {
        const status set =
            parameter_set_text(&p, parameter_index(settings[i][0]), settings[i][1], NULL);
        assert(set == STATUS_OK);
        (void)set;
    }
    const status resolved = parameters_resolve(&p, NULL);
    assert(resolved == STATUS_OK);
    (void)resolved;
    return p;
}

// A scenario of that arm, which owns nothing.
static scenario timed_scenario(const char *const (*settings)[2])
{
    static char name[] = "bench", none[] = "";
    return (scenario){.name = name,
                      .file = none,
                      .title = none,
                      .description = none,
                      .parameters = timed_parameters(settings)};
}

static status run_once(void *context)
{
    run_result result;
    status code = run_scenario(context, false, &result);
    run_finish(&result);
    return code;
}

static status run_with_rows(void *context)
{
    run_result result;
    status code = run_scenario(context, true, &result);
    run_finish(&result);
    return code;
}

// Computing time of a run with the given settings for each simulated millisecond [us].
static status time_run(const char *const (*settings)[2], status (*run)(void *context),
                       double *value, fault *f)
{
    scenario s = timed_scenario(settings);
    status code;
    double seconds = bench_seconds_per_call(run, &s, bench_window, &code);
    *value = 1e6 * seconds / (1e3 * s.parameters.run.duration);
    return code == STATUS_OK ? code : fault_set(f, code, "the run failed: %s", status_text(code));
}

// 1 s of two links at 1 V into the wall: the defaults.
static status measure_arm_n2(double *value, fault *f)
{
    static const char *const settings[][2] = {{NULL, NULL}};
    return time_run(settings, run_once, value, f);
}

// The same with a row kept for each millisecond.
static status measure_arm_n2_rows(double *value, fault *f)
{
    static const char *const settings[][2] = {{NULL, NULL}};
    return time_run(settings, run_with_rows, value, f);
}

// With a hub on a stiff spring of its own.
static status measure_spring_hub(double *value, fault *f)
{
    static const char *const settings[][2] = {{"arm.hub_joint", "spring"}, {NULL, NULL}};
    return time_run(settings, run_once, value, f);
}

// Chains that strike the wall at 1 rad/s after 5 ms, and what comes of it up to 50 ms.
static status time_struck_chain(const char *links, double *value, fault *f)
{
    const char *const settings[][2] = {{"arm.links", links},       {"arm.hub_joint", "beam"},
                                       {"initial.angle", "0.095"}, {"initial.velocity", "1"},
                                       {"run.duration", "0.05"},   {NULL, NULL}};
    return time_run(settings, run_once, value, f);
}

#define STRUCK(links)                                                                              \
    static status measure_struck_##links(double *value, fault *f)                                  \
    {                                                                                              \
        return time_struck_chain(#links, value, f);                                                \
    }
STRUCK(8)
STRUCK(20)
STRUCK(42)
STRUCK(64)
STRUCK(128)
#undef STRUCK

// The same arm on the rig, under a law that samples its noisy sensors 200 times a second and hardly
// ever gives the same command twice.
static status measure_rig_n2(double *value, fault *f)
{
    static const char *const settings[][2] = {{"control.law", "hybrid"}, {NULL, NULL}};
    return time_run(settings, run_once, value, f);
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
            *seconds = bench_seconds_per_call(pass_stretch, &s, bench_window, &code);
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
    snprintf(count, sizeof count, "%d", links);
    const parameters p = timed_parameters(settings);
    double from = !contact ? 0.05 : links == 2 ? 0.30 : 0.7;
    double to = !contact ? 0.25 : links == 2 ? 0.36 : 0.9;
    return time_stretch(&p, from, to, seconds, f);
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
    static const char *const settings[][2] = {{NULL, NULL}};
    scenario s = timed_scenario(settings);

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

// What the runs of a batch begin with and come to.
typedef struct timed_batch {
    scenario scenario;
    summary *summaries; // to be freed
} timed_batch;

static status prepare_batch(timed_batch *b, fault *f)
{
    static const char *const settings[][2] = {{NULL, NULL}};
    *b = (timed_batch){.scenario = timed_scenario(settings)};
    b->summaries = malloc(BATCH_RUNS * sizeof *b->summaries);
    return b->summaries != NULL ? STATUS_OK : fault_no_memory(f);
}

// Time steps of all runs together for a second by the clock, on as many threads as processors.
static status measure_batch(double *value, fault *f)
{
    timed_batch b;
    status code = prepare_batch(&b, f);
    if (code != STATUS_OK) {
        return code;
    }

    // all of it, by the clock
    double start = clock_seconds(CLOCK_MONOTONIC), steps = 0;
    int threads = (int)sysconf(_SC_NPROCESSORS_ONLN);
    code = batch_run(make_batch_run, &b.scenario, BATCH_RUNS, threads, b.summaries);
    double elapsed = clock_seconds(CLOCK_MONOTONIC) - start;

    // the steps that were made
    for (int i = 0; i < BATCH_RUNS && code == STATUS_OK; i++) {
        steps += b.summaries[i].steps;
        code = b.summaries[i].status;
    }
    free(b.summaries);
    *value = steps / elapsed;
    return code == STATUS_OK
               ? code
               : fault_set(f, code, "a run of the batch failed: %s", status_text(code));
}

// Computing time of a run of the batch on one thread, in vectors of at most `width` arms [us].
static status time_batch(int width, double *value, fault *f)
{
    timed_batch b;
    status code = prepare_batch(&b, f);
    if (code != STATUS_OK) {
        return code;
    }

    // over and over, as one batch is short
    double start = bench_computing_time(), elapsed = 0;
    long batches = 0;
    taylor_limit_width(width);
    for (; code == STATUS_OK && elapsed < bench_window; batches++) {
        code = batch_run(make_batch_run, &b.scenario, BATCH_RUNS, 1, b.summaries);
        elapsed = bench_computing_time() - start;
    }
    taylor_limit_width(0);
    free(b.summaries);
    *value = 1e6 * elapsed / (double)(batches * BATCH_RUNS);
    return code == STATUS_OK ? code : fault_set(f, code, "the batch failed: %s", status_text(code));
}

#define WIDTH(width)                                                                               \
    static status measure_batch_##width(double *value, fault *f)                                   \
    {                                                                                              \
        return time_batch(width, value, f);                                                        \
    }
WIDTH(1)
WIDTH(2)
WIDTH(4)
WIDTH(8)
#undef WIDTH

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

// The rows of that run as CSV into a file that is written over and over.
static status measure_csv(double *value, fault *f)
{
    static const char *const settings[][2] = {{NULL, NULL}};
    scenario s = timed_scenario(settings);
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
    return code == STATUS_OK ? code
                             : fault_set(f, code, "rows cannot be written: %s", status_text(code));
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
    // one run
    {"arm_n2_us_per_ms", "us/ms", false, measure_arm_n2},
    {"arm_n2_rows_us_per_ms", "us/ms", false, measure_arm_n2_rows},
    {"spring_hub_us_per_ms", "us/ms", false, measure_spring_hub},
    {"rig_n2_us_per_ms", "us/ms", false, measure_rig_n2},
    {"csv_us_per_row", "us", false, measure_csv},

    // many links
    {"struck_n8_us_per_ms", "us/ms", false, measure_struck_8},
    {"struck_n20_us_per_ms", "us/ms", false, measure_struck_20},
    {"struck_n42_us_per_ms", "us/ms", false, measure_struck_42},
    {"struck_n64_us_per_ms", "us/ms", false, measure_struck_64},
    {"struck_n128_us_per_ms", "us/ms", false, measure_struck_128},
    {"arm_n128_free_us_per_ms", "us/ms", false, measure_arm_n128_free},
    {"arm_n128_contact_us_per_ms", "us/ms", false, measure_arm_n128_contact},

    // many runs
    {"batch_n2_steps_per_s", "1/s", true, measure_batch},
    {"batch_width_1_us_per_run", "us", false, measure_batch_1},
    {"batch_width_2_us_per_run", "us", false, measure_batch_2},
    {"batch_width_4_us_per_run", "us", false, measure_batch_4},
    {"batch_width_8_us_per_run", "us", false, measure_batch_8},

    // what is made of runs
    {"predict_us", "us", false, measure_predict},
    {"tables_s", "s", false, measure_tables},
};
const int bench_count = (int)(sizeof bench_table / sizeof bench_table[0]);
