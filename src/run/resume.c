#include "src/run/resume.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "src/base/instant.h"
#include "src/engines/motion_create.h"

enum { CHECKPOINT_ROWS = 512 }; // rows from one checkpoint to the next

// The checkpoint with that index, the oldest having index 0.
static checkpoint *checkpoint_at(const run_history *h, size_t index)
{
    assert(index < h->checkpoints.count);
    return (checkpoint *)((char *)h->checkpoints.base + index * h->checkpoints.size);
}

// Whether the run keeps checkpoints, and its forces after its end. A run with a rig does
// not: its controller's state is not part of a checkpoint.
static bool keeps_history(const recording *r)
{
    return r->options->rows_expected > 0 && r->rig == NULL;
}

// Reserves address space for the forces and the checkpoints (`size` bytes each) of a run
// that has from `least` to `most` rows. False if there is none.
static bool checkpoint_reserve(run_history *h, size_t size, size_t least, size_t most)
{
    assert(size >= sizeof(checkpoint));

    // even a run of a few rows has room for one checkpoint
    return shared_array_reserve(&h->forces, sizeof(force_step), least, most) &&
           shared_array_reserve(&h->checkpoints, size, least / CHECKPOINT_ROWS + 1,
                                most / CHECKPOINT_ROWS + 1);
}

status checkpoint_open_history(recording *r, const motion *m, fault *f)
{
    run_history *h = &r->result->history;
    const size_t expected = r->options->rows_expected;
    if (h->forces.base != NULL) {
        return STATUS_OK; // it has the history of the run it resumes, or another's memory
    }

    // forces that grow as they come
    if (!keeps_history(r)) {
        shared_array_init(&h->forces, sizeof(force_step));
        return STATUS_OK;
    }

    // forces and checkpoints that never move
    const size_t size = sizeof(checkpoint) + motion_saved_size(m);
    if (!checkpoint_reserve(h, size, expected, recording_most_rows(expected))) {
        return fault_set(f, STATUS_NO_MEMORY, "no address space for %zu rows", expected);
    }
    return STATUS_OK;
}

bool checkpoint_keep(recording *r, const motion *m, double last_event)
{
    run_history *h = &r->result->history;
    const trace *t = &r->result->trace;
    double now = m->state[SLOT_TIME];
    if (!keeps_history(r) || !instant_after(now, last_event)) {
        return true;
    }

    // enough rows after the last one, and room for another
    size_t before =
        h->checkpoints.count > 0 ? checkpoint_at(h, h->checkpoints.count - 1)->rows : 0;
    if (t->row_count < before + CHECKPOINT_ROWS) {
        return true;
    }
    if (!shared_array_grow(&h->checkpoints, h->checkpoints.count + 1)) {
        return false;
    }

    // all that the steps to come depend on
    checkpoint *added = checkpoint_at(h, h->checkpoints.count++);
    *added = (checkpoint){.time = now,
                          .rows = t->row_count,
                          .events = t->event_count,
                          .force_steps = h->forces.count,
                          .recording = r->state,
                          .summary = r->result->summary};
    motion_save(m, added->motion);
    return true;
}

void checkpoint_restore(recording *r, arm *a, motion *m)
{
    assert(r->result->history.checkpoints.count > 0);
    const run_history *h = &r->result->history;
    const checkpoint *last = checkpoint_at(h, h->checkpoints.count - 1);

    // the parameters as the script had changed them by then
    for (; r->state.next_action < last->recording.next_action; r->state.next_action++) {
        action_apply(&r->scenario->actions[r->state.next_action], &r->now, NULL);
    }
    arm_init(a, &r->now);
    r->state = last->recording;

    // and the motion
    motion_restore(a, m, last->motion);
    recording_publish(r, last->time);
}

// --- resuming --------------------------------------------------------------------------

// A checkpoint serves two scenarios if it lies before the instant at which they begin to
// differ, by this share of method.step at least.
#define MARGIN 1e-3

// Whether a parameter has the same value in both sets.
static bool same_parameter(const parameters *a, const parameters *b, int i)
{
    if (parameter_is_text(&parameter_table[i])) {
        size_t at = parameter_table[i].offset;
        return strcmp((const char *)a + at, (const char *)b + at) == 0;
    }
    return parameter_get(a, i) == parameter_get(b, i);
}

// The instant [s] up to which runs of two scenarios are the same: -1 if they differ from
// the start, HUGE_VAL if they do not differ.
static double same_until(const scenario *a, const scenario *b)
{
    const int duration = PARAMETER_INDEX(run.duration);
    double until = HUGE_VAL;

    // another parameter makes another run from the start; only the duration does not: up
    // to where the window of the steady force begins, which cuts a step, runs are the
    // same
    for (int i = 0; i < parameter_count; i++) {
        if (same_parameter(&a->parameters, &b->parameters, i)) {
            continue;
        }
        if (i != duration) {
            return -1;
        }
        double shorter = fmin(a->parameters.run.duration, b->parameters.run.duration);
        until = fmax(0, shorter - STEADY_WINDOW);
    }

    // scripts are the same up to the first action that is not in both
    for (int i = 0; i < a->action_count || i < b->action_count; i++) {
        const action *x = i < a->action_count ? &a->actions[i] : NULL;
        const action *y = i < b->action_count ? &b->actions[i] : NULL;
        bool same = x != NULL && y != NULL && x->time == y->time && x->kind == y->kind &&
                    x->parameter == y->parameter && x->value == y->value &&
                    strcmp(x->text, y->text) == 0;
        if (!same) {
            until = fmin(until, x != NULL ? x->time : HUGE_VAL);
            until = fmin(until, y != NULL ? y->time : HUGE_VAL);
            break;
        }
    }
    return until;
}

// Lets `result` begin with the part of `from` that had been recorded at a checkpoint: its
// rows, events, forces and summary, and the first `checkpoints` checkpoints. There will
// be room for `least` to `most` rows. False without memory; result is empty then.
static bool share_part(const run_result *from, const checkpoint *part, size_t checkpoints,
                       size_t least, size_t most, run_result *result)
{
    const run_history *old = &from->history;
    run_history *own = &result->history;
    result->summary = part->summary;

    // rows and events, then forces and checkpoints of a run that has them
    bool shared =
        trace_reserve(&result->trace, from->trace.angle_count, least, most) ==
            STATUS_OK &&
        trace_share(&result->trace, &from->trace, part->rows, part->events) == STATUS_OK;
    if (shared && old->forces.reserved > 0) {
        shared = checkpoint_reserve(own, old->checkpoints.size, least, most) &&
                 shared_array_share(&own->forces, &old->forces, part->force_steps) &&
                 shared_array_share(&own->checkpoints, &old->checkpoints, checkpoints);
    }

    if (!shared) {
        run_finish(result);
    }
    return shared;
}

bool run_resume(const run_result *from, const scenario *old, const scenario *s,
                size_t rows_expected, run_result *result)
{
    memset(result, 0, sizeof *result);
    const run_history *h = &from->history;
    if (h->checkpoints.count == 0) {
        return false;
    }

    // the last checkpoint before the runs differ
    double until = same_until(old, s) - MARGIN * s->parameters.method.step;
    size_t count = 0;
    while (count < h->checkpoints.count && checkpoint_at(h, count)->time < until) {
        count++;
    }
    if (count == 0) {
        return false;
    }

    return share_part(from, checkpoint_at(h, count - 1), count, rows_expected,
                      recording_most_rows(rows_expected), result);
}

status run_share(const run_result *from, run_result *result)
{
    memset(result, 0, sizeof *result);
    const checkpoint whole = {.rows = from->trace.row_count,
                              .events = from->trace.event_count,
                              .force_steps = from->history.forces.count,
                              .summary = from->summary};
    const size_t checkpoints = from->history.checkpoints.count;

    // with room for what there is, as it will not grow
    const size_t rows = whole.rows > whole.events ? whole.rows : whole.events;
    const size_t most = (rows > whole.force_steps ? rows : whole.force_steps) + 1;
    if (!share_part(from, &whole, checkpoints, most, most, result)) {
        return STATUS_NO_MEMORY;
    }
    result->landing = from->landing;
    return STATUS_OK;
}
