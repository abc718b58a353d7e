// Many runs side by side: steps of several two-link arms are computed in the lanes of the
// processor's vectors.
#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "src/run/arm_run.h"
#include "src/run/recording.h"
#include "src/engines/motion_create.h"
#include "src/run/run.h"
#include "src/engines/pair/taylor_lanes.h"

// The number of runs in progress at once: enough to fill the vectors with steps of one
// form (eight lanes to 96 %), few enough to stay in the second-level cache.
enum { IN_HAND = 24 };

// The bytes of the summary that steps write to, from its first number on.
enum { SUMMARY_SHARE = 128 };

// One of the runs that go side by side.
typedef struct side_run {
    recording recording;
    arm_run run;
    fault fault;
    taylor_lane *lane;   // its lane in the series of the step that it is to make
    int kind;            // the kind of that step: steps of one kind go together
    motion *motion;      // storage of the run before it, to be used again; NULL: none
    shared_array forces; // the same of that run's forces
    shared_array events; // and of its events
} side_run;

struct side_by_side {
    const scenario *scenarios;
    run_options options;     // of all runs
    run_result *results;     // one for each scenario
    int count, next;         // number of scenarios, and the next one to begin
    int waiting[IN_HAND];    // queue of the places in in_hand that wait for their series
    int waiting_count;       // length of that queue
    int alike[TAYLOR_KINDS]; // how many in the queue are of each kind
    side_run in_hand[IN_HAND];
    taylor_group series; // of the runs that step together
};

// Puts the storage of a run's events aside, if there is any and no earlier one.
static void keep_events(side_run *one)
{
    shared_array events = trace_take_events(&one->recording.result->trace);
    if (events.capacity > 0 && one->events.capacity == 0) {
        one->events = events;
    } else {
        shared_array_finish(&events);
    }
}

// Ends a run and puts its storage aside for the next one in its place.
static void end_run(side_run *one, status failed)
{
    shared_array *forces = &one->recording.result->history.forces;
    motion *over = arm_run_finish(&one->run, failed);
    if (over != NULL) {
        one->motion = over;
    }
    one->forces = *forces;
    memset(forces, 0, sizeof *forces);
    keep_events(one);
    recording_end(&one->recording, failed, &one->fault);
}

// Begins a run in the storage of the one before it. What `one` keeps is taken out of it
// before anything can fail, so that no storage has two owners.
static status begin_run(side_run *one, const scenario *s, const run_options *options,
                        run_result *result)
{
    // the recording, with the forces' storage
    one->run.motion = NULL;
    one->run.path = NULL;
    const status failed =
        recording_begin(&one->recording, s, options, result, &one->fault);
    result->history.forces = one->forces;
    result->history.forces.count = 0;
    one->forces = (shared_array){0};
    TRY(failed);

    // the arm, in the motion's storage
    motion *spare = one->motion;
    one->motion = NULL;
    TRY(arm_run_open(&one->run, &one->recording, spare, &one->fault));
    trace_give_events(&result->trace, &one->events);
    return STATUS_OK;
}

// Prepares the lane of a run's next step in a series, if that step can be computed so.
// Returns whether it can.
static bool needs_series(side_run *one)
{
    arm_run *run = &one->run;
    one->lane = NULL;
    if (!run->under_way.exists) {
        const double remaining = run->segment.stop - run->motion->state[SLOT_TIME];
        one->lane = taylor_prepare(&run->arm, run->motion, remaining);
    }
    return one->lane != NULL;
}

// Continues a run, whose last step returned `failed`, until its next step needs a series;
// then it waits in the queue, as series of several runs are computed together. False if
// the run is over; it has been ended then.
static bool continue_run(side_by_side *group, int place, status failed)
{
    side_run *one = &group->in_hand[place];
    bool ended = false;

    // steps that need no series are made at once
    while (failed == STATUS_OK && !ended) {
        failed = arm_run_prepare_step(&one->run, &ended, &one->fault);
        if (failed == STATUS_OK && !ended) {
            if (needs_series(one)) {
                one->kind = taylor_kind(one->lane->form);
                group->alike[one->kind]++;
                group->waiting[group->waiting_count++] = place;
                return true;
            }
            failed = arm_run_step(&one->run, HUGE_VAL, &one->fault);
        }
    }

    end_run(one, failed);
    return false;
}

// Prefetches the cache lines of a block of memory for writing.
static inline void fetch(const void *from, size_t size)
{
    for (size_t at = 0; at < size; at += CACHE_LINE) {
        __builtin_prefetch((const char *)from + at, 1);
    }
}

// Prefetches the memory that the next step of a run will use, which the series of other
// runs have displaced from the first-level cache.
static void fetch_run(const side_run *one)
{
    const arm_run *run = &one->run;
    const motion *m = run->motion;
    fetch(m, sizeof *m);
    fetch(m->state, (size_t)m->size * sizeof *m->state);
    fetch(m->trial, (size_t)m->size * sizeof *m->trial);
    fetch(one->lane, offsetof(taylor_lane, block[AT_ANGLE_0]));
    fetch(run, offsetof(arm_run, arm.modal_damping));
    fetch(&one->recording.state, sizeof one->recording.state);
    fetch(&one->recording.result->summary.first_contact_s, SUMMARY_SHARE);
    fetch(&one->recording.result->history.forces, sizeof(shared_array));
}

// Begins runs in a free place until one waits there for its series, or none is left.
static void fill_place(side_by_side *group, int place)
{
    side_run *one = &group->in_hand[place];
    bool waits = false;

    // a run of the printed model never waits and is computed here as a whole
    while (!waits && group->next < group->count) {
        const scenario *s = &group->scenarios[group->next];
        run_result *result = &group->results[group->next++];
        if (s->parameters.arm.model == ARM_PRINTED) {
            run_scenario_with(s, &group->options, result);
            continue;
        }

        // the next corrected run, up to its first wait
        waits = continue_run(group, place, begin_run(one, s, &group->options, result));
    }
}

// The kind of step of which most runs wait, among the kinds of the first few in the
// queue. The first kind that fills the vectors is taken.
static int most_common_kind(const side_by_side *group, int width)
{
    enum { LOOKED_AT = 4 };
    int kind = group->in_hand[group->waiting[0]].kind;
    for (int i = 1;
         i < group->waiting_count && i < LOOKED_AT && group->alike[kind] < width; i++) {
        const int other = group->in_hand[group->waiting[i]].kind;
        if (group->alike[other] > group->alike[kind]) {
            kind = other;
        }
    }
    return kind;
}

// Takes the runs that are to step together out of the queue: those of the most common
// kind, as many as fit into the vectors. Computes their series, lets them make their
// steps, and continues each by itself until it waits again.
static void step_together(side_by_side *group)
{
    const int width = taylor_width();
    const int kind = most_common_kind(group, width);

    // out of the queue, in which the others keep their order
    taylor_lane *lanes[TAYLOR_WIDEST];
    int chosen[TAYLOR_WIDEST], count = 0, left = 0, next = 0;
    const int wanted = group->alike[kind] < width ? group->alike[kind] : width;
    for (; count < wanted; next++) {
        const int place = group->waiting[next];
        if (group->in_hand[place].kind == kind) {
            lanes[count] = group->in_hand[place].lane;
            chosen[count++] = place;
        } else {
            group->waiting[left++] = place;
        }
    }
    group->alike[kind] -= count;
    group->waiting_count -= count;
    memmove(group->waiting + left, group->waiting + next,
            (size_t)(group->waiting_count - left) * sizeof *group->waiting);

    // the series of all, then how far each step goes, and the state at its end
    taylor_end ends[TAYLOR_WIDEST];
    taylor_compute(&group->series, lanes, count);
    for (int i = 0; i < count; i++) {
        fetch_run(&group->in_hand[chosen[i]]);
    }
    for (int i = 0; i < count; i++) {
        arm_run *run = &group->in_hand[chosen[i]].run;
        arm_run_begin_step(run);
        const double length = run->motion->step.coming.end.length;
        const int pieces = lanes[i]->form.contact ? arm_run_force_pieces(run, length) : 0;
        ends[i] = (taylor_end){length, pieces};
    }
    taylor_finish(&group->series, lanes, ends, count);

    // each makes its step and continues, or makes room for the next scenario
    for (int i = 0; i < count; i++) {
        side_run *one = &group->in_hand[chosen[i]];
        if (!continue_run(group, chosen[i],
                          arm_run_step(&one->run, HUGE_VAL, &one->fault))) {
            fill_place(group, chosen[i]);
        }
    }
}

// The storage that earlier calls have left, or a new one; NULL without memory.
static side_by_side *open_storage(side_by_side **storage)
{
    if (*storage == NULL) {
        *storage = aligned_alloc(_Alignof(side_by_side), sizeof **storage);
        for (int place = 0; *storage != NULL && place < IN_HAND; place++) {
            (*storage)->in_hand[place].motion = NULL;
            shared_array_init(&(*storage)->in_hand[place].forces, sizeof(force_step));
            shared_array_init(&(*storage)->in_hand[place].events, sizeof(event));
        }
    }
    return *storage;
}

void side_by_side_destroy(side_by_side *storage)
{
    for (int place = 0; storage != NULL && place < IN_HAND; place++) {
        motion_destroy(storage->in_hand[place].motion);
        shared_array_finish(&storage->in_hand[place].forces);
        shared_array_finish(&storage->in_hand[place].events);
    }
    free(storage);
}

void run_together(const scenario *scenarios, int count, const atomic_bool *abandon,
                  run_result *results, side_by_side **storage)
{
    assert(count >= 0);
    const run_options options = {.abandon = abandon, .untimed = true};

    // without vectors, or without memory: one run after the other
    side_by_side *group = taylor_width() > 1 ? open_storage(storage) : NULL;
    if (group == NULL) {
        for (int i = 0; i < count; i++) {
            run_scenario_with(&scenarios[i], &options, &results[i]);
        }
        return;
    }

    // all places are filled, and refilled until no scenario is left
    group->scenarios = scenarios;
    group->options = options;
    group->results = results;
    group->count = count;
    group->next = group->waiting_count = 0;
    memset(group->alike, 0, sizeof group->alike);
    for (int place = 0; place < IN_HAND; place++) {
        fill_place(group, place);
    }
    while (group->waiting_count > 0) {
        step_together(group);
    }
}
