// The motion from event to event, for tests without a run around it.
#pragma once

#include "src/contact/contact_machine.h"

// Steps until `until` [s] or the first event; a step takes `step` [s] at most.
static inline status motion_advance(const arm *a, motion *m, double until, double step,
                                    motion_report *report)
{
    status s = STATUS_OK;
    *report = (motion_report){.event = MOTION_REACHED};
    while (s == STATUS_OK && report->event == MOTION_REACHED && m->state[SLOT_TIME] < until) {
        s = motion_step(a, m, until, step, report);
    }
    return s;
}
