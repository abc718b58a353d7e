#include "src/run/checkpoint.h"

#include <assert.h>
#include <string.h>

#include "src/base/instant.h"

enum {
    CHECKPOINT_ROWS = 512, // from one checkpoint to the next
    ROWS_PER_RESERVED = 64 // address space is for one checkpoint in so many rows
};

checkpoint *checkpoint_at(const run_history *h, size_t index)
{
    assert(h != NULL && index < h->checkpoint_count);
    return (checkpoint *)((char *)h->checkpoints.base + index * h->checkpoints.size);
}

// Whether the run keeps checkpoints, and its forces beyond its end.
static bool keeps_history(const recording *r)
{
    return r->options->rows_expected > 0 && r->rig == NULL;
}

bool checkpoint_reserve(run_history *h, size_t size, size_t rows_expected)
{
    assert(h != NULL && size >= sizeof(checkpoint));
    const size_t most = recording_most_rows(rows_expected);

    // of a run of a few rows, too, there is room for one
    const size_t least = rows_expected / ROWS_PER_RESERVED + 1;
    return force_history_reserve(&h->forces, rows_expected, most) &&
           shared_array_reserve(&h->checkpoints, size, least, most);
}

status checkpoint_open_history(recording *r, const motion *m, fault *f)
{
    assert(r != NULL && m != NULL);
    run_history *h = &r->result->history;
    size_t expected = r->options->rows_expected;
    size_t size = sizeof(checkpoint) + (size_t)m->most_size * sizeof(double);

    // shared, plain, or one that others can share
    if (h->forces.array.reserved > 0) {
        return STATUS_OK; // shared with the run that is resumed
    }
    if (!keeps_history(r)) {
        if (h->forces.array.base == NULL) {
            force_history_init(&h->forces); // else it has another run's memory to use
        }
        return STATUS_OK;
    }
    return checkpoint_reserve(h, size, expected)
               ? STATUS_OK
               : fault_set(f, STATUS_NO_MEMORY, "no address space for %zu rows", expected);
}

bool checkpoint_keep(recording *r, const motion *m, double last_event)
{
    run_history *h = &r->result->history;
    const trace *t = &r->result->trace;
    double now = m->state[SLOT_TIME];
    if (!keeps_history(r) || !instant_after(now, last_event)) {
        return true;
    }

    // is it time for one, and is there room?
    size_t before = h->checkpoint_count > 0 ? checkpoint_at(h, h->checkpoint_count - 1)->rows : 0;
    if (t->row_count < before + CHECKPOINT_ROWS) {
        return true;
    }

    if (!shared_array_grow(&h->checkpoints, h->checkpoint_count + 1)) {
        return false;
    }

    // all that the steps to come depend on
    h->checkpoint_count++;
    checkpoint *kept = checkpoint_at(h, h->checkpoint_count - 1);
    *kept = (checkpoint){.time = now,
                         .rows = t->row_count,
                         .events = t->event_count,
                         .force_steps = h->forces.count,
                         .impacted = r->result->before_impact != NULL,
                         .recording = r->state,
                         .summary = r->result->summary,
                         .steps = m->steps,
                         .start_energy = m->start_energy,
                         .pulse_peak = m->pulse_peak,
                         .pulse_peak_time = m->pulse_peak_time,
                         .largest_penetration = m->largest_penetration};
    memcpy(kept->state, m->state, (size_t)m->size * sizeof(double));

    return true;
}

void checkpoint_restore(recording *r, arm *a, motion *m)
{
    assert(r != NULL && r->result->history.checkpoint_count > 0);
    const run_history *h = &r->result->history;
    const checkpoint *kept = checkpoint_at(h, h->checkpoint_count - 1);

    // the parameters as the script had changed them by then
    for (; r->state.next_action < kept->recording.next_action; r->state.next_action++) {
        action_apply(&r->scenario->actions[r->state.next_action], &r->now, NULL);
    }
    arm_init(a, &r->now);
    r->state = kept->recording;

    // and the motion
    motion_follow_arm(a, m);
    memcpy(m->state, kept->state, (size_t)m->size * sizeof(double));
    motion_forget_stride(m);
    m->steps = kept->steps;
    m->start_energy = kept->start_energy;
    m->pulse_peak = kept->pulse_peak;
    m->pulse_peak_time = kept->pulse_peak_time;
    m->largest_penetration = kept->largest_penetration;
    recording_publish(r, kept->time);
}
