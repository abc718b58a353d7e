// Snapshots: where a run of the corrected arm can be taken up again.
#include "src/run/recording.h"

#include <string.h>

enum { SNAPSHOT_ROWS = 512 }; // rows from one snapshot to the next

status recording_open_history(recording *r, const motion *m, fault *f)
{
    run_history *h = &r->result->history;
    size_t expected = r->options.rows_expected, most = rows_at_most(expected);
    size_t size = sizeof(run_snapshot) + (size_t)m->size * sizeof(double);
    r->keeps_history = expected > 0 && r->rig == NULL;
    if (!r->keeps_history || h->strides.reserved > 0) {
        return STATUS_OK;
    }
    bool reserved = shared_array_reserve(&h->strides, sizeof(force_stride), expected, most) &&
                    shared_array_reserve(&h->snapshots, size, expected / 64, most);
    return reserved ? STATUS_OK
                    : fault_set(f, STATUS_NO_MEMORY, "no address space for %zu rows", expected);
}

bool recording_take_snapshot(recording *r, const motion *m, double last_event)
{
    run_history *h = &r->result->history;
    const trace *t = &r->result->trace;
    double now = m->state[SLOT_TIME];
    if (!r->keeps_history || now - last_event < 1e-12) {
        return true;
    }
    size_t before = h->snapshot_count > 0 ? run_snapshot_at(h, h->snapshot_count - 1)->rows : 0;
    if (t->row_count < before + SNAPSHOT_ROWS) {
        return true;
    }
    if (!shared_array_grow(&h->snapshots, h->snapshot_count + 1)) {
        return false;
    }
    run_snapshot *kept = run_snapshot_at(h, h->snapshot_count++);
    *kept = (run_snapshot){.time = now,
                           .rows = t->row_count,
                           .events = t->event_count,
                           .strides = r->count,
                           .next_action = r->next_action,
                           .grid_row = r->grid_row,
                           .separated = r->separated,
                           .pulse_open = r->pulse_open,
                           .touched = r->result->touch != NULL,
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

void recording_take_up(recording *r, arm *a, motion *m)
{
    const run_history *h = &r->result->history;
    const run_snapshot *kept = run_snapshot_at(h, h->snapshot_count - 1);
    r->count = kept->strides;
    r->strides = h->strides.base;
    r->capacity = h->strides.capacity;
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
