// Checkpoints: where a run of the corrected arm can be resumed.
#include "src/run/recording.h"

#include <string.h>

enum { CHECKPOINT_ROWS = 512 }; // rows from one checkpoint to the next

status recording_open_history(recording *r, const motion *m, fault *f)
{
    run_history *h = &r->result->history;
    size_t expected = r->options.rows_expected, most = rows_at_most(expected);
    size_t size = sizeof(checkpoint) + (size_t)m->size * sizeof(double);
    r->keeps_history = expected > 0 && r->rig == NULL;
    if (!r->keeps_history || h->steps.reserved > 0) {
        return STATUS_OK;
    }
    bool reserved = shared_array_reserve(&h->steps, sizeof(force_step), expected, most) &&
                    shared_array_reserve(&h->checkpoints, size, expected / 64, most);
    return reserved ? STATUS_OK
                    : fault_set(f, STATUS_NO_MEMORY, "no address space for %zu rows", expected);
}

bool recording_checkpoint(recording *r, const motion *m, double last_event)
{
    run_history *h = &r->result->history;
    const trace *t = &r->result->trace;
    double now = m->state[SLOT_TIME];
    if (!r->keeps_history || now - last_event < 1e-12) {
        return true;
    }
    size_t before = h->checkpoint_count > 0 ? checkpoint_at(h, h->checkpoint_count - 1)->rows : 0;
    if (t->row_count < before + CHECKPOINT_ROWS) {
        return true;
    }
    if (!shared_array_grow(&h->checkpoints, h->checkpoint_count + 1)) {
        return false;
    }
    checkpoint *kept = checkpoint_at(h, h->checkpoint_count++);
    *kept = (checkpoint){.time = now,
                         .rows = t->row_count,
                         .events = t->event_count,
                         .force_steps = r->count,
                         .next_action = r->next_action,
                         .grid_row = r->grid_row,
                         .separated = r->separated,
                         .pulse_open = r->pulse_open,
                         .impacted = r->result->before_impact != NULL,
                         .integral_at_window = r->integral_at_window,
                         .summary = r->result->summary,
                         .steps = m->steps,
                         .start_energy = m->start_energy,
                         .pulse_peak = m->pulse_peak,
                         .pulse_peak_time = m->pulse_peak_time,
                         .largest_penetration = m->largest_penetration};
    memcpy(kept->state, m->state, (size_t)m->size * sizeof(double));
    return true;
}

void recording_resume(recording *r, arm *a, motion *m)
{
    const run_history *h = &r->result->history;
    const checkpoint *kept = checkpoint_at(h, h->checkpoint_count - 1);
    r->count = kept->force_steps;
    r->steps = h->steps.base;
    r->capacity = h->steps.capacity;
    r->grid_row = kept->grid_row;
    r->separated = kept->separated;
    r->pulse_open = kept->pulse_open;
    r->integral_at_window = kept->integral_at_window;
    for (; r->next_action < kept->next_action; r->next_action++) {
        action_apply(&r->scenario->actions[r->next_action], &r->now, NULL);
    }
    arm_init(a, &r->now);
    memcpy(m->state, kept->state, (size_t)m->size * sizeof(double));
    m->steps = kept->steps;
    m->start_energy = kept->start_energy;
    m->pulse_peak = kept->pulse_peak;
    m->pulse_peak_time = kept->pulse_peak_time;
    m->largest_penetration = kept->largest_penetration;
    recording_publish(r, kept->time);
}
