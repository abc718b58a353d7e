#include "src/run/run.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "src/base/numbers.h"
#include "src/run/recording_frame.h"
#include "src/run/stepped.h"
#include "src/solve/contact_machine.h"
#include "src/solve/taylor_engine.h"

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

// --- several at once --------------------------------------------------------------------------

// So many runs are in hand at once: enough to fill the vectors with strides of one form, few enough
// to stay in the nearest cache.
enum { IN_HAND = 16 };

// One of the runs that go side by side.
typedef struct side_run {
    recording recording;
    corrected_run run;
    fault fault;
    taylor_lane *lane; // its part in the series of the stride it is to make
} side_run;

typedef struct side_by_side {
    const scenario *scenarios;
    run_options options; // of all
    run_result *results;
    int count, next;      // of them, and the next one to begin
    int waiting[IN_HAND]; // places of those in hand, all of which wait for their series
    int waiting_count;
    side_run in_hand[IN_HAND];
    taylor_group series; // of those whose strides are being made
} side_by_side;

// Goes on with a run until it waits for series that can be computed together with others'. False
// if it is over: it is closed then.
static bool go_on(side_by_side *group, int place)
{
    side_run *one = &group->in_hand[place];
    status failed = STATUS_OK;
    bool ended = false;

    // strides that need no series are taken at once, one that does waits for company
    while (failed == STATUS_OK && !ended) {
        failed = corrected_approach_stride(&one->run, &ended, &one->fault);
        if (failed == STATUS_OK && !ended) {
            double remaining = one->run.stop - one->run.motion->state[SLOT_TIME];
            one->lane = taylor_prepare(&one->run.arm, one->run.motion, remaining);
            if (one->lane != NULL) {
                group->waiting[group->waiting_count++] = place;
                return true;
            }
            failed = corrected_stride(&one->run, &one->fault);
        }
    }

    corrected_close(&one->run, failed);
    recording_end(&one->recording, failed, &one->fault, (time_used){0});
    return false;
}

// Makes the stride whose series are computed, and goes on.
static bool stride_and_go_on(side_by_side *group, int place)
{
    side_run *one = &group->in_hand[place];
    status failed = corrected_stride(&one->run, &one->fault);
    if (failed == STATUS_OK) {
        return go_on(group, place);
    }
    corrected_close(&one->run, failed);
    recording_end(&one->recording, failed, &one->fault, (time_used){0});
    return false;
}

// Begins runs in a free place until one waits there for its series, or none is left.
static void begin_next(side_by_side *group, int place)
{
    side_run *one = &group->in_hand[place];
    bool waits = false;

    // the printed model has nothing to wait for and is run here
    while (!waits && group->next < group->count) {
        const scenario *s = &group->scenarios[group->next];
        run_result *result = &group->results[group->next++];
        if (s->parameters.arm.model == ARM_PRINTED) {
            run_scenario_with(s, &group->options, result);
            continue;
        }

        // the next corrected run, up to its first wait
        one->run.motion = NULL;
        status failed = recording_begin(&one->recording, s, &group->options, result, &one->fault);
        if (failed == STATUS_OK) {
            failed = corrected_open(&one->run, &one->recording, &one->fault);
        }
        if (failed == STATUS_OK) {
            waits = go_on(group, place);
        } else {
            corrected_close(&one->run, failed);
            recording_end(&one->recording, failed, &one->fault, (time_used){0});
        }
    }
}

// Takes as many of those that wait as fit into the vectors and are of the form that most of the
// first few have, computes their series, and lets them make their strides.
static void serve(side_by_side *group)
{
    enum { LOOKED_AT = 4 };
    const int width = taylor_width();

    // the form that most of the first in the queue share
    int best = 0, most = 0, chosen[TAYLOR_WIDEST], count = 0;
    for (int i = 0; i < group->waiting_count && i < LOOKED_AT && most < width; i++) {
        int alike = 0;
        for (int j = 0; j < group->waiting_count && alike < width; j++) {
            alike += taylor_alike(group->in_hand[group->waiting[i]].lane->form,
                                  group->in_hand[group->waiting[j]].lane->form);
        }
        best = alike > most ? i : best;
        most = alike > most ? alike : most;
    }

    // out of the queue, whose order stays
    const taylor_form form = group->in_hand[group->waiting[best]].lane->form;
    taylor_lane *lanes[TAYLOR_WIDEST];
    int left = 0;
    for (int i = 0; i < group->waiting_count; i++) {
        const int place = group->waiting[i];
        if (count < width && taylor_alike(group->in_hand[place].lane->form, form)) {
            lanes[count] = group->in_hand[place].lane;
            chosen[count++] = place;
        } else {
            group->waiting[left++] = place;
        }
    }
    group->waiting_count = left;

    // side by side to the ends of their strides
    taylor_end ends[TAYLOR_WIDEST];
    taylor_compute(&group->series, lanes, count);
    for (int i = 0; i < count; i++) {
        const corrected_run *run = &group->in_hand[chosen[i]].run;
        motion_look_ahead(&run->arm, run->motion, run->stop, run->recording->now.method.step);
        const double length = run->motion->ahead.length;
        const int pieces = lanes[i]->form.contact ? corrected_force_pieces(run, length) : 0;
        ends[i] = (taylor_end){length, pieces};
    }
    taylor_finish(&group->series, lanes, ends, count);

    // then each goes on by itself or makes room
    for (int i = 0; i < count; i++) {
        if (!stride_and_go_on(group, chosen[i])) {
            begin_next(group, chosen[i]);
        }
    }
}

void run_together(const scenario *scenarios, int count, const atomic_bool *abandon,
                  run_result *results)
{
    assert(scenarios != NULL && results != NULL && count >= 0);
    side_by_side *group = aligned_alloc(_Alignof(side_by_side), sizeof *group);
    const run_options options = {.abandon = abandon};
    const time_used start = time_now();
    if (group == NULL || taylor_width() == 1) {
        for (int i = 0; i < count; i++) {
            run_scenario_with(&scenarios[i], &options, &results[i]);
        }
        free(group);
        return;
    }

    group->scenarios = scenarios;
    group->options = options;
    group->results = results;
    group->count = count;
    group->next = group->waiting_count = 0;
    for (int place = 0; place < IN_HAND; place++) {
        begin_next(group, place);
    }
    while (group->waiting_count > 0) {
        serve(group);
    }
    free(group);

    // nobody can say whose time it was
    const time_used all = time_since(start);
    for (int i = 0; i < count; i++) {
        results[i].summary.cpu_time_s = all.cpu / count;
        results[i].summary.wall_time_s = all.wall / count;
    }
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
