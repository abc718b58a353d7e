#include "src/run/run.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/run/recording.h"
#include "src/run/run_result.h"
#include "src/run/stepped.h"

// --- the corrected arm ------------------------------------------------------------------------

static status corrected_begin(stepped_run *run, recording *r, fault *f)
{
    return corrected_open(&run->corrected, r, NULL, f);
}

static void corrected_end(stepped_run *run, status failed)
{
    corrected_close(&run->corrected, failed);
}

static void corrected_summary(stepped_run *run, status failed)
{
    corrected_sum_up(&run->corrected, failed);
}

static double corrected_time(const stepped_run *run)
{
    return corrected_now(&run->corrected);
}

static bool corrected_at_end(const stepped_run *run)
{
    return !(corrected_time(run) < run->corrected.recording->scenario->parameters.run.duration);
}

static status corrected_approach(stepped_run *run, bool *ended, fault *f)
{
    return corrected_approach_stride(&run->corrected, ended, f);
}

static status corrected_stride_until(stepped_run *run, double until, fault *f)
{
    corrected_run *c = &run->corrected;
    const status s = corrected_stride(c, until, f);

    // the pace is that of strides which the motion chose, not of instants a program asks for
    if (!(corrected_now(c) < until)) {
        c->pace = pace_begin();
    }
    return s;
}

static status corrected_act_now(stepped_run *run, const action *todo, fault *f)
{
    const status s = corrected_end_step(&run->corrected, f);
    return s == STATUS_OK ? corrected_act(&run->corrected, todo, -1, f) : s;
}

static sensed_motion corrected_sensed(stepped_run *run)
{
    return corrected_sensed_now(&run->corrected);
}

static sample corrected_row_now(stepped_run *run)
{
    return corrected_row(&run->corrected, corrected_present(&run->corrected), 0);
}

static const double *corrected_state(const stepped_run *run, int *angle_count)
{
    const motion *m = run->corrected.motion;
    *angle_count = m->dof;
    return state_angles(m, corrected_present(&run->corrected));
}

// What the stretch remembers; what the motion does follows.
typedef struct saved_stretch {
    double stop, last_event;
    int at_once;
    open_step under_way;
} saved_stretch;

static size_t corrected_saved_size(const stepped_run *run)
{
    return sizeof(saved_stretch) + motion_saved_size(run->corrected.motion);
}

static void corrected_save(const stepped_run *run, void *bytes)
{
    const corrected_run *c = &run->corrected;
    saved_stretch saved;
    memset(&saved, 0, sizeof saved);
    saved.stop = c->stop;
    saved.last_event = c->last_event;
    saved.at_once = c->at_once;
    saved.under_way = c->under_way;
    memcpy(bytes, &saved, sizeof saved);
    motion_save(c->motion, (char *)bytes + sizeof saved);
}

static void corrected_restore(stepped_run *run, const void *bytes)
{
    corrected_run *c = &run->corrected;
    saved_stretch saved;
    memcpy(&saved, bytes, sizeof saved);
    corrected_bind_arm(c); // to parameters and voltage of then
    motion_restore(&c->arm, c->motion, (const char *)bytes + sizeof saved);
    c->last_event = saved.last_event;
    c->at_once = saved.at_once;
    c->pace = pace_begin();

    // the step under way, looked at again as it was when it was begun
    c->under_way.goes_on = false;
    if (saved.under_way.goes_on) {
        c->stop = saved.under_way.begun_for;
        corrected_begin_step(c);
    }
    c->under_way = saved.under_way;
    c->stop = saved.stop;
}

static const stepped_model corrected_model = {.stops_anywhere = true,
                                              .takes_pushes = true,
                                              .open = corrected_begin,
                                              .close = corrected_end,
                                              .sum_up = corrected_summary,
                                              .time = corrected_time,
                                              .at_end = corrected_at_end,
                                              .approach = corrected_approach,
                                              .stride = corrected_stride_until,
                                              .act = corrected_act_now,
                                              .sensed = corrected_sensed,
                                              .row = corrected_row_now,
                                              .state = corrected_state,
                                              .saved_size = corrected_saved_size,
                                              .save = corrected_save,
                                              .restore = corrected_restore};

// --- the printed arm --------------------------------------------------------------------------

static status printed_begin(stepped_run *run, recording *r, fault *f)
{
    return printed_open(&run->printed, r, f);
}

static void printed_end(stepped_run *run, status failed)
{
    if (run->printed.begun) {
        printed_sum_up(&run->printed, failed);
    }
}

static void printed_summary(stepped_run *run, status failed)
{
    printed_sum_up(&run->printed, failed);
}

static double printed_time(const stepped_run *run)
{
    return run->printed.motion.row.time;
}

static bool printed_at_end(const stepped_run *run)
{
    return printed_motion_ended(&run->printed.motion);
}

static status printed_approach(stepped_run *run, bool *ended, fault *f)
{
    return printed_approach_step(&run->printed, ended, f);
}

static status printed_stride(stepped_run *run, double until, fault *f)
{
    (void)until; // its rows are where they are
    return printed_step(&run->printed, f);
}

static status printed_act_now(stepped_run *run, const action *todo, fault *f)
{
    return printed_act(&run->printed, todo, -1, f);
}

static sensed_motion printed_sensed(stepped_run *run)
{
    return run->printed.sensed;
}

static sample printed_row_now(stepped_run *run)
{
    return printed_sample(&run->printed);
}

static const double *printed_state(const stepped_run *run, int *angle_count)
{
    *angle_count = 3;
    return run->printed.state;
}

static size_t printed_saved_size(const stepped_run *run)
{
    return sizeof run->printed;
}

static void printed_save(const stepped_run *run, void *bytes)
{
    printed_run saved = run->printed;
    saved.recording = NULL;
    memcpy(bytes, &saved, sizeof saved);
}

static void printed_restore(stepped_run *run, const void *bytes)
{
    recording *own = run->printed.recording;
    memcpy(&run->printed, bytes, sizeof run->printed);
    run->printed.recording = own;
}

static const stepped_model printed_model = {.open = printed_begin,
                                            .close = printed_end,
                                            .sum_up = printed_summary,
                                            .time = printed_time,
                                            .at_end = printed_at_end,
                                            .approach = printed_approach,
                                            .stride = printed_stride,
                                            .act = printed_act_now,
                                            .sensed = printed_sensed,
                                            .row = printed_row_now,
                                            .state = printed_state,
                                            .saved_size = printed_saved_size,
                                            .save = printed_save,
                                            .restore = printed_restore};

// --- either -----------------------------------------------------------------------------------

const stepped_model *stepped_model_of(const parameters *p)
{
    assert(p != NULL);
    return p->arm.model == ARM_PRINTED ? &printed_model : &corrected_model;
}

status stepped_run_whole(recording *r, fault *f)
{
    assert(r != NULL && f != NULL);
    stepped_run run = {.model = stepped_model_of(&r->scenario->parameters)};
    bool ended = false;
    status failed = run.model->open(&run, r, f);
    while (failed == STATUS_OK && !ended) {
        failed = run.model->approach(&run, &ended, f);
        if (failed == STATUS_OK && !ended) {
            failed = run.model->stride(&run, HUGE_VAL, f);
        }
    }
    run.model->close(&run, failed);
    return failed;
}

status run_scenario(const scenario *s, bool keep_trace, run_result *result)
{
    const run_options options = {.keep_trace = keep_trace};
    return run_scenario_with(s, &options, result);
}

status run_scenario_with(const scenario *s, const run_options *options, run_result *result)
{
    assert(s != NULL && options != NULL && result != NULL);
    const time_used start = time_now();
    recording r;
    fault f;
    status code = recording_begin(&r, s, options, result, &f);
    if (code == STATUS_OK) {
        code = stepped_run_whole(&r, &f);
    }
    recording_end(&r, code, &f, time_since(start));
    return code;
}

int run_check_expectations(const scenario *s, const run_result *result, fault_handler report,
                           void *context)
{
    assert(s != NULL && result != NULL && (report != NULL || s->expectation_count == 0));
    int missed = 0;
    for (int i = 0; i < s->expectation_count; i++) {
        const expectation *e = &s->expectations[i];
        const char *key = summary_table[e->quantity].key;
        double value = summary_value(&result->summary, e->quantity);
        if (expectation_is_met(e, value)) {
            continue;
        }

        // as the editor that opens the file wants it: place, what is and what was expected
        char sentence[512], found[64] = "nothing (null)";
        if (!isnan(value)) {
            decimal_print(found, sizeof found, "%.9g", value);
        }
        if (e->is_null) {
            snprintf(sentence, sizeof sentence, "%s:%d:%d: %s is %s, expected null", s->file,
                     e->line, e->column, key, found);
        } else {
            decimal_print(sentence, sizeof sentence, "%s:%d:%d: %s is %s, expected %.9g within %g",
                          s->file, e->line, e->column, key, found, e->value, e->tolerance);
        }
        report(context, sentence);
        missed++;
    }
    return missed;
}

// --- results ----------------------------------------------------------------------------------

void run_finish(run_result *result)
{
    assert(result != NULL);
    trace_finish(&result->trace);
    force_history_finish(&result->history.forces);
    shared_array_finish(&result->history.checkpoints);
    free(result->before_impact);
    result->before_impact = NULL;
}

void run_monitor_count(run_monitor *monitor)
{
    if (monitor != NULL) {
        atomic_fetch_add_explicit(&monitor->pieces, 1, memory_order_relaxed);
    }
}
